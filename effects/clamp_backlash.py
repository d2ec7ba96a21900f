r"""Play between neighbouring cable clamps: dead travel at every reversal.

.. math::  p_\text{end} = p - z, \qquad \mathrm{d}z = \mathrm{d}p, \quad |z| \le b/2

the play operator of width b (Visintin, Differential Models of Hysteresis, 1994, ch. III): the end of the cable stands still
while the drive crosses the play. Plain form: at the start the play is taken up towards pulling, where the tension holds it;
richer: the clamp begins in the middle of its play. What a campaign shows is the dead travel of the towed end as a whole; in a scenario of
the rod it is that of the drive (:mod:`beam.drive_play`), not of every pin of a chain.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from beam.drive_play import reversals
from effects.effect import Array, BenchPath, Effect, Form, Parameter, of_values
from effects.stop_operator import stop
from effects.towed_cable import TowedCable, turns_back
from effects.towed_scenario import TowedScenario, si
from geometry.errors import SpecError


def _act(begin: float) -> Callable[..., TowedCable]:
    def act(cable: TowedCable, _strength: Sequence[float], play: float) -> TowedCable:
        if play <= 0:
            return cable

        def drive(t: Array, motion: Array) -> Array:
            z = stop(motion[:, 0], 0.5 * play, 0.5 * begin * play)
            p = motion[:, 0] - z
            free = np.abs(z) < 0.5 * play
            v, a = np.where(free, 0.0, motion[:, 1]), np.where(free, 0.0, motion[:, 2])
            return np.column_stack([p - p[0], v, a])

        return cable.driven(drive)

    return act


def _drive(begin: float) -> Callable[..., TowedScenario]:
    def act(towed: TowedScenario, _strength: Sequence[float], play: float) -> TowedScenario:
        drive, duration = towed.scenario.pull, towed.scenario.time.duration.value
        if begin == 1.0 and len(reversals(drive, duration)) == 1:
            raise SpecError("the play is taken up at the start, and the shearer of this scenario never turns back")
        if towed.scenario.drive.play is not None:
            raise SpecError("the scenario has a drive.play already; leave it out, or the effect")
        where = "taken up" if begin else "centred"
        return towed.changed(
            f"clamp-backlash: drive.play {1e3 * play:.3g} mm, {where} at the start",
            drive__play=si(play, "m"), drive__play_taken_up=begin,
        )  # fmt: skip

    return act


def _why_untestable(paths: Sequence[BenchPath]) -> str | None:
    return None if any(turns_back(p) for p in paths) else "the towed end never turns back"


_SHAPE = (
    Parameter(
        "play", "m", "dead travel at every reversal", plausible=(2e-4, 0.2),
        source="joints of a cable handler: fractions of a millimetre to a tenth of a link",
        starts=of_values(5e-4, 1e-3, 2e-3, 4e-3, 8e-3, 1.6e-2, 3.2e-2, 6.4e-2),
    ),
)  # fmt: skip

EFFECT = Effect(
    name="clamp-backlash",
    kind="physics",
    title="play between neighbouring cable clamps: dead travel at every reversal",
    equation="p_end = p - z, dz = dp, |z| <= b/2",
    source="play operator, Visintin, Differential Models of Hysteresis, 1994, ch. III",
    needs="reversals",
    signature="after every reversal the tension waits until the play is crossed, longer where the drive is slow",
    kinds=("towing",),
    forms=(
        Form("taken up at the start", "drive", _act(1.0), shape=_SHAPE, scenario=_drive(1.0)),
        Form("centred at the start", "drive", _act(0.0), shape=_SHAPE, scenario=_drive(0.0)),
    ),
    why_untestable=_why_untestable,
)
