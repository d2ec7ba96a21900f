"""What `helicable explain` shows in the terminal: one screen, the same sentences as the page."""

from __future__ import annotations

from collections.abc import Sequence

from compare.findings import Findings, NextExperiment, SetError, Untestable
from compare.findings_sentences import (
    BASELINES,
    listed,
    missing_effect,
    model_against_data,
    named,
    parameter_sentences,
    rivals,
    rivals_sentence,
    uncalibrated,
    what_next,
    with_units,
)
from compare.kinds import SETS
from helicable.screen import sheet, table

_MOST = 3


def show_findings(findings: Findings, notes: Sequence[str] = ()) -> None:
    """Print the findings on one screen of about 80 by 40."""
    rows = [("Predicted", uncalibrated(findings)), ("Fails", model_against_data(findings))]
    rows += _paragraphs("Missing", [missing_effect(findings), *_parameters(findings)])
    if findings.marks:
        rows += _paragraphs("Signs", [mark.sentence for mark in findings.marks[:2]])
    rows += _paragraphs("Why not", [rivals_sentence(c) for c in rivals(findings)[:_MOST]])
    rows += _paragraphs("Untestable", untestable_sentences(findings.untestable)[: _MOST + 1])
    rows.append(("Next", what_next(findings)))
    rows += _paragraphs("Notes", [*notes, *findings.notes][:_MOST])
    sheet(findings.comparison.campaign.title or "Campaign", rows)
    columns = ("error / floor", "before", "after", "ratio of excess", "baselines")
    table("", columns, [error_row(name, findings) for name in SETS], right=(1, 2))


def _paragraphs(name: str, sentences: Sequence[str]) -> list[tuple[str, str]]:
    return [(name if i == 0 else "", sentence) for i, sentence in enumerate(sentences)]


def _parameters(findings: Findings) -> list[str]:
    """Parameters of everything that the verdict names, one line each effect."""
    found = {name: parameter_sentences(findings, name) for name in named(findings)}
    most = _MOST if len(found) < _MOST else 2
    lines = [f"{name}: {'; '.join(p[:most])}{' ...' if len(p) > most else ''}" for name, p in found.items() if p]
    return lines[: _MOST + 1]


def untestable_sentences(untestable: Sequence[Untestable]) -> list[str]:
    """Effects that share a reason in one sentence."""
    by_reason: dict[str, list[str]] = {}
    for u in untestable:
        by_reason.setdefault(u.why, []).append(u.effect)
    return [f"{listed(names)}: {why}" for why, names in by_reason.items()]


def error_row(name: str, findings: Findings) -> tuple[str, str, str, str, str]:
    """One row of the table of errors before and after."""
    e = findings.errors.get(name)
    if e is None:
        held_back = [x for x in findings.comparison.campaign.of_set(name) if not x.is_open]
        return (name, "-", "-", "not opened (--open-sealed)" if held_back else "no experiments", "")
    return (name, f"{e.before:.3g}", f"{e.after:.3g}", ratio_words(e), baseline_words(e))


def ratio_words(e: SetError) -> str:
    """Ratio of the excess with its interval, and whether the fall is confirmed."""
    if e.ratio is None:
        return "-"
    interval = (
        f" [{e.ratio_low:.2g}, {e.ratio_high:.2g}]" if e.ratio_low is not None and e.ratio_high is not None else ""
    )
    word = "" if e.confirmed is None else " confirmed" if e.confirmed else " NOT CONFIRMED"
    return f"{e.ratio:.2g}{interval}{word}"


def baseline_words(e: SetError) -> str:
    """The same error for other ways to mend the model."""
    return ", ".join(f"{BASELINES.get(k, k)} {v:.3g}" for k, v in e.baselines.items())


def show_next(following: NextExperiment | None, findings: Findings) -> None:
    """Print the suggested experiment as the row of experiments.csv that it would be."""
    sheet(findings.comparison.campaign.title, [("Missing", missing_effect(findings)), ("Next", what_next(findings))])
    if following is None:
        return
    rows = [("kind", following.kind), *((k, f"{v:.4g}") for k, v in with_units(following.conditions).items())]
    table("Conditions", ("", "value"), rows, right=(1,))
    chances = [("with these data", following.p_wrong_before), ("after this experiment", following.p_wrong_after)]
    if following.p_wrong_repeat is not None:
        chances.append(("after repeating what exists", following.p_wrong_repeat))
    table("Probability of naming the wrong one", ("", "P(wrong)"), [(k, f"{v:.2g}") for k, v in chances], right=(1,))
