"""From a campaign to the named effect: `explain`, and the sealed data that are opened once, after the model is fixed.

The order is fixed: noise, calibration of the linear model, what is testable, the search on the set *calibrate*, the verdict,
the recalibrated model, and then its error on *validate*, which no parameter was fitted to. The sealed experiments are read
by :func:`open_and_validate` alone.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from compare.bench_design import make_blocks
from compare.bench_model import BenchModel
from compare.campaign import Campaign
from compare.comparison import Comparison, compare, compare_calibrated
from compare.effect_calibration import calibration_of, parameters_of
from compare.findings import Candidate, Findings, NextExperiment, Place, SetError, Step, Verdict
from compare.fit_store import FitStore
from compare.gaussian_process_patch import patch_error, refit_error
from compare.localisation import marks
from compare.next_experiment import separating_experiment
from compare.rivals import TIE, tied
from compare.search import Attempt, Progress, Stage
from compare.section_finding import section_findings, with_expectations
from compare.testability import testability, worth_trying
from compare.thinning import thinned
from compare.towing_setup import modelled
from compare.validation import set_error
from compare.verdict import Outcome, decide
from effects.effect import Effect
from effects.library import library as whole_library
from effects.library import library_notes
from geometry.errors import InputError

_WITH_PARAMETERS = 5


def explain(
    model: BenchModel,
    campaign: Campaign,
    progress: Progress | None = None,
    library: Sequence[Effect] | None = None,
    store: str | Path | None = None,
) -> Findings:
    """Find the physics that the linear model misses, and prove it on data that it did not fit.

    Parameters
    ----------
    model : BenchModel
        With the nominal stiffness; effects that were added to it by hand are left out.
    campaign : Campaign
        Sealed experiments are not read, opened or not.
    progress : callable, optional
        Called with a fraction 0..1 and a sentence.
    library : sequence of Effect, optional
        What may be missing; by default everything that is installed or registered.
    store : path, optional
        File in which finished fits are kept; an explanation that was killed goes on from there.

    Raises
    ------
    InputError
        If no open bench experiment is in the set calibrate.
    ConvergenceError
        If the calibration does not come to rest.

    Examples
    --------
    >>> findings = explain(BenchModel(campaign.section), campaign)                  # doctest: +SKIP
    >>> findings.verdict, findings.effects                                          # doctest: +SKIP
    ('identified', ('interlayer-friction',))
    """
    begin = time.perf_counter()
    tell = progress or (lambda _fraction, _sentence: None)
    effects = tuple(library) if library is not None else whole_library()
    closed, notes = thinned(_closed(modelled(campaign)[0]) if model.towing else _closed(campaign))
    tell(0.0, "learning the noise, calibrating the linear stiffness")
    before = compare(model.linear, closed)
    bench = [e for e in closed.of_set("calibrate") if model.covers(e)]
    if not bench:
        raise InputError("no open experiment that the model covers is in the set calibrate: nothing can be learnt.")
    blocks = make_blocks(bench, before.model, before.noise)
    if store is not None:
        fits = FitStore.of(closed, effects, before.model, store)
        blocks = tuple(replace(block, fits=fits) for block in blocks)
    tell(0.1, "asking what these experiments can tell apart")
    separation, untestable, smallest, D = testability(blocks, effects)
    outcome = decide(blocks, worth_trying(effects, blocks, D), lambda f, s: tell(0.15 + 0.65 * f, s))
    assumed = not outcome.before.from_repeats or any(c.assumed for c in before.noise.by_channel.values())
    verdict = _tier(outcome, assumed)
    tell(0.8, "calibrating the model with the effects, judging it on what it did not fit")
    after = _after(before, outcome, closed)
    return Findings(
        comparison=before,
        after=after,
        model=after.model,
        verdict=verdict,
        effects=outcome.effects,
        confusable=outcome.confusable,
        closest=outcome.closest,
        ranking=_ranking(outcome, verdict),
        untestable=tuple(u for u in untestable if u.effect not in (*outcome.effects, *outcome.confusable)),
        separation=separation,
        smallest_seen=smallest,
        path=_path(outcome, before, after),
        errors=_errors(before, after),
        where=_where(before, after),
        marks=marks(before, closed),
        next_experiment=_next(outcome, verdict),
        notes=(*notes, *before.notes, *library_notes(), *section_findings(campaign, before), *_notes(outcome, assumed)),
        noise_assumed=assumed,
        seconds=time.perf_counter() - begin,
    )


def open_and_validate(findings: Findings, campaign: Campaign) -> Findings:
    """Open the sealed experiments and judge the fixed models on them; nothing is fitted again.

    Parameters
    ----------
    findings : Findings
        Of the campaign before it was opened.
    campaign : Campaign
        As it was read.
    """
    opened, _ = thinned(modelled(campaign.open_sealed())[0])
    before = compare_calibrated(findings.comparison, opened)
    after = before if findings.after is findings.comparison else compare_calibrated(findings.after, opened)
    error = set_error(before, after, "sealed", _baselines(before, "sealed") if after is not before else None)
    errors = dict(findings.errors)
    if error is not None:
        errors["sealed"] = error
    ids = ", ".join(e.id for e in opened.of_set("sealed")) or "none"
    note = f"sealed experiments were opened after the model was fixed: {ids}; nothing was fitted to them."
    kept = tuple(n for n in findings.notes if not n.startswith("sealed, not read"))
    return replace(findings, comparison=before, after=after, errors=errors, notes=(*kept, note), sealed_opened=True)


def _closed(campaign: Campaign) -> Campaign:
    """The campaign without its sealed experiments, so that nothing of them can be used even if they are open."""
    listed = tuple(e if e.set != "sealed" else replace(e, table=None) for e in campaign.experiments)
    return replace(campaign, experiments=listed, sealed_opened=False)


def _tier(outcome: Outcome, assumed: bool) -> Verdict:
    if outcome.verdict == "identified" and assumed:
        return "family-identified"
    return outcome.verdict


def _after(before: Comparison, outcome: Outcome, campaign: Campaign) -> Comparison:
    if not outcome.final.names or outcome.verdict in ("none", "unknown"):
        return before
    calibration = calibration_of(outcome.final, before.calibration, before.nominal)
    calibration = replace(calibration, parameters=with_expectations(calibration.parameters, campaign, outcome.final))
    return compare_calibrated(replace(before, calibration=calibration), campaign)


def _errors(before: Comparison, after: Comparison) -> dict[str, SetError]:
    errors = {}
    for name in ("calibrate", "validate"):
        baselines = _baselines(before, name) if name == "validate" and before.relative_error(name) is not None else None
        found = set_error(before, after, name, baselines)
        if found is not None:
            errors[name] = found if baselines is None else replace(found, baselines=baselines)
    return errors


def _baselines(before: Comparison, name: str) -> dict[str, float]:
    values = {"Gaussian process patch": patch_error(before, name), "refit of the old model": refit_error(before, name)}
    return {key: value for key, value in values.items() if value is not None}


def _ranking(outcome: Outcome, verdict: Verdict) -> tuple[Candidate, ...]:
    """Every testable effect against the linear model alone; the accepted first one in the form that it was given."""
    first = outcome.first
    attempts = {a.effect.name: a for a in first.plain()}
    for step in outcome.steps[:1]:
        if _tried_alone(step.attempt, first):
            attempts[step.attempt.effect.name] = step.attempt
    in_place = _gaps_in_place(outcome)
    best = max((a.rank for a in attempts.values()), default=0.0)
    behind = {name: in_place.get(name, best - a.rank) for name, a in attempts.items()}
    ordered = sorted(attempts.values(), key=lambda a: (behind[a.effect.name], -a.rank))
    return tuple(
        _candidate(a, outcome, behind[a.effect.name], parameters=i < _WITH_PARAMETERS) for i, a in enumerate(ordered)
    )


def _gaps_in_place(outcome: Outcome) -> dict[str, float]:
    """By how many nats each effect is behind an accepted one in its place, the smallest where there are several."""
    gaps: dict[str, float] = {}
    for accepted, rivals in outcome.rivals.items():
        mine = next((r.rank for r in rivals if r.effect.name == accepted), None)
        for r in rivals:
            if mine is not None:
                gap = 0.0 if r.effect.name == accepted else max(0.0, mine - r.rank)
                gaps[r.effect.name] = min(gap, gaps.get(r.effect.name, np.inf))
    return gaps


def _tried_alone(attempt: Attempt, first: Stage) -> bool:
    """Whether nothing was accepted beside it: not so where the effect that was added first was taken out again."""
    return all(
        len(t.fit.x) == len(first.blocks[t.site.block].base) + len(t.fit.term.form.strength) for t in attempt.trials
    )


def _candidate(attempt: Attempt, outcome: Outcome, behind: float, parameters: bool) -> Candidate:
    share = float(min(1.0, max(0.0, attempt.share)))
    return Candidate(
        attempt.effect.name,
        attempt.effect.kind,
        ", ".join(dict.fromkeys(attempt.forms)),
        attempt.log_e,
        outcome.first.needed,
        share,
        max(0.0, behind),
        parameters_of(attempt, outcome.first) if parameters and attempt.gain > 0 else {},
        attempt.positive,
        attempt.folds,
        _why(attempt, outcome, share),
    )


def _why(attempt: Attempt, outcome: Outcome, share: float) -> str:
    """Why an effect is not the one, or what is doubtful about it."""
    name, needed = attempt.effect.name, outcome.first.needed
    edges = sorted({e for t in attempt.trials for e in t.fit.at_edge})
    doubt = f"; {', '.join(edges)} at the end of its range" if edges else ""
    if name in outcome.effects:
        return f"accepted{doubt}"
    if name in outcome.confusable:
        return f"cannot be told from {', '.join(n for n in outcome.confusable if n != name)}{doubt}"
    for accepted, rivals in outcome.rivals.items():
        gap = next((rivals[0].rank - r.rank for r in rivals if r.effect.name == name), None)
        if gap is not None and gap >= TIE and attempt.log_e > needed:
            return f"{gap:.0f} nats worse than {accepted} in its place, leaves {100 * (1 - share):.0f} % of the misfit{doubt}"
    if attempt.log_e <= needed:
        return f"no evidence: log e {attempt.log_e:.1f}, {needed:.1f} are needed{doubt}"
    return f"not needed beside {', '.join(outcome.final.names) or 'the linear model'}{doubt}"


def _path(outcome: Outcome, before: Comparison, after: Comparison) -> tuple[Step, ...]:
    first = before.relative_error("calibrate") or 0.0
    total = outcome.before.T
    steps = [Step("linear model", "", 0.0, first, 0.0, f"lack of fit F = {outcome.before.F:.3g}")]
    if outcome.verdict in ("none", "unknown"):
        return tuple(steps)
    for taken in outcome.steps:
        left = max(taken.misfit.T, 0.0) / total if total > 0 else 0.0
        error = (1 + (first**2 - 1) * left) ** 0.5 if first > 1 else first
        if taken is outcome.steps[-1]:
            error = after.relative_error("calibrate") or error
        form = ", ".join(dict.fromkeys(taken.attempt.forms))
        note = f"lack of fit F = {taken.misfit.F:.3g}"
        steps.append(Step(taken.attempt.effect.name, form, taken.attempt.log_e, error, 1 - left, note))
    return tuple(steps)


def _where(before: Comparison, after: Comparison) -> tuple[Place, ...]:
    """Where the linear model fails, worst first, and what is left there."""
    left = {(f.experiment.id, f.channel): f.relative_excess for f in after.fits}
    return tuple(
        Place(f.experiment.id, f.channel, f.relative_excess, left[f.experiment.id, f.channel])
        for f in before.where_it_fails()
    )


def _next(outcome: Outcome, verdict: Verdict) -> NextExperiment | None:
    if verdict == "confusable":
        for name, rivals in outcome.rivals.items():
            names = tied(rivals, name, outcome.after)
            if len(names) > 1:
                return separating_experiment(outcome.final.without(name), [r for r in rivals if r.effect.name in names])
    return None


def _notes(outcome: Outcome, assumed: bool) -> list[str]:
    notes = []
    if assumed:
        notes.append(
            "noise assumed: no repeats measured it (in every channel), so that the best verdict is family-identified. "
            "Repeat two or three experiments."
        )
    groups = min(len(block.groups) for block in outcome.first.blocks)
    if groups < 3:
        notes.append(
            f"only {groups} condition(s) in the set calibrate: what is left out and predicted is "
            + ("each of them in turn." if groups > 1 else "nothing; the evidence is that of the fit.")
        )
    return notes
