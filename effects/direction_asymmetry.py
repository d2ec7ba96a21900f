r"""Direction asymmetry: different stiffness for the two signs of the load.

.. math::  c = \pm\tfrac12 |\varepsilon|

so that the stiffness is K (1 + a/2) on the positive side and K (1 - a/2) on the negative one. A test in the direction
x- or y- loads the negative side with a positive deflection: there the sign is turned. Source: bimodular elasticity,
Ambartsumyan 1965; in a cable the lay of the outer layer opens under one sign of the twist and closes under the other.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from effects.effect import BenchPath, Effect, Parameter
from effects.loading_path import direction_sign, sides
from effects.reversible_law import reversible_form

Array = NDArray[np.float64]


def _strength(name: str, meaning: str) -> Parameter:
    return Parameter(
        name,
        "1",
        meaning,
        -2.0,
        2.0,
        (-1.0, 1.0),
        "cores off centre and open lays: a ratio of 3 at most (general knowledge)",
    )


def _even(strain: Array, tension: Array, temperature: Array, reference: BenchPath) -> Array:
    return (0.5 * direction_sign(reference.direction) * np.abs(strain))[:, None]


def _by_plane(strain: Array, tension: Array, temperature: Array, reference: BenchPath) -> Array:
    columns = np.zeros((strain.size, 2))
    plane = 1 if (reference.direction or "x").startswith("y") else 0
    columns[:, plane] = 0.5 * direction_sign(reference.direction) * np.abs(strain)
    return columns


def _why_untestable(paths: Sequence[BenchPath]) -> str | None:
    if len(sides(paths)) < 2:
        return "every experiment loads in one and the same direction"
    return None


TWO_SLOPES = reversible_form(
    "two slopes",
    _even,
    strength=(_strength("asymmetry", "difference of the two stiffnesses over their mean"),),
)
BY_PLANE = reversible_form(
    "two slopes in each plane",
    _by_plane,
    strength=(
        _strength("asymmetry in x", "difference of the stiffnesses in x+ and x- over their mean"),
        _strength("asymmetry in y", "difference of the stiffnesses in y+ and y- over their mean"),
    ),
)

EFFECT = Effect(
    name="direction-asymmetry",
    kind="physics",
    title="different stiffness for the two signs of the load",
    equation="load = K (strain + a |strain| / 2)",
    source="Ambartsumyan 1965, bimodular elasticity",
    needs="load in both directions",
    signature="two slopes that meet at zero load, even harmonics, no loop",
    kinds=("tension", "torsion", "bending", "shear"),
    forms=(TWO_SLOPES, BY_PLANE),
    why_untestable=_why_untestable,
)
