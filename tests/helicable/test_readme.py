"""The README tells the truth: its commands exist, its links lead somewhere."""

import pathlib
import re

import pytest

from helicable.main import VERBS

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]


@pytest.mark.parametrize("page", PAGES, ids=lambda p: p.name)
def test_links_and_pictures_exist(page):
    targets = re.findall(r"\]\(([^)#]+)(?:#[^)]*)?\)", page.read_text(encoding="utf-8"))
    local = [t for t in targets if not t.startswith(("http:", "https:"))]
    assert all((page.parent / t).exists() for t in local), [t for t in local if not (page.parent / t).exists()]


@pytest.mark.parametrize("page", PAGES, ids=lambda p: p.name)
def test_every_command_that_is_shown_exists(page):
    blocks = "\n".join(
        re.findall(r"^```\w*$(.*?)^```$", page.read_text(encoding="utf-8"), flags=re.MULTILINE | re.DOTALL)
    )
    shown = set(re.findall(r"^(?:\.venv/bin/)?helicable ([a-z-]+)", blocks, flags=re.MULTILINE))
    assert shown <= set(VERBS), shown - set(VERBS)


def test_the_two_commands_stand_in_the_readme_and_in_the_makefile():
    readme, makefile = (ROOT / "README.md").read_text(), (ROOT / "Makefile").read_text()
    for target in ("demo", "test"):
        assert f"make {target}" in readme
        assert re.search(rf"^{target}:", makefile, flags=re.MULTILINE)
