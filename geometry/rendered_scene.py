"""The one door to pyvista: surfaces in space, rendered off-screen without a display, in parallel projection."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geometry.colour_scheme import INK, SOFT
from geometry.errors import GeometryError
from geometry.quiet_output import quiet_output

DOTS_PER_INCH = 150


@dataclass(frozen=True)
class View:
    """Parallel projection of a cylinder of `radius` and `length` [m] about z on a picture of `size` pixels."""

    radius: float
    length: float
    size: tuple[int, int]
    towards: tuple[float, float, float] = (-0.80, 0.42, 0.52)

    @property
    def focus(self) -> NDArray[np.float64]:
        """Middle of the cylinder."""
        return np.array([0.0, 0.0, 0.5 * self.length])

    @property
    def axes(self) -> NDArray[np.float64]:
        """Right, up and towards-the-eye directions as rows."""
        back = np.array(self.towards) / np.linalg.norm(self.towards)
        right = np.cross([0.0, 1.0, 0.0], back)
        right /= np.linalg.norm(right)
        return np.array([right, np.cross(back, right), back])

    @property
    def scale(self) -> float:
        """Half the height of the picture [m]."""
        half_width = 0.5 * self.length * abs(self.axes[0, 2]) + self.radius * np.hypot(*self.axes[0, :2])
        half_height = 0.5 * self.length * abs(self.axes[1, 2]) + self.radius * np.hypot(*self.axes[1, :2])
        return float(max(1.50 * half_height, 1.08 * half_width * self.size[1] / self.size[0]))

    def pixel(self, point: NDArray[np.float64]) -> NDArray[np.float64]:
        """Column and row (from the top) of a point in space."""
        across = self.axes[:2] @ (point - self.focus) * (0.5 * self.size[1] / self.scale)
        return np.array([0.5 * self.size[0] + across[0], 0.56 * self.size[1] - across[1]])


@dataclass(frozen=True)
class Surface:
    """Polygons of one number of corners: `points` (n, 3) [m], `faces` (m, k), normals (n, 3) or None, colour and gloss."""

    points: NDArray[np.float64]
    faces: NDArray[np.int64]
    colour: str
    normals: NDArray[np.float64] | None = None
    smooth: bool = True
    gloss: tuple[float, float] = (0.15, 8)
    edges: bool = False


def rendered(surfaces: Sequence[Surface], view: View) -> NDArray[np.uint8]:
    """Picture (rows, columns, 3) of the surfaces.

    Raises
    ------
    GeometryError
        If nothing can be rendered here.
    """
    try:
        with quiet_output():
            return _rendered(surfaces, view)
    except (OSError, ValueError, RuntimeError) as error:
        if isinstance(error, GeometryError):
            raise
        raise GeometryError(f"the picture cannot be rendered here: {error}; try installing libegl1.") from None


def _rendered(surfaces: Sequence[Surface], view: View) -> NDArray[np.uint8]:
    try:
        import pyvista
    except (ImportError, OSError) as error:
        raise GeometryError(
            f"pyvista cannot be loaded ({error}); on Debian or Ubuntu: apt-get install libgl1 libegl1, "
            "or pip install --force-reinstall pyvista."
        ) from None
    plotter: Any = pyvista.Plotter(off_screen=True, window_size=list(view.size), lighting="none")
    plotter.set_background("white")
    plotter.enable_anti_aliasing("ssaa")
    for surface in surfaces:
        _add(pyvista, plotter, surface)
    right, up, back = view.axes
    for direction, strength in ((back + 0.9 * up - 0.5 * right, 0.72), (back + 0.8 * right, 0.40), (back - up, 0.22)):
        light = pyvista.Light(
            position=tuple(view.focus + view.length * direction), focal_point=tuple(view.focus), intensity=strength
        )
        light.positional = False
        plotter.add_light(light)
    plotter.camera.parallel_projection = True
    plotter.camera.position = tuple(view.focus + 3 * view.length * back)
    plotter.camera.focal_point = tuple(view.focus)
    plotter.camera.up = tuple(up)
    plotter.camera.parallel_scale = view.scale
    plotter.camera.SetWindowCenter(0.0, 0.12)  # leaves room for the title: moves the picture down by 6 % of its height
    plotter.camera.clipping_range = (0.01 * view.length, 20 * view.length)
    image = plotter.screenshot(return_img=True)
    plotter.close()
    if image is None:
        raise GeometryError("the renderer returned no picture; try installing libegl1.")
    return np.asarray(image)


def _add(pyvista: Any, plotter: Any, surface: Surface) -> None:
    mesh = pyvista.PolyData.from_regular_faces(surface.points, surface.faces)
    if surface.normals is not None:
        mesh.point_data["Normals"] = surface.normals
        mesh.point_data.active_normals_name = "Normals"
    specular, power = surface.gloss
    style = {"specular": specular, "specular_power": power, "ambient": 0.28, "diffuse": 0.85}
    if surface.edges:
        style |= {"show_edges": True, "edge_color": INK, "edge_opacity": 0.5, "line_width": 1.0}
    plotter.add_mesh(mesh, color=surface.colour, smooth_shading=surface.smooth, **style)


@dataclass(frozen=True)
class Label:
    """Text with a leader line to a point in space."""

    text: str
    point: NDArray[np.float64]


def write_picture(
    image: NDArray[np.uint8], view: View, title: str, facts: str, labels: Sequence[Label], path: str | Path
) -> Path:
    """Write title, facts and labels on a rendered picture.

    Raises
    ------
    GeometryError
        If the file cannot be written.
    """
    from matplotlib.figure import Figure

    path = Path(path)
    width, height = view.size
    figure = Figure(figsize=(width / DOTS_PER_INCH, height / DOTS_PER_INCH), facecolor="white")
    axes = figure.add_axes((0, 0, 1, 1))
    axes.imshow(image, aspect="equal")
    axes.set(xlim=(0, width), ylim=(height, 0))
    axes.axis("off")
    _draw_labels(axes, view, labels)
    small = 10 if len(title) > 105 else 12 if len(title) > 88 else 14
    axes.text(0.02 * width, 0.05 * height, title, fontsize=small, fontweight="bold", color=INK, va="center")
    axes.text(0.02 * width, 0.1 * height, facts, fontsize=11, color=SOFT, va="center")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        figure.savefig(path, dpi=DOTS_PER_INCH)
    except (OSError, ValueError) as error:
        raise GeometryError(
            f'the picture cannot be written to "{path}": {error}; try a name that ends in .png.'
        ) from None
    return path


def _draw_labels(axes: Any, view: View, labels: Sequence[Label]) -> None:
    """Names alternately above and below; a name that would run into its neighbour moves further out."""
    from matplotlib.patheffects import withStroke

    halo = [withStroke(linewidth=2.4, foreground="white")]
    width, height = view.size
    start, end = view.pixel(np.zeros(3)), view.pixel(np.array([0.0, 0.0, view.length]))
    slope = (end[1] - start[1]) / (end[0] - start[0])
    clear = 1.3 * view.radius * 0.5 * height / view.scale
    taken: dict[bool, list[tuple[float, float, float]]] = {True: [], False: []}
    for k, label in enumerate(sorted(labels, key=lambda label: view.pixel(label.point)[0])):
        above, spot = k % 2 == 0, view.pixel(label.point)
        lines = label.text.split("\n")
        half = 0.55 * 11 * DOTS_PER_INCH / 72 * max(map(len, lines)) / 2 + 8
        tall = 1.25 * 11 * DOTS_PER_INCH / 72 * len(lines) + 8
        out = -1.0 if above else 1.0
        column = float(np.clip(spot[0], half, width - half))
        row = start[1] + slope * (spot[0] - start[0]) + out * clear
        for left, right, far in taken[above]:
            if column - half < right and column + half > left and out * (far - row) > 0:
                row = far
        row = float(np.clip(row, 0.13 * height + tall, 0.99 * height - tall))
        for left, right, far in taken[above]:  # no room further out: beside
            if column - half < right and column + half > left and out * (far - row) > 0:
                column = right + half
        taken[above].append((column - half, column + half, row + out * tall))
        axes.plot([spot[0], column], [spot[1], row], color=INK, linewidth=0.9, path_effects=halo, zorder=3)
        axes.plot(*spot, marker="o", markersize=4.5, color="white", markeredgecolor=INK, zorder=4)
        axes.text(
            column, row + out * 6, label.text, ha="center", va="bottom" if above else "top", fontsize=11, color=INK,
            path_effects=halo, linespacing=1.15, zorder=5,
        )  # fmt: skip
