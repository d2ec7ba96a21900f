"""`python -m benchmarks.gallery`: draw every cable that ships and write docs/gallery.md and its pictures.

Takes about a minute. The pictures are reduced to a palette, which keeps each below 300 kB.
"""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory

from geometry import Cable, builtin_cables, draw_cross_section, draw_cutaway, draw_swept_cell, read_cable
from geometry.nested_cell import nested_cell

DOCS = Path(__file__).resolve().parent.parent / "docs"
CELL = "mcpt-1.9-3.3-3x35"
LARGEST = 300_000
"""Bytes of a picture."""

PROPERTIES = ("E", "nu", "density", "wire_density", "lay_factor")
"""Assumed numbers that do not change the drawing."""

HEAD = """# Gallery

Every cable that ships with helicable, cut open and in section. The drawings follow the cable files: strands, wires and
armour lie where their helices put them. Bunched conductors, whose wires have no fixed places, are drawn as one cylinder.
`helicable show NAME --out pictures` draws one of them; `make gallery` draws this page again.
"""


def main() -> None:
    """Write all pictures and the page."""
    sections = [HEAD]
    for entry in builtin_cables():
        cable = read_cable(entry.name)
        picture(f"{cable.name}-cutaway.png", lambda path, cable=cable: draw_cutaway(cable, path))
        picture(f"{cable.name}-section.png", lambda path, cable=cable: draw_cross_section(cable, path, dpi=150))
        sections.append(words(cable))
    cell = nested_cell(read_cable(CELL), elements=60_000)
    title = f"{CELL}: cell at the level of strands"
    picture(f"{CELL}-cell.png", lambda path: draw_swept_cell(cell, path, title))
    sections.append(
        f"## The mesh of `{CELL}`\n\nHexahedra swept with the cable and with each strand; between a conductor that turns and its "
        "fixed surroundings one ring of cells slides from index to index.\n\n"
        f"![mesh of the cell, cut open](pictures/{CELL}-cell.png)\n"
    )
    shutil.copyfile(DOCS / "pictures" / f"{CELL}-cutaway.png", DOCS / "pictures" / "cutaway.png")  # of the README
    (DOCS / "gallery.md").write_text("\n".join(sections), encoding="utf-8")


def words(cable: Cable) -> str:
    """The section of the page on one cable: what it is, what is assumed, and its pictures."""
    lines = [f"## {cable.title}", "", f"`{cable.name}`: {sizes(cable)}", "", assumptions(cable), ""]
    lines += [f"![{cable.title}, cut open](pictures/{cable.name}-cutaway.png)", ""]
    lines += [f"![{cable.title}, cross-section](pictures/{cable.name}-section.png)", ""]
    return "\n".join(lines)


def sizes(cable: Cable) -> str:
    """Diameter, mass and number of parts in words."""
    return (
        f"{1e3 * cable.outer_diameter:.1f} mm over all, {cable.mass_per_length:.3g} kg/m, {len(cable.parts)} parts. "
        + (cable.notes[0] if cable.notes else "")
    ).strip()


def assumptions(cable: Cable) -> str:
    """Which sizes are assumed; the assumed properties of materials are only counted."""
    shape = [n.key for n in cable.assumed if n.key.rsplit(".", 1)[-1] not in PROPERTIES]
    others = len(cable.assumed) - len(shape)
    told = "Assumed sizes: " + ", ".join(f"`{key}`" for key in shape) if shape else "No size is assumed"
    return told + (f"; and {others} properties of materials." if others else ".")


def picture(name: str, draw: Callable[[Path], Path]) -> None:
    """Draw one picture and reduce it to as many colours as fit."""
    from PIL import Image

    with TemporaryDirectory() as folder:
        image = Image.open(draw(Path(folder) / name)).convert("RGB")
    target = DOCS / "pictures" / name
    for colours in (256, 128, 64):
        palette = image.quantize(colours, method=Image.Quantize.MAXCOVERAGE)
        image.quantize(palette=palette, dither=Image.Dither.FLOYDSTEINBERG).save(target, optimize=True)
        if target.stat().st_size <= LARGEST:
            return
    raise SystemExit(f"{target} has {target.stat().st_size} bytes, more than {LARGEST}.")


if __name__ == "__main__":
    main()
