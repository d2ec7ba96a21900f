"""Notebooks run, with their assertions, on short horizons; the printed notebook holds the same code as its source."""

import json
import pathlib
import runpy

import pytest

FOLDER = pathlib.Path(__file__).resolve().parents[2] / "notebooks"
SOURCES = sorted(FOLDER.glob("*.py"))


@pytest.mark.parametrize("source", SOURCES, ids=lambda p: p.stem)
def test_notebook_runs_and_its_assertions_hold(source, monkeypatch):
    monkeypatch.setenv("MPLBACKEND", "Agg")
    import matplotlib
    import matplotlib.pyplot

    matplotlib.use("Agg")
    monkeypatch.chdir(FOLDER)
    assert "assert " in source.read_text(encoding="utf-8")
    runpy.run_path(str(source), run_name="testing")
    matplotlib.pyplot.close("all")


@pytest.mark.parametrize("source", SOURCES, ids=lambda p: p.stem)
def test_printed_notebook_holds_the_same_code(source):
    """Cell by cell; the print also has its outputs."""
    import jupytext

    cells = [c.source for c in jupytext.read(source).cells if c.cell_type == "code"]
    printed = json.loads(source.with_suffix(".ipynb").read_text(encoding="utf-8"))
    code = [c for c in printed["cells"] if c["cell_type"] == "code"]
    assert ["".join(c["source"]) for c in code] == cells
    assert any(c["outputs"] for c in code)
