r"""Picture of one record: measurement and models, and what the residual says before and after effects are added.

Four panels: load over path; residual over time with the band of the noise and, in towing, the phases of the motion; histogram
and autocorrelation of the whitened residual K r, K^T K = C^-1, which is white with variance one if the model is true. Bands
of +- 2 and +- 2 / sqrt(n) hold 95 % of it. matplotlib is imported when a picture is asked for.
"""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from compare.comparison import ChannelFit, Comparison
from compare.plot_style import GREEN, GREY, INK, SKY, VERMILLION, force_scale, path_of, path_scale, thinned, told

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Array = NDArray[np.float64]
_MOST_LAGS = 40
_AT_REST = 0.03


def whitened(fit: ChannelFit, comparison: Comparison) -> Array:
    """Residual of one channel in units of its noise, (n,): independent and of variance one if the model is true."""
    return comparison.noise.of(fit.experiment, fit.channel).whiten(fit.measured - fit.model, fit.model)


def autocorrelation(x: Array, lags: int) -> Array:
    """Correlation of a series with itself at lags 0 .. `lags`, about a mean of zero.

    Examples
    --------
    >>> autocorrelation(np.array([1.0, -1.0, 1.0, -1.0]), 1)
    array([ 1.  , -0.75])
    """
    power = float(x @ x) or 1.0
    return np.array([float(x[: len(x) - k] @ x[k:]) / power for k in range(lags + 1)])


def worst_and_typical(comparison: Comparison) -> list[ChannelFit]:
    """The record with the largest excess and the one in the middle, the same channel once."""
    fits = sorted(comparison.fits, key=lambda f: -f.relative_excess)
    return [] if not fits else [fits[0]] if len(fits) < 3 else [fits[0], fits[len(fits) // 2]]


def same_record(fit: ChannelFit, comparison: Comparison) -> ChannelFit:
    """The same channel of the same experiment in another comparison."""
    key = (fit.experiment.id, fit.channel)
    return next((f for f in comparison.fits if (f.experiment.id, f.channel) == key), fit)


def record_figure(fit: ChannelFit, before: Comparison, after: Comparison, added: str) -> Figure:
    """One channel of one experiment, before and after.

    Parameters
    ----------
    fit : ChannelFit
        Of `before`.
    before, after : Comparison
        Of the base model and of the model with effects; the same object if nothing was added.
    added : str
        Names of the effects for the legend.
    """
    from matplotlib.figure import Figure

    models = [(fit, before, VERMILLION, "-", "calibrated base model")]
    if after is not before:
        models.append((same_record(fit, after), after, GREEN, "--", f"with {added}"))
    figure = Figure(figsize=(7.2, 5.4))
    axes: Any = figure.subplots(2, 2, height_ratios=(1.25, 1))
    _draw_loop(axes[0, 0], models)
    _draw_residual(axes[0, 1], models)
    _draw_histogram(axes[1, 0], models)
    _draw_autocorrelation(axes[1, 1], models)
    handles = [*axes[0, 0].get_lines(), axes[0, 1].patches[0]]
    figure.legend(
        handles=handles,
        labels=["measured", *(m[4] for m in models), "noise, ± 2 floors"],
        loc="outside lower center",
        ncols=2 if after is not before else 3,
        frameon=False,
    )
    e = fit.experiment
    conditions = ", ".join(told(name, e.conditions) for name in e.conditions)
    figure.suptitle(f"{e.id}: {e.kind}, {fit.channel}", x=0.01, ha="left", fontsize=11, fontweight="bold", color=INK)
    axes[0, 0].set_title(conditions, fontsize=8, color=INK)
    return figure


def _draw_loop(axes: Axes, models: list[Any]) -> None:
    fit = models[0][0]
    channel = fit.experiment.record.prescribed
    x_scale, y_scale = path_scale(channel, fit), force_scale(fit.unit, float(np.abs(fit.measured).max()))
    x, y = thinned(path_of(fit) * x_scale[0], fit.measured * y_scale[0])
    axes.plot(x, y, color=SKY, lw=3.2)
    for made, _, colour, dash, _ in models:
        x, y = thinned(path_of(made) * x_scale[0], made.model * y_scale[0])
        axes.plot(x, y, color=colour, lw=1.3, ls=dash)
    axes.set_xlabel(f"{channel} [{x_scale[1]}]")
    axes.set_ylabel(f"{fit.channel} [{y_scale[1]}]")


def _draw_residual(axes: Axes, models: list[Any]) -> None:
    fit = models[0][0]
    largest = max(float(np.abs(m[0].measured - m[0].model).max()) for m in models)
    scale = force_scale(fit.unit, largest)
    time = fit.experiment.record.time
    t = np.arange(len(fit.measured), dtype=float) if time is None else time
    axes.axhspan(-2 * fit.noise_floor * scale[0], 2 * fit.noise_floor * scale[0], color=GREY, alpha=0.35, lw=0)
    for made, _, colour, dash, _ in models:
        x, r = thinned(t, (made.measured - made.model) * scale[0])
        axes.plot(x, r, color=colour, lw=1.1, ls=dash if dash == "-" else (0, (4, 1)))
    axes.axhline(0, color=INK, lw=0.6)
    axes.set_xlabel("sample" if time is None else "time [s]")
    axes.set_ylabel(f"measured - model [{scale[1]}]")
    axes.set_title("residual", fontsize=8, color=INK)
    if fit.experiment.kind == "towing" and time is not None:
        _draw_phases(axes, time, path_of(fit), fit.experiment.record.prescribed == "speed")


def _draw_phases(axes: Axes, time: Array, path: Array, is_speed: bool) -> None:
    """Above the curves what the drive does: pulled, let down; nothing where it rests."""
    low, high = axes.get_ylim()
    axes.set_ylim(low, high + 0.12 * (high - low))
    for begin, end, sense in phases(path if is_speed else np.gradient(path, time)):
        span = float(time[begin]), float(time[end])
        axes.axvspan(*span, ymin=0.93, color=SKY if sense > 0 else GREY, alpha=0.35, lw=0)
        if span[1] - span[0] > 0.12 * (time[-1] - time[0]):
            word = "pulled" if sense > 0 else "let down"
            axes.text(
                sum(span) / 2,
                0.963,
                word,
                transform=axes.get_xaxis_transform(),
                ha="center",
                va="center",
                fontsize=6.5,
                color=INK,
            )


def phases(speed: Array) -> list[tuple[int, int, int]]:
    """First and last sample of every phase of motion, and its sense; rests (below 3 % of the largest speed) are left out.

    Examples
    --------
    >>> phases(np.array([0.0, 1.0, 1.0, 0.0, -0.5, -0.5]))
    [(1, 2, 1), (4, 5, -1)]
    """
    sense = np.where(np.abs(speed) > _AT_REST * max(float(np.abs(speed).max()), 1e-300), np.sign(speed), 0.0)
    cuts = [0, *(np.flatnonzero(np.diff(sense)) + 1).tolist(), len(sense)]
    return [(a, b - 1, int(sense[a])) for a, b in pairwise(cuts) if sense[a] != 0]


def _draw_histogram(axes: Axes, models: list[Any]) -> None:
    values = [whitened(made, comparison) for made, comparison, *_ in models]
    reach = float(np.clip(max(np.abs(v).max() for v in values), 4.0, 12.0))
    edges = np.linspace(-reach, reach, 33).tolist()
    for v, (_, _, colour, dash, _) in zip(values, models, strict=True):
        inside = np.clip(v, -reach, reach)
        filled: dict[str, Any] = {"color": colour, "ls": dash, "lw": 1.3}
        axes.hist(inside, edges, density=True, histtype="step", **filled)
    z = np.linspace(-reach, reach, 200)
    axes.plot(z, np.exp(-(z**2) / 2) / np.sqrt(2 * np.pi), color=INK, lw=0.9)
    axes.annotate("noise", (0.9, 0.28), (1.8, 0.36), fontsize=7.5, color=INK, arrowprops={"arrowstyle": "-", "lw": 0.5})
    axes.set_ylim(0, 1.15 * max(axes.get_ylim()[1] / 1.05, 0.4))
    axes.set_xlabel("residual in units of its noise (beyond the axis: last bar)")
    axes.xaxis.label.set_fontsize(8)
    axes.set_ylabel("density")


def _draw_autocorrelation(axes: Axes, models: list[Any]) -> None:
    n = len(models[0][0].measured)
    lags = max(1, min(_MOST_LAGS, n // 4))
    band = 2 / np.sqrt(n)
    axes.axhspan(-band, band, color=GREY, alpha=0.35, lw=0)
    for made, comparison, colour, dash, _ in models:
        axes.plot(autocorrelation(whitened(made, comparison), lags), color=colour, lw=1.3, ls=dash)
    axes.axhline(0, color=INK, lw=0.6)
    axes.set_xlim(0, lags)
    axes.set_ylim(min(-0.3, axes.get_ylim()[0]), 1.02)
    axes.set_xlabel("lag [samples]")
    axes.set_ylabel("autocorrelation")
