r"""Loads on the end z = L of a specimen, and their nodal forces in the frame that turns with the cable.

On a free end-section of area A (of the loaded parts; r from its centroid, I about it) the traction of

* tension F: F / A along z; shear F: F / A along x or y;
* bending M about x or y: sigma_zz = M (y or -x) / I; torsion M about z: tau = M e_z x r / I_p.

On a rigid plate the same nodal forces act, and only their resultant counts. Fixed axes x, y are those of the laboratory; the section
stands turned by `phase` at z = 0 and by phase + tau_0 L at z = L.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geometry.errors import SpecError
from homogenize.section_field import FloatArray, SectionField

KINDS = ("tension", "shear", "bending", "torsion")


@dataclass(frozen=True)
class LoadCase:
    """One load: `kind`, `size` [N] or [N m] with its sign, and `axis` "x" or "y" (the force's, or the axis of the bending moment).

    Raises
    ------
    SpecError
        If the kind or the axis is not known, or the size is zero or not finite.

    Examples
    --------
    >>> LoadCase("shear", -500.0, "y").name
    'shear -y'
    """

    kind: str
    size: float
    axis: str = "x"

    def __post_init__(self) -> None:
        if self.kind not in KINDS:
            raise SpecError(f'the load "{self.kind}" is not known; choose {", ".join(KINDS)}.')
        if self.axis not in ("x", "y"):
            raise SpecError(f'the axis of a load must be x or y, found "{self.axis}".')
        if not (np.isfinite(self.size) and self.size != 0):
            raise SpecError(f"a load of {self.size:g} moves nothing; give a force in N, or a moment in N m.")

    @property
    def name(self) -> str:
        """In words, with direction and sign."""
        sign = "+" if self.size > 0 else "-"
        return f"{self.kind} {sign}{self.axis}" if self.kind in ("shear", "bending") else self.kind

    @property
    def direction(self) -> FloatArray:
        """Unit vector (3,), in fixed axes, of the force or the moment with its sign."""
        along = 2 if self.kind in ("tension", "torsion") else "xy".index(self.axis)
        return np.sign(self.size) * np.eye(3)[along]

    @property
    def is_force(self) -> bool:
        """Whether the load is a force; a moment otherwise."""
        return self.kind in ("tension", "shear")


def turn(angle: float) -> FloatArray:
    """(3, 3) components in fixed axes from those in a frame turned by an angle about z."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def nodal_forces(load: LoadCase, field: SectionField, loaded: NDArray[np.bool_], angle: float) -> FloatArray:
    """Nodal forces (3 n,) [N] on the end-section in rotating components.

    Parameters
    ----------
    load : LoadCase
    field : SectionField
    loaded : (regions,) parts that carry the traction
    angle : of the end-section against fixed axes [rad]
    """
    weight = np.where(loaded[field.region_of][:, None], field.weight, 0.0)
    area = weight.sum()
    X, Y = field.position - np.einsum("xeq,eq->x", field.position, weight)[:, None, None] / area
    d = abs(load.size) * (turn(angle).T @ load.direction)
    traction = np.zeros((3, *weight.shape))
    if load.is_force:
        traction += d[:, None, None] / area
    elif load.kind == "torsion":
        polar = ((X**2 + Y**2) * weight).sum()
        traction[0], traction[1] = -d[2] * Y / polar, d[2] * X / polar
    else:
        traction[2] = _bending(d, X, Y, weight)
    local = np.einsum("xeq,eq,aq->eax", traction, weight, field.shape)
    f = np.zeros(field.unknowns)
    np.add.at(f, field.element_dofs.ravel(), local.ravel())
    return f


def _bending(moment: FloatArray, X: FloatArray, Y: FloatArray, weight: FloatArray) -> FloatArray:
    """sigma_zz = a X + b Y whose moments about X and Y are int sigma Y and -int sigma X."""
    inertia = np.array(
        [[(Y * X * weight).sum(), (Y * Y * weight).sum()], [-(X * X * weight).sum(), -(X * Y * weight).sum()]]
    )
    a, b = np.linalg.solve(inertia, moment[:2])
    return a * X + b * Y
