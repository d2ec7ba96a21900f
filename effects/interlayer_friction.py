r"""Interlayer friction: wires stick and slip between the layers, and the grip of the layers grows with the axial tension.

.. math::  c = s, \qquad |s| \le x\,\bigl[(1 - g) + g\,N/N_{typ}\bigr]

s is the stress of a stick-slip element (:mod:`effects.slip_element`), x its slip strain at the typical tension, g the
share of the grip that axial tension makes: the rest is the pressure of the sheath and of the lay-up. Wires slip one
after the other round the section and layer after layer, so that the loop of a real cable is that of many elements.
Source: Papailiou, IEEE Trans. Power Delivery 12 (1997) 1576-1588; Foti & Martinelli, J. Sound Vib. 374 (2016); Iwan 1966.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from effects.effect import UNKNOWN, BenchPath, Derived, Effect, Form, Parameter, of_strain, of_values
from effects.gradual_slip import gradual_record, gradual_step
from effects.loading_path import grip_ratio
from effects.slip_element import slip_record, slip_step

Array = NDArray[np.float64]

SLIP_STRAINS = np.geomspace(0.03, 3.0, 16)
"""Slip strains of the distributed form over the largest strain, at the typical tension."""

SLIP_STRAIN = Parameter(
    "slip strain",
    "strain",
    "strain at which the layers begin to slip, at the typical tension",
    plausible=(0.0, np.inf),
    source="of the layup: friction coefficient times radial pressure over the stick stiffness; no common number",
    starts=of_strain(0.01, 1.5, 14),
)
TENSION_SHARE = Parameter(
    "tension share",
    "1",
    "share of the grip that is made by axial tension; with none it would be plasticity",
    low=0.25,
    high=1.0,
    plausible=(0.25, 1.0),
    source="0 is a limit that tension does not move, 1 a layup without pressure of its own (by definition)",
    starts=of_values(0.3, 0.5, 0.7, 0.9, 1.0),
)


def _strength(name: str, meaning: str) -> Parameter:
    return Parameter(
        name,
        "1",
        meaning,
        plausible=(0.0, 10.0),
        source="stick over slip stiffness of strands 1.2 to 10 (Papailiou 1997 and the cell of this cable, as a range)",
    )


def _one(path: BenchPath, slip_strain: float, share: float) -> Array:
    return _record(path, np.array([slip_strain]), share)


def _distributed(path: BenchPath, share: float) -> Array:
    return _record(path, SLIP_STRAINS * path.largest, share)


def _record(path: BenchPath, slip_strain: Array, share: float) -> Array:
    grip = grip_ratio(path.tension, path.typical_tension, path.strain.size)
    return slip_record(path.strain, slip_strain, (1.0 - share) + share * grip)


def _advance(
    strain: Array, before: Array, tension: Array, state: Array, slip_strain: Array, share: float, reference: BenchPath
) -> tuple[Array, Array]:
    grip = grip_ratio(tension, reference.typical_tension, strain.size)
    stress = slip_step(state, strain - before, slip_strain, (1.0 - share) + share * grip)
    return stress, stress


def _advance_one(
    strain: Array,
    before: Array,
    dt: float,
    tension: Array,
    temperature: Array,
    state: Array,
    slip_strain: float,
    share: float,
    reference: BenchPath = UNKNOWN,
) -> tuple[Array, Array]:
    return _advance(strain, before, tension, state, np.array([slip_strain]), share, reference)


def _advance_distributed(
    strain: Array,
    before: Array,
    dt: float,
    tension: Array,
    temperature: Array,
    state: Array,
    share: float,
    reference: BenchPath = UNKNOWN,
) -> tuple[Array, Array]:
    return _advance(strain, before, tension, state, SLIP_STRAINS * reference.largest, share, reference)


def _gradual(path: BenchPath, slip_strain: float, share: float) -> Array:
    grip = grip_ratio(path.tension, path.typical_tension, path.strain.size)
    return gradual_record(path.strain, slip_strain, (1.0 - share) + share * grip)


def _advance_gradual(
    strain: Array,
    before: Array,
    dt: float,
    tension: Array,
    temperature: Array,
    state: Array,
    slip_strain: float,
    share: float,
    reference: BenchPath = UNKNOWN,
) -> tuple[Array, Array]:
    grip = grip_ratio(tension, reference.typical_tension, strain.size)
    stress = gradual_step(state, strain - before, slip_strain, (1.0 - share) + share * grip)
    return stress, stress


def _why_untestable(paths: Sequence[BenchPath]) -> str | None:
    if not any(np.ptp(p.strain) > 0.0 for p in paths if p.strain.size):
        return "the strain stands still in every record"
    return None


ONE_ELEMENT = Form(
    "one slip element",
    "section",
    _one,
    shape=(SLIP_STRAIN, TENSION_SHARE),
    strength=(_strength("stick stiffness", "stiffness that is lost when the layers slip, over the linear one"),),
    advance=_advance_one,
    memory=1,
    derived=(
        Derived(
            "slip limit",
            "load",
            "load of the friction when all layers slip, at the typical tension",
            lambda shape, a, _reference: float(a[0] * shape[0]),
        ),
    ),
)
DISTRIBUTED = Form(
    "distributed slip, sixteen elements",
    "section",
    _distributed,
    shape=(TENSION_SHARE,),
    strength=tuple(
        _strength(f"stick stiffness {x:.2g}", f"of the wires that slip at {x:.2g} times the largest strain")
        for x in SLIP_STRAINS
    ),
    advance=_advance_distributed,
    memory=len(SLIP_STRAINS),
    derived=(
        Derived(
            "slip limit",
            "load",
            "load of the friction when all layers slip, at the typical tension",
            lambda _shape, a, reference: float(a @ SLIP_STRAINS * reference.largest),
        ),
        Derived(
            "stick stiffness",
            "1",
            "stiffness that is lost when all layers slip, over the linear one",
            lambda _shape, a, _reference: float(a.sum()),
        ),
    ),
)
GRADUAL = Form(
    "gradual slip",
    "section",
    _gradual,
    shape=(SLIP_STRAIN, TENSION_SHARE),
    strength=(_strength("stick stiffness", "stiffness that is lost when the layers slip, over the linear one"),),
    advance=_advance_gradual,
    memory=1,
    derived=ONE_ELEMENT.derived,
)

EFFECT = Effect(
    name="interlayer-friction",
    kind="physics",
    title="stick-slip between the layers; the slip limit grows with axial tension",
    equation="load = K (strain + sum_j a_j s_j),  |s_j| <= x_j [(1 - g) + g N/N_typ],  ds_j = dstrain while it sticks",
    source="Papailiou, IEEE Trans. Power Delivery 12 (1997) 1576; Iwan, J. Appl. Mech. 33 (1966) 893",
    needs="loops (the path turns back); at least two axial tensions to tell it from plasticity, two amplitudes to size it",
    signature="loops that do not depend on rate; stiffness falls with amplitude and rises with axial tension",
    kinds=("tension", "torsion", "bending", "shear"),
    forms=(ONE_ELEMENT, DISTRIBUTED, GRADUAL),
    why_untestable=_why_untestable,
)
