"""Solids for CAD: the parts of the cable as pipes along their helices, written as STEP or BREP.

The section of a member in the plane normal to its own centre line is swept along that line by OpenCASCADE: parts along
their helix in the cable, strands along the double helix of strand in core and core in cable (laid_member.py). The volume
of a pipe is exactly its section times its length. Members that are alike are swept once and turned about the axis.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from geometry.cable import Cable
from geometry.errors import GeometryError, MeshError
from geometry.gmsh_session import gmsh_session
from geometry.laid_member import LaidMember, laid_members
from geometry.quiet_output import quiet_output
from geometry.self_intersection import check_self_intersection

FORMATS = (".step", ".stp", ".brep")
POINTS_PER_TURN = 64
DEFAULT_KINDS = ("conductor", "insulation", "screen", "cover", "wrap", "sheath", "armour", "wire", "bedding")
MOST_POINTS = 400_000
"""Points of the splines of one file; a longer piece is refused."""


@dataclass(frozen=True)
class Solid:
    """One solid that was written: `volume` as OpenCASCADE computes it and `closed_form` [m^3]."""

    name: str
    volume: float
    closed_form: float


def write_solids(
    cable: Cable,
    path: str | Path,
    length: float,
    kinds: tuple[str, ...] = DEFAULT_KINDS,
    level: str = "conductor",
) -> list[Solid]:
    """Write the parts of the given kinds as solids of a cable of `length` [m]; coordinates in the file are millimetres.

    The ends of laid members are normal to their own centre lines. The interstices and the voids between strands are not
    written. Strands that would cut each other slightly, because they are flattened in reality, are written round
    (``self_intersections`` lists them).

    Parameters
    ----------
    level : "conductor" writes stranded conductors as one cylinder, "strand" writes their strands

    Raises
    ------
    GeometryError
        If the ending or the level is unknown, the length not positive or too long for one file, no part is of these kinds,
        two parts cut each other, or the file cannot be written.
    """
    path = Path(path)
    members = _checked(cable, path, length, kinds, level)
    path.parent.mkdir(parents=True, exist_ok=True)
    found = []
    try:
        with gmsh_session(cable.name) as gmsh:
            gmsh.option.setString("Geometry.OCCTargetUnit", "MM")
            models: dict[tuple[Any, ...], tuple[int, float, float]] = {}
            made = [_solid(gmsh, member, length, models) for member in members]
            gmsh.model.occ.synchronize()
            for member, (tag, closed) in zip(members, made, strict=True):
                gmsh.model.setEntityName(3, tag, member.name)
                found.append(Solid(member.name, 1e-9 * gmsh.model.occ.getMass(3, tag), closed))
            with quiet_output():
                gmsh.write(str(path))
    except MeshError as error:
        raise GeometryError(f"the solids cannot be made: {error}") from None
    if not path.is_file():
        raise GeometryError(f'the solids could not be written to "{path}"; check that the folder can be written to.')
    return found


def _checked(cable: Cable, path: Path, length: float, kinds: tuple[str, ...], level: str) -> list[LaidMember]:
    """The members to write, after all checks of the input."""
    if path.suffix.lower() not in FORMATS:
        raise GeometryError(
            f'solids cannot be written to "{path.name}": choose a name that ends in {", ".join(FORMATS)}.'
        )
    if not (np.isfinite(length) and length > 0):
        raise GeometryError(f"the length of the solids must be positive, found {length:g} m.")
    members = laid_members(cable, level, kinds)
    if not members:
        raise GeometryError(f"the cable has no solid parts of the kinds {', '.join(kinds)}; it has {_kinds(cable)}.")
    points = sum(POINTS_PER_TURN * length / m.finest_pitch for m in members if not m.straight)
    if points > MOST_POINTS:
        raise GeometryError(
            f"solids of {length:g} m need {points:.3g} points along their centre lines: choose at most "
            f"{length * MOST_POINTS / points:.3g} m."
        )
    check_self_intersection(cable, min(length, 1.0), level)
    return members


def _solid(
    gmsh: Any, member: LaidMember, length: float, models: dict[tuple[Any, ...], tuple[int, float, float]]
) -> tuple[int, float]:
    """Tag and exact volume [m^3] of one solid [mm]; a member like an earlier one is its copy, turned about the axis."""
    phase = member.levels[0].phase
    key = (replace(member.levels[0], phase=0.0), *member.levels[1:], member.inner_radius, member.outer_radius)
    if key in models:
        tag, first, closed = models[key]
        ((_, copied),) = gmsh.model.occ.copy([(3, tag)])
        gmsh.model.occ.rotate([(3, copied)], 0, 0, 0, 0, 0, 1, phase - first)
        return copied, closed
    tag, closed = _pipe(gmsh, member, length), member.volume(length)
    models[key] = (tag, phase, closed)
    return tag, closed


def _pipe(gmsh: Any, member: LaidMember, length: float) -> int:
    """One solid [mm]; returns its tag."""
    occ = gmsh.model.occ
    radii = [1e3 * r for r in (member.outer_radius, member.inner_radius) if r > 0]
    z = member.stations(0.0, length, POINTS_PER_TURN)
    if member.straight:
        x, y, _ = 1e3 * member.centre_line(z[[0, -1]]).points[0]
        bodies = [(3, occ.addCylinder(x, y, 0, 0, 0, 1e3 * length, radius)) for radius in radii]
        return bodies[0][1] if len(bodies) == 1 else occ.cut(bodies[:1], bodies[1:])[0][0][1]
    line = member.centre_line(z)
    points, tangents, normal = 1e3 * line.points, line.frames[[0, -1], 0], line.frames[0, 1]
    spline = occ.addSpline([occ.addPoint(*xyz) for xyz in points], tangents=tangents.ravel().tolist())
    loops = [
        occ.addCurveLoop([occ.addCircle(*points[0], radius, zAxis=tangents[0].tolist(), xAxis=normal.tolist())])
        for radius in radii
    ]
    disc = occ.addPlaneSurface(loops)
    pipe = occ.addPipe([(2, disc)], occ.addWire([spline]), "DiscreteTrihedron")
    occ.remove([(2, disc)], recursive=False)
    return next(tag for dim, tag in pipe if dim == 3)


def _kinds(cable: Cable) -> str:
    return ", ".join(dict.fromkeys(part.kind for part in cable.parts))
