"""The seven panels of the page of `helicable explain`: text, pictures, tables, a light, and how every number is computed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from compare.comparison import ChannelFit, Comparison
from compare.findings import Findings
from compare.findings_record import experiment_rows
from compare.findings_sentences import (
    listed,
    missing_effect,
    model_against_data,
    named,
    nats,
    parameters_of,
    rivals_sentence,
    steps_taken,
    uncalibrated,
    uncertain,
    what_next,
    with_units,
)
from compare.kinds import SETS
from compare.residual_plot import autocorrelation, same_record, whitened, worst_and_typical
from helicable import how_computed
from helicable.campaign_tables import (
    NOISE_COLUMNS,
    TESTABLE_COLUMNS,
    condition_rows,
    confused_rows,
    kind_rows,
    noise_cells,
    testable_rows,
)
from helicable.explain_screen import baseline_words, error_row, ratio_words, untestable_sentences
from helicable.report import Figure, Section, Table
from helicable.traffic_light import Light, error_light, held_out_light, verdict_light

_NO_LIGHT = Light("good", "")


@dataclass(frozen=True)
class Panel(Section):
    """A section with a light, and for every number in it how it is computed."""

    light: Light = _NO_LIGHT
    computed: Sequence[tuple[str, str]] = ()


def panels(findings: Findings, pictures: Mapping[str, Path]) -> tuple[Panel, ...]:
    """The seven panels, in the order of the data."""
    return (
        _data(findings, pictures),
        _model_over_measurement(findings, pictures),
        _where(findings, pictures),
        _which(findings, pictures),
        _path(findings, pictures),
        _held_out(findings, pictures),
        _next(findings),
    )


def _figures(pictures: Mapping[str, Path], captions: Mapping[str, str]) -> list[Figure]:
    return [Figure(pictures[name], caption) for name, caption in captions.items() if name in pictures]


def _data(f: Findings, pictures: Mapping[str, Path]) -> Panel:
    campaign, s = f.comparison.campaign, f.separation
    rows = experiment_rows(campaign)
    noise = noise_cells(f.comparison.record()["noise"])
    text = "\n\n".join(f"Confounded: {sentence}" for sentence in s.confounded)
    untestable = [(u.effect, u.why) for u in f.untestable]
    columns = ("kind", "experiments", "repeats", "sets", "path", "largest", "measured")
    tables = [
        Table("What was recorded (SI units)", columns, kind_rows(rows), right=(1, 2, 5)),
        Table("Conditions", ("kind", "condition", "from", "to", "values"), condition_rows(rows), right=(2, 3, 4)),
        Table("Noise (SI units)", NOISE_COLUMNS, noise, right=(2, 3, 4, 5, 6)),
        Table("What can be shown", TESTABLE_COLUMNS, testable_rows(s, f.smallest_seen), right=(1,)),
        Table("Not testable with these data", ("effect", "why"), untestable),
        Table("Pairs that may be confused", ("effect", "taken for", "chance"), confused_rows(s), right=(2,)),
    ]
    figures = _figures(pictures, {"confusion": "Chance that these experiments let one effect be taken for another"})
    light = Light("good", "clear design")
    if f.noise_assumed or s.confounded or untestable:
        reasons = [w for w, yes in (("noise assumed", f.noise_assumed), ("confounded covariates", s.confounded)) if yes]
        light = Light("mind", listed(reasons) or "some effects not testable")
    return Panel("Data and design", text, figures, [t for t in tables if t.rows], light, how_computed.DATA)


def _model_over_measurement(f: Findings, pictures: Mapping[str, Path]) -> Panel:
    captions = {"record-1": "The record that the base model misses most", "record-2": "A typical record"}
    after = f.after.calibration.values
    rows = [
        (name, f"{v.nominal:.4g}", uncertain(v.value, v.std), f"{v.ratio:.3g}", *_again(after.get(name)), v.unit)
        for name, v in f.comparison.calibration.values.items()
    ]
    heads = ("stiffness", "predicted", "calibrated", "ratio", "with effects", "unit")
    marks = [
        (
            fit.experiment.id,
            fit.channel,
            *_misfit_words(fit, f.comparison),
            *_misfit_words(same_record(fit, f.after), f.after),
        )
        for fit in worst_and_typical(f.comparison)
    ]
    tables = [
        Table("Linear stiffness", heads, rows, right=(1, 2, 3, 4)),
        Table(
            "The residual of these records",
            (
                "experiment",
                "channel",
                "base: misfit",
                "base: autocorrelation",
                "after: misfit",
                "after: autocorrelation",
            ),
            marks if f.effects else [m[:4] for m in marks],
            note="" if f.effects else "Nothing was added: the base model only.",
        ),
    ]
    if not f.effects:
        tables[1] = Table(tables[1].title, tables[1].columns[:4], tables[1].rows)
    light = error_light(f.comparison.relative_error("calibrate"))
    light = Light(light.level, f"base model {light.word}")
    return Panel(
        "Model over measurement", uncalibrated(f), _figures(pictures, captions), tables, light, how_computed.MODEL
    )


def _again(value: object) -> tuple[str]:
    return (uncertain(value.value, value.std) if value is not None else "-",)  # pyright: ignore[reportAttributeAccessIssue]


def _misfit_words(fit: ChannelFit, comparison: Comparison) -> tuple[str, str]:
    ratio = fit.after.rmse / fit.noise_floor
    x = whitened(fit, comparison)
    r, band = float(autocorrelation(x, 1)[1]), 2 / np.sqrt(len(x))
    word = "white" if abs(r) <= band else "correlated"
    distance = {"good": "at the floor", "mind": "near it", "bad": "far from it"}[error_light(ratio).level]
    return f"{ratio:.3g} x floor: {distance}", f"{r:.2f} (band {band:.2f}): {word}"


def _where(f: Findings, pictures: Mapping[str, Path]) -> Panel:
    captions = {
        "where": "Excess over the noise floor by experiment and channel; dark is far from the floor",
        "conditions": "The same against what was varied: a trend shows what the missing effect depends on",
        "loop-energy": "Energy of a loop: friction does not depend on rate, viscosity does",
    }
    marks = [(m.name, m.sentence, uncertain(m.value, m.std), m.computed) for m in f.marks]
    places = [(p.experiment, p.channel, f"{p.excess:.3g}", f"{p.after:.3g}") for p in f.where]
    tables = [
        Table("Marks of the residual", ("mark", "what is seen", "value", "how computed"), marks, right=(2,)),
        Table("Places", ("experiment", "channel", "excess [floors]", "after [floors]"), places, right=(2, 3)),
    ]
    failing = f.comparison.where_it_fails()
    light = Light("good", "nowhere beyond noise")
    if failing:
        light = Light("bad", f"{len(failing)} of {len(f.comparison.fits)} channels beyond noise")
    return Panel(
        "Where it fails",
        model_against_data(f),
        _figures(pictures, captions),
        [t for t in tables if t.rows],
        light,
        how_computed.WHERE,
    )


def _which(f: Findings, pictures: Mapping[str, Path]) -> Panel:
    inside = named(f)
    rows = [
        (
            c.effect,
            c.kind,
            c.form,
            nats(c.log_e),
            nats(c.needed),
            f"{100 * c.share:.0f} %",
            nats(c.behind),
            f"{c.positive_folds} of {c.folds}",
            _role(c.effect, f) if c.effect in inside else rivals_sentence(c).split(": ", 1)[1],
        )
        for c in f.ranking
    ]
    parameters = [
        (effect, name, uncertain(p.value, p.std, p.unit), _range(p.plausible), p.expected, p.meaning)
        for effect in inside
        for name, p in parameters_of(f, effect).items()
    ]
    heads = ("effect", "kind", "form", "log e", "needed", "share", "behind", "folds", "why (not)")
    found = ("effect", "parameter", "value", "usual range", "from the cable itself", "meaning")
    seen = [(name, size) for name, size in f.smallest_seen.items()] if f.verdict == "none" else []
    tables = [
        Table("Parameters that were found", found, parameters, right=(2,)),
        Table("Smallest size that would have been seen", ("effect", "size"), seen),
        Table("All effects that were tried", heads, rows, right=(3, 4, 5, 6)),
    ]
    text = missing_effect(f) + "\n\n" + "\n\n".join(f"Not testable: {s}." for s in untestable_sentences(f.untestable))
    caption = {"ranking": "Evidence of each effect against the base model, and the share of the excess that it removes"}
    return Panel(
        "Which effect",
        text,
        _figures(pictures, caption),
        [t for t in tables if t.rows],
        verdict_light(f),
        how_computed.WHICH,
    )


def _role(effect: str, f: Findings) -> str:
    return "accepted" if effect in f.effects else "in the set that cannot be told apart"


def _range(plausible: tuple[float, float] | None) -> str:
    if plausible is None:
        return ""
    low, high = plausible
    return f"from {low:.3g}" if np.isinf(high) else f"{low:.3g} to {high:.3g}"


def _path(f: Findings, pictures: Mapping[str, Path]) -> Panel:
    rows = [
        (
            str(i),
            step.added,
            step.form,
            nats(step.log_e),
            f"{step.error:.3g}",
            f"{100 * step.share:.0f} %",
            step.note,
        )
        for i, step in enumerate(steps_taken(f), start=1)
    ]
    heads = ("step", "added", "form", "log e", "error [floors]", "share", "note")
    text = "" if rows else "Nothing was added: no effect passed the gate alone."
    light = error_light(f.path[-1].error) if rows else Light("good" if f.verdict == "none" else "mind", "nothing added")
    tables = [Table("Steps", heads, rows, right=(0, 3, 4, 5))] if rows else []
    caption = {"path": "The error on the calibration set falls with every effect that is accepted"}
    return Panel("The path", text, _figures(pictures, caption), tables, light, how_computed.PATH)


def _held_out(f: Findings, pictures: Mapping[str, Path]) -> Panel:
    rows = [
        (*error_row(name, f)[:3], "1", ratio_words(f.errors[name]), baseline_words(f.errors[name]))
        for name in SETS
        if name in f.errors
    ]
    heads = ("set", "before", "after", "floor", "ratio of excess", "other ways to mend the model")
    caption = {"errors": "Error on every set before and after, with the noise floor and other ways to mend the model"}
    tables = [Table("Error over the noise floor", heads, rows, right=(1, 2, 3))] if rows else []
    return Panel(
        "Before and after",
        sealed_sentence(f),
        _figures(pictures, caption),
        tables,
        held_out_light(f.errors),
        how_computed.HELD_OUT,
    )


def sealed_sentence(f: Findings) -> str:
    """Whether the sealed experiments were opened."""
    sealed = f.comparison.campaign.of_set("sealed")
    if f.sealed_opened:
        return "The sealed experiments were opened once, after the model was fixed."
    if sealed:
        return f"{len(sealed)} sealed experiments were not opened (helicable explain --open-sealed does it, once)."
    return "The campaign has no sealed experiments."


def _next(f: Findings) -> Panel:
    n, tables = f.next_experiment, []
    if n is not None:
        rows = [("kind", n.kind), *((k, f"{v:.4g}") for k, v in with_units(n.conditions).items())]
        chances = [("with these data", n.p_wrong_before), ("after this experiment", n.p_wrong_after)]
        if n.p_wrong_repeat is not None:
            chances.append(("after repeating what exists", n.p_wrong_repeat))
        tables = [
            Table("The experiment", ("", "value"), rows, right=(1,)),
            Table(
                "Chance of naming the wrong one", ("", "P(wrong)"), [(k, f"{v:.2g}") for k, v in chances], right=(1,)
            ),
        ]
    light = Light("good", "nothing to separate")
    if n is not None or f.verdict == "unknown":
        light = Light("mind", "an experiment is suggested" if n is not None else "not known yet")
    return Panel("Next experiment", what_next(f), (), tables, light, how_computed.NEXT)
