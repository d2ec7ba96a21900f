"""The ladder of the published specimen, computed once and kept: `python -m benchmarks.ladder` writes benchmarks/ladder.json and a figure.

With `--contact` the rung of opening, rubbing cores is climbed too. Its matrix is dense, three columns for each interface node and
station: it needs some 60 interface nodes, far fewer than the gmsh mesh of this cable has (200), and is refused on that mesh for now.
"""

from __future__ import annotations

import sys
from pathlib import Path

from geometry import read_cable
from homogenize.specimen import AxialGrading, Specimen
from homogenize.specimen.frictional_contact import FrictionalContact
from homogenize.specimen.ladder import PUBLISHED, ladder, read_ladder, write_ladder
from homogenize.specimen.ladder_plot import ladder_plot
from homogenize.specimen.specimen_mesh import specimen_mesh

CABLE = "paper-specimen-3x35"
LENGTH = 0.1823
RECORD = Path(__file__).with_name("ladder.json")
CONTACT = FrictionalContact(0.3)
COARSE = AxialGrading(end_size=0.2, largest=0.9, growth=4.0, degree=3)


def main() -> None:
    """Compute, write, draw."""
    cable = read_cable(CABLE)
    mesh, coarse = specimen_mesh(cable), specimen_mesh(cable, size=0.22 * cable.outer_diameter)
    specimen = Specimen(LENGTH)
    rungs = ladder(
        mesh,
        specimen,
        contact=CONTACT if "--contact" in sys.argv else None,
        contact_mesh=coarse,
        contact_specimen_grading=Specimen(LENGTH, grading=COARSE),
        progress=lambda fraction, sentence: print(f"{100 * fraction:3.0f} % {sentence}", flush=True),
    )
    write_ladder(rungs, RECORD, f"{CABLE}, {1e3 * LENGTH:g} mm, {len(mesh.cells)} triangles")
    about, rungs = read_ladder(RECORD)
    ladder_plot(rungs, about).savefig(RECORD.with_suffix(".png"), dpi=150)
    for rung in (*rungs, PUBLISHED):
        print(
            rung.name, {k: float(f"{v:.4g}") for k, v in rung.numbers().items()}, f"misfit {rung.misfit(PUBLISHED):.2f}"
        )


if __name__ == "__main__":
    main()
