"""The shipped campaigns: made by their scripts, with a truth that stands outside them and was not changed afterwards."""

import hashlib
from pathlib import Path

import numpy as np
import pytest

from benchmarks.blind_towing.exudyn_line import installed
from benchmarks.hidden_effect_towing import DURATION, SAMPLES, SITES
from benchmarks.shipped_campaigns import TORSION, make_torsion, truth_json, truth_page, truths
from compare import Campaign

PARENT = Path(__file__).resolve().parents[2] / "data" / "campaigns"


def test_truth_is_the_one_whose_hash_was_stated():
    """truth.json and truth.md are what the scripts write; every README names the SHA-256."""
    text = (PARENT / "truth.json").read_text(encoding="utf-8")
    assert text == truth_json()
    assert (PARENT / "truth.md").read_text(encoding="utf-8") == truth_page()
    digest = hashlib.sha256(text.encode()).hexdigest()
    readmes = [PARENT / name / "README.md" for name in truths()]
    stated = [r.read_text(encoding="utf-8") for r in readmes if r.is_file()]
    assert len(stated) == 6 and all(digest in text for text in stated)


def test_four_have_a_hidden_effect_and_every_folder_has_a_truth():
    folders = {p.name for p in PARENT.iterdir() if p.is_dir()}
    assert folders == set(truths())
    assert sum(bool(t["effects"]) for t in truths().values()) >= 4


@pytest.mark.parametrize("name", [site.name for site in SITES] + [TORSION])
def test_folder_reads_and_does_not_tell(name):
    """Readable, repeats for all, sealed records, small files, and no name of the truth in any of them."""
    campaign = Campaign.read(PARENT / name)
    assert {e.set for e in campaign.experiments} == {"calibrate", "validate", "sealed"}
    assert sum(e.repeat_of is not None for e in campaign.experiments) == len(campaign.experiments) / 2
    for file in (PARENT / name).iterdir():
        assert file.stat().st_size < 500_000
        assert not any(effect in file.read_text(encoding="utf-8") for effect in truths()[name]["effects"])


def test_torsion_is_made_again_to_the_last_digit_but_one(tmp_path):
    make_torsion(tmp_path)
    for file in (PARENT / TORSION).glob("e*.csv"):
        if file.name == "experiments.csv":
            assert file.read_text() == (tmp_path / TORSION / file.name).read_text()
            continue
        old, new = (np.loadtxt(p, delimiter=",", skiprows=1) for p in (file, tmp_path / TORSION / file.name))
        np.testing.assert_allclose(new, old, rtol=2e-5, atol=1e-6)


@pytest.mark.skipif(not installed(), reason="the simulator of these data is not installed")
@pytest.mark.parametrize("site", SITES, ids=lambda s: s.name)
def test_towing_runs_are_those_of_the_simulator(site):
    """The first eighth of the fastest run to calibrate, made again: both repeats lie round it within the noise."""
    t = np.linspace(0.0, DURATION, SAMPLES)[: SAMPLES // 8]
    condition = site.conditions()[2]
    made = site.clean(condition, t)
    swing = np.ptp(made, axis=1)[:, None]
    for name in ("w05.csv", "w06.csv"):
        shipped = np.loadtxt(PARENT / site.name / name, delimiter=",", skiprows=1)[: len(t)]
        np.testing.assert_allclose(shipped[:, 1], condition.motion(t)[0], rtol=1e-5, atol=1e-7)
        assert np.sqrt(np.mean(((shipped[:, 2:].T - made) / swing) ** 2)) < 0.025
