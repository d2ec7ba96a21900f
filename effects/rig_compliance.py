r"""Compliance of the rig: the frame, the load cell and the grips stretch with the load, in series with the specimen.

.. math::  u = \varepsilon L + \frac{K\varepsilon}{k_\text{rig}} \quad\Rightarrow\quad
           \varepsilon = \frac{u/L}{1 + c/L}, \qquad c = \frac{K}{k_\text{rig}}

c is the length of cable that is as compliant as the rig: EA over the stiffness of the frame [N/m] in tension, GJ over
that of the drive [N m/rad] in torsion. At one length the apparent stiffness K/(1 + c/L) is just another stiffness, so
that only lengths show it; and lengths alone cannot tell it from a load that enters through the sheath
(``end-load-introduction``), which has the same law. A specimen of unknown length is left as it is. Source: springs in
series, e.g. ASTM E111, on extension measured between the grips.
"""

from __future__ import annotations

from collections.abc import Sequence

from effects.effect import Array, BenchPath, Effect, Form, Parameter, of_length

_LENGTHS_DIFFER = 1.05  # ratio of lengths below which they count as equal


def _in_series(path: BenchPath, compliance: float) -> Array:
    if path.length is None:
        return path.strain
    return path.strain / (1.0 + compliance / path.length)


def one_length(paths: Sequence[BenchPath]) -> str | None:
    """The sentence why these records cannot show an effect of the specimen length, or None if they may."""
    lengths = [p.length for p in paths if p.length is not None]
    if not lengths:
        return "no specimen length is recorded; it shows only in how the apparent stiffness changes with length"
    if max(lengths) < _LENGTHS_DIFFER * min(lengths):
        return f"all specimens are {lengths[0]:.4g} m long; test a second length, at least half or twice that"
    return None


EFFECT = Effect(
    name="rig-compliance",
    kind="rig",
    title="the frame stretches with the load: apparent stiffness depends on specimen length",
    equation="strain = (u/L)/(1 + c/L), c = K/k_rig",
    source="springs in series; ASTM E111 on extension measured between the grips",
    needs="specimens of at least two lengths, best of ratio 2 or more; a gauge on the specimen itself would tell it from"
    " end-load-introduction",
    signature="straight lines without a loop, flatter for shorter specimens: 1/K_apparent is linear in 1/L",
    kinds=("tension", "torsion"),
    forms=(
        Form(
            "compliance in series",
            "fixture",
            _in_series,
            shape=(
                Parameter(
                    "compliance", "m", "length of cable as compliant as the rig",
                    plausible=(0.0, 5.0),
                    source="cables of EA 0.1 to 10 MN in frames of 2 to 100 MN/m: 1 mm to 5 m",
                    starts=of_length(0.005, 2.0, 16),
                ),
            ),
        ),
    ),
    why_untestable=one_length,
)  # fmt: skip
