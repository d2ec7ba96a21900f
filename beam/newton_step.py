r"""One time step by modified Newton iteration, around compiled kernels.

The equations of motion hold at the end of the step, M(q) w + F(q, v, t) = 0 with the true acceleration w; the algorithmic
acceleration a follows from (1 - alpha_m) a_{n+1} + alpha_m a_n = (1 - alpha_f) w_{n+1} + alpha_f w_n. For a constant mass
matrix this is the method of Chung and Hulbert, force by force; it also is of second order where M depends on q.

The factorised matrix comes from earlier steps and is renewed where the residual falls by less than a factor of two.

Source: M. Arnold, O. Brüls, Multibody Syst. Dyn. 18 (2007) 185-202, doi 10.1007/s11044-007-9084-0.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from beam.block_tridiagonal import invert_chain, sweep_chain
from beam.compiled import kernel
from beam.contact_force import contact_forces
from beam.contact_lanes import contact_residual
from beam.element_choice import internal_force, internal_tangent

Array = NDArray[np.float64]

CONVERGED, NOT_CONVERGED, NOT_FINITE, SINGULAR = 0, 1, 2, 3
TOTALS = 5
"""Elastic energy, damping power, kinetic energy, power of the held unknowns, potential of the constant forces."""


class RodArrays(NamedTuple):
    """What the kernels read of a rod."""

    lengths: Array
    x: Array
    w: Array
    H: Array
    C: Array
    C_damping: Array
    damped: bool
    E0: Array
    m: float
    J: Array
    mass: Array


class ContactArrays(NamedTuple):
    """Surfaces one after the other, see :func:`beam.contact_force.contact_forces`, and room for what they report."""

    P: Array
    first: NDArray[np.int64]
    xs: Array
    ws: Array
    anchors: Array
    moved: Array
    reports: Array
    nodal: Array
    cone: Array


class StateArrays(NamedTuple):
    """Positions, velocities, algorithmic and true accelerations, each (n + 1, dof)."""

    q: Array
    v: Array
    a: Array
    w: Array


class MatrixArrays(NamedTuple):
    """Blocks of the iteration matrix, see :func:`beam.block_tridiagonal.invert_chain`."""

    D: Array
    U: Array
    L: Array
    pivots: NDArray[np.int64]


class Rule(NamedTuple):
    """Coefficients of the method, step h, stopping rule, most iterations."""

    am: float
    af: float
    gamma: float
    beta: float
    h: float
    relative: float
    absolute: float
    iterations: int


def predict(old: StateArrays, new: StateArrays, rule: Rule) -> None:
    """Start of the iteration: the algorithmic acceleration goes on as it was."""
    h = rule.h
    np.copyto(new.a, old.a)
    np.add(old.v, h * old.a, out=new.v)
    np.add(old.q, (0.5 * h) * (old.v + new.v), out=new.q)
    np.subtract(old.a, rule.af * old.w, out=new.w)
    np.divide(new.w, 1.0 - rule.af, out=new.w)


def hold(new: StateArrays, held: NDArray[np.int64], values: Array) -> None:
    """Write prescribed positions, velocities, accelerations `values` (k, 3) into the unknowns `held` (k, 2)."""
    i, k = held.T
    new.q[i, k], new.v[i, k], new.a[i, k] = values.T
    new.w[i, k] = values[:, 2]


def evaluate(
    rod: RodArrays, contact: ContactArrays, external: Array, state: StateArrays, F: Array, S: Array, totals: Array
) -> None:
    """Write M w + F - external into `F` and the section forces into `S`; energies and powers into `totals`, `reports`."""
    np.negative(external, out=F)
    totals[0], totals[1], totals[2] = internal_force(
        state.q, state.v, state.w, True, rod.damped, rod.lengths, rod.H, rod.w, rod.C, rod.C_damping, rod.E0,
        rod.m, rod.J, rod.mass, F, S,
    )  # fmt: skip
    contact_residual(
        contact.P, contact.first, contact.xs, contact.ws, state.q, state.v, rod.lengths, contact.anchors,
        contact.moved, F, contact.reports,
    )  # fmt: skip


def renew(
    rod: RodArrays, contact: ContactArrays, held: NDArray[np.int64], state: StateArrays, matrix: MatrixArrays,
    rule: Rule, F: Array,
) -> int:  # fmt: skip
    """Form and factorise the iteration matrix; `F` is room that is overwritten. Returns -1, or the singular node."""
    D, U, L = matrix.D, matrix.U, matrix.L
    D[:] = 0.0
    U[:] = 0.0
    L[:] = 0.0
    speed = rule.gamma / (rule.beta * rule.h)
    acceleration = (1.0 - rule.am) / ((1.0 - rule.af) * rule.beta * rule.h * rule.h)
    internal_tangent(
        state.q, state.v, state.w, True, speed, acceleration, rod.lengths, rod.x, rod.H, rod.w, rod.C, rod.C_damping,
        rod.E0, rod.m, rod.J, rod.mass, D, U, L,
    )  # fmt: skip
    contact_forces(
        contact.P, contact.first, contact.xs, contact.ws, state.q, state.v, rod.lengths, contact.anchors,
        contact.moved, F, contact.nodal, contact.nodal, contact.reports, contact.cone, False, True, speed, D, U, L,
    )  # fmt: skip
    fix_blocks(held, D, U, L)
    return invert_chain(D, U, L, matrix.pivots)


def fix_blocks(held: NDArray[np.int64], D: Array, U: Array, L: Array) -> None:
    """Replace rows and columns of the unknowns `held` (k, 2) by the identity."""
    i, k = held.T
    D[i, k, :] = 0.0
    D[i, :, k] = 0.0
    D[i, k, k] = 1.0
    before, after = i > 0, i < len(U)
    L[i[before] - 1, k[before], :] = 0.0
    U[i[before] - 1, :, k[before]] = 0.0
    U[i[after], k[after], :] = 0.0
    L[i[after], :, k[after]] = 0.0


@kernel
def residual_size(F: Array, held: NDArray[np.int64], R: Array) -> float:
    """Copy the free rows of `F` into `R`; its length."""
    for i in range(F.shape[0]):
        for k in range(F.shape[1]):
            R[i, k] = F[i, k]
    for j in range(held.shape[0]):
        R[held[j, 0], held[j, 1]] = 0.0
    total = 0.0
    for i in range(F.shape[0]):
        part = 0.0
        for k in range(F.shape[1]):
            part += R[i, k] * R[i, k]
        total += part
    return np.sqrt(total)


def correct(state: StateArrays, delta: Array, rule: Rule) -> None:
    """Subtract Newton's step from positions, and what belongs to it from velocities and accelerations."""
    h, beta = rule.h, rule.beta
    algorithmic = 1.0 / (beta * h * h)
    move(*state, delta, rule.gamma / (beta * h), algorithmic, (1.0 - rule.am) / (1.0 - rule.af) * algorithmic)


@kernel
def move(q: Array, v: Array, a: Array, w: Array, delta: Array, speed: float, algorithmic: float, true: float) -> None:
    """Subtract `delta` from `q`, and the given multiples of it from `v`, `a` and `w`."""
    for i in range(delta.shape[0]):
        for k in range(delta.shape[1]):
            d = delta[i, k]
            q[i, k] -= d
            v[i, k] -= speed * d
            a[i, k] -= algorithmic * d
            w[i, k] -= true * d


def account(external: Array, held: NDArray[np.int64], new: StateArrays, F: Array, totals: Array) -> None:
    """Complete `totals` for an accepted state."""
    i, k = held.T
    totals[3] = F[i, k] @ new.v[i, k]
    totals[4] = -np.vdot(external, new.q)


def newton_step(
    rod: RodArrays, contact: ContactArrays, external: Array, held: NDArray[np.int64], values: Array, old: StateArrays,
    new: StateArrays, matrix: MatrixArrays, known: bool, rule: Rule, F: Array, S: Array, R: Array, totals: Array,
) -> tuple[int, int, int, bool]:  # fmt: skip
    """From the state `old` to `new`; `known` says that `matrix` holds a factorised matrix of this step length.

    `R` keeps the last residual. Returns how it ended, the iterations, the factorisations, and whether `matrix` is usable.
    """
    predict(old, new, rule)
    hold(new, held, values)
    start, last, fresh, factored = np.inf, np.inf, 0, 0
    for k in range(rule.iterations):
        evaluate(rod, contact, external, new, F, S, totals)
        size = (1.0 - rule.af) * residual_size(F, held, R)
        if not size < np.inf:
            return NOT_FINITE, k + 1, factored, known
        if k == 0:
            start = size
        if size <= rule.relative * start + rule.absolute:
            account(external, held, new, F, totals)
            return CONVERGED, k + 1, factored, known
        if size > 1e6 * max(start, 1.0):
            return NOT_CONVERGED, k + 1, factored, known
        if not known or (size > 0.5 * last and k - fresh >= 2):
            fresh = k
            factored += 1
            known = renew(rod, contact, held, new, matrix, rule, F) < 0
            if not known:
                return SINGULAR, k + 1, factored, known
        last = size
        sweep_chain(matrix.D, matrix.U, matrix.L, R)
        correct(new, R, rule)
    return NOT_CONVERGED, rule.iterations, factored, known
