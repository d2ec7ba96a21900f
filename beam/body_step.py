"""One time step of a rod with bodies: the iteration of :mod:`beam.newton_step` with the forces and the matrix of :mod:`beam.multibody`."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from beam.block_sparse import factorise, sweep
from beam.multibody import Multibody
from beam.newton_step import (
    CONVERGED,
    NOT_CONVERGED,
    NOT_FINITE,
    SINGULAR,
    ContactArrays,
    Rule,
    StateArrays,
    account,
    correct,
    evaluate,
    hold,
    predict,
    residual_size,
)
from beam.rod_forces import Blocks, Forces
from beam.rod_model import RodModel

Array = NDArray[np.float64]


def body_step(
    model: RodModel, system: Multibody, t: float, contact: ContactArrays, old: StateArrays, new: StateArrays,
    store: Array, known: bool, rule: Rule, out: Forces, R: Array, totals: Array,
) -> tuple[int, int, int, bool]:  # fmt: skip
    """From the state `old` to `new` at time `t`; `store` holds the factorised matrix if it is `known`.

    `out` receives forces and energies of the bodies, `totals` those of the rod. Returns as :func:`beam.newton_step.newton_step`.
    """
    predict(old, new, rule)
    hold(new, model.held, model.held_values(t))
    start, last, fresh, factored = np.inf, np.inf, 0, 0
    for k in range(rule.iterations):
        evaluate(model.arrays, contact, model.external, new, out.F, out.S, totals)
        add_bodies(model, system, t, contact, new, out)
        size = (1.0 - rule.af) * residual_size(out.F, model.held, R)
        if not size < np.inf:
            return NOT_FINITE, k + 1, factored, known
        start = size if k == 0 else start
        if size <= rule.relative * start + rule.absolute:
            account(model.external, model.held, new, out.F, totals)
            return CONVERGED, k + 1, factored, known
        if size > 1e6 * max(start, 1.0):
            return NOT_CONVERGED, k + 1, factored, known
        if not known or (size > 0.5 * last and k - fresh >= 2):
            fresh, factored = k, factored + 1
            known = renew(model, system, t, contact, new, store, rule) < 0
            if not known:
                return SINGULAR, k + 1, factored, known
        last = size
        at = system.pattern
        sweep(store, at.order, at.first, at.near, at.up, at.low, R)
        correct(new, R, rule)
    return NOT_CONVERGED, rule.iterations, factored, known


def add_bodies(
    model: RodModel, system: Multibody, t: float, contact: ContactArrays, new: StateArrays, out: Forces
) -> None:
    """Add the forces of bodies, bushings, joints and their contacts to ``out.F``; their energies and powers anew."""
    out.kinetic = out.held_power = out.bushing = out.bushing_damping_power = 0.0
    out.penalty = out.bristle = out.contact_damping_power = out.friction_power = out.surface_power = out.penetration = (
        0.0
    )
    begin = model.rod.lengths.size * int(model.first[-1])
    system.add_forces(t, new.q, new.v, new.w, contact.anchors, contact.moved, begin, True, None, 0.0, 0.0, out)


def renew(
    model: RodModel, system: Multibody, t: float, contact: ContactArrays, new: StateArrays, store: Array, rule: Rule
) -> int:
    """Form and factorise the iteration matrix in `store`. Returns -1, or the singular row."""
    speed = rule.gamma / (rule.beta * rule.h)
    acceleration = (1.0 - rule.am) / ((1.0 - rule.af) * rule.beta * rule.h * rule.h)
    at, blocks = system.pattern, Blocks.of_pattern(system.pattern, store)
    model.forces(
        t, new.q, new.v, model.split(contact.anchors), blocks=blocks, factor=speed, a=new.w, factor_a=acceleration
    )
    model.fix(blocks)
    return int(factorise(store, at.order, at.first, at.up, at.low, at.update, at.update_first))
