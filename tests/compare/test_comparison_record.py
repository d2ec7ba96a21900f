"""What comes out: the JSON of the contract with finite numbers only, and nothing left out in silence."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
from made_campaign import NOMINAL
from sound_campaign import LIST, TOML

from compare import BenchModel, Campaign, NominalSection, compare

MODEL = BenchModel(NominalSection(NOMINAL))
KEYS = {"id", "kind", "channel", "set", "rmse", "bias", "noise_floor", "excess"}
TOWING = (
    TOML
    + """
[towing]
friction_coefficient = 0.35
cable_length = "40 m"
tail_tension = "800 N"
inclination = "6 deg"
"""
)
TOWED = "time [s],position [m],tension [N],tension at 15 [N]\n" + "".join(
    f"{t},{0.1 * t},{900 + t},{850 + t % 3}\n" for t in range(20)
)


def test_keys_of_the_contract(folder):
    record = compare(MODEL, Campaign.read(folder())).record()
    assert record["schema"] == 1
    assert [row["id"] for row in record["experiments"]] == ["a", "b", "c"]
    for row in record["experiments"]:
        assert row.keys() >= KEYS
    assert record["calibrated"]["EI"].keys() >= {"value", "std", "unit"}
    assert record["calibrated"]["EI"]["unit"] == "N m^2"
    assert all(isinstance(note, str) for note in record["notes"])
    assert json.loads(json.dumps(record, allow_nan=False)) == record


def test_towing_is_not_compared_and_says_so(folder):
    listed = LIST + "t,towing,t.csv,S1,,calibrate,\n"
    campaign = Campaign.read(folder({"experiments.csv": listed, "t.csv": TOWED, "campaign.toml": TOWING}))
    assert campaign["t"].record.measured == ("tension", "tension at 15")
    record = compare(MODEL, campaign).record()
    rows = [row for row in record["experiments"] if row["id"] == "t"]
    assert [row["channel"] for row in rows] == ["tension", "tension at 15"]
    assert all(row["rmse"] is None and row["excess"] is None and row["noise_floor"] > 0 for row in rows)
    assert any("cannot tow: t" in note for note in record["notes"])


def test_campaign_of_towing_only(folder):
    listed = "id,kind,file,specimen,repeat_of,set\nt,towing,t.csv,S,,calibrate\n"
    campaign = Campaign.read(folder({"experiments.csv": listed, "t.csv": TOWED, "campaign.toml": TOWING}))
    comparison = compare(MODEL, campaign)
    assert comparison.record()["calibrated"] == {}
    assert comparison.headline() == "No experiment of this campaign could be compared."


def test_kind_without_calibration_data_keeps_its_nominal_stiffness(folder):
    comparison = compare(MODEL, Campaign.read(folder()))
    assert any("no open tension experiment is in the set calibrate" in note for note in comparison.notes)
    assert "EA" not in comparison.record()["calibrated"]
    pull = next(f for f in comparison.fits if f.experiment.id == "c")
    np.testing.assert_array_equal(pull.model, pull.nominal)


def test_number_that_is_not_finite_is_null_with_its_place(folder):
    comparison = compare(MODEL, Campaign.read(folder()))
    broken = replace(comparison.fits[1], noise_floor=float("nan"))
    record = replace(comparison, fits=(comparison.fits[0], broken, comparison.fits[2])).record()
    assert record["experiments"][1]["noise_floor"] is None
    assert any(note.startswith("experiments[1].noise_floor is null") for note in record["notes"])


def test_progress_runs_from_zero_to_one(folder):
    told = []
    compare(MODEL, Campaign.read(folder()), progress=lambda fraction, sentence: told.append((fraction, sentence)))
    assert told[0][0] == 0.0 and told[-1][0] == 1.0
    assert [f for f, _ in told] == sorted(f for f, _ in told)
