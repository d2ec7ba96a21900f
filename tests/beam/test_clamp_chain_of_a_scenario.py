"""The clamp chain of a scenario: its geometry, its mass, the bushings of formula (21), and what it cannot be."""

import numpy as np
import pytest

from beam import published_section, read_scenario
from beam.bushing import GROUND, Bushing
from beam.contact_force import gap_and_normal
from beam.rod import GAUSS_X
from beam.towing_clamps import clamp_chain, link_middles
from beam.towing_model import mass_per_length, towing_model, towing_surfaces
from beam.towing_path import bend_pieces, chain_pins
from geometry.errors import SpecError

NAME = "intelligent-horizontal"
CONDITIONS = ("intelligent-horizontal", "intelligent-upward", "intelligent-downward", "conventional-horizontal")


@pytest.fixture(scope="module")
def scenario():
    return read_scenario(NAME)


@pytest.mark.parametrize("name", CONDITIONS)
def test_four_working_conditions_have_a_chain_of_sixty_links_and_400_elements(name):
    """What the source models: 400 nodes, and the number of links follows from pitch and length."""
    condition = read_scenario(name)
    chain = clamp_chain(condition, np.linspace(0, condition.cable.length.value, condition.elements + 1))
    assert condition.elements == 400 and condition.has_clamps and condition.clamps is not None
    assert len(chain.bodies) == len(link_middles(condition.cable.length.value, condition.clamps.pitch.value)) >= 60
    assert len(chain.bushings) == 2 * (len(chain.bodies) + 1) + len(chain.bodies)


def test_pins_on_a_bend_keep_the_pitch_and_the_length_of_the_cable():
    """R_p = p / (2 sin(p / 2R)): the distance of neighbouring pins is the pitch, with one link per pitch of cable."""
    radius, pitch = 0.3, 0.16
    pins, direction = chain_pins([(0.0, 0.0), (np.pi * radius, -1 / radius)], np.linspace(0.0, 5 * pitch, 6), pitch)
    np.testing.assert_allclose(np.linalg.norm(np.diff(pins, axis=0), axis=1), pitch, rtol=1e-12)
    np.testing.assert_allclose(np.diff(direction), -pitch / radius, rtol=1e-12)


@pytest.mark.parametrize("height", [0.08, 0.3, 0.6])
def test_free_bend_comes_down_to_the_deck(height):
    """Arc and counter arc end level, at the height of the deck."""
    from beam.shape import strands_and_arcs

    pieces = bend_pieces(0.3, height)
    end = strands_and_arcs(np.array([sum(length for length, _ in pieces)]), [*pieces, (1.0, 0.0)], angle=np.pi)[0]
    np.testing.assert_allclose(end[[1, 8]], [height, 0.0], rtol=0, atol=1e-12)


def test_chain_hangs_together_at_the_start(scenario):
    """The two sides of every pin meet within 2 mm, on the strands within round-off; the links weigh what the scenario says."""
    model = towing_model(scenario, published_section(scenario), scenario.cable_inertia)
    from beam.body_record import bushing_states

    apart = np.linalg.norm(bushing_states(model, 0.0, model.q0, 0 * model.q0).displacement[:200, :3], axis=1)
    assert apart.max() < 2e-3
    assert np.sort(apart)[: int(0.8 * apart.size)].max() < 1e-12
    links = sum(body.mass for body in model.bodies)
    total = mass_per_length(scenario, scenario.cable_inertia) * scenario.cable.length.value
    one = scenario.cable.clamp_mass_per_length.value * scenario.clamps.pitch.value
    assert links + model.rod.mass_per_length * scenario.cable.length.value == pytest.approx(total - one, rel=1e-12)


def test_bushings_and_links_are_counted_from_the_shearer(scenario):
    """Bushings 1, 2 join link 1 to the cable's end at the shearer; 3, 4 the links 2 and 1; the last two are at the supply."""
    chain = clamp_chain(scenario, np.linspace(0, 16, 401))
    found = {b.name: b for b in chain.bushings}
    assert (found["bushing 1"].first, found["bushing 1"].second) == ("clamp 1", -1)
    assert (found["bushing 3"].first, found["bushing 3"].second) == ("clamp 2", "clamp 1")
    assert (found["bushing 200"].first, found["bushing 200"].second) == (0, "clamp 99")
    assert chain.bodies[-1].name == "clamp 1"
    side = 0.5 * scenario.clamps.pin_width.value
    for name, bushing in found.items():
        if name.startswith("bushing"):  # odd numbers lie on the side of positive z
            z = side if int(name.split()[-1]) % 2 else -side
            assert np.asarray(bushing.first_point, float)[2] == np.asarray(bushing.second_point, float)[2] == z


def depth(surface, point, t=0.0):
    """How far a point is in a surface [m]."""
    return gap_and_normal(surface.parameters(t), *point)[0]


def test_walls_stand_at_the_clearance_from_the_links(scenario):
    """A link's edge in the middle of the trough is clear of both walls by walls.clearance; it enters the one it goes to."""
    chosen = read_scenario("intelligent-downward").changed(walls__clearance="40 mm", clamps__width="90 mm")
    walls = {s.name: s for s in towing_surfaces(chosen) if "wall" in s.name}
    assert len(walls) == 2
    left, right = walls["left wall"], walls["right wall"]
    for moved in (-0.05, 0.0, 0.05):
        edges = [(moved + side * 0.045) for side in (1, -1)]
        assert max(depth(left, (0, 0, z)) for z in edges) == pytest.approx(-0.04 - moved, abs=1e-12)
        assert max(depth(right, (0, 0, z)) for z in edges) == pytest.approx(-0.04 + moved, abs=1e-12)


def test_roller_and_deck_go_half_the_way_of_the_shearer(scenario):
    """Movable pulley: the axis of the roller and the edge of the deck move by half of what the shearer moves."""
    roller, deck = ({s.name: s for s in towing_surfaces(scenario)}[name] for name in ("roller", "deck"))
    way = scenario.pull(7.0)[0][0] - scenario.pull(0.0)[0][0]
    assert way > 0.5
    for surface, entry in ((roller, 10), (deck, 17)):
        moved = surface.parameters(7.0)[entry] - surface.parameters(0.0)[entry]
        assert moved == pytest.approx(0.5 * way, rel=1e-12)
    assert roller.parameters(7.0)[13] == pytest.approx(0.5 * scenario.pull(7.0)[1][0], rel=1e-12)


def test_disturbance_is_a_wave_across_the_trough():
    """z = A sin(k s): stress-free curvature A k^2 sin(k s) about the normal of the strand, and about no other axis."""
    wavy = read_scenario("conventional-horizontal").changed(
        cable__elements=100, disturbance__amplitude="4 mm", disturbance__wave_length="2 m"
    )
    straight = wavy.changed(disturbance__amplitude="0 mm")
    rods = [towing_model(one, published_section(one), one.cable_inertia).rod for one in (wavy, straight)]
    change = rods[0].E0 - rods[1].E0
    s = rods[0].s[:-1, None] + GAUSS_X * rods[0].lengths[:, None]
    np.testing.assert_allclose(change[:, :, 4], 4e-3 * np.pi**2 * np.sin(np.pi * s), rtol=0, atol=1e-12)
    assert np.abs(np.delete(change, 4, axis=2)).max() == 0.0


@pytest.mark.parametrize("direction", range(6))
def test_pin_follows_formula_21(scenario, direction):
    """F = -K x - C x' + F0 in each direction of a pin's bushing; about the pin it is free up to the stop."""
    chosen = scenario.changed(clamps__preload="30 N")
    pin = next(b for b in clamp_chain(chosen, np.linspace(0, 16, 401)).bushings if b.name == "bushing 3")
    c = chosen.clamps
    expected = [c.K_x, c.K_y, c.K_z, c.K_a, c.K_b, c.stop_stiffness][direction].value
    expected *= 0.5 if direction == 5 else 1.0
    from beam.bushing import bushing_law

    x, rate, force = np.zeros(6), np.zeros(6), np.zeros(6)
    stop = c.stop_angle.value if direction == 5 else 0.0
    x[direction], rate[direction] = stop + 0.05, 0.4
    bushing_law(pin.law, False, x, rate, force)
    time = c.bushing_damping_time.value
    edge = 0.5 * float(pin.law[5, 5]) if direction == 5 else 0.0
    pre = -30.0 if direction == 0 else 0.0
    assert force[direction] == pytest.approx(pre - expected * (0.05 - edge + time * 0.4), rel=1e-12)
    if direction == 5:
        x[5], rate[5] = 0.99 * stop, 5.0
        bushing_law(pin.law, False, x, rate, force)
        assert force[5] == 0.0


def test_cable_is_free_in_its_gap_and_pressed_beyond_it(scenario):
    """Contact of clamp and cable: no force within the gap, in any direction across; beyond it back to the middle."""
    from beam.bushing import bushing_law

    inside = clamp_chain(scenario, np.linspace(0, 16, 401)).bushings[-1]
    assert isinstance(inside, Bushing) and inside.first == "clamp 1" and GROUND not in (inside.first, inside.second)
    gap, slide = scenario.clamps.cable_gap.value, scenario.clamps.cable_slide.value
    force, across = np.zeros(6), np.array([0.0, 0.6, 0.8, 0, 0, 0])
    bushing_law(inside.law, inside.round_play, 0.999 * gap * across + [0.99 * slide, 0, 0, 0, 0, 0], np.zeros(6), force)
    np.testing.assert_array_equal(force, 0.0)
    bushing_law(inside.law, inside.round_play, (gap + 1e-3) * across, np.zeros(6), force)
    assert np.linalg.norm(force) > 100 and force @ across == pytest.approx(-np.linalg.norm(force), rel=1e-12)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"clamps__pitch": "0.3 m"}, "too few to go round it: make clamps.pitch at most 0.236 m"),
        ({"clamps__stop_angle": "25 deg"}, "cannot go round a radius of 0.3 m, which takes 29.9 deg a pin"),
        ({"clamps__contact_length": "200 mm"}, "longer than the pitch"),
        ({"cable__elements": 90}, "use at least 100 elements"),
        ({"cable__clamp_mass_per_length": "0 kg/m"}, "clamps without mass"),
        ({"element": "ancf-cable"}, 'or chain = "smeared"'),
        ({"towing": "bending-machine"}, "needs the table [machine]"),
        ({"layout__deck_height": "0.7 m"}, "higher than the bend"),
        ({"roller__friction": "0.2", "roller__inertia": "1 kg m^2"}, "bare cable only"),
        ({"clamps__pich": "1 m"}, "did you mean pitch"),
    ],
)
def test_chain_that_cannot_be_is_a_sentence(scenario, changes, words):
    """One line: the key, how much, what to try."""
    with pytest.raises(SpecError) as caught:
        scenario.changed(**changes)
    assert words in str(caught.value) and "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"machine__stroke": "5 m"}, "takes the whole lower strand"),
        ({"machine__stroke": "0.2 m"}, "too short to reach drive.speed"),
        ({"towing": "conventional"}, "belongs to towing"),
    ],
)
def test_machine_that_cannot_be_is_a_sentence(changes, words):
    """A stroke longer than the strand, one too short for its ramps, a plate where there is none."""
    with pytest.raises(SpecError, match=words.replace("[", r"\[")):
        read_scenario("bending-machine").changed(**changes)


def test_bend_that_runs_off_the_trough_is_a_sentence():
    """The same check with and without a roller, naming what runs off."""
    for name, what in (("intelligent-upward", "the roller travels"), ("conventional-horizontal", "the bend travels")):
        with pytest.raises(SpecError, match=what):
            read_scenario(name).changed(time__duration="135 s", layout__upper_strand="8.2 m")
