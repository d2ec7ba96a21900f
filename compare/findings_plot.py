"""Pictures of findings: where the model fails, which effect is missing, how the error fell.

matplotlib is imported when a picture is asked for. The same colour means the same thing in all of them: vermilion the
base model, green the model with effects, blue what was accepted; line, marker, hatching and words say it again.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from compare.excess_plot import closed_loops, conditions_figure, covariates, loop_energy_figure, where_figure
from compare.findings import Findings, Separation
from compare.findings_sentences import listed, named, nats, steps_taken
from compare.kinds import SETS
from compare.plot_style import BLUE, GREEN, GREY, INK, PAGE_WIDTH, SKY, STYLE, VERMILLION, title
from compare.residual_plot import record_figure, worst_and_typical

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_MOST_BARS = 14


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
        if any("loop" in m.name.lower() for m in f.marks) and len(closed_loops(f)) > 2:
            pictures["loop-energy"] = lambda: loop_energy_figure(f)
    if f.ranking:
        pictures["ranking"] = lambda: ranking_figure(f)
    if steps_taken(f):
        pictures["path"] = lambda: path_figure(f)
    if f.errors:
        pictures["errors"] = lambda: errors_figure(f)
    if np.any(np.triu(np.maximum(f.separation.confusion, np.transpose(f.separation.confusion)), 1) >= 0.005):
        pictures["confusion"] = lambda: confusion_figure(f.separation)
    return pictures


def ranking_figure(f: Findings) -> Figure:
    """Evidence and share of the excess of every effect that was tried, best first."""
    from matplotlib.figure import Figure

    ranking = f.ranking[:_MOST_BARS]
    figure = Figure(figsize=(PAGE_WIDTH, 1.35 + 0.27 * len(ranking)))
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
            nats(log_e[i]),
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
    panels[0].set_xlabel(f"log e against the base model (dashed: {nats(ranking[0].needed)} needed)")
    panels[1].set_xlim(0, 118)
    panels[1].set_xlabel("share removed [%]")
    panels[0].set_yticks(rows, [_bar_name(c.effect, f) for c in ranking], fontsize=8)
    panels[0].set_ylim(len(ranking) - 0.4, -0.6)
    title(figure, "Which effect", f.ranking, ranking)
    return figure


def _bar_name(effect: str, f: Findings) -> str:
    return effect + (" (accepted)" if effect in f.effects else " (in the set)" if effect in named(f) else "")


def path_figure(f: Findings) -> Figure:
    """Error of the calibration set after each effect that was added."""
    from matplotlib.figure import Figure

    steps_made = steps_taken(f)
    start = f.errors["calibrate"].before if "calibrate" in f.errors else f.comparison.relative_error("calibrate")
    errors = np.array([start or np.nan, *(step.error for step in steps_made)])
    figure = Figure(figsize=(PAGE_WIDTH, 2.7))
    axes = figure.add_subplot()
    steps = np.arange(len(errors))
    axes.plot(steps, errors, "-", color=GREY, lw=1.2, zorder=1)
    axes.plot(steps[:1], errors[:1], "o", color=VERMILLION, ms=8)
    axes.plot(steps[1:], errors[1:], "o", color=GREEN, ms=8)
    for i, value in enumerate(errors):
        axes.annotate(f"{value:.3g}", (i, value), (9, 5), textcoords="offset points", fontsize=8.5, color=INK)
    axes.axhline(1.0, color=INK, lw=1.0, ls=":")
    axes.annotate("noise floor", (-0.35, 1.0), (0, 3), textcoords="offset points", fontsize=8, color=INK)
    axes.set_xticks(steps, ["base model", *(f"+ {s.added}\n{s.form}, log e {nats(s.log_e)}" for s in steps_made)])
    axes.set_xlim(-0.4, len(errors) - 0.5)
    axes.set_ylim(0, 1.15 * float(np.nanmax(errors)))
    axes.set_ylabel("error [noise floors]")
    title(figure, "The path: error on the calibration set")
    return figure


def errors_figure(f: Findings) -> Figure:
    """Error before and after on every set, with the noise floor and what other ways to mend the model reach."""
    from matplotlib.figure import Figure

    sets = [name for name in SETS if name in f.errors]
    figure = Figure(figsize=(PAGE_WIDTH, 1.5 + 0.55 * len(sets)))
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
    title(figure, "Before and after" if f.effects else "Error on every set (nothing was added)")
    return figure


def _draw_set(axes: Axes, row: int, f: Findings, name: str, used: dict[str, Any]) -> None:
    e = f.errors[name]
    axes.plot([e.before, e.after], [row, row], "-", color=GREY, lw=2.0, zorder=1)
    (used["base model"],) = axes.plot(e.before, row, "o", mfc="white", mec=VERMILLION, mew=1.8, ms=8)
    if f.effects:
        (used["with effects"],) = axes.plot(e.after, row, "o", color=GREEN, ms=8)
    for marker, (baseline, value) in zip("sDvP", e.baselines.items()):
        (used[baseline],) = axes.plot(value, row, marker, mfc="none", mec=BLUE, ms=6.5)
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
    figure = Figure(figsize=(PAGE_WIDTH, 2.0 + 0.3 * m))
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
    title(figure, "Chance of confusion [%]")
    return figure


def _square(x: int, y: int) -> Any:
    from matplotlib.patches import Rectangle

    return Rectangle((x - 0.5, y - 0.5), 1, 1, color="#EDEDED")
