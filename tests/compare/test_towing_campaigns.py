"""Towing campaigns explained: every effect of the trough and the drive found again, nothing named where nothing is missing."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from made_towing import CONDITIONS, FRICTION, tow_campaign, towing_model

from compare import BenchModel, Campaign, compare, explain
from compare.towing_setup import TowingSetup
from effects import find, library
from geometry.errors import SpecError

TOWING = [e for e in library() if "towing" in e.kinds]

UNLIKE = CONDITIONS[::2]
"""Another speed, inclination and tail tension."""


def acting(name, strength=(), shape=(), form=0):
    law = find(name).forms[form]
    return lambda cable: law.respond(cable, strength, *shape)


def explained(folder, rivals, **made):
    campaign = Campaign.read(tow_campaign(folder, **made))
    return explain(towing_model(campaign), campaign, library=[find(n) for n in rivals.split()])


def test_friction_is_calibrated_as_the_stiffness_is_on_the_bench(tmp_path):
    """From a nominal 0.30 to the true 0.35, within two of its standard deviations, and nothing is left."""
    campaign = Campaign.read(tow_campaign(tmp_path, conditions=UNLIKE))
    found = compare(towing_model(campaign), campaign)
    value = found.calibration.values["friction coefficient"]
    assert value.nominal == 0.30 and abs(value.value - FRICTION) < 2 * value.std < 0.005
    assert found.relative_error("calibrate") == pytest.approx(1.0, abs=0.1)  # 480 samples of noise: 3 %
    nominal = found.relative_error("calibrate", before=True)
    assert nominal is not None and nominal > 5


def test_nothing_is_named_where_nothing_is_missing(tmp_path):
    rivals = "trough-friction-stribeck viscous-drag added-load roller-resistance sensor-offset"
    findings = explained(tmp_path, rivals, conditions=UNLIKE)
    assert findings.verdict == "none" and findings.effects == ()


TRUTHS = [
    ("trough-friction-stribeck", (0.06,), (0.1,), {"fall": 0.06, "fall speed": 0.1}, "viscous-drag roller-resistance"),
    ("viscous-drag", (6.0,), (), {"drag": 6.0}, "trough-friction-stribeck sensor-lag"),
    ("added-load", (0.5,), (), {"added mass": 0.5}, "viscous-drag sensor-offset"),
    ("roller-resistance", (0.05,), (), {"loss": 0.05}, "added-load viscous-drag"),
    ("clamp-backlash", (), (0.01,), {"play": 0.01}, "trolley-ratio-error viscous-drag"),
    ("trolley-ratio-error", (0.08,), (), {"ratio error": 0.08}, "added-load viscous-drag"),
]


@pytest.mark.parametrize(("name", "strength", "shape", "values", "rivals"), TRUTHS, ids=[t[0] for t in TRUTHS])
def test_effect_is_found_again_with_its_numbers(name, strength, shape, values, rivals, tmp_path):
    """Identified alone, its parameters within 3 std, the error at the noise floor."""
    findings = explained(tmp_path, f"{name} {rivals}", act=acting(name, strength, shape), conditions=UNLIKE)
    assert (findings.verdict, findings.effects) == ("identified", (name,))
    assert findings.errors["calibrate"].after < 1.1 < findings.errors["calibrate"].before
    for parameter, truth in values.items():
        found = findings.after.calibration.parameters[f"{name}: {parameter}"]
        assert abs(found.value - truth) < 3 * found.std + 1e-3 * abs(truth), parameter


def test_every_towing_effect_has_its_case():
    """No effect of towing goes without a test of its recovery."""
    assert {t[0] for t in TRUTHS} | {"polygon-effect"} == {e.name for e in TOWING if e.kinds == ("towing",)}


def test_polygon_effect_is_found_again(tmp_path):
    """Its pocket travel to 1 %, its ripple to a tenth."""
    findings = explained(
        tmp_path,
        "polygon-effect viscous-drag",
        act=acting("polygon-effect", (0.06, 0.03), (0.15,)),
        conditions=CONDITIONS[:2],
    )
    assert findings.effects == ("polygon-effect",)
    found = findings.after.calibration.parameters
    assert found["polygon-effect: pocket travel"].value == pytest.approx(0.15, rel=0.01)
    cosine, sine = (found[f"polygon-effect: {part} part"].value for part in ("cosine", "sine"))
    assert np.hypot(cosine, sine) == pytest.approx(np.hypot(0.06, 0.03), rel=0.1)


def test_sensor_lag_of_the_tension_is_your_sensor_not_your_cable(tmp_path):
    def late(t, y):
        return find("sensor-lag").forms[0].respond(y[:, None], t, 0.15)[:, 0]

    findings = explained(tmp_path, "sensor-lag viscous-drag", sensor=late, conditions=CONDITIONS[:2])
    assert findings.effects == ("sensor-lag",)


def test_added_load_and_an_offset_on_one_slow_incline_are_a_set_that_another_experiment_splits(tmp_path):
    """Weight on one incline is an offset, its friction goes into the coefficient: neither is named, and `next` changes the incline."""
    findings = explained(
        tmp_path, "added-load sensor-offset", act=acting("added-load", (0.25,)), noise=12.0,
        conditions=((0.02, 10.0, 800.0), (0.03, 10.0, 800.0)), stations=(), duration=9.0,
    )  # fmt: skip
    assert findings.verdict == "confusable" and set(findings.confusable) >= {"added-load", "sensor-offset"}
    assert findings.effects == ()
    proposed = findings.next_experiment
    assert (
        proposed is not None
        and proposed.kind == "towing"
        and set(proposed.conditions)
        == {
            "speed [m/s]",
            "inclination [deg]",
            "tail tension [N]",
        }
    )
    assert proposed.p_wrong_after < 0.05 < proposed.p_wrong_before


class Killed(BaseException):
    """What ends a run from outside."""


def test_a_killed_explanation_goes_on_from_what_it_had_fitted(tmp_path, monkeypatch):
    """The second run finds the fits of the first, does not do them again, and ends with the same findings."""
    from compare import search

    campaign = Campaign.read(tow_campaign(tmp_path / "c", acting("added-load", (0.5,)), conditions=CONDITIONS[:2]))
    model, store = towing_model(campaign), tmp_path / "fits.jsonl"
    rivals = [find(n) for n in ("added-load", "viscous-drag")]
    done = []
    plain = search.refine

    def counted(*given):
        done.append(given[1].effect.name)
        return plain(*given)

    monkeypatch.setattr(search, "refine", counted)

    def kill(_fraction, sentence):
        if sentence.startswith("looking for rivals"):
            raise Killed

    with pytest.raises(Killed):
        explain(model, campaign, progress=kill, library=rivals, store=store)
    first, lines = len(done), store.read_text().count("\n")
    assert first > 0 and lines > first
    done.clear()
    again = explain(model, campaign, library=rivals, store=store)
    second = len(done)
    done.clear()
    fresh = explain(model, campaign, library=rivals)
    assert second < len(done) - first + 1
    assert (again.verdict, again.effects) == (fresh.verdict, fresh.effects) == ("identified", ("added-load",))
    assert [(c.effect, c.log_e) for c in again.ranking] == [(c.effect, c.log_e) for c in fresh.ranking]


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda text: "\n".join(line.split(",", 1)[1] for line in text.splitlines()) + "\n", "needs a clock"),
        (
            lambda text: text.replace("tension at 12", "tension at 31"),
            "station lies outside the cable, which is 30 m long",
        ),
        (lambda text: text.replace("position [m]", "position [km]"), "the towed end jumps by"),
    ],
)
def test_bad_records_are_refused_in_a_sentence(change, words, tmp_path):
    folder = tow_campaign(tmp_path, conditions=CONDITIONS[:1])
    for name in ("e0a.csv", "e0b.csv"):
        (folder / name).write_text(change((folder / name).read_text()))
    campaign = Campaign.read(folder)
    with pytest.raises(SpecError, match=words):
        compare(towing_model(campaign), campaign)


def test_a_speed_is_integrated_and_sideways_motion_left_aside(tmp_path):
    """The same record told by its speed gives the same friction; lateral displacement is named in a note."""
    folder = tow_campaign(tmp_path, conditions=CONDITIONS[:1])
    friction = []
    for turn in range(2):
        campaign = Campaign.read(folder)
        found = compare(towing_model(campaign), campaign)
        friction.append(found.calibration.values["friction coefficient"].value)
        for name in ("e0a.csv", "e0b.csv"):
            table = np.loadtxt(folder / name, delimiter=",", skiprows=1)
            table[:, 1] = np.gradient(table[:, 1], table[:, 0], edge_order=2)
            header = "time [s],speed [m/s],tension [N],tension at 12 [N],lateral displacement at 5 [mm]"
            table = np.column_stack([table, np.zeros(len(table))])
            np.savetxt(folder / name, table, delimiter=",", header=header, comments="")
        assert turn == 0 or any("lateral displacement" in note for note in found.notes)
    assert friction[1] == pytest.approx(friction[0], rel=2e-3)  # differences of positions 0.1 s apart


def test_keys_that_are_missing_are_told_or_noted(tmp_path):
    folder = tow_campaign(tmp_path, conditions=CONDITIONS[:1])
    text = (folder / "campaign.toml").read_text()
    (folder / "campaign.toml").write_text(text.replace('EA = "4.0e5 N"\n', ""))
    with pytest.raises(SpecError, match=r"\[towing\]: EA is missing"):
        towing_model(Campaign.read(folder))
    (folder / "campaign.toml").write_text(text.replace("damping_ratio = 0.1\n", ""))
    towing = towing_model(Campaign.read(folder)).towing
    assert towing is not None and towing.notes == ("[towing] gives no damping_ratio; 0.1 is taken.",)


def test_the_columns_are_exact_where_they_are_fitted(tmp_path):
    """Z x at the fitted coefficients is the run there, to a hundredth of the noise, though friction makes it nonlinear."""
    from compare.bench_design import make_blocks
    from compare.search import Stage
    from compare.towing_design import TowingRecord

    campaign = Campaign.read(
        tow_campaign(tmp_path, acting("trough-friction-stribeck", (0.08,), (0.1,)), conditions=CONDITIONS[:2])
    )
    base = compare(towing_model(campaign), campaign)
    blocks = make_blocks(campaign.of_set("calibrate"), base.model, base.noise)
    stage = Stage(blocks, ((),), [find("trough-friction-stribeck")])
    fit = stage.plain()[0].trials[0].fit
    term = replace(fit.term, strength=(float(fit.strength[0]),))
    for record in blocks[0].records:
        assert isinstance(record, TowingRecord)
        run = record.response.run(record.experiment, float(fit.x[0]), (term,))
        offset = [a - b for a, b in zip(*record.response.base(record.experiment), strict=True)]
        for exact, o, Z in zip(run, offset, record.columns((fit.term,)), strict=True):
            assert np.sqrt(np.mean((exact - o - Z @ fit.x) ** 2)) < 0.05


EXAMPLE = Path(__file__).resolve().parents[3] / "shared" / "examples" / "towing-example"


@pytest.mark.skipif(not EXAMPLE.is_dir(), reason="the shared example is not here")
def test_the_shared_example_carries_a_load_on_a_part_of_its_length():
    """Truth: 1.228 kg/m more between 8.81 m and 33.37 m, friction 0.3551; made by a simulator that shares no code."""
    whole = Campaign.read(EXAMPLE)
    kept = tuple(e for e in whole.experiments if e.id in ("e05", "e06", "e09", "e10"))
    setup = TowingSetup.of(whole)
    assert setup is not None and whole.section is not None
    campaign = replace(whole, experiments=kept)
    findings = explain(
        BenchModel(whole.section, towing=setup), campaign, library=[find("added-load"), find("sensor-offset")]
    )
    assert findings.effects == ("added-load",)
    found = findings.after.calibration
    for name, truth in (("added mass", 1.228), ("begin", 8.81), ("end", 33.37)):
        value = found.parameters[f"added-load: {name}"]
        assert abs(value.value - truth) < 4 * value.std, name
    assert found.values["friction coefficient"].value == pytest.approx(0.3551, rel=0.01)
    assert findings.errors["calibrate"].after < 1.05
