r"""Forces in contacts most of which are open or slip: Newton's method on the bodies apart from each other.

With the forces r on the jumps as unknowns and F of the bodies without contact (:mod:`homogenize.specimen.body_flexibility`)

.. math::
   j = j_f - F r, \qquad g(r) = a f(j) - r = 0, \qquad (I + A F)\,\rho = g, \quad A = a f'(j) .

An open point has no stiffness and a slipping one only across its slip: A = L R^T with few columns, and
:math:`\rho = g - L\,(I + R^T F L)^{-1} R^T F g`. With friction frozen at given pressures (Tresca) a solution is the minimum of a convex
function, whose slope along the step is found without matrices, so that an exact search along each step makes Newton's method converge
from anywhere. The pressures then go into the friction and so on (Haslinger); when they hardly change, Newton's method
on Coulomb's law itself ends the work.

Haslinger, Math. Methods Appl. Sci. 5 (1983) 422-437, doi 10.1002/mma.1670050127.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp
from numpy.typing import NDArray

from homogenize.specimen.contact_condensation import ContactSpecimen
from homogenize.specimen.frictional_contact import ContactConstants, ContactState, contact_law

FloatArray = NDArray[np.float64]

MOST_STEPS = 80
"""Newton steps with friction frozen."""
MOST_PRESSURES = 40
MOST_COULOMB = 12
_SOFT = (1e-3, 1e-2, 1e-1)
"""Of the tangential stiffness, one after another before the whole: if hard, a Newton step moves a front of slip by one ring of points."""
_ROUGHLY = 1e4
"""Error that a softened contact is allowed, over that of the contact itself."""
_NEAR = 3e-2
"""Change of the pressures, over the largest, below which Coulomb's law itself is tried."""
_SLACK = 0.2
"""Slope at the end of a search along a step, over that at its start."""
_SHARES = (1.0, 0.5, 0.25, 0.1)


def contact_forces(
    specimen: ContactSpecimen, base: FloatArray, start: FloatArray, before: ContactState, tolerance: float, size: float
) -> tuple[ContactState | None, float]:
    """The state at one load, None if it is not found, and the error of the jumps.

    Parameters
    ----------
    specimen : ContactSpecimen
    base : (3 p,) jumps of the holding specimen under the load [m]
    start : (3 p,) jumps to start from [m]
    before : state at the end of the step before
    tolerance, size : largest error of a jump over `size` [m]
    """
    problem = _Problem(specimen, base, before, tolerance * size)
    forces, pressed = problem.law(start, None)[1], before.pressure
    if pressed.any():
        for share in _SOFT:
            softened = replace(specimen.constants, tangential=share * specimen.constants.tangential)
            rough = _Problem(specimen, base, before, _ROUGHLY * tolerance * size, softened)
            forces, _ = rough.frozen(forces, pressed)
    for _ in range(MOST_PRESSURES):
        forces, settled = problem.frozen(forces, pressed)
        if not settled:
            break
        state, error = problem.state(forces)
        if error <= problem.allowed:
            return state, error / size
        change = np.abs(state.pressure - pressed).max() / max(float(state.pressure.max()), 1e-300)
        pressed = state.pressure
        if change < _NEAR:
            found = problem.coulomb(forces)
            state, error = problem.state(found)
            if error <= problem.allowed:
                return state, error / size
    return None, problem.state(forces)[1] / size


class _Problem:
    """One load step."""

    def __init__(
        self,
        specimen: ContactSpecimen,
        base: FloatArray,
        before: ContactState,
        allowed: float,
        constants: ContactConstants | None = None,
    ) -> None:
        self.F, self.C = specimen.flexibility, specimen.compliance
        self.constants = constants or specimen.constants
        self.before, self.allowed = before, allowed
        self.area = specimen.area
        self.free = base + self.F @ (specimen.springs() * base)

    def law(self, jump: FloatArray, pressed: FloatArray | None) -> tuple[ContactState, FloatArray, FloatArray]:
        """State, a f and A of the jumps."""
        state, force, tangent = contact_law(jump.reshape(-1, 3), self.before, self.constants, pressed)
        return state, (self.area[:, None] * force).ravel(), self.area[:, None, None] * tangent

    def state(self, forces: FloatArray) -> tuple[ContactState, float]:
        """State at the jumps that the forces make, with Coulomb's law, and the error of the jumps of the holding form [m]."""
        state, wanted, _ = self.law(self.free - self.F @ forces, None)
        return state, float(np.abs(self.C @ (wanted - forces)).max())

    def frozen(self, forces: FloatArray, pressed: FloatArray) -> tuple[FloatArray, bool]:
        """Forces with the friction of given pressures, and whether they are found."""
        jump = self.free - self.F @ forces
        for _ in range(MOST_STEPS):
            _, wanted, tangent = self.law(jump, pressed)
            g = wanted - forces
            if np.abs(self.C @ g).max() <= self.allowed:
                return forces, True
            step = self._step(g, tangent, True)
            move = -(self.F @ step)
            share = self._search(forces, jump, step, move, pressed)
            forces, jump = forces + share * step, jump + share * move
        return forces, False

    def _search(
        self, forces: FloatArray, jump: FloatArray, step: FloatArray, move: FloatArray, pressed: FloatArray
    ) -> float:
        """Share of the step at which the slope of the convex function is nearly zero."""

        def slope(t: float) -> float:
            return float(move @ (self.law(jump + t * move, pressed)[1] - forces - t * step))

        return _zero(slope)

    def coulomb(self, forces: FloatArray) -> FloatArray:
        """A few Newton steps on Coulomb's law, as far as they help."""
        jump = self.free - self.F @ forces
        _, wanted, tangent = self.law(jump, None)
        error = float(np.linalg.norm(self.C @ (wanted - forces)))
        for _ in range(MOST_COULOMB):
            step = self._step(wanted - forces, tangent, False)
            move = -(self.F @ step)
            for share in _SHARES:
                _, wanted, tangent = self.law(jump + share * move, None)
                off = self.C @ (wanted - forces - share * step)
                if np.linalg.norm(off) < (1 - 0.3 * share) * error:
                    break
            else:
                return forces
            forces, jump, error = forces + share * step, jump + share * move, float(np.linalg.norm(off))
            if np.abs(off).max() <= self.allowed:
                return forces
        return forces

    def _step(self, g: FloatArray, tangent: FloatArray, symmetric: bool) -> FloatArray:
        """(I + A F)^-1 g."""
        left, right = _factors(tangent)
        if left.nnz == 0:
            return g.copy()
        small = (left.T @ self.F).T
        small = right.T @ small
        small[np.diag_indices_from(small)] += 1.0
        pull = right.T @ (self.F @ g)
        if symmetric:
            y = la.cho_solve(la.cho_factor(small, lower=True, overwrite_a=True, check_finite=False), pull)
        else:
            y = la.solve(small, pull, overwrite_a=True, check_finite=False)
        return g - left @ y


def _zero(slope: Callable[[float], float]) -> float:
    """Where a rising function, negative at 0, is nearly zero; 1 at most (regula falsi, Illinois)."""
    low, high = 0.0, 1.0
    first = at_low = slope(low)
    at_high = slope(high)
    if at_high <= -_SLACK * first:
        return high
    t = high
    for _ in range(40):
        t = (low * at_high - high * at_low) / (at_high - at_low)
        here = slope(t)
        if abs(here) <= -_SLACK * first:
            return t
        if here < 0:
            low, at_low, at_high = t, here, 0.5 * at_high
        else:
            high, at_high, at_low = t, here, 0.5 * at_low
    return t


def _factors(tangent: FloatArray) -> tuple[sp.csc_array, sp.csc_array]:
    """L and R (3 p, m) of A = L R^T, columns without stiffness left out; tangent (p, 3, 3)."""
    p = len(tangent)
    values, vectors = np.linalg.eigh(tangent[:, 1:, 1:])
    scale = max(float(np.abs(tangent).max()), 1e-300)
    touch = np.flatnonzero(tangent[:, 0, 0] > 0)
    held, which = np.nonzero(values > 1e-12 * scale)
    root = np.sqrt(tangent[touch, 0, 0])
    rub = np.sqrt(values[held, which])[:, None] * vectors[held, :, which]
    count = len(touch)
    rows = np.concatenate([(3 * touch[:, None] + np.arange(3)).ravel(), (3 * held[:, None] + [1, 2]).ravel()])
    columns = np.concatenate([np.repeat(np.arange(count), 3), count + np.repeat(np.arange(len(held)), 2)])
    shape = (3 * p, count + len(held))
    press = root[:, None] * np.array([1.0, 0.0, 0.0])
    left = np.concatenate([(tangent[touch, :, 0] / root[:, None]).ravel(), rub.ravel()])
    right = np.concatenate([press.ravel(), rub.ravel()])
    return sp.csc_array((left, (rows, columns)), shape=shape), sp.csc_array((right, (rows, columns)), shape=shape)
