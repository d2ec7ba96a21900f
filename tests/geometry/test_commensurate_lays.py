"""Layers whose turns relative to the cell's motion are whole parts of their symmetry have one period: omega H = 2 pi k / fold."""

import itertools
import re
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.optimize import minimize_scalar

from geometry import read_cable
from geometry.bent_lay import lay_rate, relative_turn_rate
from geometry.common_period import cell_of, common_period
from geometry.errors import GeometryError
from geometry.helix import Helix
from geometry.matched_lay import LayeredLay
from geometry.nested_helix import nested_helix
from geometry.period_search import ECONOMY
from geometry.strand import stranded_conductor

DEGREE = float(np.radians(1))
FEW = settings(max_examples=15, deadline=None)


def by_angle(name, radius, degrees, fold, hand="Z"):
    return LayeredLay(name, radius, 2 * np.pi * radius / np.tan(degrees * DEGREE), hand, fold)


THREE_CORE_CABLE = [
    by_angle("cores", 17.667e-3, 9.0, 3),
    by_angle("inner armour", 39.467e-3, 20.1, 55, "S"),
    by_angle("outer armour", 44.067e-3, 19.6, 63),
]
"""Menard and Cartraud, Marine Structures 91 (2023) 103465: nominal lay angles."""

LAYERS = st.builds(
    lambda r, angle, hand, n: by_angle(f"{n} at {r}", r, angle, n, hand),
    st.floats(0.005, 0.05),
    st.floats(4.0, 30.0),
    st.sampled_from("ZS"),
    st.integers(2, 40),
)


@pytest.fixture(scope="module")
def reference():
    return read_cable("mcpt-1.9-3.3-3x35")


def mirrored(layer):
    return replace(layer, hand="S" if layer.hand == "Z" else "Z")


def test_three_core_sea_cable_at_its_published_period():
    """l = k p / n with l = 234.2 mm and (k, n) = (1, 3), (19, 55), (19, 63), printed to 0.01 mm and 0.001 deg."""
    cell = common_period(THREE_CORE_CABLE, height=0.2342)
    assert [layer.turns for layer in cell.layers] == [1, -19, 19]
    assert [1e3 * layer.lay for layer in cell.layers] == pytest.approx([702.60, 677.95, 776.56], abs=0.005)
    angles = [np.degrees(layer.lay_angle) for layer in cell.layers]
    assert angles == pytest.approx([8.978, 20.091, 19.624], abs=0.0005)
    changes = [np.degrees(layer.change) for layer in cell.layers]
    assert changes == pytest.approx([-0.022, -0.009, 0.024], abs=0.0006)


def test_three_core_sea_cable_found_from_its_nominal_angles():
    """The search finds (1, 19, 19) and a height that needs no larger change than the published one."""
    published = common_period(THREE_CORE_CABLE, height=0.2342)
    cell = common_period(THREE_CORE_CABLE)
    assert [layer.turns for layer in cell.layers] == [1, -19, 19]
    assert cell.height == pytest.approx(0.2342, rel=1e-3)
    assert cell.largest_change <= published.largest_change
    second, first = sorted(abs(layer.change) for layer in cell.layers)[-2:]
    assert first == pytest.approx(second, rel=1e-6)  # at the best height two layers share the largest change


def test_reference_cable(reference):
    """Three straight earth strands repeat every 234/3 = 78 mm; the power lay goes from 127 to 125.4 mm, two sixths of a turn."""
    cell = cell_of(reference)
    assert cell.height == pytest.approx(0.078, rel=1e-12)
    assert cell.twist_rate == reference.twist_rate
    earth, power = cell.layer("earth"), cell.layer("power")
    assert len(cell.layers) == 2  # three power cores count once, the control conductor is one cylinder
    assert (earth.turns, earth.fold, earth.lay, earth.change) == (-1, 3, None, 0.0)
    assert (power.turns, power.fold) == (2, 6)
    assert power.lay == pytest.approx(125.416e-3, abs=1e-6)
    assert np.degrees(power.change) == pytest.approx(0.1056, abs=1e-4)


def test_the_motion_of_the_cell_carries_every_strand_to_a_strand(reference):
    """Points of all strands at z, turned by tau H and raised by H, lie on strands: the definition of a period."""
    cell = cell_of(reference)
    H, angle = cell.height, cell.twist_rate * cell.height
    Q = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
    z = np.array([0.0, 0.01, 0.02, H, H + 0.01, H + 0.02])
    for name, radius in (("power", reference.pitch_circle_radius), ("earth", 0.0)):
        layer = cell.layer(name, radius)
        core = Helix(radius, reference.lay, reference.hand)
        level = [
            Helix(layer.nominal.radius, layer.lay or 1e9, layer.hand, 2 * np.pi * j / layer.fold + 0.2)
            for j in range(layer.fold)
        ]
        lines = [nested_helix([core, strand], z).points for strand in level]
        for j, line in enumerate(lines):
            partner = lines[(j + layer.turns) % layer.fold]
            # after the motion a strand goes on as the one that is `turns` places behind it
            np.testing.assert_allclose(partner[:3] @ Q.T + [0, 0, H], line[3:], atol=1e-8)


@FEW
@given(layers=st.lists(LAYERS, min_size=1, max_size=3), twist=st.sampled_from([0.0, 5.0, -12.0]))
def test_matched_layers_fulfil_the_condition(layers, twist):
    """omega H fold / 2 pi is whole for the adjusted lays, no change is above the tolerance, the hand stays."""
    cell = common_period(layers, twist_rate=twist, tolerance=DEGREE, longest=20.0)
    assert 0 < cell.height <= 20.0
    for layer, nominal in zip(cell.layers, layers):
        turns = relative_turn_rate(0.0, twist, layer.lay, layer.hand) * cell.height * layer.fold / (2 * np.pi)
        assert turns == pytest.approx(layer.turns, abs=1e-6)
        assert layer.lay_angle - nominal.lay_angle == pytest.approx(layer.change, abs=1e-9)
        assert abs(layer.change) <= DEGREE * (1 + 1e-9)
        assert layer.hand == nominal.hand


@FEW
@given(st.tuples(LAYERS, LAYERS), st.sampled_from([0.0, 7.0]))
def test_the_rule_of_choice_against_enumeration(layers, twist):
    """All pairs of turns, each with its best height by direct minimisation; the shortest within tolerance, then ECONOMY."""
    tolerance = 0.4 * DEGREE
    cell = common_period(layers, twist_rate=twist, tolerance=tolerance, longest=20.0)
    longest = ECONOMY * cell.height
    rates = [relative_turn_rate(0.0, twist, layer.lay, layer.hand) for layer in layers]
    ends = [
        (1 if n.hand == "Z" else -1) * np.tan(n.lay_angle + e * tolerance) / n.radius - twist
        for n in layers
        for e in (-1, 1)
    ]
    assume(all(a * b > 0 for a, b in zip(ends[::2], ends[1::2])))  # else no turn at all (k = 0) is within the tolerance
    found = []
    tops = [int(np.ceil(abs(w) * longest * n.fold / (2 * np.pi))) + 1 for w, n in zip(rates, layers)]
    assume(tops[0] * tops[1] < 400)
    for turns in itertools.product(*(range(1, top + 1) for top in tops)):
        starts = [2 * np.pi * k / (n.fold * abs(w)) for k, w, n in zip(turns, rates, layers)]
        if max(starts) > 4 * min(starts):  # far beyond what the tolerance can bring together
            continue

        def change(height, turns=turns):
            own = [np.sign(w) * 2 * np.pi * k / (n.fold * height) + twist for k, w, n in zip(turns, rates, layers)]
            sign = [1 if n.hand == "Z" else -1 for n in layers]
            return max(abs(np.arctan(s * w * n.radius) - n.lay_angle) for s, w, n in zip(sign, own, layers))

        best = minimize_scalar(change, bounds=(min(starts), max(starts) + 1e-12), options={"xatol": 1e-9 * min(starts)})
        if best.fun < tolerance * (1 - 1e-4):
            found.append((best.x, best.fun))
    shortest = min(height for height, _ in found)
    assert cell.height <= ECONOMY * shortest * (1 + 1e-6)
    least = min(change for height, change in found if height < ECONOMY * shortest * (1 - 1e-6))
    assert cell.largest_change <= least + 1e-6


@FEW
@given(layers=st.lists(LAYERS, min_size=1, max_size=3), twist=st.sampled_from([0.0, 5.0]))
def test_mirror_image(layers, twist):
    """All hands reversed: the same height and changes, turns of the other sign."""
    one = common_period(layers, twist_rate=twist, tolerance=DEGREE, longest=20.0)
    other = common_period([mirrored(layer) for layer in layers], twist_rate=-twist, tolerance=DEGREE, longest=20.0)
    assert other.height == pytest.approx(one.height, rel=1e-9)
    assert [layer.turns for layer in other.layers] == [-layer.turns for layer in one.layers]
    assert [layer.change for layer in other.layers] == pytest.approx([layer.change for layer in one.layers], abs=1e-9)


@pytest.mark.parametrize(("tolerance", "turns"), [(0.7, [2, 3]), (0.4, [3, 4]), (0.15, [5, 7])])
def test_longer_periods_with_less_change_are_not_sought_for_ever(tolerance, turns):
    """Spacings of 10 and 7.2 mm meet roughly at 20, better at 30, well at 50 mm: the shortest within the tolerance is taken."""
    layers = [
        LayeredLay(f"{n}", np.tan(15 * DEGREE) * p / (2 * np.pi), p, "Z", n) for n, p in ((30, 0.300), (40, 0.288))
    ]
    cell = common_period(layers, tolerance=tolerance * DEGREE)
    assert [layer.turns for layer in cell.layers] == turns


def test_symmetry_of_a_conductor_of_several_layers(reference):
    """6 and 12 strands of one lay come to stand as before after a sixth of a turn; the centre strand asks for nothing."""
    strand = reference.conductors["power"].strand
    conductors = {**reference.conductors, "power": stranded_conductor("power", strand, (1, 6, 12), 0.2, "Z", None)}
    power = cell_of(replace(reference, conductors=conductors)).layer("power")
    assert power.fold == 6
    assert power.nominal.radius == pytest.approx(2 * strand.diameter)


def test_one_layer_needs_no_adjustment():
    """l = p / n, the slice of a single lay."""
    cell = common_period([by_angle("wires", 0.01, 15.0, 6)])
    assert cell.height == pytest.approx(cell.layers[0].nominal.lay / 6, rel=1e-12)
    assert cell.largest_change == pytest.approx(0.0, abs=1e-12)


def test_a_motion_that_follows_a_layer():
    """Relative rotation counts: the layer that is followed keeps its lay, and never asks for a period of its own."""
    cell = common_period(THREE_CORE_CABLE, reference="cores")
    cores, *armour = cell.layers
    assert (cores.turns, cores.change) == (0, 0.0)
    assert cell.twist_rate == pytest.approx(2 * np.pi / cores.nominal.lay)
    for layer in armour:
        omega = lay_rate(layer.lay, layer.hand) - cell.twist_rate
        assert omega * cell.height * layer.fold == pytest.approx(2 * np.pi * layer.turns, abs=1e-8)
    assert common_period(THREE_CORE_CABLE[:1], reference="cores") is None


def test_every_height_will_do_where_nothing_turns(reference):
    """No layers; straight members in a straight cable; strands that do not turn relative to their core; no strands modelled."""
    assert common_period([]) is None
    assert common_period([LayeredLay("straight", 1e-3, None, "Z", 6)]) is None
    core = Helix(11.625e-3, 0.234)
    still = LayeredLay("still", 3e-3, 2 * np.pi / core.torsion, "Z", 6, core.radius)
    assert common_period([still], twist_rate=core.turn_rate) is None
    assert cell_of(read_cable("example-three-core")) is None


def test_a_straight_cable_with_laid_strands(reference):
    """The conductors alone set the period: the lay over the number of strands; straight earth strands ask for nothing."""
    straight = replace(reference, lay=None)
    cell = cell_of(straight)
    assert cell.height == pytest.approx(0.127 / 6, rel=1e-12)
    assert cell.layer("earth").turns == 0
    assert cell.largest_change == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("hand", ["Z", "S"])
def test_left_handed_strands_in_a_right_handed_cable(reference, hand):
    """Opposite lay turns faster against the core: more turns in the same period; the mirror image of the cable likewise."""
    conductors = {**reference.conductors, "power": replace(reference.conductors["power"], hand=hand)}
    cell = cell_of(replace(reference, conductors=conductors))
    other = {name: replace(c, hand="S" if c.hand == "Z" else "Z") for name, c in conductors.items()}
    image = cell_of(replace(reference, conductors=other, hand="S"))
    assert cell.height == pytest.approx(0.078, rel=1e-12)
    assert cell.layer("power").turns == {"Z": 2, "S": -6}[hand]
    assert image.height == pytest.approx(cell.height)
    assert image.layer("power").turns == -cell.layer("power").turns
    assert image.layer("power").change == pytest.approx(cell.layer("power").change, abs=1e-12)


def test_straight_strands_bend_to_the_period_only_if_they_must(reference):
    """At a tolerance of 0.05 deg they are given a lay of metres, so that both conductors change by the same angle."""
    cell = cell_of(reference, tolerance=0.05 * DEGREE)
    earth, power = cell.layer("earth"), cell.layer("power")
    assert earth.lay > 10.0
    assert earth.change == pytest.approx(abs(power.change), rel=1e-6)
    assert cell.largest_change < 0.05 * DEGREE


def test_refusal_names_the_layer_and_what_would_do():
    """Following the advice, either the longer period or the larger tolerance, gives a period."""
    with pytest.raises(GeometryError) as refused:
        common_period(THREE_CORE_CABLE, tolerance=0.02 * DEGREE)
    sentence = str(refused.value)
    assert re.search(
        r"lay angle of \S+( armour)? would change by [+-]0\.02\d deg \(lay from [\d.]+ mm to [\d.]+ mm\)", sentence
    )
    period, tolerance = map(
        float, re.search(r"period of ([\d.]+) mm, or a tolerance of ([\d.]+) deg", sentence).groups()
    )
    assert common_period(THREE_CORE_CABLE, tolerance=0.02 * DEGREE, longest=1e-3 * period).height <= 1e-3 * period
    assert common_period(THREE_CORE_CABLE, tolerance=tolerance * DEGREE).height < 0.3
    with pytest.raises(GeometryError) as short:
        common_period(THREE_CORE_CABLE, longest=0.2)
    period = 1e-3 * float(re.search(r"period of ([\d.]+) mm", str(short.value)).group(1))
    assert common_period(THREE_CORE_CABLE, longest=period).height <= period


def test_refusals_of_the_reference_cable(reference):
    with pytest.raises(
        GeometryError, match=r"earth would change by \+1\.500 deg .*allow a period of 78.* mm, or a tolerance of 1\.5"
    ):
        cell_of(reference, longest=0.05)
    with pytest.raises(
        GeometryError, match=r"at a height of 300 mm .*cores would change by -1\.969 deg .*take a height of 234"
    ):
        common_period(THREE_CORE_CABLE, height=0.3)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: common_period(THREE_CORE_CABLE, "sheath"), 'no layer "sheath"'),
        (lambda: common_period(THREE_CORE_CABLE, tolerance=-0.1), "tolerance"),
        (lambda: common_period(THREE_CORE_CABLE, longest=0.0), "longest period must be a positive"),
        (lambda: common_period(THREE_CORE_CABLE, height=np.inf), "height of a cell must be a positive"),
        (lambda: common_period(THREE_CORE_CABLE, twist_rate=np.nan), "finite"),
        (lambda: common_period(THREE_CORE_CABLE).layer("sheath"), 'no layer "sheath"'),
        (lambda: LayeredLay("x", -1.0, 0.1, "Z", 6), "radius"),
        (lambda: LayeredLay("x", 1.0, 0.1, "Z", 0), "whole number"),
        (lambda: LayeredLay("x", 1.0, -0.1, "Z", 6), "positive length"),
    ],
)
def test_impossible_requests_are_sentences(call, words):
    with pytest.raises(GeometryError, match=words):
        call()
