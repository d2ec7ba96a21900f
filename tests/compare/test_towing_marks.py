"""Marks of towing residuals: r = b + c sense + ..., what comes after reversals, goes with speed or tension, ripples, drifts."""

import numpy as np
import pytest
from made_towing import tow_campaign, towing_model

from compare import Campaign, compare
from compare.localisation import marks
from compare.towing_signature import after_reversals
from effects import find

ALIKE = ((0.35, 0.0, 800.0), (0.35, 10.0, 800.0), (0.3, 0.0, 800.0), (0.3, 10.0, 800.0))
"""Two inclinations, each at two speeds that hardly differ."""


def seen(folder, **made):
    """Marks by name, of the base model of a campaign."""
    campaign = Campaign.read(tow_campaign(folder, **made))
    return {m.name: m for m in marks(compare(towing_model(campaign), campaign), campaign)}


def acting(name, strength=(), shape=()):
    law = find(name).forms[0]
    return lambda cable: law.respond(cable, strength, *shape)


def test_noise_alone_leaves_no_mark(tmp_path):
    assert seen(tmp_path) == {}


def test_drag_is_seen_in_the_speed(tmp_path):
    """c L v at the towed end, less what the calibrated friction took of it; inside it is smaller."""
    found = seen(tmp_path, act=acting("viscous-drag", (6.0,)))
    mark, inside = found["speed (tension)"], found["speed (tension at 12)"]
    assert 0.3 * 6.0 * 30.0 < mark.value < 1.1 * 6.0 * 30.0 and mark.value > 3 * mark.std
    assert inside.value < mark.value and "grows with the speed" in mark.sentence


def test_play_is_seen_after_reversals(tmp_path):
    """The tension waits while the play is crossed: against the sense of the motion."""
    found = seen(tmp_path, act=acting("clamp-backlash", shape=(0.005,)), conditions=ALIKE)
    mark = found["after reversals (tension)"]
    assert mark.value < -3 * mark.std and "stays behind" in mark.sentence


def test_a_loss_in_the_bend_is_seen_over_the_tension_at_the_towed_end_alone(tmp_path):
    """It grows with the tension there; the station inside does not know of it."""
    found = seen(tmp_path, act=acting("roller-resistance", (0.05,)))
    mark = found["resistance over mean tension (tension)"]
    assert mark.value > 2 * mark.std and "rises with mean tension" in mark.sentence
    assert "resistance over mean tension (tension at 12)" not in found


def test_ripple_is_seen_at_its_travel(tmp_path):
    """The period of the pockets to 5 %; nothing of the kind in a drag."""
    slow = ((0.08, 10.0, 1600.0), (0.2, 0.0, 800.0), (0.12, 10.0, 1600.0))
    act = acting("polygon-effect", (0.06, 0.03), (0.07,))
    found = seen(tmp_path / "rippled", act=act, conditions=slow, duration=9.0)
    period = float(found["ripple (tension)"].sentence.split("period of ")[1].split(" m")[0])
    assert period == pytest.approx(0.07, rel=0.05)
    dragged = seen(tmp_path / "dragged", act=acting("viscous-drag", (6.0,)), conditions=slow, duration=9.0)
    assert dragged and not any(name.startswith("ripple") for name in dragged)


def test_drift_of_the_sensor_is_told_per_second(tmp_path):
    """2 N/s, in both channels."""
    found = seen(tmp_path, sensor=lambda t, y: y + 2.0 * t)
    assert found["drift (tension)"].value == pytest.approx(2.0, abs=3 * found["drift (tension)"].std)


def test_added_load_is_seen_in_the_inclination(tmp_path):
    """dm g L sin(10 degrees) at the towed end."""
    found = seen(tmp_path, act=acting("added-load", (0.5,)), conditions=ALIKE)
    mark = found["inclination (tension)"]
    assert mark.value == pytest.approx(0.5 * 9.81 * 30.0 * np.sin(np.radians(10.0)), rel=0.3)


def test_samples_after_reversals():
    """Forth, back, forth: the sense of the motion over a twentieth of the stroke."""
    p = np.concatenate([np.linspace(0, 1, 101), np.linspace(0.99, 0, 100), np.linspace(0.01, 1, 100)])
    found = after_reversals(p)
    assert not found[:101].any() and found[103] == -1.0 and found[203] == 1.0
    assert 3 <= np.count_nonzero(found == -1.0) <= 5 and 3 <= np.count_nonzero(found == 1.0) <= 5
