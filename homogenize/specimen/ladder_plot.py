"""The ladder as a picture: the misfit of each rung, and every number with its value, placed by its ratio to the published one."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from homogenize.specimen.ladder import PUBLISHED, Rung

INK, SOFT, BLUE, ORANGE = "#22262b", "#6b7178", "#0072b2", "#d55e00"
_COLUMNS = (
    ("E", "E\nMPa", 1e-6, ("E",)),
    ("G_yoz", r"$G_{yoz}$" + "\nMPa", 1e-6, ("G_yoz",)),
    ("G_xoz", r"$G_{xoz}$" + "\nMPa", 1e-6, ("G_xoz",)),
    ("u_z", r"$u_z$, 2000 N" + "\nmm", 1e3, ("u_z",)),
    ("u_x", r"$u_{\pm x}$, 500 N" + "\nmm", 1e3, ("u_plus_x", "u_minus_x")),
    ("u_y", r"$u_{\pm y}$, 500 N" + "\nmm", 1e3, ("u_plus_y", "u_minus_y")),
)
_TICKS = {True: (0.01, 0.1, 1.0, 10.0, 100.0), False: (0.5, 1.0, 1.5, 2.0, 3.0)}
"""Where a column spans more than a decade, and where less."""
_NEAR = 0.1
"""The band about the published value that is shaded."""


def ladder_plot(rungs: Sequence[Rung], title: str = "") -> Any:
    """Draw the ladder, the published numbers as its last row.

    Returns
    -------
    matplotlib Figure
    """
    from matplotlib.figure import Figure

    rows = [*rungs, PUBLISHED]
    figure = Figure(figsize=(13.0, 0.62 * len(rows) + 1.9), layout="constrained")
    columns = figure.subplots(1, 1 + len(_COLUMNS), sharey=True, width_ratios=(1.25, *[1.0] * len(_COLUMNS)))
    heights = np.arange(len(rows))[::-1]
    _draw_misfit(columns[0], rungs, heights)
    for axes, (_, head, scale, keys) in zip(columns[1:], _COLUMNS):
        _draw_column(axes, rows, heights, keys, scale)
        axes.set_title(head, fontsize=9, color=INK)
    for axes in columns:
        axes.spines[["top", "right", "left"]].set_visible(False)
        axes.tick_params(axis="y", length=0)
        axes.tick_params(axis="x", labelsize=8, colors=SOFT)
        axes.set_ylim(-0.6, len(rows) - 0.4)
        for h in heights[:-1]:
            axes.axhline(h - 0.5, color="0.9" if h > 1 else "0.5", lw=0.7)
    names = [f"{rung.name}\n{rung.remark}" if rung.remark else rung.name for rung in rows]
    columns[0].set_yticks(heights, names, fontsize=9)
    figure.supxlabel("ratio to the published value; shaded: within 10 %", fontsize=9, color=SOFT)
    if title:
        figure.suptitle(title, fontsize=10, color=INK)
    return figure


def _draw_misfit(axes: Any, rungs: Sequence[Rung], heights: Any) -> None:
    misfit = [rung.misfit(PUBLISHED) for rung in rungs]
    axes.set_xscale("log")
    axes.set_xlim(min(misfit) / 6, max(misfit) * 4)
    axes.plot(misfit, heights[:-1], "o-", color=ORANGE, ms=7, lw=1.6)
    for m, before, h in zip(misfit, [0.0, *misfit], heights):
        at, side = ((-7, -4), "right") if before > 1.3 * m else ((8, 4), "left")  # beside the line that comes down
        axes.annotate(f"{m:.2f}", (m, h), xytext=at, textcoords="offset points", ha=side, fontsize=9, color=ORANGE)
    axes.minorticks_off()
    shown = [t for t in (0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0) if axes.get_xlim()[0] <= t <= axes.get_xlim()[1]]
    axes.set_xticks(shown[::2], [f"{t:g}" for t in shown[::2]])
    axes.set_title("misfit\nrms of log ratios", fontsize=9, color=ORANGE)


def _draw_column(axes: Any, rows: Sequence[Rung], heights: Any, keys: tuple[str, ...], scale: float) -> None:
    published = PUBLISHED.numbers()
    numbers = [[rung.numbers()[key] for key in keys] for rung in rows]
    ratios = np.array(numbers) / [published[key] for key in keys]
    low, high = min(float(ratios.min()), 0.8), max(float(ratios.max()), 1.25)
    room = (high / low) ** 0.6
    axes.set_xscale("log")
    axes.set_xlim(low / room, high * room)
    axes.axvspan(1 - _NEAR, 1 + _NEAR, color=BLUE, alpha=0.10, lw=0)
    axes.axvline(1.0, color=SOFT, lw=0.9)
    for values, row, h in zip(numbers, ratios, heights):
        alike = len(keys) == 2 and values[0] == values[1]
        for k, (value, ratio) in enumerate(zip(values, row)):
            at = h if len(keys) == 1 else h + (0.18, -0.18)[k]
            sign = "" if len(keys) == 1 else "\u00b1" if alike else "+\u2212"[k]
            axes.plot(ratio, at, "o" if len(keys) == 1 else "><"[k], color=BLUE, ms=5)
            if alike and k == 1:
                continue
            left = ratio < 1
            axes.annotate(
                f"{sign}{_number(scale * value)}", (ratio, h if alike else at), xytext=(-8 if left else 8, 0),
                textcoords="offset points", ha="right" if left else "left", va="center", fontsize=8.5, color=INK,
            )  # fmt: skip
    axes.minorticks_off()
    ticks = [t for t in _TICKS[high > 10 * low] if low / room <= t <= high * room]
    axes.set_xticks(ticks, [f"{t:g}" for t in ticks])


def _number(value: float) -> str:
    """Three digits."""
    return f"{value:.0f}" if value >= 100 else f"{value:.3g}"
