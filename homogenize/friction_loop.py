r"""Loops of tension, torsion and bending of a section whose parts rub.

A load path is followed step by step (:mod:`homogenize.coulomb_interface`); each step leaves

.. math::  F = C e + A^H s, \qquad \Delta D = \sum_i c_i\, |\Delta s_i|, \qquad \oint F\, de = \oint \Delta D

(per length, mean over the pitch; the last for a closed loop). The first slope is that of the bonded section, the last that of the section
without friction. With constant grip an unloading branch is the first loading twice as large (Masing): friction has to be turned
round from -c to c. This is exact where the tractions keep their lines, and a rule of thumb (1e-3 in bending) where they turn.

The grip p is a given pressure, or a share of the tension at the end of the step before, p = p_0 + p_1 N.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geometry.errors import SpecError
from homogenize.coulomb_interface import SlipOperator, slip_step
from homogenize.section_field import FloatArray

Progress = Callable[[float, str], None]


@dataclass(frozen=True)
class RubbingSection:
    """A section condensed onto the slips of its rubbing interfaces (m nodes).

    Attributes
    ----------
    operator : stiffness of slips and strains
    strains, forces : names of the strains that a load path prescribes and of the forces that answer
    surface : (m,) surface of each node per length of cable [m]
    friction : (m,) friction coefficient
    position : (2, m) in the rotating frame at phase zero [m]
    normal : (3, m) of the interface, out of the first of its two parts
    parts : (m,) names of the two parts
    complex_strain : whether the strains are the two components of a vector that stands still while the section turns
    """

    operator: SlipOperator
    strains: tuple[str, ...]
    forces: tuple[str, ...]
    surface: FloatArray
    friction: FloatArray
    position: FloatArray
    normal: FloatArray
    parts: tuple[tuple[str, str], ...]
    complex_strain: bool

    @property
    def bonded(self) -> FloatArray:
        """Stiffness (p, p) of the strains while everything sticks."""
        return self._real(self.operator.harmonics[0].C)

    @property
    def frictionless(self) -> FloatArray:
        """Stiffness (p, p) of the strains when every slip is free."""
        return self._real(self.operator.harmonics[0].frictionless)

    def amplitude(self, strain: FloatArray) -> NDArray:
        """Strains as the amplitude of the first harmonic: for a curvature (kappa_x - i kappa_y) / sqrt 2."""
        return np.array([strain[0] - 1j * strain[1]]) / np.sqrt(2) if self.complex_strain else strain

    def force(self, amplitude: NDArray) -> FloatArray:
        """Section forces from the amplitude of the first harmonic."""
        if not self.complex_strain:
            return np.real(amplitude)
        M = np.sqrt(2) * amplitude[0]
        return np.array([M.real, -M.imag])

    def _real(self, C: NDArray) -> FloatArray:
        return np.eye(2) * C[0, 0].real if self.complex_strain else np.real(C)


@dataclass(frozen=True)
class FrictionLoop:
    """A load path and the answer (n steps, p strains, j stations along half a pitch or one, m nodes).

    Attributes
    ----------
    strain, force : (n, p), in the order and with the names of the section
    slip : (n, j, m, 2) along the two tangents of the interface [m]
    traction : (n, j, m, 2) [Pa], on the first part of each interface
    sliding : (n, j, m) whether the node slid in the step
    dissipation : (n,) heat per length since the start [J/m]
    cap : (n, m) largest tangential traction, mu p [Pa]
    iterations : (n,)
    """

    section: RubbingSection
    strain: FloatArray
    force: FloatArray
    slip: FloatArray
    traction: FloatArray
    sliding: NDArray[np.bool_]
    dissipation: FloatArray
    cap: FloatArray
    iterations: NDArray[np.int64]

    def work(self, start: int = 0, stop: int | None = None) -> float:
        """Work of the section forces per length between two steps [J/m]; over a closed loop its area."""
        F, e = self.force[start:stop], self.strain[start:stop]
        return float(np.einsum("np,np->", 0.5 * (F[1:] + F[:-1]), np.diff(e, axis=0)))

    @property
    def cone_violation(self) -> float:
        """Largest |t| / (mu p) - 1 over all steps and nodes; 0 if the cone is kept."""
        limit = np.broadcast_to(self.cap[:, None], self.sliding.shape)
        gripped = limit > 1e-9 * limit.max()
        if not gripped.any():
            return 0.0
        length = np.linalg.norm(self.traction, axis=-1)
        return max(0.0, float((length[gripped] / limit[gripped]).max()) - 1.0)

    def slope(self, step: int, strain: int = 0) -> float:
        """Change of force over change of strain in one step."""
        dF, de = self.force[step] - self.force[step - 1], self.strain[step] - self.strain[step - 1]
        return float(dF[strain] / de[strain])


def friction_loop(
    section: RubbingSection,
    strain: FloatArray,
    grip: float | FloatArray = 0.0,
    grip_per_tension: FloatArray | None = None,
    progress: Progress | None = None,
) -> FrictionLoop:
    """Follow a load path from the stress-free section.

    Parameters
    ----------
    section : RubbingSection
        From :func:`axial_friction` or :func:`bending_friction`.
    strain : (n, p) array
        The path; it starts at zero strain, which is put before the first row if it is not there.
    grip : float or (m,) array
        Pressure on the interfaces [Pa].
    grip_per_tension : (m,) array, optional
        Pressure per tension [Pa/N] that is added for the tension of the step before (axial loops only); see
        :func:`homogenize.grip_pressure.grip_per_tension`.

    Raises
    ------
    SpecError
        If the path has the wrong shape or the grip is negative.
    ConvergenceError
        If a step does not converge.
    """
    path = _path(section, strain)
    p0 = _grip(section, grip)
    if grip_per_tension is not None and section.complex_strain:
        raise SpecError("in bending the tension is constant: give its grip as grip = T * grip_per_tension.")
    op, m = section.operator, len(section.surface)
    n, j = len(path), op.stations
    force, cap = np.zeros(path.shape), np.zeros((n, m))
    slip, traction = np.zeros((n, j, 2 * m)), np.zeros((n, j, 2 * m))
    heat, iterations = np.zeros(n), np.zeros(n, dtype=np.int64)
    cap[0] = section.friction * p0
    for i in range(1, n):
        pressure = p0 if grip_per_tension is None else np.maximum(p0 + grip_per_tension * force[i - 1, 0], 0.0)
        cap[i] = section.friction * pressure
        load = op.load(section.amplitude(path[i]))
        friction = -traction[i - 1] * np.repeat(section.surface, 2)
        slip[i], iterations[i] = slip_step(
            op, load, slip[i - 1], cap[i] * section.surface, _guess(path, slip, i), friction
        )
        force[i] = section.force(op.section_force(section.amplitude(path[i]), slip[i]))
        traction[i] = (op.force(slip[i]) + load) / np.repeat(section.surface, 2)
        length = np.linalg.norm((slip[i] - slip[i - 1]).reshape(j, m, 2), axis=-1)
        heat[i] = heat[i - 1] + (length * cap[i] * section.surface).sum() / j
        if progress:
            progress(i / n, f"step {i} of {n - 1}")
    shaped = (n, j, m, 2)
    moved = np.diff(slip, axis=0, prepend=slip[:1]).reshape(shaped)
    return FrictionLoop(
        section,
        path,
        force,
        slip.reshape(shaped),
        traction.reshape(shaped),
        np.abs(moved).max(axis=-1) > 0,
        heat,
        cap,
        iterations,
    )


def _guess(path: FloatArray, slip: FloatArray, i: int) -> FloatArray:
    """The last slip increment, scaled to this step of the path; none where the path turns."""
    if i < 2:
        return np.zeros_like(slip[0])
    before, now = path[i - 1] - path[i - 2], path[i] - path[i - 1]
    same = before @ now
    return (slip[i - 1] - slip[i - 2]) * same / (before @ before) if same > 0 else np.zeros_like(slip[0])


def _path(section: RubbingSection, strain: FloatArray) -> FloatArray:
    path = np.asarray(strain, dtype=float)
    p = len(section.strains)
    if path.ndim != 2 or path.shape[1] != p or len(path) == 0 or not np.isfinite(path).all():
        raise SpecError(f"a load path needs finite rows of {', '.join(section.strains)}; found shape {path.shape}.")
    return path if not path[0].any() else np.concatenate([np.zeros((1, p)), path])


def _grip(section: RubbingSection, grip: float | FloatArray) -> FloatArray:
    pressure = np.broadcast_to(np.asarray(grip, dtype=float), section.surface.shape)
    if not (np.isfinite(pressure).all() and (pressure >= 0).all()):
        raise SpecError("the grip must be a pressure of zero or more at every node of the rubbing interfaces.")
    return pressure
