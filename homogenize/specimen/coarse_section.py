r"""A section of few elements for the expensive specimens: contacts that open, and large displacements.

:func:`~homogenize.specimen.specimen_mesh.specimen_mesh` follows every neck and cusp between the parts, which takes a thousand triangles
and more. Here interstices and sheath are one region where they are one material, so that the cusps between a core and the laid-up
circle are gone; where they are two, the sheath begins a little farther in and the cores bite into it, so that a core and the sheath
meet at an angle. Circles have a given number of sides (quadratic, so nearly round), and only a bare minimum stands in a neck.
The trace of a round core at lay angle beta, tan beta = 2 pi r / lay, is taken as an ellipse with the half-axes R and R / cos beta.
"""

from __future__ import annotations

import math

import numpy as np

from geometry.cable import Cable, Part
from geometry.cell_mesh import CrossSectionMesh, Region
from geometry.errors import MeshError
from geometry.gmsh_session import gmsh_session
from homogenize.section_field import section_field


def coarse_section(
    cable: Cable, *, sides: int = 8, size: float = 0.2, floor: float = 0.1, bite: float = 0.006
) -> CrossSectionMesh:
    """Quadratic triangles, a few hundred, on a cable of round parts in a filler.

    Parameters
    ----------
    cable : Cable
    sides : element edges round a core
    size, floor : largest and smallest edge that is asked for, over the outer diameter
    bite : depth of the cores in a sheath of another material than the filler, over the outer diameter

    Raises
    ------
    MeshError
        If a part is not round and laid once, or the mesh is not usable.
    """
    cable.check_single_lay()
    around, inside = _split(cable)
    twist = cable.twist_rate
    with gmsh_session(cable.name) as gmsh:
        occ = gmsh.model.occ
        body = occ.addDisk(0, 0, 0, cable.outer_radius, cable.outer_radius)
        discs = []
        if len(around) > 1:
            reach = max(part.centre_radius + part.outer_radius for part in inside) - bite * cable.outer_diameter
            radius = min(reach, around[1].outer_radius)
            discs.append((occ.addDisk(0, 0, 0, radius, radius), around[1]))
        for part in sorted(inside, key=lambda part: -part.outer_radius):
            across, along = part.outer_radius, part.outer_radius / math.cos(part.lay_angle)
            disc = occ.addDisk(part.centre_radius, 0, 0, along, across, -1, [], [0, 1, 0])
            occ.rotate([(2, disc)], 0, 0, 0, 0, 0, 1, part.phase)
            discs.append((disc, part))
        _, pieces = occ.fragment([(2, body)], [(2, disc) for disc, _ in discs])
        occ.synchronize()
        part_of = {tag: around[0] for _, tag in pieces[0]}
        for (_, part), found in zip(discs, pieces[1:]):  # smaller discs last: what is inside overrides
            part_of.update({tag: part for _, tag in found})
        for option, value in (
            ("MeshSizeMax", size * cable.outer_diameter),
            ("MeshSizeMin", floor * cable.outer_diameter),
            ("MeshSizeFromCurvature", sides),
            ("ElementOrder", 2),
            ("HighOrderOptimize", 2),
        ):
            gmsh.option.setNumber(f"Mesh.{option}", value)
        gmsh.model.mesh.generate(2)
        tags, places, _ = gmsh.model.mesh.getNodes()
        number = np.zeros(int(tags.max()) + 1, dtype=np.int64)
        number[tags] = np.arange(len(tags))
        cells, region_of, parts = [], [], [part for part in cable.parts if part in part_of.values()]
        for _, tag in gmsh.model.getEntities(2):
            for nodes in gmsh.model.mesh.getElements(2, tag)[2]:
                found = number[nodes.astype(np.int64)].reshape(-1, 6)
                cells.append(found)
                region_of += [parts.index(part_of[tag])] * len(found)
    used, flat = np.unique(np.concatenate(cells), return_inverse=True)
    regions = tuple(Region(part.name, part.kind, part.material, float("nan")) for part in parts)
    mesh = CrossSectionMesh(
        places.reshape(-1, 3)[used, :2], flat.reshape(-1, 6), "triangle6", np.array(region_of), regions, twist
    )
    section_field(mesh)
    return mesh


def _split(cable: Cable) -> tuple[list[Part], list[Part]]:
    """What is round the cores, the outermost first (the filler alone where all is one material); and the rest."""
    kinds = ("sheath", "interstices")
    around = sorted((part for part in cable.parts if part.kind in kinds), key=lambda part: kinds.index(part.kind))
    inside = [part for part in cable.parts if part.kind not in kinds]
    layers = [part.name for part in inside if around and part.outer_radius > around[-1].outer_radius]
    if layers or not 1 <= len(around) <= 2:
        what = f"{layers[0]} lies between" if layers else f"found {len(around)} parts"
        raise MeshError(f"a coarse section has cores in a filler and a sheath, {what}; take specimen_mesh.")
    if len({(part.material.E, part.material.nu) for part in around}) == 1:
        del around[:-1]
    return around, inside
