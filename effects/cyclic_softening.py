r"""Cyclic softening: the stiffness falls with the largest strain seen so far (Mullins).

.. math::  m(t) = \max_{t' \le t} |\varepsilon|, \qquad c = -\varepsilon\,D(m), \qquad
           D = 1 - e^{-m/d}, \quad m/m_L, \quad \max(m - d, 0)/m_L, \ldots

or, where the first loading itself is not softened, only what comes back below it,

.. math::  c = -\varepsilon\,\mathrm{erf}\bigl((m^2 - \varepsilon^2)/d^2\bigr)

m_L is the largest strain of all experiments.
Source: Mullins, Rubber Chem. Technol. 42 (1969) 339; Ogden & Roxburgh, Proc. R. Soc. A 455 (1999) 2861-2877.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.special import erf

from effects.effect import UNKNOWN, BenchPath, Effect, Form, Parameter, of_strain
from effects.loading_path import turns_back

Array = NDArray[np.float64]
Softening = Callable[..., Array]

SATURATIONS = np.array([0.1, 0.3, 1.0])
THRESHOLDS = np.array([0.0, 0.15, 0.3, 0.5, 0.7])

DAMAGE_STRAIN = Parameter(
    "damage strain",
    "strain",
    "scale of the largest strain so far on which the softening grows",
    low=1e-9,
    plausible=(1e-9, np.inf),
    source="within the range tested (by definition: else the softening is constant or linear)",
    starts=of_strain(0.03, 3.0, 14),
)
_SOURCE = "filled rubbers lose up to 0.8 of their stiffness (Mullins 1969, as a range)"


def _strength(name: str, meaning: str) -> Parameter:
    return Parameter(name, "1", meaning, 0.0, 1.0, (0.0, 0.8), _SOURCE)


def _saturating(strain: Array, m: Array, largest: float, d: float) -> Array:
    return (strain * np.expm1(-m / d))[:, None]


def _spectrum(strain: Array, m: Array, largest: float) -> Array:
    y = (m / largest)[:, None]
    grown = np.hstack([-np.expm1(-y / SATURATIONS), np.maximum(y - THRESHOLDS, 0.0) / (1.0 - THRESHOLDS)])
    return -strain[:, None] * grown


def _below(strain: Array, m: Array, largest: float, d: float) -> Array:
    return -(strain * erf((m * m - strain * strain) / (d * d)))[:, None]


def _form(name: str, law: Softening, shape: tuple[Parameter, ...], strength: tuple[Parameter, ...]) -> Form:
    def respond(path: BenchPath, *shape: float) -> Array:
        return law(path.strain, np.maximum.accumulate(np.abs(path.strain)), path.largest, *shape)

    def advance(
        strain: Array,
        before: Array,
        dt: float,
        tension: Array,
        temperature: Array,
        state: Array,
        *shape: float,
        reference: BenchPath = UNKNOWN,
    ) -> tuple[Array, Array]:
        m = np.maximum(state[:, 0], np.abs(strain))
        return law(strain, m, reference.largest, *shape), m[:, None]

    return Form(name, "section", respond, shape, strength, advance, memory=1)


def _why_untestable(paths: Sequence[BenchPath]) -> str | None:
    if not turns_back(paths):
        return "no record comes back below a strain that it has reached, so that softening does not show"
    return None


SATURATING = _form(
    "saturating",
    _saturating,
    (DAMAGE_STRAIN,),
    (_strength("softening", "part of the stiffness that a very large strain destroys"),),
)
MIXED = _form(
    "any growth with the largest strain, eight terms",
    _spectrum,
    (),
    (
        *(_strength(f"softening, scale {x:g}", f"saturates at {x:g} of the largest strain") for x in SATURATIONS),
        *(_strength(f"softening beyond {x:g}", f"grows from {x:g} of the largest strain") for x in THRESHOLDS),
    ),
)
BELOW = _form(
    "only below the former maximum",
    _below,
    (DAMAGE_STRAIN,),
    (_strength("softening", "part of the stiffness that is missing far below the former maximum"),),
)

EFFECT = Effect(
    name="cyclic-softening",
    kind="physics",
    title="stiffness falls with the largest strain seen so far (Mullins)",
    equation="load = K strain [1 - a (1 - exp(-m/d))],  m = largest |strain| so far",
    source="Mullins, Rubber Chem. Technol. 42 (1969) 339; Ogden & Roxburgh, Proc. R. Soc. A 455 (1999) 2861",
    needs="cycles of growing and falling amplitude in one record, or several amplitudes",
    signature="first cycle stiffer than the second at the same strain; later loops closed and soft",
    kinds=("tension", "torsion", "bending", "shear"),
    forms=(SATURATING, MIXED, BELOW),
    why_untestable=_why_untestable,
)
