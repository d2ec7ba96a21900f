"""Model beside measurement: noise, calibration, and then per experiment and channel what the model misses.

The order is fixed: the noise is learnt from repeats without any model, the linear stiffness that each kind of
experiment sees is calibrated on the set *calibrate*, and only then is anything called a misfit. Readings of the model
are called model, never measurement.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from compare.bench_model import BenchModel
from compare.calibration import Calibration
from compare.campaign import Campaign
from compare.experiment import Experiment
from compare.lack_of_fit import LackOfFit, lack_of_fit
from compare.misfit import Misfit, bias_uncertainty, misfit
from compare.noise_floor import NoiseModel, measure_noise
from compare.towing_setup import modelled

Array = NDArray[np.float64]
Progress = Callable[[float, str], None]
_SIGNIFICANT = 0.01


@dataclass(frozen=True)
class ChannelFit:
    """One measured channel of one experiment beside the model, SI.

    Attributes
    ----------
    measured, nominal, model : (n,) arrays
        Measurement, model with the nominal stiffness, model with the calibrated stiffness.
    noise_floor : float
        Root mean square that the noise of this record alone is expected to have.
    before, after : Misfit
        Of the nominal and of the calibrated model.
    bias_uncertainty : float
        Up to this size a bias cannot be told from noise.
    """

    experiment: Experiment
    channel: str
    measured: Array = field(repr=False)
    nominal: Array = field(repr=False)
    model: Array = field(repr=False)
    noise_floor: float
    before: Misfit
    after: Misfit
    bias_uncertainty: float

    @property
    def unit(self) -> str:
        """SI unit of the channel."""
        return self.experiment.record.channels[self.channel].unit

    @property
    def relative_excess(self) -> float:
        """Excess of the calibrated model over the noise floor."""
        return self.after.excess / self.noise_floor


@dataclass(frozen=True)
class NotCompared:
    """A measured channel that no model of this command can predict; its noise floor is known all the same."""

    experiment: Experiment
    channel: str
    noise_floor: float


@dataclass(frozen=True)
class Comparison:
    """What :func:`compare` found; :meth:`rows` is a table of it, :meth:`record` the JSON."""

    campaign: Campaign
    nominal: BenchModel
    calibration: Calibration
    noise: NoiseModel
    fits: tuple[ChannelFit, ...]
    not_compared: tuple[NotCompared, ...]
    lack_of_fit: Mapping[tuple[str, str], LackOfFit]
    notes: tuple[str, ...]

    @property
    def model(self) -> BenchModel:
        """The calibrated model."""
        return self.calibration.model

    def relative_error(self, set_name: str, before: bool = False) -> float | None:
        """Rms residual of a set over its noise floor, 1 being as good as the data allow; None if the set is empty."""
        fits = [fit for fit in self.fits if fit.experiment.set == set_name]
        if not fits:
            return None
        n = np.array([len(fit.measured) for fit in fits], dtype=float)
        ratio = np.array([(fit.before if before else fit.after).rmse / fit.noise_floor for fit in fits])
        return float(np.sqrt(np.sum(n * ratio**2) / n.sum()))

    def where_it_fails(self) -> tuple[ChannelFit, ...]:
        """Channels with an excess that noise does not explain (chance below 1 % shared among all), worst first."""
        threshold = _SIGNIFICANT / max(len(self.fits), 1)
        failing = (f for f in self.fits if f.after.chance < threshold and f.after.excess > 0)
        return tuple(sorted(failing, key=lambda f: -f.relative_excess))

    def rows(self) -> list[dict[str, Any]]:
        """One dictionary per experiment and channel, ready for a table or a data frame; keys as in the JSON."""
        from compare.comparison_record import comparison_rows

        return comparison_rows(self)

    def record(self) -> dict[str, Any]:
        """JSON of ``helicable compare``: finite numbers only, null with a reason in the notes."""
        from compare.comparison_record import comparison_record

        return comparison_record(self)

    def headline(self) -> str:
        """One sentence: how far the calibrated model is from the data, and where it fails most."""
        if not self.fits:
            return "No experiment of this campaign could be compared."
        n = len({fit.experiment.id for fit in self.fits})
        size = self.relative_error("calibrate")
        other = self.relative_error("validate")
        errors = [
            f"{v:.3g} x the noise floor on {s}" for s, v in (("calibrate", size), ("validate", other)) if v is not None
        ]
        failing = self.where_it_fails()
        if not failing:
            return f"{n} experiments, {', '.join(errors)}: {self._verdict_without_failures()}"
        worst = "; ".join(
            f"{f.experiment.id} {f.channel} (excess {f.relative_excess:.3g} x floor)" for f in failing[:3]
        )
        return (
            f"{n} experiments, {', '.join(errors)}. Fails in {len(failing)} of {len(self.fits)} "
            f"channels, most in {worst}."
        )

    def _verdict_without_failures(self) -> str:
        unfit = [(key, test) for key, test in self.lack_of_fit.items() if test.p < _SIGNIFICANT / len(self.lack_of_fit)]
        if not unfit:
            return "the residual is within the noise."
        (kind, channel), test = min(unfit, key=lambda item: item[1].p)
        return (
            f"no single record stands out of its noise, but the means of the repeats do: {channel} in {kind} "
            f"lacks fit with F = {test.F:.3g} (p = {test.p:.1g})."
        )


def compare(model: BenchModel, campaign: Campaign, progress: Progress | None = None) -> Comparison:
    """Run a bench model on every experiment of a campaign, calibrate its linear stiffness, and report the misfit.

    Parameters
    ----------
    model : BenchModel
        With nominal stiffness.
    campaign : Campaign
        Sealed experiments are left alone, unless the campaign was opened.
    progress : callable, optional
        Called with a fraction 0..1 and a sentence.

    Raises
    ------
    SpecError
        If the section lacks a stiffness that an experiment needs.
    ConvergenceError
        If the calibration does not come to rest.
    """
    report = progress or (lambda _fraction, _sentence: None)
    campaign, aside = modelled(campaign) if model.towing else (campaign, ())
    report(0.0, "learning the noise from repeats")
    noise = measure_noise(campaign)
    bench = [e for e in campaign.readable if model.covers(e)]
    report(0.3, "calibrating the linear stiffness")
    from compare.effect_calibration import calibrate_model

    calibration = calibrate_model(model, [e for e in bench if e.set == "calibrate"], noise)
    report(0.8, "comparing every experiment")
    fits = [fit for e in bench for fit in _fit_experiment(e, model, calibration.model, noise, bench)]
    gaps = [
        NotCompared(e, channel, noise.of(e, channel).floor(e.record[channel]))
        for e in campaign.readable
        if not model.covers(e)
        for channel in e.record.measured
    ]
    tests = _lack_of_fit(fits, noise, calibration)
    notes = (
        *noise.notes,
        *calibration.notes,
        *aside,
        *(model.towing.notes if model.towing else ()),
        *_notes(campaign, bench, gaps),
    )
    report(1.0, "compared")
    return Comparison(campaign, model, calibration, noise, tuple(fits), tuple(gaps), tests, notes)


def compare_calibrated(comparison: Comparison, campaign: Campaign) -> Comparison:
    """The models and the noise of a comparison, held as they are, beside the experiments of a campaign.

    Parameters
    ----------
    comparison : Comparison
        Whose calibration is used; nothing is fitted.
    campaign : Campaign
        May have sealed experiments that were opened since.
    """
    model, noise = comparison.nominal, comparison.noise
    bench = [
        e
        for e in campaign.readable
        if model.covers(e) and all((e.kind, c) in noise.by_channel for c in e.record.measured)
    ]
    fits = tuple(fit for e in bench for fit in _fit_experiment(e, model, comparison.model, noise, bench))
    return replace(
        comparison, campaign=campaign, fits=fits, lack_of_fit=_lack_of_fit(fits, noise, comparison.calibration)
    )


def _fit_experiment(
    experiment: Experiment,
    nominal: BenchModel,
    calibrated: BenchModel,
    noise: NoiseModel,
    chain: Sequence[Experiment] = (),
) -> list[ChannelFit]:
    before, after = nominal.linear.predict(experiment), calibrated.predict(experiment, chain)
    fits = []
    for channel in experiment.record.measured:
        y, covariance = experiment.record[channel], noise.of(experiment, channel)
        fits.append(
            ChannelFit(
                experiment,
                channel,
                y,
                before[channel],
                after[channel],
                covariance.floor(y),
                misfit(y, before[channel], covariance),
                misfit(y, after[channel], covariance),
                bias_uncertainty(y, covariance),
            )
        )
    return fits


def _lack_of_fit(
    fits: Sequence[ChannelFit], noise: NoiseModel, calibration: Calibration
) -> dict[tuple[str, str], LackOfFit]:
    """Lack of fit on the set that was calibrated on, by kind and channel; all free stiffnesses counted in each."""
    tests = {}
    for (kind, channel), covariance in noise.by_channel.items():
        repeats = [r for r in noise.repeats if r.experiments[0].kind == kind and channel in r.channels]
        repeats = [r for r in repeats if all(e.set == "calibrate" for e in r.experiments)]
        predicted = {f.experiment.id: f.model for f in fits if f.experiment.kind == kind and f.channel == channel}
        if not predicted or covariance.assumed:
            continue
        test = lack_of_fit(repeats, channel, predicted, covariance, calibration.free)
        if test is not None:
            tests[kind, channel] = test
    return tests


def _notes(campaign: Campaign, bench: Sequence[Experiment], gaps: Sequence[NotCompared]) -> list[str]:
    notes = []
    sealed = [e.id for e in campaign.experiments if not e.is_open]
    if sealed:
        notes.append(f"sealed, not read: {', '.join(sealed)}.")
    if campaign.sealed_opened:
        notes.append(
            "sealed experiments were opened: "
            f"{', '.join(e.id for e in campaign.of_set('sealed'))}; none was used to learn the noise or to calibrate."
        )
    towed = list(dict.fromkeys(gap.experiment.id for gap in gaps))
    if towed:
        notes.append(
            f"not compared, because a bench model cannot tow: {', '.join(towed)}; rmse, bias and "
            "excess are null, the noise floor is given."
        )
    calibrated = {e.kind for e in bench if e.set == "calibrate"}
    for kind in dict.fromkeys(e.kind for e in bench):
        if kind not in calibrated:
            notes.append(f"no open {kind} experiment is in the set calibrate: its stiffness is the nominal one.")
    return notes
