"""The ladder of the published specimen in one piece: `python -m benchmarks.ladder` writes benchmarks/ladder.json and a picture.

All rungs stand on the calibrated specimen, so that only the physics changes from one to the next. Those of opening cores and of large
displacements stand on a coarse section of some 300 triangles with cubic layers; the traction is repeated on it. Each rung is
kept as it is done: a run that was killed goes on where it stopped. `--draw` draws the record again.
"""

from __future__ import annotations

import sys
from pathlib import Path

from geometry import read_cable
from homogenize.specimen import AxialGrading, FrictionalContact, Specimen, coarse_section
from homogenize.specimen.ladder import PUBLISHED, ladder, ladder_steps
from homogenize.specimen.ladder_plot import ladder_plot
from homogenize.specimen.ladder_record import inputs_key, kept_rungs, part_of, read_ladder, write_ladder
from homogenize.specimen.specimen_mesh import specimen_mesh

CABLE = "mcpt-1.9-3.3-3x35-specimen"
LENGTH = 0.1823
"""Of the specimen [m] if the cable file gives none."""
RECORD = Path(__file__).with_name("ladder.json")
PICTURE = Path(__file__).parents[1] / "docs" / "pictures" / "ladder.png"
CONTACT = FrictionalContact(0.3)
COARSE = AxialGrading(end_size=0.24, largest=0.9, growth=4.0, degree=3)


def main(name: str = CABLE) -> None:
    """Compute, write, draw."""
    cable = read_cable(name)
    mesh, few = specimen_mesh(cable), coarse_section(cable)
    case = cable.specimen
    specimen = Specimen(LENGTH) if case is None else Specimen(case.length, phase=case.phase)
    key = inputs_key(cable.numbers, len(mesh.cells), len(few.cells), specimen, CONTACT, COARSE)
    about = f"{cable.name}, {1e3 * specimen.length:g} mm, {len(mesh.cells)} triangles"
    rungs = ladder(
        ladder_steps(mesh, specimen, contact=CONTACT, coarse=few, coarse_grading=COARSE),
        lambda fraction, sentence: print(f"{100 * fraction:3.0f} % {sentence}", flush=True),
        kept=kept_rungs(RECORD, key),
        done=lambda so_far: write_ladder(so_far, part_of(RECORD), key),
    )
    write_ladder(rungs, RECORD, about)
    part_of(RECORD).unlink()
    draw()


def draw() -> None:
    """Picture and table of the record."""
    about, rungs = read_ladder(RECORD)
    ladder_plot(rungs, about).savefig(PICTURE, dpi=150)
    for rung in (*rungs, PUBLISHED):
        found = {k: float(f"{v:.4g}") for k, v in rung.numbers().items()}
        print(rung.name, found, f"misfit {rung.misfit(PUBLISHED):.3f}")


if __name__ == "__main__":
    draw() if "--draw" in sys.argv else main(*sys.argv[1:])
