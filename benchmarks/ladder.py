"""The ladder of the published specimen, computed once and kept: `python -m benchmarks.ladder` writes benchmarks/ladder.json and a picture.

The rungs of opening cores and of large displacements stand on a coarse section of some 200 triangles with cubic layers; rung 4 is
repeated on it.
About ten minutes of processor time.
"""

from __future__ import annotations

import sys
from pathlib import Path

from geometry import read_cable
from homogenize.specimen import AxialGrading, FrictionalContact, Specimen, coarse_section
from homogenize.specimen.ladder import PUBLISHED, ladder, read_ladder, write_ladder
from homogenize.specimen.ladder_plot import ladder_plot
from homogenize.specimen.specimen_mesh import specimen_mesh

CABLE = "paper-specimen-3x35"
LENGTH = 0.1823
RECORD = Path(__file__).with_name("ladder.json")
PICTURE = Path(__file__).parents[1] / "docs" / "pictures" / "ladder.png"
CONTACT = FrictionalContact(0.3)
COARSE = AxialGrading(end_size=0.24, largest=0.9, growth=4.0, degree=3)


def main(name: str = CABLE) -> None:
    """Compute, write, draw."""
    cable = read_cable(name)
    mesh = specimen_mesh(cable)
    rungs = ladder(
        mesh,
        Specimen(LENGTH),
        contact=CONTACT,
        coarse=coarse_section(cable),
        coarse_grading=COARSE,
        progress=lambda fraction, sentence: print(f"{100 * fraction:3.0f} % {sentence}", flush=True),
    )
    write_ladder(rungs, RECORD, f"{cable.name}, {1e3 * LENGTH:g} mm, {len(mesh.cells)} triangles")
    draw()


def draw() -> None:
    """Picture and table of the record."""
    about, rungs = read_ladder(RECORD)
    ladder_plot(rungs, about).savefig(PICTURE, dpi=150)
    for rung in (*rungs, PUBLISHED):
        found = {k: float(f"{v:.4g}") for k, v in rung.numbers().items()}
        print(rung.name, found, f"misfit {rung.misfit(PUBLISHED):.2f}")


if __name__ == "__main__":
    draw() if "--draw" in sys.argv else main()
