"""A layer of wires locks where neighbours touch; it may not cut what is below it; its mass is that of its wires' length."""

import numpy as np
import pytest

from geometry import GeometryError, Material, MeshError, helix_distance, read_cable
from geometry.wire_layer import WireLayer, check_layer, largest_count, layer_parts, neighbour_clearances, wire_layers

STEEL = Material("steel", 200e9, 0.3, 7850.0)


def layer(count=55, diameter=4e-3, radius=39.467e-3, lay=0.678, phase=0.0, filler=None):
    return WireLayer("armour", "armour", count, diameter, STEEL, radius, phase, 2 * np.pi / lay if lay else 0.0, filler)


def test_thin_wires_fill_the_circle_as_their_width_over_cos_beta():
    """For thin wires the largest count tends to 2 pi r cos(beta) / d; curvature costs less than one wire in a thousand."""
    r, d, lay = 1.0, 2e-3, 4.0
    cos = 1 / np.hypot(1, 2 * np.pi * r / lay)
    assert largest_count(r, d, lay) == pytest.approx(2 * np.pi * r * cos / d, rel=1e-3)


def test_straight_wires_lock_at_the_chord():
    """n straight wires fit while d <= 2 r sin(pi / n)."""
    for n in (2, 3, 6, 17):
        d = 2 * np.sin(np.pi / n)
        assert largest_count(1.0, d * (1 - 1e-9), None) == n
        assert largest_count(1.0, d * 1.001, None) < n


@pytest.mark.parametrize(("count", "lay"), [(17, 0.21), (60, 0.3), (7, 0.02)])
def test_advice_of_the_locking_limit_fits_when_followed(count, lay):
    """Lay and count named in the sentence fit; a little less lay and one wire more do not."""
    r, d = (8.8e-3, 3.2e-3) if count == 17 else (39.467e-3, 4e-3) if count == 60 else (20e-3, 4e-3)
    with pytest.raises(GeometryError, match=r"armour: its \d+ wires of .* overlap by .* mm") as caught:
        check_layer(layer(count, d, r, lay), [])
    words = str(caught.value).split()
    shortest = float(words[words.index("least") + 1]) * 1e-3
    most = int(words[words.index("most") + 1])
    check_layer(layer(count, d, r, shortest), [])
    check_layer(layer(most, d, r, lay), [])
    with pytest.raises(GeometryError):
        check_layer(layer(count, d, r, 0.98 * shortest), [])
    with pytest.raises(GeometryError):
        check_layer(layer(most + 1, d, r, lay), [])


def test_count_beyond_the_circle_names_no_lay():
    with pytest.raises(GeometryError, match=r"at any lay: take at most 58 wires\.$"):
        check_layer(layer(70), [])


def test_gap_of_neighbours_against_two_sampled_helices():
    """Brute force over points of two neighbouring centre lines."""
    one = layer(17, 3.2e-3, 8.8e-3, 0.21)
    z = np.linspace(-0.05, 0.05, 400001)
    first = np.array([one.radius, 0.0, 0.0])
    turn = 2 * np.pi * z / 0.21 + 2 * np.pi / 17
    second = np.stack([one.radius * np.cos(turn), one.radius * np.sin(turn), z], axis=1)
    assert one.gap == pytest.approx(np.linalg.norm(second - first, axis=1).min() - 3.2e-3, abs=1e-9)


def test_wires_that_cut_the_layer_below_are_refused():
    below = layer_parts(layer(6, 2e-3, 2e-3, 0.06), 0.0)
    with pytest.raises(GeometryError, match=r"cut armour wire \d below them by 0\.5 mm: enlarge the radius to 4 mm"):
        check_layer(layer(10, 2e-3, 3.5e-3, 0.08), below)
    check_layer(layer(10, 2e-3, 4e-3, 0.08), below)


def test_wires_of_one_lay_may_lie_in_the_valleys():
    """Same lay, shifted by half a wire: the sum of radii is reached at a smaller radius; unshifted wires cut."""
    lay, r1, d = 0.06, 2e-3, 1.9e-3
    below = layer_parts(layer(6, d, r1, lay), 0.0)
    r2 = next(r for r in np.arange(3e-3, 4e-3, 1e-5) if helix_distance(r1, r, np.pi / 6, lay) > d)
    assert r2 < r1 + d - 1e-4
    check_layer(layer(6, d, r2, lay, phase=np.pi / 6), below)
    with pytest.raises(GeometryError, match="cut armour wire"):
        check_layer(layer(6, d, r2, lay), below)
    with pytest.raises(GeometryError, match="valleys"):
        layer_parts(layer(6, d, r2, lay, np.pi / 6, STEEL), r1 + d / 2)


def test_wires_over_the_axis_are_refused():
    with pytest.raises(GeometryError, match="reach over the axis"):
        check_layer(layer(1, 4e-3, 1e-3, 0.1), [])


def test_a_single_wire_may_not_cut_its_next_turn():
    with pytest.raises(GeometryError, match=r"its 1 wire of 4 mm overlaps itself"):
        check_layer(layer(1, 4e-3, 10e-3, 3.5e-3), [])
    check_layer(layer(1, 4e-3, 10e-3, 4.5e-3), [])


def test_mass_of_a_layer_is_that_of_the_length_of_its_wires():
    """n rho pi d^2/4 times the arc length per length of cable, 1 / cos(beta): exact."""
    cable = read_cable("spiral-strand-120")
    for wires in wire_layers(cable).values():
        first = wires[0]
        lay = 2 * np.pi / abs(first.twist_rate)
        stretch = np.hypot(1.0, 2 * np.pi * first.centre_radius / lay)
        expected = len(wires) * first.material.density * np.pi * first.outer_radius**2 * stretch
        assert sum(w.mass_per_length for w in wires) == pytest.approx(expected, rel=1e-12)


def test_filler_and_wires_fill_their_ring():
    filler = Material("bitumen", 1e6, 0.49, 1100.0)
    below = 37.467e-3
    parts = layer_parts(layer(filler=filler), below)
    assert parts[-1].kind == "interstices" and parts[-1].area > 0
    ring = np.pi * ((39.467e-3 + 2e-3) ** 2 - below**2)
    assert sum(part.area for part in parts) == pytest.approx(ring, rel=1e-12)


def test_one_pair_stands_for_a_layer():
    """120 wires give two gaps a layer, not 7140 pairs; each equals the pair that it stands for."""
    cable = read_cable("spiral-strand-120")
    found = neighbour_clearances(cable)
    assert len(found) == 2 * 6
    for name, wires in wire_layers(cable).items():
        first = wires[0]
        lay = 2 * np.pi / abs(first.twist_rate)
        pair = helix_distance(first.centre_radius, first.centre_radius, wires[1].phase - first.phase, lay)
        gap = next(c.gap for c in found if c.first == f"{name} wire" and c.second == "the next wire")
        assert gap == pytest.approx(pair - 2 * first.outer_radius, abs=1e-12)


def test_several_lays_are_refused_where_one_section_would_have_to_serve():
    cable = read_cable("sea-three-core")
    assert len(cable.lays) == 3 and not cable.single_lay
    with pytest.raises(
        MeshError,
        match=r"the cores 702.6 mm Z, inner armour 677.95 mm S, outer armour 776.56 mm Z.*one layer at a time",
    ):
        cable.check_single_lay()
    assert read_cable("mcpt-1.9-3.3-3x35").single_lay
