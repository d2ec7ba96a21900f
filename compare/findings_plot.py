"""Pictures of findings: where the model fails, which effect is missing, how the error fell.

matplotlib is imported when a picture is asked for. The same colour means the same thing in all of them: vermilion the
base model, green the model with effects, blue what was accepted; line, marker, hatching and words say it again.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from compare.comparison import ChannelFit
from compare.experiment import Experiment
from compare.findings import Findings, Separation
from compare.findings_sentences import BASELINES, listed, named
from compare.kinds import SETS
from compare.loading import amplitude, loop_energy, mean_rate
from compare.plot_style import BLUE, GREEN, GREY, INK, SKY, STYLE, VERMILLION, told, varying
from compare.residual_plot import record_figure, same_record, worst_and_typical

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_MOST_ROWS, _MOST_BARS = 40, 14
_WIDTH = 7.2


def plot_findings(findings: Findings, folder: str | Path) -> dict[str, Path]:
    """Write the pictures of findings as PNG files.

    Parameters
    ----------
    findings : Findings
        What ``explain`` found.
    folder : path
        Made if it is not there.

    Returns
    -------
    dict of str to Path
        ``record-1``, ``record-2``, ``where``, ``conditions``, ``loop-energy``, ``ranking``, ``path``, ``errors``,
        ``confusion``, as far as there is something to draw.
    """
    import matplotlib
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    written = {}
    with matplotlib.rc_context(STYLE):
        for name, draw in _pictures(findings).items():
            figure = draw()
            FigureCanvasAgg(figure)
            written[name] = folder / f"{name}.png"
            figure.savefig(written[name])
    return written


def _pictures(f: Findings) -> Mapping[str, Callable[[], Figure]]:
    pictures: dict[str, Callable[[], Figure]] = {}
    added = listed(f.effects)
    for i, fit in enumerate(worst_and_typical(f.comparison), start=1):
        pictures[f"record-{i}"] = lambda fit=fit: record_figure(fit, f.comparison, f.after, added)
    if f.comparison.fits:
        pictures["where"] = lambda: where_figure(f)
        if covariates(f):
            pictures["conditions"] = lambda: conditions_figure(f)
        if any("loop" in m.name.lower() for m in f.marks) and len(_loops(f)) > 2:
            pictures["loop-energy"] = lambda: loop_energy_figure(f)
    if f.ranking:
        pictures["ranking"] = lambda: ranking_figure(f)
    if f.path:
        pictures["path"] = lambda: path_figure(f)
    if f.errors:
        pictures["errors"] = lambda: errors_figure(f)
    if len(f.separation.effects) > 1:
        pictures["confusion"] = lambda: confusion_figure(f.separation)
    return pictures


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
    figure = Figure(figsize=(_WIDTH, 1.3 + 0.21 * len(fits)))
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
    figure.get_layout_engine().set(rect=(0, 0, 0.74 if many else 1.0, 1))  # pyright: ignore
    _title(figure, "Excess over the noise floor [noise floors]", f.comparison.fits, fits)
    return figure


def _map_norm(top: float) -> Any:
    from matplotlib.colors import PowerNorm

    return PowerNorm(0.5, 0.0, top)


def _row_name(fit: ChannelFit) -> str:
    return f"{fit.experiment.id}  {fit.experiment.kind} {fit.channel}  ({fit.experiment.set})"


def _title(figure: Figure, title: str, all_of: Any = (), shown: Any = ()) -> None:
    tail = f", the {len(shown)} largest of {len(all_of)}" if len(shown) < len(all_of) else ""
    figure.suptitle(title + tail, x=0.01, ha="left", fontsize=11, fontweight="bold", color=INK)


def covariates(f: Findings) -> dict[str, np.ndarray]:
    """What varied between the compared records: amplitude, rate and recorded conditions, each (n,), NaN where unknown."""
    fits = f.comparison.fits
    found = dict((_of_the_path(f, "amplitude", amplitude), _of_the_path(f, "mean rate", mean_rate)))
    shown = {"temperature": (" [°C]", -273.15), "axial tension": (" [N]", 0.0), "specimen length": (" [m]", 0.0)}
    for name in varying([x.experiment for x in fits]):
        unit, shift = shown.get(name, ("", 0.0))
        found[name + unit] = np.array([x.experiment.conditions.get(name, np.nan) + shift for x in fits])
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
    figure = Figure(figsize=(_WIDTH, 0.9 + 2.1 * rows))
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
    _title(figure, "Excess against what was varied")
    return figure


def _loops(f: Findings) -> list[tuple[ChannelFit, float]]:
    found = [(x, loop_energy(x)) for x in f.comparison.fits]
    return [(x, e) for x, e in found if e is not None and e > 0]


def loop_energy_figure(f: Findings) -> Figure:
    """Energy of one loop against amplitude and against rate; the base model has none."""
    from matplotlib.figure import Figure

    found = _loops(f)
    figure = Figure(figsize=(_WIDTH, 3.2))
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
    _title(figure, "Energy lost in one loop (the base model loses none)")
    return figure


def _energy_unit(fit: ChannelFit) -> str:
    """J of a force over a length or a moment over an angle; J/m of a load over a strain, a twist or a curvature."""
    return "J" if fit.experiment.record.prescribed in ("extension", "rotation", "deflection") else "J/m"


def ranking_figure(f: Findings) -> Figure:
    """Evidence and share of the excess of every effect that was tried, best first."""
    from matplotlib.figure import Figure

    ranking = f.ranking[:_MOST_BARS]
    figure = Figure(figsize=(_WIDTH, 1.35 + 0.27 * len(ranking)))
    panels: Any = figure.subplots(1, 2, sharey=True, width_ratios=(1.6, 1))
    rows = np.arange(len(ranking))
    log_e = np.nan_to_num([c.log_e for c in ranking], neginf=-1e3, posinf=1e6)
    share = np.nan_to_num([c.share for c in ranking])
    for i, c in enumerate(ranking):
        accepted, tied = c.effect in f.effects, c.effect in f.confusable
        look: dict[str, Any] = {"color": BLUE if accepted else SKY if tied else GREY, "height": 0.66}
        look |= {"hatch": "///" if tied and not accepted else None, "edgecolor": "white", "lw": 0}
        panels[0].barh(rows[i], log_e[i], **look)
        panels[1].barh(rows[i], 100 * max(share[i], 0.0), **look)
        panels[0].annotate(
            f"{log_e[i]:.3g}",
            (max(log_e[i], 0), rows[i]),
            (3, 0),
            textcoords="offset points",
            va="center",
            fontsize=7.5,
        )
        panels[1].annotate(
            f"{100 * share[i]:.0f} %", (100 * max(share[i], 0), rows[i]), (3, 0), textcoords="offset points",
            va="center", fontsize=7.5,
        )  # fmt: skip
    panels[0].axvline(ranking[0].needed, color=INK, lw=1.0, ls="--")
    panels[0].set_xscale("symlog", linthresh=10.0)
    panels[0].set_xlim(min(-1.0, float(log_e.min())), 4 * max(20.0, float(log_e.max())))
    panels[0].set_xlabel(f"log e against the base model (dashed: {ranking[0].needed:.2g} needed)")
    panels[1].set_xlim(0, 118)
    panels[1].set_xlabel("share removed [%]")
    panels[0].set_yticks(rows, [_bar_name(c.effect, f) for c in ranking], fontsize=8)
    panels[0].set_ylim(len(ranking) - 0.4, -0.6)
    _title(figure, "Which effect", f.ranking, ranking)
    return figure


def _bar_name(effect: str, f: Findings) -> str:
    return effect + (" (accepted)" if effect in f.effects else " (in the set)" if effect in named(f) else "")


def path_figure(f: Findings) -> Figure:
    """Error of the calibration set after each effect that was added."""
    from matplotlib.figure import Figure

    start = f.errors["calibrate"].before if "calibrate" in f.errors else f.comparison.relative_error("calibrate")
    errors = np.array([start or np.nan, *(step.error for step in f.path)])
    figure = Figure(figsize=(_WIDTH, 2.7))
    axes = figure.add_subplot()
    steps = np.arange(len(errors))
    axes.plot(steps, errors, "-", color=GREY, lw=1.2, zorder=1)
    axes.plot(steps[:1], errors[:1], "o", color=VERMILLION, ms=8)
    axes.plot(steps[1:], errors[1:], "o", color=GREEN, ms=8)
    for i, value in enumerate(errors):
        axes.annotate(f"{value:.3g}", (i, value), (9, 5), textcoords="offset points", fontsize=8.5, color=INK)
    axes.axhline(1.0, color=INK, lw=1.0, ls=":")
    axes.annotate("noise floor", (-0.35, 1.0), (0, 3), textcoords="offset points", fontsize=8, color=INK)
    axes.set_xticks(steps, ["base model", *(f"+ {s.added}\n{s.form}, log e {s.log_e:.3g}" for s in f.path)])
    axes.set_xlim(-0.4, len(errors) - 0.5)
    axes.set_ylim(0, 1.15 * float(np.nanmax(errors)))
    axes.set_ylabel("error [noise floors]")
    _title(figure, "The path: error on the calibration set")
    return figure


def errors_figure(f: Findings) -> Figure:
    """Error before and after on every set, with the noise floor and what other ways to mend the model reach."""
    from matplotlib.figure import Figure

    sets = [name for name in SETS if name in f.errors]
    figure = Figure(figsize=(_WIDTH, 1.5 + 0.55 * len(sets)))
    axes = figure.add_subplot()
    used: dict[str, Any] = {}
    for row, name in enumerate(sets):
        _draw_set(axes, row, f, name, used)
    floor = axes.axvline(1.0, color=INK, lw=1.0, ls=":")
    axes.set_xscale("log")
    low, high = axes.get_xlim()
    axes.set_xlim(min(low, 0.85), max(high, 1.5))
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    axes.xaxis.set_major_locator(LogLocator(subs=(1.0, 1.5, 2.0, 3.0, 5.0, 7.0)))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda v, _: f"{v:g}"))
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.set_yticks(range(len(sets)), sets)
    axes.set_ylim(len(sets) - 0.4, -0.6)
    axes.set_xlabel("error [noise floors]")
    figure.legend(
        [*used.values(), floor], [*used, "noise floor"], loc="outside lower center", ncols=3, frameon=False, fontsize=8
    )
    _title(figure, "Before and after" if f.effects else "Error on every set (nothing was added)")
    return figure


def _draw_set(axes: Axes, row: int, f: Findings, name: str, used: dict[str, Any]) -> None:
    e = f.errors[name]
    axes.plot([e.before, e.after], [row, row], "-", color=GREY, lw=2.0, zorder=1)
    (used["base model"],) = axes.plot(e.before, row, "o", mfc="white", mec=VERMILLION, mew=1.8, ms=8)
    if f.effects:
        (used["with effects"],) = axes.plot(e.after, row, "o", color=GREEN, ms=8)
    for marker, (baseline, value) in zip("sDvP", e.baselines.items()):
        (used[BASELINES.get(baseline, baseline)],) = axes.plot(value, row, marker, mfc="none", mec=BLUE, ms=6.5)
    if e.ratio is not None:
        interval = (
            f" [{e.ratio_low:.2g}, {e.ratio_high:.2g}]" if e.ratio_low is not None and e.ratio_high is not None else ""
        )
        word = "" if e.confirmed is None else ", confirmed" if e.confirmed else ", not confirmed"
        text = f"excess ratio {e.ratio:.2g}{interval}{word}"
        place = float(np.sqrt(e.before * e.after))
        axes.annotate(text, (place, row), (0, 7), textcoords="offset points", ha="center", fontsize=8, color=INK)


def confusion_figure(s: Separation) -> Figure:
    """Probability of taking one effect for another, by the design of these experiments alone."""
    from matplotlib.figure import Figure

    m = len(s.effects)
    figure = Figure(figsize=(_WIDTH, 2.0 + 0.3 * m))
    axes = figure.add_subplot()
    table = 100 * np.asarray(s.confusion)
    axes.imshow(table, cmap="Blues", vmin=0, vmax=50, aspect="auto")
    for (i, j), value in np.ndenumerate(table):
        if i != j and value >= 0.5:
            axes.text(j, i, f"{value:.0f}", ha="center", va="center", fontsize=7, color="white" if value > 28 else INK)
        elif i == j:
            axes.add_patch(_square(j, i))
    axes.set_xticks(range(m), s.effects, rotation=35, ha="right", rotation_mode="anchor", fontsize=7.5)
    axes.set_yticks(range(m), s.effects, fontsize=7.5)
    axes.set_xlabel("taken for")
    axes.set_ylabel("true effect")
    axes.tick_params(length=0)
    _title(figure, "Chance of confusion [%]")
    return figure


def _square(x: int, y: int) -> Any:
    from matplotlib.patches import Rectangle

    return Rectangle((x - 0.5, y - 0.5), 1, 1, color="#EDEDED")
