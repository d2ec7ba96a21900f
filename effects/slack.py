r"""Slack: a soft toe before the layers bed in; reversible, and on the positive side of the strain only.

.. math::  c = -\delta(\varepsilon) \ \text{for}\ \varepsilon > 0,\quad 0 \ \text{else}; \qquad
           \delta = d\,(1 - e^{-\varepsilon/d}), \quad \min(\varepsilon, d), \quad d \tanh(\varepsilon/d), \quad
           \varepsilon - \varepsilon^2/2d \ (\varepsilon < d),\ d/2

The stiffness begins at K (1 - a) and reaches K beyond the toe, where the line is shifted by a d. A sum of the sharp
ones with strengths >= 0 is every toe that only stiffens.
Source: bedding-in of strands, e.g. Feyrer, Wire Ropes (2015); the exponential toe is that of Fung's tissues.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from effects.effect import BenchPath, Effect, Form, Parameter, of_strain
from effects.reversible_law import reversible_form

Array = NDArray[np.float64]

TOES = np.array([0.02, 0.04, 0.08, 0.13, 0.2, 0.3, 0.42, 0.56, 0.72, 0.9])
"""Dead lengths of the mixed form over the largest strain."""

TOE = Parameter(
    "toe strain",
    "strain",
    "length of the toe",
    low=1e-9,
    plausible=(1e-9, np.inf),
    source="bedding-in of strands 0.05 to 0.5 % in tension (general knowledge); no common number in other kinds",
    starts=of_strain(0.01, 1.0, 14),
)
_SOURCE = "0 no toe, 1 no stiffness at the start (by definition)"
SOFTNESS = Parameter(
    "softness", "1", "part of the stiffness that is missing at the start", 0.0, 1.0, (0.02, 1.0), _SOURCE
)
LOOSENESS = Parameter(
    "looseness", "1", "part of the stiffness that is missing on the negative side", 0.0, 1.0, (0.0, 1.0), _SOURCE
)


def _exponential(x: Array, d: float) -> Array:
    return -d * np.expm1(-x / d)


def _sharp(x: Array, d: float) -> Array:
    return np.minimum(x, d)


def _tanh(x: Array, d: float) -> Array:
    return d * np.tanh(x / d)


def _quadratic(x: Array, d: float) -> Array:
    y = np.minimum(x, d)
    return y - y * y / (2.0 * d)


def _toe_form(name: str, deficit: Callable[[Array, float], Array]) -> Form:
    def law(strain: Array, tension: Array, temperature: Array, reference: BenchPath, d: float) -> Array:
        return -deficit(np.maximum(strain, 0.0), d)[:, None]

    return reversible_form(name, law, (TOE,), (SOFTNESS,))


def _mixed(strain: Array, tension: Array, temperature: Array, reference: BenchPath) -> Array:
    return -np.minimum(np.maximum(strain, 0.0)[:, None], TOES * reference.largest)


def _loose(strain: Array, tension: Array, temperature: Array, reference: BenchPath, d: float) -> Array:
    return np.column_stack([-_exponential(np.maximum(strain, 0.0), d), -np.minimum(strain, 0.0)])


def _why_untestable(paths: Sequence[BenchPath]) -> str | None:
    if not any(p.strain.max(initial=0.0) > 0.0 for p in paths):
        return "no record loads the positive side, where a slack is taken up"
    return None


EXPONENTIAL = _toe_form("exponential toe", _exponential)
SHARP = _toe_form("dead length", _sharp)
QUADRATIC = _toe_form("parabolic toe", _quadratic)
SMOOTH = _toe_form("hyperbolic tangent toe", _tanh)
MIXED = reversible_form(
    "any toe, ten dead lengths",
    _mixed,
    strength=tuple(
        Parameter(f"softness {x:g}", "1", f"missing up to {x:g} of the largest strain", 0.0, 1.0, (0.0, 1.0), _SOURCE)
        for x in TOES
    ),
)
LOOSE = reversible_form("toe, and slack on the negative side", _loose, (TOE,), (SOFTNESS, LOOSENESS))

EFFECT = Effect(
    name="slack",
    kind="physics",
    title="soft toe before the layers bed in: reversible, one-sided",
    equation="load = K [strain - a d (1 - exp(-strain/d))] for strain > 0, K strain else",
    source="Feyrer, Wire Ropes (2015), bedding-in; exponential toe after Fung 1967",
    needs="small and large strains on the positive side; the negative side tells it from stiffening",
    signature="soft start on one side, then straight; no loop; in a short range stiffness rises with amplitude",
    kinds=("tension", "torsion", "bending", "shear"),
    forms=(EXPONENTIAL, SHARP, QUADRATIC, SMOOTH, MIXED, LOOSE),
    why_untestable=_why_untestable,
)
