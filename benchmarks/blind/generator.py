"""Makes one hidden-effect campaign from a seed: records for the folder, and a label that never goes there.

>>> from benchmarks.blind.generator import make, label
>>> folder = make(7, "out/campaign-7")                                             # doctest: +SKIP
>>> label(7)["effects"]                                                            # doctest: +SKIP
>>> make(7, "out/mine", effects=("slack",), design="rich", noise="white", size=0.01, strength=0.05)   # doctest: +SKIP
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.blind.bench import Bench
from benchmarks.blind.campaign_writer import MeasuredKind, write_campaign
from benchmarks.blind.designs import make_bench
from benchmarks.blind.noise import Noise
from benchmarks.blind.plan import Case, case_of, draw_design, may_shear, possible_kinds
from benchmarks.blind.rivals import nearest_rival
from benchmarks.blind.strength import base_signal, channel_rms, cross_unit, distance, of_share, share_not_linear
from benchmarks.blind.ties import exactly_tied, looks_like_a_condition, twins, untestable
from benchmarks.blind.truth import Truth, respond
from benchmarks.blind.truths import ALL, LIBRARY

_EVERYWHERE = ("thermal-softening", "viscoelasticity", "viscous-damping")
_RADIUS = 0.008
_VISIBLE = 1.5
_TRIES = 60
_FAR = 60.0
"""Distance from which a single truth is taken to be far from all rivals."""


@dataclass(frozen=True)
class Hidden:
    """Everything about one campaign; the folder gets only what the rig would have seen."""

    case: Case
    design: str
    benches: tuple[Bench, ...]
    truths: tuple[tuple[Truth, ...], ...]
    noise: Noise
    clock: bool
    second: bool

    @property
    def cross_noise(self) -> Noise | None:
        return Noise(self.noise.kind, self.noise.size, self.noise.gain, self.noise.offset) if self.second else None


def draw_noise(rng: np.random.Generator, kind: str, size: float, bench: Bench) -> Noise:
    """Scatter comes in a light form (1 % gain, 0.5 % offset) and a heavy one (2 % of rms/largest, 1 %)."""
    if kind != "scatter":
        return Noise(kind, size)
    if rng.random() < 0.5:
        return Noise(kind, size, 0.01, 0.005)
    signal = base_signal(bench)
    return Noise(kind, size, 0.02 * channel_rms(bench, signal) / float(np.abs(signal).max()), 0.01)


def _slice(bench: Bench, rows: Sequence[int]) -> Bench:
    r = list(rows)
    return replace(
        bench, strain=bench.strain[r], time=bench.time[r], count=bench.count[r], length=bench.length[r],
        tension=bench.tension[r], temperature=bench.temperature[r], frequency=bench.frequency[r],
        set_names=tuple(bench.set_names[i] for i in r),
    )  # fmt: skip


def _draw_benches(rng: np.random.Generator, case: Case) -> tuple[str, tuple[Bench, ...]]:
    """Design and conditions that suit the case."""
    for _ in range(_TRIES):
        design = case.design or draw_design(rng, case.effects)
        kind = case.kind or str(rng.choice(possible_kinds(case.effects, design)))
        if case.kind is None and may_shear(case.effects, design) and rng.random() < 0.06:
            kind = "shear"
        bench = make_bench(rng, kind, design, design == "load-controlled")
        second = design != "load-controlled" and "tension-torsion-coupling" in case.effects
        clock = design != "no-clock"
        hidden = [untestable(name, bench, clock, second) for name in case.effects]
        tied = [bool(twins(name, bench, design)) for name in case.effects]
        exact = [exactly_tied(name, bench, design) for name in case.effects]
        wanted = {"single": not any(hidden) and not any(tied), "pair": not any(hidden) and not any(exact)}
        wanted |= {"tie": any(tied) and not any(hidden), "untestable": all(hidden)}
        if case.group == "outside":
            probe = ALL[case.effects[0]].draw(np.random.default_rng(0), bench).of_size(0.1)
            wanted["outside"] = not looks_like_a_condition(bench, respond(bench, [probe])["main"])
        if wanted.get(case.group, True) or (case.design is not None and case.group == "single"):
            break
    two = case.two_kinds if case.two_kinds is not None else rng.random() < 0.12
    if not two or bench.kind == "shear" or design in ("load-controlled", "no-clock"):
        return design, (bench,)
    other = str(rng.choice([k for k in ("tension", "torsion", "bending") if k != bench.kind]))
    second_bench = make_bench(rng, other, design)
    return design, (_slice(bench, (0, 1, 2, 3, 4, 6, 8)), _slice(second_bench, (0, 1, 2, 3, 6, 8)))


def _draw_truths(rng: np.random.Generator, case: Case, bench: Bench) -> tuple[Truth, ...]:
    truths = []
    for i, name in enumerate(case.effects):
        variant = case.variants[i] if i < len(case.variants) else None
        truth = ALL[name].draw(rng, bench, variant)
        truths.append(of_share(bench, truth, case.strength) if case.strength else truth.of_size(0.0))
    return tuple(truths)


def _expected_f0(bench: Bench, d: float) -> float:
    """Lack of fit F that a distance d gives on average with two repeats."""
    return 1 + d**2 / float(bench.count[bench.fitted_rows].sum())


def hidden(seed: int, **changes: Any) -> Hidden:
    """Draw a campaign; `changes` sets fields of :class:`benchmarks.blind.plan.Case` by hand."""
    case = case_of(seed).but(**changes)
    rng = np.random.default_rng([31337, seed])
    design, benches = _draw_benches(rng, case)
    bench = benches[0]
    coupling = "tension-torsion-coupling" in case.effects
    second = design != "load-controlled" and bench.kind in ("tension", "torsion")
    second = second and (coupling or bool(rng.random() < (0.7 if bench.kind == "tension" else 0.3)))
    noise = draw_noise(rng, case.noise, case.size, bench)
    truths = [_draw_truths(rng, case, bench)]
    if case.group == "outside":
        for _ in range(8):
            d = distance(bench, noise, None, truths[0])
            if _expected_f0(bench, d) > _VISIBLE or case.strength > 0.5:
                break
            case = replace(case, strength=1.6 * case.strength)
            truths[0] = tuple(of_share(bench, t, case.strength) for t in truths[0])
    for other in benches[1:]:
        everywhere = case.but(effects=tuple(n for n in case.effects if n in _EVERYWHERE), group=case.group)
        truths.append(_draw_truths(rng, replace(everywhere, variants=()), other))
    return Hidden(case, design, benches, tuple(truths), noise, design != "no-clock", second)


def label_of(made: Hidden) -> dict[str, Any]:
    """What is true of a campaign, for the scorecard only."""
    case, bench, truths = made.case, made.benches[0], made.truths[0]
    hidden_names = [n for n in case.effects if n in LIBRARY and untestable(n, bench, made.clock, made.second)]
    sets = {n: twins(n, bench, made.design) for n in case.effects if n in LIBRARY}
    whole = distance(bench, made.noise, made.cross_noise, truths) if truths else 0.0
    alone = [
        distance(bench, made.noise, made.cross_noise, truths, truths[:i] + truths[i + 1 :]) for i in range(len(truths))
    ]
    rival, apart = "", whole
    alone_on_main = case.group == "single" and "tension-torsion-coupling" not in case.effects
    if alone_on_main and whole < _FAR and not bench.load_control:
        rng = np.random.default_rng([808, case.seed])
        rival, apart = nearest_rival(rng, bench, made.noise, truths[0], made.clock)
    return {
        "seed": case.seed, "group": case.group, "effects": list(case.effects), "variants": [t.variant for t in truths],
        "kind": "+".join(b.kind for b in made.benches), "design": made.design, "noise": case.noise, "size": case.size,
        "gain": made.noise.gain, "strength": case.strength,
        "achieved": round(share_not_linear(bench, truths), 5) if truths else 0.0,
        "D": round(whole, 2), "D_alone": [round(d, 2) for d in alone], "F0": round(_expected_f0(bench, whole), 3),
        "untestable": hidden_names, "twins": sorted({t for s in sets.values() for t in s}),
        "tied": [n for n in sets if exactly_tied(n, bench, made.design)],
        "rival": rival, "apart": round(apart, 2), "clock": made.clock, "second_channel": made.second,
    }  # fmt: skip


def label(seed: int, **changes: Any) -> dict[str, Any]:
    """The label of a seed."""
    return label_of(hidden(seed, **changes))


def make(seed: int, folder: str | Path, **changes: Any) -> Path:
    """Write the campaign of a seed; nothing in the folder tells the truth."""
    return write(hidden(seed, **changes), folder)


def write(made: Hidden, folder: str | Path) -> Path:
    """Write a campaign that was drawn before."""
    rng = np.random.default_rng([4242, made.case.seed])
    order, kinds = [], []
    for k, (bench, truths) in enumerate(zip(made.benches, made.truths, strict=True)):
        kinds.append(_measure(rng, made, bench, truths, second=made.second and k == 0))
        order += [(k, c) for c in range(len(bench.count))]
    shuffled = [order[i] for i in rng.permutation(len(order))]
    records = [(k, r) for k, c in shuffled for r, owner in enumerate(kinds[k].condition) if owner == c]
    wrong = {name: np.exp(rng.uniform(np.log(0.62), np.log(1.4))) for name in ("EA", "GA", "EI", "GJ")}
    path = Path(folder)
    title = f"{' and '.join(b.kind for b in made.benches)} loops, {len(order)} conditions, two repeats"
    write_campaign(path, title, _section(made, wrong), _sensors(rng, made), kinds, records)
    return path


def _measure(
    rng: np.random.Generator, made: Hidden, bench: Bench, truths: tuple[Truth, ...], second: bool
) -> MeasuredKind:
    clean = respond(bench, truths)
    rms = channel_rms(bench, clean["main"])
    unit = _RADIUS * bench.stiffness if bench.kind == "tension" else bench.stiffness / _RADIUS
    condition = [c for c in range(len(bench.count)) for _ in range(2)]
    if made.noise.gain:
        specimen = [f"S{i + 1:02d}" for i in rng.permutation(len(condition))]
    else:
        specimen = [str(s) for s in rng.choice(["A", "B"] if rng.random() < 0.7 else ["A"], len(condition))]
    main, cross, given = [], [], []
    for c in condition:
        n = bench.count[c]
        path = bench.stiffness * bench.strain[c, :n] if bench.load_control else bench.strain[c, :n]
        given.append(path)
        y = clean["main"][c, :n]
        main.append(y + made.noise.draw(rng, y, rms))
        z = clean["cross"][c, :n]
        cross.append(unit * (z + made.noise.draw(rng, z, cross_unit(bench))))
    names = {"tension": ["extension"] * 4 + ["strain"], "torsion": ["twist", "twist", "rotation"]}
    names |= {"bending": ["curvature"], "shear": ["deflection"]}
    direction = None
    if bench.kind == "shear":
        direction = [str(d) for d in rng.choice(["x+", "y+"], len(bench.count))]
    path_name = str(rng.choice(names[bench.kind]))
    return MeasuredKind(
        bench, path_name, condition, specimen, given, main, cross if second else None, made.clock, direction
    )


def _section(made: Hidden, wrong: dict[str, float]) -> dict[str, str]:
    """Nominal stiffness, wrong by up to 40 %."""
    true = {"EA": 8e5, "GA": 3e5, "EI": 70.0, "GJ": 60.0}
    for bench in made.benches:
        if bench.kind == "shear":  # load = K u/L with K/L = 1/(L^3/3EI + L/GA); bending and shear share alike
            L = float(bench.length[0])
            true["EI"], true["GA"] = bench.stiffness * L**2 / 3 * 1.1, 11 * bench.stiffness
        else:
            true[{"tension": "EA", "torsion": "GJ", "bending": "EI"}[bench.kind]] = bench.stiffness
    units = {"EA": "N", "GA": "N", "EI": "N m^2", "GJ": "N m^2"}
    return {k: f"{true[k] * wrong[k]:.4g} {units[k]}" for k in true} | {"mass_per_length": "4.6 kg/m"}


def _sensors(rng: np.random.Generator, made: Hidden) -> dict[str, str]:
    """What a data sheet would say of the load channel; left out in half of the campaigns."""
    if rng.random() < 0.5 or made.design == "load-controlled":
        return {}
    unit = {
        "tension": ("force", "N"),
        "torsion": ("torque", "N m"),
        "bending": ("moment", "N m"),
        "shear": ("force", "N"),
    }
    bench = made.benches[0]
    name, si = unit[bench.kind]
    return {name: f"{made.noise.size * channel_rms(bench, base_signal(bench)):.3g} {si}"}
