r"""A specimen whose parts open and rub: one path of loads after another from the same initial state.

Small displacements. At each load the jumps solve :math:`G(j) = j - s j_0 - \tilde C q(j) = 0`
(:mod:`homogenize.specimen.contact_condensation`) by a semismooth Newton method: only points that are open or slip have a q, so that
its matrix :math:`I - \tilde C\, dq/dj` is reduced to these points; where they are many, the forces are found instead
(:mod:`homogenize.specimen.contact_forces`), to the same error of the jumps.
Alart, Curnier, Comput. Methods Appl. Mech. Eng. 92 (1991) 353-375, doi 10.1016/0045-7825(91)90022-X.

The initial state comes first: an interference is let go without a load, a grip is in balance already. Where an observed displacement under
+F and -F is (odd + even) and (-odd + even) of it, the even part is what a linear specimen without an initial state does not have.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geometry.errors import ConvergenceError, SpecError
from homogenize.specimen.contact_condensation import ContactSpecimen, FloatArray
from homogenize.specimen.contact_forces import contact_forces
from homogenize.specimen.frictional_contact import ContactState, at_rest, contact_law, dissipation

Progress = Callable[[float, str], None]

TOLERANCE = 1e-7
"""Largest error of a jump, over the largest jump of the holding specimen under its loads or the largest gap."""
MOST_ITERATIONS = 25
MOST_CUTS = 4
_MOST_LOOSE = 0.4
"""Share of the points above which the forces are the better unknowns."""
_FEW = 100
"""Loose points that are few in any specimen."""
_SHARES = (1.0, 0.5, 0.25, 0.1, 0.03)
"""Of a Newton step, tried one after another until the residual falls."""


@dataclass(frozen=True)
class ContactStep:
    """Equilibrium under a share of a load.

    Attributes
    ----------
    share : of the load, with its sign
    face : (nodes, 3) displacement of the loaded end in fixed axes, from the parts as drawn [m]
    strain : (3,) volume averages of e_zz, g_xz, g_yz
    state : of the contacts
    dissipated : by friction since the start of the path [J]
    resultants : (12,) forces and moments about the centre of z = 0 from the held and from the loaded end; their sum should vanish
    """

    share: float
    face: FloatArray
    strain: FloatArray
    state: ContactState
    dissipated: float
    resultants: FloatArray

    def open_share(self, area: FloatArray) -> float:
        """Share of the contact surface without pressure."""
        return float(area[self.state.open()].sum() / area.sum())


def initial_state(specimen: ContactSpecimen) -> ContactStep:
    """The specimen before any load: an interference has been let go.

    Raises
    ------
    ConvergenceError
        If the contacts do not settle.
    """
    rest = at_rest(specimen.constants)
    none = np.zeros(specimen.jump.shape[0])
    state = _follow(specimen, none, none, rest, ()) if np.any(specimen.constants.gap < 0) else rest
    return _observed(specimen, 0, 0.0, state, 0.0)


def contact_path(
    specimen: ContactSpecimen,
    load: int,
    shares: Sequence[float],
    start: ContactStep | None = None,
    progress: Progress | None = None,
) -> tuple[ContactStep, ...]:
    """Follow a load through its shares, negative ones included, from the initial state or from another step.

    Parameters
    ----------
    specimen : ContactSpecimen
    load : number of the load in `specimen.loads`
    shares : of the load, in order
    start : a step to go on from, of the same load or without one

    Raises
    ------
    SpecError
        If the load is not there.
    ConvergenceError
        If a step does not settle, however small; with the parts that are still moving.
    """
    if not 0 <= load < len(specimen.loads):
        raise SpecError(f"load number {load} is not one of the {len(specimen.loads)} loads of the specimen.")
    before = start or initial_state(specimen)
    steps = []
    for i, share in enumerate(shares):
        if progress:
            progress(i / len(shares), f"{specimen.loads[load].name}: {100 * share:.0f} % of the load")
        old, new = (s * specimen.jump[:, load] for s in (before.share, share))
        passed: list[ContactState] = []
        state = _follow(specimen, old, new, before.state, passed)
        lost = before.dissipated
        for a, b in zip([before.state, *passed], [*passed, state]):
            lost += dissipation(a, b, specimen.constants, specimen.area)
        before = _observed(specimen, load, share, state, lost)
        steps.append(before)
    return tuple(steps)


def even_and_odd(plus: float, minus: float) -> tuple[float, float]:
    """Even and odd part of displacements under +F and -F, both along +F.

    Examples
    --------
    >>> even, odd = even_and_odd(6.95, -7.96)
    >>> round(even, 3), round(odd, 3)
    (-0.505, 7.455)
    """
    return 0.5 * (plus + minus), 0.5 * (plus - minus)


def _observed(specimen: ContactSpecimen, load: int, share: float, state: ContactState, lost: float) -> ContactStep:
    q = _excess(specimen, state.jump.ravel(), state)
    seen = share * specimen.observed[:, load] + specimen.columns @ q
    face, strain, resultants = np.split(seen, [3 * specimen.faces, 3 * specimen.faces + 3])
    return ContactStep(share, face.reshape(-1, 3), strain, state, lost, resultants)


def _excess(specimen: ContactSpecimen, jump: FloatArray, state: ContactState) -> FloatArray:
    """q of a state that has settled."""
    force = np.concatenate([(specimen.constants.grip - state.pressure)[:, None], state.shear], axis=1)
    return specimen.springs() * jump - (specimen.area[:, None] * force).ravel()


def _follow(
    specimen: ContactSpecimen,
    old: FloatArray,
    new: FloatArray,
    before: ContactState,
    passed: list[ContactState] | tuple,
) -> ContactState:
    """The state at the load with holding jumps `new`, from that at `old`; states on the way are appended to `passed`."""
    done, step, cuts, state = 0.0, 1.0, 0, before
    while done < 1.0:
        target = min(1.0, done + step)
        base = old + target * (new - old)
        found, error = _settled(specimen, base, (target - done) * (new - old), state)
        if found is None:
            cuts += 1
            if cuts > MOST_CUTS:
                raise ConvergenceError(_sentence(specimen, state, done, error))
            step *= 0.5
            continue
        if target < 1.0 and isinstance(passed, list):
            passed.append(found)
        done, state = target, found
    return state


def _settled(
    specimen: ContactSpecimen, base: FloatArray, ahead: FloatArray, before: ContactState
) -> tuple[ContactState | None, float]:
    """The state at one load, None if it is not found, and the error of the jumps; `ahead` is what they would do if all held.

    Newton's method from there, while most points hold; else :mod:`homogenize.specimen.contact_forces`.
    """
    start = before.jump.ravel() + ahead
    found, error = _newton(specimen, base, start, before)
    if found is None:
        found, error = contact_forces(specimen, base, start, before, TOLERANCE, _size(specimen))
    return found, error


def _size(specimen: ContactSpecimen) -> float:
    """A large jump [m]."""
    return max(float(np.abs(specimen.jump).max()), float(np.abs(specimen.constants.gap).max()))


def _newton(
    specimen: ContactSpecimen,
    base: FloatArray,
    start: FloatArray,
    before: ContactState,
) -> tuple[ContactState | None, float]:
    """Semismooth Newton from `start`, given up where more than :data:`_MOST_LOOSE` of the points are open or slip."""
    springs, area, size = specimen.springs(), specimen.area, _size(specimen)

    def residual(jump: FloatArray) -> tuple[FloatArray, ContactState, FloatArray]:
        state, force, tangent = contact_law(jump.reshape(-1, 3), before, specimen.constants)
        q = springs * jump - (area[:, None] * force).ravel()
        return jump - base - specimen.compliance @ q, state, tangent

    jump = start.copy()
    G, state, tangent = residual(jump)
    error = np.inf
    for _ in range(MOST_ITERATIONS):
        error = float(np.abs(G).max()) / size
        if error <= TOLERANCE:
            return state, error
        slope = springs.reshape(-1, 3)[:, :, None] * np.eye(3) - area[:, None, None] * tangent
        loose = np.flatnonzero(np.abs(slope).max(axis=(1, 2)) > 1e-9 * springs.reshape(-1, 3).max(axis=1))
        if len(loose) > max(_MOST_LOOSE * len(area), _FEW):
            break
        step = _step(specimen.compliance, G, slope[loose], loose)
        tried = []
        for share in _SHARES:
            found = residual(jump + share * step)
            tried.append((float(np.linalg.norm(found[0])), share, found))
            if tried[-1][0] < (1 - 0.3 * share) * np.linalg.norm(G):
                break
        _, share, (G, state, tangent) = min(tried, key=lambda t: t[0])
        jump = jump + share * step
    return None, error


def _step(C: FloatArray, G: FloatArray, slope: FloatArray, loose: NDArray[np.int64]) -> FloatArray:
    """-(I - C dq)^-1 G with dq blocks (k, 3, 3) at the loose points."""
    if not len(loose):
        return -G
    at = (3 * loose[:, None] + np.arange(3)).ravel()
    columns = C if len(at) == len(C) else C[:, at]
    inside = columns if len(at) == len(C) else columns[at]

    def excess(x: FloatArray) -> FloatArray:
        return np.einsum("kij,kj->ki", slope, x.reshape(-1, 3)).ravel()

    blocks = np.einsum("nki,kij->nkj", inside.reshape(len(at), -1, 3), slope, optimize=True).reshape(len(at), -1)
    return columns @ excess(np.linalg.solve(np.eye(len(at)) - blocks, -G[at])) - G


def _sentence(specimen: ContactSpecimen, state: ContactState, done: float, error: float) -> str:
    open_points = np.flatnonzero(state.open())
    where = ", ".join(sorted({" and ".join(specimen.parts[k]) for k in open_points[:200]})[:3]) or "none"
    return (
        f"the contacts of the specimen did not settle beyond {100 * done:.3g} % of a load step: jumps are still off by {error:.1e} of the "
        f"largest; open so far: {where}; take smaller load steps, less friction, or a grip."
    )
