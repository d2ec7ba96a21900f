"""Findings in words: the five sentences of the first screen, and the numbers with their uncertainty.

Terminal, page and notebook say the same: they take their sentences from here.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from compare.comparison import ChannelFit, Comparison
from compare.findings import Candidate, Findings, ParameterValue, SetError, Step
from compare.kinds import CONDITIONS, SETS

VERDICTS = {
    "none": "the residual is noise",
    "identified": "these effects bring the error to the noise floor",
    "family-identified": "the right family, its form is not exact yet",
    "confusable": "these explain the data equally well",
    "unknown": "something is missing that the library does not have",
}
BASELINES = {"Gaussian process patch": "GP patch", "refit of the old model": "refit"}  # where there is little room
_MOST_NAMED = 3


def uncertain(value: float, std: float | None, unit: str = "") -> str:
    """A value with its standard deviation, rounded to what is known; None is a deviation that is not finite.

    >>> uncertain(0.5132, 0.0312, "N m"), uncertain(48213.0, 130.0, "N"), uncertain(0.5, float("inf"), "1")
    ('0.513 ± 0.031 N m', '48210 ± 130 N', '0.5 (not determined)')
    """
    unit = "" if unit in ("1", "-") else unit
    std = math.inf if std is None else std
    if not math.isfinite(value):
        return "not determined"
    if not math.isfinite(std) or std <= 0:
        return f"{value:.4g} {unit}".rstrip() + (" (not determined)" if not math.isfinite(std) else "")
    size = max(abs(value), std)
    digits = 1 - math.floor(math.log10(std))
    if size >= 1e6 or size < 1e-3:
        power = math.floor(math.log10(size))
        scale, digits = 10.0**power, min(max(digits + power, 0), 6)
        return f"({value / scale:.{digits}f} ± {std / scale:.{digits}f})e{power:d} {unit}".rstrip()
    kept = max(digits, 0)
    return f"{round(value, digits):.{kept}f} ± {round(std, digits):.{kept}f} {unit}".rstrip()


def nats(value: float) -> str:
    """An evidence or a gap in nats: digits as far as they matter.

    >>> nats(7.18), nats(-2.44), nats(40810.3)
    ('7.2', '-2.4', '40810')
    """
    return f"{value:.0f}" if abs(value) >= 100 else f"{value:.1f}"


def listed(names: Sequence[str], joint: str = "and", most: int = 99) -> str:
    """Words with commas and a last joint.

    >>> listed(["a", "b", "c"], "or")
    'a, b or c'
    """
    shown = list(names[:most])
    if len(names) > most:
        return ", ".join(shown) + f" {joint} {len(names) - most} more"
    return shown[0] if len(shown) == 1 else f"{', '.join(shown[:-1])} {joint} {shown[-1]}" if shown else ""


def uncalibrated(findings: Findings) -> str:
    """How far the model is before anything is fitted, and what calibrating the linear stiffness changes."""
    c = findings.comparison
    before, after = c.relative_error("calibrate", before=True), c.relative_error("calibrate")
    ratios = [
        f"{v.name} {v.ratio:.3g} of the predicted ({uncertain(v.value, v.std, v.unit)})"
        for v in c.calibration.values.values()
    ]
    if before is None or after is None:
        return "No experiment of the set calibrate could be compared."
    changed = listed(ratios) or "nothing to calibrate"
    return f"{before:.3g} x the noise floor as predicted, {after:.3g} x calibrated: {changed}."


def model_against_data(findings: Findings) -> str:
    """Sentence 1: how far the calibrated base model is from the data, and where it fails most."""
    c = findings.comparison
    if not c.fits:
        return "No experiment of this campaign could be compared."
    n = len({fit.experiment.id for fit in c.fits})
    errors = [f"{v:.3g} x on {name}" for name in SETS if (v := c.relative_error(name)) is not None]
    head = f"{n} experiments, error over the noise floor {', '.join(errors)}."
    failing = c.where_it_fails()
    if not failing:
        return f"{head} No record stands out of its noise."
    worst = [f"{f.experiment.id} {f.channel} ({_excess(f)}, {f.relative_excess:.3g} x floor)" for f in failing[:2]]
    fine = fine_kinds(c)
    tail = f"; fine in {listed(fine)}" if fine else ""
    return f"{head} Fails in {len(failing)} of {len(c.fits)} channels, most in {listed(worst)}{tail}."


def fine_kinds(comparison: Comparison) -> list[str]:
    """Kinds of experiment in which no channel fails."""
    failing = {f.experiment.kind for f in comparison.where_it_fails()}
    return [k for k in dict.fromkeys(f.experiment.kind for f in comparison.fits) if k not in failing]


def missing_effect(findings: Findings) -> str:
    """Sentence 2: the verdict with its evidence."""
    f = findings
    assumed = " (noise assumed)" if f.noise_assumed else ""
    if f.verdict == "none":
        seen = [f"{name} from {size}" for name, size in f.smallest_seen.items()]
        tail = f"; it would have been seen: {listed(seen, most=_MOST_NAMED)}" if seen else ""
        return f"none: no missing effect found{assumed}{tail}."
    if f.verdict == "unknown":
        near = f"; closest is {f.closest[0]}, which removes {_percent(f.closest[1])} of the excess" if f.closest else ""
        accepted = f" beside {listed(f.effects)}" if f.effects else ""
        return f"unknown: something is missing{accepted} that no effect of the library explains{assumed}{near}."
    accepted = [_evidence(f, name) for name in f.effects]
    if f.verdict == "confusable":
        beside = f", beside {'; '.join(accepted)}" if accepted else ""
        return f"confusable: {listed(f.confusable, 'or')}; these data cannot tell them apart{assumed}{beside}."
    return f"{f.verdict}: {'; then '.join(accepted)}{assumed}."


def _evidence(findings: Findings, name: str) -> str:
    step = next((s for s in findings.path if s.added == name), None)
    candidate = candidate_of(findings, name)
    if step is None and candidate is None:
        return name
    log_e = step.log_e if step is not None else candidate.log_e if candidate else math.nan
    share = step.share if step is not None else candidate.share if candidate else math.nan
    gate = f" (needs {nats(candidate.needed)})" if candidate is not None else ""
    return f"{name}, log e {nats(log_e)}{gate}, explains {_percent(share)} of the excess"


def candidate_of(findings: Findings, name: str) -> Candidate | None:
    """The ranked candidate of that name."""
    return next((c for c in findings.ranking if c.effect == name), None)


def parameters_of(findings: Findings, effect: str) -> dict[str, ParameterValue]:
    """Parameters of an effect: as calibrated in the final model, else as they were when it was tried."""
    mark = f"{effect}: "
    final = {k.removeprefix(mark): p for k, p in findings.after.calibration.parameters.items() if k.startswith(mark)}
    candidate = candidate_of(findings, effect)
    return final or (dict(candidate.parameters) if candidate is not None else {})


def parameter_sentences(findings: Findings, effect: str) -> list[str]:
    """Every parameter with its uncertainty, and beside it what the geometry of the cable would give, if known."""
    return [parameter_sentence(name, p) for name, p in parameters_of(findings, effect).items()]


def parameter_sentence(name: str, p: ParameterValue) -> str:
    """One parameter in words.

    >>> parameter_sentence("slip_limit", ParameterValue(0.51, 0.03, "N m", expected="0.4 to 0.6 N m"))
    'slip_limit 0.510 ± 0.030 N m (from the cable itself: 0.4 to 0.6 N m)'
    """
    expected = f" (from the cable itself: {p.expected})" if p.expected else ""
    outside = p.plausible is not None and not p.plausible[0] <= p.value <= p.plausible[1]
    odd = " (outside what is usual)" if outside else ""
    return f"{name} {uncertain(p.value, p.std, p.unit)}{expected}{odd}"


def named(findings: Findings) -> tuple[str, ...]:
    """Everything that the verdict names: accepted, then the set."""
    return (*findings.effects, *(c for c in findings.confusable if c not in findings.effects))


def rivals(findings: Findings) -> list[Candidate]:
    """Candidates that the verdict does not name, best first."""
    inside = named(findings)
    return [c for c in findings.ranking if c.effect not in inside]


def rivals_sentence(c: Candidate) -> str:
    """Why it is not this one."""
    gate = "" if c.log_e >= c.needed else f", log e {nats(c.log_e)} below the {nats(c.needed)} that are needed"
    return f"{c.effect}: {c.note or f'{nats(c.behind)} nats behind, explains {_percent(c.share)}{gate}'}"


def why_not(findings: Findings) -> str:
    """Sentence 3: why it is none of the next best, and what these data cannot show at all."""
    others = [rivals_sentence(c) for c in rivals(findings)[:_MOST_NAMED]]
    closed = [f"{u.effect} ({u.why})" for u in findings.untestable]
    parts = [". ".join(o.rstrip(".") for o in others) + "."] if others else []
    if closed:
        parts.append(f"Not testable: {listed(closed, most=_MOST_NAMED)}.")
    return " ".join(parts) or "Every effect of the library could be tested, and there is no rival."


def held_out(findings: Findings) -> str:
    """Sentence 4: the error before and after on data that were not fitted, against the floor and the baselines."""
    names = [n for n in ("sealed", "validate") if n in findings.errors]
    if not names:
        return "No held-out data: mark experiments as validate or sealed to see whether the error falls there."
    return " ".join(f"{name}: {error_sentence(findings.errors[name])}." for name in names)


def error_sentence(e: SetError) -> str:
    """Before, after, ratio with its interval, baselines.

    >>> error_sentence(SetError(3.4, 1.05, 1.0, 0.15, 0.11, 0.2, {"refit of the old model": 3.3}, True))
    '3.4 -> 1.05 x floor, excess ratio 0.15 [0.11, 0.2], confirmed; refit of the old model 3.3'
    """
    text = f"{e.before:.3g} -> {e.after:.3g} x floor"
    if e.ratio is not None:
        text += f", excess ratio {e.ratio:.2g}"
        if e.ratio_low is not None and e.ratio_high is not None:
            text += f" [{e.ratio_low:.2g}, {e.ratio_high:.2g}]"
    if e.confirmed is not None:
        text += ", confirmed" if e.confirmed else ", NOT CONFIRMED"
    others = [f"{k} {v:.3g}" for k, v in e.baselines.items()]
    return text + (f"; {', '.join(others)}" if others else "")


def what_next(findings: Findings) -> str:
    """Sentence 5: the experiment that would separate the rivals."""
    n = findings.next_experiment
    if n is None and findings.verdict == "unknown":
        worst = findings.comparison.where_it_fails()
        place = f" ({worst[0].experiment.id})" if worst else ""
        return (
            f"Vary one condition at a time around where the excess is largest{place}: what it depends on is not known."
        )
    if n is None:
        return "No rivals are left that another experiment of these kinds would have to separate."
    conditions = listed([_condition(k, v) for k, v in with_units(n.conditions).items()])
    text = n.sentence.rstrip(".") or f"{n.kind} at {conditions} separates {listed(n.separates)}"
    repeat = (
        f"; a repeat of what exists would give {_probability(n.p_wrong_repeat)}" if n.p_wrong_repeat is not None else ""
    )
    return f"{text}: P(wrong) {_probability(n.p_wrong_before)} -> {_probability(n.p_wrong_after)}{repeat}."


def steps_taken(findings: Findings) -> list[Step]:
    """The effects of the path, without the base model at its start."""
    return [s for s in findings.path if s.log_e != 0 or s.added in findings.effects]


def first_screen(findings: Findings) -> tuple[tuple[str, str], ...]:
    """The five sentences with their titles."""
    return (
        ("Model vs data", model_against_data(findings)),
        ("Missing effect", " ".join([missing_effect(findings), *_found(findings)])),
        ("Why not", why_not(findings)),
        ("Held out", held_out(findings)),
        ("Next", what_next(findings)),
    )


def with_units(conditions: Mapping[str, float]) -> dict[str, float]:
    """Conditions with their SI unit in the name, as the head of experiments.csv has them.

    >>> with_units({"axial tension": 4000.0, "rate [1/s]": 0.5})
    {'axial tension [N]': 4000.0, 'rate [1/s]': 0.5}
    """
    return {
        name if "[" in name or name not in CONDITIONS else f"{name} [{CONDITIONS[name].unit}]": float(value)
        for name, value in conditions.items()
    }


def _found(findings: Findings) -> list[str]:
    """Parameters of what the verdict names, a sentence each."""
    found = {name: parameter_sentences(findings, name)[:_MOST_NAMED] for name in named(findings)}
    return [f"{name}: {', '.join(words)}." for name, words in found.items() if words]


def _condition(name: str, value: float) -> str:
    """'axial tension [N]' and 4000 as '4000 N axial tension'."""
    label, _, unit = name.partition("[")
    return " ".join(w for w in (f"{value:.4g}", unit.rstrip("] "), label.strip()) if w)


def _excess(fit: ChannelFit) -> str:
    return f"excess {fit.after.excess:.3g} of {float(abs(fit.measured).max()):.3g} {fit.unit}"


def _percent(share: float) -> str:
    return f"{100 * share:.0f} %" if math.isfinite(share) else "an unknown part"


def _probability(p: float) -> str:
    """Per cent where that reads well, a power of ten below.

    >>> _probability(0.5), _probability(1e-4)
    ('50 %', '1e-04')
    """
    return f"{100 * p:.0f} %" if p >= 0.01 else f"{p:.0e}"
