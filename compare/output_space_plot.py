"""Picture of what the full rod says beside the chain: their difference over time, in noise floors, record by record.

matplotlib is imported when a picture is asked for.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from compare.output_space_mapping import RodCorrection
from compare.plot_style import BLUE, GREY, INK, PAGE_WIDTH, STYLE, VERMILLION, thinned, title

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_MOST_RECORDS = 8


def plot_correction(correction: RodCorrection, path: Path) -> Path:
    """Write the picture of :func:`correction_figure`."""
    import matplotlib
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    with matplotlib.rc_context(STYLE):
        figure = correction_figure(correction)
        FigureCanvasAgg(figure)
        figure.savefig(path)
    return path


def correction_figure(correction: RodCorrection) -> Figure:
    """One strip for each distinctly led record, the towed end and a station in it, with the band of the noise."""
    from matplotlib.figure import Figure

    led = list(dict.fromkeys(r.experiments for r in correction.records))
    shown = led[:_MOST_RECORDS]
    figure = Figure(figsize=(PAGE_WIDTH, 1.2 + 0.75 * len(shown)))
    panels: Any = figure.subplots(len(shown), 1, sharex=True, sharey=True, squeeze=False)[:, 0]
    channels = list(dict.fromkeys(r.channel for r in correction.records))
    channels.sort(key=lambda c: (c != "tension", c))
    colours = dict(zip(channels, (VERMILLION, BLUE, GREY, INK) * len(channels), strict=False))
    drawn: dict[str, Any] = {}
    for axes, ids in zip(panels, shown, strict=True):
        drawn["noise, ± 2 floors"] = axes.axhspan(-2, 2, color=GREY, alpha=0.25, lw=0)
        axes.axhline(0, color=INK, lw=0.6)
        for r in (x for x in correction.records if x.experiments == ids):
            t, d = thinned(r.time, r.difference / r.floor)
            (drawn[r.channel],) = axes.plot(t, d, color=colours[r.channel], lw=1.1)
        axes.set_ylabel(", ".join(ids), rotation=0, ha="right", va="center", fontsize=8)
    size = max(0.05, *(1.2 * float(np.abs(r.difference).max()) / r.floor for r in correction.records))
    panels[0].set_ylim(-size, size)
    panels[-1].set_xlabel("time [s]")
    names = [*(c for c in channels if c in drawn), "noise, ± 2 floors"]
    figure.legend([drawn[n] for n in names], names, loc="outside lower center", ncols=4, frameon=False)
    title(figure, "Full rod less chain [noise floors]", led, shown)
    return figure
