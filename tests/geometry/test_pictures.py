"""Pictures hold what they claim: the colours of all visible parts in the right proportions, at the right places."""

import matplotlib.image
import numpy as np
import pytest
from matplotlib.colors import to_rgb

from geometry import GeometryError, cross_section_mesh, draw_cross_section, draw_cutaway, draw_mesh, read_cable
from geometry.cable import KINDS
from geometry.colour_scheme import KIND_COLOURS, KIND_TITLES, kind_colour


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


def test_section_shows_the_parts_in_their_proportions(cable, tmp_path):
    """Pixels of a colour over pixels of the sheath = ratio of the areas, within 12 % (lines and labels lie on top)."""
    path = draw_cross_section(cable, tmp_path / "section.png", dpi=200)
    area = {kind: sum(p.area for p in cable.parts if p.kind == kind) for kind in KINDS}
    sheath = share(path, kind_colour("sheath"))
    for kind in ("conductor", "insulation", "interstices", "screen"):
        assert share(path, kind_colour(kind)) / sheath == pytest.approx(area[kind] / area["sheath"], rel=0.12), kind


def test_section_names_every_part(cable, tmp_path):
    """The text of the SVG holds every member, every kind and the outer diameter."""
    import matplotlib

    with matplotlib.rc_context({"svg.fonttype": "none"}):
        text = draw_cross_section(cable, tmp_path / "section.svg").read_text(encoding="utf-8")
    for part in cable.parts:
        assert part.member in text and part.kind in text
    assert "51.6 mm" in text and "lay 234 mm" in text and "10 mm" in text


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
    path = draw_cutaway(cable, tmp_path / "cut" / "cable.png", size=(900, 450))
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


def test_pictures_that_cannot_be_made(cable, tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(GeometryError, match="cannot be written"):
        draw_cross_section(cable, tmp_path / "file" / "section.png")
    with pytest.raises(GeometryError, match=r"ends in .png"):
        draw_cross_section(cable, tmp_path / "section.docx")
    with pytest.raises(GeometryError, match="length"):
        draw_cutaway(cable, tmp_path / "cut.png", length=0.0)
