"""Picture of a friction loop: force over strain, and what friction adds to the section without it.

Left the whole force, F over e; right F - K_slip e, which opens loops that are thin beside their elastic line: there a section that slips
everywhere is a level line, and one that sticks has the slope K_stick - K_slip.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from geometry.errors import InputError
from homogenize.friction_loop import FrictionLoop
from homogenize.section_field import FloatArray

INK, SOFT, STICK, SLIP, FILL = "#22262b", "#6b7178", "#0072b2", "#d55e00", "#e4ebf2"

LABELS = {
    "stretch": ("stretch [1e-3]", 1e3),
    "twist": ("twist [rad/m]", 1.0),
    "kappa_x": ("curvature [1/m]", 1.0),
    "N": ("tension", "N"),
    "M_z": ("torque", "N m"),
    "M_x": ("bending moment", "N m"),
}


def draw_friction_loop(
    loop: FrictionLoop,
    path: str | Path,
    *,
    strain: int = 0,
    start: int = 0,
    title: str = "",
    note: str = "",
    dpi: int = 170,
) -> Path:
    """Draw one strain and its force.

    Parameters
    ----------
    loop : from :func:`homogenize.friction_loop`
    path : file to write; the ending chooses the format
    strain : number of the strain that the load path moves
    start : step at which the last closed cycle starts; its area is filled
    title, note : lines above the picture

    Raises
    ------
    InputError
        If the file cannot be written.
    """
    from matplotlib.figure import Figure

    section = loop.section
    (x_label, x_scale), (y_name, unit) = LABELS[section.strains[strain]], LABELS[section.forces[strain]]
    stick, slip = float(section.bonded[strain, strain]), float(section.frictionless[strain, strain])
    e, F = loop.strain[:, strain], loop.force[:, strain]
    figure = Figure(figsize=(12.4, 5.8), facecolor="white")
    for left, force, slopes, name in (
        (0.075, F, (stick, slip), y_name),
        (0.575, F - slip * e, (stick - slip, 0.0), f"{y_name} that friction adds"),
    ):
        axes = figure.add_axes((left, 0.11, 0.405, 0.68))
        factor, prefix = _prefix(float(np.abs(force).max()))
        _panel(axes, e * x_scale, force * factor, [K * factor / x_scale for K in slopes], start)
        axes.set_xlabel(x_label, color=INK)
        axes.set_ylabel(f"{name} [{prefix}{unit}]", color=INK)
        axes.set_title(name[0].upper() + name[1:], loc="left", fontsize=11, color=INK)
    figure.axes[0].legend(loc="upper left", frameon=False, fontsize=9, labelcolor=INK)
    figure.text(0.075, 0.94, title or "Friction loop", fontsize=13, fontweight="bold", color=INK)
    figure.text(0.075, 0.895, note, fontsize=9, color=SOFT)
    return _saved(figure, Path(path), dpi)


def _prefix(largest: float) -> tuple[float, str]:
    if largest >= 1e4:
        return 1e-3, "k"
    return (1.0, "") if largest >= 0.1 or largest == 0 else (1e3, "m")


def _panel(axes: Any, x: FloatArray, y: FloatArray, slopes: list[float], start: int) -> None:
    """The loop, and the two slopes through the origin and through the place where the cycle turns."""
    axes.fill(x[start:], y[start:], facecolor=FILL, edgecolor="none", zorder=1)
    axes.plot(x, y, color=INK, linewidth=1.7, zorder=4, label="section that rubs")
    reach_x, reach_y = 1.12 * float(np.abs(x).max()), 1.25 * (float(np.abs(y).max()) or 1.0)
    line = np.array([-reach_x, reach_x])
    styles = ((STICK, "-", "stick: all parts bonded"), (SLIP, "--", "slip: no friction"))
    for slope, (colour, dash, label) in zip(slopes, styles, strict=True):
        axes.plot(line, slope * line, color=colour, linestyle=dash, linewidth=1.2, zorder=3, label=label)
        turned = y[start] + slope * (line - x[start])
        axes.plot(line, turned, color=colour, linestyle=dash, linewidth=0.8, alpha=0.5, zorder=2)
    axes.axhline(0, color=SOFT, linewidth=0.5, zorder=0)
    axes.axvline(0, color=SOFT, linewidth=0.5, zorder=0)
    axes.set(xlim=(-reach_x, reach_x), ylim=(-reach_y, reach_y))
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)


def _saved(figure: Any, path: Path, dpi: int) -> Path:
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        figure.savefig(path, dpi=dpi)
    except (OSError, ValueError) as error:
        raise InputError(f'the picture cannot be written to "{path}": {error}; try a name that ends in .png.') from None
    return path
