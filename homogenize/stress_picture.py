"""Picture of recovered stresses: conductors by the stress along them, everything soft by von Mises' stress, each with its own scale."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geometry.errors import InputError
from homogenize.stress_recovery import StressRecovery, von_mises

INK, SOFT, REST = "#22262b", "#6b7178", "#e7e9ec"

_RIM = {6: [0, 3, 1, 4, 2, 5], 9: [0, 4, 1, 5, 2, 6, 3, 7]}
"""Nodes round an element."""

_FACES = {
    6: [(0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5)],
    9: [(a, b, 8) for a, b in zip(_RIM[9], [*_RIM[9][1:], _RIM[9][0]])],
}
"""Triangles that fill an element."""


def draw_stress(
    recovery: StressRecovery, path: str | Path, *, angle: float | None = None, title: str = "", dpi: int = 170
) -> Path:
    """Draw the section, turned by the angle at which the stiffest part carries most.

    Parameters
    ----------
    recovery : from :func:`homogenize.recover`
    path : file to write; the ending chooses the format
    angle : angle of the section [rad]; the worst one if not given

    Raises
    ------
    InputError
        If the file cannot be written.
    """
    from matplotlib.figure import Figure

    angle = recovery.worst_angle if angle is None else angle
    metal = np.array([row.kind == "conductor" for row in recovery.regions])[recovery.region_of]
    figure = Figure(figsize=(12.6, 6.6), facecolor="white")
    along = recovery.axial(angle) / 1e6
    soft = von_mises(recovery.stress(angle)) / 1e6
    panels = (
        (0.06, metal, along, "RdBu_r", "stress along the conductor [MPa]", "Conductors"),
        (0.555, ~metal, soft, "viridis", "von Mises stress [MPa]", "Insulation, bedding, sheath"),
    )
    for left, shown, values, colours, label, name in panels:
        if not shown.any():
            continue
        axes = figure.add_axes((left, 0.09, 0.36, 0.74))
        _section(axes, recovery, angle, shown)
        _coloured(figure, axes, recovery, angle, shown, values, colours, label, left)
        axes.set_title(name, loc="left", fontsize=11, color=INK)
        _mark(axes, recovery, angle, shown, np.abs(values))
    figure.text(0.06, 0.945, title or "Recovered stresses", fontsize=13, fontweight="bold", color=INK)
    figure.text(0.06, 0.905, _loads(recovery, angle), fontsize=9, color=SOFT)
    path = Path(path)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        figure.savefig(path, dpi=dpi)
    except (OSError, ValueError) as error:
        raise InputError(f'the picture cannot be written to "{path}": {error}; try a name that ends in .png.') from None
    return path


def _places(recovery: StressRecovery, angle: float) -> NDArray[np.float64]:
    """Nodes of each element [mm] with the section turned, shape (2, k, e)."""
    c, s = np.cos(angle), np.sin(angle)
    x, y = 1e3 * recovery.nodes
    return np.stack([c * x - s * y, s * x + c * y])


def _section(axes: Any, recovery: StressRecovery, angle: float, shown: NDArray[np.bool_]) -> None:
    """The parts that are not coloured, in grey, and the outlines of all parts."""
    from matplotlib.collections import LineCollection, PolyCollection

    places = _places(recovery, angle)
    rim = _RIM[places.shape[1]]
    grey = places[:, rim][:, :, ~shown].transpose(2, 1, 0)
    axes.add_collection(PolyCollection(list(grey), facecolors=REST, edgecolors=REST, linewidths=0.3))
    axes.add_collection(LineCollection(_outlines(recovery, places), colors=INK, linewidths=0.5, zorder=3))
    reach = 1.03 * float(np.abs(places).max())
    axes.set(xlim=(-reach, reach), ylim=(-reach, reach), aspect="equal", xlabel="x [mm]", ylabel="y [mm]")
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)


def _outlines(recovery: StressRecovery, places: NDArray[np.float64]) -> list[NDArray[np.float64]]:
    """Edges of elements that no other element of the same part shares."""
    rim = _RIM[places.shape[1]]
    triples = [(rim[i], rim[i + 1], rim[(i + 2) % len(rim)]) for i in range(0, len(rim), 2)]
    middles = np.concatenate([places[:, t[1]].T for t in triples])
    part = np.tile(recovery.region_of, len(triples))
    key = np.column_stack([part, np.round(middles * 1e6).astype(np.int64)])
    _, inverse, count = np.unique(key, axis=0, return_inverse=True, return_counts=True)
    edges = np.concatenate([places[:, list(t)].transpose(2, 1, 0) for t in triples])
    return list(edges[count[inverse.ravel()] == 1])


def _coloured(
    figure: Any,
    axes: Any,
    recovery: StressRecovery,
    angle: float,
    shown: NDArray[np.bool_],
    values: NDArray[np.float64],
    colours: str,
    label: str,
    left: float,
) -> None:
    from matplotlib.tri import Triangulation

    places = _places(recovery, angle)[:, :, shown]
    k, e = places.shape[1:]
    number = np.arange(k * e).reshape(e, k)
    faces = np.concatenate([number[:, list(face)] for face in _FACES[k]])
    x, y = places.transpose(0, 2, 1).reshape(2, -1)
    high = float(np.abs(values[shown]).max()) or 1.0
    low = -high if values[shown].min() < 0 else 0.0
    if low == 0.0:  # a few places of high stress would leave the rest in one colour
        high = float(np.quantile(values[shown], 0.995)) or high
    drawn = axes.tripcolor(
        Triangulation(x, y, faces), values[shown].ravel(), shading="gouraud", cmap=colours, vmin=low, vmax=high
    )
    place = figure.add_axes((left + 0.372, 0.17, 0.011, 0.58))
    bar = figure.colorbar(drawn, cax=place, extend="max" if low == 0 else "neither")
    bar.set_label(label, fontsize=9, color=INK)
    bar.outline.set_visible(False)


def _mark(
    axes: Any, recovery: StressRecovery, angle: float, shown: NDArray[np.bool_], size: NDArray[np.float64]
) -> None:
    """A ring round the largest value, with its number."""
    e, k = np.unravel_index(int(np.where(shown[:, None], size, -1.0).argmax()), size.shape)
    x, y = _places(recovery, angle)[:, k, e]
    axes.plot(
        x, y, marker="o", markersize=9, markerfacecolor="none", markeredgecolor=INK, markeredgewidth=1.3, zorder=5
    )
    lower, upper = axes.get_ylim()
    axes.annotate(
        f"{size[e, k]:.3g} MPa",
        (x, y),
        (0.98, 0.02 if y < 0.5 * (lower + upper) else 0.98),
        textcoords="axes fraction",
        ha="right",
        va="bottom" if y < 0.5 * (lower + upper) else "top",
        fontsize=9.5,
        color=INK,
        arrowprops={"arrowstyle": "-", "color": INK, "linewidth": 0.7},
        zorder=6,
    )


def _loads(recovery: StressRecovery, angle: float) -> str:
    names = ("T_x", "T_y", "N", "M_x", "M_y", "M_z")
    units = ("N", "N", "N", "N m", "N m", "N m")
    floor = 1e-9 * float(np.abs(recovery.forces).max())
    shown = [
        f"{n} = {value:.4g} {u}"
        for n, value, u in zip(names, recovery.forces, units, strict=True)
        if abs(value) > floor
    ]
    return (
        f"{', '.join(shown) or 'no load'} · section turned by {np.degrees(angle):.0f}° · linear elastic · "
        "a conductor is one cylinder: mean over metal and voids"
    )
