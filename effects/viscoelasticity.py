r"""Viscoelasticity: stress fades while the strain stands still (Maxwell branches beside the linear spring).

.. math::  c_j = q_j, \qquad \dot q_j = \dot\varepsilon - q_j/\tau_j

Relaxation modulus K (1 + sum_j a_j exp(-t/tau_j)), a Prony series: K is the long-term stiffness. With many times spread
evenly in the logarithm and strengths of one sign it can be any fading relaxation, a power law among them.
Source: Maxwell 1867; Tschoegl, The Phenomenological Theory of Linear Viscoelastic Behavior (1989).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from effects.effect import UNKNOWN, BenchPath, Effect, Form, Parameter, of_time
from effects.maxwell_branch import maxwell_record, maxwell_step

Array = NDArray[np.float64]

BRANCHES = 10
RATIO = 3.5
"""Number of branches of the spectrum, and the ratio of one relaxation time to the next: close to five decades in all."""

_TAU_SOURCE = "rubber relaxes on every time scale from milliseconds to months (general knowledge)"


def _longest(paths: Sequence[BenchPath]) -> Array:
    """One value only: twice the longest record, beyond which a branch is a spring."""
    return of_time(2, 0.5, 2.0)(paths)[-1:]


def _between_the_rates(paths: Sequence[BenchPath]) -> Array:
    """From half the time scale of the fastest loading, below which a branch is a dashpot, to twice the longest record."""
    scales = [
        float(np.abs(p.strain).max() / max(np.abs(np.diff(p.strain) / np.diff(p.time)).max(), 1e-300))
        for p in paths
        if p.time is not None and len(p.time) > 2 and np.abs(p.strain).max() > 0
    ]
    longest = _longest(paths)[0]
    shortest = min(scales) if scales else longest / 1e4
    return np.geomspace(min(0.5 * shortest, longest / 10), longest, 14)


RELAXATION_TIME = Parameter(
    "relaxation time",
    "s",
    "time in which the stress of the branch falls to 1/e",
    low=1e-6,
    plausible=(1e-3, 1e7),
    source=_TAU_SOURCE,
    starts=_between_the_rates,
)
LONGEST_TIME = Parameter(
    "longest relaxation time",
    "s",
    "of the spectrum; twice the longest record",
    low=1e-6,
    plausible=(1e-6, 1e9),
    source=_TAU_SOURCE,
    starts=_longest,
)


def _strength(name: str, meaning: str) -> Parameter:
    return Parameter(
        name,
        "1",
        meaning,
        plausible=(0.0, 10.0),
        source="short- over long-term stiffness of filled rubbers 1.1 to 10 (general knowledge)",
    )


def _record(path: BenchPath, tau: Array) -> Array:
    if path.time is None:
        return np.zeros((path.strain.size, tau.size))
    return maxwell_record(path.strain, path.time, tau)


def _one(path: BenchPath, tau: float) -> Array:
    return _record(path, np.array([tau]))


def _times(longest: float) -> Array:
    """Relaxation times of the spectrum, the fastest first."""
    return longest * RATIO ** np.arange(1.0 - BRANCHES, 1.0)


def _spectrum(path: BenchPath, longest: float) -> Array:
    return _record(path, _times(longest))


def _advance_one(
    strain: Array,
    before: Array,
    dt: float,
    tension: Array,
    temperature: Array,
    state: Array,
    tau: float,
    reference: BenchPath = UNKNOWN,
) -> tuple[Array, Array]:
    stress = maxwell_step(state, strain - before, dt, np.array([tau]))
    return stress, stress


def _advance_spectrum(
    strain: Array,
    before: Array,
    dt: float,
    tension: Array,
    temperature: Array,
    state: Array,
    longest: float,
    reference: BenchPath = UNKNOWN,
) -> tuple[Array, Array]:
    stress = maxwell_step(state, strain - before, dt, _times(longest))
    return stress, stress


def _why_untestable(paths: Sequence[BenchPath]) -> str | None:
    if all(p.time is None for p in paths):
        return "no record has a clock, so that no relaxation can be timed"
    return None


ONE_BRANCH = Form(
    "one Maxwell branch",
    "section",
    _one,
    shape=(RELAXATION_TIME,),
    strength=(_strength("fading stiffness", "stiffness that relaxes, over the long-term one"),),
    advance=_advance_one,
    memory=1,
)
SPECTRUM = Form(
    "spectrum of ten Maxwell branches",
    "section",
    _spectrum,
    shape=(LONGEST_TIME,),
    strength=tuple(
        _strength(f"fading stiffness {i + 1}", f"of branch {i + 1} from the fastest, over the long-term one")
        for i in range(BRANCHES)
    ),
    advance=_advance_spectrum,
    memory=BRANCHES,
)

EFFECT = Effect(
    name="viscoelasticity",
    kind="physics",
    title="relaxation: stress fades at constant strain (Maxwell, Prony)",
    equation="load = K (strain + sum_j a_j q_j),  dq_j/dt = dstrain/dt - q_j/tau_j",
    source="Maxwell 1867; Tschoegl, The Phenomenological Theory of Linear Viscoelastic Behavior (1989)",
    needs="a clock; a hold, or at least two rates independent of the amplitude",
    signature="stiffness rises with rate, loop energy has its peak where rate times relaxation time is 1; holds fade",
    kinds=("tension", "torsion", "bending", "shear"),
    forms=(ONE_BRANCH, SPECTRUM),
    why_untestable=_why_untestable,
)
