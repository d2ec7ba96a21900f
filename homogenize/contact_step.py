r"""One load step of interfaces that slip and open: Signorini's conditions and Coulomb's cone on a condensed section.

With the jumps x = (slips, openings), S x + A y the force that the interface must put on them, and old jumps of the step before,

.. math::
   0 \le g = x_n + g_0 \;\perp\; f_n \ge 0, \qquad |f_t| \le c, \qquad
   f_t = -c\, \Delta x_t / |\Delta x_t| \ \text{where}\ \Delta x_t \ne 0 ,

with c = mu f_n where the parts can part (f_n the contact force of this very step), and c given where they cannot. Stick, slip and
separation are exact, there is no penalty. With c given this is the minimum of a convex energy plus the heat; with c = mu f_n
it is not, as friction does not follow from a potential then (De Saxce, Feng, Math. Comput. Model. 28 (1998) 225-245); a solution
is unique for small mu.

Solved by splitting (alternating directions): an elastic step with all jumps free but tied to a trial z by springs rho L,
then the laws at every node, all at once, as projections P of v = z + u:

.. math::
   z = P(v), \qquad (S + \rho L)\, d = \rho L (z - u) - r, \qquad v \leftarrow v + \alpha (d - z) ,

z_n = max(v_n, -g), z_t = v_t max(0, 1 - c / (rho L |v_t|)); -rho L u = -rho L (v - z) is the contact force, r the force at the old jumps, L
a bound of S. The springs are an aid of the iteration: at its end d = z. rho is small because slips at full friction are
governed by soft, long-ranged motions (whole parts that slide), which the elastic step takes exactly. Boyd, Parikh, Chu, Peleato,
Eckstein, Found. Trends Mach. Learn. 3 (2011) 1-122, doi 10.1561/2200000016. The map v -> v is sped up by Anderson's extrapolation of
the last few steps, given up for a plain step where the residual grows: Walker, Ni, SIAM J. Numer. Anal. 49 (2011) 1715-1735,
doi 10.1137/10078356X.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geometry.errors import ConvergenceError
from homogenize.interface_operator import InterfaceOperator
from homogenize.section_field import FloatArray

TOLERANCE = 1e-6
"""Largest imbalance of a nodal force at the end of a step, relative to the largest friction or contact force."""
MOST_ITERATIONS = 4000
_SPRING = 0.015
"""rho at the start; from measurements on a cable with four cores."""
_RELAXATION = 1.6
_SMALL = 1e-3
"""Friction forces below this share of the load's forces are not resolved any better than those of this size."""
_EXTRAPOLATED, _CYCLE = 500, 800
"""Iterations that are sped up, of every so many; large friction at parts that open can need some without."""
_MEMORY = 20
"""Steps that are extrapolated."""
_GROWTH = 2.0
"""Growth of the residual at which an extrapolation is given up."""


@dataclass(frozen=True)
class NodeLaws:
    """What the nodes of an interface obey.

    Attributes
    ----------
    friction : (rubbing,) mu
    opening_of : (rubbing,) number of the opening of the same node; -1 where the parts cannot part
    gap : (openings,) g_0 [m]
    """

    friction: FloatArray
    opening_of: NDArray[np.int64]
    gap: FloatArray

    def caps(self, given: FloatArray, contact: FloatArray) -> FloatArray:
        """Largest friction force (stations, rubbing) from given ones (rubbing,) and contact forces (stations, openings)."""
        caps = np.broadcast_to(given, (len(contact), len(given))).copy()
        own = self.opening_of >= 0
        caps[:, own] = self.friction[own] * np.maximum(contact[:, self.opening_of[own]], 0.0)
        return caps


def contact_step(
    operator: InterfaceOperator,
    laws: NodeLaws,
    load: FloatArray,
    old: FloatArray,
    given: FloatArray,
    guess: FloatArray,
    force: FloatArray,
) -> tuple[FloatArray, int]:
    """Jumps after one load step, and the number of iterations.

    Parameters
    ----------
    load : (stations, u) force of the load without jumps [N/m]
    old : (stations, u) jumps before the step [m]
    given : (rubbing,) friction force of each node that cannot part, per length [N/m]
    guess, force : (stations, u) increment of the jumps [m] and interface forces [N/m] to start from

    Raises
    ------
    ConvergenceError
        With how far the iteration came, and the number of the unknown that is farthest off in ``worst``.
    """
    L, base = operator.bound, operator.force(old) + load
    scale = max(float(given.max(initial=0.0)), _SMALL * float(np.abs(base).max(initial=0.0)))
    if not given.any() and not len(laws.gap):
        return old - operator.free(base), 0
    if scale == 0.0:
        return old, 0
    rho = _SPRING
    v = guess - force / (rho * L)
    extrapolate = Extrapolation(v.size)
    off = np.inf
    apart = np.zeros_like(v)
    for iteration in range(1, MOST_ITERATIONS + 1):
        z = _projected(v, laws, given, rho * L, old, operator.rubbing)
        d = operator.sprung(rho, rho * L * (2 * z - v) - base)
        apart = np.abs(d - z) * L
        off = float(apart.max())
        if len(laws.gap):
            scale = max(scale, rho * float((np.abs(v - z) * L)[:, 2 * operator.rubbing :].max()))
        if off <= TOLERANCE * scale:
            return _landed(old + z, z, laws, old, operator.rubbing), iteration
        step = _RELAXATION * (d - z)
        if iteration % _CYCLE == 0:
            extrapolate = Extrapolation(v.size)
        v = extrapolate(v, step, np.sqrt(L)) if iteration % _CYCLE < _EXTRAPOLATED else v + step
    worst = int(apart.max(axis=0).argmax())
    raise UnsettledError(
        f"the slips of a load step did not settle in {MOST_ITERATIONS} iterations: forces are still out of balance by "
        f"{off / scale:.1e} of the largest friction force (allowed {TOLERANCE:.0e}); take smaller load steps.",
        worst,
    )


class UnsettledError(ConvergenceError):
    """A load step that did not settle; `worst` is the number of the unknown that is farthest off."""

    def __init__(self, sentence: str, worst: int) -> None:
        super().__init__(sentence)
        self.worst = worst


class Extrapolation:
    """Anderson's extrapolation of a fixed-point map from its last few steps."""

    def __init__(self, size: int) -> None:
        self.dx = np.zeros((_MEMORY, size))
        self.df = np.zeros((_MEMORY, size))
        self.gram = np.zeros((_MEMORY, _MEMORY))
        self.count = 0
        self.last: tuple[FloatArray, FloatArray] | None = None
        self.best = np.inf
        self.plain: FloatArray | None = None

    def __call__(self, v: FloatArray, step: FloatArray, weight: FloatArray) -> FloatArray:
        """The next trial from a point and its plain step; both are measured with a weight."""
        f = (step * weight).ravel()
        x = (v * weight).ravel()
        norm = float(f @ f) ** 0.5
        if self.plain is not None and norm > _GROWTH * self.best:
            back, self.plain, self.last, self.count = self.plain, None, None, 0
            self.best = np.inf
            return back
        self.best = min(self.best, norm)
        if self.last is not None:
            row = self.count % _MEMORY
            self.dx[row], self.df[row] = x - self.last[0], f - self.last[1]
            self.count += 1
            m = min(self.count, _MEMORY)
            self.gram[row, :m] = self.gram[:m, row] = self.df[:m] @ self.df[row]
        self.last = (x, f)
        m = min(self.count, _MEMORY)
        if m < 2:
            self.plain = None
            return v + step
        H = self.gram[:m, :m]
        gamma = np.linalg.solve(H + 1e-10 * np.trace(H) * np.eye(m), self.df[:m] @ f)
        self.plain = v + step
        return ((x + f - gamma @ (self.dx[:m] + self.df[:m])).reshape(v.shape)) / weight


def _landed(x: FloatArray, z: FloatArray, laws: NodeLaws, old: FloatArray, rubbing: int) -> FloatArray:
    """Jumps whose closed openings are -g_0 to the last digit."""
    n = slice(2 * rubbing, None)
    x[:, n] = np.where(z[:, n] <= -laws.gap - old[:, n], -laws.gap, x[:, n])
    return x


def _projected(
    v: FloatArray, laws: NodeLaws, given: FloatArray, spring: FloatArray, old: FloatArray, rubbing: int
) -> FloatArray:
    """P(v): openings that stay above -g_0, slips shortened by the friction."""
    z = np.empty_like(v)
    t, n = slice(0, 2 * rubbing), slice(2 * rubbing, None)
    z[:, n] = np.maximum(v[:, n], -laws.gap - old[:, n])
    caps = laws.caps(given, spring[n] * (z[:, n] - v[:, n]))
    pairs = v[:, t].reshape(len(v), -1, 2)
    length = np.sqrt(pairs[..., 0] ** 2 + pairs[..., 1] ** 2)
    keep = np.maximum(0.0, 1.0 - caps / (spring[t][::2] * np.maximum(length, 1e-300)))
    z[:, t] = (pairs * keep[..., None]).reshape(len(v), -1)
    return z
