r"""What holds the two ends of a specimen, as linear maps from the free unknowns of an end-section to all of its unknowns.

* :class:`Held`: the end z = 0; all of the section, or the named parts with the surfaces they touch, do not move.
* :class:`Traction`: the end z = L is free, the load is spread over all of the section or over the named parts.
* :class:`Plate`: the end z = L, or the named parts of it, moves as a rigid body; the plate may or may not tilt and twist, and it can always
  move across and along the cable. A motion that is not free meets a reaction.

Parts are named as on an interface: "conductor", "sheath", "insulation", "interstices", "power core 1", ...
Where a part slides in its surroundings, gripping it grips the nodes of the surface around it too, at that one section.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from geometry.cell_mesh import CrossSectionMesh
from geometry.errors import SpecError
from homogenize.interface_choice import sides
from homogenize.section_field import FloatArray
from homogenize.section_system import SectionSystem


@dataclass(frozen=True)
class Held:
    """The end z = 0 does not move; all of it, or `parts`."""

    parts: tuple[str, ...] = ()

    def describe(self) -> str:
        """The condition in words."""
        return "end-section fixed" if not self.parts else f"{_listed(self.parts)} gripped"


@dataclass(frozen=True)
class Traction:
    """The end z = L is free and loaded by a traction on all of it, or on `parts`."""

    parts: tuple[str, ...] = ()

    def describe(self) -> str:
        """The condition in words."""
        return f"traction on {_listed(self.parts) if self.parts else 'the whole end-section'}"


@dataclass(frozen=True)
class Plate:
    """The end z = L, or `parts` of it, moves as a rigid body, which may `tilt` and `twist` or not."""

    tilt: bool = True
    twist: bool = True
    parts: tuple[str, ...] = ()

    @property
    def free_motions(self) -> tuple[int, ...]:
        """Free columns of the rigid motions: three translations, turns about x, y, z."""
        return (0, 1, 2, *((3, 4) if self.tilt else ()), *((5,) if self.twist else ()))

    def describe(self) -> str:
        """The condition in words."""
        what = "rigid plate" if not self.parts else f"{_listed(self.parts)} gripped by a rigid plate"
        free = [word for word, free in (("tilt", self.tilt), ("twist", self.twist)) if free]
        return f"{what}, free to {' and '.join(free)}" if free else f"{what}, neither tilting nor twisting"


@dataclass(frozen=True)
class EndMap:
    """Unknowns of an end-section from its free ones.

    Attributes
    ----------
    A : (n, free) sparse; columns are orthonormal
    free : number of free unknowns
    closed : whether no unknown of the section itself is free (fixed, or all in a rigid plate)
    rigid : (n, r) the plate's motions, orthonormal; no columns where there is no plate
    """

    A: sp.csr_array
    free: int
    closed: bool
    rigid: FloatArray

    def project(self, R: FloatArray) -> FloatArray:
        """The nearest admissible values of R (n, loads)."""
        return self.A @ (self.A.T @ R)


def held_end(end: Held, system: SectionSystem, mesh: CrossSectionMesh) -> EndMap:
    """The map of z = 0.

    Raises
    ------
    SpecError
        If a part is not there.
    """
    n = len(system.pencil.Z)
    gripped = gripped_unknowns(end.parts, system, mesh)
    return EndMap(_identity(n, ~gripped), int((~gripped).sum()), bool(gripped.all()), np.zeros((n, 0)))


def loaded_end(end: Traction | Plate, system: SectionSystem, mesh: CrossSectionMesh) -> EndMap:
    """The map of z = L, in the frame that turns with the cable (a plate's free motions do not depend on that turn).

    Raises
    ------
    SpecError
        If a part is not there.
    """
    n = len(system.pencil.Z)
    if isinstance(end, Traction):
        region_mask(end.parts, mesh)
        return EndMap(_identity(n, np.ones(n, dtype=bool)), n, False, np.zeros((n, 0)))
    gripped = gripped_unknowns(end.parts, system, mesh)
    rigid = np.where(gripped[:, None], system.pencil.Z[:, list(end.free_motions)], 0.0)
    rigid, _ = np.linalg.qr(rigid)
    A = sp.csr_array(sp.hstack([_identity(n, ~gripped), sp.csr_array(rigid)]))
    return EndMap(A, int((~gripped).sum()) + rigid.shape[1], bool(gripped.all()), rigid)


def region_mask(parts: Sequence[str], mesh: CrossSectionMesh) -> NDArray[np.bool_]:
    """(regions,) those that the words name; all of them for no words.

    Raises
    ------
    SpecError
        If a word is not known.
    """
    known = sides(mesh)
    mask = np.zeros(len(mesh.regions), dtype=bool)
    for part in parts:
        if part not in known or not np.any(known[part]):
            raise SpecError(
                f'the end of the specimen names "{part}", which is not a part; known are {", ".join(known)}.'
            )
        mask |= known[part]
    return mask if parts else ~mask


def gripped_unknowns(parts: Sequence[str], system: SectionSystem, mesh: CrossSectionMesh) -> NDArray[np.bool_]:
    """(n,) unknowns of the section that belong to the nodes of the parts."""
    if not parts:
        return np.ones(len(system.pencil.Z), dtype=bool)
    inside = region_mask(parts, mesh)[system.field.region_of]
    nodal = np.zeros(system.field.unknowns, dtype=bool)
    nodal[(3 * np.unique(system.field.cells[:, inside])[:, None] + np.arange(3)).ravel()] = True
    return nodal if system.T is None else np.asarray(abs(system.T).T @ nodal.astype(float) > 0)


def read_end(text: str) -> Traction | Plate:
    """The loaded end in words: "uniform", "traction:sheath+interstices", "plate", "plate:no-tilt,no-twist", "grip:conductor".

    Raises
    ------
    SpecError
        If the words are not known.

    Examples
    --------
    >>> read_end("plate:no-twist").describe()
    'rigid plate, free to tilt'
    >>> read_end("traction:sheath+interstices").describe()
    'traction on sheath and interstices'
    """
    word, _, rest = (part.strip() for part in text.partition(":"))
    details = [d.strip() for d in rest.split(",") if d.strip()]
    parts = tuple(p.strip() for d in details if d not in ("no-tilt", "no-twist") for p in d.split("+"))
    tilt, twist = "no-tilt" not in details, "no-twist" not in details
    if word in ("uniform", "traction") and tilt and twist and bool(parts) == (word == "traction"):
        return Traction(parts)
    if word == "plate" and not parts:
        return Plate(tilt, twist)
    if word == "grip":
        return Plate(tilt, twist, parts or ("conductor",))
    raise SpecError(
        f'the loaded end "{text}" is not known; choose uniform, traction:PART+PART, plate, plate:no-tilt,no-twist or grip:PART,no-twist.'
    )


def _identity(n: int, free: NDArray[np.bool_]) -> sp.csr_array:
    columns = np.flatnonzero(free)
    return sp.csr_array((np.ones(len(columns)), (columns, np.arange(len(columns)))), shape=(n, len(columns)))


def _listed(parts: Sequence[str]) -> str:
    return " and ".join(parts)
