"""The loading paths on which the picture of an effect is drawn: two or three conditions that show what sets it apart.

The numbers are those of a mining cable of about 50 mm, so that the pictures carry plausible units; they are pictures of
the laws, not measurements. What a linear model makes of the same records is fitted to them by least squares, as a
calibration would: an effect is seen in what that leaves.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from effects.effect import Array, BenchPath, Effect, Form
from effects.towing_scene import fitted_base, tension, towed_path

STIFFNESS = {"tension": 4e5, "torsion": 60.0, "bending": 95.0, "shear": 4e4}
"""Nominal EA [N], GJ [N m2], EI [N m2]; of the cantilever force over deflection per length [N]."""
LARGEST = {"tension": 0.005, "torsion": 1.0, "bending": 1.0, "shear": 0.05}
"""Largest strain of the pictures, in the unit of the path per length."""
_SAMPLES = 240  # per leg, from one turning point to the next


@dataclass(frozen=True)
class Case:
    """One record of a picture: what it is called, its path, and the part of it that is drawn."""

    label: str
    path: BenchPath = field(repr=False)
    shown: slice = field(default_factory=lambda: slice(None))


@dataclass(frozen=True)
class Scene:
    """Records of one kind of experiment, and the size of the effect: shapes over the largest strain where they are strains."""

    kind: str
    cases: tuple[Case, ...]
    shape: tuple[float, ...] = ()
    strength: tuple[float, ...] = ()
    over_time: bool = False


@dataclass(frozen=True)
class Reading:
    """What the load channel reads with the effect, and by the linear model fitted to all records of the scene, SI."""

    case: Case
    load: Array = field(repr=False)
    linear: Array = field(repr=False)


def read_scene(effect: Effect, scene: Scene) -> list[Reading]:
    """Readings of the plain form of an effect in a scene, one per case."""
    if scene.kind == "towing":
        paths = [c.path for c in scene.cases]
        loads = [tension(effect, p, scene.shape, scene.strength) for p in paths]
        base = fitted_base(paths, loads)
        return [Reading(c, y, x) for c, x, y in zip(scene.cases, base, loads, strict=True)]
    loads = [_load(effect.forms[0], c.path, scene) for c in scene.cases]
    base = [STIFFNESS[scene.kind] * c.path.strain for c in scene.cases]
    if effect.stage in ("cross", "bias"):  # without coupling there is no second load; a bias is none of the stiffness
        ratio = 0.0 if effect.stage == "cross" else 1.0
    else:
        x, y = np.concatenate(base), np.concatenate(loads)
        ratio = float(x @ y / (x @ x))
    return [Reading(c, y, ratio * x) for c, x, y in zip(scene.cases, base, loads, strict=True)]


def _load(form: Form, path: BenchPath, scene: Scene) -> Array:
    K, strength = STIFFNESS[scene.kind], np.array(scene.strength)
    if form.stage == "fixture":
        return K * form.respond(path, *scene.shape)
    if form.stage == "filter":
        return form.respond(K * path.strain[:, None], path.time, *scene.shape)[:, 0]
    if form.stage == "cross":
        return K * (form.respond(path, *scene.shape) @ strength)
    if form.stage == "bias":
        return K * path.strain + form.respond(path, *scene.shape) @ (strength * K * LARGEST[scene.kind])
    return K * (path.strain + form.respond(path, *scene.shape) @ strength)


def scene_of(effect: Effect) -> Scene:
    """The scene of a built-in effect; for any other one cycles of two amplitudes, with an effect of about a third."""
    if effect.name in _SCENES:
        return _SCENES[effect.name]()
    kind = effect.kinds[0]
    if kind == "towing":
        form = effect.forms[0]
        cases = _towed((0.6, 1600.0, 0.0), (0.15, 800.0, 10.0))
        shape = [float(v[len(v) // 2]) for v in (p.starts([c.path for c in cases]) for p in form.shape if p.starts)]
        strength = [0.3 * min(p.plausible[1], 1e3) for p in form.strength]
        return Scene(kind, cases, tuple(shape), tuple(strength), over_time=True)
    cases = _by_amplitude(kind)
    paths = [c.path for c in cases]
    form = effect.forms[0]
    shape = [float(v[len(v) // 2]) for v in (p.starts(paths) for p in form.shape if p.starts is not None)]
    scene = Scene(kind, cases, tuple(shape), tuple(0.0 for _ in form.strength))
    if not form.strength:
        return scene
    columns = form.respond(paths[0], *shape)
    size = np.maximum(np.abs(columns).max(axis=0), 1e-300)
    scale = 1.0 if form.stage == "bias" else LARGEST[kind]
    clipped = [np.clip(0.3 * scale / s / len(size), p.low, p.high) for s, p in zip(size, form.strength, strict=True)]
    return replace(scene, strength=tuple(float(a) for a in clipped))


def _record(kind: str, turns: Sequence[float], leg: float = 10.0, **conditions: float) -> BenchPath:
    """Half waves of `leg` seconds from one turning point to the next; the points are given over the largest strain."""
    s = np.linspace(0.0, len(turns) - 1.0, _SAMPLES * (len(turns) - 1) + 1)
    before = np.minimum(s.astype(int), len(turns) - 2)
    begun = 0.5 - 0.5 * np.cos(np.pi * (s - before))
    points = np.array(turns, dtype=float)
    strain = LARGEST[kind] * (points[before] + begun * np.diff(points)[before])
    n, tension = len(s), conditions.get("tension", 2000.0)
    return BenchPath(
        kind, strain, leg * s, conditions.get("length", 2.0), np.full(n, tension), conditions.get("temperature", 293.15),
        None, LARGEST[kind], 2000.0, 293.15,
    )  # fmt: skip


_CYCLE = (0.0, 1.0, -1.0, 1.0, -1.0, 0.0)


def _by_tension() -> tuple[Case, ...]:
    return tuple(Case(f"axial tension {t / 1e3:g} kN", _record("bending", _CYCLE, tension=t)) for t in (4e3, 2e3, 1e3))


def _by_amplitude(kind: str, turns: Sequence[float] = _CYCLE) -> tuple[Case, ...]:
    small = _record(kind, [0.5 * t for t in turns])
    return Case("amplitude 100 %", _record(kind, turns)), Case("amplitude 50 %", small)


def _by_duration(kind: str, slow: float, fast: float) -> tuple[Case, ...]:
    legs = ((f"one cycle in {2 * leg:g} s", leg) for leg in (slow, fast))
    return tuple(Case(name, _record(kind, _CYCLE, leg=leg)) for name, leg in legs)


def _by_length(kind: str, *lengths: float, turns: Sequence[float] = _CYCLE) -> tuple[Case, ...]:
    return tuple(Case(f"specimen of {length:g} m", _record(kind, turns, length=length)) for length in lengths)


def _by_temperature() -> tuple[Case, ...]:
    return tuple(Case(f"{t} °C", _record("bending", _CYCLE, temperature=273.15 + t)) for t in (0, 20, 40))


def _holding() -> tuple[Case, ...]:
    turns = (0.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0)
    names = (("ramps of 40 s, held for 80 s", 40.0), ("ramps of 10 s, held for 20 s", 10.0))
    return tuple(Case(name, _record("bending", turns, leg=leg)) for name, leg in names)


def _after_more() -> tuple[Case, ...]:
    path = _record("bending", (0.0, 0.5, 0.0, 1.0, 0.0, 0.5))
    parts = (("first cycle, to 50 %", 0, 2), ("then to 100 %", 2, 4), ("again to 50 %", 4, 5))
    return tuple(Case(name, path, slice(a * _SAMPLES, b * _SAMPLES + 1)) for name, a, b in parts)


def _stretch() -> tuple[Case, ...]:
    return (Case("rotation blocked", _record("tension", (0.0, 1.0, 0.0))),)


def _towed(*conditions: tuple[float, float, float]) -> tuple[Case, ...]:
    """Records of towing by largest speed [m/s], tail tension [N] and inclination [deg]."""
    return tuple(Case(f"{v:g} m/s, tail {tail:g} N, {a:g}°", towed_path(v, tail, a)) for v, tail, a in conditions)


def _towing(shape: tuple[float, ...], strength: tuple[float, ...], *conditions: tuple[float, float, float]) -> Scene:
    return Scene("towing", _towed(*conditions), shape, strength, over_time=True)


_SPEEDS = ((0.6, 800.0, 0.0), (0.1, 800.0, 0.0))
_GRIPS = (0.0, 0.6, 0.0, 1.0, 0.0)
_SCENES = {
    "interlayer-friction": lambda: Scene("bending", _by_tension(), (0.3, 0.9), (1.0,)),
    "plasticity": lambda: Scene("bending", _by_amplitude("bending"), (0.35,), (2.0,)),
    "viscous-damping": lambda: Scene("bending", _by_duration("bending", 20.0, 5.0), (), (0.8,)),
    "viscoelasticity": lambda: Scene("bending", _holding(), (15.0,), (0.8,), over_time=True),
    "stiffening": lambda: Scene("bending", _by_amplitude("bending"), (), (0.8,)),
    "slack": lambda: Scene("tension", _by_amplitude("tension", (0.0, 1.0, 0.0)), (0.2 * LARGEST["tension"],), (0.9,)),
    "cyclic-softening": lambda: Scene("bending", _after_more(), (0.5,), (0.6,)),
    "thermal-softening": lambda: Scene("bending", _by_temperature(), (), (0.012,)),
    "tension-stiffening": lambda: Scene("bending", _by_tension(), (), (0.4,)),
    "tension-torsion-coupling": lambda: Scene("tension", _stretch(), (), (3e-3,)),
    "direction-asymmetry": lambda: Scene("bending", _by_amplitude("bending"), (), (0.25,)),
    "end-load-introduction": lambda: Scene("tension", _by_length("tension", 4, 1, 0.5, turns=(0, 1, 0)), (0.3,)),
    "backlash": lambda: Scene("torsion", _by_length("torsion", 4, 1), (0.5,)),
    "grip-slip": lambda: Scene("tension", _by_length("tension", 4, 1, turns=_GRIPS), (1.0, 0.3 * LARGEST["tension"])),
    "rig-compliance": lambda: Scene("tension", _by_length("tension", 4, 1, 0.5, turns=(0, 1, 0)), (0.3,)),
    "sensor-offset": lambda: Scene("bending", _by_amplitude("bending"), (), (0.15,)),
    "sensor-drift": lambda: Scene("bending", _by_duration("bending", 20.0, 5.0), (), (0.3 / 100,), over_time=True),
    "sensor-lag": lambda: Scene("bending", _by_duration("bending", 20.0, 5.0), (0.8,)),
    "trough-friction-stribeck": lambda: _towing((0.15,), (0.15,), *_SPEEDS),
    "viscous-drag": lambda: _towing((), (20.0,), *_SPEEDS),
    "added-load": lambda: _towing((), (1.5,), (0.3, 800.0, 0.0), (0.3, 800.0, 12.0)),
    "roller-resistance": lambda: _towing((), (0.15,), (0.3, 800.0, 0.0), (0.3, 2400.0, 0.0)),
    "clamp-backlash": lambda: _towing((0.04,), (), *_SPEEDS),
    "polygon-effect": lambda: _towing((0.108,), (0.05, 0.0), (0.3, 800.0, 0.0), (0.12, 800.0, 0.0)),
    "trolley-ratio-error": lambda: _towing((), (0.2,), *_SPEEDS),
}
