"""Writes the folder of a towing campaign: campaign.toml, experiments.csv and one table per record, and no truth."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.blind_towing.towed_line import Line

Array = NDArray[np.float64]
CAMPAIGN = """title = "{title}"

[section]
EA = "{EA:g} N"
mass_per_length = "{mass:g} kg/m"

[towing]
friction_coefficient = {friction:.3g}
cable_length = "{length:g} m"
mass_per_length = "{mass:g} kg/m"
EA = "{EA:g} N"
damping_ratio = {damping:g}
presliding = "{presliding:g} mm"
"""


def write_folder(
    folder: Path,
    line: Line,
    nominal_friction: float,
    t: Array,
    stations: Sequence[float],
    records: Sequence[tuple[Any, Array]],
    title: str = "Cable towed to and fro in a trough",
    first: int = 1,
) -> list[str]:
    """Write a campaign; records of one condition follow each other, the later ones are repeats of the first.

    Parameters
    ----------
    records : sequence of (condition, (channels, samples) array)
        A condition has `motion`, `slope` [rad], `tail` [N], `speed` [m/s] and `purpose`.

    Returns
    -------
    list of str
        The rows of experiments.csv below its header.
    """
    folder.mkdir(parents=True, exist_ok=True)
    text = CAMPAIGN.format(title=title, EA=line.EA, mass=line.mass, friction=nominal_friction, length=line.length,
                           damping=line.damping_ratio, presliding=1e3 * line.presliding)  # fmt: skip
    (folder / "campaign.toml").write_text(text, encoding="utf-8")
    rows = experiment_rows(folder, t, stations, records, first)
    header = "id,kind,file,specimen,repeat_of,set,speed [m/s],inclination [deg],tail tension [N]"
    (folder / "experiments.csv").write_text("\n".join([header, *rows]) + "\n", encoding="utf-8")
    return rows


def experiment_rows(
    folder: Path, t: Array, stations: Sequence[float], records: Sequence[tuple[Any, Array]], first: int = 1
) -> list[str]:
    """Write the tables and return their rows of experiments.csv; the first is number `first`."""
    rows, original, before = [], "", None
    for number, (condition, y) in enumerate(records, start=first):
        name = f"w{number:02d}"
        repeats = before is condition
        original, before = (original if repeats else name), condition
        columns = np.column_stack([t, condition.motion(t)[0], *y])
        head = ",".join(["time [s],position [m],tension [N]", *(f"tension at {s:g} [N]" for s in stations)])
        form = ["%.6g", "%.7g", *["%.6g"] * len(y)]
        lines = [",".join(f % x for f, x in zip(form, row, strict=True)) for row in columns.tolist()]
        (folder / f"{name}.csv").write_text("\n".join([head, *lines]) + "\n", encoding="utf-8")
        cells = [name, "towing", f"{name}.csv", "AB"[repeats], original if repeats else "", condition.purpose,
                 f"{condition.speed:g}", f"{math.degrees(condition.slope):g}", f"{condition.tail:g}"]  # fmt: skip
        rows.append(",".join(cells))
    return rows
