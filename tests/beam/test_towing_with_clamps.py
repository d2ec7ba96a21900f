"""Towing with the clamps as bodies: balances, the movable pulley, contacts that open and close, buckling, what is kept."""

from functools import partial

import numpy as np
import pytest

from beam import published_section, read_scenario, tow
from beam.generalized_alpha import Integrator, StepSettings
from beam.statics import StaticSettings, equilibrium
from beam.towing_comparison import comparison
from beam.towing_model import towing_model
from beam.towing_record import write_contact_table
from geometry.errors import ConvergenceError

SHORT = {
    "cable__length": "6.4 m", "cable__elements": 40, "layout__upper_strand": "3.2 m", "layout__slack": "20 mm",
    "drive__speed": "0.4 m/s", "drive__ramp_start": "0 s", "drive__ramp_end": "0.4 s",
    "time__duration": "1.2 s", "time__frame": "40 ms",
}  # fmt: skip


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    scenario = read_scenario("intelligent-horizontal").changed(**SHORT)
    return tow(scenario, file=tmp_path_factory.mktemp("clamps") / "run.nc")


def test_energy_of_the_run_is_closed_with_bushings_and_links(run):
    """Stored + lost = work of the drives, the bushings' energies among them, to 1e-5 of the throughput."""
    assert run.status == "completed"
    energies = run.record()["energies"]
    assert abs(run.balance_error) < 1e-5
    assert energies["bushing_damping_loss"] > 0 and energies["friction_loss"] > 1.0
    stored = sum(energies[k] for k in ("kinetic", "elastic", "gravity", "contact", "bristle", "bushing"))
    lost = sum(v for k, v in energies.items() if k.endswith("loss"))
    assert stored + lost == pytest.approx(energies["drive_work"], abs=1e-3)


def test_momentum_of_cable_and_links():
    """Supports + contacts + weight = rate of the momentum of cable and links."""
    scenario = read_scenario("intelligent-horizontal").changed(**SHORT)
    model = towing_model(scenario, published_section(scenario), scenario.cable_inertia)
    rest = equilibrium(model)
    rest.outcome.require_success()
    motion = Integrator(model, rest.q, anchors=rest.anchors, settings=StepSettings(relative=1e-10, absolute=1e-6))
    assert motion.advance(20)
    n = model.rod.nodes
    total = motion.reaction[: model.moving, 0:3].sum(axis=0) + motion.forces.body_contact.sum(axis=0)
    total += model.weight[: model.moving, 0:3].sum(axis=0)
    masses = np.array([body.mass for body in model.bodies])
    a = motion.a
    lengths = model.rod.lengths[:, None]
    share = model.rod.mass_per_length * lengths
    # integral of the cubic Hermite function over an element
    cable = (share * (0.5 * (a[: n - 1, 0:3] + a[1:n, 0:3]) + lengths / 12 * (a[: n - 1, 3:6] - a[1:n, 3:6]))).sum(
        axis=0
    )
    links = masses @ a[n : model.moving, 0:3]
    assert abs(links[0]) > 0.5
    np.testing.assert_allclose(total, cable + links, rtol=0, atol=1e-3)  # the iteration stops at 1e-6 N a node


def test_bend_travels_at_half_the_speed(run):
    """Movable pulley: the first moment of an inextensible cable grows by u (L_up + pi R / 2 + u / 4) when its end moves by u."""
    scenario, x = run.scenario, run.dataset["position"].values[:, :, 0]
    u = x[-1, -1] - x[0, -1]
    step = scenario.cable.length.value / scenario.elements
    moment = step * (x.sum(axis=1) - 0.5 * (x[:, 0] + x[:, -1]))
    R, upper = scenario.layout.bend_radius.value, scenario.layout.upper_strand.value
    assert u == pytest.approx(0.4, abs=1e-9)
    assert moment[-1] - moment[0] == pytest.approx(u * (upper + np.pi * R / 2 + u / 4), rel=0.02)  # links are polygons
    lower = run.dataset["position"].sel(node=slice(40, 32)).values
    assert np.abs(lower[-1] - lower[0]).max() < 5e-3


def test_links_open_and_close_their_contacts(run):
    """Links come off the trough and onto the roller as the bend passes; the cable meets and leaves the walls of its gap."""
    data = run.dataset
    touching = np.linalg.norm(data["clamp_contact_force"].values, axis=2) > 1e-6
    assert (touching[-1] & ~touching[0]).any() and (~touching[-1] & touching[0]).any()
    pressed = data["clamp_cable_pressure"].values > 0
    assert (pressed[1:] & ~pressed[:-1]).any() and (~pressed[1:] & pressed[:-1]).any()


def test_pin_carries_what_the_cable_does_not(run):
    """Cut next to the shearer: pull = cable + both bushings of pin 1, where no mass is left; the chain pulls, too."""
    data = run.dataset
    chain = data["chain_force"].sel(pin=1).values[:, 0]
    cable = data["force_global"].sel(node=0).values[:, 0]
    np.testing.assert_allclose(chain + cable, data["pull_force"].values[:, 0], rtol=0, atol=0.5)
    assert chain.max() > 20.0
    along = data["bushing_force"].sel(direction="x").values
    pairs = along.reshape(len(along), -1, 2)
    np.testing.assert_allclose(pairs[..., 0], pairs[..., 1], rtol=0, atol=1e-6)  # nothing moves across


def test_contacts_of_the_links_add_up_by_surface(run):
    """Trough, deck and roller together push the links as link by link; friction obeys Coulomb; the roller is smooth."""
    data, mu = run.dataset, run.scenario.contact.friction.value
    by_surface, by_link = (data[name].values.sum(axis=1) for name in ("surface_force", "clamp_contact_force"))
    np.testing.assert_allclose(by_surface, by_link, rtol=0, atol=1e-8)
    normal, friction = (
        data[f"surface_{name}"].sel(surface=["trough", "deck"]).values for name in ("normal", "friction")
    )
    assert (friction <= mu * normal * (1 + 1e-9)).all() and friction.max() > 5.0
    np.testing.assert_allclose(normal, data["surface_force"].sel(surface=["trough", "deck"], axis="y"), rtol=1e-9)
    contacts = run.record()["contacts"]
    assert contacts["roller"]["friction_max"] == pytest.approx(0.0, abs=1e-9) and contacts["roller"]["normal_max"] > 10
    assert contacts["deck"]["slip_share_end"] > 0.5 and contacts["trough"]["gap_min"] < 0
    head, *rows = write_contact_table(data, run.frames.file.path.parent / "contacts.csv").read_text().splitlines()
    assert "deck friction [N]" in head and len(rows) == data.sizes["time"]


def test_tensioner_stands_in_the_supply_reaction():
    """Cylinder with constant force in place of the fixed end: what holds cable and chain there is its force."""
    scenario = read_scenario("intelligent-horizontal").changed(
        **SHORT | {"time__duration": "40 ms"}, drive__tensioner_force="200 N"
    )
    data = tow(scenario).dataset
    held = data["supply_reaction"].values[0, 0]
    last = data["chain_force"].sel(pin=data["pin"].values[0]).values[0, 0]
    assert held == pytest.approx(200.0, abs=1e-6)
    assert -held == pytest.approx(last + data["force_global"].sel(node=40).values[0, 0], abs=0.05)


def test_record_has_what_the_source_reports(run):
    """Bushing 3, contact 35 and the sideways displacement are numbers; similarity is 1 : 2.5 and two bushings a pin."""
    record = run.record()
    assert record["clamps"] == 39 and record["chain"] == "clamps"
    assert record["bushing_3_amplitude"] == np.abs(run.dataset["bushing_force"].sel(bushing=3, direction="x")).max()
    assert record["similarity"]["bushing_3_pair"] == pytest.approx(5 * record["bushing_3_amplitude"])
    assert set(record["contact_35"]) == {"max", "max_at", "begins", "ends"}
    assert np.isfinite(record["lateral_displacement_max"])
    rows = {row.key: row for row in comparison(record)}
    assert rows["node_54_Fx_plateau"].ratio == pytest.approx(record["nodes"]["54"]["Fx_plateau"] / 1300)
    assert rows["lateral_displacement_max"].ratio is None  # not reported for this condition


def test_run_with_bodies_that_was_stopped_goes_on_bit_by_bit(tmp_path):
    """The state of links and bushings is in the checkpoint: the file ends up with the same bytes."""
    path, whole = tmp_path / "run.nc", tmp_path / "whole.nc"
    scenario = read_scenario("intelligent-horizontal").changed(**SHORT | {"time__duration": "0.2 s"})
    tow(scenario, file=whole)

    def stop(fraction, sentence):
        if fraction > 0.4:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        tow(scenario, file=path, checkpoint_every=0.0, progress=stop)
    tow(scenario, file=path, resume=True)
    assert path.read_bytes() == whole.read_bytes()


def test_run_that_cannot_go_on_names_what_and_when_and_keeps_the_rest():
    """An impossible tolerance: the first instant is kept, the sentence says where and at which time."""
    scenario = read_scenario("intelligent-horizontal").changed(**SHORT)
    stopped = tow(scenario, settings=StepSettings(5e-3, relative=0.0, absolute=0.0, iterations=2))
    assert not stopped.outcome.completed and stopped.dataset.sizes["time"] == 1
    assert "at t = 0.0000 s" in stopped.status
    assert "body clamp" in stopped.status or "node" in stopped.status
    assert stopped.record()["notes"][0] == stopped.status


def test_play_in_the_pins_that_finds_no_equilibrium_is_a_sentence(monkeypatch):
    """A chain whose pins are loose is a mechanism: the sentence says which link, and which key to change."""
    few = partial(equilibrium, settings=StaticSettings(most_steps=3))
    monkeypatch.setattr("beam.towing.equilibrium", few)
    with pytest.raises(ConvergenceError, match=r"body clamp .*try clamps.pin_play = 0 mm"):
        tow(read_scenario("intelligent-horizontal").changed(**SHORT, clamps__pin_play="1 mm"))


def test_statics_that_does_not_arrive_names_the_link():
    """Three steps are not enough for a chain to settle: the sentence says how many, where, and how far off."""
    scenario = read_scenario("intelligent-horizontal").changed(**SHORT)
    model = towing_model(scenario, published_section(scenario), scenario.cable_inertia)
    rest = equilibrium(model, settings=StaticSettings(most_steps=3))
    assert not rest.outcome.completed
    assert "3 steps are used up" in str(rest.outcome) and "body clamp" in str(rest.outcome)


LONG = {
    "cable__length": "8 m", "cable__elements": 50, "layout__upper_strand": "4 m", "layout__inclination": "-50 deg",
    "clamps__K_b": "0 N m/rad", "clamps__K_x": "0.01 MN/m", "walls__clearance": "60 mm",
    "cable__clamp_mass_per_length": "40 kg/m",
}  # fmt: skip
SHORTER = {"cable__length": "6.4 m", "cable__elements": 40, "layout__upper_strand": "3.2 m"}


@pytest.fixture(scope="module")
def downhill():
    """Sideways place of the cable at rest, by the amplitude of its waves [mm]."""
    found = {}
    for amplitude in (0, 1, 2):
        scenario = read_scenario("intelligent-downward").changed(**LONG, disturbance__amplitude=f"{amplitude} mm")
        model = towing_model(scenario, published_section(scenario), scenario.cable_inertia)
        rest = equilibrium(model)
        rest.outcome.require_success()
        found[amplitude] = rest.q[: model.moving, 2]
    return found


def test_without_disturbance_nothing_moves_sideways(downhill):
    """Symmetry: no lateral cause, no lateral effect, also where the straight chain is unstable."""
    assert np.abs(downhill[0]).max() == 0.0


def test_a_small_disturbance_buckles_a_pushed_chain(downhill):
    """A heavy chain slides downhill and pushes: waves of 1 mm grow more than tenfold, and waves twice as high not twice as much."""
    one, two = (np.abs(downhill[amplitude]).max() for amplitude in (1, 2))
    assert 10e-3 < one < two < 1.8 * one
    assert two < 60e-3  # the walls


def test_side_walls_hold_the_chain():
    """With the walls at 15 mm such a chain lies against both, and the links feel it."""
    scenario = read_scenario("intelligent-downward").changed(
        **(LONG | SHORTER | {"walls__clearance": "15 mm"}), disturbance__amplitude="2 mm"
    )
    model = towing_model(scenario, published_section(scenario), scenario.cable_inertia)
    rest = equilibrium(model)
    rest.outcome.require_success()
    links = slice(model.rod.nodes, model.moving)
    assert 15e-3 < rest.q[links, 2].max() < 15.5e-3 and -15.5e-3 < rest.q[links, 2].min() < -15e-3
    assert np.abs(rest.forces.body_contact[:, 2]).max() > 1.0
