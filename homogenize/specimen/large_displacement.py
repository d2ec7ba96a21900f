r"""A piece of cable that moves far: total Lagrangian, one end held, dead forces on the other, Newton with load steps.

.. math::  f(u) = s\, F, \quad 0 < s \le 1, \qquad u \leftarrow u + K(u)^{-1} (s F - f(u)),

f and K of :mod:`homogenize.specimen.wedge18`; F keeps its direction and its nodes (a traction per area at rest). A linear step is solved by
conjugate gradients preconditioned by the factor of an earlier tangent, to which it stays close; the factor is renewed when it is far.
Linear steps are solved the better the closer the end is, so that Newton stays quadratic (Eisenstat, Walker, SIAM J. Sci. Comput. 17 (1996)
16-32, doi 10.1137/0917003). A step that does not converge is halved.
"""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as spla
from numpy.typing import NDArray

from geometry.errors import ConvergenceError, SpecError
from homogenize.section_field import FloatArray
from homogenize.specimen.wedge18 import Wedges

_log = logging.getLogger(__name__)

Progress = Callable[[float, str], None]
Preconditioner = Callable[[FloatArray], FloatArray]

TOLERANCE = 1e-8
"""Largest imbalance (norm of the nodal forces) over the load."""
ROUNDING = 1e-6
"""An imbalance below this that no longer falls is rounding: slender bodies are much stiffer along than across."""
MOST_ITERATIONS = 20
MOST_CUTS = 6
"""A load step is halved so many times at most."""
_FAR = 40
"""Conjugate gradient iterations after which the factor is renewed."""
_FAR_GIVEN = 400
"""The same for a preconditioner that was given."""


@dataclass(frozen=True)
class LoadedState:
    """Equilibrium at a share of the load.

    Attributes
    ----------
    share : s
    u : (unknowns,) displacement, rotating components [m]
    residuals : imbalance over the load before each Newton step and after the last
    """

    share: float
    u: FloatArray
    residuals: tuple[float, ...]


@dataclass(frozen=True)
class LargeDisplacement:
    """A path of equilibria, from the first share of the load to the last.

    Attributes
    ----------
    factors : number of factorisations
    preconditioner : the last approximate inverse of the tangent on the free unknowns; another load on the same body can start with it
    """

    wedges: Wedges
    force: FloatArray
    states: tuple[LoadedState, ...]
    factors: int
    preconditioner: Preconditioner | None

    @property
    def u(self) -> FloatArray:
        """Displacement at the end of the path."""
        return self.states[-1].u


def end_traction(wedges: Wedges, force: FloatArray) -> FloatArray:
    """Nodal forces of a force (3,) [N] in fixed axes spread evenly over the end face z = L at rest, (unknowns,)."""
    out = np.zeros((len(wedges.planes), wedges.section.nodes.shape[1], 3))
    spread = wedges.face_area()[:, None] * np.asarray(force, dtype=float) / wedges.section.area
    out[-1] = wedges.turned(spread, float(wedges.planes[-1]))
    return out.ravel()


def large_displacement(
    wedges: Wedges,
    force: FloatArray,
    shares: tuple[float, ...] = (1.0,),
    held: NDArray[np.bool_] | None = None,
    preconditioner: Preconditioner | None = None,
    progress: Progress | None = None,
) -> LargeDisplacement:
    """Follow the equilibrium under a growing load.

    Parameters
    ----------
    wedges : Wedges
    force : (unknowns,) nodal forces at share 1, see :func:`end_traction` [N]
    shares : growing shares of the load at which the state is wanted
    held : (unknowns,) which displacements stay zero; the plane z = 0 if not given
    preconditioner : approximate inverse of the tangent on the unknowns that are not held, for instance of an earlier path on the
        same body; the factor of the first tangent if not given

    Returns
    -------
    LargeDisplacement
        With one state for each share.

    Raises
    ------
    SpecError
        If the load is zero or the shares do not grow.
    ConvergenceError
        If a load step was halved too often; names the part that is farthest from balance and the share reached.
    """
    if held is None:
        held = np.arange(wedges.unknowns) < wedges.plane_unknowns
    if not np.any(force[~held]):
        raise SpecError("the load is zero: give a force on unknowns that are not held.")
    if not shares or shares[0] <= 0 or (np.diff(shares) <= 0).any():
        raise SpecError("the shares of the load must be positive and grow, for instance 0.5, 1.")
    newton = _Newton(wedges, np.asarray(force, dtype=float), ~held, preconditioner)
    u, reached, states = np.zeros(wedges.unknowns), 0.0, []
    for share in shares:
        residuals: tuple[float, ...] = ()
        step, cuts = share - reached, 0
        while reached < share:
            target = min(share, reached + step)
            found, residuals = newton.solve(u, target)
            if progress:
                progress(reached / shares[-1], f"load {100 * target:.0f} %: imbalance {residuals[-1]:.1e}")
            if found is None:
                cuts += 1
                if cuts > MOST_CUTS:
                    raise ConvergenceError(newton.sentence(u, reached, target, residuals))
                step *= 0.5
                continue
            u, reached = found, target
        states.append(LoadedState(share, u, residuals))
    return LargeDisplacement(wedges, newton.force, tuple(states), newton.factors, newton.inverse)


def _at_rounding(residuals: list[float]) -> bool:
    """Small, and no longer falling."""
    return len(residuals) > 2 and residuals[-2] < ROUNDING and residuals[-1] > 0.1 * residuals[-2]


class _Newton:
    """Newton's method with the factor of an earlier tangent."""

    def __init__(
        self, wedges: Wedges, force: FloatArray, free: NDArray[np.bool_], inverse: Preconditioner | None
    ) -> None:
        self.wedges, self.force, self.free = wedges, force, free
        self.scale = float(np.linalg.norm(force[free]))
        self.inverse = inverse
        self.factors = 0
        self.out = force

    def solve(self, start: FloatArray, share: float) -> tuple[FloatArray | None, tuple[float, ...]]:
        """Equilibrium at a share of the load from a state nearby, None if it is not found; and the residuals."""
        u, residuals = start.copy(), []
        for iteration in range(MOST_ITERATIONS + 1):
            with np.errstate(all="ignore"):
                f, K = self.wedges.force_and_tangent(u)
            self.out = np.where(self.free, share * self.force - f, 0.0)
            residuals.append(float(np.linalg.norm(self.out[self.free])) / (self.scale * share))
            _log.debug("share %g iteration %d imbalance %.2e", share, iteration, residuals[-1])
            if residuals[-1] <= TOLERANCE or _at_rounding(residuals):
                return (u if self.wedges.smallest_volume(u) > 0 else None), tuple(residuals)
            lost = not np.isfinite(residuals[-1]) or (iteration > 3 and residuals[-1] > 1e4 * max(residuals[0], 1))
            if lost or iteration == MOST_ITERATIONS:
                break
            step = self._linear(K, self.out[self.free], max(1e-10, min(1e-4, 0.1 * residuals[-1])))
            if step is None:
                break
            u[self.free] += step
        return None, tuple(residuals)

    def _linear(self, K: sp.csr_array, rhs: FloatArray, tolerance: float) -> FloatArray | None:
        inner = K[self.free][:, self.free]
        for fresh in (False, True):
            own = self.factors > 0
            if fresh or self.inverse is None:
                self.inverse = self._factorised(inner)
            if self.inverse is None:
                return None
            operator = spla.LinearOperator(inner.shape, self.inverse)
            step, failed = spla.cg(
                inner, rhs, rtol=tolerance, atol=0.0, maxiter=_FAR if own or fresh else _FAR_GIVEN, M=operator
            )
            if not failed and np.isfinite(step).all():
                return step
        step = self.inverse(rhs)  # the tangent is not positive: its own factor, without gradients
        return step if np.isfinite(step).all() else None

    def _factorised(self, inner: sp.csr_array) -> Preconditioner | None:
        self.factors += 1
        try:
            return spla.splu(
                sp.csc_matrix(inner), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True}
            ).solve
        except RuntimeError:
            return None

    def sentence(self, u: FloatArray, reached: float, target: float, residuals: tuple[float, ...]) -> str:
        """Why the path ends, where, and what to try."""
        w = self.wedges
        out = np.abs(np.nan_to_num(self.out)).reshape(len(w.planes), -1, 3).max(axis=-1)
        plane, node = np.unravel_index(int(np.argmax(out)), out.shape)
        element = int(np.argmax((w.section.cells == node).any(axis=0)))
        name = w.regions[w.section.region_of[element]].name
        far = np.abs(w.fixed_components(u)).max()
        what = (
            "some element was turned inside out"
            if residuals[-1] <= TOLERANCE
            else f"the imbalance stayed at {residuals[-1]:.1e} of the load"
        )
        return (
            f"large displacements were followed up to {100 * reached:.3g} % of the load (largest displacement "
            f"{1e3 * far:.3g} mm) and no farther: at {100 * target:.3g} % {what}, "
            f"farthest off in {name} at z = {1e3 * w.planes[plane]:.3g} mm; take a smaller load, more layers there, or the "
            "neo-Hookean law for soft parts (St Venant-Kirchhoff loses its stiffness in strong compression)."
        )
