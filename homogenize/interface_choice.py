"""Which parts of a section do not simply stick to each other, chosen by the names of the two sides.

A name is two sides with a hyphen between. A side is the name of a part ("power core 1 screen"), of a member ("power core 1"),
a kind of part ("conductor", "insulation", "screen", "cover", "interstices", "wrap", "sheath", ...), or one of

* ``core``: a member with parts about its own centre line, off the axis; ``centre``: the same on the axis;
* ``filler``: the interstices; ``surroundings``: every other part that touches the first side.

Two names are wider than their words: ``conductor-insulation`` is every conductor against whatever surrounds it, and ``core-filler``
every core against whatever surrounds it, other cores, the centre and the wrap included. Parts of one core never part in a name with "core".
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from geometry.cell_mesh import CrossSectionMesh
from geometry.errors import MeshError, SpecError

WIDER = {"conductor-insulation": ("conductor", "surroundings"), "core-filler": ("core", "surroundings")}
_CORED = ("conductor", "insulation", "screen", "cover")
_OFF_AXIS = 0.02
"""Of the section's radius: a member whose centre is farther from the axis is a core."""


class InterfaceLaw(Protocol):
    """What every interface law can say of itself."""

    @property
    def holds(self) -> bool:
        """Whether the interface resists a small slip."""
        ...

    def describe(self) -> str:
        """The law in words."""
        ...


@dataclass(frozen=True)
class Interfaces:
    """Interface laws by the name of the two sides; everything that is not named is bonded.

    Parameters
    ----------
    laws : mapping of names such as "conductor-insulation" or "core-filler" to a law:
        :class:`~homogenize.sliding_interface.Frictionless`, :class:`~homogenize.elastic_interface.Elastic`,
        :class:`~homogenize.coulomb_interface.Coulomb`, :class:`~homogenize.opening_contact.Unilateral`

    Raises
    ------
    SpecError
        If nothing is named.
    """

    laws: Mapping[str, InterfaceLaw]

    def __post_init__(self) -> None:
        if not self.laws:
            raise SpecError('no interface is named; write for instance {"conductor-insulation": Frictionless()}.')

    def describe(self) -> str:
        """All laws in words."""
        return "; ".join(f"{name} {law.describe()}" for name, law in self.laws.items())

    def separated(self, mesh: CrossSectionMesh) -> NDArray[np.int64]:
        """Number of the law between each two regions, shape (regions, regions), -1 where they are bonded.

        Raises
        ------
        MeshError
            If a name is not known, names parts that do not touch, or two names claim the same pair of parts.
        """
        touch = touching(mesh)
        law_of = np.full(touch.shape, -1, dtype=np.int64)
        names = list(self.laws)
        for number, name in enumerate(names):
            pairs = _pairs(mesh, name) & touch
            if not pairs.any():
                raise MeshError(_apart(mesh, touch, name))
            taken = law_of[pairs & (law_of >= 0)]
            if len(taken):
                raise MeshError(f'"{name}" and "{names[taken[0]]}" both name the same two parts: give them one law.')
            law_of[pairs] = number
        return law_of


def touching(mesh: CrossSectionMesh) -> NDArray[np.bool_]:
    """Whether two regions share an edge of the mesh, shape (regions, regions)."""
    corners = 3 if mesh.cell_kind.startswith("triangle") else 4
    around = mesh.cells[:, :corners]
    ends = np.sort(np.stack([around, np.roll(around, -1, axis=1)], axis=-1).reshape(-1, 2), axis=1)
    region = np.repeat(mesh.region_of, corners)
    order = np.lexsort((ends[:, 1], ends[:, 0]))
    ends, region = ends[order], region[order]
    same = (ends[1:] == ends[:-1]).all(axis=1)
    touch = np.zeros((len(mesh.regions),) * 2, dtype=bool)
    touch[region[:-1][same], region[1:][same]] = True
    touch |= touch.T
    np.fill_diagonal(touch, False)
    return touch


def members(mesh: CrossSectionMesh) -> list[str]:
    """The member each region belongs to: "power core 1 screen" to "power core 1"; a region named by its kind is its own."""
    return [region.name.removesuffix(f" {region.kind}") for region in mesh.regions]


def sides(mesh: CrossSectionMesh) -> dict[str, NDArray[np.bool_]]:
    """Regions, as a mask, of every word that can name a side."""
    member, kind = members(mesh), [region.kind for region in mesh.regions]
    found: dict[str, list[bool]] = {}
    for word in dict.fromkeys([*kind, *(r.name for r in mesh.regions), *member]):
        found[word] = [word in (k, r.name, m) for k, r, m in zip(kind, mesh.regions, member)]
    off = _off_axis(mesh, member)
    cored = {m for m, k in zip(member, kind) if k in _CORED}
    found["core"] = [m in cored and off[m] for m in member]
    found["centre"] = [m in cored and not off[m] for m in member]
    found["filler"] = [k == "interstices" for k in kind]
    found["surroundings"] = [True] * len(kind)
    return {word: np.array(mask) for word, mask in found.items() if any(mask)}


def _off_axis(mesh: CrossSectionMesh, member: list[str]) -> dict[str, bool]:
    """Whether the centre of each member, by its bounding box, lies off the axis."""
    radius = np.hypot(*mesh.points.T).max()
    off = {}
    for name in dict.fromkeys(member):
        belongs = np.array([m == name for m in member])[mesh.region_of]
        points = mesh.points[np.unique(mesh.cells[belongs])]
        off[name] = bool(np.hypot(*(points.max(axis=0) + points.min(axis=0)) / 2) > _OFF_AXIS * radius)
    return off


def _pairs(mesh: CrossSectionMesh, name: str) -> NDArray[np.bool_]:
    """Symmetric mask of the region pairs that a name means, touching or not."""
    known = sides(mesh)
    left, right = _split(name, known)
    A, B = known[left], known[right]
    pairs = A[:, None] & B[None, :]
    own = np.array(members(mesh))
    if "core" in (left, right) or "centre" in (left, right) or left in own or right in own:
        pairs &= own[:, None] != own[None, :]
    if right == "surroundings":
        pairs &= ~(A[:, None] & A[None, :]) | (own[:, None] != own[None, :])
    return pairs | pairs.T


def _split(name: str, known: Mapping[str, NDArray]) -> tuple[str, str]:
    first = WIDER.get(name)
    cuts = [(name[:i], name[i + 1 :]) for i, letter in enumerate(name) if letter == "-"] if first is None else [first]
    for left, right in cuts:
        if left in known and right in known:
            return left, right
    missing = [word for cut in cuts[:1] for word in cut if word not in known] or [name]
    words = [
        w
        for w in ("conductor", "insulation", "screen", "cover", "core", "centre", "filler", "wrap", "sheath")
        if w in known
    ]
    raise MeshError(
        f'nothing can slide at "{name}": no part is "{missing[0]}"; write two sides with a hyphen between, each one of '
        f"{', '.join([*words, 'surroundings'])} or the name of a part."
    )


def _apart(mesh: CrossSectionMesh, touch: NDArray[np.bool_], name: str) -> str:
    known = sides(mesh)
    left, right = _split(name, known)
    beside = np.asarray(touch[known[left]].any(axis=0))
    if left in ("core", "centre"):
        beside &= ~known[left]
    kinds = list(dict.fromkeys(r.kind for r, b in zip(mesh.regions, beside) if b)) or ["no other part"]
    return f'the interface "{name}" names parts that do not touch: {left} touches {", ".join(kinds)}, not {right}.'
