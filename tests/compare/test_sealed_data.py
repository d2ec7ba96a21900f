"""Sealed experiments: hashed, not read, by no code path, until they are opened on request; opening changes nothing else."""

from __future__ import annotations

import hashlib
import logging

import pytest
from sound_campaign import LIST, LOOP

from compare import BenchModel, Campaign, compare, plot_comparison
from geometry.errors import InputError

SEALED = LIST + "s,bending,s.csv,S1,a,sealed,1\n"
POISON = b"\xff\xfe this, is not a table \x00 at all"


def comparison_of(campaign: Campaign):
    assert campaign.section is not None
    return compare(BenchModel(campaign.section), campaign)


def test_no_code_path_reads_a_sealed_table(folder, tmp_path):
    """A table that cannot be parsed proves it: reading, comparing, plotting and writing all succeed."""
    campaign = Campaign.read(folder({"experiments.csv": SEALED, "s.csv": POISON}))
    comparison = comparison_of(campaign)
    plot_comparison(comparison, tmp_path / "out")
    record = comparison.record()
    assert "s" not in [row["id"] for row in record["experiments"]]
    assert any("sealed, not read: s" in note for note in record["notes"])
    with pytest.raises(InputError):
        campaign.open_sealed()


def test_sealed_table_is_hashed(folder):
    campaign = Campaign.read(folder({"experiments.csv": SEALED, "s.csv": POISON}))
    assert campaign["s"].sha256 == hashlib.sha256(POISON).hexdigest()
    assert not campaign["s"].is_open
    assert [e.id for e in campaign.readable] == ["a", "b", "c"]


def test_asking_for_a_sealed_record_is_a_sentence(folder):
    campaign = Campaign.read(folder({"experiments.csv": SEALED, "s.csv": LOOP}))
    with pytest.raises(InputError, match="experiment s is sealed"):
        _ = campaign["s"].record


def test_values_of_sealed_data_change_nothing_before_opening(folder):
    """Two campaigns that differ in their sealed values only give the same record."""
    records = []
    for values in (LOOP, LOOP.replace("9.6", "960")):
        records.append(comparison_of(Campaign.read(folder({"experiments.csv": SEALED, "s.csv": values}))).record())
    assert records[0] == records[1]


def test_opening_adds_the_sealed_experiments_and_leaves_noise_and_calibration(folder, caplog):
    campaign = Campaign.read(folder({"experiments.csv": SEALED, "s.csv": LOOP.replace("9.6", "12.6")}))
    closed = comparison_of(campaign)
    with caplog.at_level(logging.WARNING):
        opened_campaign = campaign.open_sealed()
    opened = comparison_of(opened_campaign)
    assert "sealed experiments opened: s" in caplog.text
    assert campaign["s"].table is None, "the campaign that was read stays sealed"
    assert opened.noise.by_channel == closed.noise.by_channel
    assert opened.calibration.values == closed.calibration.values
    assert [f.experiment.id for f in opened.fits] == ["a", "b", "c", "s"]
    assert opened.relative_error("sealed") is not None and closed.relative_error("sealed") is None
    assert any("sealed experiments were opened: s" in note for note in opened.notes)


def test_sealed_table_changed_behind_our_back(folder):
    path = folder({"experiments.csv": SEALED, "s.csv": LOOP})
    campaign = Campaign.read(path)
    (path / "s.csv").write_text(LOOP.replace("9.6", "9.7"))
    with pytest.raises(InputError, match=r"s\.csv: the sealed table was changed"):
        campaign.open_sealed()
