r"""Local stresses and strains in every part of a section, from the section forces of a beam.

The fields of the helical cell are known per unit section force, so that no further solve is needed:
:math:`\varepsilon = [B_s X + B_z V]\,\theta` with theta = (T_x, T_y, N, M_x, M_y, M_z) in the axes of the section. In axes that do not
turn,
the section stands at the angle :math:`\varphi = \tau_0 z` and sees

.. math::
   \theta(\varphi) = \theta_0 + \theta_1 \cos\varphi + \theta_2 \sin\varphi, \quad
   \theta_0 = (0, 0, N, 0, 0, M_z),\; \theta_1 = (T_x, T_y, 0, M_x, M_y, 0),\; \theta_2 = (T_y, -T_x, 0, M_y, -M_x, 0),

so that the peak of any stress component over the pitch, for a fixed bending plane, is its mean plus its amplitude, exactly. Von Mises'
stress
is no component: its peak is sought at equally spaced angles.

The axial direction of a laid member is the tangent of its centre line at the point of the centre line nearest to the place; parts about
the axis take z. Stresses are fitted linearly in each element and taken at its nodes, so that peaks on a surface are on the surface.
A conductor is a homogeneous cylinder here: its stress is the mean over metal and voids, without the bending of its wires.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from geometry.cell_mesh import CrossSectionMesh
from geometry.errors import SpecError
from homogenize.helical_cell import HelicalCell
from homogenize.section_field import SectionField
from homogenize.section_stiffness import SectionStiffness

FloatArray = NDArray[np.float64]

_REFERENCE_NODES = {
    6: np.array([[0, 0], [1, 0], [0, 1], [0.5, 0], [0.5, 0.5], [0, 0.5]]),
    9: np.array([[0, 0], [1, 0], [1, 1], [0, 1], [0.5, 0], [1, 0.5], [0.5, 1], [0, 0.5], [0.5, 0.5]]),
}


@dataclass(frozen=True)
class RegionStress:
    """Stresses of one part over the whole pitch; Pa, angles in rad.

    Attributes
    ----------
    name, kind : of the part
    axial_mean : mean over the part of the stress along its helix, which the angle changes for laid parts only; mean over the pitch
    axial_max, axial_min : largest and smallest stress along its helix, anywhere in the part and at any angle
    strain_max, strain_min : the same of the strain along its helix
    von_mises : largest von Mises stress
    place : (x, y) [m] of the largest von Mises stress, in the section as drawn
    angle : by which the section is turned there
    """

    name: str
    kind: str
    axial_mean: float
    axial_max: float
    axial_min: float
    strain_max: float
    strain_min: float
    von_mises: float
    place: tuple[float, float]
    angle: float


@dataclass(frozen=True)
class StressRecovery:
    """Recovered fields.

    Attributes
    ----------
    forces : (6,) section forces in axes that do not turn
    regions : one row for each part of the mesh
    worst_angle : angle of the section [rad] at which the stiffest parts carry the largest von Mises stress
    nodes : (2, k, e) places of the nodes of each element [m], section as drawn
    region_of : (e,) index of the part
    parts : stress at the nodes, shape (3, e, k, 6): its constant, cosine and sine part over the angle [Pa]
    along : axial stress at the nodes, shape (3, e, k) [Pa]
    """

    forces: FloatArray
    regions: tuple[RegionStress, ...]
    worst_angle: float
    nodes: FloatArray
    region_of: NDArray[np.int64]
    parts: FloatArray
    along: FloatArray

    def stress(self, angle: float) -> FloatArray:
        """Stress [Pa] at the nodes of each element, shape (e, k, 6), order xx yy zz yz xz xy in the axes of the section."""
        return _at_angle(self.parts, angle)

    def axial(self, angle: float) -> FloatArray:
        """Stress [Pa] along the members, shape (e, k), with the section turned by `angle` [rad]."""
        return _at_angle(self.along, angle)


def section_forces(
    section: SectionStiffness,
    *,
    tension: float = 0.0,
    curvature: tuple[float, float] = (0.0, 0.0),
    torque: float = 0.0,
    twist: float | None = None,
) -> FloatArray:
    """Section forces (6,) of a piece under tension and a given bend: moments and, with a given twist, the torque from the 6x6.

    Parameters
    ----------
    section : SectionStiffness
        Averaged over the pitch, see :func:`homogenize.pitch_average`.
    tension : N [N]
    curvature : (kappa_x, kappa_y) [1/m]; 1 / bend radius
    torque : M_z [N m], used if no twist is given
    twist : twist per length [rad/m]; 0 for ends that cannot turn

    Examples
    --------
    >>> bar = SectionStiffness.uncoupled(EA=1e6, GA_x=1e5, GA_y=1e5, EI_x=70.0, EI_y=70.0, GJ=90.0, area=2e-3)
    >>> section_forces(bar, tension=1300.0, curvature=(2.0, 0.0)).round(9).tolist()
    [0.0, 0.0, 1300.0, 140.0, 0.0, 0.0]
    """
    F = section.compliance
    unknown = [3, 4] if twist is None else [3, 4, 5]
    forces = np.array([0.0, 0.0, tension, 0.0, 0.0, torque if twist is None else 0.0])
    wanted = np.array([*curvature, 0.0 if twist is None else twist])[: len(unknown)]
    if not (np.isfinite(forces).all() and np.isfinite(wanted).all()):
        raise SpecError(f"tension, curvature, torque and twist must be finite numbers, found {forces} and {wanted}.")
    forces[unknown] = np.linalg.solve(F[np.ix_(unknown, unknown)], wanted - F[unknown] @ forces)
    return forces


def turned_forces(forces: ArrayLike, angle: float) -> FloatArray:
    """Components (6,) in the axes of a section that is turned by `angle` [rad] = twist rate times z."""
    return _at_angle(_force_parts(np.asarray(forces, dtype=float)), angle)


def recover(cell: HelicalCell, mesh: CrossSectionMesh, forces: ArrayLike, *, angles: int = 72) -> StressRecovery:
    """Stresses and strains in every part under section forces given in axes that do not turn.

    Parameters
    ----------
    cell : HelicalCell
        Solved section; `mesh` is the mesh it was solved on.
    forces : (6,) T_x, T_y, N [N], M_x, M_y, M_z [N m], see :func:`section_forces` for a given curvature
    angles : int
        Angles of the section at which the von Mises stress is evaluated.

    Raises
    ------
    SpecError
        If the forces are not six finite numbers.
    """
    forces = np.asarray(forces, dtype=float)
    if forces.shape != (6,) or not np.isfinite(forces).all():
        raise SpecError(f"section forces are six finite numbers T_x, T_y, N, M_x, M_y, M_z; found {forces.tolist()}.")
    field = cell.field
    to_nodes = _extrapolation(field)
    strain = np.stack([to_nodes @ cell.strain(part) for part in _force_parts(forces)])
    stress = np.matmul(field.elasticity[:, None], strain[..., None])[..., 0]
    nodes = field.nodes[:, field.cells]
    along = _tension_along(_fibre_directions(field, len(mesh.regions)), stress)
    stretch = _tension_along(_fibre_directions(field, len(mesh.regions)), strain * [1, 1, 1, 0.5, 0.5, 0.5])
    turns = 2 * np.pi * np.arange(angles) / angles
    mises = np.stack([von_mises(_at_angle(stress, float(turn))) for turn in turns])
    rows = []
    for i, region in enumerate(mesh.regions):
        inside = field.region_of == i
        if not inside.any():
            continue
        share = field.weight[inside] / field.weight[inside].sum()
        mean = float((share * (_inner(field, along[0])[inside])).sum())
        low, high = _range_over_pitch(along[:, inside])
        short, long = _range_over_pitch(stretch[:, inside])
        here = mises[:, inside]
        turn, e, k = np.unravel_index(int(here.argmax()), here.shape)
        x, y = nodes[:, k, np.flatnonzero(inside)[e]]
        peak = float(here.max())
        rows.append(
            RegionStress(
                region.name, region.kind, mean, high, low, long, short, peak, (float(x), float(y)), float(turns[turn])
            )
        )
    stiff = max(rows, key=lambda row: row.von_mises)
    return StressRecovery(forces, tuple(rows), stiff.angle, nodes, field.region_of, stress, along)


def von_mises(stress: FloatArray) -> FloatArray:
    """Von Mises stress of stresses (..., 6), order xx yy zz yz xz xy.

    Examples
    --------
    >>> float(von_mises(np.array([0.0, 0, 5, 0, 0, 0])))
    5.0
    """
    xx, yy, zz, yz, xz, xy = np.moveaxis(stress, -1, 0)
    differences = (xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2
    return np.sqrt(0.5 * differences + 3 * (yz**2 + xz**2 + xy**2))


def _force_parts(forces: FloatArray) -> FloatArray:
    """theta_0, theta_1, theta_2 of the module docstring, shape (3, 6)."""
    Tx, Ty, N, Mx, My, Mz = forces
    return np.array([[0, 0, N, 0, 0, Mz], [Tx, Ty, 0, Mx, My, 0], [Ty, -Tx, 0, My, -Mx, 0]])


def _at_angle(parts: FloatArray, angle: float) -> FloatArray:
    return parts[0] + np.cos(angle) * parts[1] + np.sin(angle) * parts[2]


def _range_over_pitch(parts: FloatArray) -> tuple[float, float]:
    """Smallest and largest value over all angles and places of parts (3, ...)."""
    swing = np.hypot(parts[1], parts[2])
    return float((parts[0] - swing).min()), float((parts[0] + swing).max())


def _extrapolation(field: SectionField) -> FloatArray:
    """Matrix (k, q) from the quadrature points to the nodes of an element, exact for linear fields."""
    place = _REFERENCE_NODES[len(field.cells)]
    points = field.shape.T @ place
    monomials = [np.column_stack([np.ones(len(p)), p]) for p in (place, points)]
    return monomials[0] @ np.linalg.pinv(monomials[1])


def _inner(field: SectionField, nodal: FloatArray) -> FloatArray:
    """Values (e, q) at the quadrature points of values (e, k) at the nodes."""
    return nodal @ field.shape


def _fibre_directions(field: SectionField, regions: int) -> FloatArray:
    """Unit tangents (e, k, 3) of the members at the nodes, in the axes of the section."""
    tau = field.twist_rate
    area = np.bincount(field.region_of, field.weight.sum(axis=1), regions)
    first = [np.bincount(field.region_of, (field.weight * c).sum(axis=1), regions) for c in field.position]
    centre = np.stack(first) / np.where(area > 0, area, 1.0)
    r, phase = np.hypot(*centre)[field.region_of][:, None], np.arctan2(centre[1], centre[0])[field.region_of][:, None]
    x, y = np.moveaxis(field.nodes[:, field.cells], -1, 1)
    z = np.zeros_like(x)
    for _ in range(6):  # Newton on (P - c(z)) . c'(z) = 0
        turn = phase + tau * z
        gap = tau * r * (y * np.cos(turn) - x * np.sin(turn)) - z
        slope = -(tau**2) * r * (x * np.cos(turn) + y * np.sin(turn)) - 1
        z = z - gap / slope
    turn = phase + tau * z
    tangent = np.stack([-tau * r * np.sin(turn), tau * r * np.cos(turn), np.ones_like(turn)], axis=-1)
    return tangent / np.linalg.norm(tangent, axis=-1, keepdims=True)


def _tension_along(t: FloatArray, tensor: FloatArray) -> FloatArray:
    """t . tensor . t with the tensor (..., 6) as xx yy zz yz xz xy (no engineering factor)."""
    a, b, c = np.moveaxis(t, -1, 0)
    weights = np.stack([a * a, b * b, c * c, 2 * b * c, 2 * a * c, 2 * a * b], axis=-1)
    return (weights * tensor).sum(axis=-1)
