"""Pictures hold what they claim: the colours of all visible parts in the right proportions, at the right places."""

import itertools

import matplotlib.image
import numpy as np
import pytest
from matplotlib.colors import to_rgb

from geometry import (
    CellBlock,
    GeometryError,
    SweptCell,
    builtin_cables,
    cross_section_mesh,
    draw_cross_section,
    draw_cutaway,
    draw_mesh,
    draw_swept_cell,
    helical_slice,
    read_cable,
)
from geometry.cable import KINDS
from geometry.colour_scheme import ALUMINIUM, KIND_COLOURS, KIND_TITLES, STEEL, kind_colour, part_colour
from geometry.cutaway_picture import cutaway_surfaces
from geometry.mesh_picture import cell_surfaces, region_ends
from geometry.section_legend import legend_blocks
from geometry.stripping import drawn_from, stripped_steps


@pytest.fixture(scope="module")
def cable():
    return read_cable("mcpt-1.9-3.3-3x35")


def share(path, colour, tolerance=0.02):
    image = matplotlib.image.imread(path)[..., :3]
    return float((np.abs(image - to_rgb(colour)).max(-1) < tolerance).mean())


def test_every_kind_has_one_colour_and_title():
    assert set(KIND_COLOURS) == set(KIND_TITLES) == set(KINDS)
    assert len(set(KIND_COLOURS.values())) == len(KINDS)
    assert kind_colour("unknown").startswith("#")


def test_metals_have_their_colour():
    """Copper, also as the softer cylinder of a strand; steel and aluminium are not drawn as copper."""
    assert part_colour("conductor", 8900, 110e9) == part_colour("strand", 6343, 80e9) == KIND_COLOURS["conductor"]
    assert part_colour("conductor", 7850, 200e9) == STEEL and part_colour("conductor", 2700, 70e9) == ALUMINIUM
    assert part_colour("sheath", 1400, 6e6) == KIND_COLOURS["sheath"]


def test_section_shows_the_parts_in_their_proportions(cable, tmp_path):
    """Pixels of a colour over pixels of the sheath = ratio of the areas, within 12 % (lines and labels lie on top).

    Thin walls lose too many pixels to their outlines; the outlines themselves are exact in test_nested_solids.py.
    """
    path = draw_cross_section(cable, tmp_path / "section.png", dpi=200)
    area = {kind: sum(p.area for p in cable.parts if p.kind == kind) for kind in KINDS}
    sheath = share(path, kind_colour("sheath"))
    for kind in ("insulation", "interstices"):
        assert share(path, kind_colour(kind)) / sheath == pytest.approx(area[kind] / area["sheath"], rel=0.12), kind


@pytest.mark.parametrize(
    ("name", "words"),
    [
        (
            "mcpt-1.9-3.3-3x35",
            ["power core 1\u20133", "control core", "51.6 mm", "lay 234 mm", "10 mm", "7 strands of 27"],
        ),
        (
            "sea-three-core",
            ["inner armour", "55 \u00d7", "lay 677.9 mm S", "outer armour", "63 \u00d7", "776.6 Z", "bedding"],
        ),
        ("spiral-strand-120", ["king", "33 \u00d7", "lay 620 mm Z, 15.9"]),
        ("strand-1x7-steel", ["wire 1\u20136", "3.73 mm", "core"]),
        ("helical-rod", ["rod", "45.0"]),
    ],
)
def test_section_names_every_part(name, words, tmp_path):
    """The text of the SVG holds every member, every layer of wires with its lay, and every kind."""
    import matplotlib

    made = read_cable(name)
    with matplotlib.rc_context({"svg.fonttype": "none"}):
        text = draw_cross_section(made, tmp_path / "section.svg").read_text(encoding="utf-8")
    for word in words:
        assert word in text
    for part in made.parts:
        assert (part.layer or part.member.rstrip("0123456789 ")) in text
    if name.startswith("mcpt"):
        assert all(part.kind in text for part in made.parts)


def test_legend_points_at_what_it_names(cable):
    """The anchor of a block lies inside its part; fillers are pointed at where no core is."""
    for made in (cable, read_cable("sea-three-core")):
        for block in legend_blocks(made):
            name = block.title or block.rows[0].name
            r = np.linalg.norm(block.anchor)
            around = [p for p in made.parts if p.name == name and p.centre_radius == 0]
            assert all(p.inner_radius <= r <= p.outer_radius for p in around), name
            if name == "interstices":
                centres = [p.centre_radius * np.exp(1j * p.phase) for p in made.parts if p.kind == "screen"]
                screen = max(p.outer_radius for p in made.parts if p.kind == "screen")
                assert min(abs(complex(*block.anchor) - c) for c in centres) > screen


def test_mesh_picture_states_its_numbers(cable, tmp_path):
    import matplotlib

    mesh = cross_section_mesh(cable, 6e-3, "triangle")
    with matplotlib.rc_context({"svg.fonttype": "none"}):
        text = draw_mesh(mesh, tmp_path / "mesh.svg", title="My mesh").read_text(encoding="utf-8")
    assert "My mesh" in text and "scaled Jacobian" in text
    for kind in ("quad", "triangle6", "quad9"):
        assert (
            draw_mesh(cross_section_mesh(cable, 8e-3, kind), tmp_path / f"{kind}.png", dpi=50).stat().st_size > 10_000
        )


def test_cutaway_is_rendered_without_a_display(cable, tmp_path, monkeypatch, capfd):
    """Sheath shortest at the left, copper at the right; nothing is written to the terminal."""
    monkeypatch.delenv("DISPLAY", raising=False)
    path = draw_cutaway(cable, tmp_path / "cut" / "cable.png", wires=False, size=(900, 450))
    image = matplotlib.image.imread(path)[..., :3]
    assert image.shape == (450, 900, 3)
    hue = image[..., 0] - image[..., 2]
    dark = image.max(-1) < 0.35
    copper = (hue > 0.3) & (image[..., 1] < 0.75 * image[..., 0])
    columns = np.arange(900)
    centre = [(mask.sum(0) * columns).sum() / mask.sum() for mask in (dark, copper)]
    assert dark.mean() > 0.03 and copper.mean() > 0.005
    assert centre[0] + 150 < centre[1]
    said = capfd.readouterr()
    assert said.out == said.err == ""


@pytest.mark.parametrize("entry", [entry.name for entry in builtin_cables()])
def test_layers_are_cut_one_after_the_other(entry):
    """Every layer ends before the one below it; all parts are shown, the conductors to the end."""
    made = read_cable(entry)
    steps = stripped_steps(made)
    assert sorted(p.name for step in steps for p in step.parts) == sorted(p.name for p in made.parts)
    assert steps[-1].end == pytest.approx(1.0) and all(p.kind in ("conductor", "wire") for p in steps[-1].parts)
    for above, below in itertools.pairwise(steps):
        assert above.end == below.begin < below.end
        if not any(p.kind == "interstices" for p in (*above.parts, *below.parts)):
            reach = [max(p.centre_radius + p.outer_radius for p in step.parts) for step in (above, below)]
            assert reach[0] > reach[1]
    for step in steps:
        for part in step.parts:
            assert drawn_from(part, steps) < step.end


def test_double_armour_is_stripped_like_in_a_makers_drawing():
    titles = [step.title for step in stripped_steps(read_cable("sea-three-core"))]
    assert titles == [
        "sheath", "outer armour", "bedding", "inner armour", "inner sheath", "interstices", "screen", "insulation", "conductor",
    ]  # fmt: skip


def test_surfaces_follow_the_helices():
    """Armour wires: surface points less the radius along their normals lie on the helices of that layer, lay and hand."""
    sea = read_cable("sea-three-core")
    for layer in ("inner armour", "outer armour"):
        wires = [p for p in sea.parts if p.layer == layer]
        rho, rate = wires[0].outer_radius, wires[0].twist_rate
        matching = 0
        for surface in (s for s in cutaway_surfaces(sea, 0.5) if s.normals is not None):
            assert surface.normals is not None
            centre = surface.points - rho * surface.normals
            if not np.allclose(np.hypot(*centre[:, :2].T), wires[0].centre_radius, rtol=1e-9):
                continue
            turned = np.arctan2(centre[:, 1], centre[:, 0]) - rate * centre[:, 2] - wires[0].phase
            steps = turned / (2 * np.pi / len(wires))
            np.testing.assert_allclose(steps, np.round(steps), atol=1e-9)
            assert set(np.round(steps).astype(int) % len(wires)) == set(range(len(wires)))
            matching += 1
        assert matching == 1


def swept(mesh):
    """A slice as a swept cell of one block."""
    block = CellBlock(mesh.cell_kind, mesh.cells, mesh.region_of)
    return SweptCell(mesh.points, (block,), mesh.regions, mesh.twist_rate, mesh.height, mesh.bottom, mesh.top)


def test_cell_is_drawn_cut_open(cable, tmp_path):
    """The outer faces that are passed on enclose exactly what is left of each region: the volume by Gauss's theorem."""
    cell = swept(helical_slice(cross_section_mesh(cable, 5e-3, "quad"), 0.02, 20))
    ends = region_ends(cell)
    assert list(ends)[:3] == ["sheath", "wrap", "interstices"] and ends["conductor"] == 1.0
    volume = 0.0
    for surface in cell_surfaces(cell, ends):
        a, b, c, d = (surface.points[surface.faces[:, k]] for k in range(4))
        volume += sum(np.einsum("ij,ij->", x, np.cross(y, z)) for x, y, z in ((a, b, c), (a, c, d))) / 6
    kept = 0.0
    for region in cell.regions:
        layers = np.ceil(20 * ends[region.kind] - 1e-6)
        kept += region.closed_form_area * layers / 20 * cell.height
    assert volume == pytest.approx(kept, rel=0.02)  # coarse section: the polygons of 5 mm elements lose area
    path = draw_swept_cell(cell, tmp_path / "cell.png", size=(600, 400))
    assert matplotlib.image.imread(path).shape[:2] == (400, 600)


def test_pictures_that_cannot_be_made(tmp_path):
    cable = read_cable("example-three-core")
    (tmp_path / "file").write_text("")
    with pytest.raises(GeometryError, match="cannot be written"):
        draw_cross_section(cable, tmp_path / "file" / "section.png")
    with pytest.raises(GeometryError, match=r"ends in .png"):
        draw_cross_section(cable, tmp_path / "section.docx")
    with pytest.raises(GeometryError, match="length"):
        draw_cutaway(cable, tmp_path / "cut.png", length=0.0)
