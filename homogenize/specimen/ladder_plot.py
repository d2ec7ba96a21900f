"""The ladder as a picture: every number over its published value, rung by rung."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from homogenize.specimen.ladder import PUBLISHED, Rung

_LABELS = {
    "E": ("E", "o", "#1b4f72"),
    "G_yoz": (r"$G_{yoz}$", "s", "#b03a2e"),
    "G_xoz": (r"$G_{xoz}$", "D", "#e08e79"),
    "u_z": (r"$u_z$", "^", "#2e86c1"),
    "u_plus_x": (r"$u_{+x}$", ">", "#1e8449"),
    "u_minus_x": (r"$u_{-x}$", "<", "#1e8449"),
    "u_plus_y": (r"$u_{+y}$", ">", "#82b74b"),
    "u_minus_y": (r"$u_{-y}$", "<", "#82b74b"),
}


def ladder_plot(rungs: Sequence[Rung], title: str = "") -> Any:
    """Draw the ladder.

    Returns
    -------
    matplotlib Figure
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10.5, 0.62 * len(rungs) + 2.6), layout="constrained")
    moduli, displacements = figure.subplots(1, 2, sharey=True)
    published = PUBLISHED.numbers()
    heights = np.arange(len(rungs))[::-1]
    for key, (label, marker, colour) in _LABELS.items():
        axes = displacements if key.startswith("u_") else moduli
        ratio = [r.numbers()[key] / published[key] for r in rungs]
        shift = {"G_yoz": 0.0, "G_xoz": -0.18, "E": 0.18, "u_z": 0.24, "u_plus_x": 0.12, "u_minus_x": 0.0}.get(
            key, -0.12
        )
        shift = -0.24 if key == "u_minus_y" else shift
        axes.plot(
            ratio,
            heights + shift,
            marker,
            color=colour,
            ms=6,
            label=label,
            mfc=colour if key != "u_minus_x" else "white",
        )
    for axes, what in ((moduli, "modulus / published"), (displacements, "largest displacement / published")):
        axes.axvline(1.0, color="0.35", lw=1)
        axes.set_xscale("log")
        axes.set_xlabel(what)
        axes.grid(axis="x", which="both", color="0.9", lw=0.6)
        axes.legend(
            loc="upper center", bbox_to_anchor=(0.5, 1.13), ncols=5, fontsize=8, frameon=False, handletextpad=0.1
        )
        for h in heights[:-1]:
            axes.axhline(h - 0.5, color="0.85", lw=0.6)
    moduli.set_yticks(heights, [f"{r.name}\n{r.remark}" if r.remark else r.name for r in rungs], fontsize=8)
    if title:
        figure.suptitle(title, fontsize=10)
    return figure
