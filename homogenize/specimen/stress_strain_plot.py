"""Picture of the average stress over the average strain of each load: load steps, the fitted line, its slope and R2."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from homogenize.specimen.apparent_modulus import ApparentModulus
from homogenize.specimen.shear_lag_plot import INK, SOFT, saved

MOST_COLUMNS = 3


def draw_stress_strain(found: Sequence[ApparentModulus], path: str | Path, note: str = "", dpi: int = 150) -> Path:
    """Draw one panel for each load.

    Parameters
    ----------
    found : moduli with their curves
    path : file to write
    note : how the specimen is loaded

    Raises
    ------
    InputError
        If the file cannot be written.
    """
    from matplotlib.figure import Figure

    columns = min(len(found), MOST_COLUMNS)
    rows = -(-len(found) // columns)
    figure = Figure(figsize=(max(4.8, 3.4 * columns), 2.9 * rows + 0.3), layout="constrained")
    panels = figure.subplots(rows, columns, squeeze=False).ravel()
    for axes, one in zip(panels, found):
        _draw(axes, one)
    for axes in panels[len(found) :]:
        axes.set_axis_off()
    title = "Average stress over average strain"
    figure.suptitle(f"{title}: {note}" if note else title, color=INK, fontsize=10, x=0.01, ha="left")
    return saved(figure, path, dpi)


def _draw(axes: Any, found: ApparentModulus) -> None:
    force = found.u_max == found.u_max
    across, up = (100.0, 1e-6) if force else (1.0, 1.0)
    curve = found.curve
    ends = np.array([0.0, curve.strain.max() * 1.05])
    axes.plot(across * ends, up * (curve.intercept + curve.slope * ends), color="#0072b2", lw=1.4)
    axes.plot(across * curve.strain, up * curve.stress, "o", color="#d55e00", ms=5)
    slope = f"{1e-6 * curve.slope:.4g} MPa" if force else f"{curve.slope:.4g} N m$^2$"
    axes.annotate(
        f"slope {slope}\n$R^2$ {curve.R2:.4f}", (0.05, 0.95), xycoords="axes fraction", va="top", color="#0072b2"
    )
    axes.set_title(found.load, color=INK, fontsize=9, loc="left")
    axes.set_xlabel("average strain [%]" if force else "rotation over length [rad/m]", color=SOFT, fontsize=8)
    axes.set_ylabel("average stress [MPa]" if force else "moment [N m]", color=SOFT, fontsize=8)
    axes.tick_params(labelsize=8)
    axes.set_xlim(left=0)
    axes.set_ylim(bottom=0)
    axes.spines[["top", "right"]].set_visible(False)
    axes.grid(color="#e6e8eb", lw=0.6)
