"""The picture of an effect: its loops under two or three conditions, and what a linear model leaves of them.

matplotlib is imported when a picture is asked for. Colours are those of Okabe & Ito (2008), which stay apart for
colour-blind readers; line widths and dashes say the same.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from effects.effect import Array, Effect
from effects.signature_scene import Reading, Scene, read_scene, scene_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_GREY, _INK = "#8C8C8C", "#2B2B2B"
_LINES: tuple[dict[str, Any], ...] = (
    {"color": "#0072B2", "lw": 2.4},
    {"color": "#D55E00", "lw": 1.7},
    {"color": "#009E73", "lw": 1.7, "ls": (0, (5, 1.5))},
)
_LINEAR: dict[str, Any] = {"color": _INK, "lw": 1.0, "ls": (0, (1.5, 1.5))}
_STYLE: dict[Any, Any] = {
    "font.size": 9,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.edgecolor": _GREY,
    "axes.labelcolor": _INK,
    "xtick.color": _INK,
    "ytick.color": _INK,
    "axes.titlesize": 9,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "savefig.dpi": 150,
}
_PATHS = {
    "tension": ("strain", 1e2, "%"),
    "torsion": ("twist", 1.0, "rad/m"),
    "bending": ("curvature", 1.0, "1/m"),
    "shear": ("deflection / length", 1e2, "%"),
    "towing": ("told position", 1.0, "m"),
}
_LOADS = {
    "tension": ("force", "N"),
    "torsion": ("torque", "N m"),
    "bending": ("moment", "N m"),
    "shear": ("force", "N"),
    "towing": ("tension", "N"),
}
_CROSS = {"tension": ("torque", "N m"), "torsion": ("force", "N")}


def plot_signature(effect: Effect, folder: str | Path) -> Path:
    """Write the picture of an effect as ``<name>.png``.

    Parameters
    ----------
    effect : Effect
        Of the library or your own; its plain form is drawn.
    folder : path
        Made if it is not there.

    Returns
    -------
    Path
        The file.
    """
    import matplotlib
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    file = Path(folder) / f"{effect.name}.png"
    file.parent.mkdir(parents=True, exist_ok=True)
    with matplotlib.rc_context(_STYLE):
        figure = signature_figure(effect)
        FigureCanvasAgg(figure)
        figure.savefig(file)
    return file


def signature_figure(effect: Effect, scene: Scene | None = None) -> Figure:
    """Left the load over the path, right what the fitted linear model leaves, over the path or over time."""
    import textwrap

    from matplotlib.figure import Figure

    scene = scene or scene_of(effect)
    readings = read_scene(effect, scene)
    words = textwrap.wrap(effect.title[:1].upper() + effect.title[1:], 118) + textwrap.wrap(
        f"Look for: {effect.signature}.", 118
    )
    above, height = 0.42 + 0.17 * len(words), 3.9 + 0.17 * len(words)  # inches
    figure = Figure(figsize=(8.4, height))
    loops, rest = figure.subplots(1, 2)
    figure.subplots_adjust(0.085, 0.95 / height, 0.985, 1 - (above + 0.22) / height, wspace=0.26)
    load, unit = (_CROSS if effect.stage == "cross" else _LOADS)[scene.kind]
    name, factor, path_unit = _PATHS[scene.kind]
    for reading, line in zip(readings, _lines(readings), strict=False):
        _draw(loops, reading.case.path.strain * factor, reading.load, reading, line)
        x = _time(reading) if scene.over_time else reading.case.path.strain * factor
        _draw(rest, x, reading.load - reading.linear, reading, line)
    known = {"cross": "linear model without coupling", "bias": "linear model"}
    _draw_linear(loops, readings, factor, known.get(effect.stage, "linear model, fitted to all"))
    rest.axhline(0.0, **_LINEAR)
    loops.set(xlabel=f"{name} [{path_unit}]", ylabel=f"{load} [{unit}]")
    rest.set(xlabel="time [s]" if scene.over_time else f"{name} [{path_unit}]", ylabel=f"{load} [{unit}]")
    loops.set_title("with the effect")
    rest.set_title("less the base model" if scene.kind == "towing" else "less the linear model")
    for axes in (loops, rest):
        axes.grid(color=_GREY, alpha=0.25, lw=0.6)
        axes.set_axisbelow(True)
        axes.locator_params(nbins=6)
    handles, labels = loops.get_legend_handles_labels()
    figure.legend(handles, labels, loc="lower center", ncols=len(handles), frameon=False)
    figure.text(0.012, 1 - 0.1 / height, effect.name, va="top", fontsize=12, fontweight="bold", color=_INK)
    told = "\n".join(words)
    figure.text(0.012, 1 - 0.36 / height, told, va="top", fontsize=8.5, linespacing=1.3, color=_INK)
    return figure


def _lines(readings: Sequence[Reading]) -> list[dict[str, Any]]:
    return [_LINES[i % len(_LINES)] for i in range(len(readings))]


def _time(reading: Reading) -> Array:
    time = reading.case.path.time
    assert time is not None
    return time


def _draw(axes: Axes, x: Array, y: Array, reading: Reading, line: dict[str, Any]) -> None:
    part = reading.case.shown
    axes.plot(x[part], y[part], label=reading.case.label, solid_joinstyle="round", **line)


def _draw_linear(axes: Axes, readings: Sequence[Reading], factor: float, label: str) -> None:
    largest = max(readings, key=lambda r: float(abs(r.case.path.strain).max()))
    if largest.case.path.kind == "towing":
        for i, reading in enumerate(readings):
            told = "base model, its friction fitted to all" if i == 0 else None
            axes.plot(reading.case.path.strain * factor, reading.linear, label=told, zorder=5, **_LINEAR)
        return
    x, y = largest.case.path.strain, largest.linear
    ends = [int(x.argmin()), int(x.argmax())]
    axes.plot(x[ends] * factor, y[ends], label=label, zorder=5, **_LINEAR)
