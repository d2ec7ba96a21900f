r"""Tensile test of a strand between two grips: the record, and what such a test would give for a strand of known modulus.

The travel u of the crosshead is shared by the strand, the machine and the grips, which all carry the same force F,

.. math::  u - u_0 = \frac{F L}{E A} + \frac{F}{k} + s(F_{\max}),

L the length between the grips, A the area that E refers to, k the stiffness of frame, load cell and grips, s the slip of
the grips as in :mod:`effects.grip_slip`, which does not come back on unloading; u_0 is where the strand is just straight.

The published test (Ge et al., PLoS ONE 18(2) e0281136, 2023: 100 mm between grips, 100 mm/min, a sample each 0.032 s, slip
in the grips noted, 80 GPa for the power and 70 GPa for the control strand) shows no curve that could be read here. What
:func:`synthetic_record` makes tests the evaluation (:mod:`compare.strand_modulus`); it is no measurement.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from effects.effect import BenchPath, Form
from effects.library import find

Array = NDArray[np.float64]
LENGTH, SPEED, INTERVAL = 0.1, 0.1 / 60, 0.032
"""Of the published test: between the grips [m], of the crosshead [m/s], between samples [s]."""


@dataclass(frozen=True)
class TensileRecord:
    """Travel of the crosshead [m] and force [N], both (n,), of a strand with `length` [m] between the grips."""

    travel: Array = field(repr=False)
    force: Array = field(repr=False)
    length: float

    def until(self, force: float) -> TensileRecord:
        """The record before the first sample above that force [N]: what is left out is taken as beyond the elastic range."""
        above = np.flatnonzero(self.force > force)
        last = int(above[0]) if above.size else len(self.force)
        return TensileRecord(self.travel[:last], self.force[:last], self.length)


@lru_cache(maxsize=1)
def slip_forms() -> dict[str, Form]:
    """Forms of the effect ``grip-slip`` by their names."""
    return {form.name: form for form in find("grip-slip").forms}


def stretch(travel: Array, start: float, length: float, form: str | None = None, slip: tuple[float, ...] = ()) -> Array:
    """Strain of the strand (n,), not below zero, for a strand does not push.

    Parameters
    ----------
    travel : (n,) array
        Of the crosshead [m].
    start : float
        Travel at which the strand is straight [m].
    length : float
        L + E A / k: strand, and the length of strand as compliant as the machine [m].
    form, slip : str or None, tuple of float
        Form of ``grip-slip`` and its parameters.
    """
    path = BenchPath("tension", np.maximum(travel - start, 0.0) / length, length=length)
    return np.maximum(path.strain if form is None else slip_forms()[form].respond(path, *slip), 0.0)


def synthetic_record(
    E: float,
    area: float,
    *,
    length: float = LENGTH,
    speed: float = SPEED,
    interval: float = INTERVAL,
    largest: float = 8e-3,
    machine_stiffness: float = math.inf,
    slip: tuple[float, ...] = (),
    form: str = "comes to an end",
    noise: float = 0.0,
    start: float = 0.0,
    unload: bool = True,
    seed: int = 0,
) -> TensileRecord:
    """A record as a tensile test of an elastic strand would give it; no measurement.

    Parameters
    ----------
    E, area : float
        True modulus [Pa] on the area [m^2].
    length, speed, interval : float
        Between the grips [m], of the crosshead [m/s], between samples [s].
    largest : float
        Largest travel over length.
    machine_stiffness : float
        [N/m].
    slip : tuple of float
        Parameters of the form of ``grip-slip``: (slip [m], limit [strain], width [strain]) of "comes to an end".
    noise : float
        Standard deviation of the force [N].
    start : float
        Travel at which the strand is straight [m].
    unload : bool
        Whether the crosshead comes back to its start.

    Examples
    --------
    >>> record = synthetic_record(80e9, 7.143e-6, unload=False)
    >>> len(record.force), f"{record.travel[1] / record.length:.2e}"
    (16, '5.33e-04')
    """
    step = speed * interval
    up = np.arange(0.0, largest * length + 1e-9 * step, step)
    travel = np.concatenate([up, up[-2::-1]]) if unload else up
    strain = stretch(travel, start, length + E * area / machine_stiffness, form if slip else None, slip)
    scatter = np.random.default_rng(seed).normal(0.0, 1.0, len(travel))
    return TensileRecord(travel, E * area * strain + noise * scatter, length)
