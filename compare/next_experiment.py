r"""The experiment that would separate the rivals: where their predictions differ most after each is fitted to all data.

For a condition x the best effect b is taken as true and the rival j is fitted, with its stiffness, strengths and shapes, to
what b predicts for the experiments that exist and for x twice (with a repeat),

.. math::  D^2(x) = \min_{\theta_j, a_j} |W (f_b - f_j)|^2_{\text{existing} + x} ,\qquad P(\text{wrong}) = \Phi(-D/2)

and x is the condition whose smallest D over the rivals is largest, or the cheapest of those with
D > 10. Source: T-optimal designs, Atkinson & Fedorov,
Biometrika 62 (1975) 57; Buzzi-Ferraris & Forzatti 1983. Repeating what exists is among the candidates, for honesty.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtr

from compare.bench_design import BenchRecord, Block, Whitener
from compare.findings import NextExperiment
from compare.form_fit import shape_grid
from compare.gram import Scan, energy, positive_flags
from compare.search import Attempt, Stage
from effects.effect import STRAIN_UNITS, ActiveEffect, BenchPath

Array = NDArray[np.float64]
_ZERO_CELSIUS = 273.15
_SHAPES, _SHAPES_OF_RUNS = 40, 5
_REPEATS = 2
_NO_BETTER = 0.5
_CLEAR = 10.0  # a distance that is enough: beyond it the cheaper condition wins
_SMALLEST_P = 1e-6  # chances below it are not claimed
_PATH_WORDS = {"tension": "strain", "torsion": "twist", "bending": "curvature", "shear": "deflection over length"}


@dataclass(frozen=True)
class Proposal:
    """A condition to be tested: its path and the words for it; `conditions` as in experiments.csv.

    `cost` counts what differs from conditions that the rig has shown that it can reach, larger paths twice. `record` is
    that of the new experiment where it is no path alone (towing).
    """

    path: BenchPath = field(repr=False)
    conditions: Mapping[str, float]
    words: str
    cost: float = 0.0
    record: Any = field(default=None, repr=False)


def proposals(block: Block) -> Iterator[Proposal]:
    """Conditions within reach: one or two of the existing ones changed, amplitude, rate, tension, temperature, length."""
    if block.kind == "towing":
        from compare.next_towing import towing_proposals

        yield from towing_proposals(block)
        return
    record = max(block.records, key=lambda r: float(np.abs(r.led.path.strain).max()))
    path = replace(record.led.path, strain=record.led.path.strain[record.led.lead :])
    lead = record.led.lead
    if lead:
        path = replace(
            path,
            time=None if path.time is None else path.time[lead:] - path.time[lead],
            tension=None if path.tension is None else path.tension[lead:],
        )
    for amplitude in (1.0, 2.0):
        for rate in (1.0, 0.2, 5.0) if path.time is not None else (1.0,):
            for tension in _tensions(block):
                for temperature in _temperatures(block):
                    for length in _lengths(block):
                        yield _proposal(block, path, amplitude, rate, tension, temperature, length)


def _tensions(block: Block) -> Sequence[float | None]:
    values = [float(p.tension.mean()) for p in block.paths if p.tension is not None]
    if block.kind == "tension" or not values:
        return (None,)
    return sorted({min(values), max(values), 2.0 * max(values)})


def _temperatures(block: Block) -> Sequence[float | None]:
    values = [p.temperature for p in block.paths if p.temperature is not None]
    return (None,) if not values else sorted({min(values), max(values), max(values) + 20.0})


def _lengths(block: Block) -> Sequence[float | None]:
    values = [p.length for p in block.paths if p.length is not None]
    return (None,) if not values or block.kind == "shear" else sorted({min(values), max(values), 2.0 * max(values)})


def _proposal(
    block: Block,
    path: BenchPath,
    amplitude: float,
    rate: float,
    tension: float | None,
    temperature: float | None,
    length: float | None,
) -> Proposal:
    strain = amplitude * path.strain
    time = None if path.time is None else path.time / rate
    grip = path.tension
    if block.kind == "tension" and grip is not None:
        grip = amplitude * grip
    elif tension is not None:
        grip = np.full(len(strain), tension)
    new = replace(path, strain=strain, time=time, tension=grip, temperature=temperature or path.temperature)
    new = replace(new, length=length or path.length)
    conditions: dict[str, float] = {}
    words = [f"a largest {_PATH_WORDS[block.kind]} of {np.abs(strain).max():.3g}"]
    speed = 0.0
    if time is not None:
        speed = float(np.abs(np.diff(strain) / np.diff(time)).max())
        words.append(f"a largest rate of {speed:.3g} per second")
    for name, value, text in (
        ("axial tension [N]", tension, f"axial tension {tension or 0:.4g} N"),
        ("temperature [degC]", None if temperature is None else temperature - _ZERO_CELSIUS,
         f"{(temperature or 0) - _ZERO_CELSIUS:.3g} degC"),
        ("specimen length [m]", length, f"specimen length {length or 0:.3g} m"),
    ):  # fmt: skip
        if value is not None:
            conditions[name] = round(float(value), 6)
            words.append(text)
    unit = "-" if STRAIN_UNITS[block.kind] == "1" else STRAIN_UNITS[block.kind]
    conditions[f"largest {_PATH_WORDS[block.kind]} [{unit}]"] = float(f"{np.abs(strain).max():.4g}")
    if time is not None:
        conditions[f"largest rate [{unit.replace('-', '1')}/s]"] = float(f"{speed:.4g}")
    return Proposal(new, conditions, ", ".join(words), _cost(block, amplitude, rate, tension, temperature, length))


def _cost(
    block: Block, amplitude: float, rate: float, tension: float | None, temperature: float | None, length: float | None
) -> float:
    """Twice for a larger path, once for a tension, temperature or length beyond what was tested, half for another rate."""
    beyond = [
        tension is not None
        and tension > 1.01 * max(float(p.tension.mean()) for p in block.paths if p.tension is not None),
        temperature is not None
        and temperature > 0.1 + max(p.temperature for p in block.paths if p.temperature is not None),
        length is not None and length > 1.01 * max(p.length for p in block.paths if p.length is not None),
    ]
    return 2.0 * (amplitude > 1) + float(sum(beyond)) + 0.5 * (rate != 1)


def separating_experiment(rest: Stage, rivals: Sequence[Attempt]) -> NextExperiment | None:
    """The condition that best separates rivals for one place in a model.

    Parameters
    ----------
    rest : Stage
        The accepted effects but for the one in question.
    rivals : sequence of Attempt
        Best first, tried on that stage.
    """
    best = rivals[0]
    b = best.trials[0].site.block
    others = [r for r in rivals[1:] if r.trials[0].site.block == b]
    if not others:
        return None
    block = rest.blocks[b]
    truth = best.trials[0].fit
    gaps = np.array([0.0, *[best.rank - r.rank for r in others]])
    weights = np.exp(-np.maximum(gaps, 0.0))
    before = float(1 - weights[0] / weights.sum())
    contests = [_Contest(rest, b, truth.term, truth.x, other) for other in others]
    found = [(min(c.distance(p) for c in contests), p) for p in proposals(block)]
    enough = min(max(d for d, _ in found), _CLEAR)
    D, chosen = min((f for f in found if f[0] >= enough), key=lambda f: (f[1].cost, -f[0]))
    again = min(c.distance(None) for c in contests)
    names = tuple(r.effect.name for r in (best, *others))
    after, repeat = max(float(ndtr(-D / 2)), _SMALLEST_P), max(float(ndtr(-again / 2)), _SMALLEST_P)
    if D < _NO_BETTER:
        sentence = (
            f"no {block.kind} experiment within reach separates {' from '.join(names)}: they are the same law there. "
            "Look at the place itself, for instance at the strain of the specimen away from its grips"
        )
        return NextExperiment(block.kind, {}, names, before, before, before, sentence)
    sentence = f"{block.kind} with {chosen.words}, done twice, separates {' from '.join(names)}"
    return NextExperiment(
        block.kind, chosen.conditions, names, before, min(after, before), min(repeat, before), sentence
    )


class _Contest:
    """One rival against the best effect, on the existing experiments and on a new one."""

    def __init__(self, rest: Stage, b: int, truth: ActiveEffect, x: Array, rival: Attempt) -> None:
        self.block, self.accepted = rest.blocks[b], rest.accepted[b]
        self.truth, self.x = (*self.accepted, truth), x
        term = rival.trials[0].fit.term
        grid = shape_grid(term.form, self.block)
        most = _SHAPES_OF_RUNS if self.block.kind == "towing" else _SHAPES
        grid = [grid[i] for i in np.unique(np.linspace(0, len(grid) - 1, most).round().astype(int))]
        self.terms = [(*self.accepted, replace(term, shape=s)) for s in (term.shape, *grid)]
        self.scan = Scan(self.block, self.accepted)
        self.positive = positive_flags(self.block, self.terms[0])
        known = [self._products(record) for record in self.block.records]
        self.existing = np.sum(known, axis=0)

    def distance(self, proposal: Proposal | None) -> float:
        """D with the new condition done twice, or with everything repeated."""
        new = (
            self.existing
            if proposal is None
            else _REPEATS * self._products(proposal.record or _new_record(self.block, proposal.path))
        )
        S = self.existing + new
        base = self.scan.base()
        model = replace(base, S=S[:, None], positive=self.positive)
        mean = np.zeros(model.P)
        x = model.fit(S, prior=(mean, np.full((len(S), model.P), 1e-9)))
        return float(np.sqrt(max(0.0, float(np.min(energy(S, x))))))

    def _products(self, record: BenchRecord) -> Array:
        """V^T V of the rival at every shape, the best effect's prediction as the target: (m, P + 1, P + 1)."""
        target = record.whitened(self.truth) @ self.x
        V = [np.column_stack([record.whitened(terms), target]) for terms in self.terms]
        return np.array([v.T @ v for v in V])


def _new_record(block: Block, path: BenchPath) -> BenchRecord:
    """A record of a block on another path, with the noise of its channels."""
    driven = [r for r in block.records if not any(x.flipped for x in r.readings)]
    template = driven[0] if driven else block.records[0]
    n = len(path.strain)
    readings = tuple(
        replace(
            r, y=np.zeros(n), signal=r.stiffness * path.strain,
            whiten=Whitener.of(r.whiten.noise, r.stiffness * path.strain / r.whiten.factor, r.whiten.factor),
        )
        for r in template.readings
    )  # fmt: skip
    return replace(template, led=replace(template.led, path=path, lead=0), readings=readings)
