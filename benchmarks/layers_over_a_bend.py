r"""A cable of slipping layers that is drawn over a bend, material point by material point.

The independent side of :mod:`effects.bending_loss`: nothing is imported from there. Points of the cable, `spacing` apart, move
through a curvature that stands still, kappa(s) = 1/R on the arc and falling as exp(-s/lambda) before and behind it. Each has the
stick-slip elements of :mod:`benchmarks.hidden_effect_campaign`, whose grip follows the tension of the instant. While the cable moves
by dp, the moments M of all points do work, and the tension that this takes is

.. math::  T_\text{bend} = \sum_i M_i\,[\kappa(s_i + h/2) - \kappa(s_i - h/2)]

Before a record the cable is drawn to and fro, so that no point comes to the bend for the first time, and then ever less, until no
tension is left of it at rest. lambda = sqrt(EI/T) with the stiffness EI of slipped layers and the tension at rest.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from benchmarks.hidden_effect_campaign import BASE, EI, LAYERS, POWER, TENSION

Array = NDArray[np.float64]
_TAIL = 6.0  # transition lengths before and behind the arc


def sliders() -> tuple[Array, Array]:
    """Stick stiffness [N m^2] and slip curvature [1/m] at the typical tension, (elements,) each."""
    stiffness, limit = zip(*(layer.sliders() for layer in LAYERS), strict=True)
    return np.concatenate(stiffness), np.concatenate(limit)


def grip(tension: float) -> float:
    """Factor on the slip curvatures."""
    return BASE + (1 - BASE) * (tension / TENSION) ** POWER


@dataclass(frozen=True)
class Bend:
    """Radius [m], angle of wrap [rad] and distance of the material points [m]."""

    radius: float
    angle: float = math.pi
    spacing: float = 4e-3

    def tension(self, t: Array, position: Array, tension: Array) -> Array:
        """What the bend adds to the tension [N], (n,), while the cable moves by position [m] under a tension before it [N]."""
        return _Passage(self, float(tension[0]), position).run(position, tension)


class _Passage:
    """The points that come near the bend in a record."""

    def __init__(self, bend: Bend, at_rest: float, position: Array) -> None:
        self.h, self.k0, self.arc = bend.spacing, 1 / bend.radius, bend.radius * bend.angle
        self.width = math.sqrt(EI / at_rest)
        reach = _TAIL * self.width
        self.first = 2 * reach + self.arc
        low, high = min(float(position.min()), 0.0) - self.first, max(float(position.max()), 0.0) + self.first
        self.X = np.arange(-reach - high, self.arc + reach - low, self.h)
        self.stiffness, self.limit = sliders()
        self.z = np.zeros((len(self.X), len(self.limit)))
        self.p = 0.0
        self.kappa = self._bent(self.X)

    def _bent(self, s: Array) -> Array:
        outside = np.maximum(np.maximum(-s, s - self.arc), 0.0)
        return self.k0 * np.exp(-outside / self.width)

    def to(self, p: float, tension: float) -> float:
        """Move there in steps of at most half a spacing, and read the tension that it takes [N]."""
        steps = max(1, math.ceil(abs(p - self.p) / (self.h / 2)))
        top = self.limit * grip(tension)
        for q in np.linspace(self.p, p, steps + 1)[1:]:
            kappa = self._bent(self.X + q)
            near = np.flatnonzero(kappa != self.kappa)
            self.z[near] = np.clip(self.z[near] + (kappa - self.kappa)[near, None], -top, top)
            self.kappa = kappa
        self.p = p
        step = self._bent(self.X + p + self.h / 2) - self._bent(self.X + p - self.h / 2)
        return float((self.z @ self.stiffness) @ step)

    def run(self, position: Array, tension: Array) -> Array:
        rest, swing = float(tension[0]), self.first / 2
        while swing > self.h / 8:
            self.to(swing, rest)
            swing *= -0.75
            self.to(swing, rest)
            swing *= -0.75
        self.to(0.0, rest)
        return np.array([self.to(x, T) for x, T in zip(position, tension, strict=True)])


def work(radius: float, tension: float) -> float:
    """Work of one closed passage per length [N], in closed form: 2 K x (1/R - 2 x) of every element that slips both ways."""
    stiffness, limit = sliders()
    x = limit * grip(tension)
    return float(np.sum(2 * stiffness * x * np.maximum(1 / radius - 2 * x, 0.0)))
