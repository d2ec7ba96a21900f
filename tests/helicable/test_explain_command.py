"""The verbs check, explain, add and next: what they show, write and refuse; findings are made by hand here."""

from __future__ import annotations

import json
import pathlib
import sys
import types
from dataclasses import replace

import pytest
from made_findings import VERDICTS, made_check, made_findings, write_campaign

from compare.findings import SetError
from compare.findings_record import explain_schema
from helicable.main import main

TOWING = """title = "towed"
[section]
EA = "4.0e5 N"
GA = "1.6e5 N"
EI = "95 N m^2"
GJ = "60 N m^2"
mass_per_length = "4.6 kg/m"
[towing]
friction_coefficient = 0.35
cable_length = "40 m"
tail_tension = "800 N"
inclination = "6 deg"
"""
SHIPPED = pathlib.Path(__file__).resolve().parents[2] / "data" / "campaigns" / "example-tension"
TOWED = "time [s],position [m],tension [N]\n" + "".join(f"{t},{0.01 * t},{800 + t}\n" for t in range(20))


@pytest.fixture
def folder(tmp_path):
    """A campaign folder with the made experiments, one of them sealed."""
    return write_campaign(tmp_path / "campaign", sealed=("b05a", "b05b"))


@pytest.fixture
def explained(monkeypatch):
    """compare.explain replaced: returns made findings and keeps what it was called with."""
    calls: dict[str, object] = {}

    def explain(model, campaign, progress=None, library=None, store=None):
        calls.update(explained=campaign, library=library, model=model, store=store)
        return made_findings(calls.get("verdict", "identified"))

    def open_and_validate(findings, campaign):
        calls.update(
            opened=campaign,
            order=[*calls.get("order", []), "opened after explain" if "explained" in calls else "first"],
        )
        errors = {**findings.errors, "sealed": SetError(3.2, 1.1, 1.0, 0.2, 0.1, 0.3, {}, True)}
        return replace(findings, errors=errors, sealed_opened=True)

    made = types.ModuleType("compare.explain")
    made.explain, made.open_and_validate = explain, open_and_validate
    monkeypatch.setitem(sys.modules, "compare.explain", made)
    return calls


def squeezed(text: str) -> str:
    return " ".join(text.split())


@pytest.mark.parametrize("verdict", VERDICTS)
def test_explain_shows_one_screen_and_writes_the_contracts_json(
    verdict, folder, explained, tmp_path, capsys, monkeypatch
):
    monkeypatch.setenv("COLUMNS", "80")
    explained["verdict"] = verdict
    file = tmp_path / "f.json"
    assert main(["explain", str(folder), "--json", str(file)]) == 0
    out = capsys.readouterr().out
    record = json.loads(file.read_text())
    assert record["verdict"] == verdict
    assert record["error"]["sealed"] is None
    assert len(out.splitlines()) <= 40
    shown = squeezed(out)
    for word in ("Predicted", "Fails", f"Missing {verdict}", "Why not", "Untestable", "Next", "ratio of excess"):
        assert word in shown, word
    assert "opened" not in explained


def test_explain_follows_its_schema(folder, explained, tmp_path):
    jsonschema = pytest.importorskip("jsonschema")
    assert main(["explain", str(folder), "--json", str(tmp_path / "f.json")]) == 0
    jsonschema.validate(json.loads((tmp_path / "f.json").read_text()), explain_schema())


def test_sealed_experiments_are_opened_after_the_model_is_fixed(folder, explained, tmp_path, capsys):
    """explain sees the campaign with its sealed tables unread; they are opened by the validation alone."""
    file = tmp_path / "f.json"
    assert main(["explain", str(folder), "--open-sealed", "--json", str(file)]) == 0
    assert not any(e.is_open for e in explained["explained"].of_set("sealed"))
    assert explained["opened"] is explained["explained"]
    assert explained["order"] == ["opened after explain"]
    assert json.loads(file.read_text())["error"]["sealed"]["after"] == 1.1
    assert "sealed" in capsys.readouterr().out


def test_opening_where_nothing_is_sealed_is_said(tmp_path, explained, capsys):
    folder = write_campaign(tmp_path / "campaign")
    assert main(["explain", str(folder), "--open-sealed"]) == 0
    assert "no sealed experiments" in squeezed(capsys.readouterr().out)
    assert "opened" not in explained


def test_the_library_can_be_restricted(folder, explained, capsys):
    assert main(["explain", str(folder), "--effects", "sensor-offset, plasticity"]) == 0
    assert [e.name for e in explained["library"]] == ["sensor-offset", "plasticity"]
    assert main(["explain", str(folder), "--effects", "plastisity"]) == 2
    assert "plasticity" in capsys.readouterr().err


@pytest.mark.parametrize("verb", ["check", "compare"])
def test_towing_alone_is_read_and_run(verb, tmp_path, capsys):
    """A campaign of towing needs no bench: its friction is calibrated, and the effects of the trough can be tested."""
    rows = "id,kind,file,specimen,repeat_of,set\nw,towing,w.csv,S,,calibrate\n"
    for name, text in {"campaign.toml": TOWING, "experiments.csv": rows, "w.csv": TOWED}.items():
        (tmp_path / name).write_text(text)
    assert main([verb, str(tmp_path)]) == 0
    out = squeezed(capsys.readouterr().out)
    assert ("friction coefficient" if verb == "compare" else "viscous-drag") in out
    assert "[towing] gives no presliding; 0.3 mm is taken" in out or verb == "check"


def test_towing_without_a_clock_is_refused_in_a_sentence(tmp_path, capsys):
    rows = "id,kind,file,specimen,repeat_of,set\nw,towing,w.csv,S,,calibrate\n"
    table = "\n".join(line.split(",", 1)[1] for line in TOWED.splitlines()) + "\n"
    for name, text in {"campaign.toml": TOWING, "experiments.csv": rows, "w.csv": table}.items():
        (tmp_path / name).write_text(text)
    assert main(["explain", str(tmp_path)]) == 2
    err = squeezed(capsys.readouterr().err)
    assert "needs a clock" in err and "Traceback" not in err


def test_towing_among_bench_experiments_is_explained_with_them(folder, explained, tmp_path):
    (folder / "campaign.toml").write_text(TOWING)
    with (folder / "experiments.csv").open("a") as file:
        file.write("w,towing,w.csv,S,,calibrate,,,\n")
    (folder / "w.csv").write_text(TOWED)
    assert main(["explain", str(folder)]) == 0
    assert [e.kind for e in explained["explained"].experiments][-1] == "towing"
    assert explained["model"].towing.friction == 0.35


def test_finished_fits_are_kept_in_the_folder_of_the_report(folder, explained, tmp_path):
    """So that the same command goes on from there after a kill; without --out nothing is written."""
    assert main(["explain", str(folder), "--out", str(tmp_path / "out")]) == 0
    assert explained["store"] == tmp_path / "out" / "fits.jsonl"
    explained.clear()
    assert main(["explain", str(folder)]) == 0 and explained["store"] is None


def test_next_gives_the_experiment_and_its_probabilities(folder, explained, tmp_path, capsys):
    explained["verdict"] = "confusable"
    file = tmp_path / "n.json"
    assert main(["next", str(folder), "--json", str(file)]) == 0
    record = json.loads(file.read_text())
    assert record["next_experiment"]["p_wrong_after"] == 1e-4
    out = squeezed(capsys.readouterr().out)
    assert "axial tension [N] 4000" in out
    assert "with these data 0.5" in out and "after this experiment 0.0001" in out


def test_next_without_rivals_says_so(folder, explained, capsys):
    assert main(["next", str(folder)]) == 0
    assert "No rivals are left" in squeezed(capsys.readouterr().out)


def test_check_shows_what_was_recorded_and_what_it_can_show(folder, tmp_path, capsys, monkeypatch):
    made = types.ModuleType("compare.testability")
    made.check = lambda model, campaign, progress=None: made_check()
    monkeypatch.setitem(sys.modules, "compare.testability", made)
    file = tmp_path / "c.json"
    assert main(["check", str(folder), "--json", str(file)]) == 0
    out = squeezed(capsys.readouterr().out)
    assert "interlayer-friction plasticity 31 %" in out
    assert "stiffening plasticity" not in out, "pairs below 5 % are not listed"
    assert "axial tension [N] 500 2000 3" in out
    assert "thermal-softening: all experiments at 20 degC" in out and "vary together" in out
    record = json.loads(file.read_text())
    assert {"experiments", "noise", "separation", "untestable", "smallest_seen", "notes"} <= set(record)


def test_a_title_with_brackets_is_shown_as_it_is(folder, explained, capsys):
    toml = folder / "campaign.toml"
    toml.write_text(toml.read_text().replace("Bench tests", "[/bold] Bench [b]tests"))
    assert main(["compare", str(folder)]) == 0
    assert "[/bold] Bench [b]tests" in capsys.readouterr().out


def test_add_switches_an_effect_on_and_the_error_falls(folder, tmp_path, capsys):
    """The made loops are no more than half those of friction: the error falls on both sets, sealed ones stay closed."""
    file = tmp_path / "add.json"
    assert main(["add", str(folder), "interlayer-friction", "--json", str(file), "--out", str(tmp_path / "out")]) == 0
    record = json.loads(file.read_text())
    for name in ("calibrate", "validate"):
        assert record["error"][name]["after"] < 0.6 * record["error"][name]["before"]
    assert record["error"]["sealed"] is None
    assert any(name.startswith("interlayer-friction") for name in record["parameters"])
    assert {"before", "after"} == set(record["calibrated"])
    assert (tmp_path / "out" / "overview.png").is_file() and (tmp_path / "out" / "add.json").is_file()
    assert "interlayer-friction" in capsys.readouterr().out


def test_adding_what_is_not_in_the_library_is_a_sentence(folder, capsys):
    assert main(["add", str(folder), "interlayer-fricton"]) == 2
    assert "interlayer-friction" in capsys.readouterr().err


def test_check_of_a_real_folder_reads_everything_but_the_sealed_tables(folder, tmp_path):
    """Numbers of the campaign that the test wrote come back; the sealed rows show their list entry only."""
    file = tmp_path / "c.json"
    assert main(["check", str(folder), "--json", str(file)]) == 0
    record = json.loads(file.read_text())
    rows = {r["id"]: r for r in record["experiments"]}
    assert rows["b03a"]["largest"] == pytest.approx(1.6, rel=1e-3)
    assert rows["b05a"]["set"] == "sealed" and rows["b05a"]["rows"] is None
    assert record["noise"][0]["s"] == pytest.approx(0.4, rel=0.1)  # as the test drew it
    assert "thermal-softening" in [u["effect"] for u in record["untestable"]]
    assert "interlayer-friction" in record["separation"]["effects"]


def test_the_campaign_that_ships_has_no_missing_effect(tmp_path, capsys):
    """Nothing replaced: explain runs, says none, follows its schema and writes its page."""
    file, out = tmp_path / "f.json", tmp_path / "out"
    assert main(["explain", str(SHIPPED), "--json", str(file), "--out", str(out)]) == 0
    record = json.loads(file.read_text())
    assert record["verdict"] == "none" and record["effects"] == [] and record["smallest_seen"]
    assert record["error"]["calibrate"]["after"] < 1.2
    page = (out / "report.html").read_text(encoding="utf-8")
    assert "none: no missing effect found" in page and json.loads((out / "explain.json").read_text()) == record
    assert "Missing none" in squeezed(capsys.readouterr().out)
    jsonschema = pytest.importorskip("jsonschema")
    jsonschema.validate(record, explain_schema())


def test_opening_the_seal_of_a_real_folder_judges_the_fixed_model(folder, tmp_path):
    """Opening changes the error of the sealed set and nothing else that was found."""
    closed, opened = tmp_path / "closed.json", tmp_path / "opened.json"
    words = ["explain", str(folder), "--effects", "interlayer-friction,viscous-damping", "--json"]
    assert main([*words, str(closed)]) == 0
    assert main([*words, str(opened), "--open-sealed"]) == 0
    before, after = json.loads(closed.read_text()), json.loads(opened.read_text())
    assert before["error"]["sealed"] is None and after["error"]["sealed"]["after"] < after["error"]["sealed"]["before"]
    for key in ("verdict", "effects", "confusable", "ranking", "path", "parameters", "calibrated_with_effects"):
        assert before[key] == after[key], key
    assert after["sealed_opened"] is True and any("sealed experiments were opened" in n for n in after["notes"])
