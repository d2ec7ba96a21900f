r"""The grip of an interface under tension: the normal pressure that the tension itself makes.

In the z-independent problem under N = 1 with all rubbing interfaces stuck, the nodal force that the second side of an interface puts on the
first is f = E1^T Z y + E2 u of the elements of that first side. With the normal N out of it and the surface w per length,

.. math::   p = - N \cdot f / w ,

positive where the parts are pressed together. Laid parts are pressed inwards by their tension; where p is negative the interface would
open and does not rub.
"""

from __future__ import annotations

import numpy as np

from geometry.cell_mesh import CrossSectionMesh
from homogenize.coulomb_interface import Coulomb
from homogenize.interface_choice import Interfaces
from homogenize.section_field import FloatArray
from homogenize.section_problem import SectionSolver
from homogenize.section_system import section_system


def grip_per_tension(mesh: CrossSectionMesh, interfaces: Interfaces, free_twist: bool = False) -> FloatArray:
    """Pressure on each rubbing node per tension [Pa/N], shape (m,), in the order of the rubbing section.

    The twist is blocked, or free (no torque). Negative where the parts are pulled apart.

    Raises
    ------
    SpecError, MeshError, ConvergenceError
        As in :func:`homogenize.rubbing_section.axial_friction`.
    """
    system = section_system(mesh, interfaces, history=True)
    sliding = system.sliding
    assert sliding is not None
    links = sliding.links_of(Coulomb)
    pinned = (*system.gauge, *system.slip_pins, *sliding.slips_of(links).tolist())
    solver = SectionSolver(system.pencil, 0.0, tuple(dict.fromkeys(pinned)))
    Q = np.eye(6)[:, [2, 5]]
    compliance = Q.T @ np.linalg.inv(solver.schur) @ Q
    torque = 0.0 if free_twist else -compliance[1, 0] / compliance[1, 1]
    y = np.linalg.solve(solver.schur, Q @ np.array([1.0, torque]))
    u = sliding.T @ (-solver.X_R @ y)
    _, E1, E2 = sliding.field.matrices()
    force = (E2 @ u + E1.T @ (sliding.field.rigid_motion() @ y)).reshape(-1, 3)
    doubled = sliding.doubled
    normal = doubled.frame[0][:, links]
    return -(normal.T * force[doubled.child[links]]).sum(axis=1) / doubled.surface[links]
