r"""Backlash: free play in the grips or joints, which the path has to cross before the specimen feels anything.

.. math::  u_\text{section} = \operatorname{sign}(u)\,\max\bigl(|u| - \tfrac{\delta}{2},\, 0\bigr), \qquad
           \varepsilon = u_\text{section} / L

delta is the whole play between the two contacts, a length in tension and shear, an angle in torsion and bending. It
belongs to the grips: its strain goes with 1/L. The specimen pulls the joint back against its contact, so that the play
lies around zero load and loading and unloading are the same curve. Where no specimen length is recorded L is 1 m, and
the play found is that of a specimen of 1 m.

Richer: contacts that close gradually,

.. math::  u_\text{section} = u - \frac{u}{\bigl(1 + |2u/\delta|^{1/r}\bigr)^{r}},

which is the sharp play for r = 0; and a joint that does not rest in the middle of its play, with another way to go
to either side. Source: the dead-zone nonlinearity, e.g. Nordin & Gutman, Automatica 38 (2002) 1633.
"""

from __future__ import annotations

import numpy as np

from effects.effect import Array, BenchPath, Effect, Form, Parameter, of_play, of_values

_FITS = "pin joints in H11/d11 of ISO 286 have 0.08 to 0.4 mm; several in series, worn, reach centimetres or degrees"


def _free_play(path: BenchPath, play: float) -> Array:
    return _beyond(path.strain, _half(path, play), _half(path, play))


def _unequal_play(path: BenchPath, up: float, down: float) -> Array:
    length = path.length or 1.0
    return _beyond(path.strain, up / length, down / length)


def _gradual_play(path: BenchPath, play: float, rounding: float) -> Array:
    half = _half(path, play)
    if rounding < 1e-3 or half == 0.0:
        return _beyond(path.strain, half, half)
    size = np.abs(path.strain) / half
    # (1 + size^(1/r))^-r, written so that no power overflows
    lost = np.minimum(1.0, size) * (1 + np.minimum(size, 1 / np.maximum(size, 1e-300)) ** (1 / rounding)) ** -rounding
    return path.strain - np.sign(path.strain) * half * lost


def _half(path: BenchPath, play: float) -> float:
    return play / 2 / (path.length or 1.0)


def _beyond(strain: Array, up: float, down: float) -> Array:
    """Strain beyond a dead zone from -down to up."""
    return np.maximum(strain - up, 0.0) - np.maximum(-strain - down, 0.0)


_PLAY = Parameter(
    "play",
    "play",
    "way from one contact to the other",
    plausible=(0.0, 0.05),
    source=_FITS,
    starts=of_play(0.01, 1.0, 10),
)

_ROUNDING = Parameter(
    "rounding",
    "1",
    "0 for hard contacts",
    high=2.0,
    plausible=(0.0, 2.0),
    source="0 a sharp contact, 2 one that closes over many plays (by definition)",
    starts=of_values(0.25, 0.5, 1.0),
)


def _way(side: str) -> Parameter:
    meaning = f"way to the contact of {'positive' if side == 'up' else 'negative'} loads"
    return Parameter(
        f"play {side}", "play", meaning, plausible=(0.0, 0.05), source=_FITS, starts=of_play(0.005, 0.5, 7)
    )


EFFECT = Effect(
    name="backlash",
    kind="rig",
    title="free play in the grips or joints around zero load",
    equation="u_section = sign(u) max(|u| - play/2, 0), strain = u_section/L",
    source="dead-zone nonlinearity, e.g. Nordin & Gutman, Automatica 38 (2002) 1633",
    needs=(
        "samples around zero load; one specimen length shows it by its shape, and a second one, twice as long, shows that"
        " it is a length of the grips and not a strain of the cable"
    ),
    signature="flat around zero load, then the linear line moved sideways by half the play; the same on the way back; in"
    " terms of strain half as wide for twice the length",
    kinds=("tension", "torsion", "bending", "shear"),
    forms=(
        Form("free play", "fixture", _free_play, shape=(_PLAY,)),
        Form("contacts that close gradually", "fixture", _gradual_play, shape=(_PLAY, _ROUNDING)),
        Form("unequal ways to either side", "fixture", _unequal_play, shape=(_way("up"), _way("down"))),
    ),
)
