"""Picture of a sweep: the pull force over the swept axes, as lines, or as a map where both axes have many values.

The axis with the most numbers is horizontal, the next one is colour, the others are panels. Runs without a result are crosses
at the foot of their panel.
"""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, Any

import matplotlib

matplotlib.use("Agg", force=False)

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

from beam.sweep_axis import Axis

if TYPE_CHECKING:
    from beam.sweep_record import SweepFolder

MANY = 7
"""More values than these on the colour axis make a map."""
PANELS = 12


def sweep_figure(folder: SweepFolder, quantity: str = "pull_force_plateau") -> Figure:
    """The picture; of more than twelve panels the first twelve are drawn and the title says so."""
    data = folder.dataset
    across, colour, others = _roles(folder.axes)
    places = list(itertools.product(*(range(len(axis.texts)) for axis in others)))
    shown = places[:PANELS]
    columns = min(3, len(shown))
    rows = -(-len(shown) // columns)
    figure, axes = plt.subplots(
        rows, columns, figsize=(4.6 * columns + 1.4, 3.4 * rows + 0.9), sharex=True, sharey=True, squeeze=False, layout="constrained"
    )  # fmt: skip
    unit, meaning = data[quantity].attrs["units"], data[quantity].attrs["long_name"].split(":")[0]
    values = data[quantity].values
    limits = (float(np.nanmin(values)), float(np.nanmax(values))) if np.isfinite(values).any() else (0.0, 1.0)
    as_map = colour is not None and colour.unit != "" and across.unit != "" and len(colour.texts) > MANY
    drawn: Any = None
    for ax, place in itertools.zip_longest(axes.flat, shown):
        if place is None:
            ax.set_visible(False)
            continue
        part = data[quantity].isel({axis.name: i for axis, i in zip(others, place, strict=True)})
        if as_map and colour is not None:
            drawn = _map(ax, part.transpose(colour.name, across.name).values, across, colour, limits)
        else:
            _lines(ax, part, across, colour)
        said = ", ".join(f"{a.name} {a.texts[i]}" for a, i in zip(others, place, strict=True) if len(a.texts) > 1)
        ax.set_title(said, fontsize=9)
        if across.unit == "":
            ax.set_xticks(range(len(across.texts)), across.texts)
    for ax in axes[:, 0]:
        ax.set_ylabel(colour.label if as_map and colour is not None else f"{meaning} [{unit}]")
    for k in range(columns):
        last = max(r for r in range(rows) if r * columns + k < len(shown))
        axes[last, k].set_xlabel(across.label)
        axes[last, k].tick_params(labelbottom=True)
    if as_map:
        figure.colorbar(drawn, ax=axes, label=f"{meaning} [{unit}]")
    elif colour is not None:
        axes.flat[min(columns, len(shown)) - 1].legend(
            title=colour.label, fontsize=8, title_fontsize=8, loc="upper left", bbox_to_anchor=(1.01, 1.0)
        )
    _title(figure, folder, meaning, len(places))
    return figure


def _roles(axes: list[Axis]) -> tuple[Axis, Axis | None, list[Axis]]:
    """Horizontal axis, colour axis, panel axes."""
    order = sorted(axes, key=lambda a: (a.unit == "", -len(a.texts)) if len(a.texts) > 1 else (True, 0))
    across, rest = order[0], order[1:]
    colour = next((axis for axis in rest if len(axis.texts) > 1), None)
    return across, colour, [axis for axis in axes if axis is not across and axis is not colour]


def _lines(ax: Any, part: Any, across: Axis, colour: Axis | None) -> None:
    x = np.array(across.numbers)
    count = 1 if colour is None else len(colour.texts)
    shades = plt.get_cmap("viridis")(np.linspace(0.0, 0.85, count))
    order = np.argsort(x)
    for i in range(count):
        y = (part if colour is None else part.isel({colour.name: i})).values
        label = None if colour is None else (f"{colour.numbers[i]:g}" if colour.unit else colour.texts[i])
        ax.plot(x[order], y[order], "o-", color=shades[i], ms=4, lw=1.6, label=label)
        lost = ~np.isfinite(y)
        ax.plot(x[lost], np.full(lost.sum(), 0.02), "x", color=shades[i], transform=ax.get_xaxis_transform())
    ax.grid(True, color="#e5e5e5", linewidth=0.6)
    for side in ("top", "right"):
        ax.spines[side].set_visible(False)


def _map(ax: Any, values: np.ndarray, across: Axis, colour: Axis, limits: tuple[float, float]) -> Any:
    i, j = np.argsort(across.numbers), np.argsort(colour.numbers)
    x, y = np.array(across.numbers)[i], np.array(colour.numbers)[j]
    ax.set_facecolor("#dddddd")
    return ax.pcolormesh(x, y, values[np.ix_(j, i)], shading="nearest", cmap="viridis", vmin=limits[0], vmax=limits[1])


def _title(figure: Figure, folder: SweepFolder, meaning: str, panels: int) -> None:
    completed, failed, missing = folder.counts()
    text = f"{folder.title}\n{meaning}; {completed} runs completed"
    if failed or missing:
        text += f", {failed} failed, {missing} not run yet (crosses; grey in a map)"
    if panels > PANELS:
        text += f"; the first {PANELS} of {panels} panels"
    figure.suptitle(text, fontsize=10)
