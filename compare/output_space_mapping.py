r"""Output space mapping: the reduced model that was calibrated, corrected by what the full model says at the optimum.

With the tensions y of the records, c(theta) of the axial chain and r(theta) of the full rod, and theta_0 fitted with the chain,

.. math::

    d_k = r(\theta_k) - c(\theta_k), \qquad
    \theta_{k+1} = \arg\min_\theta \lVert y - c(\theta) - d_k \rVert^2_{C^{-1}}

so that one run of the rod for every distinctly led record takes the place of a fit with the rod: at theta_k the corrected chain is
the rod, only its slopes are the chain's. A second round is done where the first moved a parameter by more than a tenth
of its standard deviation. Friction coefficient and strengths move, shapes (a play, a fall speed) stay.

Sources: J. W. Bandler et al., IEEE Trans. Microw. Theory Tech. 52 (2004) 337, doi 10.1109/TMTT.2003.820904 (output space
mapping); M. C. Kennedy, A. O'Hagan, J. R. Stat. Soc. B 63 (2001) 425, doi 10.1111/1467-9868.00294 (additive discrepancy).
"""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from compare.chain_refit import SETS, ChainFit, Differences, FullModel, Progress
from compare.comparison import Comparison
from compare.findings_sentences import listed, uncertain
from compare.towed_rod import Section, rod_tensions

Array = NDArray[np.float64]
MATTERS = 0.1  # of a standard deviation, from which a second round is done
_MOST_ROUNDS = 2


@dataclass(frozen=True)
class RecordDifference:
    """Full rod less chain in one channel of the records that were led alike: [N], and in noise floors of the channel."""

    experiments: tuple[str, ...]
    channel: str
    largest: float
    rms: float
    floor: float
    time: Array = field(repr=False)
    difference: Array = field(repr=False)

    @property
    def in_floors(self) -> float:
        """Root mean square over the noise floor."""
        return self.rms / self.floor


@dataclass(frozen=True)
class MovedParameter:
    """A parameter as it was found with the chain, and with the corrected chain; `std` is that of the fit."""

    name: str
    unit: str
    before: float
    after: float
    std: float

    @property
    def sigmas(self) -> float:
        """How far it moved, in standard deviations."""
        return (self.after - self.before) / self.std if self.std > 0 else 0.0


@dataclass(frozen=True)
class RodCorrection:
    """What the full rod says about a fit with the chain.

    Attributes
    ----------
    records : tuple of RecordDifference
        At the parameters of the last round, largest part of the noise first.
    parameters : tuple of MovedParameter
    errors : mapping of str to (float, float)
        Error over the noise floor by set, with the chain and with the corrected chain.
    rounds : int
    notes : tuple of str
        What the rod does not carry, what was taken, records whose run stopped.
    seconds : float
        Processor time.
    """

    records: tuple[RecordDifference, ...]
    parameters: tuple[MovedParameter, ...]
    errors: Mapping[str, tuple[float, float]]
    rounds: int
    notes: tuple[str, ...]
    seconds: float

    @property
    def sentence(self) -> str:
        """How far the rod is from the chain, and what that does to the parameters."""
        worst = self.records[0]
        led = len({r.experiments for r in self.records})
        head = (
            f"The full rod, run for {led} distinctly led record(s), differs from the chain by at most "
            f"{max(r.largest for r in self.records):.3g} N, rms {worst.rms:.3g} N = {worst.in_floors:.2g} noise floors in "
            f"{worst.experiments[0]} ({worst.channel})"
        )
        moved = [p for p in self.parameters if abs(p.sigmas) > MATTERS]
        if not moved:
            return f"{head}; no parameter moves by more than {MATTERS:g} of its standard deviation."
        words = [
            f"{p.name} {p.before:.4g} -> {uncertain(p.after, p.std, p.unit)} ({p.sigmas:+.1f} sigma)" for p in moved
        ]
        return f"{head}; corrected by it: {listed(words)}."

    def record(self) -> dict[str, Any]:
        """The same as plain numbers, for JSON."""
        return {
            "sentence": self.sentence,
            "rounds": self.rounds,
            "seconds": self.seconds,
            "records": [
                {
                    "experiments": list(r.experiments), "channel": r.channel, "largest": r.largest, "rms": r.rms,
                    "noise_floor": r.floor, "rms_over_floor": r.in_floors,
                }
                for r in self.records
            ],
            "parameters": [
                {"name": p.name, "unit": p.unit, "before": p.before, "after": p.after, "std": p.std, "sigmas": p.sigmas}
                for p in self.parameters
            ],
            "error": {name: {"chain": e[0], "corrected": e[1]} for name, e in self.errors.items()},
            "notes": list(self.notes),
        }  # fmt: skip


def corrected_by_rod(
    comparison: Comparison, progress: Progress | None = None, full: FullModel | None = None
) -> RodCorrection:
    """Run every distinctly led towing record once in the full rod at what was found, and fit again with the difference.

    Parameters
    ----------
    comparison : Comparison
        Of the calibrated model, with effects or without: ``findings.after`` or what :func:`compare.compare` returns. Only its
        sets calibrate and validate are looked at.
    progress : callable, optional
        Called with a fraction 0..1 and a sentence.
    full : callable, optional
        Another full model in the place of the rod.

    Raises
    ------
    InputError
        If the campaign has no towing record in the set calibrate.
    ConvergenceError
        If the rod came to the end of no record, or the chain of none.
    """
    begin, tell = time.process_time(), progress or (lambda _fraction, _sentence: None)
    fit = ChainFit.of(comparison)
    section = Section.of(comparison.model.section, fit.setup.EA)
    run = full or (lambda cable, stations, told: rod_tensions(cable, section, stations, progress=told))
    notes = [section.note] if section.note and full is None else []
    found = fit.start
    base = theta = fit.fitted(found, {})
    rounds, moved, differences = 0, np.zeros(len(found)), {}
    while rounds < _MOST_ROUNDS:
        differences, said = fit.differences(theta, run, lambda f, s, k=rounds: tell((k + f) / _MOST_ROUNDS, s))
        notes += [s for s in said if s not in notes]
        if rounds == 0 and len(differences) < len(fit.led):  # what could not be run is left out of both fits
            base = fit.fitted(found, {key: {} for key in differences})
        last, theta = theta, fit.fitted(base, differences)
        moved, rounds = theta - base, rounds + 1
        if (np.abs(theta - last) <= MATTERS * fit.std).all():
            break
    tell(1.0, "corrected by the full rod")
    after = found + moved
    return RodCorrection(
        tuple(sorted(_rows(fit, differences), key=lambda r: -r.in_floors)),
        _moved(fit, found, after),
        {name: e for name in SETS if (e := fit.errors(name, found, after, differences)) is not None},
        rounds,
        tuple(notes),
        time.process_time() - begin,
    )


def _rows(fit: ChainFit, differences: Differences) -> list[RecordDifference]:
    """One row for every channel of every distinctly led record."""
    found = []
    for key, by_channel in differences.items():
        members = fit.led[key]
        record, ids = members[0].record, tuple(e.id for e in members)
        assert record.time is not None
        for c, d in by_channel.items():
            floor = fit.noise.of(members[0], c).floor(record[c])
            rms, largest = float(np.sqrt(np.mean(d**2))), float(np.abs(d).max())
            found.append(RecordDifference(ids, c, largest, rms, floor, record.time - record.time[0], d))
    return found


def _moved(fit: ChainFit, found: Array, after: Array) -> tuple[MovedParameter, ...]:
    """Every parameter before and after; the friction coefficient is a ratio in the fit."""
    size = np.array([fit.friction, *np.ones(len(found) - 1)])
    rows = zip(fit.names, found * size, after * size, fit.std * size, strict=True)
    return tuple(MovedParameter(n, u, float(b), float(a), float(s)) for (n, u), b, a, s in rows)
