"""Colours, scales and labels that the pictures of this package share.

Colours are those of Okabe & Ito (2008), which stay apart for colour-blind readers; what they say is also said by line
width, marker or text.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from compare.comparison import ChannelFit
from compare.experiment import Experiment

if TYPE_CHECKING:
    from matplotlib.figure import Figure

BLUE, SKY, VERMILLION, GREEN, GREY, INK = "#0072B2", "#56B4E9", "#D55E00", "#009E73", "#8C8C8C", "#2B2B2B"
STYLE: dict[Any, Any] = {
    "font.size": 9,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.edgecolor": GREY,
    "axes.labelcolor": INK,
    "xtick.color": INK,
    "ytick.color": INK,
    "axes.titlesize": 9,
    "axes.titlelocation": "left",
    "figure.constrained_layout.use": True,
    "savefig.dpi": 150,
}
PAGE_WIDTH = 7.2  # inches: what a page shows at full width
_MOST_POINTS = 3000
_SHOWN = {
    "extension": (1e3, "mm"),
    "deflection": (1e3, "mm"),
    "strain": (1e2, "%"),
    "rotation": (180 / np.pi, "deg"),
}
_CONDITION_SHOWN = {"temperature": (1.0, -273.15, "°C"), "inclination": (180 / np.pi, 0.0, "°")}
_CONDITION_UNIT = {"axial tension": "N", "tail tension": "N", "specimen length": "m", "speed": "m/s", "frequency": "Hz"}


def title(figure: Figure, text: str, all_of: Sequence[Any] = (), shown: Sequence[Any] = ()) -> None:
    """Title at the left, which says so where only some of all items are shown."""
    tail = f", the {len(shown)} largest of {len(all_of)}" if len(shown) < len(all_of) else ""
    figure.suptitle(text + tail, x=0.01, ha="left", fontsize=11, fontweight="bold", color=INK)


def path_of(fit: ChannelFit) -> NDArray[np.float64]:
    """What the rig imposed in the experiment of this fit, SI."""
    record = fit.experiment.record
    return record[record.prescribed]


def thinned(*series: NDArray[np.float64]) -> list[NDArray[np.float64]]:
    """Every k-th sample, so that no line has more points than a picture can show."""
    step = -(-len(series[0]) // _MOST_POINTS)
    return [s[::step] for s in series]


def path_scale(channel: str, fit: ChannelFit) -> tuple[float, str]:
    """Factor and unit in which a prescribed channel is shown."""
    unit = fit.experiment.record.channels[channel].unit
    return _SHOWN[channel] if channel in _SHOWN else force_scale(unit, float(np.abs(path_of(fit)).max()))


def force_scale(unit: str, largest: float) -> tuple[float, str]:
    """Factor and unit in which a load of that size is shown."""
    return (1e-3, f"k{unit}") if unit in ("N", "N m") and largest >= 5000 else (1.0, unit)


def varying(experiments: Sequence[Experiment]) -> list[str]:
    """Conditions that differ between experiments, so that naming them tells the experiments apart."""
    seen: dict[str, set[float]] = {}
    for experiment in experiments:
        for name, value in experiment.conditions.items():
            seen.setdefault(name, set()).add(value)
    return [name for name, values in seen.items() if len(values) > 1]


def told(name: str, conditions: Mapping[str, float]) -> str:
    """A condition with its value in the unit in which people say it.

    >>> told("temperature", {"temperature": 293.15}), told("axial tension", {"axial tension": 4e3})
    ('20 °C', '4000 N')
    """
    factor, shift, unit = _CONDITION_SHOWN.get(name, (1.0, 0.0, _CONDITION_UNIT.get(name, "")))
    label = "" if name in _CONDITION_SHOWN or name in _CONDITION_UNIT else f"{name} "
    return f"{label}{factor * conditions[name] + shift:.4g} {unit}".rstrip()
