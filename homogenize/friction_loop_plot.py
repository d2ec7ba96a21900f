"""Picture of a friction loop: force over strain, and what friction adds to the section without it.

Left the whole force, F over e; right F - K_slip e, which opens loops that are thin beside their elastic line: there a section that slips
everywhere is a level line, and one that sticks has the slope K_stick - K_slip. Where parts can open the right side shows the share of the
surface that is open and the largest gap, over the strain.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from geometry.errors import InputError
from homogenize.friction_loop import FrictionLoop
from homogenize.section_field import FloatArray

INK, SOFT, STICK, SLIP, OPEN, FILL = "#22262b", "#6b7178", "#0072b2", "#d55e00", "#009e73", "#e4ebf2"

STICKS = (STICK, "-", "stick: all parts bonded")
SLIPS = (SLIP, "--", "slip: no friction")

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
    first: int = 0,
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
    first : step before the loop, after a constant load has been put on
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
    e, F = loop.strain[first:, strain], loop.force[first:, strain]
    figure = Figure(figsize=(12.4, 5.8), facecolor="white")
    panels = [(0.075, F, _lines(loop, strain), y_name)]
    if section.opens.any():
        _opening_panels(figure, loop, e * x_scale, first, x_label)
    else:
        styles = [(stick - slip, *STICKS), (0.0, *SLIPS)]
        panels.append((0.575, F - slip * e, styles, f"{y_name} that friction adds"))
    for left, force, lines, name in panels:
        axes = figure.add_axes((left, 0.11, 0.405, 0.68))
        factor, prefix = _prefix(float(np.abs(force).max()))
        scaled = [(K * factor / x_scale, *style) for K, *style in lines]
        _panel(
            axes,
            e * x_scale,
            force * factor,
            scaled,
            start - first,
            bool(section.rubs.any()),
            bool(section.opens.any()),
        )
        axes.set_xlabel(x_label, color=INK)
        axes.set_ylabel(f"{name} [{prefix}{unit}]", color=INK)
        axes.set_title(name[0].upper() + name[1:], loc="left", fontsize=11, color=INK)
        if left < 0.5:
            axes.legend(loc="upper left", frameon=False, fontsize=9, labelcolor=INK)
    figure.text(0.075, 0.94, title or "Friction loop", fontsize=13, fontweight="bold", color=INK)
    figure.text(0.075, 0.895, note, fontsize=9, color=SOFT)
    return _saved(figure, Path(path), dpi)


def _lines(loop: FrictionLoop, strain: int) -> list[tuple[Any, ...]]:
    """Slopes to compare with: colour, dash, label."""
    section = loop.section
    stick, slip, open_ = (float(K[strain, strain]) for K in (section.bonded, section.frictionless, section.open))
    lines: list[tuple[Any, ...]] = [(stick, *STICKS), (slip, *SLIPS)]
    if not section.opens.any():
        return lines
    closed = (slip, SLIP, "--", "closed, no friction")
    return [*(lines[:1] if section.rubs.any() else []), closed, (open_, OPEN, ":", "all open")]


def _opening_panels(figure: Any, loop: FrictionLoop, x: FloatArray, first: int, x_label: str) -> None:
    """Share of the surface that is open, and the largest gap."""
    gap = 1e3 * loop.gap.max(axis=(1, 2))[first:]
    rows = ((0.48, 100 * loop.open_share[first:], "Open surface", "share [%]"), (0.11, gap, "Largest gap", "gap [mm]"))
    for bottom, y, name, label in rows:
        axes = figure.add_axes((0.575, bottom, 0.405, 0.31))
        axes.plot(x, y, color=OPEN, linewidth=1.7)
        top = float(y.max())
        axes.set(xlim=(1.12 * min(x.min(), 0), 1.12 * max(x.max(), 0)), ylim=(-0.04 * (top or 1), 1.15 * (top or 1)))
        axes.set_ylabel(label, color=INK)
        axes.set_title(name, loc="left", fontsize=11, color=INK)
        axes.axvline(0, color=SOFT, linewidth=0.5, zorder=0)
        for side in ("top", "right"):
            axes.spines[side].set_visible(False)
        if bottom < 0.2:
            axes.set_xlabel(x_label, color=INK)
        else:
            axes.set_xticklabels([])


def _prefix(largest: float) -> tuple[float, str]:
    if largest >= 1e4:
        return 1e-3, "k"
    return (1.0, "") if largest >= 0.1 or largest == 0 else (1e3, "m")


def _panel(axes: Any, x: FloatArray, y: FloatArray, lines: list[Any], start: int, rubs: bool, opens: bool) -> None:
    """The loop, and slopes through its first point and through the place where the cycle turns."""
    axes.fill(x[start:], y[start:], facecolor=FILL, edgecolor="none", zorder=1)
    axes.plot(x, y, color=INK, linewidth=1.7, zorder=4, label="section that rubs" if rubs else "section that opens")
    reach_x, reach_y = 1.12 * float(np.abs(x).max()), 1.25 * (float(np.abs(y).max()) or 1.0)
    line = np.array([-reach_x, reach_x])
    for slope, colour, dash, label in lines:
        along = y[0] + slope * (line - x[0])
        axes.plot(line, along, color=colour, linestyle=dash, linewidth=1.2, zorder=3, label=label)
        if rubs and not opens:
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
