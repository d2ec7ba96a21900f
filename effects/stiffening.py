r"""Stiffening: the section grows stiffer with the strain, and back again on the same line.

.. math::  c = \varepsilon\,|\varepsilon/\varepsilon_{largest}|^{p}, \qquad
           c = \varepsilon\,\frac{(\varepsilon/x)^2}{1 - (\varepsilon/x)^2}, \qquad
           c = \mathrm{sgn}(\varepsilon)\,\max(|\varepsilon| - x,\, 0)

The cubic, p = 2, is the first term of every smooth law that is odd, and p may be found from the data; the
second locks at a strain x, as chains of finite
length do; a sum of the third with strengths >= 0 is every convex law.
Source: Duffing 1918; Gent, Rubber Chem. Technol. 69 (1996) 59-61.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from effects.effect import BenchPath, Effect, Parameter, of_strain, of_values
from effects.reversible_law import reversible_form

Array = NDArray[np.float64]

POWERS = np.array([1.0, 2.0, 4.0, 8.0, 16.0])
KNEES = np.array([0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.88, 0.94])
"""Knees of the convex form over the largest strain."""
_NEAR_LOCK = 0.999  # of the locking strain: beyond, the law goes on straight

LOCKING_STRAIN = Parameter(
    "locking strain",
    "strain",
    "strain at which the stiffness becomes infinite",
    low=1e-9,
    plausible=(1e-9, np.inf),
    source="beyond the largest strain that was reached (by definition)",
    starts=of_strain(1.03, 4.0, 10),
)


EXPONENT = Parameter(
    "exponent",
    "1",
    "of the growth of the secant stiffness with strain; 2 for the cubic law",
    low=0.1,
    high=20.0,
    plausible=(0.2, 10.0),
    source="between a knee and a lock; general knowledge",
    starts=of_values(0.5, 1.0, 1.5, 3.0, 5.0),
)


def _strength(name: str, meaning: str) -> Parameter:
    return Parameter(
        name,
        "1",
        meaning,
        plausible=(0.0, 10.0),
        source="rubber stiffens at most some tenfold before it breaks (Treloar 1944, as a range)",
    )


def _cubic(strain: Array, tension: Array, temperature: Array, reference: BenchPath) -> Array:
    return (strain * (strain / reference.largest) ** 2)[:, None]


def _powers(strain: Array, tension: Array, temperature: Array, reference: BenchPath) -> Array:
    return strain[:, None] * np.abs(strain / reference.largest)[:, None] ** POWERS


def _locking(strain: Array, tension: Array, temperature: Array, reference: BenchPath, x: float) -> Array:
    ratio = np.minimum((strain / x) ** 2, _NEAR_LOCK**2)
    return (strain * ratio / (1.0 - ratio))[:, None]


def _power(strain: Array, tension: Array, temperature: Array, reference: BenchPath, exponent: float) -> Array:
    return (strain * np.abs(strain / reference.largest) ** exponent)[:, None]


def _knees(strain: Array, tension: Array, temperature: Array, reference: BenchPath) -> Array:
    over = np.abs(strain)[:, None] - KNEES * reference.largest
    return np.sign(strain)[:, None] * np.maximum(over, 0.0)


CUBIC = reversible_form(
    "cubic",
    _cubic,
    strength=(_strength("cubic stiffening", "added stiffness at the largest strain (secant), over the linear one"),),
)
ODD_POWERS = reversible_form(
    "odd powers",
    _powers,
    strength=tuple(
        _strength(f"stiffening of power {p:g}", f"secant stiffness added as strain to the power {p:g}, at the largest")
        for p in POWERS
    ),
)
LOCKING = reversible_form(
    "locking strain",
    _locking,
    shape=(LOCKING_STRAIN,),
    strength=(_strength("locking stiffness", "scale of the stiffness that becomes infinite, over the linear one"),),
)
CONVEX = reversible_form(
    "any convex law, ten knees",
    _knees,
    strength=tuple(
        _strength(f"stiffening beyond {x:g}", f"stiffness added beyond {x:g} of the largest strain") for x in KNEES
    ),
)
POWER = reversible_form(
    "power law",
    _power,
    shape=(EXPONENT,),
    strength=(
        _strength("power-law stiffening", "added stiffness at the largest strain (secant), over the linear one"),
    ),
)

EFFECT = Effect(
    name="stiffening",
    kind="physics",
    title="reversible stiffening with amplitude",
    equation="load = K strain [1 + a (strain/largest)^2]",
    source="Duffing 1918; Gent, Rubber Chem. Technol. 69 (1996) 59",
    needs="at least two amplitudes, or one large one",
    signature="stiffness rises with amplitude, no loop, odd harmonics",
    kinds=("tension", "torsion", "bending", "shear"),
    forms=(CUBIC, ODD_POWERS, LOCKING, CONVEX, POWER),
)
