"""What a contact reports: gap, normal force, friction and slip, against weight, Coulomb's law and geometry."""

import csv

import numpy as np
import pytest

from beam import read_scenario, tow
from beam.benchmark_friction import MU, WEIGHT, cable_on_floor
from beam.contact_state import contact_states
from beam.generalized_alpha import Integrator, StepSettings
from beam.rod_model import RodModel
from beam.shape import straight
from beam.statics import equilibrium
from beam.surface import ContactLaw, Cylinder, Plane
from beam.towing_record import contact_record, write_contact_table
from geometry.errors import InputError


@pytest.fixture(scope="module")
def short_run():
    scenario = read_scenario("intelligent-horizontal").changed(
        cable__length="4 m", cable__elements=24, layout__upper_strand="1.4 m", layout__slack="20 mm", time__duration="0.4 s",
        drive__ramp_start="0 s", drive__ramp_end="0.3 s",
    )  # fmt: skip
    return tow(scenario)


def on_slope(slope: float, steps: int = 200) -> Integrator:
    model = cable_on_floor(4, [], length=2.0, slope=slope, bristle_ratio=0.5)
    motion = Integrator(model, model.q0, settings=StepSettings(5e-3, absolute=1e-7))
    assert motion.advance(steps)
    return motion


def test_a_resting_cable_presses_with_its_weight():
    """N = w L, shared by length; gap = -w / k_n; no friction, nothing slips."""
    model = cable_on_floor(4, [], length=2.0)
    rest = equilibrium(model)
    (floor,) = contact_states(model, 0.0, rest.q, 0 * rest.q, rest.anchors)
    np.testing.assert_allclose(floor.normal.sum(axis=1), WEIGHT * 0.5, rtol=1e-6)
    np.testing.assert_allclose(floor.gap, -WEIGHT / 1.25e6, rtol=1e-6)
    np.testing.assert_allclose(floor.force.sum(axis=(0, 1)), [0, WEIGHT * 2.0, 0], rtol=1e-6, atol=1e-6)
    assert floor.friction.max() < 1e-9 and floor.slip_share == 0.0


def test_below_the_friction_angle_it_sticks():
    """T = w L sin, use = tan / mu, slip share 0."""
    slope = 0.25
    (floor,) = on_slope(slope, 600).contacts
    assert floor.friction.sum() == pytest.approx(WEIGHT * 2.0 * np.sin(slope), rel=1e-4)
    np.testing.assert_allclose(floor.use, np.tan(slope) / MU, rtol=1e-3)
    assert floor.slip_share == 0.0 and not floor.slips.any() and floor.touching.all()


def test_above_it_every_point_slips():
    """T = mu N, uphill; slip share 1."""
    (floor,) = on_slope(0.35).contacts
    np.testing.assert_allclose(floor.friction, MU * floor.normal, rtol=1e-9)
    assert floor.force[..., 0].min() > 0  # gravity pulls to -x
    assert floor.slip_share == 1.0 and floor.slips.all()
    assert floor.normal.sum() == pytest.approx(WEIGHT * 2.0 * np.cos(0.35), rel=1e-4)


def test_gap_of_what_does_not_touch():
    """Distance from a cylinder and a plane; NaN beyond a plane's extent, and no slip share without contact."""
    base = cable_on_floor(4, [], length=2.0)
    law = ContactLaw()
    surfaces = [
        Cylinder("roller", law, (1.0, -0.5, 0.0), 0.3),
        Plane("floor", law, offset=-0.1),
        Plane("deck", law, offset=-0.2, low=(1.0, -1.0, -1.0)),
    ]
    model = RodModel(base.rod, straight(base.rod.s), surfaces=surfaces)
    roller, floor, deck = contact_states(model, 0.0, model.q0, 0 * model.q0, model.fresh_anchors())
    np.testing.assert_allclose(floor.gap, 0.1, rtol=1e-12)
    assert roller.smallest_gap == pytest.approx(0.2, abs=2e-3)  # the nearest contact point is 15 mm beside the top
    assert np.isnan(deck.element_gap[:2]).all() and np.allclose(deck.element_gap[2:], 0.2)
    assert np.isnan(roller.slip_share) and np.isnan(floor.element_slip).all() and floor.use.max() == 0


def check_record(data):
    """Elements add up to surfaces, surfaces to the nodal contact forces; friction stays inside its cone."""
    by_element, by_surface = data["contact_normal"].values, data["surface_normal"].values
    np.testing.assert_allclose(by_element.sum(axis=1), by_surface, rtol=1e-12, atol=1e-9)
    force = data["surface_force"].values.sum(axis=1)
    np.testing.assert_allclose(force, data["contact_force"].values.sum(axis=1), rtol=0, atol=1e-8 * by_surface.max())
    mu = np.array([0.3, 0.3, 0.0])
    assert (data["surface_friction"].values <= mu * by_surface * (1 + 1e-12)).all()
    gaps = data["contact_gap"].values
    np.testing.assert_array_equal(np.nanmin(gaps, axis=1), data["surface_gap"].values)
    carries = by_element > 0
    assert (gaps[carries] < 0).all() and np.isfinite(data["contact_slip"].values[carries]).all()


def test_tables_of_a_run(short_run, tmp_path):
    """The record adds up; JSON and CSV hold its numbers; a place that cannot be written is a sentence."""
    data = short_run.dataset
    check_record(data)
    record = contact_record(data)
    assert set(record) == {"trough", "deck", "roller"} and record["roller"]["friction_max"] == 0
    assert record["trough"]["normal_end"] == float(data["surface_normal"].sel(surface="trough")[-1]) > 0
    assert record["deck"]["slip_share_end"] is None  # the short taut cable hangs free of it
    path = write_contact_table(data, tmp_path / "contacts.csv")
    rows = list(csv.DictReader(path.open()))
    assert len(rows) == data.sizes["time"]
    assert float(rows[-1]["trough friction [N]"]) == pytest.approx(record["trough"]["friction_end"], rel=1e-8)
    with pytest.raises(InputError, match="contacts cannot be written there"):
        write_contact_table(data, tmp_path / "missing" / "contacts.csv")
