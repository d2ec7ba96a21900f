"""Picture of the fatigue-relevant history of a run: smallest bend radius over time, ranges along the cable, rainflow cycles."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import matplotlib

matplotlib.use("Agg", force=False)

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

from beam.fatigue_history import CycleCount, FatigueHistory

if TYPE_CHECKING:
    import xarray

BENDING, TENSION = "#0072B2", "#D55E00"


def fatigue_figure(data: xarray.Dataset, history: FatigueHistory) -> Figure:
    """Four panels; `data` is the run's dataset, `history` comes from :func:`beam.fatigue_history.fatigue_history`."""
    figure, axes = plt.subplots(2, 2, figsize=(9.6, 6.2), layout="constrained")
    (radius, ranges), (bends, pulls) = axes
    radius.plot(data["time"].values, 1e3 * data["bend_radius"].values, color="black", linewidth=1.5)
    radius.set(xlabel="time [s]", ylabel="smallest bend radius [mm]", title="Bend radius of the centre line")
    low = 1e3 * float(data["bend_radius"].values.min())
    radius.axhline(low, color="#777777", linestyle=":", linewidth=1)
    radius.annotate(
        f"least {low:.0f} mm",
        (data["time"].values[-1], low),
        (0, -11),
        textcoords="offset points",
        ha="right",
        fontsize=8,
    )
    radius.margins(y=0.15)
    ranges.plot(history.s, history.curvature_range, color=BENDING, linewidth=1.5)
    ranges.set(xlabel="arc length from the supply [m]", title="Ranges of the sections over the run")
    ranges.set_ylabel("range of the curvature [1/m]", color=BENDING)
    other = ranges.twinx()
    other.plot(history.s, history.tension_range, color=TENSION, linewidth=1.2)
    other.set_ylabel("range of the tension [N]", color=TENSION)
    other.set_ylim(0, None)
    ranges.set_ylim(0, None)
    _cycles(
        bends,
        history.bending_cycles,
        "range of the curvature [1/m]",
        BENDING,
        "Rainflow cycles of bending, all sections",
    )
    _cycles(
        pulls, history.tension_cycles, "range of the tension [N]", TENSION, "Rainflow cycles of tension, all sections"
    )
    for ax in (radius, bends, pulls):
        for side in ("top", "right"):
            ax.spines[side].set_visible(False)
    figure.suptitle(str(data.attrs.get("title", "")), fontsize=11)
    return figure


def _cycles(ax: Any, counts: Sequence[CycleCount], label: str, colour: str, title: str) -> None:
    sizes = np.concatenate([np.zeros(0), *(one.range for one in counts)])
    weight = np.concatenate([np.zeros(0), *(one.count for one in counts)]) / max(len(counts), 1)
    top = float(sizes.max()) if sizes.size else 1.0
    ax.hist(sizes, bins=list(np.linspace(0, top, 25)), weights=weight, color=colour, edgecolor="white", linewidth=0.5)
    ax.set(xlabel=label, ylabel="cycles a section, mean", title=title, yscale="log")
