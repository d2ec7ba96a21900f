"""Solids for CAD: the parts of the cable as pipes along their helices, written as STEP or BREP.

The section of a part in the plane normal to its own centre line is swept along the helix with the Frenet frame by OpenCASCADE.
The volume of a pipe is exactly its section times its length.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from geometry.cable import Cable, Part
from geometry.errors import GeometryError, MeshError
from geometry.gmsh_session import gmsh_session
from geometry.helix import Helix
from geometry.quiet_output import quiet_output

FORMATS = (".step", ".stp", ".brep")
POINTS_PER_TURN = 48
DEFAULT_KINDS = ("conductor", "insulation", "screen", "cover", "wrap", "sheath")


@dataclass(frozen=True)
class Solid:
    """One solid that was written: `volume` as OpenCASCADE computes it and `closed_form` [m^3]."""

    name: str
    volume: float
    closed_form: float


def write_solids(cable: Cable, path: str | Path, length: float, kinds: tuple[str, ...] = DEFAULT_KINDS) -> list[Solid]:
    """Write the parts of the given kinds as solids of a cable of `length` [m]; coordinates in the file are millimetres.

    The ends of laid parts are normal to their own centre lines. The interstices are not written.

    Raises
    ------
    GeometryError
        If the ending is unknown, the length not positive, no part is of these kinds, or the file cannot be written.
    """
    path = Path(path)
    if path.suffix.lower() not in FORMATS:
        raise GeometryError(
            f'solids cannot be written to "{path.name}": choose a name that ends in {", ".join(FORMATS)}.'
        )
    if not (np.isfinite(length) and length > 0):
        raise GeometryError(f"the length of the solids must be positive, found {length:g} m.")
    parts = [part for part in cable.parts if part.kind in kinds and part.kind != "interstices"]
    if not parts:
        raise GeometryError(f"the cable has no solid parts of the kinds {', '.join(kinds)}; it has {_kinds(cable)}.")
    path.parent.mkdir(parents=True, exist_ok=True)
    found = []
    try:
        with gmsh_session(cable.name) as gmsh:
            gmsh.option.setString("Geometry.OCCTargetUnit", "MM")
            for part in parts:
                tag = _pipe(gmsh, cable, part, 1e3 * length)
                gmsh.model.occ.synchronize()
                gmsh.model.setEntityName(3, tag, part.name)
                closed = np.pi * (part.outer_radius**2 - part.inner_radius**2) * length / np.cos(part.lay_angle)
                found.append(Solid(part.name, 1e-9 * gmsh.model.occ.getMass(3, tag), float(closed)))
            with quiet_output():
                gmsh.write(str(path))
    except MeshError as error:
        raise GeometryError(f"the solids cannot be made: {error}") from None
    if not path.is_file():
        raise GeometryError(f'the solids could not be written to "{path}"; check that the folder can be written to.')
    return found


def _pipe(gmsh: Any, cable: Cable, part: Part, length: float) -> int:
    """One solid [mm]; returns its tag."""
    occ = gmsh.model.occ
    r, inner, outer = (1e3 * x for x in (part.centre_radius, part.inner_radius, part.outer_radius))
    if r == 0 or cable.lay is None:
        x, y = r * np.cos(part.phase), r * np.sin(part.phase)
        body = occ.addCylinder(x, y, 0, 0, 0, length, outer)
        if inner == 0:
            return body
        return occ.cut([(3, body)], [(3, occ.addCylinder(x, y, 0, 0, 0, length, inner))])[0][0][1]
    helix = Helix(r, 1e3 * cable.lay, cable.hand, part.phase)
    z = np.linspace(0, length, max(8, int(np.ceil(POINTS_PER_TURN * length / helix.pitch)) + 1))
    start, (tangent, normal, _) = helix.position(0.0), helix.frenet_frame(0.0)
    spline = occ.addSpline(
        [occ.addPoint(*xyz) for xyz in helix.position(z)],
        tangents=[*helix.tangent(0.0), *helix.tangent(length)],
    )
    wire = occ.addWire([spline])
    loops = [
        occ.addCurveLoop([occ.addCircle(*start, radius, zAxis=list(tangent), xAxis=list(normal))])
        for radius in ([outer, inner] if inner > 0 else [outer])
    ]
    disc = occ.addPlaneSurface(loops)
    pipe = occ.addPipe([(2, disc)], wire, "Frenet")
    occ.remove([(2, disc)], recursive=False)
    return next(tag for dim, tag in pipe if dim == 3)


def _kinds(cable: Cable) -> str:
    return ", ".join(dict.fromkeys(part.kind for part in cable.parts))
