"""Pictures of a comparison: model over measurement with the residual below, and where the model fails.

matplotlib is imported when a picture is asked for.
"""

from __future__ import annotations

from collections.abc import Sequence, Set
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from compare.comparison import ChannelFit, Comparison
from compare.plot_style import (
    BLUE,
    GREY,
    INK,
    SKY,
    STYLE,
    VERMILLION,
    force_scale,
    path_of,
    path_scale,
    thinned,
    told,
    varying,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_COLUMNS, _PANELS_A_PAGE = 4, 8
_MOST_BARS = 60


def plot_comparison(comparison: Comparison, folder: str | Path) -> list[Path]:
    """Write the pictures of a comparison as PNG files.

    Parameters
    ----------
    comparison : Comparison
        What :func:`compare.comparison.compare` found.
    folder : path
        Made if it is not there.

    Returns
    -------
    list of Path
        ``overview.png`` first, then ``<kind>-<channel>-<page>.png``; empty where nothing could be compared.
    """
    if not comparison.fits:
        return []
    import matplotlib
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    written = []
    with matplotlib.rc_context(STYLE):
        for name, figure in _figures(comparison):
            FigureCanvasAgg(figure)
            figure.savefig(folder / f"{name}.png")
            written.append(folder / f"{name}.png")
    return written


def _figures(comparison: Comparison) -> list[tuple[str, Figure]]:
    figures = [("overview", overview_figure(comparison))]
    failing = {(f.experiment.id, f.channel) for f in comparison.where_it_fails()}
    for kind, channel in dict.fromkeys((f.experiment.kind, f.channel) for f in comparison.fits):
        groups = _grouped([f for f in comparison.fits if (f.experiment.kind, f.channel) == (kind, channel)])
        pages = [groups[i : i + _PANELS_A_PAGE] for i in range(0, len(groups), _PANELS_A_PAGE)]
        for page, part in enumerate(pages, start=1):
            title = f"{kind}: {channel}, model over measurement" + (
                f" ({page} of {len(pages)})" if len(pages) > 1 else ""
            )
            name = f"{kind}-{channel.replace(' ', '-')}-{page}"
            figures.append((name, loops_figure(part, title, varying([g[0].experiment for g in groups]), failing)))
    return figures


def _grouped(fits: Sequence[ChannelFit]) -> list[list[ChannelFit]]:
    """Fits of one experiment and its repeats together, in the order of the campaign."""
    parent = {f.experiment.id: f.experiment.repeat_of for f in fits}
    groups: dict[str, list[ChannelFit]] = {}
    for fit in fits:
        root = fit.experiment.id
        while (above := parent.get(root)) is not None:
            root = above
        groups.setdefault(root, []).append(fit)
    return list(groups.values())


def loops_figure(
    groups: Sequence[Sequence[ChannelFit]], title: str, conditions: Sequence[str], failing: Set[tuple[str, str]]
) -> Figure:
    """One panel per experiment with its repeats: the loops, and below the residual with its noise band.

    Parameters
    ----------
    groups : sequence of sequences of ChannelFit
        Every group is drawn into one panel; all of one kind and channel.
    title : str
        Above the figure.
    conditions : sequence of str
        Names of the conditions that stand above every panel.
    failing : set of (experiment id, channel)
        Fits whose misfit noise does not explain.
    """
    from matplotlib.figure import Figure

    columns = min(_COLUMNS, len(groups))
    rows = -(-len(groups) // columns)
    width = 3.3 if columns > 1 else 6.0
    figure = Figure(figsize=(width * columns, 3.9 * rows + 0.8))
    outer = figure.add_gridspec(rows, columns, hspace=0.06)
    largest = max(float(np.abs(f.measured).max()) for group in groups for f in group)
    first = groups[0][0]
    x_scale, y_scale = path_scale(first.experiment.record.prescribed, first), force_scale(first.unit, largest)
    worst = max(float(np.abs(f.measured - f.model).max()) for group in groups for f in group)
    reach = 1.08 * max(worst, 2.5 * max(f.noise_floor for group in groups for f in group))
    r_scale = force_scale(first.unit, reach)
    for i, group in enumerate(groups):
        inner = outer[i // columns, i % columns].subgridspec(2, 1, height_ratios=(2.2, 1), hspace=0.05)
        top = figure.add_subplot(inner[0])
        below = figure.add_subplot(inner[1], sharex=top)
        _draw_loop(top, group, x_scale, y_scale)
        _draw_residual(below, group, x_scale, r_scale)
        below.set_ylim(-reach * r_scale[0], reach * r_scale[0])
        top.set_title(_panel_title(group, conditions, failing))
        top.tick_params(labelbottom=False)
        below.set_xlabel(f"{first.experiment.record.prescribed} [{x_scale[1]}]")
        if i % columns == 0:
            top.set_ylabel(f"{first.channel} [{y_scale[1]}]")
            below.set_ylabel(f"residual [{r_scale[1]}]")
    _shared_legend(figure, max(len(g) for g in groups) > 1)
    figure.suptitle(title, x=0.01, ha="left", fontsize=12, fontweight="bold", color=INK)
    return figure


def _draw_loop(axes: Axes, group: Sequence[ChannelFit], x_scale: tuple[float, str], y_scale: tuple[float, str]) -> None:
    for i, fit in enumerate(group):
        x, y = thinned(path_of(fit) * x_scale[0], fit.measured * y_scale[0])
        axes.plot(x, y, color=BLUE if i == 0 else SKY, lw=1.6, zorder=3 - 0.1 * i)
    x, f = thinned(path_of(group[0]) * x_scale[0], group[0].model * y_scale[0])
    axes.plot(x, f, color=VERMILLION, lw=1.0, zorder=4)


def _draw_residual(
    axes: Axes, group: Sequence[ChannelFit], x_scale: tuple[float, str], r_scale: tuple[float, str]
) -> None:
    band = 2 * float(np.mean([f.noise_floor for f in group])) * r_scale[0]
    axes.axhspan(-band, band, color=GREY, alpha=0.4, lw=0)
    axes.axhline(0, color=VERMILLION, lw=0.8)
    for i, fit in enumerate(group):
        x, r = thinned(path_of(fit) * x_scale[0], (fit.measured - fit.model) * r_scale[0])
        axes.plot(x, r, color=BLUE if i == 0 else SKY, lw=0.8, zorder=3 - 0.1 * i)


def _shared_legend(figure: Figure, repeats: bool) -> None:
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    handles: list[Any] = [Line2D([], [], color=BLUE, lw=1.6, label="measured")]
    if repeats:
        handles.append(Line2D([], [], color=SKY, lw=1.6, label="its repeats"))
    handles.append(Line2D([], [], color=VERMILLION, lw=1.6, label="calibrated model"))
    handles.append(Patch(color=GREY, alpha=0.4, lw=0, label="noise, ± 2 floors"))
    figure.legend(handles=handles, loc="outside lower center", ncols=len(handles), frameon=False)


def overview_figure(comparison: Comparison) -> Figure:
    """Excess over the noise floor of every experiment and channel: bars after calibration, open circles before."""
    from matplotlib.figure import Figure

    failing = {id(f) for f in comparison.where_it_fails()}
    fits = sorted(
        comparison.fits, key=lambda f: (("calibrate", "validate", "sealed").index(f.experiment.set), -f.relative_excess)
    )
    hidden = max(len(fits) - _MOST_BARS, 0)
    if hidden:
        keep = {id(f) for f in sorted(fits, key=lambda f: -f.relative_excess)[:_MOST_BARS]}
        fits = [f for f in fits if id(f) in keep]
    figure = Figure(figsize=(7.5, 1.9 + 0.23 * len(fits)))
    axes = figure.add_subplot()
    rows = _rows_with_gaps(fits)
    after = np.array([f.relative_excess for f in fits])
    before = np.array([f.before.excess / f.noise_floor for f in fits])
    colours = [VERMILLION if id(f) in failing else SKY for f in fits]
    axes.barh(rows, after, height=0.72, color=colours)
    axes.plot(before, rows, "o", mfc="white", mec=INK, ms=4.5, mew=1.0, clip_on=False)
    for row, fit in zip(rows, fits):
        scale, unit = force_scale(fit.unit, fit.after.excess)
        size = f"{fit.after.excess * scale:.3g} {unit}" if id(fit) in failing else "within noise"
        place = {"transform": axes.get_yaxis_transform(), "va": "center", "ha": "left", "fontsize": 7.5}
        axes.text(1.015, row, size, color=INK if id(fit) in failing else GREY, **place)
    axes.set_yticks(rows, [f"{f.experiment.id}  {f.experiment.kind} {f.channel}" for f in fits], fontsize=7.5)
    axes.set_ylim(max(rows) + 0.8, min(rows) - 1.2)
    axes.set_xlim(0, 1.12 * max(1.0, float(np.max(after)), float(np.max(before))))
    if max(float(np.max(after)), float(np.max(before))) > 100:
        axes.set_xscale("symlog", linthresh=1.0)
    for name in dict.fromkeys(f.experiment.set for f in fits):
        start = min(r for r, f in zip(rows, fits, strict=True) if f.experiment.set == name)
        axes.text(0, start - 0.6, f" {name}", fontsize=8.5, fontweight="bold", color=INK, va="bottom")
    _finish_overview(figure, axes)
    tail = f" (the {_MOST_BARS} largest; {hidden} more are smaller)" if hidden else ""
    title = "Where the model fails" if failing else "No record stands out of its noise"
    figure.suptitle(f"{title}{tail}", x=0.01, ha="left", fontsize=12, fontweight="bold", color=INK)
    return figure


def _finish_overview(figure: Figure, axes: Axes) -> None:
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    axes.set_xlabel("excess over the noise floor [noise floors]")
    axes.grid(axis="x", color=GREY, alpha=0.3, lw=0.6)
    axes.set_axisbelow(True)
    axes.tick_params(axis="y", length=0)
    handles = [
        Patch(color=VERMILLION, label="calibrated, beyond noise"),
        Patch(color=SKY, label="calibrated, within noise"),
        Line2D([], [], ls="", marker="o", mfc="white", mec=INK, ms=5, label="nominal stiffness"),
    ]
    figure.legend(handles=handles, loc="outside lower center", ncols=3, frameon=False, fontsize=8)


def _rows_with_gaps(fits: Sequence[ChannelFit]) -> list[float]:
    """Vertical place of every bar, with a gap for the name of each set."""
    rows, place, last = [], 0.0, None
    for fit in fits:
        if last is not None and fit.experiment.set != last:
            place += 1.4
        rows.append(place)
        place, last = place + 1.0, fit.experiment.set
    return rows


def _panel_title(group: Sequence[ChannelFit], conditions: Sequence[str], failing: Set[tuple[str, str]]) -> str:
    first = group[0].experiment
    ids = ", ".join(f.experiment.id for f in group[:4]) + (" ..." if len(group) > 4 else "")
    conditions_told = ", ".join(told(name, first.conditions) for name in conditions if name in first.conditions)
    excess = float(np.sqrt(np.mean([f.relative_excess**2 for f in group])))
    beyond = any((f.experiment.id, f.channel) in failing for f in group)
    verdict = f"excess {excess:.2g} floors" if beyond else "within noise"
    return f"{ids}  ·  {first.set}  ·  {verdict}" + (f"\n{conditions_told}" if conditions_told else "")
