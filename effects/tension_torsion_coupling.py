r"""Coupling of tension and torsion: a torque under pure stretch, a force under pure twist.

.. math::  M_z = EA\,a\,\varepsilon \ (\text{tension}), \qquad N = GJ\,a\,\tau \ (\text{torsion})

Helical layers whose lays do not balance turn when they are pulled. Both a are the same section coupling B, as B/EA and
as B/GJ. Source: Costello, Theory of Wire Rope (1997), chapter 3.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from effects.effect import BenchPath, Effect, Parameter
from effects.reversible_law import reversible_form

Array = NDArray[np.float64]


def _strength(name: str, meaning: str) -> Parameter:
    return Parameter(
        name,
        "arm",
        meaning,
        -np.inf,
        np.inf,
        (-np.inf, np.inf),
        "in tension at most the radius times the tangent of the lay angle, some millimetres (Costello 1997)",
    )


def _linear(strain: Array, tension: Array, temperature: Array, reference: BenchPath) -> Array:
    return strain[:, None]


def _cubic(strain: Array, tension: Array, temperature: Array, reference: BenchPath) -> Array:
    ratio = strain / reference.largest
    return np.column_stack([strain, strain * np.abs(ratio), strain * ratio**2])


LINEAR = reversible_form(
    "proportional",
    _linear,
    strength=(_strength("coupling", "torque over axial stiffness times strain, or force over torsional"),),
    stage="cross",
)
CURVED = reversible_form(
    "changing with amplitude",
    _cubic,
    strength=(
        _strength("coupling", "at small strain"),
        _strength("coupling, one-sided growth", "secant change at the largest strain, of the odd quadratic term"),
        _strength("coupling, cubic growth", "secant change at the largest strain, of the cubic term"),
    ),
    stage="cross",
)

EFFECT = Effect(
    name="tension-torsion-coupling",
    kind="physics",
    title="torque under pure extension, force under pure twist",
    equation="torque = EA a strain (tension),  force = GJ a twist (torsion)",
    source="Costello, Theory of Wire Rope (1997), chapter 3",
    needs="the torque of a tension test with blocked rotation, or the force of a torsion test with blocked stretch",
    signature="the second load follows the first without delay, with its sign",
    kinds=("tension", "torsion"),
    forms=(LINEAR, CURVED),
)
