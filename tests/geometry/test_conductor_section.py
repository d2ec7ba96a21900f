"""Stranded conductor in quadrilaterals: exact areas, symmetry node for node, a conforming mesh with flats at the contacts."""

from functools import cache

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from geometry import GeometryError, MeshError, WireTrace
from geometry.conductor_section import conductor_section
from geometry.mesh_quality import block_quality
from geometry.strand_contact import RING

REFERENCE = ((1, 6), 3.0158e-3 / 2, 4.525e-3, 2 * np.pi / 127e-3)
CASES = {
    "1+6": (*REFERENCE, 48),
    "1+6, left-handed and fine": (*REFERENCE[:3], -REFERENCE[3], 96),
    "1+6, coarse": (*REFERENCE, 24),
    "3 straight": ((3,), 3.0158e-3 / 2, 3.25e-3, 0.0, 30),
    "1+6+12": ((1, 6, 12), 1e-3, 5e-3, 2 * np.pi / 0.1, 60),
    "single": ((1,), 3e-3, 3e-3, 0.0, 48),
    "3+9+15": ((3, 9, 15), 0.5e-3, 3.0774e-3, 2 * np.pi / 0.06, 60),
    "1+5, neighbours apart": ((1, 5), 1e-3, 3e-3, 50.0, 40),
    "1+6, stated 2.5 % thin": ((1, 6), 1.5e-3, 0.975 * 4.5e-3, 40.0, 48),
    "1+6, stated 2.5 % thick": ((1, 6), 1.5e-3, 1.025 * 4.5e-3, 40.0, 48),
}
FOLDS = {"1+6": 6, "3 straight": 3, "1+6+12": 6, "single": 6, "3+9+15": 3, "1+5, neighbours apart": 5}
every_case = pytest.mark.parametrize("name", CASES)


@cache
def section_of(name):
    return conductor_section(*CASES[name])


def strand_areas(section):
    a, b, c, d = np.moveaxis(section.points[section.cells], 1, 0)
    p, q = c - a, d - b
    return np.bincount(section.strand_of, 0.5 * (p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0]))


def edges_of(section):
    """Sorted edges (4 m, 2) and the cell of each."""
    cells = section.cells
    edges = np.concatenate([cells[:, [k, (k + 1) % 4]] for k in range(4)])
    return np.sort(edges, axis=1), np.tile(np.arange(len(cells)), 4)


def edge_strands(section):
    """{edge: numbers of the strands of its cells}."""
    found = {}
    for edge, cell in zip(*edges_of(section)):
        found.setdefault(tuple(edge), []).append(int(section.strand_of[cell]))
    return found


def ring_edges(section):
    return {tuple(sorted(e)) for e in zip(section.ring.tolist(), np.roll(section.ring, -1).tolist())}


@every_case
def test_every_strand_has_the_exact_area_of_its_trace(name):
    """Flats, polygons and a stated diameter that does not fit take no metal away."""
    section, turn = section_of(name), CASES[name][3]
    expected = [WireTrace(p.centre_radius, p.phase, p.radius, turn).area for p in section.strands]
    np.testing.assert_allclose(strand_areas(section), expected, rtol=1e-12)  # closed form against sums of rounded terms


@every_case
def test_the_ring_is_a_polygon_of_the_conductor_circle_s_area_with_nodes_at_equal_angles(name):
    section = section_of(name)
    count, R = CASES[name][4], CASES[name][2]
    ring = section.points[section.ring]
    assert len(section.ring) == count
    angles = 2 * np.pi * np.arange(count) / count
    radius = np.hypot(*ring.T)
    np.testing.assert_allclose(
        ring, radius[:, None] * np.column_stack([np.cos(angles), np.sin(angles)]), atol=1e-12 * R
    )
    x, y = ring.T
    area = 0.5 * (x * np.roll(y, -1) - y * np.roll(x, -1)).sum()
    assert area == pytest.approx(np.pi * R**2, rel=1e-12)


@every_case
def test_turned_by_one_fold_the_section_is_itself_node_for_node(name):
    section = section_of(name)
    assert section.fold == FOLDS.get(name, 6)
    angle = 2 * np.pi / section.fold
    Q = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    gaps = np.linalg.norm((section.points @ Q.T)[:, None] - section.points[None], axis=2)
    image = gaps.argmin(1)
    assert gaps.min(1).max() < 1e-12
    assert len(set(image)) == len(image)
    cells = {frozenset(cell): s for cell, s in zip(section.cells.tolist(), section.strand_of.tolist())}
    for cell, strand in zip(image[section.cells].tolist(), section.strand_of.tolist()):
        place, moved = section.strands[strand], section.strands[cells[frozenset(cell)]]
        assert moved.layer == place.layer
        if place.centre_radius > 0:
            assert np.exp(1j * moved.phase) == pytest.approx(np.exp(1j * (place.phase + angle)), abs=1e-12)


@every_case
def test_edges_belong_to_two_cells_or_lie_on_a_boundary_that_closes(name):
    """Conforming: no edge has three cells, nodes are not doubled, and the boundary has as many edges as it has ends."""
    section = section_of(name)
    edges, _ = edges_of(section)
    unique, count = np.unique(edges, axis=0, return_counts=True)
    assert set(count) == {1, 2}
    free = unique[count == 1]
    assert set(np.bincount(free.ravel())) <= {0, 2, 4}
    points = section.points
    gaps = np.linalg.norm(points[:, None] - points[None], axis=2) + np.eye(len(points))
    assert gaps.min() > 1e-3 * section.strands[0].radius
    alone = np.setdiff1d(np.arange(len(points)), section.cells)
    assert set(alone) <= set(section.ring)


@every_case
def test_cells_are_convex_and_of_good_shape(name):
    section = section_of(name)
    quality = block_quality(section.points, section.cells, "quad")
    assert quality.min() > 0.7
    assert quality.mean() > 0.87


@every_case
def test_listed_contacts_are_the_pairs_that_share_edges(name):
    section = section_of(name)
    on_ring = ring_edges(section)
    shared = {}
    for edge, strands in edge_strands(section).items():
        pair = (RING, strands[0]) if edge in on_ring else tuple(sorted(strands))
        if len(pair) == 2 and pair[0] != pair[1]:
            shared[pair] = shared.get(pair, 0) + 1
    assert tuple(sorted(shared)) == section.contacts
    if name not in ("single", "1+6, coarse"):
        assert set(shared.values()) <= {1, 2}


def test_six_round_one_touch_the_centre_their_neighbours_and_the_ring():
    expected = {(0, k) for k in range(1, 7)} | {(RING, k) for k in range(1, 7)}
    expected |= {(k, k + 1) for k in range(1, 6)} | {(1, 6)}
    assert set(section_of("1+6").contacts) == expected


def test_strands_that_would_hang_free_are_held_and_the_closed_gap_is_told():
    """In 3 + 9 + 15 most strands of the middle layer touch nothing; those of 1 + 6 need no such help."""
    section = section_of("3+9+15")
    touched = {strand for pair in section.contacts for strand in pair}
    assert touched >= set(range(27))
    assert 0.025 < section.closed_gap / 0.5e-3 < 0.25
    assert section_of("1+6").closed_gap < 1e-9


@every_case
def test_nodes_stay_near_the_traces(name):
    """Boundary nodes leave the trace by what flats and equal areas ask for; at the ring, by the stand-off of its nodes."""
    section, turn = section_of(name), CASES[name][3]
    edges, cell = edges_of(section)
    unique, index, count = np.unique(edges, axis=0, return_index=True, return_counts=True)
    step, R, outer = 2 * np.pi / CASES[name][4], CASES[name][2], section.strands[-1]
    at_ring = np.hypot(R * np.cos(step) - outer.centre_radius, R * np.sin(step)) / outer.radius - 1
    limit = max(at_ring, 0.0) + 0.07
    for strand, place in enumerate(section.strands):
        mine = section.strand_of[cell[index]] == strand
        nodes = np.unique(unique[mine & (count == 1)])
        trace = WireTrace(place.centre_radius, place.phase, place.radius * section.strand_scale, turn)
        points = section.points[nodes]
        gap = np.linalg.norm(points - trace.point(trace.nearest(points)), axis=1)
        assert gap.max() < limit * place.radius


def test_the_hand_of_the_lay_does_not_change_the_section():
    """The trace of a round wire is even in the turn rate."""
    right, left = (conductor_section(*REFERENCE[:3], sign * REFERENCE[3], 48) for sign in (1, -1))
    np.testing.assert_array_equal(right.points, left.points)


def test_size_and_ring_nodes_set_the_number_of_cells():
    counts = [len(conductor_section(*REFERENCE, n).cells) for n in (24, 48, 120)]
    assert counts[0] < 200 < counts[1] < 500 < 1000 < counts[2]
    assert len(conductor_section(*REFERENCE, 48, size=0.3e-3).cells) > 2 * counts[1]
    assert len(conductor_section(REFERENCE[0], *REFERENCE[1:], 96, size=1e-3).cells) < counts[1]
    assert len(conductor_section(*CASES["3 straight"][:4], 18).cells) < 70


@settings(max_examples=12, deadline=None)
@given(
    st.sampled_from([(1, 6), (3,), (4,), (1, 5), (2,), (1, 6, 12)]),
    st.floats(0.2e-3, 3e-3),
    st.floats(0.975, 1.025),
    st.floats(9.0, 60.0),
    st.integers(0, 5),
)
def test_areas_and_shapes_hold_for_any_lay_and_size(layers, radius, misfit, lay_ratio, more):
    reach = radius * {(1, 6): 3, (3,): 1 + 2 / 3**0.5, (4,): 1 + 2**0.5, (1, 5): 3, (2,): 2, (1, 6, 12): 5}[layers]
    R, turn = misfit * reach, 2 * np.pi / (2 * lay_ratio * reach)
    step = np.lcm(2, np.gcd.reduce(layers[1:] if layers[0] == 1 else layers))
    nodes = int(step * (np.ceil(2 * np.pi * R / (0.75 * radius * misfit) / step) + more))
    assume(nodes <= 100)
    section = conductor_section(layers, radius, R, turn, nodes)
    expected = [WireTrace(p.centre_radius, p.phase, radius, turn).area for p in section.strands]
    np.testing.assert_allclose(strand_areas(section), expected, rtol=1e-9)
    assert block_quality(section.points, section.cells, "quad").min() > 0.4
    assert section.strand_scale == pytest.approx(misfit, rel=1e-12)


@pytest.mark.parametrize(
    ("change", "kind", "sentence"),
    [
        ({"ring_nodes": 50}, MeshError, r"repeat 6 times a turn .* multiple of 6, found 50: take 48"),
        ({"layers": (3,), "conductor_radius": 3.2e-3, "ring_nodes": 27}, MeshError, r"multiple of 6, found 27"),
        ({"ring_nodes": 18}, MeshError, r"18 nodes .* too far apart .* take at least 24"),
        ({"ring_nodes": 0}, MeshError, r"found 0: take 24"),
        ({"layers": (1,), "conductor_radius": 1.5e-3, "ring_nodes": 22}, MeshError, r"multiple of 4, found 22: take"),
        ({"layers": (1, 7)}, GeometryError, r"a layer of 7 members of 3 mm does not fit"),
        ({"layers": (1, 0)}, GeometryError, r"every layer .* at least one strand"),
        ({"layers": ()}, GeometryError, r"every layer .* at least one strand"),
        ({"conductor_radius": 5e-3}, GeometryError, r"reach out to 4\.5 mm, .* 5 mm \(\+11\.1 %\): correct one"),
        ({"strand_radius": -1e-3}, GeometryError, r"must be positive, found 4\.5 mm and -1 mm"),
        (
            {"turn_rate": 2 * np.pi / 20e-3},
            GeometryError,
            r"strands . and . of a conductor overlap by .* lengthen their lay",
        ),
        ({"size": 0.0}, MeshError, r"distance of the nodes .* positive"),
    ],
)
def test_what_cannot_be_is_said_in_a_sentence(change, kind, sentence):
    good = {"layers": (1, 6), "strand_radius": 1.5e-3, "conductor_radius": 4.5e-3, "turn_rate": 49.0, "ring_nodes": 48}
    conductor_section(**good)
    with pytest.raises(kind, match=sentence):
        conductor_section(**(good | change))
