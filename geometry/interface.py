"""Named interfaces: the faces in which two regions of a volume mesh meet.

An interface carries the names of its two regions, "power core 1 strand 1 | power core 1 strand 2", and their kinds. What is
bonded, slides or rubs is chosen by a word of cable making (`CHOICES`), by kinds ("screen-interstices"), or by a name
with wildcards ("power core 1 *|*"). A contact law later needs the nodes on both sides, see doubled_nodes.py.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase

import numpy as np
from numpy.typing import NDArray

from geometry.cell_face import cell_table, faces_at, regions_of_cells, same_faces
from geometry.cell_mesh import SliceMesh, SweptCell
from geometry.errors import MeshError

CORE = {"insulation", "screen"}
CENTRE = {"cover"}
CHOICES: dict[str, tuple[set[str], set[str]]] = {
    "strand-strand": ({"strand"}, {"strand"}),
    "conductor-insulation": ({"conductor", "strand"}, CORE | CENTRE),
    "insulation-screen": ({"insulation"}, {"screen"}),
    "core-core": (CORE, CORE),
    "core-filler": (CORE, {"interstices"}),
    "core-wrap": (CORE, {"wrap"}),
    "core-sheath": (CORE, {"sheath"}),
    "centre-core": (CENTRE, CORE),
    "centre-filler": (CENTRE, {"interstices"}),
    "filler-wrap": ({"interstices"}, {"wrap"}),
    "filler-sheath": ({"interstices"}, {"sheath"}),
    "wrap-sheath": ({"wrap"}, {"sheath"}),
}
"""Kinds of the two sides; "core-core" are different cores, "insulation-screen" is inside one core."""
GAUSS = np.array([-1.0, 1.0]) / np.sqrt(3.0)


@dataclass(frozen=True)
class Interface:
    """Faces shared by the cells of two regions.

    Attributes
    ----------
    name : "a | b", the names of the regions
    regions : (a, b) indices into the regions of the mesh, a < b
    kinds : kinds of the two regions
    faces : (f, 4) node numbers seen from a outwards; (f, 3) if all are triangles; a triangle among quadrilaterals repeats its last node
    cells : (f, 2) the cell of a and the cell of b, counted over all blocks
    area : [m^2]
    """

    name: str
    regions: tuple[int, int]
    kinds: tuple[str, str]
    faces: NDArray[np.int64]
    cells: NDArray[np.int64]
    area: float


def interfaces(mesh: SliceMesh | SweptCell) -> tuple[Interface, ...]:
    """All interfaces of a mesh, ordered by their regions.

    Raises
    ------
    MeshError
        If three cells share one face.
    """
    table, region = cell_table(mesh), regions_of_cells(mesh)
    used = table >= 0
    lowest = np.full(len(mesh.points), len(mesh.regions))
    highest = np.full(len(mesh.points), -1)
    owners = np.broadcast_to(region[:, None], table.shape)[used]
    np.minimum.at(lowest, table[used], owners)
    np.maximum.at(highest, table[used], owners)
    faces = faces_at(mesh, lowest < highest, whole=True)
    pairs = same_faces(faces.nodes, mesh)
    sides = region[faces.cells[pairs]]
    backwards = sides[:, 0] > sides[:, 1]
    pairs[backwards] = pairs[backwards, ::-1]
    sides.sort(axis=1)
    pairs, sides = pairs[sides[:, 0] != sides[:, 1]], sides[sides[:, 0] != sides[:, 1]]
    found = []
    for a, b in np.unique(sides, axis=0):
        rows = pairs[(sides[:, 0] == a) & (sides[:, 1] == b)]
        rows = rows[np.lexsort(faces.cells[rows].T[::-1])]
        nodes = _closed(faces.nodes[rows[:, 0]])
        name = f"{mesh.regions[a].name} | {mesh.regions[b].name}"
        kinds = (mesh.regions[a].kind, mesh.regions[b].kind)
        area = float(face_areas(mesh.points, nodes).sum())
        found.append(Interface(name, (int(a), int(b)), kinds, nodes, faces.cells[rows], area))
    return tuple(found)


def select_interfaces(found: Sequence[Interface], *wanted: str) -> tuple[Interface, ...]:
    """The interfaces that are meant by any of the words.

    Parameters
    ----------
    found : all interfaces of a mesh
    wanted : a key of `CHOICES` ("core-filler"), two kinds ("screen-interstices") or two names ("earth *|*"), in any order

    Raises
    ------
    MeshError
        If a word means none of them.
    """
    chosen: set[int] = set()
    for word in wanted:
        numbers = {k for k, interface in enumerate(found) if _is_meant(interface, word)}
        if not numbers:
            there = sorted({"|".join(interface.kinds) for interface in found})
            raise MeshError(
                f'no interface of this mesh is meant by "{word}"; there are {", ".join(there) or "none"}: '
                f"try two of these kinds, two names of regions, or one of {', '.join(CHOICES)}."
            )
        chosen |= numbers
    return tuple(found[k] for k in sorted(chosen))


def face_areas(points: NDArray[np.float64], faces: NDArray[np.int64]) -> NDArray[np.float64]:
    """Area [m^2] of triangles or bilinear quadrilaterals, shape (f,); 2 x 2 Gauss points."""
    corners = points[_closed(faces)]
    if corners.shape[1] == 3:
        corners = corners[:, [0, 1, 2, 2]]
    total = np.zeros(len(corners))
    a, b, c, d = corners.transpose(1, 0, 2)
    for x in GAUSS:
        for y in GAUSS:
            along = (1 - y) * (b - a) + (1 + y) * (c - d)
            across = (1 - x) * (d - a) + (1 + x) * (c - b)
            total += np.linalg.norm(np.cross(along, across), axis=1) / 16
    return total


def face_normals(points: NDArray[np.float64], faces: NDArray[np.int64]) -> NDArray[np.float64]:
    """Unit normal of the vector area of each face, (f, 3), by the right-hand rule."""
    corners = points[_closed(faces)]
    if corners.shape[1] == 3:
        corners = corners[:, [0, 1, 2, 2]]
    normal = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    return normal / np.linalg.norm(normal, axis=1)[:, None]


def _closed(nodes: NDArray[np.int64]) -> NDArray[np.int64]:
    """Triangles among quadrilaterals with their last node repeated; three columns if there are triangles only."""
    if nodes.shape[1] == 3 or (len(nodes) and (nodes[:, 3] < 0).all()):
        return nodes[:, :3]
    return np.column_stack([nodes[:, :3], np.where(nodes[:, 3] < 0, nodes[:, 2], nodes[:, 3])])


def _is_meant(interface: Interface, word: str) -> bool:
    if word in CHOICES:
        one, other = CHOICES[word]
        a, b = interface.kinds
        return ((a in one and b in other) or (a in other and b in one)) and (
            word != "core-core" or not _one_core(interface)
        )
    one, bar, other = (side.strip() for side in word.partition("|" if "|" in word else "-"))
    names = interface.name.split(" | ")
    return bool(bar) and any(
        fnmatchcase(sides[0], one) and fnmatchcase(sides[1], other)
        for pair in (interface.kinds, names)
        for sides in (pair, pair[::-1])
    )


def _one_core(interface: Interface) -> bool:
    """Whether both regions are layers of one core: they differ in kind and their names in the last word only."""
    a, b = (name.rsplit(" ", 1)[0] for name in interface.name.split(" | "))
    return a == b
