r"""The EMPS positioning drive: what is missing in a motor force of inertia and viscous friction alone?

.. math::  F = M a + F_v v

Two records of one ball-screw drive in closed loop: one calibrates, the other, with force pulses on the motor, is held
out. The reference motion repeats itself four times, so that each stretch of it was run four times: the stretches are
the experiments, their repeats the measure of the noise. Force, position and every column are low-passed alike (zero
phase); velocity, acceleration and jerk are central differences.

Candidates are columns beside M a + F_v v: Coulomb friction, an offset of the force, Stribeck's fall of the friction with
speed, quadratic drag, a spring, a lag of the force. (Coulomb friction with two limits, one per direction, spans the same
columns as Coulomb friction and an offset; the data cannot tell them apart and it is not listed as a rival.)

Source: A. Janot, M. Gautier, M. Brunot, Data set and reference models of EMPS, Workshop on Nonlinear System
Identification Benchmarks 2019; www.nonlinearbenchmark.org.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.signal import butter, sosfiltfilt

from compare.bench_design import BenchRecord, Block, Reading, Whitener, repeat_groups
from compare.bench_path import LedPath
from compare.campaign import Campaign
from compare.experiment import Channel, Experiment, Record
from compare.noise_floor import measure_noise
from effects.effect import ActiveEffect, BenchPath, Effect, Form, Parameter, of_values
from geometry.errors import SpecError

Array = NDArray[np.float64]
NAME = "emps-drive"
KIND = "drive"
_PERIOD = 6240  # samples after which the reference repeats itself
_STRETCHES = 12  # of one period
_CUT_OFF = 20.0  # Hz
_SETTLED = 200  # samples at either end where the filter has not settled
_EVERY = 20  # samples kept: 50 Hz, 0.8 of the Nyquist rate of the cut-off, so that neighbours are nearly independent


@dataclass(frozen=True)
class DrivePath(BenchPath):
    """The motion of a stretch; `strain` holds the velocity [m/s]. `sign` is that of the velocity, low-passed as all."""

    position: Array = field(default_factory=lambda: np.zeros(0), repr=False)
    acceleration: Array = field(default_factory=lambda: np.zeros(0), repr=False)
    jerk: Array = field(default_factory=lambda: np.zeros(0), repr=False)
    sign: Array = field(default_factory=lambda: np.zeros(0), repr=False)


@dataclass(frozen=True)
class DriveRecord(BenchRecord):
    """A stretch with its two base columns, inertia and viscous friction."""

    base: Array = field(default_factory=lambda: np.zeros((0, 2)), repr=False)

    def columns(self, terms: Sequence[ActiveEffect], only: int | None = None) -> list[Array]:
        """Base columns [N] and those of the terms, as the search asks for them."""
        parts = [] if only is not None else [self.base]
        parts += [t.form.respond(self.led.path, *t.shape) for i, t in enumerate(terms) if only in (None, i)]
        return [np.ascontiguousarray(np.hstack(parts))]


def read_motion(path: Path) -> dict[str, Array]:
    """Time, position, velocity, acceleration, jerk, sign of the velocity and motor force, low-passed, at 50 Hz."""
    if not path.is_file():
        raise SpecError(f"{path}: there is no such file; give the folder that holds the data sets.")
    with np.load(path) as file:
        time, position = file["time"], file["position"]
        force = file["force_per_volt"] * file["voltage"]
    step = float(time[1] - time[0])
    sections = butter(4, 2 * _CUT_OFF * step, output="sos")

    def smooth(values: Array) -> Array:
        return np.asarray(sosfiltfilt(sections, values))

    q = smooth(position)
    v = np.gradient(q, step)
    acceleration = np.gradient(v, step)
    motion = {
        "time": time,
        "position": q,
        "velocity": v,
        "acceleration": acceleration,
        "jerk": np.gradient(acceleration, step),
        "sign": smooth(np.sign(v)),
        "force": smooth(force),
    }
    return {name: np.ascontiguousarray(values[_SETTLED:-_SETTLED:_EVERY]) for name, values in motion.items()}


def inertia_and_viscosity(motion: dict[str, Array]) -> Array:
    """M [kg] and F_v [N s/m] by least squares, nothing else in the model."""
    columns = np.column_stack([motion["acceleration"], motion["velocity"]])
    return np.asarray(np.linalg.lstsq(columns, motion["force"], rcond=None)[0], dtype=float)


def stretches(motion: dict[str, Array]) -> list[Experiment]:
    """The record cut into stretches of the reference motion; the same stretch of a later period repeats the first."""
    n = _PERIOD // _EVERY // _STRETCHES
    found = []
    for i in range(len(motion["time"]) // n):
        part = slice(i * n, (i + 1) * n)
        channels = {
            "velocity": Channel("velocity", "m/s", motion["velocity"][part]),
            "force": Channel("force", "N", motion["force"][part]),
        }
        record = Record(motion["time"][part], "velocity", ("force",), channels)
        period, place = divmod(i, _STRETCHES)
        first = f"stretch{place + 1}"
        id = first if period == 0 else f"{first} again {period}"
        repeats = None if period == 0 else first
        found.append(Experiment(id, KIND, "", "drive", "calibrate", {}, repeats, sha256=id, table=record))
    return found


def drive_block(motion: dict[str, Array], base: Array, noise_from: dict[str, Array] | None = None) -> Block:
    """All stretches about M and F_v; the noise is learnt from the repeats of `noise_from`, or of the same record."""
    experiments = stretches(motion)
    known = experiments if noise_from is None else stretches(noise_from)
    noise = measure_noise(Campaign(Path(), NAME, None, None, {}, {}, tuple(known)))
    n, records = len(experiments[0].record), []
    for i, experiment in enumerate(experiments):
        part = {name: values[i * n : (i + 1) * n] for name, values in motion.items()}
        columns = np.column_stack([part["acceleration"], part["velocity"]]) * base
        signal = columns.sum(axis=1)
        whiten = Whitener.of(noise.by_channel[KIND, "force"], signal)
        reading = Reading("force", "load", part["force"], np.ones(2), 1.0, whiten, signal)
        path = DrivePath(
            KIND,
            part["velocity"],
            part["time"] - part["time"][0],
            position=part["position"],
            acceleration=part["acceleration"],
            jerk=part["jerk"],
            sign=part["sign"],
        )
        records.append(DriveRecord(experiment, LedPath(path), (reading,), columns))
    return Block(KIND, ("M", "Fv"), tuple(records), repeat_groups(experiments))


def shuffled(motion: dict[str, Array], base: Array, seed: int) -> dict[str, Array]:
    """The decoy: the residual of M a + F_v v in random order and without its mean, so that nothing is left to be found."""
    model = np.column_stack([motion["acceleration"], motion["velocity"]]) @ base
    residual = np.random.default_rng(seed).permutation(motion["force"] - model)
    return {**motion, "force": model + residual - residual.mean()}


def _effect(name: str, title: str, respond: object, unit: str, low: float = -np.inf, *shape: Parameter) -> Effect:
    strength = Parameter(name, unit, title, low, plausible=(low, np.inf))
    form = Form(name, "section", respond, shape, (strength,))  # type: ignore[arg-type]
    return Effect(name, "physics", title, "see the file", "see the file", "a motion", "", (KIND,), (form,))


_SPEED = Parameter(
    "vs", "m/s", "speed over which it falls", 1e-4, 0.02, starts=of_values(*np.geomspace(5e-4, 0.02, 10))
)
LIBRARY = (
    _effect("coulomb-friction", "friction of constant size", lambda p: p.sign[:, None], "N", 0.0),
    _effect("offset", "constant force", lambda p: np.ones((len(p.sign), 1)), "N"),
    _effect(
        "stribeck",
        "friction that falls with speed",
        lambda p, vs: (np.exp(-((p.strain / vs) ** 2)) * p.sign)[:, None],
        "N",
        0.0,
        _SPEED,
    ),
    _effect(
        "quadratic-drag", "drag with the square of speed", lambda p: (p.strain * np.abs(p.strain))[:, None], "N s^2/m^2"
    ),
    _effect("spring", "force with the position", lambda p: p.position[:, None], "N/m"),
    _effect("lag", "force that comes late, to first order", lambda p: p.jerk[:, None], "kg s"),
)
