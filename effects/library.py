"""The library: the effects of the campaign contract in its order, then plug-ins, then what a script registered.

A plug-in is an installed package with an entry point of the group ``helicable.effects`` that loads to an
:class:`~effects.effect.Effect`, to several, or to a function without arguments that returns one or several. A plug-in
that cannot be used is left out and spoken of in :func:`library_notes`; it never stops the program.
"""

from __future__ import annotations

import difflib
import importlib
import logging
from functools import lru_cache
from importlib.metadata import EntryPoint, distributions, entry_points
from typing import Any

from effects.effect import Effect
from effects.effect_check import defect
from geometry.errors import SpecError

logger = logging.getLogger(__name__)

GROUP = "helicable.effects"
NAMES = (
    "interlayer-friction",
    "plasticity",
    "viscous-damping",
    "viscoelasticity",
    "stiffening",
    "slack",
    "cyclic-softening",
    "thermal-softening",
    "tension-stiffening",
    "tension-torsion-coupling",
    "direction-asymmetry",
    "end-load-introduction",
    "backlash",
    "grip-slip",
    "rig-compliance",
    "sensor-offset",
    "sensor-drift",
    "sensor-lag",
    "trough-friction-stribeck",
    "viscous-drag",
    "added-load",
    "roller-resistance",
    "clamp-backlash",
    "polygon-effect",
    "trolley-ratio-error",
)

_registered: dict[str, Effect] = {}
_loading: list[
    bool
] = []  # not empty while plug-ins are loaded: one that asks for the library sees the built-in effects


def library() -> tuple[Effect, ...]:
    """Every effect that can be tried: built in, of plug-ins, registered.

    Examples
    --------
    >>> [e.name for e in library() if e.kind == "sensor"][:3]
    ['sensor-offset', 'sensor-drift', 'sensor-lag']
    """
    return (*_built_in(), *_plugged_in()[0], *_registered.values())


def library_notes() -> tuple[str, ...]:
    """Sentences on plug-ins that were left out."""
    return _plugged_in()[1]


def find(name: str) -> Effect:
    """The effect of that name.

    Raises
    ------
    SpecError
        If there is none; the sentence names the nearest ones.

    Examples
    --------
    >>> find("backlash").kind
    'rig'
    >>> find("back-lash")
    Traceback (most recent call last):
    geometry.errors.SpecError: there is no effect "back-lash" in the library; did you mean backlash or clamp-backlash? ...
    """
    known = {e.name: e for e in library()}
    if name in known:
        return known[name]
    near = difflib.get_close_matches(name, known, n=3, cutoff=0.5)
    meant = f"did you mean {' or '.join(near)}? " if near else ""
    raise SpecError(f'there is no effect "{name}" in the library; {meant}`helicable effects` lists all {len(known)}.')


def register(effect: Effect, *, replace: bool = False) -> Effect:
    """Add an effect of your own to the library of this Python process, so that ``explain`` ranks it with the others.

    Parameters
    ----------
    effect : Effect
        Made by hand or by :func:`effects.own_effect.section_effect`; its laws are tried on a short loading path first.
    replace : bool
        Whether it may take the place of an effect that was registered before, as when a notebook cell runs again.

    Returns
    -------
    Effect
        The same.

    Raises
    ------
    SpecError
        If it is no effect, its name is taken, or one of its laws does not give what its stage asks for.
    """
    wrong = _clash(effect, replace) or defect(effect)
    if wrong:
        raise SpecError(wrong)
    _registered[effect.name] = effect
    return effect


def unregister(name: str) -> None:
    """Take an effect that a script registered out of the library again; one that is not there is no error."""
    _registered.pop(name, None)


def _clash(effect: object, replace: bool) -> str | None:
    if not isinstance(effect, Effect):
        return f"only an Effect can be registered, not {type(effect).__name__}; make one with section_effect or Effect(...)."
    if any(e.name == effect.name for e in (*_built_in(), *_plugged_in()[0])):
        return f'the name "{effect.name}" belongs to an effect of the library already; choose another one.'
    if effect.name in _registered and not replace:
        return f'an effect "{effect.name}" is registered already; choose another name, or pass replace=True.'
    return None


@lru_cache(maxsize=1)
def _built_in() -> tuple[Effect, ...]:
    return tuple(importlib.import_module(f"effects.{name.replace('-', '_')}").EFFECT for name in NAMES)


def _plugged_in() -> tuple[tuple[Effect, ...], tuple[str, ...]]:
    """Effects of plug-ins, ordered by the name of their entry point, and sentences on those left out."""
    if _loading:
        return (), ()
    _loading.append(True)
    try:
        return _load_plug_ins()
    finally:
        _loading.pop()


@lru_cache(maxsize=1)
def _load_plug_ins() -> tuple[tuple[Effect, ...], tuple[str, ...]]:
    found: dict[str, Effect] = {}
    notes: list[str] = []
    for point in sorted(_points(notes), key=lambda p: (p.name, p.value)):
        try:
            for effect in _loaded(point):
                taken = effect.name in NAMES or effect.name in found
                wrong = f'the name "{effect.name}" is taken' if taken else defect(effect)
                if wrong:
                    notes.append(f"plug-in {point.name} ({point.value}) is left out: {wrong}")
                else:
                    found[effect.name] = effect
        except (Exception, SystemExit) as error:  # whatever a plug-in raises, the library stays usable without it
            told = f"{type(error).__name__}: {error}"
            notes.append(f"plug-in {point.name} ({point.value}) is left out: it cannot be loaded ({told})")
    for note in notes:
        logger.warning("%s", note)
    return tuple(found.values()), tuple(notes)


def _points(notes: list[str]) -> list[EntryPoint]:
    """Entry points of the group; a package whose list of them cannot be read is noted and left out."""
    try:
        return list(entry_points(group=GROUP))
    except Exception as error:  # one broken list stops the reading of all: read package by package
        logger.debug("entry points are read package by package: %s", error)
    found: list[EntryPoint] = []
    for package in distributions():
        try:
            found += package.entry_points.select(group=GROUP)
        except Exception as error:
            name = package.metadata["Name"]
            notes.append(
                f"package {name} is left out: its entry points cannot be read ({type(error).__name__}: {error})"
            )
    return found


def _loaded(point: EntryPoint) -> list[Effect]:
    """The effects behind an entry point; TypeError with a sentence if it is anything else."""
    thing: Any = point.load()
    if callable(thing) and not isinstance(thing, Effect):
        thing = thing()
    effects = [thing] if isinstance(thing, Effect) else thing
    if not isinstance(effects, (list, tuple)) or not all(isinstance(e, Effect) for e in effects):
        raise TypeError(f"expected an Effect, several, or a function that returns them, found {type(thing).__name__}")
    return list(effects)
