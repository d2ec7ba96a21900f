r"""Viscous damping: a resultant that is proportional to the strain rate (Kelvin-Voigt).

.. math::  c = \dot\varepsilon \qquad\text{or}\qquad c = r_0\,|\dot\varepsilon / r_0|^{n}\,\mathrm{sgn}\,\dot\varepsilon,
           \qquad r_0 = \varepsilon_{largest} / 1\,\mathrm{s}

The strength is a time, damping over stiffness. Between two samples the rate is known on average only. The plain form
takes the second-order central difference, the rate at the sample; the form by steps takes that of the step before, as
a rod does; it is kept as state. They differ by half a sampling interval.
Source: Kelvin 1865, Voigt 1892; the power law is that of Norton and of fluid dampers with orifices.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from effects.effect import UNKNOWN, BenchPath, Effect, Form, Parameter, of_values

Array = NDArray[np.float64]

EXPONENT = Parameter(
    "rate exponent",
    "1",
    "power of the strain rate",
    low=0.1,
    high=3.0,
    plausible=(0.3, 2.0),
    source="0.3 to 2 for fluid and rubber dampers (general knowledge)",
    starts=of_values(0.3, 0.45, 0.65, 0.8, 1.25, 1.6, 2.0),
)


def _strength(meaning: str) -> Parameter:
    return Parameter(
        "damping time",
        "s",
        meaning,
        plausible=(0.0, 100.0),
        source="loss factor below 1 at test rates of 0.01 rad/s and more (general knowledge)",
    )


def _rate(path: BenchPath) -> Array:
    """Strain rate (n,) at the samples: of the parabola through three of them, of the step at the ends; 0 without a clock."""
    rate = np.zeros(path.strain.size)
    if path.time is not None and path.strain.size > 1:
        h = np.diff(path.time)
        step = np.diff(path.strain) / h
        rate[0], rate[-1] = step[0], step[-1]
        rate[1:-1] = (h[1:] * step[:-1] + h[:-1] * step[1:]) / (h[1:] + h[:-1])
    return rate


def _rate_before(path: BenchPath) -> Array:
    """Strain rate (n,) of the step that ends at the sample; 0 at the first."""
    rate = np.zeros(path.strain.size)
    if path.time is not None:
        rate[1:] = np.diff(path.strain) / np.diff(path.time)
    return rate


def _power(rate: Array, largest: float, exponent: float) -> Array:
    return np.sign(rate) * largest * np.abs(rate / largest) ** exponent


def _linear(path: BenchPath) -> Array:
    return _rate(path)[:, None]


def _stepwise(path: BenchPath) -> Array:
    return _rate_before(path)[:, None]


def _power_law(path: BenchPath, exponent: float) -> Array:
    return _power(_rate(path), path.largest, exponent)[:, None]


def _advance(
    strain: Array,
    before: Array,
    dt: float,
    tension: Array,
    temperature: Array,
    state: Array,
    reference: BenchPath = UNKNOWN,
) -> tuple[Array, Array]:
    rate = (strain - before) / dt if dt > 0.0 else np.zeros_like(strain)
    return rate[:, None], rate[:, None]


def _advance_power_law(
    strain: Array,
    before: Array,
    dt: float,
    tension: Array,
    temperature: Array,
    state: Array,
    exponent: float,
    reference: BenchPath = UNKNOWN,
) -> tuple[Array, Array]:
    rate = (strain - before) / dt if dt > 0.0 else np.zeros_like(strain)
    return _power(rate, reference.largest, exponent)[:, None], rate[:, None]


def _why_untestable(paths: Sequence[BenchPath]) -> str | None:
    if all(p.time is None for p in paths):
        return "no record has a clock, so that no rate is known"
    return None


LINEAR = Form(
    "proportional to the rate",
    "section",
    _linear,
    strength=(_strength("damping over stiffness"),),
    advance=_advance,
    memory=1,
)
POWER_LAW = Form(
    "power of the rate",
    "section",
    _power_law,
    shape=(EXPONENT,),
    strength=(_strength("damping over stiffness at a rate of the largest strain per second"),),
    advance=_advance_power_law,
    memory=1,
)
STEPWISE = Form(
    "proportional to the rate of the last step",
    "section",
    _stepwise,
    strength=(_strength("damping over stiffness"),),
    advance=_advance,
    memory=1,
)

EFFECT = Effect(
    name="viscous-damping",
    kind="physics",
    title="resultant proportional to strain rate (Kelvin-Voigt)",
    equation="load = K (strain + t_d dstrain/dt)",
    source="Kelvin-Voigt solid; power law as Norton's",
    needs="a clock; at least two rates, independent of the amplitude, to tell it from friction and from a sensor's lag",
    signature="loop energy grows as amplitude squared times rate; the mean line of the loop stays where it was",
    kinds=("tension", "torsion", "bending", "shear"),
    forms=(LINEAR, POWER_LAW, STEPWISE),
    why_untestable=_why_untestable,
)
