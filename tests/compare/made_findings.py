"""Findings written by hand, one for each verdict, on a small bending campaign with loops that a linear model misses."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
from made_campaign import NOMINAL, made_experiment
from sound_campaign import TOML

from compare import BenchModel, Campaign, Comparison, NoiseCovariance, NominalSection, compare
from compare.findings import (
    Candidate,
    Check,
    Findings,
    Mark,
    NextExperiment,
    ParameterValue,
    Place,
    Separation,
    SetError,
    Step,
    Untestable,
)
from compare.misfit import misfit

VERDICTS = ("none", "identified", "family-identified", "confusable", "unknown")
EFFECTS = ("interlayer-friction", "plasticity", "viscous-damping", "stiffening")


def loops(friction: float, seed: int = 0) -> list:
    """Bending loops at three amplitudes, two tensions and two rates in pairs, with a loop of that half width [N m]."""
    rng = np.random.default_rng(seed)
    experiments = []
    plan = [
        (0.3, 500.0, 60.0),
        (0.8, 500.0, 60.0),
        (1.6, 500.0, 60.0),
        (0.8, 2000.0, 60.0),
        (0.8, 500.0, 12.0),
        (1.2, 900.0, 30.0),
    ]
    for g, (amplitude, tension, duration) in enumerate(plan):
        t = np.linspace(0, duration, 160)
        k = amplitude * np.sin(4 * np.pi * t / duration)
        slip = loop_of(t, tension, friction)
        for r in (0, 1):
            moment = 80 * k + slip + rng.normal(0, 0.4, t.size)
            e = made_experiment(
                f"b{g + 1:02d}{'ab'[r]}",
                "bending",
                "curvature",
                {"curvature": k, "moment": moment},
                repeat_of=f"b{g + 1:02d}a" if r else None,
                set="validate" if g == 5 else "calibrate",
                conditions={"axial tension": tension, "temperature": 293.15, "specimen length": 1.0},
            )
            table = replace(e.record, time=t)
            experiments.append(replace(e, table=table))
    return experiments


def loop_of(t, tension: float, friction: float):
    """Moment of the loop: its half width grows with the root of the tension."""
    return np.tanh(8 * np.cos(4 * np.pi * t / t[-1])) * friction * np.sqrt(tension / 500)


def with_loop(fit, friction: float):
    """The same record beside a model that has the loop."""
    e = fit.experiment
    model = 80 * e.record["curvature"] + loop_of(e.record.time, e.conditions["axial tension"], friction)
    noise = NoiseCovariance(s=0.4)
    return replace(fit, model=model, after=misfit(fit.measured, model, noise))


def made_campaign_of(friction: float, title: str = "Bench tests of a made cable") -> Campaign:
    return Campaign(Path("."), title, None, NominalSection(NOMINAL), {}, {}, tuple(loops(friction)))


def ranked(verdict: str) -> tuple[Candidate, ...]:
    """The same candidates as that verdict would have them."""
    best, second, *others = candidates()
    if verdict == "none":
        return tuple(replace(c, log_e=1.0 - i, share=0.0, note="") for i, c in enumerate((best, second, *others)))
    if verdict == "unknown":
        return tuple(replace(c, note="") for c in (others[0], replace(second, share=0.31, log_e=44.0), others[1]))
    if verdict == "confusable":
        return (best, replace(second, log_e=213.2, share=0.97, behind=0.8, note=""), *others)
    return (best, second, *others)


@cache
def compared(friction: float, title: str) -> Comparison:
    """The linear model beside the made campaign."""
    campaign = made_campaign_of(friction, title)
    return compare(BenchModel(NominalSection(NOMINAL)), campaign)


def separation() -> Separation:
    confusion = np.full((4, 4), 1e-6)
    np.fill_diagonal(confusion, 0.5)
    confusion[0, 1] = confusion[1, 0] = 0.31
    return Separation(
        EFFECTS,
        np.array([41.0, 38.0, 12.0, 4.1]),
        ("slip limit of 1 % of the largest moment",) * 4,
        confusion,
        ("log amplitude and log rate vary together (correlation -0.91).",),
    )


def candidates() -> tuple[Candidate, ...]:
    slip = {
        "slip_limit": ParameterValue(2.04, 0.03, "N m", "moment at which layers slip", (0.0, 50.0), "1.2 to 3.0 N m")
    }
    eta = {"time": ParameterValue(1.3, 0.4, "s", "viscosity over stiffness", (0.0, np.inf))}
    return (
        Candidate("interlayer-friction", "physics", "one slip element", 214.0, 7.5, 0.97, 0.0, slip, 5, 5),
        Candidate(
            "plasticity",
            "physics",
            "one slip element",
            190.0,
            7.5,
            0.81,
            24.0,
            slip,
            5,
            5,
            "no growth with tension allowed; 24 nats worse",
        ),
        Candidate(
            "viscous-damping",
            "physics",
            "Kelvin-Voigt",
            61.0,
            7.5,
            0.42,
            782.0,
            eta,
            3,
            5,
            "no rate trend (exponent 0.02 ± 0.05), 782 nats worse",
        ),
        Candidate(
            "stiffening", "physics", "cubic", -2.4, 7.5, -0.03, 990.0, {"c3": ParameterValue(0.1, np.inf, "m^2")}, 1, 5
        ),
    )


def made_findings(
    verdict: str = "identified", friction: float = 3.0, title: str = "Bench tests of a made cable"
) -> Findings:
    """Findings of that verdict; the comparison in them is real, everything else is written by hand."""
    noise_only = compared(0.0, title)
    comparison = noise_only if verdict == "none" else compared(friction, title)
    after = replace(comparison, fits=tuple(with_loop(fit, friction) for fit in comparison.fits))
    named = verdict in ("identified", "family-identified")
    rivals = ("interlayer-friction", "plasticity")
    errors = {
        "calibrate": SetError(3.1, 1.02 if named else 3.1),
        "validate": SetError(
            3.4, 1.05, 1.0, 0.15, 0.11, 0.20, {"Gaussian process patch": 2.7, "refit of the old model": 3.3}, True
        )
        if named
        else SetError(3.4, 3.4, baselines={"Gaussian process patch": 2.7}),
    }
    failing = comparison.where_it_fails()
    next_one = NextExperiment("bending", {"axial tension": 4000.0, "amplitude [1/m]": 1.6}, rivals, 0.5, 1e-4, 0.5)
    return Findings(
        comparison=comparison,
        after=after if named else comparison,
        model=comparison.model,
        verdict=verdict,
        effects=("interlayer-friction",) if named else (),
        confusable=rivals if verdict == "confusable" else (),
        closest=("viscous-damping", 0.42) if verdict == "unknown" else None,
        ranking=ranked(verdict),
        untestable=(Untestable("thermal-softening", "all experiments at 20 degC"),),
        separation=separation(),
        smallest_seen={"interlayer-friction": "a slip limit of 0.2 N m", "stiffening": "2 % at the largest curvature"},
        path=(Step("interlayer-friction", "one slip element", 214.0, 1.02, 0.97),) if named else (),
        errors=errors,
        where=tuple(Place(f.experiment.id, f.channel, f.relative_excess, 0.1) for f in failing),
        marks=()
        if verdict == "none"
        else (
            Mark(
                "loop energy",
                "loop energy does not depend on rate (exponent 0.02)",
                0.02,
                0.05,
                "slope of log energy over log rate",
            ),
        ),
        next_experiment=next_one if verdict == "confusable" else None,
        notes=("noise from 6 repeats.",),
        seconds=12.5,
    )


def made_check(title: str = "Bench tests of a made cable") -> Check:
    comparison = compared(3.0, title)
    return Check(
        comparison.campaign,
        comparison.noise,
        (),
        separation(),
        (Untestable("thermal-softening", "all experiments at 20 degC"),),
        {"interlayer-friction": "a slip limit of 0.2 N m"},
        (),
    )


def write_campaign(folder: Path, friction: float = 3.0, sealed: tuple[str, ...] = ()) -> Path:
    """The made campaign as a folder; the experiments named in `sealed` are of that set."""
    folder.mkdir(parents=True)
    lines = ["id,kind,file,specimen,repeat_of,set,axial tension [N],temperature [degC],specimen length [m]"]
    for e in loops(friction):
        r, put = e.record, "sealed" if e.id in sealed else e.set
        lines.append(
            f"{e.id},{e.kind},{e.file},{e.specimen},{e.repeat_of or ''},{put},{e.conditions['axial tension']:g},20,1"
        )
        table = np.column_stack([r.time, r["curvature"], r["moment"]])
        head = "time [s],curvature [1/m],moment [N m]"
        np.savetxt(folder / e.file, table, delimiter=",", header=head, comments="", fmt="%.9g")
    (folder / "experiments.csv").write_text("\n".join(lines) + "\n")
    (folder / "campaign.toml").write_text(TOML.replace("a test", "Bench tests of a made cable"))
    return folder
