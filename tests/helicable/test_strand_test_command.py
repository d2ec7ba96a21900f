"""`helicable strand-test`: the synthetic record of the published test gives back 80 and 70 GPa; CSV in, JSON and picture out."""

import json

import pytest

from helicable.main import main


@pytest.mark.parametrize(("name", "E"), [("power", 80e9), ("control", 70e9)])
def test_published_moduli_are_found_again(tmp_path, name, E):
    """Within two standard errors, from the record alone; the file that was written is read to the same number."""
    assert main(["strand-test", name, "--out", str(tmp_path)]) == 0
    record = json.loads((tmp_path / "strand-test.json").read_text())
    assert record["synthetic"] and "synthetic" in record["notes"][0]
    assert abs(record["E"] - E) < 2 * record["standard_error"] < 0.1 * E
    assert record["slope_modulus"] < 0.6 * E
    assert (tmp_path / "strand-test.png").stat().st_size > 10_000
    csv, again = tmp_path / f"{name}.csv", tmp_path / "again.json"
    area = f"{1e6 * record['area']} mm^2"
    assert main(["strand-test", str(csv), "--area", area, "--machine-stiffness", "50 kN/mm", "--json", str(again)]) == 0
    assert json.loads(again.read_text())["E"] == pytest.approx(record["E"], rel=1e-4)  # six digits in the file


def test_bad_input_is_a_sentence(tmp_path, capsys):
    file = tmp_path / "bad.csv"
    file.write_text("extension [mm],force [N]\n0,0\n1,x\n")
    for arguments, sentence in (
        ([str(file)], "--area is missing"),
        ([str(file), "--area", "7 mm^2"], '"x" is not a number'),
        ([str(tmp_path / "no.csv"), "--area", "7 mm^2"], "no such file"),
        (["power", "--until", "100 N"], "at least 6"),
        (["power", "--length", "3 kg"], "--length"),
    ):
        assert main(["strand-test", *arguments]) == 2
        assert sentence in capsys.readouterr().err
