"""Effects that were found on the bench go into the towing run: `helicable tow SCENARIO --effects explain.json`."""

import json
from pathlib import Path

import numpy as np
import pytest

from beam import read_scenario
from effects import find
from effects.effect import ActiveEffect, BenchPath
from effects.effect_record import active_effect, effect_record, read_effects
from geometry.errors import SpecError
from helicable.commands import tow as command
from helicable.found_effects import found_effects
from helicable.main import main

ROOT = Path(__file__).resolve().parents[2]
FRICTION = ActiveEffect(
    find("interlayer-friction"), find("interlayer-friction").forms[0], "bending", None, (0.3, 0.8), (0.5,),
    BenchPath("bending", np.zeros(0), largest=1.5, typical_tension=2000.0),
)  # fmt: skip
LAG = ActiveEffect(find("sensor-lag"), find("sensor-lag").forms[0], "bending", "moment", (0.2,))


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "explain.json"
    path.write_text(json.dumps({"schema": 1, "found": [effect_record(FRICTION), effect_record(LAG)]}))
    return path


def test_a_record_brings_the_effect_back(file):
    first, second = read_effects(file)
    assert (first.effect, first.form, first.shape, first.strength) == (
        FRICTION.effect,
        FRICTION.form,
        (0.3, 0.8),
        (0.5,),
    )
    assert (first.reference.largest, first.reference.typical_tension) == (1.5, 2000.0)
    assert second.channel == "moment"


def test_section_effects_reach_the_rod_and_the_change_is_shown(file, monkeypatch, capsys):
    """The run gets their law, the second run none; sensors are left aside by name."""
    laws = []

    class Made:
        status, outcome = "completed", type("Outcome", (), {"completed": True})

        def __init__(self, pull):
            self.pull = pull

        def record(self):
            return {"peak_tension": 2 * self.pull, "pull_force_plateau": self.pull}

    def run(scenario, section, progress=None, law=None, file=None, resume=False, settings=None):
        laws.append((law, section))
        return Made(1000.0 if law is None else 1100.0)

    monkeypatch.setattr(command, "run_towing", run)
    monkeypatch.setattr(command, "show_run", lambda run, used: None)
    assert main(["tow", "intelligent-horizontal", "--constants", "published", "--effects", str(file)]) == 0
    out = " ".join(capsys.readouterr().out.split())
    (law, section), (none, _) = laws
    assert none is None and law.section is section and [a.effect.name for a in law.active] == ["interlayer-friction"]
    assert "left aside: sensor-lag (bending): it acts in a sensor." in out
    assert "1000.0 N" in out and "1100.0 N" in out and "+10.00 %" in out


def short_scenario() -> str:
    """0.8 s of the built-in scenario with 100 elements."""
    text = (ROOT / "data" / "scenarios" / "intelligent-horizontal.toml").read_text(encoding="utf-8")
    for told, short in (
        ("{ value = 400,", "{ value = 100,"),
        ('"10 s", status = "assumed", range = ["6 s"', '"0.8 s", status = "assumed", range = ["0.5 s"'),
        ('"0.5 s", status = "assumed", range = ["0 s"', '"0 s", status = "assumed", range = ["0 s"'),
        ('"2.5 s", status = "assumed", range = ["1 s"', '"0.4 s", status = "assumed", range = ["0.2 s"'),
    ):
        assert text.count(told) == 1
        text = text.replace(told, short)
    return text


def test_damping_of_the_bench_raises_the_pull_of_the_rod(tmp_path):
    """A cable that resists bending at a rate takes work at the roller: end to end, from the file of the findings to the pull."""
    scenario, found, out = tmp_path / "short.toml", tmp_path / "found.json", tmp_path / "tow.json"
    scenario.write_text(short_scenario(), encoding="utf-8")
    damping = find("viscous-damping")
    active = ActiveEffect(damping, damping.forms[0], "bending", strength=(1.0,))
    found.write_text(json.dumps({"schema": 1, "found": [effect_record(active)]}))
    words = [
        "tow",
        str(scenario),
        "--constants",
        "published",
        "--chain",
        "smeared",
        "--effects",
        str(found),
        "--json",
        str(out),
    ]
    assert main(words) == 0
    record = json.loads(out.read_text())
    assert record["status"] == "completed"
    without = record["without_effects"]["pull_force_plateau"]
    assert record["pull_force_plateau"] > 1.01 * without  # the peak, a wave of the start, is damped instead


def test_bench_and_face_act_together_in_one_command(tmp_path, capsys):
    """A law of the section, a drag and a mass: each is told, and the pull rises by a part of drag x speed x length.

    The rest goes off the tension at the bend: the taut cable is held between two ends whose motion is given.
    """
    drag, load, polygon = (find(name) for name in ("viscous-drag", "added-load", "polygon-effect"))
    towing = [
        ActiveEffect(drag, drag.forms[0], "towing", strength=(200.0,)),
        ActiveEffect(load, load.forms[0], "towing", strength=(2.0,)),
        ActiveEffect(load, load.forms[1], "towing", shape=(1.0, 3.0), strength=(2.0,)),
        ActiveEffect(polygon, polygon.forms[0], "towing", shape=(0.1,), strength=(0.05, 0.02)),
        ActiveEffect(find("sensor-drift"), find("sensor-drift").forms[0], "towing", "tension", (), (0.1,)),
    ]
    damping = find("viscous-damping")
    bench = [ActiveEffect(damping, damping.forms[0], "bending", strength=(0.01,))]
    scenario, lab, face, out = (tmp_path / name for name in ("short.toml", "lab.json", "face.json", "tow.json"))
    scenario.write_text(short_scenario(), encoding="utf-8")
    for path, found in ((lab, bench), (face, towing)):
        path.write_text(json.dumps({"schema": 1, "found": [effect_record(e) for e in found]}))
    words = ["tow", str(scenario), "--constants", "published", "--chain", "smeared", "--json", str(out)]
    assert main([*words, "--effects", str(lab), "--effects", str(face)]) == 0
    said, record = " ".join(capsys.readouterr().out.split()), json.loads(out.read_text())
    assert "What viscous-damping, viscous-drag, added-load, polygon-effect changes without with change" in said
    assert (
        "cable.clamp_mass_per_length 6 -> 8 kg/m" in said
        and "left aside: added-load (towing): the load lies from 1" in said
    )
    assert len(record["effects"]["changes"]) == 3 and len(record["effects"]["aside"]) == 2
    rise = record["pull_force_plateau"] - record["without_effects"]["pull_force_plateau"]
    assert 0.5 < rise / (200.0 * 6.86 / 60 * 7.4) < 1.0  # drag x speed x upper strand


def test_what_cannot_act_in_a_rod_is_refused_in_a_sentence(file, tmp_path):
    other = tmp_path / "other.json"
    for text, words in (
        (
            json.dumps({"found": [effect_record(LAG)]}),
            r"none of the effects that were found \(sensor-lag \(bending\): it acts in a sensor\)",
        ),
        ("{}", "this is not the JSON of `helicable explain`"),
        (json.dumps({"found": [{**effect_record(FRICTION), "form": "older"}]}), 'no form "older"'),
    ):
        other.write_text(text)
        with pytest.raises(SpecError, match=words):
            found_effects([other]).into(read_scenario("intelligent-horizontal"))
    with pytest.raises(SpecError, match="cannot be read"):
        found_effects([tmp_path / "none.json"])
    with pytest.raises(SpecError, match="no record of an effect"):
        active_effect({"effect": "plasticity"})
