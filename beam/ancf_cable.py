r"""The ANCF cable: position and slope at every node, no shear, no torsion; the fast choice where neither matters.

It takes the place of :class:`beam.rod.Rod` in a :class:`beam.rod_model.RodModel`, with six unknowns a node instead of twelve;
statics, dynamics, contact and friction are the same. What an element stores and how it is integrated is told in
:mod:`beam.ancf_cable_element`. The section is reduced to EA with the twist blocked and one EI.

A cable has no section axes. Where results need some, they are carried along the centre line without turning about it, from the
supply on. The shear force follows from the moments, :math:`Q = t \times m'/|r'|`, with the slope of m between Gauss
points, so that it is one order less accurate than N and m.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from beam.ancf_cable_element import CABLE_DOF, cable_force
from beam.compiled import kernel
from beam.element import UNIT_MASS, unit_shapes
from beam.rod import FIELDS, GAUSS_X, Rod
from beam.section_force import to_nodes
from beam.section_law import DampingTimes
from geometry.errors import SpecError
from homogenize.section_stiffness import SectionInertia, SectionStiffness

Array = NDArray[np.float64]

UNEQUAL = 0.02
"""Largest relative difference of the two bending stiffnesses, and of what couples to bending, that one EI stands for."""


@dataclass(frozen=True)
class AncfCable(Rod):
    """Elements of a straight, shear-stiff cable without torsion; build it as a :class:`beam.rod.Rod`."""

    name: ClassVar[str] = "ancf-cable"
    dof: ClassVar[int] = CABLE_DOF

    @classmethod
    def build(
        cls,
        lengths: Array,
        section: SectionStiffness,
        inertia: SectionInertia,
        damping: DampingTimes | None = None,
        stress_free: Array | None = None,
    ) -> AncfCable:
        """Cable of elements `lengths` [m].

        Raises
        ------
        SpecError
            If a length is not positive, or if the cable needs what this element does not have: initial curvature, two
            bending stiffnesses, coupling of bending with stretch.
        """
        if stress_free is not None:
            raise SpecError("an ANCF cable is straight when it is unloaded; initial curvature needs the rod.")
        plain = Rod.build(lengths, section, inertia, damping)
        C = plain.C
        EI = 0.5 * (C[4, 4] + C[5, 5])
        if abs(C[4, 4] - C[5, 5]) > UNEQUAL * EI or abs(C[4, 5]) > UNEQUAL * EI:
            raise SpecError(
                f"an ANCF cable has one bending stiffness, the section has {C[4, 4]:.4g} and {C[5, 5]:.4g} N m2, coupled by "
                f"{C[4, 5]:.3g}: take the pitch average of the section, or the rod."
            )
        if max(abs(C[0, 4]), abs(C[0, 5])) > UNEQUAL * np.sqrt(C[0, 0] * EI):
            raise SpecError("an ANCF cable cannot couple stretch with bending, as this section does: take the rod.")
        return cls(plain.lengths, C, plain.C_damping, plain.E0, plain.mass_per_length, plain.J)

    def slots(self, field: str, here: Array) -> slice | list[int]:
        """Unknowns of the field `field` at a node with the values `here`; "theta" is the direction of the slope.

        Raises
        ------
        SpecError
            If there are none, or if the direction to hold is not along a global axis.
        """
        if field == "theta":
            along = int(np.argmax(np.abs(here[3:6])))
            across = [k for k in (3, 4, 5) if k != 3 + along]
            if np.abs(here[across]).max() > 1e-9:
                raise SpecError(
                    "a clamped ANCF cable must point along x, y or z there, so that its direction is held and its stretch is free: "
                    "turn the model, or take the rod."
                )
            return across
        slot = FIELDS[field]
        if slot.stop > CABLE_DOF:
            raise SpecError(f"an ANCF cable has no {field} to hold: take the rod.")
        return slot

    def columns(self, values: Array) -> Array:
        """The cable's part of nodal values (n + 1, 12) of the rod; values (n + 1, 6) as they are."""
        return np.array(values[:, :CABLE_DOF], dtype=float, order="C")

    def load_columns(self, load: Array) -> Array:
        """The same for nodal forces; a moment, which has nothing to act on, is refused."""
        if load.shape[1] > CABLE_DOF and np.any(load[:, CABLE_DOF:]):
            raise SpecError(
                "a moment cannot act on an ANCF cable, which has no rotations: apply a force on the slope, or take the rod."
            )
        return self.columns(load)

    def sections(self, q: Array, S: Array) -> tuple[Array, Array, Array]:
        """Rotation vectors (n + 1, 3), local and global section forces (n + 1, 6), see :mod:`beam.section_force`."""
        R = axes(q[:, 3:6])
        turned = to_nodes(self._global_forces(q, S))
        local = np.concatenate([np.einsum("nij,ni->nj", R, turned[:, k : k + 3]) for k in (0, 3)], axis=1)
        theta = np.ascontiguousarray(Rotation.from_matrix(R).as_rotvec())
        on_one_branch(theta)
        return theta, local, turned

    def strains(self, q: Array) -> Array:
        """Stretch and curvatures at the Gauss points, section axes, (n, 3, 6); those of shear and torsion are zero."""
        E, unit, spare = np.empty_like(self.E0), np.eye(6), np.zeros_like(q)
        cable_force(q, q, q, False, False, self.lengths, unit, unit, 0.0, UNIT_MASS, spare, E)
        R = self._gauss_axes(q)
        E[..., 3:6] = np.einsum("egij,egi->egj", R, E[..., 3:6])
        return E

    def moment(self, q: Array, f: Array) -> Array:
        """Moment (3,) [N m] of the generalised forces `f` (6,) on a node with the values `q` (6,): r' x f of the slope."""
        return np.cross(q[3:6], f[3:6])

    def in_section_axes(self, q: Array, S: Array) -> Array:
        """Section forces `S` (n, 3, 6) of the kernels in section axes, with the shear force."""
        R, turned = self._gauss_axes(q), self._global_forces(q, S)
        return np.concatenate([np.einsum("egij,egi->egj", R, turned[..., k : k + 3]) for k in (0, 3)], axis=2)

    def _gauss_axes(self, q: Array) -> Array:
        return axes(self._gauss_slopes(q).reshape(-1, 3)).reshape(self.lengths.size, GAUSS_X.size, 3, 3)

    def _gauss_slopes(self, q: Array) -> Array:
        H = unit_shapes(GAUSS_X)
        chord = (q[1:, 0:3] - q[:-1, 0:3]) / self.lengths[:, None]
        parts = (H[:, 6], chord), (H[:, 5], q[:-1, 3:6]), (H[:, 7], q[1:, 3:6])
        return sum((h[None, :, None] * x[:, None, :] for h, x in parts), start=np.zeros((1, 1, 1)))

    def _global_forces(self, q: Array, S: Array) -> Array:
        span = (GAUSS_X[2] - GAUSS_X[0]) * self.lengths
        slope = ((S[:, 2, 3:] - S[:, 0, 3:]) / span[:, None])[:, None, :]
        d = self._gauss_slopes(q)
        size = np.linalg.norm(d, axis=2)[..., None]
        return np.concatenate([S[..., 0:1] * d / size + np.cross(d, slope) / size**2, S[..., 3:6]], axis=2)


def axes(slopes: Array) -> Array:
    """Rotation matrices (n, 3, 3) of section axes carried along the slopes (n, 3), the first axis along them."""
    t = slopes / np.linalg.norm(slopes, axis=1)[:, None]
    across = np.zeros_like(t)
    carry_along(np.ascontiguousarray(t), across)
    return np.stack([t, across, np.cross(t, across)], axis=2)


@kernel
def carry_along(t: Array, across: Array) -> None:
    """Write unit vectors `across` (n, 3) normal to the tangents `t` (n, 3) that turn with them but not about them.

    The first one is level, normal to t and to z (the y axis where t is along x).
    """
    x, y = t[0, 0], t[0, 1]
    flat = np.sqrt(x * x + y * y)
    across[0, 0], across[0, 1], across[0, 2] = (-y / flat, x / flat, 0.0) if flat > 1e-12 else (0.0, 1.0, 0.0)
    for i in range(1, t.shape[0]):
        forward, together = 0.0, 1.0
        for k in range(3):
            forward += t[i, k] * across[i - 1, k]
            together += t[i, k] * t[i - 1, k]
        size = 0.0
        for k in range(3):
            across[i, k] = across[i - 1, k] - forward / max(together, 1e-12) * (t[i, k] + t[i - 1, k])
            size += across[i, k] * across[i, k]
        size = np.sqrt(size)
        for k in range(3):
            across[i, k] /= size


@kernel
def on_one_branch(theta: Array) -> None:
    """Take rotation vectors along a line (n, 3) to the branch that is nearer to the one before; half a turn starts upwards."""
    b0, b1, b2 = 0.0, 0.0, 1e-3
    for i in range(theta.shape[0]):
        t0, t1, t2 = theta[i, 0], theta[i, 1], theta[i, 2]
        size = np.sqrt(t0 * t0 + t1 * t1 + t2 * t2)
        if size > 1e-6:
            s = 1.0 - 2.0 * np.pi / size
            near = (t0 - b0) ** 2 + (t1 - b1) ** 2 + (t2 - b2) ** 2
            if (s * t0 - b0) ** 2 + (s * t1 - b1) ** 2 + (s * t2 - b2) ** 2 < near:
                theta[i, 0], theta[i, 1], theta[i, 2] = s * t0, s * t1, s * t2
        b0, b1, b2 = theta[i, 0], theta[i, 1], theta[i, 2]
