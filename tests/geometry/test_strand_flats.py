"""Flats between strands: their width is a number of the cable, not of the mesh; where the mesh cannot follow, it says so."""

import numpy as np
import pytest

from geometry import GeometryError, SpecError, cable_files, read_cable
from geometry.conductor_section import conductor_section
from geometry.mesh_quality import block_quality
from geometry.nested_cell import nested_cell
from geometry.strand_contact import RING, overlap_half_width, touch_of
from geometry.wire_trace import WireTrace

LONG_LAY = (1, 6), 1.5e-3, 4.5e-3, 2 * np.pi / 0.4
TEXT = cable_files()["mcpt-1.9-3.3-3x35"].read_text(encoding="utf-8")


def flats(section):
    """Width of every contact of two strands, from the mesh alone: edges of cells of two strands, added up."""
    edges = np.sort(np.concatenate([section.cells[:, [k, (k + 1) % 4]] for k in range(4)]), axis=1)
    owner = np.tile(section.strand_of, 4)
    unique, number = np.unique(edges, axis=0, return_inverse=True)
    width = {}
    for edge in np.flatnonzero(np.bincount(number) == 2):
        pair = tuple(sorted(set(owner[number == edge].tolist())))
        if len(pair) == 2:
            a, b = section.points[unique[edge]]
            width[pair] = width.get(pair, 0.0) + float(np.linalg.norm(a - b))
    return width


@pytest.mark.parametrize("width", [0.2e-3, 0.3e-3, 0.6e-3])
def test_width_stays_under_refinement(width):
    """All twelve flats of 1 + 6 have the stated width on four meshes (exact), and the cells stay well shaped."""
    for nodes in (48, 72, 96, 144):
        section = conductor_section(*LONG_LAY, nodes, flat_width=width)
        assert list(flats(section).values()) == pytest.approx([width] * 12, rel=1e-9)
        assert section.flats_as_wanted and section.flat_width == pytest.approx(width, rel=1e-9)
        assert block_quality(section.points, section.cells, "quad").min() > 0.7


def test_without_a_number_it_is_a_share_of_the_radius():
    for nodes in (24, 60, 120):
        assert list(flats(conductor_section(*LONG_LAY, nodes)).values()) == pytest.approx([0.3 * 1.5e-3] * 12, rel=1e-9)


def test_coarse_mesh_says_what_it_used():
    """Edges of 0.59 mm resolve no flat below three tenths of that; four times the nodes do, and the sentence changes."""
    coarse, fine = (conductor_section(*LONG_LAY, nodes, flat_width=0.15e-3) for nodes in (48, 192))
    assert coarse.flat_width == pytest.approx(0.3 * coarse.edge, rel=1e-6)
    assert not coarse.flats_as_wanted
    assert (
        "0.15 mm wide between strands are too narrow for edges of 0.589 mm: 0.177 mm is used"
        in coarse.flat_sentence("x")
    )
    assert fine.flat_sentence("x") == "x: strands touch each other on flats 0.15 mm wide."


@pytest.mark.parametrize("lay", [0.127, 0.4])
def test_flats_span_the_overlap(lay):
    """Neighbours of 1 + 6 overlap as their traces are long along the circle; narrower flats would leave metal in metal."""
    section = conductor_section((1, 6), 1.5e-3, 4.5e-3, 2 * np.pi / lay, 144, flat_width=0.01e-3)
    a, b = (WireTrace(3e-3, k * np.pi / 3, 1.5e-3, 2 * np.pi / lay) for k in (0, 1))
    touch = touch_of(a, b)
    apart = 0.5e-3 * np.arange(-1, 1.01, 1e-3)
    on_a = a.point(a.nearest(touch.middle + apart[:, None] * np.array([-touch.normal[1], touch.normal[0]])))
    inside = (on_a - touch.middle) @ touch.normal > 0  # the first strand past the middle of the flat
    lens = float(np.ptp(on_a[inside], axis=0).max())
    assert lens < 2 * overlap_half_width(touch, a, b) < 1.3 * lens
    assert max(flats(section).values()) >= lens
    if lay < 0.2:
        assert "strands overlap where they touch" in section.flat_sentence("x")


def test_strands_apart_do_not_overlap():
    a, b = (WireTrace(3.1e-3, k * np.pi / 3, 1.5e-3, 5.0) for k in (0, 1))
    assert overlap_half_width(touch_of(a, b), a, b) == 0.0


def test_ring_contact_is_as_wide_as_its_nodes_allow():
    """Outer strands touch the ring over about the width of a flat, at least one edge to each side."""
    for nodes, edges in ((24, 2), (96, 2), (192, 4)):
        section = conductor_section(*LONG_LAY, nodes, flat_width=0.6e-3)
        contacts = [pair for pair in section.contacts if pair[0] == RING]
        on_ring = np.isin(section.cells, section.ring).sum(1) == 2
        assert on_ring.sum() == edges * len(contacts)


@pytest.mark.parametrize("width", [0.0, -1e-4, 1e-3, float("nan")])
def test_impossible_widths(width):
    with pytest.raises(GeometryError, match=r"cannot be .* mm wide: state a width above zero and up to 0\.9 mm"):
        conductor_section(*LONG_LAY, 48, flat_width=width)


def with_flat(folder, value):
    path = folder / "mine.toml"
    entry = f'flat_width = {{ value = {value}, status = "assumed", range = ["0.1 mm", "0.8 mm"], source = "test" }}'
    path.write_text(TEXT.replace("[conductors.power]\n", f"[conductors.power]\n{entry}\n"), encoding="utf-8")
    return path


def test_cable_file_states_the_width_and_the_cell_tells_it(tmp_path):
    """The key reaches the mesh; an argument goes before it; sentences name every conductor."""
    cable = read_cable(with_flat(tmp_path, '"0.6 mm"'))
    assert cable.conductors["power"].flat_width == 0.6e-3
    notes = nested_cell(cable, size=2.5e-3).notes
    assert len(notes) == 4
    assert sum("flats 0.6 mm wide" in note for note in notes) == 3
    assert all("flats 0.7 mm wide" in note for note in nested_cell(cable, size=2.5e-3, flat_width=0.7e-3).notes)


@pytest.mark.parametrize(
    ("value", "sentence"),
    [
        ('"1 mm"', r"conductors.power.flat_width: .* outside its own range"),
        ("0.3", "conductors.power.flat_width: the number 0.3 has no unit"),
        ('"-0.3 mm"', "conductors.power.flat_width: .* must be positive"),
    ],
)
def test_bad_widths_in_a_file(tmp_path, value, sentence):
    with pytest.raises(SpecError, match=sentence):
        read_cable(with_flat(tmp_path, value))


def test_width_beyond_the_strand_is_refused(tmp_path):
    path = with_flat(tmp_path, '"1 mm"')
    path.write_text(path.read_text(encoding="utf-8").replace('"0.8 mm"]', '"2 mm"]'), encoding="utf-8")
    with pytest.raises(
        SpecError, match=r"flats between strands of 3.016 mm cannot be 1 mm wide; state at most 0.905 mm"
    ):
        read_cable(path)
