r"""Round members of a cable with the helices they lie on: cores in the cable, strands in a core, wires laid about the axis.

A member is a round body (inner to outer radius in the plane normal to its own centre line) on a nest of helices
(nested_helix.py). Strand i of n in a layer of a conductor stands, in the section z = 0, at the angle 2 pi i / n from the
outward direction of its conductor, and runs on in the frame of parallel transport. Over a core helix of curvature kappa and
torsion t, a strand at radius r and lay p has the length, per arc length s of the core,

.. math::  \sqrt{(1 + r\kappa\cos\varphi)^2 + (2\pi r/p)^2},\qquad \varphi = (h\,2\pi/p - t)\,s + 2\pi i/n ,

phi from the outward direction; by Pappus' theorem a pipe of radius rho about it has the volume pi rho^2 x that length.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from geometry.cable import Cable, Part
from geometry.errors import GeometryError
from geometry.helix import Helix
from geometry.nested_helix import SAMPLES_PER_TURN, CentreLine, wound_on
from geometry.strand import Conductor, Strand, layer_radii

STRAIGHT = 1e9
"""Pitch [m] that stands for a straight member."""
LEVELS = ("conductor", "strand")


@dataclass(frozen=True)
class LaidMember:
    """Round member of a cable.

    Attributes
    ----------
    name : as the part; strands add their layer and place, such as "power core 1 conductor strand 2.3"
    part : the part it is, or belongs to
    inner_radius, outer_radius : in the plane normal to its own centre line [m]
    levels : helices from the outermost (in the cable) to its own
    count : how many members its layer holds
    """

    name: str
    part: Part
    inner_radius: float
    outer_radius: float
    levels: tuple[Helix, ...]
    count: int = 1

    @property
    def kind(self) -> str:
        """Kind of its part."""
        return self.part.kind

    @property
    def straight(self) -> bool:
        """Whether its centre line is straight."""
        return all(level.radius == 0 or level.pitch >= STRAIGHT for level in self.levels)

    @property
    def finest_pitch(self) -> float:
        """The shortest pitch [m] among its levels that bend it."""
        return min((level.pitch for level in self.levels if level.radius > 0), default=STRAIGHT)

    def centre_line(self, z: ArrayLike) -> CentreLine:
        """Centre line at increasing heights of the first level [m]; phases count from the section z = 0.

        The arc length `s` counts from z[0]. Frames turn with no level but the first (parallel transport).
        """
        heights = np.asarray(z, dtype=float)
        fine = self._fine(heights)
        origin = int(np.searchsorted(fine, 0.0))
        helix = self.levels[0]
        line = CentreLine(fine, helix.position(fine), helix.transported_frame(fine), fine / np.cos(helix.lay_angle))
        for level in self.levels[1:]:
            line = wound_from_origin(line, level, origin)
        rows = np.searchsorted(fine, heights)
        return CentreLine(heights, line.points[rows], line.frames[rows], line.s[rows] - line.s[rows[0]])

    def length(self, height: float) -> float:
        """Length [m] of its centre line over the heights 0 to `height` of its first level."""
        if len(self.levels) == 1:
            return self.levels[0].length(height)
        return float(self.centre_line(np.array([0.0, height])).s[-1])

    def volume(self, height: float) -> float:
        """Volume [m^3] over that length, ends normal to the centre line: section x length (Pappus)."""
        return float(np.pi * (self.outer_radius**2 - self.inner_radius**2) * self.length(height))

    def curvature(self, z: ArrayLike) -> NDArray[np.float64]:
        """Curvature [1/m] of the centre line at increasing heights, by differences of the tangents over the arc length."""
        if len(self.levels) == 1:
            return np.full(np.shape(z), self.levels[0].curvature)
        line = self.centre_line(z)
        return np.linalg.norm(np.gradient(line.frames[:, 0], line.s, axis=0, edge_order=2), axis=1)

    def stations(self, start: float, end: float, per_turn: int = SAMPLES_PER_TURN) -> NDArray[np.float64]:
        """Heights from `start` to `end` with at least `per_turn` steps in the shortest pitch."""
        steps = int(np.ceil(per_turn * (end - start) / self.finest_pitch))
        return np.linspace(start, end, max(8, steps) + 1)

    def _fine(self, heights: NDArray[np.float64]) -> NDArray[np.float64]:
        """The heights and zero, with steps between them that follow every level."""
        if heights.ndim != 1 or len(heights) < 2 or not (np.diff(heights) > 0).all():
            raise GeometryError("the heights of a centre line must be a list of at least two increasing numbers.")
        low, high = min(heights[0], 0.0), max(heights[-1], 0.0)
        knots = np.union1d(heights, [low, 0.0, high])
        step = max(min(self.finest_pitch / SAMPLES_PER_TURN, (high - low) / 8), 1e-9)
        counts = np.maximum(np.ceil(np.diff(knots) / step).astype(int), 1)
        pieces = [np.linspace(a, b, n + 1)[:-1] for a, b, n in zip(knots[:-1], knots[1:], counts, strict=True)]
        return np.concatenate([*pieces, knots[-1:]])


def laid_members(cable: Cable, level: str = "conductor", kinds: tuple[str, ...] | None = None) -> list[LaidMember]:
    """The round members of a cable, in the order of its parts; the interstices are not round and left out.

    Parameters
    ----------
    level : "conductor" takes stranded conductors as one cylinder, "strand" takes their strands instead
    kinds : kinds of parts to take, None for all

    Raises
    ------
    GeometryError
        If the level is unknown.
    """
    if level not in LEVELS:
        raise GeometryError(f'the level of solids is "conductor" or "strand", found "{level}".')
    found = []
    for part in cable.parts:
        if part.kind == "interstices" or (kinds is not None and part.kind not in kinds):
            continue
        conductor = stranded(cable, part) if level == "strand" else None
        found += [whole_member(part)] if conductor is None else strands(part, conductor)
    return found


def whole_member(part: Part) -> LaidMember:
    """A part as one round member on its own helix."""
    return LaidMember(part.name, part, part.inner_radius, part.outer_radius, (part_helix(part),))


def part_helix(part: Part) -> Helix:
    """Helix of the centre line of a part; `STRAIGHT` pitch if it does not turn."""
    pitch = 2 * np.pi / abs(part.twist_rate) if part.twist_rate else STRAIGHT
    return Helix(part.centre_radius, pitch, "S" if part.twist_rate < 0 else "Z", part.phase)


def stranded(cable: Cable, part: Part) -> Conductor | None:
    """Make-up of a conductor whose strands are known; None for other parts."""
    conductor = cable.conductor_of(part)
    return conductor if conductor is not None and conductor.strand is not None and conductor.layers else None


def strands(part: Part, conductor: Conductor) -> list[LaidMember]:
    """The strands of a conductor, from the inside."""
    strand = conductor.strand
    assert strand is not None
    radius, found = strand.diameter / 2, []
    for k, (n, r) in enumerate(
        zip(conductor.layers, layer_radii(conductor.layers, strand.diameter, conductor.name), strict=True), 1
    ):
        for i in range(n):
            name = f"{part.name} strand {k}.{i + 1}"
            pitch = conductor.lay if r > 0 and conductor.lay is not None else STRAIGHT
            own = Helix(r, pitch, conductor.hand, 2 * np.pi * i / n + np.pi)  # e1 points inwards at z = 0
            found.append(LaidMember(name, part, 0.0, radius, (part_helix(part), own), n))
    return found


def wires(member: LaidMember, strand: Strand) -> list[LaidMember]:
    """The wires of a strand, from the inside; the first of each layer at the outward side of the strand at z = 0."""
    found = []
    for k, (n, r) in enumerate(zip(strand.layers, strand.radii, strict=True), 1):
        for i in range(n):
            pitch = strand.lay if r > 0 and strand.lay is not None else STRAIGHT
            own = Helix(r, pitch, strand.hand, 2 * np.pi * i / n)
            name = f"{member.name} wire {k}.{i + 1}"
            found.append(LaidMember(name, member.part, 0.0, strand.wire_diameter / 2, (*member.levels, own), n))
    return found


def wound_from_origin(host: CentreLine, level: Helix, origin: int) -> CentreLine:
    """A member wound on its finely sampled host line, with s = 0 and e1 pointing away from the host at the row `origin`.

    The arc length of the host must be zero there, so that the phase of `level` counts from it.
    """
    line = wound_on(host, level)
    e1, e2 = line.frames[origin, 1:]
    h1, h2 = host.frames[origin, 1:]
    out = np.cos(level.phase) * h1 + np.sin(level.phase) * h2
    turn = np.arctan2(out @ e2, out @ e1)
    c, s = np.cos(turn), np.sin(turn)
    first = c * line.frames[:, 1] + s * line.frames[:, 2]
    second = -s * line.frames[:, 1] + c * line.frames[:, 2]
    return replace(line, frames=np.stack([line.frames[:, 0], first, second], axis=1), s=line.s - line.s[origin])
