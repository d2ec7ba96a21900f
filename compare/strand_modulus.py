r"""Modulus of a strand from force and crosshead travel, the slip of the grips and the stretch of the machine taken out.

The slope of force over travel alone is too low by both (:mod:`compare.strand_tensile_test`). Least squares over
(E A, u_0, s) with each form of the slip, and the simplest form whose Bayesian information criterion is within 2 of the best
(Schwarz, Ann. Statist. 6 (1978) 461). One length cannot show 1/k: it must be known, from a stiff bar in the same grips,
and its doubt goes into that of E,

.. math::  \Bigl(\frac{\delta E}{E}\Bigr)^2 = \Bigl(\frac{\delta (EA)}{EA}\Bigr)^2_{\text{fit}}
           + \Bigl(\frac{EA}{k L}\,\frac{\delta k}{k}\Bigr)^2 + \Bigl(\frac{\delta A}{A}\Bigr)^2
           + \Bigl(\frac{\delta L}{L}\Bigr)^2 .

A bend of the curve is read as slip. Where the record holds no unloading, the same bend could be the strand yielding or its
wires drawing straight: unloading is steep after slip and tells them apart.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from compare.strand_tensile_test import TensileRecord, stretch
from geometry.errors import InputError, SpecError

Array = NDArray[np.float64]
_SUDDEN = "one sudden slip"
_CLEARLY_BETTER = 2.0
_FEWEST = 6
_EXACT = 1e-9
_HIGHEST = 50.0
_BETWEEN = tuple(np.linspace(0.03, 0.93, 19))
"""Limits over the largest apparent strain at which a sudden slip is tried; between two samples all limits are one."""
FORMS = (None, _SUDDEN, "bites as it slides", "comes to an end")
"""No slip, and forms of ``grip-slip``, the fewest parameters first."""


@dataclass(frozen=True)
class StrandModulus:
    """What a tensile test says of a strand.

    Attributes
    ----------
    E, standard_error : float
        Modulus on the given area [Pa], and what fit, machine, area and length together leave in doubt.
    parts : dict of str to float
        Relative doubt by its origin: ``fit``, ``machine``, ``area``, ``length``.
    slope_modulus : float
        What the straight line through force over travel gives, with slip and frame left in [Pa].
    machine_modulus : float
        The same line with the frame taken out, slip left in [Pa].
    slip_form : str
        ``none`` or a form of the effect ``grip-slip``.
    slip : float
        Travel that the grips had lost at the end of the record [m].
    noise : float
        Root mean square residual of the force [N].
    unloaded : bool
        Whether the record holds an unloading of at least a fifth of the largest force.
    fitted : (n,) array
        Force of the fit at the samples [N].
    """

    E: float
    standard_error: float
    parts: dict[str, float]
    slope_modulus: float
    machine_modulus: float
    slip_form: str
    slip: float
    noise: float
    unloaded: bool
    fitted: Array = field(repr=False)


@dataclass(frozen=True)
class _Fit:
    """Unknowns (ln EA, start over span, ln of the slip's parameters), variance of ln EA, fitted force, rms residual, BIC."""

    form: str | None
    x: Array
    variance: float
    force: Array
    noise: float
    criterion: float


def strand_modulus(
    record: TensileRecord,
    area: float,
    *,
    machine_stiffness: float = math.inf,
    machine_error: float = 0.0,
    area_error: float = 0.0,
    length_error: float = 0.0,
) -> StrandModulus:
    """Modulus of a strand from its tensile record, slip of the grips and stretch of the machine taken out.

    Parameters
    ----------
    record : TensileRecord
    area : float
        Area that the modulus refers to [m^2]: the cylinder of the strand, or its metal; never mix them.
    machine_stiffness, machine_error : float
        Of frame, load cell and grips [N/m], infinite where the travel was measured on the strand itself; relative doubt.
    area_error, length_error : float
        Relative doubts.

    Raises
    ------
    SpecError
        If an argument is not possible.
    InputError
        If the record is too short, or no modulus fits it.

    Examples
    --------
    >>> from compare.strand_tensile_test import synthetic_record
    >>> record = synthetic_record(80e9, 7.143e-6, slip=(3e-4, 5e-4, 1e-3), machine_stiffness=50e6, noise=2.0)
    >>> found = strand_modulus(record, 7.143e-6, machine_stiffness=50e6, machine_error=0.1)
    >>> abs(found.E - 80e9) < 3 * found.standard_error, found.slope_modulus < 70e9
    (True, True)
    """
    _check(record, area, machine_stiffness, (machine_error, area_error, length_error))
    fits = [_fitted(record, None, machine_stiffness)]
    if fits[0].noise > _EXACT * float(np.abs(record.force).max()):
        fits += [_fitted(record, form, machine_stiffness) for form in FORMS[1:]]
    best = min(fit.criterion for fit in fits)
    fit = next(f for f in fits if f.criterion <= best + _CLEARLY_BETTER)
    EA, slope = math.exp(fit.x[0]), _slope(record)
    in_series = EA / (machine_stiffness * record.length)
    parts = {
        "fit": math.sqrt(fit.variance),
        "machine": in_series * machine_error,
        "area": area_error,
        "length": length_error,
    }
    return StrandModulus(
        E=EA / area,
        standard_error=EA / area * math.hypot(*parts.values()),
        parts=parts,
        slope_modulus=slope * record.length / area,
        machine_modulus=record.length / area / (1 / slope - 1 / machine_stiffness),
        slip_form=fit.form or "none",
        slip=_lost(record, fit, machine_stiffness),
        noise=fit.noise,
        unloaded=_unloaded(record.force),
        fitted=fit.force,
    )


def _check(record: TensileRecord, area: float, stiffness: float, doubts: tuple[float, ...]) -> None:
    for name, value in (("area", area), ("specimen length", record.length), ("machine stiffness", stiffness)):
        if not value > 0:
            raise SpecError(f"the {name} is {value:g}; it must be positive.")
    if any(not 0 <= doubt < 1 for doubt in doubts):
        raise SpecError(f"relative doubts must lie from 0 to 1, found {', '.join(f'{d:g}' for d in doubts)}.")
    if len(record.force) < _FEWEST:
        raise InputError(
            f"the record has {len(record.force)} samples and an evaluation takes at least {_FEWEST}: sample faster, pull "
            f"slower, or raise the force up to which it is used."
        )
    if not (np.isfinite(record.force).all() and np.isfinite(record.travel).all()):
        raise InputError("the record holds numbers that are not finite; leave those rows out.")
    if np.ptp(record.travel) == 0 or np.ptp(record.force) == 0:
        raise InputError("travel or force never changes in the record: there is nothing to take a modulus from.")
    slope = _slope(record)
    if slope <= 0:
        raise InputError(
            f"force falls as the travel grows (slope {slope:.3g} N/m): check signs and order of the columns."
        )
    if slope >= stiffness:
        raise InputError(
            f"machine and strand together show {slope:.4g} N/m, more than the machine alone ({stiffness:.4g} N/m): its "
            "stiffness is stated too low."
        )


def _slope(record: TensileRecord) -> float:
    """Of the straight line through the loading branch [N/m]."""
    top = int(np.argmax(record.force)) + 1
    if top < 3:
        top = len(record.force)
    return float(np.polyfit(record.travel[:top], record.force[:top], 1)[0])


def _unloaded(force: Array) -> bool:
    top = int(np.argmax(force))
    return bool(force[top] - force[top:].min() > 0.2 * force[top])


def _starts(record: TensileRecord, form: str | None, stiffness: float) -> list[Array]:
    """Where the search begins: shares of the travel that slip took, and where and over which strain it did."""
    span, slope, start = float(np.ptp(record.travel)), _slope(record), _begin(record)
    strain, found = span / record.length, []
    for lost in {None: (0.0,), _SUDDEN: (0.2,)}.get(form, (0.1, 0.35)):
        EA = record.length / max(1 / slope * (1 - lost) - 1 / stiffness, 0.05 / slope)
        head = np.array([math.log(EA), start / span])
        if form is None:
            found.append(head)
        limits = _BETWEEN if form == _SUDDEN else (0.05, 0.2, 0.5)
        for limit in limits if form else ():
            whole = lost * span if form != "bites as it slides" else 2 * lost * record.length
            widths = ((0.05,), (0.3,)) if form == "comes to an end" else ((),)
            tails = [np.array([whole, limit * strain, *(w * strain for w in width)]) for width in widths]
            found += [np.concatenate([head, np.log(tail)]) for tail in tails]
    return found


def _begin(record: TensileRecord) -> float:
    """Travel where the loading branch, drawn on downwards, leaves zero force [m]."""
    top = int(np.argmax(record.force)) + 1
    rising = np.maximum.accumulate(record.force[:top])
    first = int(np.searchsorted(rising, 0.02 * rising[-1]))
    return float(record.travel[max(first - 1, 0)])


def _fitted(record: TensileRecord, form: str | None, stiffness: float) -> _Fit:
    """Least squares with one form of the slip, from several starts."""
    from scipy.optimize import least_squares  # slow to load, needed here only

    span, scale = float(np.ptp(record.travel)), float(np.abs(record.force).max())

    def force(x: Array) -> Array:
        EA, slip = math.exp(min(x[0], _HIGHEST)), tuple(float(v) for v in np.exp(np.clip(x[2:], -_HIGHEST, _HIGHEST)))
        return EA * stretch(record.travel, x[1] * span, record.length + EA / stiffness, form, slip)

    def misfit(x: Array) -> Array:
        return (force(x) - record.force) / scale

    runs = []
    for x in _starts(record, form, stiffness):
        runs.append(least_squares(misfit, x, method="lm", max_nfev=30 * len(x)))
    best = min(runs, key=lambda run: run.cost)
    n, unknowns = len(record.force), len(best.x)
    squares = max(2 * best.cost, n * 1e-24)
    covariance = np.linalg.pinv(best.jac.T @ best.jac) * squares / max(n - unknowns, 1)
    return _Fit(
        form=form,
        x=best.x,
        variance=float(max(covariance[0, 0], 0.0)),
        force=force(best.x),
        noise=scale * math.sqrt(squares / n),
        criterion=n * math.log(squares / n) + unknowns * math.log(n) if n > unknowns else math.inf,
    )


def _lost(record: TensileRecord, fit: _Fit, stiffness: float) -> float:
    """Slip of the grips at the largest force [m]."""
    if fit.form is None:
        return 0.0
    EA, span = math.exp(fit.x[0]), float(np.ptp(record.travel))
    length = record.length + EA / stiffness
    top = int(np.argmax(fit.force))
    return float(max(record.travel[top] - fit.x[1] * span, 0.0) - length * fit.force[top] / EA)
