r"""Apparent moduli of a finite specimen, by every definition in use, so that it can be said which one a number is.

With the volume average :math:`\langle q\rangle = \frac1V\int q\,dV` (formula (3) of Ge et al., PLoS ONE 18(2) e0281136, 2023) and
the mean over the loaded end :math:`\bar u`:

* tension :math:`E_{app} = \langle\sigma_{zz}\rangle / \langle\varepsilon_{zz}\rangle = F L / (A \bar u_z)`;
* shear along x :math:`G_{app} = \langle\tau_{xz}\rangle / \langle\gamma_{xz}\rangle`, :math:`\gamma_{xz} = \partial_z u_x + \partial_x u_z`
  (plane yoz; along y plane xoz);
* :math:`(F/A) L / u_{max}` and :math:`(F/A) L / \bar u`, displacement over length;
* :math:`\langle\sigma_{vM}\rangle / \langle\sigma_{vM}/E\rangle`, the "equivalent" reading;
* bending :math:`M L / \bar\theta`, torsion :math:`T L / \bar\theta`, with the least-squares rotation of the loaded end.

In bending :math:`\bar u_x / L` and :math:`\langle\partial_x u_z\rangle` nearly cancel: G_app of a slender specimen is a small difference of
large numbers, not a shear modulus. u_max is larger than the mean where soft material of the loaded face bulges: above 1.2 times the
mean it is the end condition that is measured.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from homogenize.section_field import FloatArray, SectionField
from homogenize.specimen.load_case import turn
from homogenize.specimen.specimen_solution import SpecimenSolution
from homogenize.specimen.stress_strain_curve import StressStrainCurve, proportional_curve


@dataclass(frozen=True)
class ApparentModulus:
    """What one load case says.

    Attributes
    ----------
    load : its name
    modulus : E_app or G_app [Pa]; bending and torsion stiffness [N m^2]
    mean_stress, mean_strain : of the component that the load asks for; moment and rotation per length for moments
    u_max, u_mean : largest displacement along the load, and its mean over the loaded end [m]; nan for moments
    modulus_of_maximum, modulus_of_mean : (F/A) L / u_max and (F/A) L / u_mean [Pa]; nan for moments
    curve : load steps up to the whole load, with the fitted line
    """

    load: str
    modulus: float
    mean_stress: float
    mean_strain: float
    u_max: float
    u_mean: float
    modulus_of_maximum: float
    modulus_of_mean: float
    curve: StressStrainCurve

    @property
    def unevenness(self) -> float:
        """u_max / u_mean; above 1.2 the end condition is being measured."""
        return self.u_max / self.u_mean


def apparent_moduli(solution: SpecimenSolution, steps: int = 10) -> tuple[ApparentModulus, ...]:
    """All load cases of a linear specimen, in their order; the load grows in `steps`."""
    strain, stress = mean_strain(solution), mean_stress(solution)
    return tuple(_modulus(solution, k, strain[:, k], stress[:, k], steps) for k in range(len(solution.loads)))


def _modulus(solution: SpecimenSolution, k: int, strain: FloatArray, stress: FloatArray, steps: int) -> ApparentModulus:
    load, L = solution.loads[k], solution.specimen.length
    d = load.direction
    nan = float("nan")
    if not load.is_force:
        angle = float(d @ end_rotation(solution)[:, k]) / L
        curve = proportional_curve(angle, abs(load.size), steps)
        return ApparentModulus(load.name, abs(load.size) / angle, abs(load.size), angle, nan, nan, nan, nan, curve)
    component = [4, 3, 2][int(np.argmax(np.abs(d)))]
    e, s = float(d.sum() * strain[component]), float(d.sum() * stress[component])
    along = np.einsum("nxm,x->nm", solution.displacement[..., k], d)
    u_max = float(along.max())
    u_mean = float(d @ end_displacement(solution)[:, k])
    nominal = abs(load.size) / solution.system.field.area * L
    return ApparentModulus(
        load.name, s / e, s, e, u_max, u_mean, nominal / u_max, nominal / u_mean, proportional_curve(e, s, steps)
    )


def node_weights(field: SectionField) -> FloatArray:
    """(nodes,) integrals of the shape functions over the section [m^2]."""
    local = np.einsum("eq,kq->ke", field.weight, field.shape)
    weights: FloatArray = np.zeros(field.nodes.shape[1])
    np.add.at(weights, field.cells.ravel(), local.ravel())
    return weights


def end_displacement(solution: SpecimenSolution) -> FloatArray:
    """(3, loads) mean displacement of the loaded end in fixed axes [m]."""
    field = solution.system.field
    return np.einsum("n,nxk->xk", node_weights(field), solution.displacement[:, :, -1]) / field.area


def end_rotation(solution: SpecimenSolution) -> FloatArray:
    """(3, loads) least-squares rotation of the loaded end about fixed axes [rad]."""
    field = solution.system.field
    w, u = node_weights(field), solution.nodal[:, :, -1]
    X, Y = field.nodes - (field.nodes @ w / w.sum())[:, None]
    tilt = np.linalg.solve(
        [[(w * Y * Y).sum(), -(w * X * Y).sum()], [-(w * X * Y).sum(), (w * X * X).sum()]],
        np.array([(w * Y) @ u[:, 2], -(w * X) @ u[:, 2]]),
    )
    twist = ((w * X) @ u[:, 1] - (w * Y) @ u[:, 0]) / (w * (X * X + Y * Y)).sum()
    return turn(float(solution.angles[-1])) @ np.vstack([tilt, twist])


def mean_strain(solution: SpecimenSolution) -> FloatArray:
    """(6, loads) volume average of the strain inside the parts, fixed axes, order xx yy zz yz xz xy, engineering shears."""
    return _volume_average(solution, stress=False)


def mean_stress(solution: SpecimenSolution) -> FloatArray:
    """(6, loads) volume average of the stress [Pa], fixed axes, order xx yy zz yz xz xy."""
    return _volume_average(solution, stress=True)


def _volume_average(solution: SpecimenSolution, stress: bool) -> FloatArray:
    field, T = solution.system.field, solution.system.T
    inner, across = section_integrals(field, np.ones(len(field.weight), dtype=bool), stress)
    if T is not None:
        inner, across = (T.T @ a.T for a in (inner, across))
        inner, across = inner.T, across.T
    z, w, N, D = solution.operator.axial.quadrature
    at = np.einsum("cn,nmk->cmk", inner, solution.U, optimize=True)
    slope = np.einsum("cn,nmk->cmk", across, solution.U, optimize=True)
    local = np.einsum("gm,cmk->gck", N, at) + np.einsum("gm,cmk->gck", D, slope)
    angles = solution.specimen.phase + solution.mesh.twist_rate * z
    turned = np.array([turned_components(a, angle, stress) for a, angle in zip(local, angles)])
    return np.einsum("g,gck->ck", w, turned) / (field.area * solution.specimen.length)


def section_integrals(field: SectionField, elements: np.ndarray, stress: bool) -> tuple[FloatArray, FloatArray]:
    """Integrals of B_s and B_z, or of C B_s and C B_z, over some elements of the section: two arrays (6, 3 n)."""
    found = []
    for B in (field.strain_s, field.strain_z):
        B = np.broadcast_to(B, (*field.weight.shape, *B.shape[2:]))[elements]
        if stress:
            B = np.matmul(field.point_elasticity[elements], B)
        local = np.einsum("eq,eqci->cei", field.weight[elements], B, optimize=True)
        total = np.zeros((6, field.unknowns))
        for c in range(6):
            total[c] = np.bincount(field.element_dofs[elements].ravel(), local[c].ravel(), field.unknowns)
        found.append(total)
    return found[0], found[1]


def turned_components(a: FloatArray, angle: float, stress: bool) -> FloatArray:
    """Components (6, loads) in fixed axes of a stress, or of a strain with engineering shears, from those in axes turned by an angle."""
    half = 1.0 if stress else 0.5
    xx, yy, zz, yz, xz, xy = a[0], a[1], a[2], half * a[3], half * a[4], half * a[5]
    tensor = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    Q = turn(angle)
    t = np.einsum("ia,jb,abk->ijk", Q, Q, tensor)
    return np.array([t[0, 0], t[1, 1], t[2, 2], t[1, 2] / half, t[0, 2] / half, t[0, 1] / half])


def von_mises_moduli(solution: SpecimenSolution) -> FloatArray:
    """(loads,) mean von Mises stress over the mean of von Mises stress by the local modulus [Pa]; isotropic parts."""
    field, axial = solution.system.field, solution.operator.axial
    _, w, N, D = axial.quadrature
    modulus = 1 / np.linalg.inv(field.elasticity)[:, 2, 2]
    above = below = np.zeros(len(solution.loads))
    flat = solution.nodal.reshape(-1, *solution.nodal.shape[2:])
    for g, weight in enumerate(w):
        strain = field.strain(np.einsum("nmk,m->nk", flat, N[g]), np.einsum("nmk,m->nk", flat, D[g]))
        s = np.matmul(field.point_elasticity, strain)
        normal = (s[:, :, 0] - s[:, :, 1]) ** 2 + (s[:, :, 1] - s[:, :, 2]) ** 2 + (s[:, :, 2] - s[:, :, 0]) ** 2
        mises = np.sqrt(0.5 * normal + 3 * (s[:, :, 3:] ** 2).sum(axis=2))
        above = above + weight * np.einsum("eq,eqk->k", field.weight, mises)
        below = below + weight * np.einsum("eq,eqk,e->k", field.weight, mises, 1 / modulus)
    return above / below
