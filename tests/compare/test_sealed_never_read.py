"""Sealed experiments: no verb and no function looks at what stands in them before they are opened.

Three independent nets: poison that cannot be parsed, a watch on every byte that leaves the file, and findings that may not
depend on the sealed values. Opening is on request, once, and said in the log, on the screen and in the JSON.
"""

from __future__ import annotations

import builtins
import io
import json
import logging
import os
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from compare import BenchModel, Campaign
from compare import campaign as campaign_module
from helicable.main import main

TOML = 'title = "sealed"\n[section]\nEI = "95 N m^2"\n'
POISON = b"\xff\xfenot a table, 1e999, \x00nan\n"
FEW = "viscous-damping,sensor-offset"
VERBS: dict[str, list[str]] = {
    "check": [],
    "compare": [],
    "explain": ["--effects", FEW],
    "add": ["viscous-damping"],
    "next": [],
}
IDS = ("a", "b", "c", "d", "s")


def table(seed: int, largest: float, offset: float) -> bytes:
    """One cycle of bending with an offset of the moment that the linear model does not have."""
    rng = np.random.default_rng(seed)
    time = np.linspace(0, 20, 40)
    curvature = largest * np.sin(np.linspace(0, 2 * np.pi, 40))
    moment = 90 * curvature + offset + rng.normal(0, 0.3, 40)
    body = "".join(f"{t:.4f},{k:.6f},{m:.5f}\n" for t, k, m in zip(time, curvature, moment, strict=True))
    return ("time [s],curvature [1/m],moment [N m]\n" + body).encode()


@pytest.fixture
def folder(tmp_path: Path) -> Callable[[bytes], Path]:
    """Campaign with two pairs of repeats that calibrate and one sealed experiment of the given content."""

    def write(sealed: bytes) -> Path:
        path = tmp_path / "campaign"
        path.mkdir(exist_ok=True)
        rows = ["id,kind,file,specimen,repeat_of,set", "a,bending,a.csv,S,,calibrate", "b,bending,b.csv,S,a,calibrate"]
        rows += ["c,bending,c.csv,S,,calibrate", "d,bending,d.csv,S,c,calibrate", "s,bending,s.csv,S,,sealed"]
        (path / "campaign.toml").write_text(TOML)
        (path / "experiments.csv").write_text("\n".join(rows) + "\n")
        for i, id in enumerate("abcd"):
            (path / f"{id}.csv").write_bytes(table(i, 0.4 if id in "ab" else 0.25, 5.0))
        (path / "s.csv").write_bytes(sealed)
        return path

    return write


def run(verb: str, folder: Path, out: Path, *more: str) -> tuple[int, Any]:
    code = main([verb, str(folder), *VERBS[verb], *more, "--json", str(out)])
    return code, json.loads(out.read_text()) if out.exists() else None


def without_clock(record: Any) -> Any:
    """The JSON without what another run changes by itself."""
    if isinstance(record, dict):
        return {k: without_clock(v) for k, v in record.items() if k != "seconds"}
    return [without_clock(v) for v in record] if isinstance(record, list) else record


@pytest.mark.parametrize("verb", VERBS)
def test_poison_in_a_sealed_table_harms_no_verb(folder, tmp_path, verb):
    code, record = run(verb, folder(POISON), tmp_path / "out.json")
    assert code == 0
    assert any("sealed, not read: s" in note for note in record["notes"])


@pytest.mark.parametrize("verb", VERBS)
def test_findings_do_not_depend_on_the_sealed_values(folder, tmp_path, verb):
    """The same linear specimen, one ten times as stiff, and poison: one and the same JSON."""
    found = []
    for i, sealed in enumerate((table(9, 0.4, 5.0), table(9, 4.0, -500.0), POISON)):
        _, record = run(verb, folder(sealed), tmp_path / f"out{i}.json")
        found.append(without_clock(record))
    assert found[0] == found[1] == found[2]


@pytest.fixture
def watched(monkeypatch) -> Iterator[list[str]]:
    """Names of campaign tables in the order in which anything opens them, by whatever way Python has."""
    opened: list[str] = []

    def note(path: Any) -> None:
        if isinstance(path, (str, bytes, os.PathLike)) and Path(os.fsdecode(path)).stem in IDS:
            opened.append(Path(os.fsdecode(path)).name)

    for module, name in ((builtins, "open"), (io, "open"), (os, "open")):
        original = getattr(module, name)

        def spied(path: Any, *args: Any, _original: Any = original, **keywords: Any) -> Any:
            note(path)
            return _original(path, *args, **keywords)

        monkeypatch.setattr(module, name, spied)
    yield opened


@pytest.mark.parametrize("verb", VERBS)
def test_a_sealed_file_is_opened_once_for_its_hash_and_then_never(folder, tmp_path, watched, verb):
    path = folder(table(9, 0.4, 5.0))
    watched.clear()
    run(verb, path, tmp_path / "out.json")
    assert watched.count("a.csv") > 0, "the watch sees the tables that are read"
    assert watched.count("s.csv") == watched.count("a.csv") == 1


@pytest.mark.parametrize("verb", VERBS)
def test_the_bytes_of_a_sealed_file_reach_the_hash_alone(folder, tmp_path, monkeypatch, verb):
    """Whatever is handed to the parser of tables is not the sealed content."""
    sealed, parsed = table(9, 0.4, 5.0), []
    original = campaign_module.read_record

    def spied(raw: bytes, *args: Any) -> Any:
        parsed.append(raw)
        return original(raw, *args)

    monkeypatch.setattr(campaign_module, "read_record", spied)
    run(verb, folder(sealed), tmp_path / "out.json")
    assert len(parsed) == 4 and sealed not in parsed


def test_opening_is_on_request_logged_and_said_in_the_findings(folder, tmp_path, caplog):
    path = folder(table(9, 0.4, 5.0))
    _, closed = run("explain", path, tmp_path / "closed.json")
    assert closed["error"]["sealed"] is None
    with caplog.at_level(logging.WARNING):
        code, opened = run("explain", path, tmp_path / "opened.json", "--open-sealed")
    assert code == 0
    assert caplog.text.count("sealed experiments opened: s") == 1, "opened once"
    assert any("opened" in note and "s" in note for note in opened["notes"])
    error = opened["error"]["sealed"]
    assert error["after"] < error["before"]
    for key in ("verdict", "effects", "ranking", "untestable", "where"):
        assert opened[key] == closed[key], "what was found stands before the sealed data are seen"
    for name in ("calibrate", "validate"):
        assert opened["error"][name] == closed["error"][name]


def test_opened_poison_is_a_sentence_and_no_finding(folder, tmp_path, capsys):
    code, record = run("explain", folder(POISON), tmp_path / "out.json", "--open-sealed")
    assert code == 2 and record is None
    assert "s.csv, row 1" in capsys.readouterr().err


def test_sealed_table_changed_after_reading_is_not_opened(folder):
    path = folder(table(9, 0.4, 5.0))
    campaign = Campaign.read(path)
    (path / "s.csv").write_bytes(table(10, 0.4, 5.0))
    with pytest.raises(Exception, match="was changed after the campaign was read"):
        campaign.open_sealed()


def test_explain_leaves_sealed_experiments_of_an_opened_campaign_alone(folder):
    """Also where the campaign was opened before, the search sees the sets calibrate and validate only."""
    from compare.explain import explain
    from effects import find

    campaign = Campaign.read(folder(table(9, 4.0, -500.0)))
    assert campaign.section is not None
    library = [find(name) for name in FEW.split(",")]
    closed = explain(BenchModel(campaign.section), campaign, library=library)
    opened = explain(BenchModel(campaign.section), campaign.open_sealed(), library=library)
    assert opened.verdict == closed.verdict and opened.effects == closed.effects
    assert [c.log_e for c in opened.ranking] == [c.log_e for c in closed.ranking]
