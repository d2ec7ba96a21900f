"""The campaign that ships: what its maker writes is what is stored, and its disclosed truth comes back."""

import pathlib

from benchmarks import example_campaign
from compare import BenchModel, Campaign, compare

FOLDER = pathlib.Path(__file__).resolve().parents[2] / "data" / "campaigns" / "example-tension"


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
