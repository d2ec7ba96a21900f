"""Does an effect keep the promises of its stage? Its laws are tried on a short loading path.

A section law gives one finite column per strength; a fixture gives a strain, a filter a signal, and both leave their
input exactly as it is when all their shapes are zero. A law that a rod can step gives these columns sample by sample,
up to the half interval by which a rate may be early.
"""

from __future__ import annotations

import re

import numpy as np

from effects.effect import Array, BenchPath, Effect, Form

_NAME = re.compile(r"[a-z][a-z0-9]*(-[a-z0-9]+)*")
BENCH_KINDS = ("tension", "torsion", "bending", "shear")
KINDS = (*BENCH_KINDS, "towing")
_STEP_OFF = 0.1  # of the columns: a rate at a sample and that of the step before differ by half a sampling interval
STAGES = ("section", "cross", "fixture", "filter", "bias", "chain", "drive")
TOWED = ("chain", "drive")


def probe(kind: str = "torsion") -> BenchPath:
    """A short record to try a law on: growing cycles of 1 % with a clock, a length and all conditions."""
    time = np.linspace(0.0, 60.0, 241)
    if kind == "towing":
        position = 0.25 * (1 - np.cos(time / 10.0)) ** 2
        return BenchPath(kind, position, time, 30.0, largest=1.0)
    strain = 0.01 * np.sin(time / 5.0) * (0.3 + 0.7 * time / 60.0)
    return BenchPath(
        kind, strain, time, 2.0, 1000.0 + 100.0 * np.cos(time / 7.0), 300.0, None, 0.01, 1000.0, 293.15
    )  # fmt: skip


def defect(effect: Effect) -> str | None:
    """The sentence that says what is wrong with an effect, or None."""
    if not isinstance(effect.name, str) or not _NAME.fullmatch(effect.name):
        return f'"{effect.name}" is no name for an effect; use words in small letters, joined by "-".'
    if effect.kind not in ("physics", "rig", "sensor"):
        return f'effect {effect.name}: the kind "{effect.kind}" is none of physics, rig, sensor.'
    unknown = [k for k in effect.kinds if k not in KINDS]
    if unknown or not effect.kinds:
        return f"effect {effect.name}: kinds must be some of {', '.join(KINDS)}, found {', '.join(unknown) or 'none'}."
    if not effect.forms:
        return f"effect {effect.name} has no form; it needs at least one law."
    for form in effect.forms:
        wrong = _form_defect(form, probe(effect.kinds[0]))
        if wrong:
            return f'effect {effect.name}, form "{form.name}": {wrong}.'
        on_bench = [k for k in effect.kinds if k != "towing"]
        if (form.stage in TOWED and on_bench) or (
            form.stage in ("section", "cross", "fixture") and len(on_bench) < len(effect.kinds)
        ):
            return (
                f'effect {effect.name}, form "{form.name}": a law of the stage {form.stage} cannot act in '
                f"{on_bench[0] if form.stage in TOWED else 'towing'} experiments."
            )
    return None


def _form_defect(form: Form, path: BenchPath) -> str | None:
    if form.stage not in STAGES:
        return f'the stage "{form.stage}" is none of {", ".join(STAGES)}'
    without = [p.name for p in form.shape if p.starts is None]
    if without:
        return f"the shape {without[0]} has no starts; say where a search begins, such as of_strain(0.1, 1.0, 6)"
    try:
        middle = [float(v[len(v) // 2]) for v in (np.atleast_1d(p.starts([path])) for p in form.shape if p.starts)]
        if form.stage in TOWED:
            return _towed_defect(form, path, middle)
        given = _answer(form, path, middle)
        if form.stage in ("fixture", "filter"):
            neutral = _answer(form, path, [0.0] * len(form.shape))
            return _passes_defect(form, path, given, neutral)
        return _columns_defect(form, path, given, middle)
    except Exception as error:  # whatever a user's law raises becomes part of the sentence
        return f"its law fails with {type(error).__name__}: {error}"


def _signal(path: BenchPath) -> Array:
    return np.column_stack([path.strain, path.strain**2])


def _answer(form: Form, path: BenchPath, shape: list[float]) -> Array:
    arguments = (_signal(path), path.time) if form.stage == "filter" else (path,)
    return np.asarray(form.respond(*arguments, *shape), dtype=float)


def _towed_defect(form: Form, path: BenchPath, shape: list[float]) -> str | None:
    from beam.axial_chain import AxialChain
    from effects.towed_cable import TowedCable

    assert path.time is not None
    chain = AxialChain(30.0, 4e5, 5.0, 0.3, 800.0, 0.1, elements=8)
    cable = TowedCable(chain, path.time, path.strain)
    if bool(form.strength) != (form.stage == "chain"):
        return "a chain law has strengths, and a drive has none"
    without = [0.0] * len(shape) if form.stage == "drive" else shape
    neutral, some = [0.0] * len(form.strength), [0.01] * len(form.strength)
    base = cable.tensions([10.0])
    if not np.array_equal(form.respond(cable, neutral, *without).tensions([10.0]), base):
        return "with nothing of the effect the cable must be left unchanged"
    changed = form.respond(cable, some, *shape).tensions([10.0])
    if not np.isfinite(changed).all():
        return "its law gives values that are not finite"
    return None


def _passes_defect(form: Form, path: BenchPath, given: Array, neutral: Array) -> str | None:
    expected = _signal(path) if form.stage == "filter" else path.strain
    if given.shape != expected.shape:
        return f"its law must give an array of shape {expected.shape}, it gives {given.shape}"
    if not np.isfinite(given).all():
        return "its law gives values that are not finite"
    if not np.array_equal(neutral, expected):
        return "with all shapes at zero its law must return its input unchanged"
    return None


def _columns_defect(form: Form, path: BenchPath, given: Array, shape: list[float]) -> str | None:
    expected = (len(path.strain), len(form.strength))
    if not form.strength:
        return "it has no strength, so that it could not be switched off"
    if given.shape != expected:
        return f"its law must give one column per strength, shape {expected}; it gives {given.shape}"
    if not np.isfinite(given).all():
        return "its law gives values that are not finite"
    if form.advance is None:
        return None
    off = np.linalg.norm(_stepped(form, path, shape) - given)
    if off > _STEP_OFF * np.linalg.norm(given):
        return "stepped sample by sample it gives other columns; if its law knows the past, say memoryless=False"
    return None


def _stepped(form: Form, path: BenchPath, shape: list[float]) -> Array:
    """What `advance` gives for one material point along the path."""
    assert form.advance is not None and path.time is not None and path.tension is not None
    state, columns, before = np.zeros((1, form.memory)), [], np.zeros(1)
    steps = np.diff(path.time, prepend=path.time[0])
    for i, dt in enumerate(steps):
        now = (path.strain[i : i + 1], before, float(dt), path.tension[i : i + 1], np.full(1, path.temperature))
        given, state = form.advance(*now, state, *shape, reference=path)
        columns.append(given[0])
        before = path.strain[i : i + 1]
    return np.array(columns)
