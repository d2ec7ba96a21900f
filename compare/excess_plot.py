"""Pictures of where a model fails: map of the excess, excess against what was varied, energy of the loops.

Vermilion is the base model, green the model with effects, blue the measurement. matplotlib is imported when a picture is
asked for.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from compare.comparison import ChannelFit
from compare.experiment import Experiment
from compare.findings import Findings
from compare.kinds import SETS
from compare.loading import amplitude, loop_energy, mean_rate
from compare.plot_style import BLUE, GREEN, INK, PAGE_WIDTH, VERMILLION, title, told, varying
from compare.residual_plot import same_record

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_MOST_ROWS = 40
_SHOWN = {
    "temperature": (" [°C]", 1.0, -273.15), "axial tension": (" [N]", 1.0, 0.0), "specimen length": (" [m]", 1.0, 0.0),
    "tail tension": (" [N]", 1.0, 0.0), "speed": (" [m/s]", 1.0, 0.0), "inclination": (" [°]", 180 / np.pi, 0.0),
}  # fmt: skip


def where_figure(f: Findings) -> Figure:
    """Map of the excess over the noise floor: experiments and channels downwards, before and after sideways."""
    from matplotlib.figure import Figure

    fits = sorted(f.comparison.fits, key=lambda x: -x.relative_excess)[:_MOST_ROWS]
    fits = sorted(fits, key=lambda x: (x.experiment.kind, SETS.index(x.experiment.set), x.channel, x.experiment.id))
    values = [[x.relative_excess] for x in fits]
    heads = ["base model"]
    if f.after is not f.comparison:
        heads.append("with effects")
        values = [[x.relative_excess, same_record(x, f.after).relative_excess] for x in fits]
    figure = Figure(figsize=(PAGE_WIDTH, 1.3 + 0.21 * len(fits)))
    axes = figure.add_subplot()
    table = np.array(values)
    norm = _map_norm(max(3.0, float(table.max())))
    axes.imshow(table, aspect="auto", cmap="YlOrBr", norm=norm)
    for (i, j), value in np.ndenumerate(table):
        dark = float(norm(value)) > 0.6
        axes.text(j, i, f"{value:.2g}", ha="center", va="center", fontsize=7.5, color="white" if dark else INK)
    many = varying([x.experiment for x in fits])
    axes.set_xticks(range(len(heads)), heads)
    axes.xaxis.tick_top()
    axes.set_yticks(range(len(fits)), [_row_name(x) for x in fits], fontsize=7.5)
    for i, x in enumerate(fits):
        words = ", ".join(told(name, x.experiment.conditions) for name in many if name in x.experiment.conditions)
        axes.text(len(heads) - 0.45, i, words, va="center", fontsize=7, color=INK, clip_on=False)
    axes.tick_params(length=0)
    axes.spines[:].set_visible(False)
    engine = figure.get_layout_engine()
    if many and engine is not None:
        engine.set(rect=(0, 0, 0.74, 1))  # pyright: ignore[reportCallIssue]
    title(figure, "Excess over the noise floor [noise floors]", f.comparison.fits, fits)
    return figure


def _map_norm(top: float) -> Any:
    from matplotlib.colors import PowerNorm

    return PowerNorm(0.5, 0.0, top)


def _row_name(fit: ChannelFit) -> str:
    return f"{fit.experiment.id}  {fit.experiment.kind} {fit.channel}  ({fit.experiment.set})"


def covariates(f: Findings) -> dict[str, np.ndarray]:
    """What varied between the compared records: amplitude, rate and recorded conditions, each (n,), NaN where unknown."""
    fits = f.comparison.fits
    found = dict((_of_the_path(f, "amplitude", amplitude), _of_the_path(f, "mean rate", mean_rate)))
    for name in varying([x.experiment for x in fits]):
        unit, factor, shift = _SHOWN.get(name, ("", 1.0, 0.0))
        found[name + unit] = np.array([factor * x.experiment.conditions.get(name, np.nan) + shift for x in fits])
    return {name: v for name, v in found.items() if np.isfinite(v).any() and np.nanmax(v) > 1.05 * np.nanmin(v)}


def _of_the_path(f: Findings, name: str, of: Callable[[Experiment], float]) -> tuple[str, np.ndarray]:
    """A number of each record with its unit; where several paths were prescribed, over the largest of its own."""
    experiments = [x.experiment for x in f.comparison.fits]
    paths = [e.record.prescribed for e in experiments]
    values = np.array([of(e) for e in experiments])
    if len(set(paths)) == 1:
        per = "/s" if of is mean_rate else ""
        unit = experiments[0].record.channels[paths[0]].unit
        return f"{name} of the {paths[0]} [{'' if unit == '1' and per else unit}{per}]".replace("[/s]", "[1/s]"), values
    largest = {p: max((v for v, q in zip(values, paths) if q == p and np.isfinite(v)), default=1.0) for p in paths}
    return f"{name}, over the largest of its path", values / np.array([largest[p] or 1.0 for p in paths])


def conditions_figure(f: Findings) -> Figure:
    """Excess of every record against each condition that varied, before and after."""
    from matplotlib.figure import Figure

    found = dict(list(covariates(f).items())[:6])
    rows = -(-len(found) // 2)
    figure = Figure(figsize=(PAGE_WIDTH, 0.9 + 2.1 * rows))
    panels = np.atleast_1d(figure.subplots(rows, 2, sharey=True, squeeze=False)).ravel()
    before = np.array([x.relative_excess for x in f.comparison.fits])
    after = np.array([same_record(x, f.after).relative_excess for x in f.comparison.fits])
    for axes, (name, x) in zip(panels, found.items()):
        axes.plot(x, before, "o", color=VERMILLION, ms=5, alpha=0.75, label="base model")
        if f.after is not f.comparison:
            axes.plot(x, after, "^", mfc="none", mec=GREEN, ms=5, label="with effects")
        positive = x[np.isfinite(x)]
        if positive.min() > 0 and positive.max() > 20 * positive.min():
            axes.set_xscale("log")
        axes.set_xlabel(name)
        axes.set_ylim(bottom=min(0.0, -0.03 * float(before.max())))
    for axes in panels[len(found) :]:
        axes.set_visible(False)
    for axes in panels[::2]:
        axes.set_ylabel("excess [floors]")
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=2, frameon=False)
    title(figure, "Excess against what was varied")
    return figure


def closed_loops(f: Findings) -> list[tuple[ChannelFit, float]]:
    found = [(x, loop_energy(x)) for x in f.comparison.fits]
    return [(x, e) for x, e in found if e is not None and e > 0]


def loop_energy_figure(f: Findings) -> Figure:
    """Energy of one loop against amplitude and against rate; the base model has none."""
    from matplotlib.figure import Figure

    found = closed_loops(f)
    figure = Figure(figsize=(PAGE_WIDTH, 3.2))
    panels: Any = figure.subplots(1, 2, sharey=True)
    measured = np.array([e for _, e in found])
    model = np.array([loop_energy(same_record(x, f.after), model=True) or 0.0 for x, _ in found])
    everywhere = [(x.experiment.id, x.channel) for x in f.comparison.fits]
    chosen = [everywhere.index((x.experiment.id, x.channel)) for x, _ in found]
    for axes, (name, values) in zip(
        panels, (_of_the_path(f, "amplitude", amplitude), _of_the_path(f, "mean rate", mean_rate)), strict=True
    ):
        at = values[chosen]
        axes.plot(at, measured, "o", color=BLUE, ms=5.5, alpha=0.8, label="measured")
        if f.after is not f.comparison and model.max() > 1e-6 * measured.max():
            axes.plot(at, model, "x", color=GREEN, ms=6.5, mew=1.6, label="model with effects")
        axes.set_xlabel(name)
        axes.set_xlim(left=0)
        axes.set_ylim(bottom=0)
    units = {_energy_unit(x) for x, _ in found}
    panels[0].set_ylabel(f"energy of a loop [{', '.join(sorted(units))}]")
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=2, frameon=False)
    title(figure, "Energy lost in one loop (the base model loses none)")
    return figure


def _energy_unit(fit: ChannelFit) -> str:
    """J of a force over a length or a moment over an angle; J/m of a load over a strain, a twist or a curvature."""
    return "J" if fit.experiment.record.prescribed in ("extension", "rotation", "deflection") else "J/m"
