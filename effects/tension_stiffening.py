r"""Tension stiffening: the stiffness in bending or torsion grows with the axial tension.

.. math::  c = \varepsilon\,(r - 1), \qquad c = \varepsilon\,(r^p - 1), \qquad
           c = \varepsilon\,\Bigl(\frac{(1 + s)\,r}{r + s} - 1\Bigr), \qquad r = N/N_{typ}

K is the stiffness at the typical tension. Source: geometric stiffness of helical wires under tension, e.g. Feyrer, Wire
Ropes (2015) for torsion; contact between the layers closes with tension, with the power 1/3 of Hertz and upwards.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from effects.effect import BenchPath, Effect, Parameter, of_values
from effects.loading_path import grip_ratio, mean_tensions, spread
from effects.reversible_law import reversible_form

Array = NDArray[np.float64]

SHARE = Parameter(
    "tension share",
    "1",
    "part of the stiffness, at the typical tension, that axial tension makes",
    0.0,
    1.0,
    (0.01, 1.0),
    "1 if nothing is left without tension (by definition)",
)
POWER = Parameter(
    "power",
    "1",
    "power of the axial tension",
    low=0.1,
    high=4.0,
    plausible=(0.3, 2.0),
    source="1/3 for Hertz contacts, 1 for geometric stiffness, 2 as the next order",
    starts=of_values(0.3, 0.45, 0.65, 1.4, 2.0),
)
SATURATION = Parameter(
    "saturation",
    "1",
    "tension of half saturation over the typical one",
    low=0.02,
    high=100.0,
    plausible=(0.05, 20.0),
    source="within and about the tensions tested (by definition)",
    starts=of_values(0.1, 0.3, 1.0, 3.0, 10.0),
)


def _linear(strain: Array, tension: Array, temperature: Array, reference: BenchPath) -> Array:
    return (strain * (grip_ratio(tension, reference.typical_tension, strain.size) - 1.0))[:, None]


def _power(strain: Array, tension: Array, temperature: Array, reference: BenchPath, p: float) -> Array:
    return (strain * (grip_ratio(tension, reference.typical_tension, strain.size) ** p - 1.0))[:, None]


def _saturating(strain: Array, tension: Array, temperature: Array, reference: BenchPath, s: float) -> Array:
    r = grip_ratio(tension, reference.typical_tension, strain.size)
    return (strain * ((1.0 + s) * r / (r + s) - 1.0))[:, None]


def _why_untestable(paths: Sequence[BenchPath]) -> str | None:
    tensions = mean_tensions(paths)
    if not tensions:
        return "no axial tension was recorded"
    if spread(tensions) < 1.05:
        return f"all experiments at an axial tension of {np.mean(tensions):.4g} N"
    return None


LINEAR = reversible_form("linear in tension", _linear, strength=(SHARE,))
POWER_LAW = reversible_form("power of tension", _power, (POWER,), (SHARE,))
SATURATING = reversible_form("saturating with tension", _saturating, (SATURATION,), (SHARE,))

EFFECT = Effect(
    name="tension-stiffening",
    kind="physics",
    title="bending or torsion stiffness grows with axial tension",
    equation="load = K strain [1 + a (N/N_typ - 1)]",
    source="Feyrer, Wire Ropes (2015); Hertz contact between layers for the powers below 1",
    needs="at least two axial tensions that are not tied to amplitude, rate or temperature",
    signature="stiffness rises with axial tension at every amplitude; no loop",
    kinds=("torsion", "bending"),
    forms=(LINEAR, POWER_LAW, SATURATING),
    why_untestable=_why_untestable,
)
