"""The base model of a towing experiment: [towing] of campaign.toml and the conditions of the record make an axial chain.

All but the friction coefficient is taken as true (:mod:`beam.axial_chain` has the equations). The motion is the told position,
or the integral of the told speed; the clock is needed.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from beam.axial_chain import AxialChain
from compare.campaign import Campaign
from compare.campaign_file import FILE
from compare.experiment import Experiment, Record
from compare.kinds import station
from effects.bending_loss import BendingLoss
from effects.effect import ActiveEffect, BenchPath
from effects.effect_check import TOWED
from effects.towed_cable import TowedCable
from geometry.errors import InputError, SpecError

Array = NDArray[np.float64]
DAMPING_RATIO, PRESLIDING = 0.1, 3e-4
_FASTEST = 10.0  # m/s: no drive of a cable handler comes near
_FEWEST = 8


@dataclass(frozen=True)
class TowingSetup:
    """What is common to all towing records of a campaign, SI; tail tension and inclination may be the experiments' own."""

    friction: float
    length: float
    EA: float
    mass: float
    tail_tension: float | None = None
    inclination: float | None = None
    damping_ratio: float = DAMPING_RATIO
    presliding: float = PRESLIDING
    elements: int = 32
    notes: tuple[str, ...] = ()
    bend: BendingLoss | None = None

    @classmethod
    def of(cls, campaign: Campaign, EA: float | None = None, mass: float | None = None) -> TowingSetup | None:
        """From the table [towing], else [section], else `EA` and `mass` of the cable; None without a towing experiment.

        Raises
        ------
        SpecError
            If the axial stiffness or the mass is given nowhere.
        """
        if not any(e.kind == "towing" for e in campaign.experiments):
            return None
        table, stated = campaign.towing, campaign.section.stated if campaign.section else {}
        values = {"EA": EA, "mass_per_length": mass}
        for key in values:
            values[key] = table.get(key, stated.get(key, values[key]))
            if values[key] is None:
                raise SpecError(f"{FILE}, [towing]: {key} is missing, and [section] does not give it; add one of them.")
        if table["friction_coefficient"] == 0:
            raise SpecError(
                f"{FILE}, [towing] friction_coefficient: 0 cannot be calibrated, which scales it; give a starting value."
            )
        notes = [
            f"[towing] gives no {key}; {value} is taken." for key, value in
            (("damping_ratio", f"{DAMPING_RATIO:g}"), ("presliding", f"{1e3 * PRESLIDING:g} mm")) if key not in table
        ]  # fmt: skip
        return cls(
            table["friction_coefficient"], table["cable_length"], float(values["EA"] or 0), float(values["mass_per_length"] or 0),
            table.get("tail_tension"), table.get("inclination"), table.get("damping_ratio", DAMPING_RATIO),
            table.get("presliding", PRESLIDING) or 1e-6, notes=tuple(notes),
        )  # fmt: skip

    def cable(self, experiment: Experiment, friction: float) -> TowedCable:
        """The record's cable with a friction coefficient, ready to be run.

        Raises
        ------
        SpecError
            If the record has no clock, jumps, or a station outside the cable.
        """
        given, record = experiment.conditions, experiment.record
        tail, slope = given.get("tail tension", self.tail_tension), given.get("inclination", self.inclination)
        assert tail is not None and slope is not None  # the campaign reader has seen to it
        chain = self.chain(friction, tail, slope)
        position = told_position(experiment, self.length)
        assert record.time is not None
        return TowedCable(chain, record.time - record.time[0], position, carried=self.bend)

    def carrying(self, laws: Sequence[ActiveEffect], EI: float, bend_radius: float) -> TowingSetup:
        """The same with laws that a bench found in bending, at the bend over which the towed end is drawn.

        They are taken as true: nothing of them is fitted to towing records.

        Parameters
        ----------
        laws : sequence of ActiveEffect
            Of the section, in bending.
        EI : float
            Bending stiffness [N m^2] that was calibrated with them.
        bend_radius : float
            [m].

        Raises
        ------
        InputError
            If a law does not act in the section in bending, or a number is not positive.
        """
        bend = BendingLoss(laws, EI, bend_radius)
        names = ", ".join(dict.fromkeys(a.effect.name for a in bend.laws))
        notes = [
            f"{names} is carried from the bench into the bend of radius {bend_radius:g} m; it was not fitted here."
        ]
        if bend.curvature > 1.001 * bend.largest_tested:
            notes.append(
                f"the bench bent to {bend.largest_tested:.3g} 1/m, this bend has {bend.curvature:.3g} 1/m: its loss is extrapolated."
            )
        return replace(self, bend=bend, notes=(*self.notes, *notes))

    def chain(self, friction: float, tail: float, slope: float) -> AxialChain:
        """The cable at a friction coefficient, a tail tension [N] and an inclination [rad]."""
        return AxialChain(
            self.length, self.EA, self.mass, friction, tail, slope, self.damping_ratio, self.presliding,
            elements=self.elements,
        )  # fmt: skip

    def predict(self, experiment: Experiment, friction: float, active: Sequence[ActiveEffect] = ()) -> dict[str, Array]:
        """What the channels of a record read, (n,) each."""
        own = [a for a in active if a.kind == "towing" and not a.neutral]
        cable = with_effects(self.cable(experiment, friction), own)
        found = read_channels(cable, experiment)
        path = towing_path(experiment, self)
        for channel in found:
            for a in own:
                if a.form.stage == "filter" and a.channel == channel:
                    found[channel] = a.form.respond(found[channel][:, None], path.time, *a.shape)[:, 0]
            for a in own:
                if a.form.stage == "bias" and a.channel == channel:
                    c = a.form.respond(path, *a.shape)
                    found[channel] = found[channel] + (c[:, None] if c.ndim == 1 else c) @ np.asarray(a.strength)
        return found


def with_effects(cable: TowedCable, active: Sequence[ActiveEffect]) -> TowedCable:
    """The cable with the effects of towing among `active`, strengths and shapes given."""
    for a in active:
        if a.form.stage in TOWED:
            cable = a.form.respond(cable, a.strength, *a.shape)
    return cable


def read_channels(cable: TowedCable, experiment: Experiment) -> dict[str, Array]:
    """Tension of every measured channel, (n,) each."""
    channels = [c for c in experiment.record.measured if c.startswith("tension")]
    places = [station(c) for c in channels]
    inside = [s for s in places if s is not None]
    end, *at = cable.tensions(inside)
    rest = iter(at)
    return {c: end if s is None else next(rest) for c, s in zip(channels, places, strict=True)}


def towing_path(experiment: Experiment, setup: TowingSetup) -> BenchPath:
    """The told motion as a path: position [m] over time."""
    time = experiment.record.time
    assert time is not None
    position = told_position(experiment, setup.length)
    return BenchPath("towing", position, time - time[0], setup.length)


def told_position(experiment: Experiment, cable_length: float) -> Array:
    """Position of the towed end [m] from where it rests, checked.

    Raises
    ------
    SpecError
        If the record has no clock, jumps, or a station outside the cable.
    """
    record, file = experiment.record, experiment.file
    if record.prescribed == "tension":
        raise SpecError(f"{file}: a towing record is led by position or speed; the tension as control is not modelled.")
    if experiment.continues is not None:
        raise SpecError(f"{file}: a towing record starts from rest; it cannot continue {experiment.continues}.")
    if record.time is None:
        raise SpecError(f'{file}: a towing record needs a clock; add the column "time [s]".')
    if len(record) < _FEWEST:
        raise SpecError(f"{file}: {len(record)} samples are no towing record; it takes at least {_FEWEST}.")
    for channel in record.measured:
        s = station(channel)
        if s is not None and s > cable_length:
            raise SpecError(
                f'{file}, column "{channel}": the station lies outside the cable, which is {cable_length:g} m long.'
            )
    if record.prescribed == "speed":
        from scipy.interpolate import CubicSpline

        position = np.asarray(CubicSpline(record.time, record["speed"]).antiderivative()(record.time), dtype=float)
    else:
        position = record["position"] - record["position"][0]
    speed = np.abs(np.diff(position) / np.diff(record.time))
    if speed.max() > _FASTEST:
        i = int(speed.argmax())
        raise SpecError(
            f'{file}, row {i + 3}, column "{record.prescribed}": the towed end jumps by {position[i + 1] - position[i]:.3g} m in '
            f"{record.time[i + 1] - record.time[i]:.3g} s; more than {_FASTEST:g} m/s is no towing. Check the unit and the row."
        )
    return np.ascontiguousarray(position)


def modelled(campaign: Campaign) -> tuple[Campaign, tuple[str, ...]]:
    """The campaign without channels that an axial model does not have (lateral displacement), and a sentence on them."""
    sideways = [
        e for e in campaign.experiments
        if e.is_open and e.kind == "towing" and any(c.startswith("lateral") for c in e.record.measured)
    ]  # fmt: skip
    if not sideways:
        return campaign, ()
    kept = tuple(replace(e, table=_axial(e.record)) if e in sideways else e for e in campaign.experiments)
    names = ", ".join(e.id for e in sideways[:5])
    return replace(campaign, experiments=kept), (
        f"lateral displacement ({names}) is not compared: the model of a towing record is axial.",
    )


def _axial(record: Record) -> Record:
    measured = tuple(c for c in record.measured if not c.startswith("lateral"))
    if not measured:
        raise InputError("a towing record without a tension cannot be compared.")
    channels = {name: c for name, c in record.channels.items() if not name.startswith("lateral")}
    return Record(record.time, record.prescribed, measured, channels)
