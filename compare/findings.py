"""What `explain` found: the verdict, the effects, why not the others, and how the error fell.

Plain data, filled by :mod:`compare.explain` and read by reports, notebooks and scripts. The five verdicts and the keys of
:meth:`Findings.record` are those of the campaign contract, schema version 1.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from compare.bench_model import BenchModel
from compare.calibration import ParameterValue
from compare.campaign import Campaign
from compare.comparison import Comparison
from compare.noise_floor import NoiseModel

Array = NDArray[np.float64]
Verdict = Literal["none", "identified", "family-identified", "confusable", "unknown"]


@dataclass(frozen=True)
class Candidate:
    """One effect, tried on these data beside the base model alone.

    Attributes
    ----------
    effect, kind, form : str
        Name, physics / rig / sensor, and the form that was used.
    log_e : float
        Natural logarithm of the e-value against the base model; `needed` is the gate that it has to pass.
    share : float
        Part of the excess over noise that it removes on experiments left out of the fit, at most 1.
    behind : float
        By how many nats its held-out score is behind the best candidate; 0 for the best.
    parameters : mapping of str to ParameterValue
        By name, with the kind of experiment added where there are several.
    positive_folds, folds : int
        In how many of the left-out conditions it did better than the base.
    note : str
        Why it is not the one, or what is doubtful about it.
    """

    effect: str
    kind: str
    form: str
    log_e: float
    needed: float
    share: float
    behind: float
    parameters: Mapping[str, ParameterValue]
    positive_folds: int = 0
    folds: int = 0
    note: str = ""


@dataclass(frozen=True)
class Untestable:
    """An effect that these data cannot show, and why."""

    effect: str
    why: str


@dataclass(frozen=True)
class Separation:
    """How well these experiments can tell effects apart, before any verdict.

    Attributes
    ----------
    effects : tuple of str
        The testable ones.
    distance : (m,) array
        D of each at its smallest size of interest, from the refitted base, in units of the noise.
    size : tuple of str
        That smallest size in words.
    confusion : (m, m) array
        Probability of taking row for column, Phi(-D_ij / 2), the rival refitted; 0.5 on the diagonal.
    confounded : tuple of str
        Sentences on covariates that vary together.
    """

    effects: tuple[str, ...]
    distance: Array = field(repr=False)
    size: tuple[str, ...]
    confusion: Array = field(repr=False)
    confounded: tuple[str, ...] = ()


@dataclass(frozen=True)
class Check:
    """What can be said about a campaign before any effect is looked for: ``compare.testability.check``.

    Attributes
    ----------
    campaign : Campaign
        As it was read; sealed experiments are not in it.
    noise : NoiseModel
        Covariance of every channel, and what it was learnt from.
    noise_notes : tuple of str
        Sentences on noise that had to be assumed and on repeats that could not be used.
    separation : Separation
        Of the testable effects from the base and from each other.
    untestable : tuple of Untestable
        What these experiments cannot show, and why.
    smallest_seen : mapping of str to str
        Per testable effect the smallest size that these data would show.
    """

    campaign: Campaign = field(repr=False)
    noise: NoiseModel = field(repr=False)
    noise_notes: tuple[str, ...]
    separation: Separation
    untestable: tuple[Untestable, ...]
    smallest_seen: Mapping[str, str]
    notes: tuple[str, ...]

    def record(self) -> dict[str, Any]:
        """JSON of ``helicable check``."""
        from compare.findings_record import check_record

        return check_record(self)


@dataclass(frozen=True)
class Step:
    """One step of the path from the base model to the accepted one."""

    added: str
    form: str
    log_e: float
    error: float
    """rms residual over the noise floor of the calibration set, after the step."""
    share: float
    note: str = ""


@dataclass(frozen=True)
class SetError:
    """rms residual over the noise floor of one set, and the ratio of the excess after / before with its interval.

    `ratio` is None where nothing was added or no excess was there before; `baselines` holds the same error for other
    ways to mend the model (Gaussian-process patch, refit of the old model).
    """

    before: float
    after: float
    floor: float = 1.0
    ratio: float | None = None
    ratio_low: float | None = None
    ratio_high: float | None = None
    baselines: Mapping[str, float] = field(default_factory=dict)
    confirmed: bool | None = None


@dataclass(frozen=True)
class Place:
    """One channel of one experiment where the base model fails: `excess` and `after` over its noise floor."""

    experiment: str
    channel: str
    excess: float
    after: float = 0.0


@dataclass(frozen=True)
class Mark:
    """One signature found in the residual of the base model: a sentence, the number behind it, and how it was computed."""

    name: str
    sentence: str
    value: float
    std: float
    computed: str


@dataclass(frozen=True)
class NextExperiment:
    """The experiment that best separates the rivals."""

    kind: str
    conditions: Mapping[str, float]
    separates: tuple[str, ...]
    p_wrong_before: float
    p_wrong_after: float
    p_wrong_repeat: float | None = None
    sentence: str = ""


@dataclass(frozen=True)
class Findings:
    """Everything that `explain` has to say about a campaign.

    Attributes
    ----------
    comparison, after : Comparison
        Of the base model and of the model with the accepted effects (the same as `comparison` if there are none).
    model : BenchModel
        With the accepted effects switched on and everything recalibrated: a usable forward model.
    verdict : Verdict
        One of the five words.
    effects, confusable : tuple of str
        Accepted effects in the order in which they were added; a set that cannot be told apart.
    closest : (str, float) or None
        For ``unknown``: the nearest effect and the share that it removes.
    ranking : tuple of Candidate
        Best first, against the base model.
    smallest_seen : mapping of str to str
        Per testable effect the smallest size that these data would have shown.
    errors : mapping of str to SetError
        ``calibrate``, ``validate`` and, once opened, ``sealed``.
    noise_assumed : bool
        No repeats measured the noise; the best tier is then ``family-identified``.
    """

    comparison: Comparison = field(repr=False)
    after: Comparison = field(repr=False)
    model: BenchModel = field(repr=False)
    verdict: Verdict
    effects: tuple[str, ...]
    confusable: tuple[str, ...]
    closest: tuple[str, float] | None
    ranking: tuple[Candidate, ...]
    untestable: tuple[Untestable, ...]
    separation: Separation
    smallest_seen: Mapping[str, str]
    path: tuple[Step, ...]
    errors: Mapping[str, SetError]
    where: tuple[Place, ...]
    marks: tuple[Mark, ...]
    next_experiment: NextExperiment | None
    notes: tuple[str, ...]
    noise_assumed: bool = False
    sealed_opened: bool = False
    seconds: float = 0.0

    def record(self) -> dict[str, Any]:
        """JSON of ``helicable explain``, schema 1 of the campaign contract."""
        from compare.findings_record import findings_record

        return findings_record(self)

    def headline(self) -> str:
        """The verdict in one sentence."""
        from compare.findings_record import headline

        return headline(self)
