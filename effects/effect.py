r"""What an effect is: a named piece of physics, of the rig or of a sensor, that the linear model leaves out.

A bench record is read through four stages, in this order,

.. math::  y = \text{bias} + \text{filter}\bigl[ K\,(\varepsilon + \textstyle\sum_j a_j\, c_j(\varepsilon;\theta_j))\bigr],
           \qquad \varepsilon = \text{fixture}(\text{path} / L)

K is the linear stiffness (EA, GJ, EI, or that of the cantilever), epsilon the path per length that the section sees. An
effect acts in one stage. Its *shape* parameters theta enter nonlinearly; its *strengths* a multiply columns c that are
measured in strain, so that K a c is the load that the effect adds. With strengths of zero, or, in a fixture or a
filter, with shapes of zero, the linear model is left exactly as it was.

A towing record is run, not read: an effect of towing changes the cable that is run (:mod:`effects.towed_cable`), by its
strengths (stage ``chain``) or by its shapes alone (``drive``). Sensors read both kinds of record in the same way.

An effect has one or more forms: the plain one first, richer ones after it. A richer form is the same physics with more
freedom (more elements, more relaxation times), never another effect.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from geometry.errors import InputError

Array = NDArray[np.float64]
EffectKind = Literal["physics", "rig", "sensor"]
Stage = Literal["section", "cross", "fixture", "filter", "bias", "chain", "drive"]
STRAIN_UNITS = {"tension": "1", "torsion": "rad/m", "bending": "1/m", "shear": "1"}
PLAY_UNITS = {"tension": "m", "torsion": "rad", "bending": "rad", "shear": "m"}
ARM_UNITS = {"tension": "m", "torsion": "1/m"}


@dataclass(frozen=True)
class BenchPath:
    """What one specimen goes through in one record, SI.

    Attributes
    ----------
    kind : str
        ``tension``, ``torsion``, ``bending``, ``shear`` or ``towing``.
    strain : (n,) array
        Path per length: strain, twist [rad/m], curvature [1/m], deflection over length of a cantilever; in towing the
        told position [m].
    time : (n,) array or None
        Instants [s], starting at the first sample; None for a loop without a clock.
    length : float or None
        Specimen length [m]; in towing that of the cable.
    tension : (n,) array or None
        Axial tension that grips the layers [N]: of the conditions, in a tension test the calibrated linear force.
    temperature : float or None
        [K].
    direction : str or None
        ``x+``, ``x-``, ``y+`` or ``y-`` of a shear or bending test.
    largest : float
        Largest \\|strain\\| of all experiments of this kind, the scale of strain-like shapes.
    typical_tension, typical_temperature : float
        Mean over the experiments of this kind [N], [K]; 0 and 293.15 where nothing was recorded.
    """

    kind: str
    strain: Array = field(repr=False)
    time: Array | None = field(default=None, repr=False)
    length: float | None = None
    tension: Array | None = field(default=None, repr=False)
    temperature: float | None = None
    direction: str | None = None
    largest: float = 1.0
    typical_tension: float = 0.0
    typical_temperature: float = 293.15

    def with_strain(self, strain: Array) -> BenchPath:
        """The same record with another strain."""
        return replace(self, strain=strain)


Starts = Callable[[Sequence[BenchPath]], Array]
"""Values of a shape parameter from which a search begins, for the experiments at hand: shape (m,), increasing."""


def of_strain(low: float, high: float, m: int) -> Starts:
    """m values, evenly spaced in the logarithm, from `low` to `high` times the largest strain."""
    return lambda paths: np.geomspace(low, high, m) * max(p.largest for p in paths)


def of_time(m: int, low: float = 0.5, high: float = 1.0) -> Starts:
    """m values from `low` times the shortest mean sampling interval to `high` times the longest record."""

    def values(paths: Sequence[BenchPath]) -> Array:
        times = [p.time for p in paths if p.time is not None and len(p.time) > 1]
        if not times:
            return np.ones(1)
        spans = [float(t[-1] - t[0]) for t in times]
        shortest = min(span / (len(t) - 1) for span, t in zip(spans, times, strict=True))
        return np.geomspace(low * shortest, high * max(spans), m)

    return values


def of_length(low: float, high: float, m: int) -> Starts:
    """m values from `low` to `high` times the shortest specimen length."""

    def values(paths: Sequence[BenchPath]) -> Array:
        lengths = [p.length for p in paths if p.length is not None]
        return np.geomspace(low, high, m) * (min(lengths) if lengths else 1.0)

    return values


def of_play(low: float, high: float, m: int) -> Starts:
    """m lengths (of a play, of a slip) from `low` to `high` times the largest strain times the shortest length."""

    def values(paths: Sequence[BenchPath]) -> Array:
        lengths = [p.length for p in paths if p.length is not None]
        return np.geomspace(low, high, m) * max(p.largest for p in paths) * (min(lengths) if lengths else 1.0)

    return values


def of_values(*values: float) -> Starts:
    """The given values, whatever the experiments."""
    return lambda _paths: np.array(values, dtype=float)


@dataclass(frozen=True)
class Parameter:
    """One number of an effect.

    Attributes
    ----------
    name, unit, meaning : str
        SI unit; ``strain`` stands for the unit of the path per length of the kind, ``arm`` for that of the other load
        over this one (torque over force in a tension test, force over torque in a torsion test), ``play`` for that of
        the path itself, ``channel`` for that of the channel of a sensor.
    low, high : float
        Physical bounds: outside them the parameter has no meaning.
    plausible : (float, float)
        What cables and rigs usually show; outside it a finding loses a tier.
    source : str
        Where the plausible range is from.
    starts : Starts or None
        Only for shapes: where a search begins.
    """

    name: str
    unit: str
    meaning: str
    low: float = 0.0
    high: float = np.inf
    plausible: tuple[float, float] = (0.0, np.inf)
    source: str = ""
    starts: Starts | None = field(default=None, repr=False)

    def unit_for(self, kind: str) -> str:
        """SI unit in an experiment of that kind."""
        unit = self.unit
        for token, units in (("strain", STRAIN_UNITS), ("arm", ARM_UNITS), ("play", PLAY_UNITS)):
            unit = unit.replace(token, units.get(kind, "1"))
        return unit


@dataclass(frozen=True)
class Derived:
    """A number that follows from the parameters of a form and says more than they do, such as a slip limit.

    `value(shape, strength, reference)` gives it; for the unit ``load`` in strain, to be multiplied by the linear stiffness.
    """

    name: str
    unit: str
    meaning: str
    value: Callable[[Sequence[float], Array, BenchPath], float] = field(repr=False)


Respond = Callable[..., Any]
Advance = Callable[..., tuple[Array, Array]]


@dataclass(frozen=True)
class Form:
    """One mathematical form of an effect.

    Attributes
    ----------
    name : str
        For reports, such as ``one slip element``.
    stage : Stage
        ``section``: `respond(path, *shape)` gives the columns c (n, k) [strain] on the load channel.
        ``cross``: the same on the other measured load (torque of a tension test, force of a torsion test), as strain.
        ``fixture``: `respond(path, *shape)` gives the strain (n,) that the section sees.
        ``filter``: `respond(signal, time, *shape)` gives what the sensor reads of a signal (n, k), linear in it.
        ``bias``: `respond(path, *shape)` gives columns (n, k) that are added to a channel, of size about 1.
        ``chain``, ``drive``: `respond(cable, strength, *shape)` gives the :class:`effects.towed_cable.TowedCable` with the
        effect; the strengths are in their own units, and a drive has none.
    shape, strength : tuple of Parameter
        Nonlinear parameters; linear ones, one per column. Fixtures and filters have no strengths.
    advance : callable, optional
        Only section and cross forms: ``advance(strain, before, dt, tension, temperature, state, *shape,
        reference=UNKNOWN)`` takes n material points one step on and returns their columns (n, k) and new state
        (n, memory); arrays (n,) in SI but for `dt`. `reference` is a path of the experiments that the effect was fitted
        to; its largest strain, typical tension and temperature, and direction are read, its records are not. Starting
        from zeros (the first sample with a `dt` of 0) it gives the columns of `respond` sample by sample.
    memory : int
        State variables per material point.
    derived : tuple of Derived
        What reports name first.
    scenario : callable, optional
        Only chains and drives: ``scenario(towed, strength, *shape)`` gives the :class:`effects.towed_scenario.TowedScenario` with
        the effect, for the towing run of the rod.
    """

    name: str
    stage: Stage
    respond: Respond = field(repr=False)
    shape: tuple[Parameter, ...] = ()
    strength: tuple[Parameter, ...] = ()
    advance: Advance | None = field(default=None, repr=False)
    memory: int = 0
    derived: tuple[Derived, ...] = ()
    scenario: Callable[..., Any] | None = field(default=None, repr=False)


UNKNOWN = BenchPath("tension", np.zeros(0))
"""A reference that knows nothing: scales of 1, no typical tension, 20 degC."""


@dataclass(frozen=True)
class Effect:
    """A named effect.

    Attributes
    ----------
    name : str
        As in the contract, such as ``interlayer-friction``.
    kind : EffectKind
        ``physics``, ``rig`` or ``sensor``.
    title, equation, source, needs, signature : str
        One line; the law in plain text; where it is from; what data it takes; what it looks like.
    kinds : tuple of str
        Kinds of experiment in which it can act.
    forms : tuple of Form
        The plain one first.
    why_untestable : callable
        Given the paths of the experiments of one kind, the sentence why they cannot show it, or None if they may.
    """

    name: str
    kind: EffectKind
    title: str
    equation: str
    source: str
    needs: str
    signature: str
    kinds: tuple[str, ...]
    forms: tuple[Form, ...]
    why_untestable: Callable[[Sequence[BenchPath]], str | None] = field(default=lambda _paths: None, repr=False)

    @property
    def stage(self) -> Stage:
        """Stage of the plain form."""
        return self.forms[0].stage


@dataclass(frozen=True)
class ActiveEffect:
    """An effect that is switched on in a model: in which kind of experiment, for sensors on which channel, how strong.

    Attributes
    ----------
    effect, form : Effect, Form
        What acts and in which form.
    kind : str
        Kind of experiment.
    channel : str or None
        Channel of a sensor effect.
    shape, strength : tuple of float
        Values of the form's parameters, SI; strengths multiply the linear stiffness, biases are in the unit of the channel.
    reference : BenchPath
        A path of the experiments that it was fitted to: the scales on which the strengths rest.
    """

    effect: Effect
    form: Form
    kind: str
    channel: str | None = None
    shape: tuple[float, ...] = ()
    strength: tuple[float, ...] = ()
    reference: BenchPath = field(default=UNKNOWN, repr=False)

    def advance(
        self, strain: Array, before: Array, dt: float, tension: Array, temperature: Array, state: Array
    ) -> tuple[Array, Array]:
        """Strain (n,) that the effect adds at n material points after one step, and their new state (n, memory).

        What a rod calls: the load of the effect is this strain times the linear stiffness. A channel of its own (stage
        ``cross``) is left to the caller.

        Raises
        ------
        InputError
            If the form acts outside the section, where a material point does not see it.
        """
        if self.form.advance is None:
            raise InputError(
                f"{self.effect.name} acts in the {self.form.stage}, not at a material point of the section."
            )
        columns, state = self.form.advance(
            strain, before, dt, tension, temperature, state, *self.shape, reference=self.reference
        )
        return columns @ np.asarray(self.strength, dtype=float), state

    @property
    def neutral(self) -> bool:
        """Whether it leaves the linear model as it is."""
        return not any(self.strength if self.form.strength else self.shape)
