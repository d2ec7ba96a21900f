r"""The columns of a towing record: the axial chain made linear about its working point.

The run f(x, a) of a record depends on the friction ratio x and on the strengths a of effects. With the calibrated base f(1, 0)
and its slope J over x, the target and the columns are

.. math::  y - f(1,0) + J \approx Z_0\,x + \sum_j Z_j a_j, \qquad Z_0 = J

A new effect enters by a difference quotient at a small strength (one run per strength and record); where that explains
anything it is fitted, the record run once more at the fitted values, and its column corrected by Broyden's rank-one update,
so that the right hand side is exact at the fitted values and not linearised there. An effect that has shapes alone (a
drive) changes Z_0 in the same way. Sensors act on the columns as on the bench. Runs are kept, so that nothing is run twice.

While shapes are searched columns are *rough*: those of the difference quotients, Z(q) at the shape q, shifted by what corrects
them at a shape q_0 close by, Z(q) + [Z_corrected(q_0) - Z(q_0)]. Runs that do not wait for each other are done on all cores.
"""

from __future__ import annotations

import os
from collections import OrderedDict
from collections.abc import Hashable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from compare.bounded_least_squares import solve_bounded
from compare.experiment import Experiment
from compare.towing_setup import TowingSetup, read_channels, towing_path, with_effects
from effects.effect import ActiveEffect, Form, Parameter
from effects.effect_check import TOWED
from geometry.errors import ConvergenceError, InputError

if TYPE_CHECKING:
    from compare.towing_design import TowingRecord

Array = NDArray[np.float64]
Terms = tuple[ActiveEffect, ...]
Shape = tuple[float, ...]
_Job = tuple[Experiment, float, Terms]
_SLOPE = 0.02  # step of the friction ratio
_WORTH_A_RUN = 8.0  # fall of the square residual below which a column is not corrected
_MOST_ROUNDS = 5
_CLOSE = 0.3  # square residual by which a linear column may be off the run
_KEPT = 300_000_000  # bytes of columns, about
_LOWEST = 0.02  # of the friction ratio
_FAR = 5.0  # times the largest plausible strength


@dataclass(frozen=True)
class _Fit:
    """Coefficients of the base and of every chain term, and the square residual that they leave."""

    x: Array
    square: float


class TowingResponse:
    """Runs of the chain for the records of a block, kept by what went into them.

    Parameters
    ----------
    setup : TowingSetup
    friction : float
        Calibrated coefficient, about which x is 1.
    """

    def __init__(self, setup: TowingSetup, friction: float) -> None:
        self.setup, self.friction = setup, friction
        self.block: tuple[TowingRecord, ...] = ()
        self._kept: OrderedDict[Hashable, Any] = OrderedDict()
        self._led: dict[str, Hashable] = {}
        self._of_steps: dict[Hashable, list[Array]] = {}
        self.runs = 0
        self._size = 1  # bytes of the columns of the longest record, about

    def hold(self, records: tuple[TowingRecord, ...]) -> None:
        """Take the records to which columns are fitted."""
        self.block = records
        self._size = max(16 * sum(len(reading.y) for reading in r.readings) for r in records)

    def base(self, experiment: Experiment) -> tuple[list[Array], list[Array]]:
        """f(1, 0) and its slope over the friction ratio, per channel."""
        at, ahead = self.run(experiment, 1.0, ()), self.run(experiment, 1.0 + _SLOPE, ())
        return at, [(b - a) / _SLOPE for a, b in zip(at, ahead, strict=True)]

    def run(self, experiment: Experiment, x: float, terms: Terms) -> list[Array]:
        """Tension of every channel at a friction ratio, with chain terms whose strengths are given."""
        return self._keep(self._run_key(experiment, x, terms), lambda: self._run(experiment, x, terms))

    def prepare(self, models: Sequence[Terms]) -> None:
        """Run what the rough columns of all records for several last terms take, on all cores."""
        jobs: list[_Job] = []
        for terms in models:
            if terms and terms[-1].form.stage in TOWED:
                x, parts = self._working(terms[:-1]).x, _parts(terms)[0]
                runs = [_with_strengths(parts[:-1], x)] * bool(terms[-1].form.strength) + _probes(parts, x)
                jobs += [(r.experiment, float(x[0]), run) for r in self.block for run in runs]
        self._ahead(jobs)

    def _ahead(self, jobs: Sequence[_Job]) -> None:
        """Run on all cores what is not kept yet; each run is the same wherever and whenever it is done.

        What finds no balance is left to be found out where it is asked for.
        """
        missing: dict[Hashable, _Job] = {}
        for job in jobs:
            key = self._run_key(*job)
            if key not in self._kept:
                missing[key] = job
        if len(missing) < 2 or (pool := _pool()) is None:
            return
        for key, found in zip(missing, pool.map(lambda job: self._tried(*job), missing.values()), strict=True):
            if found is not None:
                self.runs += 1
                self._keep(key, lambda found=found: found)

    def _tried(self, experiment: Experiment, x: float, terms: Terms) -> list[Array] | None:
        try:
            return self._tensions(experiment, x, terms)
        except (ConvergenceError, InputError):
            return None

    def _run_key(self, experiment: Experiment, x: float, terms: Terms) -> Hashable:
        return "run", self._motion(experiment), float(x), *(_key(t) for t in terms)

    def _motion(self, experiment: Experiment) -> Hashable:
        """What a run depends on beside its terms; the same for repeats that were led alike."""
        if experiment.id not in self._led:
            path, given = towing_path(experiment, self.setup), experiment.conditions
            assert path.time is not None
            told = hash((path.time.tobytes(), path.strain.tobytes()))
            self._led[experiment.id] = (
                told, given.get("tail tension"), given.get("inclination"), experiment.record.measured
            )  # fmt: skip
        return self._led[experiment.id]

    def _run(self, experiment: Experiment, x: float, terms: Terms) -> list[Array]:
        self.runs += 1
        return self._tensions(experiment, x, terms)

    def _tensions(self, experiment: Experiment, x: float, terms: Terms) -> list[Array]:
        """As if every run took the steps of the base: that a drive takes finer ones is nothing that it explains."""
        cable = with_effects(self.setup.cable(experiment, self.friction * x), terms)
        found = list(read_channels(cable, experiment).values())
        if (fine := cable.chain.substeps(cable.time, cable.shortest)) > cable.chain.substeps(cable.time):
            finer = self._finer(experiment, fine, cable.shortest)
            found = [a - b for a, b in zip(found, finer, strict=True)]
        return found

    def _finer(self, experiment: Experiment, steps: int, shortest: float) -> list[Array]:
        """What so many steps between two samples change in the base run."""
        key = (self._motion(experiment), steps)
        if key not in self._of_steps:
            cable = self.setup.cable(experiment, self.friction)
            runs = (read_channels(c, experiment).values() for c in (replace(cable, shortest=shortest), cable))
            self._of_steps[key] = [a - b for a, b in zip(*runs, strict=True)]
        return self._of_steps[key]

    def columns(self, record: TowingRecord, terms: Terms) -> list[Array]:
        """All columns in the order of `terms`, as the sensors read them."""
        key = ("columns", record.experiment.id, *(_key(t) for t in terms))
        return self._keep(key, lambda: self._sensed(record, self._chain(record, terms), terms))

    def rough_columns(self, record: TowingRecord, terms: Terms, near: Shape | None = None) -> list[Array]:
        """The same, linear in the last term, or corrected as at its shape `near`."""
        key = ("rough", near, record.experiment.id, *(_key(t) for t in terms))
        return self._keep(key, lambda: self._sensed(record, self._nearly(record, terms, near), terms))

    def _nearly(self, record: TowingRecord, terms: Terms, near: Shape | None) -> list[Array]:
        rough = self._begin(record, terms)
        if near is None:
            return rough
        anchor = (*terms[:-1], replace(terms[-1], shape=near))
        exact, begun = self._chain(record, anchor), self._begin(record, anchor)
        return [z + (b - a) for z, a, b in zip(rough, begun, exact, strict=True)]

    def _sensed(self, record: TowingRecord, inner: Sequence[Array], terms: Terms) -> list[Array]:
        time, offset = record.led.path.time, self._offset(record.experiment)
        found = []
        for reading, Z, o in zip(record.readings, inner, offset, strict=True):
            base, at, parts = Z[:, :1], 1, []
            for term in terms:
                k = len(term.form.strength)
                of_chain = term.form.stage in TOWED
                parts.append(Z[:, at : at + k] if of_chain else np.zeros((len(Z), k)))
                at += k if of_chain else 0
            Y = np.column_stack([base, *parts])
            for term in terms:
                if term.form.stage == "filter" and term.channel == reading.channel:
                    lagged = term.form.respond(np.column_stack([Y, o]), time, *term.shape)
                    Y = np.array(lagged[:, :-1])
                    Y[:, 0] += lagged[:, -1] - o
            begin = 1
            for term in terms:
                k = len(term.form.strength)
                if term.form.stage == "bias" and term.channel == reading.channel:
                    c = term.form.respond(record.led.path, *term.shape)
                    Y[:, begin : begin + k] = c[:, None] if c.ndim == 1 else c
                begin += k
            found.append(np.ascontiguousarray(Y))
        return found

    def _offset(self, experiment: Experiment) -> list[Array]:
        f, J = self.base(experiment)
        return [a - b for a, b in zip(f, J, strict=True)]

    def _chain(self, record: TowingRecord, terms: Terms) -> list[Array]:
        """Columns of base and chain terms, (n, 1 + k) per reading, exact where all terms together are fitted."""
        key = ("chain", record.experiment.id, *(_key(t) for t in terms))
        return self._keep(key, lambda: self._corrected(record, terms))

    def _corrected(self, record: TowingRecord, terms: Terms) -> list[Array]:
        Z = self._begin(record, terms)
        for x in self._visited(terms):
            Z = self._updated(record, _parts(terms)[0], Z, x)
        return Z

    def _begin(self, record: TowingRecord, terms: Terms) -> list[Array]:
        """The columns before they are corrected: a sensor takes them as they were without it, a chain term adds its own."""
        if not _parts(terms)[0]:
            return [J[:, None] for J in self.base(record.experiment)[1]]
        if terms[-1].form.stage not in TOWED:
            return self._chain(record, terms[:-1])
        return self._first(record, terms)

    def _updated(self, record: TowingRecord, chain: Terms, Z: Sequence[Array], x: Array) -> list[Array]:
        """Broyden's update of the columns of the last term, or of the base for a drive, by the run at x."""
        try:
            f = self.run(record.experiment, float(x[0]), _with_strengths(chain, x))
        except (ConvergenceError, InputError):
            return list(Z)
        k = len(chain[-1].form.strength)
        own = slice(len(x) - k, len(x)) if k else slice(0, 1)
        size = float(x[own] @ x[own])
        if size == 0.0:
            return list(Z)
        updated = []
        for fr, o, old in zip(f, self._offset(record.experiment), Z, strict=True):
            new = old.copy()
            new[:, own] += np.outer(fr - o - old @ x, x[own]) / size
            updated.append(new)
        return updated

    def _first(self, record: TowingRecord, terms: Terms) -> list[Array]:
        """Columns with the last term by difference quotients at small strengths, a drive at the friction that it was without."""
        rest, chain = terms[:-1], _parts(terms)[0]
        Z, x = self._chain(record, rest), self._working(rest).x
        if not terms[-1].form.strength:
            return self._updated(record, chain, Z, x)
        at = self.run(record.experiment, float(x[0]), _with_strengths(chain[:-1], x))
        parts: list[list[Array]] = [[z] for z in Z]
        for k, probe in enumerate(_probes(chain, x)):
            try:
                f = self.run(record.experiment, float(x[0]), probe)
            except (ConvergenceError, InputError):
                f = at
            for part, a, b in zip(parts, at, f, strict=True):
                part.append(((b - a) / probe[-1].strength[k])[:, None])
        return [np.hstack(part) for part in parts]

    def _visited(self, terms: Terms) -> list[Array]:
        """The coefficients at which the records are run to correct the columns, none where these explain too little."""
        return self._keep(("visited", *(_key(t) for t in terms)), lambda: self._visit(terms))

    def _visit(self, terms: Terms) -> list[Array]:
        chain = _parts(terms)[0]
        if not chain:
            return []
        self.prepare([terms])
        Z = [self._begin(r, terms) for r in self.block]
        k, visited = len(chain[-1].form.strength), []
        found = self._fit(Z, terms)
        gain = self._working(terms[:-1]).square - found.square
        if terms[-1] is chain[-1] and gain < _WORTH_A_RUN:
            return []
        while len(visited) < _MOST_ROUNDS and (not k or found.x[-k:].any()):
            visited.append(found.x)
            self._ahead([(r.experiment, float(found.x[0]), _with_strengths(chain, found.x)) for r in self.block])
            new = [self._updated(r, chain, z, found.x) for r, z in zip(self.block, Z, strict=True)]
            missed = sum(
                float(np.sum(reading.whiten((a - b) @ found.x[:, None]) ** 2))
                for r, zs, olds in zip(self.block, new, Z, strict=True)
                for reading, a, b in zip(r.readings, zs, olds, strict=True)
            )
            Z = new
            if missed < _CLOSE:
                break
            found = self._fit(Z, terms)
        return visited

    def _working(self, terms: Terms) -> _Fit:
        """Coefficients of base and chain terms at which the columns are fitted to the block."""
        key = ("working", *(_key(t) for t in terms))
        return self._keep(key, lambda: self._fit([self._chain(r, terms) for r in self.block], terms))

    def _fit(self, Z: Sequence[Sequence[Array]], terms: Terms) -> _Fit:
        P = 1 + sum(len(t.form.strength) for t in terms)
        A, b, yy = np.zeros((P, P)), np.zeros(P), 0.0
        for record, own in zip(self.block, Z, strict=True):
            for reading, columns in zip(record.readings, self._sensed(record, own, terms), strict=True):
                white = reading.whiten(np.column_stack([columns, reading.y]))
                A += white[:, :-1].T @ white[:, :-1]
                b += white[:, :-1].T @ white[:, -1]
                yy += float(white[:, -1] @ white[:, -1])
        scale = 1 / np.sqrt(np.maximum(np.diag(A), 1e-300))
        positive = np.array([True, *(p.low >= 0 for t in terms for p in t.form.strength)], dtype=np.bool_)
        x = np.zeros((1, P))
        unit = A * scale[:, None] * scale + 1e-10 * np.eye(P)
        solve_bounded(np.ascontiguousarray(unit[None]), np.ascontiguousarray((b * scale)[None]), positive, x)
        full = x[0] * scale
        square = float(yy - 2 * full @ b + full @ A @ full)
        in_chain = [True, *(t.form.stage in TOWED for t in terms for _ in t.form.strength)]
        return _Fit(_sane(full[in_chain], _parts(terms)[0]), square)

    def _keep(self, key: Hashable, make: Any) -> Any:
        if key in self._kept:
            self._kept.move_to_end(key)
            return self._kept[key]
        value = make()
        self._kept[key] = value
        while len(self._kept) > max(1000, _KEPT // self._size):
            self._kept.popitem(last=False)
        return value


def _parts(terms: Terms) -> tuple[Terms, Terms]:
    return tuple(t for t in terms if t.form.stage in TOWED), tuple(t for t in terms if t.form.stage not in TOWED)


def _key(term: ActiveEffect) -> Hashable:
    return term.effect.name, term.form.name, term.channel, term.shape, term.strength


def _with_strengths(chain: Terms, x: Array) -> Terms:
    """Chain terms with the coefficients x (1 + k) of base and strengths."""
    found, at = [], 1
    for term in chain:
        k = len(term.form.strength)
        found.append(replace(term, strength=tuple(float(v) for v in x[at : at + k])))
        at += k
    return tuple(found)


def _probes(chain: Terms, x: Array) -> list[Terms]:
    """The chain terms with the strengths in x (1 + k), and the last one with each of its own small in turn, or a drive as it is."""
    own = chain[-1].form.strength
    if not own:
        return [_with_strengths(chain, x)]
    sizes = np.diag([_probe(parameter) for parameter in own])
    return [_with_strengths(chain, np.append(x, size)) for size in sizes]


@lru_cache(maxsize=1)
def _pool() -> ThreadPoolExecutor | None:
    """Threads for runs, one a core; none on one core."""
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    return ThreadPoolExecutor(cores, "towing") if cores > 1 else None


def _probe(parameter: Parameter) -> float:
    low, high = parameter.plausible
    if not np.isfinite(high):
        return 0.01
    return float(np.sqrt(low * high)) if low > 0 else 0.1 * high


def _sane(x: Array, chain: Terms) -> Array:
    """Coefficients at which a chain can be run: a friction above zero, strengths not far beyond what is plausible."""
    limits: list[tuple[float, float]] = [(_LOWEST, 1 / _LOWEST)]
    forms: list[Form] = [t.form for t in chain]
    for parameter in (p for f in forms for p in f.strength):
        far = _FAR * max(abs(v) for v in parameter.plausible)
        limits.append((max(parameter.low, -far), min(parameter.high, far)))
    low, high = np.array(limits).T
    return np.clip(x, low, high)
