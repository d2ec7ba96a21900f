"""The seismic damper of Ganey (2015) as a campaign: one cyclic run of a yielding steel plate, cut into its cycles.

The table holds displacement and force without a clock, over nine cycles of growing amplitude. Every cycle is a record that
goes on where the one before it ended. The cycles that end in the first half of the samples calibrate; the others, of up
to 2.7 times the amplitude, are held out. The plate is entered as a cantilever, because its force is transverse to it and
no axial tension grips it; length and nominal stiffness only set a scale.
"""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from benchmarks.measured.campaign_folder import read_table, write_campaign
from benchmarks.measured.reading_error import pixel_of_the_path

Array = NDArray[np.float64]
NAME = "ganey-2015-damper"
_LENGTH = "0.1"
_TOML = """title = "Seismic damper, steel U-shaped flexural plate, cyclic loop (Ganey 2015)"

[section]   # a scale only: a cantilever of 0.1 m with 3 N/mm
EI = "1000 N m^2"
GA = "1e9 N"

[sensors]
force = "{force:.4g} kN"
"""


def write(data: Path, folder: Path, shuffle: int | None = None) -> Path:
    """Write the campaign.

    Parameters
    ----------
    data : Path
        Folder of the data set, with loop.csv.
    folder : Path
        Where the campaign goes.
    shuffle : int, optional
        Seed of the decoy: the residual of the straight line, without its mean, is shuffled, so that nothing is left.
    """
    loop = read_table(data / NAME / "loop.csv", ("displacement [mm]", "force [kN]"))
    x, force = loop.T
    noise = pixel_of_the_path(x, force)
    if shuffle is not None:
        slope = float(x @ force / (x @ x))
        residual = np.random.default_rng(shuffle).permutation(force - slope * x)
        residual -= residual.mean()
        force, noise = slope * x + residual, float(np.sqrt(np.mean(residual**2)))
    ends = [0, *cycle_ends(x), len(x)]
    rows, tables = [], {}
    for i, (begin, end) in enumerate(pairwise(ends)):
        id = f"cycle{i + 1}"
        rows.append(
            {
                "id": id,
                "kind": "shear",
                "specimen": "plate",
                "set": "calibrate" if end <= len(x) // 2 else "validate",
                "direction": "x+",
                "specimen length [m]": _LENGTH,
                "continues": "" if i == 0 else f"cycle{i}",
            }
        )
        tables[id] = {"deflection [mm]": x[begin:end], "force [kN]": force[begin:end]}
    return write_campaign(folder, _TOML.format(force=noise), rows, tables)


def cycle_ends(x: Array) -> list[int]:
    """Samples at which the path comes back upwards through zero after a full cycle.

    >>> cycle_ends(np.sin(np.arange(26)))
    [7, 13, 19]
    """
    up = np.flatnonzero((x[:-1] < 0) & (x[1:] >= 0)) + 1
    return [int(i) for i in up if i < len(x) - 3]
