"""Effects of towing in a scenario of the rod: each change says there what the law says in a campaign."""

import math

import numpy as np
import pytest

from beam import read_scenario
from beam.axial_chain import AxialChain
from beam.towing_model import trough_law
from effects import find, library
from effects.effect import ActiveEffect
from effects.towed_cable import TowedCable
from effects.towed_scenario import changed_by

SCENARIO = read_scenario("intelligent-horizontal").changed(cable__elements=100)
TIME = np.linspace(0.0, 1.0, 11)
CHAIN = AxialChain(30.0, 4e5, 4.6, 0.22)
THERE_AND_BACK = {
    "time": ["0 s", "1 s", "4 s", "6 s", "9 s", "10 s"],
    "speed": ["0 m/s", "0.1 m/s", "0.1 m/s", "-0.1 m/s", "-0.1 m/s", "0 m/s"],
}


def active(name, strength=(), shape=(), form=0, kind="towing"):
    return ActiveEffect(find(name), find(name).forms[form], kind, shape=shape, strength=strength)


def carried(scenario, *effects, **calibrated):
    towed, acting, aside = changed_by(scenario, effects, {k.replace("_", " "): v for k, v in calibrated.items()})
    assert acting == effects and not aside and len(towed.notes) == len(effects)
    return towed.scenario


def refused(scenario, effect):
    towed, acting, aside = changed_by(scenario, [effect])
    assert not acting and towed.scenario == scenario and len(aside) == 1
    return aside[0]


def test_every_effect_of_towing_says_what_it_changes():
    for effect in library():
        for form in effect.forms:
            assert (form.scenario is not None) == (effect.kinds == ("towing",)), (effect.name, form.name)


def test_added_load_is_mass_per_length():
    loaded = carried(SCENARIO, active("added-load", (1.5,)))
    assert loaded.cable.clamp_mass_per_length.value == pytest.approx(6.0 + 1.5, rel=1e-12)
    all_of_it = carried(SCENARIO, active("added-load", (1.5,), (0.0, 40.0), form=1))
    assert all_of_it.cable == loaded.cable
    assert "from 2 to 5 m" in refused(SCENARIO, active("added-load", (1.5,), (2.0, 5.0), form=1))
    assert "outside what can be computed" in refused(SCENARIO, active("added-load", (-7.0,)))


@pytest.mark.parametrize("form", [0, 1, 2])
def test_friction_of_the_trough_falls_with_speed_as_that_of_the_chain(form):
    """mu(v) of trough and deck is the chain's at every speed, with the friction at high speed that was calibrated beside it."""
    effect = active("trough-friction-stribeck", (0.12,), (0.04,), form)
    chain = effect.form.respond(TowedCable(CHAIN, TIME, 0 * TIME), (0.12,), 0.04).chain
    law = trough_law(carried(SCENARIO, effect, friction_coefficient=0.22))
    for v in (0.0, 0.02, 0.04, 0.1, 1.0):
        assert law.coefficient(v) == pytest.approx(0.22 + chain.excess(v), rel=1e-12)
    assert trough_law(carried(SCENARIO, effect)).friction == 0.3  # that of the scenario, where nothing was calibrated
    assert "already" in refused(carried(SCENARIO, effect), effect)


def test_drag_of_the_trough_is_resistance_per_length_and_speed_beside_what_is_there():
    assert trough_law(carried(SCENARIO, active("viscous-drag", (5.0,)))).drag == pytest.approx(5.0, rel=1e-12)
    muddy = SCENARIO.changed(contact__drag="2 N s/m^2")
    assert trough_law(carried(muddy, active("viscous-drag", (5.0,)))).drag == pytest.approx(7.0, rel=1e-12)


def test_roller_resistance_is_a_capstan_of_the_same_loss():
    """exp(mu theta) - 1 = c, theta = pi under a deck of two radii; a second loss multiplies the first."""
    once = carried(SCENARIO, active("roller-resistance", (0.1,)))
    assert math.expm1(once.entries()["roller.friction"].value * math.pi) == pytest.approx(0.1, rel=1e-12)
    twice = carried(once, active("roller-resistance", (0.2,), form=1))
    assert math.exp(twice.entries()["roller.friction"].value * math.pi) == pytest.approx(1.1 * 1.2, rel=1e-12)
    low = SCENARIO.changed(layout__deck_height="0.5 m")
    angle = math.pi + math.acos((0.5 - 0.3 + 0.9) / 1.2)
    assert math.expm1(
        carried(low, active("roller-resistance", (0.1,))).entries()["roller.friction"].value * angle
    ) == pytest.approx(0.1)
    driven = SCENARIO.changed(roller__friction=0.2, roller__surface_speed="0.1 m/s")
    assert "the roller is driven" in refused(driven, active("roller-resistance", (0.1,)))


def test_ratio_error_multiplies_the_travel_of_the_trolley():
    """u_T = (1 + e) u_T, also beside an error that is there, and on a curve."""
    for scenario in (SCENARIO, SCENARIO.changed(drive__trolley_error=0.01, drive__curve=THERE_AND_BACK)):
        wrong = carried(scenario, active("trolley-ratio-error", (-0.02,)))
        for t in (3.0, 7.0):
            assert wrong.trolley(t)[0][0] == pytest.approx(0.98 * scenario.trolley(t)[0][0], rel=1e-12)
            assert wrong.pull(t)[0][0] == scenario.pull(t)[0][0]


@pytest.mark.parametrize(("form", "strength"), [(0, (0.05, -0.02)), (1, (0.05, -0.02, 0.01, 0.03))])
def test_polygon_effect_leads_the_trolley_as_it_leads_the_towed_end_of_a_campaign(form, strength):
    effect = active("polygon-effect", strength, (0.11,), form)
    rippled = carried(SCENARIO, effect)
    t = np.linspace(0.6, 9.0, 40)
    even = np.array([[part[0] for part in SCENARIO.trolley(x)] for x in t])
    cable = effect.form.respond(TowedCable(CHAIN, t, even[:, 0]), strength, 0.11)
    assert np.array([[p[0] for p in rippled.trolley(x)] for x in t]) == pytest.approx(
        cable.drives[0](t, even), rel=1e-12
    )
    assert rippled.pull(7.0)[0][0] == SCENARIO.pull(7.0)[0][0]
    assert "already" in refused(rippled, effect)


def test_backlash_is_dead_travel_at_every_reversal_of_the_shearer():
    """After the turn the towed end waits for the play b; the trolley does not. Centred, it waits for b/2 at the start."""
    turning = SCENARIO.changed(drive__curve=THERE_AND_BACK)
    late = carried(turning, active("clamp-backlash", shape=(0.05,)))
    assert late.pull(4.5)[0][0] == pytest.approx(turning.pull(4.5)[0][0], rel=1e-12)
    assert late.pull(9.0)[0][0] == pytest.approx(turning.pull(9.0)[0][0] + 0.05, rel=1e-12)
    assert late.trolley(9.0)[0][0] == turning.trolley(9.0)[0][0]
    centred = carried(SCENARIO, active("clamp-backlash", shape=(0.05,), form=1))
    assert centred.pull(9.0)[0][0] == pytest.approx(SCENARIO.pull(9.0)[0][0] - 0.025, rel=1e-12)
    assert "never turns back" in refused(SCENARIO, active("clamp-backlash", shape=(0.05,)))
    assert (
        carried(read_scenario("bending-machine"), active("clamp-backlash", shape=(0.05,))).entries()["drive.play"].value
        == 0.05
    )


def test_what_has_no_part_in_a_scenario_is_left_aside_by_name():
    for name in ("conventional-horizontal", "bending-machine"):
        scenario = read_scenario(name)
        for effect in (
            active("roller-resistance", (0.1,)), active("trolley-ratio-error", (0.01,)),
            active("polygon-effect", (0.1, 0.0), (0.1,)),
        ):  # fmt: skip
            assert refused(scenario, effect).startswith(
                f"{effect.effect.name} (towing): "
            ) and "has no trolley" in refused(scenario, effect)
    assert "acts in a sensor" in refused(SCENARIO, active("sensor-lag", shape=(0.2,)))
