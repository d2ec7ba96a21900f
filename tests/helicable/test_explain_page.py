"""The page of explain: seven panels, five sentences first, no network, text escaped, lights that need no colour; in a real browser."""

from __future__ import annotations

import html
import json
import re
import shutil
import subprocess
from dataclasses import replace

import numpy as np
import pytest
from made_findings import VERDICTS, made_findings

from compare.findings import Separation
from compare.findings_plot import plot_findings
from compare.findings_sentences import first_screen
from helicable.explain_report import write_report

PANELS = (
    "Data and design",
    "Model over measurement",
    "Where it fails",
    "Which effect",
    "The path",
    "Before and after",
    "Next experiment",
)
CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")
EVIL = "<script>document.title='broken'</script> \"onload=alert(1) {{ 7*7 }}"


@pytest.fixture(scope="module")
def pages(tmp_path_factory):
    """Folder and text of the page of each verdict."""
    made = {}
    for verdict in VERDICTS:
        folder = tmp_path_factory.mktemp(verdict)
        made[verdict] = write_report(made_findings(verdict), folder)
    return made


@pytest.mark.parametrize("verdict", VERDICTS)
def test_seven_panels_in_order_below_the_five_sentences(verdict, pages):
    page = pages[verdict].read_text(encoding="utf-8")
    text = html.unescape(page)
    heads = re.findall(r'<h2><span class="step">(\d)</span>([^<]+?)\s*<span class="light', page)
    assert [name for _, name in heads] == list(PANELS)
    assert [int(i) for i, _ in heads] == list(range(1, 8))
    for _, sentence in first_screen(made_findings(verdict)):
        assert text.index(sentence) < text.index('<section id="s1">')


@pytest.mark.parametrize("verdict", VERDICTS)
def test_the_page_needs_no_other_file_and_no_network(verdict, pages):
    page = pages[verdict].read_text(encoding="utf-8")
    sources = re.findall(r'(?:src|href)="([^"]*)"', page)
    assert sources
    assert all(s.startswith(("data:image/", "#")) for s in sources), [s[:60] for s in sources]
    assert "url(" not in page and "@import" not in page and "http" not in page


@pytest.mark.parametrize("verdict", VERDICTS)
def test_every_link_leads_somewhere_and_every_panel_says_how(verdict, pages):
    page = pages[verdict].read_text(encoding="utf-8")
    targets = set(re.findall(r'id="([^"]+)"', page))
    assert set(re.findall(r'href="#([^"]+)"', page)) <= targets
    assert {f"how{i}" for i in range(1, 8)} <= targets
    blocks = re.findall(r"How these numbers are computed</summary>(.*?)</details>", page, flags=re.S)
    assert len(blocks) == 7 and all(len(re.findall("<dt>", b)) >= 2 for b in blocks)


@pytest.mark.parametrize("verdict", VERDICTS)
def test_every_light_has_a_shape_and_a_word(verdict, pages):
    """The three lights differ without their colour: circle, triangle, square, and a word beside."""
    page = pages[verdict].read_text(encoding="utf-8")
    lights = re.findall(r'<span class="light (good|mind|bad)">(.*?)</span>', page, flags=re.S)
    assert len(lights) >= 13
    shape = {"good": "<circle", "mind": "M10 1.5L19.5", "bad": "<rect"}
    for level, content in lights:
        assert shape[level] in content
        assert re.sub("<[^>]*>", "", content).strip()


def test_the_verdict_decides_the_light(pages):
    found = {v: re.search(r'<p class="verdict"><b class="(\w+)">', p.read_text()).group(1) for v, p in pages.items()}
    assert found == {
        "none": "good",
        "identified": "good",
        "family-identified": "mind",
        "confusable": "mind",
        "unknown": "bad",
    }


def test_text_of_a_campaign_cannot_become_part_of_the_page(tmp_path):
    page = write_report(made_findings("identified", title=EVIL), tmp_path).read_text(encoding="utf-8")
    assert html.escape(EVIL, quote=True).replace("&quot;", "&#34;").replace("&#x27;", "&#39;") in page
    assert page.count("<script") == 1, "only the page's own"


def test_pictures_that_have_nothing_to_show_are_left_out(tmp_path):
    assert "path" not in plot_findings(made_findings("none"), tmp_path / "none")
    written = plot_findings(made_findings("identified"), tmp_path / "some")
    assert {"record-1", "record-2", "where", "conditions", "loop-energy", "ranking", "path", "errors"} <= set(written)
    from matplotlib.image import imread

    assert all(imread(p).std() > 0.02 for p in written.values()), "something is drawn"


def test_findings_with_nothing_in_them_still_make_a_page(tmp_path):
    """No experiment compared, no candidate, no set, no testable effect: sentences, not a traceback."""
    made = made_findings("none")
    nothing = replace(
        made.comparison, fits=(), lack_of_fit={}, calibration=replace(made.comparison.calibration, values={})
    )
    empty = Separation((), np.zeros(0), (), np.zeros((0, 0)))
    bare = replace(
        made,
        comparison=nothing,
        after=nothing,
        ranking=(),
        untestable=(),
        separation=empty,
        smallest_seen={},
        errors={},
    )
    page = write_report(replace(bare, where=(), notes=()), tmp_path).read_text(encoding="utf-8")
    assert "No experiment" in page and "No held-out data" in page
    assert json.dumps(bare.record(), allow_nan=False)


@pytest.mark.skipif(CHROMIUM is None, reason="no chromium")
@pytest.mark.parametrize("width", [1280, 400])
def test_a_browser_shows_it_without_sideways_scrolling(width, pages, tmp_path):
    """The page is laid out by a real browser; what is wide scrolls in its own box, and hostile titles stay text."""
    page = write_report(made_findings("identified", title=EVIL), tmp_path)
    probe = "<script>addEventListener('load', () => { document.body.dataset.probe = [document.documentElement.scrollWidth, innerWidth, "
    probe += "[...document.images].every(i => i.naturalWidth > 300), document.title.startsWith('<script>')].join(' ') })</script>"
    page.write_text(page.read_text(encoding="utf-8").replace("</main>", f"</main>{probe}"), encoding="utf-8")
    # the narrowest window of the browser is wider than a phone, so that the page is put into a frame of that width
    frame = tmp_path / "frame.html"
    script = "addEventListener('message', e => { document.body.dataset.probe = e.data })"
    page.write_text(
        page.read_text(encoding="utf-8").replace("</body>", "<script>addEventListener('load', () => parent.postMessage("
        "document.body.dataset.probe, '*'))</script></body>"),
        encoding="utf-8",
    )  # fmt: skip
    frame.write_text(
        f'<script>{script}</script><body><iframe src="report.html" width="{width}" height="900"></iframe></body>'
    )
    command = [CHROMIUM, "--headless", "--no-sandbox", "--disable-gpu", "--window-size=1400,1000"]
    command += [f"--user-data-dir={tmp_path / 'profile'}", "--virtual-time-budget=8000", "--dump-dom", frame.as_uri()]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120)
    found = re.search(r'<body data-probe="([^"]*)"', done.stdout)
    assert found, done.stderr[-500:]
    wide, inner, pictures, title = found.group(1).split()
    assert int(inner) <= width and int(wide) <= int(inner)
    assert (pictures, title) == ("true", "true")
