"""Picture of the shear lag: the share of the load in each kind of part along the specimen."""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from geometry.errors import InputError
from homogenize.specimen.shear_lag import ShearLag, grouped

INK, SOFT = "#22262b", "#6b7178"
COLOURS = ("#b5651d", "#0072b2", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#6b7178")
SMALL = 0.03
"""Kinds of parts that never carry more than this share are not drawn."""


def draw_shear_lag(lag: ShearLag, kind_of: Mapping[str, str], path: str | Path, note: str = "", dpi: int = 150) -> Path:
    """Draw the shares, parts of one kind added up.

    Parameters
    ----------
    lag : of a tension
    kind_of : kind of each part
    path : file to write
    note : how the load is brought in

    Raises
    ------
    InputError
        If the file cannot be written.
    """
    from matplotlib.figure import Figure

    by_kind = grouped(lag, dict(kind_of))
    figure = Figure(figsize=(7.2, 3.9), layout="constrained")
    axes = figure.add_subplot()
    order = np.argsort(-by_kind.share.max(axis=1))
    drawn = [int(i) for i in order if by_kind.share[i].max() > SMALL]
    labels = []
    for i, colour in zip(drawn, COLOURS * (1 + len(drawn) // len(COLOURS))):
        axes.plot(1e3 * lag.z, 100 * by_kind.share[i], color=colour, lw=2)
        labels.append((100 * float(by_kind.share[i, -1]), by_kind.parts[i], colour))
    last = 1e3 * float(lag.z[-1])
    for y, (_, name, colour) in zip(_apart([label[0] for label in labels], 6.0), labels):
        axes.annotate(
            name, (last, y), xytext=(8, 0), textcoords="offset points", color=colour, va="center", annotation_clip=False
        )
    axes.set_xlim(0, last)
    axes.set_ylim(min(0.0, 100 * float(by_kind.share.min()) - 3), 105)
    axes.set_xlabel("distance from the held end [mm]", color=INK)
    axes.set_ylabel("share of the axial force [%]", color=INK)
    axes.set_title(
        f"Who carries the load: {lag.load}, {note}" if note else f"Who carries the load: {lag.load}",
        color=INK,
        fontsize=10,
        loc="left",
    )
    axes.spines[["top", "right"]].set_visible(False)
    axes.grid(color="#e6e8eb", lw=0.6)
    return saved(figure, path, dpi)


def _apart(heights: list[float], least: float) -> list[float]:
    """Heights moved up where labels would lie on each other."""
    order, out = np.argsort(heights), list(heights)
    for low, high in itertools.pairwise(order):
        out[high] = max(out[high], out[low] + least)
    return out


def saved(figure: Any, path: str | Path, dpi: int) -> Path:
    """Write a figure, or say why it cannot be written."""
    target = Path(path)
    try:
        figure.savefig(target, dpi=dpi)
    except (OSError, ValueError) as error:
        raise InputError(f"the picture {target} cannot be written: {error}; choose another place or ending.") from None
    return target
