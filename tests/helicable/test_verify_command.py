"""The verbs verify and stress, and the export of the section: tables, JSON keys, exit codes."""

import json

import pytest

from helicable.commands import verify as verify_module
from helicable.main import main
from homogenize.benchmark import Benchmark, Case

CABLE = "mcpt-1.9-3.3-3x35"


def test_verify_prints_and_writes_what_was_found(tmp_path, capsys):
    """A fast part of the section's benchmarks."""
    file = tmp_path / "verify.json"
    assert main(["verify", "--only", "section", "--match", "T1", "--json", str(file)]) == 0
    record = json.loads(file.read_text())
    assert record["schema"] == 1 and record["failed"] == 0 and record["passed"] == len(record["benchmarks"]) > 20
    keys = {"name", "part", "source", "quantity", "expected", "computed", "relative_error", "tolerance", "passed"}
    assert all(keys <= set(row) and row["part"] == "section" for row in record["benchmarks"])
    out = capsys.readouterr().out
    assert "BECAS" in out and "benchmarks pass" in out


def test_verify_the_rod(tmp_path):
    file = tmp_path / "rod.json"
    assert main(["verify", "--match", "R1 Princeton beam 13.345 N 45", "--json", str(file)]) == 0
    rows = json.loads(file.read_text())["benchmarks"]
    assert [row["quantity"] for row in rows] == ["tip x [m]", "tip y [m]", "tip z [m]"]
    assert {row["part"] for row in rows} == {"rod"}
    assert rows[2]["expected"] == 0.1567746


def test_a_failing_benchmark_is_exit_code_one(monkeypatch, tmp_path, capsys):
    """The wrong number is named, the file is written all the same."""
    wrong = Case("T0 wrong", "arithmetic", lambda: [Benchmark("T0 wrong", "arithmetic", "two [-]", 2.0, 3.0, 0.1)])
    monkeypatch.setattr(verify_module, "_cases", lambda part: [wrong])
    file = tmp_path / "v.json"
    assert main(["verify", "--only", "rod", "--json", str(file)]) == 1
    assert "FAILS T0 wrong: two" in capsys.readouterr().out
    assert json.loads(file.read_text())["failed"] == 1


@pytest.mark.parametrize(
    ("arguments", "words"), [(["--only", "cell"], "section or rod"), (["--match", "xyz"], "in its name")]
)
def test_unknown_parts_are_refused(arguments, words, capsys):
    assert main(["verify", *arguments]) == 2
    assert words in " ".join(capsys.readouterr().err.split())


def test_stress_of_a_towed_bend(tmp_path, capsys):
    """1300 N and a bend: every part has its row; conductors carry more than rubber; the picture is written."""
    out = tmp_path / "stress"
    arguments = ["--size", "4 mm", "--tension", "1300 N", "--bend-radius", "310 mm", "--out", str(out)]
    assert main(["stress", CABLE, *arguments]) == 0
    record = json.loads((out / "stress.json").read_text())
    assert record["forces"]["N"] == 1300.0
    assert record["strains"]["kappa_x"] == pytest.approx(1 / 0.31, rel=1e-9)
    regions = record["regions"]
    copper = max(r["von_mises_max"] for r in regions.values() if r["kind"] == "conductor")
    assert copper > 100 * max(r["von_mises_max"] for r in regions.values() if r["kind"] != "conductor")
    assert (out / "stress.png").stat().st_size > 50_000
    assert "read its stress as a strain" in " ".join(capsys.readouterr().out.split())


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--bend-radius", "10 mm"], "must exceed the radius of the cable"),
        (["--bend-radius", "1 m", "--moment", "5 N m"], "keep one of them"),
        (["--blocked", "--torque", "5 N m"], "exclude each other"),
    ],
)
def test_stress_refuses_what_cannot_be(arguments, words, capsys):
    assert main(["stress", CABLE, *arguments]) == 2
    assert words in " ".join(capsys.readouterr().err.split())


def test_homogenize_exports(tmp_path, capsys):
    """The format follows the ending; the 6x6 in the file is that of the JSON."""
    file, record = tmp_path / "section.json", tmp_path / "record.json"
    assert main(["homogenize", CABLE, "--size", "6 mm", "--export", str(file), "--json", str(record)]) == 0
    C = json.loads(record.read_text())["section"]["C"]
    K = json.loads(file.read_text())["stiffnessMatrix"]
    assert (K[0][0], K[0][3], K[4][4]) == (C[2][2], C[2][5], C[3][3])
    assert "exudyn" in capsys.readouterr().out
    assert main(["homogenize", CABLE, "--export", str(tmp_path / "a.xyz")]) == 2
    assert main(["homogenize", CABLE, "--format", "vabs"]) == 2
