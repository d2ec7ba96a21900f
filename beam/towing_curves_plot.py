"""The curves of figures 17 and 18 of the source: forces at its four nodes, displacements, bushing 3, contact 35, formulas (22), (23).

Source of the layout: M. Ge et al., PLoS ONE 18(2) e0281136 (2023). With clamps the cable's force and that of the chain at the nearest pin
are both drawn, as the source's clamps carry the tension. Published numbers are dashed.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import matplotlib

matplotlib.use("Agg", force=False)

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

from beam.chain_record import BUSHING, CONTACT, nearest_pin, pressure
from beam.towing_plot import NODE_COLOURS, NODE_PLACES, PUBLISHED_STYLE
from beam.towing_record import PUBLISHED_NODES

if TYPE_CHECKING:
    from beam.towing_run import TowingRun

AXIS_COLOURS = {"x": "#0072B2", "y": "#D55E00", "z": "#009E73"}
PUBLISHED_FORCES = {54: ("x", "node_54_Fx_plateau"), 220: ("y", "node_220_Fy_plateau"), 370: ("x", "node_370_Fx_max")}


def forces_figure(run: TowingRun) -> Figure:
    """Figure 17: forces in x, y, z over time at the nodes 54, 199, 220, 370, one panel each."""
    data = run.dataset
    time, clamps = data["time"].values, "pin" in data.dims
    figure, axes = plt.subplots(2, 2, figsize=(10, 6.6), sharex=True, layout="constrained")
    for letter, ax, number in zip("abcd", axes.flat, PUBLISHED_NODES, strict=True):
        node = run.node(number)
        cable = data["force_global"].sel(node=node).values
        chain = data["chain_force"].sel(pin=nearest_pin(data, node)).values if clamps else None
        for k, axis in enumerate("xyz"):
            label = f"F{axis}" + (" of the cable" if clamps else "")
            ax.plot(time, cable[:, k], color=AXIS_COLOURS[axis], linewidth=1.5, label=label)
            if chain is not None:
                style: dict[str, Any] = {"color": AXIS_COLOURS[axis], "linewidth": 1.2, "linestyle": (0, (2, 1.2))}
                ax.plot(time, chain[:, k], label=f"F{axis} of the clamps", **style)
        ax.set_title(f"({letter}) node {number}, {NODE_PLACES[number]}", fontsize=10)
        if number in PUBLISHED_FORCES:
            axis, key = PUBLISHED_FORCES[number]
            _dashed(ax, run, key, f"published F{axis}")
    for ax in axes[:, 0]:
        ax.set_ylabel("force [N]")
    for ax in axes[1]:
        ax.set_xlabel("time [s]")
    figure.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=6, fontsize=8)
    figure.suptitle(f"{run.scenario.title}\nforce of the shearer's side on the supply's side", fontsize=11)
    _finish(axes.flat)
    return figure


def courses_figure(run: TowingRun) -> Figure:
    """Figure 18: displacement and lateral displacement of the nodes, bushing 3, contact 35, pull force beside (22) and (23)."""
    data = run.dataset
    time = data["time"].values
    figure, axes = plt.subplots(3, 2, figsize=(10, 8.4), sharex=True, layout="constrained")
    for number in PUBLISHED_NODES:
        place = data["position"].sel(node=run.node(number)).values
        style: dict[str, Any] = {"color": NODE_COLOURS[number], "label": f"node {number}", "linewidth": 1.5}
        axes[0, 0].plot(time, np.linalg.norm(place - place[0], axis=1), **style)
        axes[0, 1].plot(time, 1e3 * (place[:, 2] - place[0, 2]), **style)
    axes[0, 0].set(title="(a) displacement", ylabel="[m]")
    axes[0, 1].set(title="(b) lateral displacement since the start", ylabel="[mm]")
    axes[0, 0].legend(fontsize=8)
    if np.ptp(data["position"].values[:, :, 2]) < 1e-6:
        axes[0, 1].set_ylim(-1, 1)
        _say(axes[0, 1], "none: the run is plane")
    _chain_panels(axes[1], run)
    _tension_panels(axes[2], run)
    for ax in axes[2]:
        ax.set_xlabel("time [s]")
    figure.suptitle(run.scenario.title, fontsize=11)
    _finish(axes.flat)
    return figure


def _chain_panels(axes: Any, run: TowingRun) -> None:
    data = run.dataset
    time = data["time"].values
    axes[0].set(title=f"(c) bushing {BUSHING}", ylabel="force [N]")
    axes[1].set(title=f"(d) contact of cable and link {CONTACT}", ylabel="force [N]")
    if "clamp" not in data.dims:
        for ax in axes:
            _say(ax, "the clamps are mass on the cable in this run")
        return
    for axis in "xyz":
        force = data["bushing_force"].sel(bushing=BUSHING, direction=axis).values
        names = {"x": "along the chain (tension)", "y": "normal", "z": "across"}
        axes[0].plot(time, force, color=AXIS_COLOURS[axis], label=names[axis], linewidth=1.4)
    _dashed(axes[0], run, "bushing_3_amplitude", "published amplitude")
    axes[0].legend(fontsize=8, loc="upper left", bbox_to_anchor=(0.0, 0.9))
    axes[1].plot(time, pressure(data, CONTACT), color="black", linewidth=1.3)
    marks = (("contact_35_start", "published start", 0.88), ("contact_35_maximum_at", "published maximum", 0.88))
    for key, label, height in marks:
        entry = getattr(run.scenario.published_results, key)
        if entry is not None:
            axes[1].axvline(entry.value, **PUBLISHED_STYLE)
            place: dict[str, Any] = {
                "xycoords": axes[1].get_xaxis_transform(),
                "textcoords": "offset points",
                "fontsize": 8,
            }
            axes[1].annotate(f"{label}:\n{entry.text}", (entry.value, height), (4, 0), **place)


def _tension_panels(axes: Any, run: TowingRun) -> None:
    data = run.dataset
    time = data["time"].values
    pull = data["pull_force"].values[:, 0]
    axes[0].plot(time, pull, color="#0072B2", label="computed", linewidth=1.6)
    axes[0].plot(time, data["formula_up"].values, color="#D55E00", label="formula (22)", linewidth=1.3)
    axes[0].plot(time, data["formula_down"].values, ":", color="#E69F00", label="formula (23)", linewidth=1.6)
    axes[0].set(title="(e) pull force of the shearer", ylabel="force [N]")
    axes[0].legend(fontsize=8)
    axes[1].plot(time, 1e3 * data["bend_radius"].values, color="black", linewidth=1.4)
    axes[1].set(title="(f) smallest bend radius", ylabel="[mm]")


def _dashed(ax: Any, run: TowingRun, key: str, label: str) -> None:
    entry = getattr(run.scenario.published_results, key)
    if entry is None:
        return
    end = float(run.dataset["time"].values[-1])
    ax.plot([0.6 * end, end], [entry.value] * 2, **PUBLISHED_STYLE)
    text: dict[str, Any] = {"textcoords": "offset points", "ha": "right", "va": "center", "fontsize": 8}
    ax.annotate(f"{label}: {entry.text}", (0.6 * end, entry.value), (-4, 0), **text)


def _say(ax: Any, text: str) -> None:
    ax.text(0.5, 0.6, text, transform=ax.transAxes, ha="center", fontsize=9, color="#555555")


def _finish(axes: Any) -> None:
    for ax in axes:
        ax.grid(True, color="#e5e5e5", linewidth=0.6)
        ax.margins(x=0.01)
        for side in ("top", "right"):
            ax.spines[side].set_visible(False)
