"""The campaigns that ship: what their makers write is what is stored, and the disclosed truth comes back."""

import hashlib
import pathlib

import numpy as np

from benchmarks import example_campaign, hidden_effect_campaign
from compare import BenchModel, Campaign, compare

FOLDER = pathlib.Path(__file__).resolve().parents[2] / "data" / "campaigns" / "example-tension"
HIDDEN = FOLDER.parent / "example-hidden-effect"


def test_the_maker_reproduces_the_stored_files(tmp_path, monkeypatch):
    monkeypatch.setattr(example_campaign, "FOLDER", tmp_path)
    example_campaign.main()
    names = {p.name for p in FOLDER.iterdir()}
    assert names == {p.name for p in tmp_path.iterdir()}
    assert all((FOLDER / n).read_bytes() == (tmp_path / n).read_bytes() for n in names)


def test_the_disclosed_stiffness_comes_back_and_nothing_is_missing():
    campaign = Campaign.read(FOLDER)
    comparison = compare(BenchModel(campaign.section), campaign)
    EA = comparison.record()["calibrated"]["EA"]
    assert abs(EA["value"] - example_campaign.EA) < 3 * EA["std"]
    assert EA["std"] < 0.01 * EA["value"]
    assert not comparison.where_it_fails()


def test_the_campaign_with_a_hidden_effect_is_reproduced_and_its_truth_stays_outside(tmp_path, monkeypatch):
    """The truth stands beside the folder, and nothing in the folder names the effect."""
    monkeypatch.setattr(hidden_effect_campaign, "FOLDER", tmp_path / "made")
    hidden_effect_campaign.main()
    assert {p.name for p in HIDDEN.iterdir()} == {p.name for p in (tmp_path / "made").iterdir()}
    data = [p for p in HIDDEN.iterdir() if p.name != "README.md"]
    assert all(p.read_bytes() == (tmp_path / "made" / p.name).read_bytes() for p in data)
    page, made = ((folder / "README.md").read_text(encoding="utf-8") for folder in (HIDDEN, tmp_path / "made"))
    assert page.startswith(made.rstrip())  # what follows is the hash of the truth
    assert hashlib.sha256((FOLDER.parent / "truth.json").read_bytes()).hexdigest() in page
    told = "".join(p.read_text(encoding="utf-8") for p in HIDDEN.iterdir())
    assert not any(word in told for word in ("friction", "slip", "layer"))
    assert sum(p.stat().st_size for p in HIDDEN.iterdir()) < 4e5


def test_sealed_conditions_of_the_hidden_effect_lie_beyond_the_open_ones():
    """Larger curvature, higher tension: a patch that interpolates has nothing to stand on there."""
    bench = hidden_effect_campaign.make_bench()
    sealed = np.array([name == "sealed" for name in bench.set_names])
    assert np.abs(bench.strain[sealed]).max() > 1.3 * np.abs(bench.strain[~sealed]).max()
    assert bench.tension[sealed].max() > 1.3 * bench.tension[~sealed].max()
