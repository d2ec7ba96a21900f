"""Pictures of a towing run: the deformed cable, forces at the published nodes, pull force, energies.

Every function returns a matplotlib figure; published numbers are dashed and say so.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import matplotlib

matplotlib.use("Agg", force=False)

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.patches import Circle

from beam.towing_record import PLATEAU_FROM, PUBLISHED_NODES

if TYPE_CHECKING:
    import xarray

    from beam.towing_run import TowingRun

NODE_COLOURS = {54: "#0072B2", 199: "#D55E00", 220: "#009E73", 370: "#8856A7"}
NODE_PLACES = {
    54: "near the shearer",
    199: "upper end of the bend",
    220: "lower end of the bend",
    370: "near the supply",
}
PUBLISHED_STYLE: dict[str, Any] = {"color": "#444444", "linestyle": (0, (5, 3)), "linewidth": 1.2}


def cable_figure(run: TowingRun, times: tuple[float, ...] | None = None) -> Figure:
    """Side view of the cable at several times, tension as colour; trough, deck and roller drawn. The height is stretched."""
    data = run.dataset
    end = float(data["time"].values[-1])
    times = times or (0.0, end / 3, 2 * end / 3, end)
    tension = data["force_local"].values[:, :, 0]
    low, high = float(tension.min()), float(tension.max())
    figure, axes = plt.subplots(len(times), 1, figsize=(10, 1.7 * len(times) + 0.6), sharex=True, layout="constrained")
    lines = None
    for ax, t in zip(np.atleast_1d(axes), times, strict=True):
        k = int(np.argmin(np.abs(data["time"].values - t)))
        lines = _draw_cable(ax, run, data, k, tension[k], (low, high))
    assert lines is not None
    np.atleast_1d(axes)[-1].set_xlabel("x along the trough [m], shearer travels to the right")
    figure.colorbar(lines, ax=axes, label="tension [N]", shrink=0.9, pad=0.01)
    figure.suptitle(f"{run.scenario.title}\nside view of the centre line, height stretched", fontsize=11)
    return figure


def _draw_cable(
    ax: Any, run: TowingRun, data: xarray.Dataset, k: int, tension: np.ndarray, limits: tuple[float, float]
) -> LineCollection:
    scenario = run.scenario
    R, t = scenario.layout.bend_radius.value, float(data["time"].values[k])
    xy = data["position"].values[k, :, :2]
    centre = scenario.roller_start + float(scenario.trolley(t)[0][0])
    ax.axhspan(-0.25, 0.0, color="#d9d9d9", zorder=0)
    deck = scenario.deck_height
    ax.fill_between([centre, 12.0], deck - 0.05, deck, color="#d9d9d9", zorder=0)
    if scenario.towing != "conventional":
        ax.add_patch(Circle((centre, R), R, facecolor="#eeeeee", edgecolor="#777777", linewidth=1, zorder=1))
        ax.plot([centre], [R], "+", color="#777777")
    segments = np.stack([xy[:-1], xy[1:]], axis=1)
    lines = LineCollection(list(segments), cmap="viridis", norm=Normalize(*limits), linewidths=3, zorder=3)
    lines.set_array(0.5 * (tension[:-1] + tension[1:]))
    ax.add_collection(lines)
    for number in PUBLISHED_NODES:
        x, y = data["position"].sel(node=run.node(number)).values[k, :2]
        ax.plot([x], [y], "o", ms=5, mfc="white", mec=NODE_COLOURS[number], mew=1.5, zorder=4)
        place, align = ((-7, -3), "right") if x < centre else ((0, 6 if y > R else -12), "center")
        style: dict[str, Any] = {"textcoords": "offset points", "fontsize": 8, "color": NODE_COLOURS[number]}
        ax.annotate(str(number), (x, y), place, ha=align, **style)
    ax.plot([0.0], [0.0], "s", color="black", ms=6, zorder=4)
    ax.annotate("supply", (0.0, 0.0), (6, 3), textcoords="offset points", fontsize=8)
    ax.annotate("shearer", tuple(xy[-1]), (6, -3), textcoords="offset points", fontsize=8)
    ax.plot(*xy[-1], ">", color="black", ms=6, zorder=4)
    ax.set(xlim=(-scenario.lower_strand - 2 * R - 0.2, max(2.0, float(data["position"].values[:, :, 0].max()) + 1.2)))
    ax.set(ylim=(-0.25, 2 * R + 0.3), ylabel="y [m]")
    ax.text(0.995, 0.5, f"t = {t:.2f} s", transform=ax.transAxes, ha="right", va="center", fontsize=9)
    return lines


def node_force_figure(run: TowingRun) -> Figure:
    """Fx and Fy at the published nodes over time, with the published steady values."""
    data = run.dataset
    time = data["time"].values
    figure, axes = plt.subplots(2, 1, figsize=(8, 6.4), sharex=True, layout="constrained")
    for number in PUBLISHED_NODES:
        force = data["force_global"].sel(node=run.node(number)).values
        label = f"node {number}, {NODE_PLACES[number]}"
        for ax, component in zip(axes, (0, 1), strict=True):
            ax.plot(time, force[:, component], color=NODE_COLOURS[number], label=label, linewidth=1.6)
    results = run.scenario.published_results
    _published(axes[0], results.node_54_Fx_plateau, "published, node 54 steady", time)
    _published(axes[0], results.node_370_Fx_max, "published bound, node 370", time)
    _published(axes[1], results.node_220_Fy_plateau, "published, node 220 (sign as published)", time)
    axes[0].set_ylabel("Fx [N], along the trough")
    axes[1].set_ylabel("Fy [N], normal to the trough")
    axes[1].set_xlabel("time [s]")
    axes[0].legend(fontsize=8, loc="upper left")
    axes[0].set_title(f"{run.scenario.title}\nsection force of the shearer's side on the supply's side", fontsize=10)
    _finish(axes)
    return figure


def pull_force_figure(run: TowingRun) -> Figure:
    """Pull force of the shearer beside formulas (22), (23) and the published plateau."""
    data = run.dataset
    time = data["time"].values
    figure, ax = plt.subplots(figsize=(8, 4.2), layout="constrained")
    ax.plot(time, data["pull_force"].values[:, 0], color="#0072B2", linewidth=1.8, label="computed pull force")
    ax.plot(time, data["formula_up"].values, color="#D55E00", linewidth=1.4, label="formula (22), up")
    style: dict[str, Any] = {"color": "#E69F00", "linewidth": 1.4, "linestyle": ":"}
    ax.plot(time, data["formula_down"].values, label="formula (23), down", **style)
    _published(ax, run.scenario.published_results.node_54_Fx_plateau, "published, node 54 steady", time)
    ax.set(xlabel="time [s]", ylabel="force [N]", ylim=(0, None))
    ax.set_title(f"{run.scenario.title}\npull force; constants: {run.scenario.constants}", fontsize=10)
    ax.legend(fontsize=8, loc="upper left")
    _finish([ax])
    return figure


def energy_figure(run: TowingRun) -> Figure:
    """Energies since the start by source, and the work of the drives that pays for them."""
    data = run.dataset
    time = data["time"].values
    energy = data["energy"].values - data["energy"].values[0]
    names = [str(name).replace("_", " ") for name in data["source"].values]
    figure, ax = plt.subplots(figsize=(8, 4.2), layout="constrained")
    colours = (
        "#56B4E9",
        "#0072B2",
        "#999999",
        "#E69F00",
        "#F0E442",
        "#8856A7",
        "#CC79A7",
        "#D55E00",
        "#8C510A",
        "#01665E",
        "#4D4D4D",
    )
    for k, name in enumerate(names[:-1]):
        ax.plot(time, energy[:, k], label=name, color=colours[k], linewidth=1.5)
    ax.plot(time, energy[:, -1], label=names[-1], color="black", linewidth=1.8)
    ax.plot(time, energy[:, :-1].sum(axis=1), "--", color="#009E73", label="sum of all but the work", linewidth=1.4)
    ax.set(xlabel="time [s]", ylabel="energy since the start [J]")
    ax.set_title(
        f"{run.scenario.title}\nenergy balance closed to {abs(run.balance_error):.1e} of the throughput", fontsize=10
    )
    ax.legend(fontsize=8, loc="upper left")
    _finish([ax])
    return figure


def _published(ax: Any, entry: Any, label: str, time: np.ndarray) -> None:
    if entry is None:
        return
    ax.plot([min(PLATEAU_FROM, 0.6 * time[-1]), time[-1]], [entry.value] * 2, **PUBLISHED_STYLE)
    ax.annotate(
        f"{label}: {entry.text}", (time[-1], entry.value), (0, 3), textcoords="offset points", ha="right", fontsize=8
    )


def _finish(axes: Any) -> None:
    for ax in axes:
        ax.grid(True, color="#e5e5e5", linewidth=0.6)
        ax.margins(x=0.01)
        for side in ("top", "right"):
            ax.spines[side].set_visible(False)
