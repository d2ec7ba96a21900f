"""Reading a campaign: what stands in the files arrives unchanged, in SI, whatever program wrote the text."""

from __future__ import annotations

import pickle

import numpy as np
import pytest

from compare import BenchModel, Campaign, compare
from geometry.errors import InputError


def test_every_cell_arrives(folder):
    campaign = Campaign.read(folder())
    assert campaign.title == "a test"
    assert [e.id for e in campaign.experiments] == ["a", "b", "c"]
    a, c = campaign["a"], campaign["c"]
    assert (a.kind, a.set, a.repeat_of, a.specimen) == ("bending", "calibrate", None, "S1")
    assert campaign["b"].repeat_of == "a"
    assert (a.record.prescribed, a.record.measured) == ("curvature", ("moment",))
    np.testing.assert_array_equal(a.record["moment"], [9.5 * (t % 5) + 0.1 for t in range(12)])
    np.testing.assert_allclose(c.record["extension"], np.arange(12) / 1000, rtol=1e-15)  # one rounding of mm to m
    assert a.record.time is not None
    np.testing.assert_array_equal(a.record.time, np.arange(12))
    assert campaign.section is not None
    assert (campaign.section.EA_blocked_twist, campaign.section.EI_x, campaign.section.GJ) == (4.0e5, 95.0, 60.0)


def test_byte_order_mark_and_windows_line_ends_change_nothing(folder):
    plain = Campaign.read(folder())
    record = plain["a"].record["moment"]
    names = ("campaign.toml", "experiments.csv", "a.csv")
    windows = {
        n: b"\xef\xbb\xbf" + (plain.folder / n).read_bytes().replace(b"\n", b"\r\n") + b"\r\n\r\n" for n in names
    }
    again = Campaign.read(folder(windows))
    np.testing.assert_array_equal(again["a"].record["moment"], record)
    assert [e.conditions for e in again.experiments] == [e.conditions for e in plain.experiments]


def test_empty_condition_is_not_recorded(folder):
    listed = "id,kind,file,specimen,repeat_of,set,temperature [degC]\n"
    listed += "a,bending,a.csv,,,calibrate,\nb,bending,b.csv,,,calibrate,20\n"
    campaign = Campaign.read(folder({"experiments.csv": listed}))
    assert "temperature" not in campaign["a"].conditions
    assert campaign["b"].conditions["temperature"] == pytest.approx(293.15, rel=1e-15)


def test_loop_without_clock_is_fine(folder):
    campaign = Campaign.read(folder({"a.csv": "curvature [1/m],moment [N m]\n0,0\n0.1,9\n0.2,19\n"}))
    assert campaign["a"].record.time is None


def test_single_experiment_without_repeats_is_fine_and_marked(folder):
    listed = "id,kind,file,specimen,repeat_of,set\na,bending,a.csv,S1,,calibrate\n"
    campaign = Campaign.read(folder({"experiments.csv": listed}))
    assert campaign.section is not None
    comparison = compare(BenchModel(campaign.section), campaign)
    assert any("noise assumed" in note for note in comparison.notes)


def test_read_data_cannot_be_overwritten_and_can_be_sent_to_another_process(folder):
    campaign = Campaign.read(folder())
    with pytest.raises(ValueError, match="read-only"):
        campaign["a"].record["moment"][0] = 1.0
    assert pickle.loads(pickle.dumps(campaign))["a"].conditions == campaign["a"].conditions


def test_unknown_id_is_a_sentence(folder):
    with pytest.raises(InputError, match="no experiment z; it has a, b, c"):
        Campaign.read(folder())["z"]


def test_a_million_rows(folder):
    block = "".join(f"{np.sin(k / 159.15):.6f},{95 * np.sin(k / 159.15):.6f}\n" for k in range(1000))
    campaign = Campaign.read(folder({"a.csv": "curvature [1/m],moment [N m]\n" + block * 1000}))
    assert len(campaign["a"].record) == 1_000_000
    assert campaign["a"].record["moment"][-1] == pytest.approx(95 * np.sin(999 / 159.15), abs=1e-6)  # digits written


def test_a_million_rows_with_one_bad_cell_name_its_row(folder):
    block = "0.1,9.5\n0.2,19.1\n" * 250_000
    with pytest.raises(InputError, match=r'a\.csv, row 500002, column "moment \[N m\]": "x" is not a number'):
        Campaign.read(folder({"a.csv": "curvature [1/m],moment [N m]\n" + block + "0.1,x\n" + block}))
