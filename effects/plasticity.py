r"""Plasticity: the metal yields at a strain that axial tension does not move, and keeps a permanent set.

.. math::  c = s, \qquad |s| \le x \ (\text{kinematic, or many elements}) \quad\text{or}\quad |s| \le x + h\,p

s is the stress of a stick-slip element (:mod:`effects.slip_element`), x its yield strain, p the plastic strain that it
has gone through. One element beside the linear spring is bilinear kinematic hardening; many make the smooth knee of
Ramberg & Osgood; a limit that grows by h with p is isotropic hardening.
Source: Prager 1956; Besseling, J. Appl. Mech. 25 (1958) 529-536; Simo & Hughes, Computational Inelasticity (1998).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from effects.effect import UNKNOWN, BenchPath, Derived, Effect, Form, Parameter, of_strain, of_values
from effects.gradual_slip import gradual_record, gradual_step
from effects.slip_element import hardening_record, hardening_step, slip_record, slip_step

Array = NDArray[np.float64]

YIELD_STRAINS = np.geomspace(0.03, 3.0, 16)
"""Yield strains of the many-element form over the largest strain."""

YIELD_STRAIN = Parameter(
    "yield strain",
    "strain",
    "strain at which the first metal yields",
    plausible=(0.0, np.inf),
    source="of the layup: yield strain of the wire over lay angle and radius; no common number",
    starts=of_strain(0.01, 1.5, 14),
)
HARDENING = Parameter(
    "isotropic hardening",
    "1",
    "growth of the yield limit with the plastic strain gone through",
    plausible=(0.0, 0.5),
    source="plastic modulus of drawn copper and steel at most some tenths of E (general knowledge)",
    starts=of_values(0.01, 0.03, 0.1, 0.3),
)


def _strength(name: str, meaning: str) -> Parameter:
    return Parameter(
        name,
        "1",
        meaning,
        plausible=(0.0, 100.0),
        source="elastic over plastic stiffness of metals, up to about 100 (general knowledge)",
    )


def _one(path: BenchPath, yield_strain: float) -> Array:
    return slip_record(path.strain, np.array([yield_strain]), np.ones(path.strain.size))


def _many(path: BenchPath) -> Array:
    return slip_record(path.strain, YIELD_STRAINS * path.largest, np.ones(path.strain.size))


def _isotropic(path: BenchPath, yield_strain: float, hardening: float) -> Array:
    return hardening_record(path.strain, yield_strain, hardening)


def _advance_one(
    strain: Array,
    before: Array,
    dt: float,
    tension: Array,
    temperature: Array,
    state: Array,
    yield_strain: float,
    reference: BenchPath = UNKNOWN,
) -> tuple[Array, Array]:
    stress = slip_step(state, strain - before, np.array([yield_strain]), np.ones(strain.size))
    return stress, stress


def _advance_many(
    strain: Array,
    before: Array,
    dt: float,
    tension: Array,
    temperature: Array,
    state: Array,
    reference: BenchPath = UNKNOWN,
) -> tuple[Array, Array]:
    stress = slip_step(state, strain - before, YIELD_STRAINS * reference.largest, np.ones(strain.size))
    return stress, stress


def _advance_isotropic(
    strain: Array,
    before: Array,
    dt: float,
    tension: Array,
    temperature: Array,
    state: Array,
    yield_strain: float,
    hardening: float,
    reference: BenchPath = UNKNOWN,
) -> tuple[Array, Array]:
    stress, growth = hardening_step(state[:, 0], state[:, 1], strain - before, yield_strain, hardening)
    return stress[:, None], np.column_stack([stress, growth])


def _gradual(path: BenchPath, yield_strain: float) -> Array:
    return gradual_record(path.strain, yield_strain, np.ones(path.strain.size))


def _advance_gradual(
    strain: Array,
    before: Array,
    dt: float,
    tension: Array,
    temperature: Array,
    state: Array,
    yield_strain: float,
    reference: BenchPath = UNKNOWN,
) -> tuple[Array, Array]:
    stress = gradual_step(state, strain - before, yield_strain, np.ones(strain.size))
    return stress, stress


def _why_untestable(paths: Sequence[BenchPath]) -> str | None:
    if not any(np.ptp(p.strain) > 0.0 for p in paths if p.strain.size):
        return "the strain stands still in every record"
    return None


KINEMATIC = Form(
    "one yielding element",
    "section",
    _one,
    shape=(YIELD_STRAIN,),
    strength=(_strength("yielding stiffness", "stiffness that is lost when the metal yields, over the linear one"),),
    advance=_advance_one,
    memory=1,
    derived=(
        Derived(
            "yield limit",
            "load",
            "load that the yielding metal carries at most",
            lambda shape, a, _reference: float(a[0] * shape[0]),
        ),
    ),
)
MANY_ELEMENTS = Form(
    "gradual yield, sixteen elements",
    "section",
    _many,
    strength=tuple(
        _strength(f"yielding stiffness {x:.2g}", f"of the metal that yields at {x:.2g} times the largest strain")
        for x in YIELD_STRAINS
    ),
    advance=_advance_many,
    memory=len(YIELD_STRAINS),
    derived=(
        Derived(
            "yield limit",
            "load",
            "load that the yielding metal carries at most",
            lambda _shape, a, reference: float(a @ YIELD_STRAINS * reference.largest),
        ),
        Derived(
            "yielding stiffness",
            "1",
            "stiffness that is lost when all metal yields, over the linear one",
            lambda _shape, a, _reference: float(a.sum()),
        ),
    ),
)
ISOTROPIC = Form(
    "isotropic hardening",
    "section",
    _isotropic,
    shape=(YIELD_STRAIN, HARDENING),
    strength=(_strength("yielding stiffness", "stiffness that is lost when the metal yields, over the linear one"),),
    advance=_advance_isotropic,
    memory=2,
)
SATURATING = Form(
    "saturating hardening",
    "section",
    _gradual,
    shape=(YIELD_STRAIN,),
    strength=(_strength("yielding stiffness", "stiffness that is lost when the metal yields, over the linear one"),),
    advance=_advance_gradual,
    memory=1,
    derived=KINEMATIC.derived,
)

EFFECT = Effect(
    name="plasticity",
    kind="physics",
    title="metal yields; the limit does not depend on axial tension; permanent set",
    equation="load = K (strain + sum_j a_j s_j),  |s_j| <= x_j,  ds_j = dstrain below the limit",
    source="Besseling, J. Appl. Mech. 25 (1958) 529; Simo & Hughes, Computational Inelasticity (1998), chapter 1",
    needs="strain beyond yield and back; at least two axial tensions to tell it from interlayer-friction",
    signature="loops that depend neither on rate nor on axial tension; a strain is left at zero load",
    kinds=("tension", "torsion", "bending", "shear"),
    forms=(KINEMATIC, MANY_ELEMENTS, ISOTROPIC, SATURATING),
    why_untestable=_why_untestable,
)
