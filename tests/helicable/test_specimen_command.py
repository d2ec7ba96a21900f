"""`helicable specimen`: a table, a JSON record and pictures; bad input is one sentence and exit code 2."""

import json

import pytest

from helicable.main import main


def test_record_of_a_rod(tmp_path):
    """Three loads on the homogeneous rod at two ends: the record holds moduli, displacements, checks; the pictures are written."""
    path = tmp_path / "found.json"
    words = [
        "specimen",
        "helical-rod",
        "--length",
        "60 mm",
        "--load",
        "tension,shear:-y,torsion",
        "--lengths",
        "40mm,80mm",
        "--size",
        "8 mm",
    ]
    assert main([*words, "--out", str(tmp_path), "--json", str(path)]) == 0
    record = json.loads(path.read_text(encoding="utf-8"))
    assert set(record["loads"]) == {"tension", "shear -y", "torsion"}
    assert record["loads"]["shear -y"]["u_max"] > 0
    assert record["loads"]["tension"]["curve"]["R2"] == pytest.approx(1.0)
    assert all(check["holds"] for check in record["checks"])
    assert "too far for small displacements" in " ".join(record["notes"])  # 2000 N on a rod like a spring
    assert record["lengths"]["E_infinite"] > 0
    for name in ("shear_lag", "stress_strain"):
        assert (tmp_path / f"{name}.png").stat().st_size > 5000
    assert (tmp_path / "length_law.png").stat().st_size > 5000


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["--length", "-3 mm"], "length of a specimen must be positive"),
        (["--load", "pull"], "is not known; choose tension"),
        (["--load", "tension:x"], "take a direction"),
        (["--load", "shear,shear:x"], "names a load twice"),
        (["--ends", "glue"], "is not known; choose uniform"),
        (["--held", "plate"], "choose fixed"),
        (["--ends", "traction:gold"], "which is not a part"),
        (["--lengths", "60 mm, 60 mm"], "at least two different lengths"),
        (["--published", "--load", "shear"], "load cases of its own"),
    ],
)
def test_bad_input(words, sentence, capsys):
    assert main(["specimen", "helical-rod", *words]) == 2
    assert sentence in capsys.readouterr().err


def test_large_displacements_in_steps(tmp_path, capsys):
    """Slope and R2 of the average stress-strain points; both signs of a shear are compared; not with several lengths."""
    path = tmp_path / "found.json"
    words = ["specimen", "helical-rod", "--length", "20 mm", "--large-displacement", "--size", "8 mm"]
    loads = ["--load", "shear:x,shear:-x", "--force", "50 N", "--steps", "2"]
    assert main([*words, *loads, "--json", str(path)]) == 0
    record = json.loads(path.read_text(encoding="utf-8"))
    assert record["large_displacement"] is True
    curve = record["loads"]["shear -x"]["curve"]
    assert len(curve["stress"]) == 3 and 0.99 < curve["R2"] <= 1.0
    assert "+x against -x" in " ".join(record["notes"])
    assert "R2" in capsys.readouterr().out
    assert main([*words, "--lengths", "20 mm, 40 mm"]) == 2
    assert "--lengths is for linear specimens" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("law", "sentence"),
    [
        ("opening+glue:3", "which is not known"),
        ("opening:3 kg", "opening"),
        ("opening,core-filler=opening", "names a pair twice"),
        ("opening,conductor-insulation=frictionless", "followed by themselves"),
    ],
)
def test_bad_opening(law, sentence, capsys):
    assert main(["specimen", "paper-specimen-3x35", "--interface", f"core-filler={law}"]) == 2
    assert sentence in capsys.readouterr().err
