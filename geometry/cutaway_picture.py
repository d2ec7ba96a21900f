"""The cable in space, cut open: sheath, wrap, bedding, screen and insulation end one after the other, wires last.

The one door to pyvista. The picture is rendered off-screen and needs no display; matplotlib writes the names on it.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geometry.cable import Cable, Part
from geometry.colour_scheme import KIND_TITLES, kind_colour
from geometry.errors import GeometryError
from geometry.helix import Helix
from geometry.nested_helix import CentreLine, nested_helix, wound_on
from geometry.quiet_output import quiet_output
from geometry.strand import Conductor, layer_radii
from geometry.swept_surface import SIDES, WIRE_SIDES, swept_surface, wire_surfaces

ENDS = {
    "sheath": 0.30,
    "wrap": 0.40,
    "interstices": 0.52,
    "screen": 0.66,
    "cover": 0.70,
    "insulation": 0.82,
    "conductor": 1.0,
}
"""Where each kind of part ends, as a share of the length shown."""
GLOSS = {"conductor": (0.7, 25), "wrap": (0.35, 15), "screen": (0.45, 20), "sheath": (0.25, 12)}
INK = "#22262b"


def draw_cutaway(
    cable: Cable, path: str | Path, length: float | None = None, wires: bool = True, size: tuple[int, int] = (1800, 900)
) -> Path:
    """Render the cable with its layers stripped back step by step.

    Parameters
    ----------
    path : picture to write (png)
    length : length shown [m]; None takes 4.2 outer diameters
    wires : draw the wires of stranded conductors where they are bare; else smooth cylinders
    size : pixels

    Raises
    ------
    GeometryError
        If nothing can be rendered here, or the file cannot be written.
    """
    path = Path(path)
    length = 4.2 * cable.outer_diameter if length is None else float(length)
    if not (np.isfinite(length) and length > 0):
        raise GeometryError(f"the length shown must be positive, found {length:g} m.")
    view = _View(cable, length, size)
    try:
        with quiet_output():
            image = _rendered(cable, length, wires, view)
    except (OSError, ValueError, RuntimeError) as error:
        if isinstance(error, GeometryError):
            raise
        raise GeometryError(f"the cut-open cable cannot be rendered here: {error}; try installing libegl1.") from None
    return _annotated(image, cable, length, view, path)


@dataclass(frozen=True)
class _View:
    """Parallel projection on a picture of `size` pixels."""

    cable: Cable
    length: float
    size: tuple[int, int]

    @property
    def focus(self) -> NDArray[np.float64]:
        return np.array([0.0, 0.0, 0.5 * self.length])

    @property
    def axes(self) -> NDArray[np.float64]:
        """Right, up and towards-the-eye directions as rows."""
        back = np.array([-0.80, 0.42, 0.52])
        back /= np.linalg.norm(back)
        right = np.cross([0.0, 1.0, 0.0], back)
        right /= np.linalg.norm(right)
        return np.array([right, np.cross(back, right), back])

    @property
    def scale(self) -> float:
        """Half the height of the picture [m]."""
        R = self.cable.outer_radius
        half_width = 0.5 * self.length * abs(self.axes[0, 2]) + R * np.hypot(*self.axes[0, :2])
        half_height = 0.5 * self.length * abs(self.axes[1, 2]) + R * np.hypot(*self.axes[1, :2])
        return max(1.42 * half_height, 1.05 * half_width * self.size[1] / self.size[0])

    def pixel(self, point: NDArray[np.float64]) -> NDArray[np.float64]:
        """Column and row (from the top) of a point in space."""
        across = self.axes[:2] @ (point - self.focus) * (0.5 * self.size[1] / self.scale)
        return np.array([0.5 * self.size[0] + across[0], 0.55 * self.size[1] - across[1]])


def _rendered(cable: Cable, length: float, wires: bool, view: _View) -> NDArray[np.uint8]:
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
    for part in cable.parts:
        _add_part(pyvista, plotter, cable, part, length, wires)
    right, up, back = view.axes
    for direction, strength in ((back + 0.9 * up - 0.5 * right, 0.72), (back + 0.8 * right, 0.40), (back - up, 0.22)):
        light = pyvista.Light(
            position=tuple(view.focus + length * direction), focal_point=tuple(view.focus), intensity=strength
        )
        light.positional = False
        plotter.add_light(light)
    plotter.camera.parallel_projection = True
    plotter.camera.position = tuple(view.focus + 3 * length * back)
    plotter.camera.focal_point = tuple(view.focus)
    plotter.camera.up = tuple(up)
    plotter.camera.parallel_scale = view.scale
    plotter.camera.SetWindowCenter(0.0, 0.1)  # leaves room for the title: moves the picture down by 5 % of its height
    plotter.camera.clipping_range = (0.01 * length, 20 * length)
    image = plotter.screenshot(return_img=True)
    plotter.close()
    if image is None:
        raise GeometryError("the renderer returned no picture; try installing libegl1.")
    return np.asarray(image)


def _annotated(image: NDArray[np.uint8], cable: Cable, length: float, view: _View, path: Path) -> Path:
    """Write title and names with leader lines on the rendered picture."""
    from matplotlib.figure import Figure
    from matplotlib.patheffects import withStroke

    width, height = view.size
    figure = Figure(figsize=(width / 150, height / 150), facecolor="white")
    axes = figure.add_axes((0, 0, 1, 1))
    axes.imshow(image, aspect="equal")
    axes.set(xlim=(0, width), ylim=(height, 0))
    axes.axis("off")
    halo = [withStroke(linewidth=2.4, foreground="white")]
    spots = sorted(
        ((view.pixel(point), point, text) for text, point in _named_spots(cable, length)), key=lambda spot: spot[0][0]
    )
    for k, (spot, point, text) in enumerate(spots):
        above = k % 2 == 0
        beside = np.array([0.0, 0.0, point[2]]) + (1.5 if above else -1.5) * cable.outer_radius * view.axes[1]
        row = float(np.clip(view.pixel(beside)[1], 0.17 * height, 0.95 * height))
        axes.plot([spot[0], spot[0]], [spot[1], row], color=INK, linewidth=0.9, path_effects=halo, zorder=3)
        axes.plot(*spot, marker="o", markersize=4.5, color="white", markeredgecolor=INK, zorder=4)
        side = "bottom" if above else "top"
        axes.text(
            spot[0], row + (-6 if above else 6), text, ha="center", va=side, fontsize=11, color=INK, path_effects=halo
        )
    axes.text(0.02 * width, 0.055 * height, cable.title, fontsize=14, fontweight="bold", color=INK, va="center")
    lay = "straight" if cable.lay is None else f"lay {1e3 * cable.lay:.4g} mm ({cable.hand})"
    facts = f"\u2300 {1e3 * cable.outer_diameter:.1f} mm \u00b7 {lay} \u00b7 {cable.mass_per_length:.2f} kg/m"
    facts += f" \u00b7 length shown {1e3 * length:.0f} mm"
    axes.text(0.02 * width, 0.105 * height, facts, fontsize=11, color="#6b7178", va="center")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        figure.savefig(path, dpi=150)
    except (OSError, ValueError) as error:
        raise GeometryError(
            f'the picture cannot be written to "{path}": {error}; try a name that ends in .png.'
        ) from None
    return path


def _named_spots(cable: Cable, length: float) -> list[tuple[str, NDArray[np.float64]]]:
    """A visible point on each kind of part, facing the eye."""
    spots = []
    ends = sorted({ENDS.get(p.kind, 0.8) for p in cable.parts})
    eye = _View(cable, length, (100, 100)).axes[2]
    for kind in dict.fromkeys(part.kind for part in cable.parts if part.kind != "cover"):
        end = ENDS.get(kind, 0.8)
        begin = max([e for e in ends if e < end and _hides(cable, kind, e)], default=0.0)
        z = 0.5 * (begin + end) * length
        best = None
        for part in (
            p
            for p in cable.parts
            if p.kind == kind and (p.centre_radius > 0 or len(cable.parts) < 6 or p.kind != "conductor")
        ):
            turn = part.phase + part.twist_rate * z
            radius = cable.laid_up_radius if kind == "interstices" else part.outer_radius
            centre = np.array([part.centre_radius * np.cos(turn), part.centre_radius * np.sin(turn), z])
            point = centre + radius * np.array([eye[0], eye[1], 0]) / np.hypot(eye[0], eye[1])
            if best is None or point @ eye > best @ eye:
                best = point
        if best is not None:
            spots.append((KIND_TITLES.get(kind, kind), best))
    return spots


def _hides(cable: Cable, kind: str, end: float) -> bool:
    return any(ENDS.get(p.kind, 0.8) == end for p in cable.parts if p.kind not in (kind, "cover"))


def _add_part(pyvista: Any, plotter: Any, cable: Cable, part: Part, length: float, wires: bool) -> None:
    end = ENDS.get(part.kind, 0.8) * length
    outside = [
        ENDS.get(p.kind, 0.8) for p in cable.parts if p.member == part.member and p.outer_radius > part.outer_radius
    ]
    if part.member not in ("wrap", "sheath", "interstices"):
        outside += [ENDS[p.kind] for p in cable.parts if p.kind == "interstices"]
    hidden = 0.04 if part.kind == "conductor" else 0.001
    begin = max([0.0, *((e - hidden) * length for e in outside)])  # what is covered is not drawn
    if part.kind == "conductor" and wires:
        conductor = cable.conductors.get(part.material.name.removesuffix(" conductor"))
        if conductor is not None and conductor.strand is not None:
            _add_wires(pyvista, plotter, cable, part, conductor, begin, end)
            return
    points, quads = swept_surface(part.outer_trace, begin, end)
    style = _style(part.kind)
    plotter.add_mesh(pyvista.PolyData.from_regular_faces(points, quads), smooth_shading=True, **style)
    plotter.add_mesh(_cap(pyvista, part, cable, end), **style)


def _style(kind: str) -> dict[str, Any]:
    specular, power = GLOSS.get(kind, (0.15, 8))
    return {"color": kind_colour(kind), "specular": specular, "specular_power": power, "ambient": 0.28, "diffuse": 0.85}


def _cap(pyvista: Any, part: Part, cable: Cable, z: float) -> Any:
    """Flat end of a part. The interstices end as a full disc, through which the cores come."""
    turn = part.twist_rate * z
    phi = np.linspace(0, 2 * np.pi, SIDES, endpoint=False)
    outer = part.outer_trace.point(phi)
    inner = (
        np.zeros_like(outer) if part.inner_trace is None or part.kind == "interstices" else part.inner_trace.point(phi)
    )
    if part.inner_trace is None and part.centre_radius > 0:
        inner = np.broadcast_to(part.centre_radius * np.array([np.cos(part.phase), np.sin(part.phase)]), outer.shape)
    both = np.vstack([outer, inner])
    c, s = np.cos(turn), np.sin(turn)
    points = np.column_stack([c * both[:, 0] - s * both[:, 1], s * both[:, 0] + c * both[:, 1], np.full(len(both), z)])
    k = np.arange(SIDES)
    following = (k + 1) % SIDES
    return pyvista.PolyData.from_regular_faces(points, np.stack([k, following, following + SIDES, k + SIDES], axis=-1))


def _add_wires(
    pyvista: Any, plotter: Any, cable: Cable, part: Part, conductor: Conductor, start: float, end: float
) -> None:
    """Bare wires of a stranded conductor: core, strand and wire as a helix on a helix on a helix."""
    strand = conductor.strand
    assert strand is not None
    straight = 1e3
    finest = min(strand.lay or end, conductor.lay or end)
    stations = np.linspace(start, end, max(24, int(72 * (end - start) / finest)))
    core = Helix(part.centre_radius, cable.lay or straight, cable.hand, part.phase)
    lines: list[CentreLine] = []
    for count, radius in zip(
        conductor.layers, layer_radii(conductor.layers, strand.diameter, conductor.name), strict=True
    ):
        for k in range(count):
            rope = Helix(radius, conductor.lay or straight, conductor.hand, 2 * np.pi * k / count)
            axis = nested_helix([core, rope], stations)
            for n, wire_radius in zip(strand.layers, strand.radii, strict=True):
                wound = [Helix(wire_radius, strand.lay or straight, strand.hand, 2 * np.pi * j / n) for j in range(n)]
                lines += [wound_on(axis, wire, transport=False) for wire in wound]
    points, normals, quads = wire_surfaces(lines, strand.wire_diameter / 2)
    mesh = pyvista.PolyData.from_regular_faces(points, quads)
    mesh.point_data["Normals"] = normals
    mesh.point_data.active_normals_name = "Normals"
    plotter.add_mesh(mesh, smooth_shading=True, **_style("conductor"))
    rims = points.reshape(len(lines), len(stations), WIRE_SIDES, 3)[:, -1].reshape(-1, 3)
    fans = np.arange(len(rims)).reshape(len(lines), WIRE_SIDES)
    plotter.add_mesh(pyvista.PolyData.from_regular_faces(rims, fans), **_style("conductor"))
