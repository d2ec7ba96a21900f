"""Animation of a towing run from its dataset: the cable, its clamps and the trolley, with tension as colour; GIF, and MP4 where ffmpeg is.

The cable is a line, every link a bar on it; both have the colour of the tension that they carry. An interactive page is written by
:mod:`beam.towing_page`.
"""

from __future__ import annotations

import logging
from pathlib import Path
from typing import TYPE_CHECKING, Any

import matplotlib

matplotlib.use("Agg", force=False)

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.animation import FFMpegWriter, FuncAnimation, PillowWriter
from matplotlib.collections import LineCollection
from matplotlib.colors import Normalize
from matplotlib.patches import Circle
from numpy.typing import NDArray

from geometry.errors import InputError

if TYPE_CHECKING:
    import xarray

    from beam.scenario import Scenario

Array = NDArray[np.float64]

logger = logging.getLogger(__name__)

FRAMES = 60
"""Instants of an animation."""


def chain_tension(data: xarray.Dataset) -> Array:
    """Tension of the links (time, link) [N]: mean of the pins at both of its ends, two bushings a pin, in the order of the links."""
    along = data["bushing_force"].sel(direction="x").values
    pins = along.reshape(len(along), -1, 2).sum(axis=2)
    return 0.5 * (pins[:, :-1] + pins[:, 1:])


def link_ends(data: xarray.Dataset, pitch: float) -> Array:
    """Both ends of every link in the plane of the trough, (time, link, 2, 2) [m]."""
    middle = data["clamp_position"].values[:, :, :2]
    turn = data["clamp_rotation_vector"].values[:, :, 2]
    half = 0.5 * pitch * np.stack([np.cos(turn), np.sin(turn)], axis=-1)
    return np.stack([middle - half, middle + half], axis=2)


def instants(count: int, most: int) -> NDArray[np.int64]:
    """At most `most` of `count` instants, evenly, with the first and the last.

    Examples
    --------
    >>> instants(9, 3).tolist()
    [0, 4, 8]
    """
    return np.unique(np.linspace(0, count - 1, min(count, most)).round().astype(np.int64))


def bend_centre(scenario: Scenario, time: Array) -> Array:
    """x of the roller's or arch's axis (time,) [m]."""
    if scenario.machine is not None:
        return np.full(len(time), scenario.roller_start)
    return scenario.roller_start + np.array([scenario.trolley(float(t))[0][0] for t in time])


class _Scene:
    """The axes, and what moves in them."""

    def __init__(self, data: xarray.Dataset, scenario: Scenario) -> None:
        self.data, self.scenario = data, scenario
        self.time = data["time"].values
        self.centre = bend_centre(scenario, self.time)
        self.cable = data["position"].values[:, :, :2]
        tension = data["force_local"].values[:, :, 0]
        self.tension = 0.5 * (tension[:, :-1] + tension[:, 1:])
        self.links = self.chain = None
        if scenario.clamps is not None and "clamp" in data.dims:
            self.links, self.chain = link_ends(data, scenario.clamps.pitch.value), chain_tension(data)
        drawn = self.tension if self.chain is None else np.concatenate([self.tension, self.chain], axis=1)
        low, high = np.percentile(drawn, (0.5, 99.5))
        self.norm = Normalize(float(low), float(high))
        self._set_up()

    def _set_up(self) -> None:
        R, height = self.scenario.layout.bend_radius.value, self.scenario.deck_height
        left, right = float(self.cable[:, :, 0].min()) - 0.3, float(self.cable[:, :, 0].max()) + 0.4
        self.figure, (whole, near) = plt.subplots(
            2, 1, figsize=(8.6, 4.6), height_ratios=(1.0, 1.5), layout="constrained"
        )
        self.views = (whole, near)
        self.moving: list[dict[str, Any]] = []
        for ax, wide in ((whole, 1.0), (near, 1.0)):
            ax.axhspan(-0.3, 0.0, color="#d9d9d9", zorder=0)
            bars = LineCollection([], cmap="viridis", norm=self.norm, linewidths=9.0 if ax is near else 5.0, alpha=0.55)
            line = LineCollection([], cmap="viridis", norm=self.norm, linewidths=3.0 if ax is near else 2.0 * wide)
            ax.add_collection(bars)
            ax.add_collection(line)
            deck = ax.plot([], [], color="#a0a0a0", linewidth=4, zorder=0)[0]
            wheel = Circle((0.0, R), R, facecolor="#eeeeee", edgecolor="#777777")
            if self.scenario.towing != "conventional":
                ax.add_patch(wheel)
            self.moving.append({"bars": bars, "line": line, "deck": deck, "wheel": wheel})
            ax.set_ylim(-0.2, max(2 * R, height) + 0.2)
            ax.set_ylabel("y [m]")
        whole.set(xlim=(left, right))
        near.set(aspect="equal", xlabel="x along the trough [m]")
        self.mark = whole.axvspan(0.0, 1.0, facecolor="none", edgecolor="#555555", linestyle=":")
        self.label = near.text(0.99, 0.92, "", transform=near.transAxes, ha="right", va="top", fontsize=10)
        what = "tension of cable (line) and links (bars) [N]" if self.links is not None else "tension [N]"
        self.figure.colorbar(self.moving[0]["line"], ax=self.views, label=what, pad=0.01)
        self.figure.suptitle(
            self.scenario.title + "\nabove: whole, height stretched; below: the bend, true to scale", fontsize=10
        )

    def draw(self, k: int) -> list[Any]:
        """Show the instant `k`."""
        R, height, x = self.scenario.layout.bend_radius.value, self.scenario.deck_height, float(self.centre[k])
        segments = np.stack([self.cable[k, :-1], self.cable[k, 1:]], axis=1)
        for one in self.moving:
            one["line"].set_segments(list(segments))
            one["line"].set_array(self.tension[k])
            if self.links is not None and self.chain is not None:
                one["bars"].set_segments(list(self.links[k]))
                one["bars"].set_array(self.chain[k])
            one["deck"].set_data([x, x + 100.0], [height - 0.03] * 2)
            one["wheel"].center = (x, R)
        half = 1.75 * (max(2 * R, height) + 0.4)
        left = x - 0.4 * half - R
        self.views[1].set_xlim(left, left + 2 * half)
        self.mark.set(x=left, width=2 * half)
        self.label.set_text(f"t = {self.time[k]:.1f} s")
        return []


def write_animation(data: xarray.Dataset, scenario: Scenario, folder: str | Path, frames: int = FRAMES) -> list[Path]:
    """Write ``towing.gif``, and ``towing.mp4`` if ffmpeg is on this machine, into `folder`.

    Parameters
    ----------
    data : Dataset
        Of the run, :attr:`beam.TowingRun.dataset` or its ``run.nc``.
    scenario : Scenario
        That it was run with.
    frames : int
        Instants that are shown, at most.

    Raises
    ------
    InputError
        If the files cannot be written.
    """
    scene = _Scene(data, scenario)
    shown = instants(len(scene.time), frames)
    span = float(scene.time[-1] - scene.time[0])
    rate = max(len(shown) / max(span, 1e-9), 2.0) if span > 0 else 2.0
    scene.figure.draw_without_rendering()
    scene.figure.set_layout_engine("none")  # laid out once, not for every instant
    film = FuncAnimation(scene.figure, scene.draw, frames=[int(k) for k in shown], blit=False)
    writers: dict[str, PillowWriter | FFMpegWriter] = {"towing.gif": PillowWriter(fps=round(rate) or 1)}
    if FFMpegWriter.isAvailable():
        writers["towing.mp4"] = FFMpegWriter(fps=round(rate) or 1)
    else:
        logger.info("no ffmpeg on this machine: the animation is written as GIF only")
    written = []
    try:
        for name, writer in writers.items():
            written.append(Path(folder) / name)
            film.save(written[-1], writer=writer, dpi=80 if name.endswith("gif") else 150)
    except OSError as error:
        raise InputError(f"{written[-1]}: the animation cannot be written there: {error}.") from None
    finally:
        plt.close(scene.figure)
    return written
