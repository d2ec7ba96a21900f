r"""Thermal softening: the stiffness falls with temperature.

.. math::  c = -\varepsilon\,(T - T_{typ}), \qquad c = \varepsilon\,(e^{-b (T - T_{typ})} - 1), \qquad
           c = -\varepsilon\,[S(T) - S(T_{typ})]

S is a step from 0 to 1: smooth round a glass transition, S = (1 + tanh((T - T_g)/w))/2, or straight between two knots;
a sum of the latter with strengths >= 0 is every stiffness that only falls.
Source: first-order expansion; Ferry, Viscoelastic Properties of Polymers (1980) for the transition.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from effects.effect import BenchPath, Effect, Parameter, Starts, of_values
from effects.reversible_law import reversible_form

Array = NDArray[np.float64]

KNOTS = np.array([-45.0, -30.0, -20.0, -10.0, 0.0, 10.0, 20.0, 30.0, 45.0])
"""Knots of the straight pieces above the typical temperature [K]."""

COEFFICIENT = Parameter(
    "temperature coefficient",
    "1/K",
    "relative loss of stiffness per kelvin",
    plausible=(2e-4, 0.03),
    source="metals 3e-4/K to rubbers near their transition 0.03/K (general knowledge)",
)
RATE = Parameter(
    "exponential rate",
    "1/K",
    "relative fall per kelvin of the part that softens",
    low=1e-3,
    high=0.5,
    plausible=(1e-3, 0.15),
    source="rubbery to glassy over some tens of kelvin (general knowledge)",
    starts=of_values(0.005, 0.015, 0.03, 0.06, 0.1, 0.15),
)
_PART = (0.0, 10.0)


def _middle(offsets: tuple[float, ...]) -> Starts:
    return lambda paths: np.array(offsets) + float(np.mean([p.typical_temperature for p in paths]))


TRANSITION = Parameter(
    "transition temperature",
    "K",
    "middle of the step",
    low=100.0,
    high=600.0,
    plausible=(200.0, 400.0),
    source="glass transition or melting of cable polymers -70 to 120 degC (general knowledge)",
    starts=_middle((-25.0, -15.0, -8.0, 0.0, 8.0, 15.0, 25.0)),
)
WIDTH = Parameter(
    "transition width",
    "K",
    "half width of the step",
    low=0.5,
    high=100.0,
    plausible=(2.0, 60.0),
    source="5 to 40 K (general knowledge)",
    starts=of_values(4.0, 10.0, 25.0),
)


def _rise(temperature: Array | float | None, reference: BenchPath, n: int) -> Array:
    """Temperature above the typical one [K], (n,); 0 where none was recorded."""
    if temperature is None:
        return np.zeros(n)
    return np.broadcast_to(np.asarray(temperature, dtype=float) - reference.typical_temperature, (n,))


def _linear(strain: Array, tension: Array, temperature: Array, reference: BenchPath) -> Array:
    return -(strain * _rise(temperature, reference, strain.size))[:, None]


def _exponential(strain: Array, tension: Array, temperature: Array, reference: BenchPath, rate: float) -> Array:
    return (strain * np.expm1(-rate * _rise(temperature, reference, strain.size)))[:, None]


def _transition(
    strain: Array, tension: Array, temperature: Array, reference: BenchPath, middle: float, width: float
) -> Array:
    above = reference.typical_temperature - middle
    rise = _rise(temperature, reference, strain.size)
    step = 0.5 * (np.tanh((rise + above) / width) - np.tanh(above / width))
    return -(strain * step)[:, None]


def _pieces(strain: Array, tension: Array, temperature: Array, reference: BenchPath) -> Array:
    rise = _rise(temperature, reference, strain.size)[:, None]
    low, high = KNOTS[:-1], KNOTS[1:]
    step = (np.clip(rise, low, high) - np.clip(0.0, low, high)) / (high - low)
    return -strain[:, None] * step


def _why_untestable(paths: Sequence[BenchPath]) -> str | None:
    known = [p.temperature for p in paths if p.temperature is not None]
    if not known:
        return "no temperature was recorded"
    if max(known) - min(known) < 1.0:
        return f"all experiments at {np.mean(known) - 273.15:.0f} degC"
    return None


LINEAR = reversible_form("linear in temperature", _linear, strength=(COEFFICIENT,))
EXPONENTIAL = reversible_form(
    "exponential in temperature",
    _exponential,
    (RATE,),
    (
        Parameter(
            "softening part",
            "1",
            "part of the stiffness that falls",
            0.0,
            plausible=_PART,
            source="1 if all of it does",
        ),
    ),
)
STEP = reversible_form(
    "transition",
    _transition,
    (TRANSITION, WIDTH),
    (
        Parameter(
            "step",
            "1",
            "stiffness lost over the transition, over that at the typical temperature",
            plausible=_PART,
            source="up to tenfold for cables with plastic sheaths (general knowledge)",
        ),
    ),
)
PIECES = reversible_form(
    "falling in straight pieces",
    _pieces,
    strength=tuple(
        Parameter(
            f"loss from {low:+g} to {high:+g} K",
            "1",
            f"stiffness lost between {low:+g} and {high:+g} K from the typical temperature",
            plausible=(0.0, 1.0),
            source="0.03/K over a piece (as of the linear form)",
        )
        for low, high in pairwise(KNOTS)
    ),
)

EFFECT = Effect(
    name="thermal-softening",
    kind="physics",
    title="stiffness falls with temperature",
    equation="load = K strain [1 - a (T - T_typ)]",
    source="first-order expansion; Ferry, Viscoelastic Properties of Polymers (1980)",
    needs="at least two temperatures that are not tied to amplitude, rate or tension",
    signature="stiffness falls with temperature and with nothing else; no loop",
    kinds=("tension", "torsion", "bending", "shear"),
    forms=(LINEAR, EXPONENTIAL, STEP, PIECES),
    why_untestable=_why_untestable,
)
