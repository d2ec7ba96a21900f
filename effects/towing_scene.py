"""The loading of the pictures of towing effects: one pull and half the way back, under two conditions, beside the base model.

The friction of the base model is fitted to the records with the effect, as a calibration would: an effect is seen in what
that leaves.
"""

from __future__ import annotations

import math

import numpy as np

from beam.axial_chain import AxialChain
from effects.effect import Array, BenchPath, Effect
from effects.towed_cable import TowedCable

FRICTION, LENGTH = 0.35, 30.0
_DURATION, _SAMPLES = 10.0, 400


def towed_path(speed: float, tail: float, slope: float) -> BenchPath:
    """Told position over time: a pull, a rest, and 60 % of the way back."""
    t = np.linspace(0.0, _DURATION, _SAMPLES + 1)

    def eased(start: float) -> Array:
        s = np.clip((t - start) / 3.2, 0.0, 1.0)
        return s**3 * (10 - 15 * s + 6 * s**2)

    position = 1.7 * speed * (eased(0.4) - 0.6 * eased(5.0))
    return BenchPath("towing", position, t, LENGTH, np.full(len(t), tail), None, f"{slope:g}", 1.7 * speed)


def tension(effect: Effect | None, path: BenchPath, shape: tuple[float, ...], strength: tuple[float, ...]) -> Array:
    """Tension at the towed end [N] with the plain form of an effect, or of the base model."""
    assert path.time is not None and path.tension is not None and path.direction is not None
    slope = math.radians(float(path.direction))
    chain = AxialChain(LENGTH, 4e5, 4.6, FRICTION, float(path.tension[0]), slope, elements=16)
    cable = TowedCable(chain, path.time, path.strain)
    return (cable if effect is None else effect.forms[0].respond(cable, strength, *shape)).tensions()[0]


def fitted_base(paths: list[BenchPath], loads: list[Array]) -> list[Array]:
    """The base model with the friction that fits all loads best."""
    base = [tension(None, p, (), ()) for p in paths]
    slope = []
    for path, now in zip(paths, base, strict=True):
        assert path.time is not None and path.tension is not None and path.direction is not None
        chain = AxialChain(
            LENGTH, 4e5, 4.6, 1.02 * FRICTION, float(path.tension[0]), math.radians(float(path.direction)), elements=16
        )
        slope.append((TowedCable(chain, path.time, path.strain).tensions()[0] - now) / 0.02)
    J, r = np.concatenate(slope), np.concatenate(loads) - np.concatenate(base)
    x = float(J @ r / (J @ J))
    return [b + x * j for b, j in zip(base, slope, strict=True)]
