"""`helicable homogenize --method two-stage`: keys of the contract, and refusals in one sentence."""

import json

import pytest

from helicable.main import main

CABLE = "mcpt-1.9-3.3-3x35"
KEYS = {"schema", "cable", "outer_diameter", "area", "mass_per_length", "section", "E_blocked_twist", "E_free_twist"}
KEYS |= {"G_yoz", "G_xoz", "bounds", "mesh", "seconds", "notes"}


def test_the_record_has_the_keys_of_the_other_methods_and_every_stage(tmp_path):
    file = tmp_path / "section.json"
    assert main(["homogenize", CABLE, "--method", "two-stage", "--size", "6 mm", "--json", str(file)]) == 0
    record = json.loads(file.read_text(encoding="utf-8"))
    assert KEYS <= set(record)
    assert record["stages"][-2]["EA_blocked_twist"] == pytest.approx(record["section"]["C"][2][2], rel=1e-12)
    assert record["E_free_twist"] < record["E_blocked_twist"]


def test_unknown_strands_are_refused(capsys):
    assert main(["homogenize", CABLE, "--method", "two-stage", "--strands", "glued"]) == 2
    assert "choose bonded or frictionless" in capsys.readouterr().err
