r"""The axial chain fitted again to towing records about what was found, with a given difference added to its readings.

Gauss's and Newton's method with the slopes of the first step (a chord), for the friction ratio and the strengths theta of all
effects that act,

.. math:: \theta \leftarrow \theta + (J^T J)^{-1} J^T\, C^{-1/2} (y - c(\theta) - d), \qquad J = \partial (C^{-1/2} c) / \partial\theta

held inside the bounds of the strengths. Records that were led alike share their runs.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from compare.calibration import Calibration
from compare.comparison import Comparison
from compare.experiment import Experiment
from compare.noise_floor import NoiseModel
from compare.towed_rod import carried
from compare.towing_setup import TowingSetup, read_channels, towing_path, with_effects
from effects.effect import ActiveEffect
from effects.towed_cable import TowedCable
from geometry.errors import ConvergenceError, InputError

Array = NDArray[np.float64]
Progress = Callable[[float, str], None]
FullModel = Callable[[TowedCable, Sequence[float], Callable[[float], None]], list[Array]]
"""Cable, stations and progress to the tensions at the towed end and at every station."""
SETS = ("calibrate", "validate")
FRICTION = "friction coefficient"
_MOST_STEPS, _AT_REST, _STEP = 8, 1e-3, 1e-3


@dataclass(frozen=True)
class _Rod:
    """A cable that is run by the full model when its tensions are asked for."""

    cable: TowedCable
    run: FullModel
    tell: Callable[[float], None]

    def tensions(self, stations: Sequence[float] = ()) -> list[Array]:
        return self.run(self.cable, stations, self.tell)


Key = tuple[object, ...]
Differences = Mapping[Key, Mapping[str, Array]]


@dataclass(frozen=True)
class ChainFit:
    """The records by how they were led, and the fit of friction ratio and strengths to them with the chain."""

    setup: TowingSetup
    noise: NoiseModel
    friction: float
    active: tuple[ActiveEffect, ...]
    led: Mapping[Key, tuple[Experiment, ...]]
    calibration: Calibration
    names: tuple[tuple[str, str], ...]
    std: Array
    bounds: tuple[Array, Array]

    @classmethod
    def of(cls, comparison: Comparison) -> ChainFit:
        model, noise = comparison.model, comparison.noise
        known = [e for name in SETS for e in comparison.campaign.of_set(name) if e.is_open and e.kind == "towing"]
        if model.towing is None or not any(e.set == "calibrate" for e in known):
            raise InputError(
                "no open towing experiment is in the set calibrate: there is nothing for the full rod to run."
            )
        led: dict[Key, tuple[Experiment, ...]] = {}
        for e in known:
            key = _led_alike(e, model.towing)
            led[key] = (*led.get(key, ()), e)
        active = tuple(a for a in model.effects if a.kind == "towing" and not a.neutral)
        names, stds, low, high = [(FRICTION, "1")], [_friction_std(comparison.calibration)], [1e-3], [np.inf]
        for a in active:
            for p in a.form.strength:
                name, std = _named(comparison.calibration, a, p.name)
                unit = p.unit_for("towing").replace("channel", "N")
                names.append((name, unit))
                stds.append(std)
                low.append(p.low)
                high.append(p.high)
        return cls(
            model.towing, noise, model.stiffness(FRICTION), active, led, comparison.calibration, tuple(names),
            np.array(stds), (np.array(low), np.array(high)),
        )  # fmt: skip

    @property
    def start(self) -> Array:
        """What was found: friction ratio 1 and the strengths."""
        return np.array([1.0, *(v for a in self.active for v in a.strength)])

    def model(self, theta: Array) -> tuple[float, list[ActiveEffect]]:
        rest, own = iter(theta[1:].tolist()), []
        for a in self.active:
            own.append(replace(a, strength=tuple(next(rest) for _ in a.form.strength)))
        return self.friction * float(theta[0]), own

    def differences(
        self, theta: Array, run: FullModel, tell: Progress
    ) -> tuple[dict[Key, dict[str, Array]], list[str]]:
        """Full model less chain of every channel, and sentences on what it does not carry and on runs that stopped."""
        friction, own = self.model(theta)
        found: dict[Key, dict[str, Array]] = {}
        notes: list[str] = []
        stopped: list[str] = []
        for i, (key, members) in enumerate(self.led.items()):
            e, words = members[0], f"running {members[0].id} in the full rod ({i + 1} of {len(self.led)})"
            tell(i / len(self.led), words)
            cable, said = carried(with_effects(self.setup.cable(e, friction), own))
            notes += [f"{s}." for s in said if f"{s}." not in notes]
            rod = _Rod(cable, run, lambda f, i=i, words=words: tell((i + f) / len(self.led), words))
            try:
                ahead, here = read_channels(rod, e), read_channels(cable, e)  # type: ignore[arg-type]
            except ConvergenceError as error:
                stopped.append(
                    f"{', '.join(m.id for m in members)} could not be run and stays out of the correction: {error}"
                )
                continue
            found[key] = {c: self._sensed(ahead[c] - here[c], c, e, own) for c in here}
        if not any(e.set == "calibrate" for key in found for e in self.led[key]):
            raise ConvergenceError(f"the full rod came to the end of no record to calibrate. First: {stopped[0]}")
        return found, [*notes, *stopped]

    def _sensed(self, d: Array, channel: str, e: Experiment, own: Sequence[ActiveEffect]) -> Array:
        """A difference of tensions as the sensor of the channel reads it."""
        for a in own:
            if a.form.stage == "filter" and a.channel == channel:
                d = a.form.respond(d[:, None], towing_path(e, self.setup).time, *a.shape)[:, 0]
        return d

    def fitted(self, theta: Array, differences: Differences) -> Array:
        """Least squares of the records to calibrate about theta, with the slopes there: Gauss and Newton's chord."""
        sigma, J = self.std, None
        for _ in range(_MOST_STEPS):
            r = self._residual(theta, differences)
            if J is None:
                steps = _STEP * np.maximum(np.maximum(np.abs(theta), sigma), 1e-6)
                J = np.column_stack(
                    [
                        (self._residual(theta + h * np.eye(len(theta))[k], differences) - r) / h
                        for k, h in enumerate(steps)
                    ]
                )
                size = np.maximum(np.linalg.norm(J, axis=0), 1e-300)
            step = -np.linalg.lstsq(J / size, r, rcond=1e-10)[0] / size
            new = np.clip(theta + step, *self.bounds)
            moved, theta = np.abs(new - theta), new
            if (moved <= _AT_REST * sigma).all():
                break
        return theta

    def _residual(self, theta: Array, differences: Differences) -> Array:
        """White residuals of the records to calibrate, one below the other; of those that were corrected, if any were."""
        parts = []
        for key, members in self.led.items():
            own = [e for e in members if e.set == "calibrate"]
            if not own or (differences and key not in differences):
                continue
            predicted = self.predicted(key, theta, differences)
            for e in own:
                for c, f in predicted.items():
                    parts.append(self.noise.of(e, c).whiten(e.record[c] - f, e.record[c]))
        return np.concatenate(parts)

    def predicted(self, key: Key, theta: Array, differences: Differences) -> dict[str, Array]:
        """The corrected chain's readings."""
        friction, own = self.model(theta)
        found = self.setup.predict(self.led[key][0], friction, own)
        return {c: f + differences.get(key, {}).get(c, 0.0) for c, f in found.items()}

    def errors(self, name: str, found: Array, after: Array, differences: Differences) -> tuple[float, float] | None:
        """Rms residual of a set over its noise floor, with the chain as it was found and with the corrected one."""
        squares, n = np.zeros(2), 0
        for key, members in self.led.items():
            own = [e for e in members if e.set == name and key in differences]
            if not own:
                continue
            pair = self.predicted(key, found, {}), self.predicted(key, after, differences)
            for e in own:
                for c in pair[0]:
                    y, floor = e.record[c], self.noise.of(e, c).floor(e.record[c])
                    squares += [float(np.sum((y - p[c]) ** 2)) / floor**2 for p in pair]
                    n += len(y)
        if not n:
            return None
        chain, corrected = np.sqrt(squares / n)
        return float(chain), float(corrected)


def _led_alike(experiment: Experiment, setup: TowingSetup) -> Key:
    """What a run depends on; the same for repeats that were led alike."""
    path, given = towing_path(experiment, setup), experiment.conditions
    assert path.time is not None
    told = path.time.tobytes(), path.strain.tobytes()
    return (*told, given.get("tail tension"), given.get("inclination"), experiment.record.measured)


def _friction_std(calibration: Calibration) -> float:
    value = calibration.values[FRICTION]
    return value.std / value.value


def _named(calibration: Calibration, a: ActiveEffect, parameter: str) -> tuple[str, float]:
    """Name under which the calibration has a strength, and its standard deviation; 0 where it is held."""
    begin = f"{a.effect.name}: {parameter}"
    for name, value in calibration.parameters.items():
        tail = name.removeprefix(begin)
        if name.startswith(begin) and (not tail or tail.startswith(" (")) and (a.channel is None or a.channel in tail):
            return name, value.std if np.isfinite(value.std) else 0.0
    return begin, 0.0
