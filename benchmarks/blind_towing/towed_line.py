r"""A towed line as finite volumes, all records of a campaign at once.

The line of length L is cut into N cells of length h; u is the displacement of their centres, positive uphill, and forces act
on the faces between them:

.. math::  h (m + b_i) \ddot u_i = T_i - T_{i+1} - h f_i - h c_i \dot u_i,\quad
           T_i = \frac{EA}{h} (1 + \beta \partial_t)(u_{i-1} - u_i),\quad f = \mu(v) (m+b) g \cos\theta \, z / d

with the towed end p half a cell before the first centre, no change of tension at the tail, z the travel since the last
reversal held within the presliding d, beta = 2 zeta/omega_1 with omega_1 = pi/(2L) sqrt(EA/m). Weight and tail tension are added
as the tension at rest. The tension at the towed end is the force on the first face, which balances all that the cells take.
Time: implicit-explicit Newmark, the elastic line implicit (trapezoidal), friction and drag explicit at the predicted state
(Hughes & Liu, J. Appl. Mech. 45 (1978) 371); second order while friction neither sticks nor slips.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Drive = Callable[[Array], tuple[Array, Array, Array]]
GRAVITY = 9.81


@dataclass(frozen=True)
class Line:
    """The cable and its trough, SI; `friction` is the coefficient while it slides fast."""

    length: float = 40.0
    EA: float = 4.2e5
    mass: float = 4.8
    friction: float = 0.35
    damping_ratio: float = 0.1
    presliding: float = 3e-4
    cells: int = 40

    @property
    def beta(self) -> float:
        """Damping over stiffness [s]."""
        return 4 * self.damping_ratio * self.length / (math.pi * math.sqrt(self.EA / self.mass))

    @property
    def centres(self) -> Array:
        """Distance of the cells from the towed end [m]."""
        return (np.arange(self.cells) + 0.5) * self.length / self.cells


def constant(speed: Array, travel: Array, station: Array) -> Array:
    """Coulomb: the coefficient does not depend on anything."""
    return np.zeros(())


@dataclass(frozen=True)
class Trough:
    """What the cable meets beyond Coulomb friction: `more(speed, travel, station)` is added to the coefficient.

    `travel` is the distance since the sliding last turned; `drag` [N s/m^2] and `load` [kg/m] are per cell or one for all.
    """

    more: Callable[[Array, Array, Array], Array] = constant
    drag: Array | float = 0.0
    load: Array | float = 0.0
    quadratic: float = 0.0


def rest_tension(line: Line, load: Array | float, slope: float, tail: float, at: Array) -> Array:
    """Tension where nothing has moved yet: tail tension and the weight below."""
    h = line.length / line.cells
    weight = GRAVITY * math.sin(slope) * h * (line.mass + np.broadcast_to(load, line.cells))
    below = np.concatenate([np.cumsum(weight[::-1])[::-1], [0.0]])
    return tail + np.interp(at, np.arange(line.cells + 1) * h, below)


def _operator(line: Line) -> Array:
    """Stiffness (N, N) of the springs between centres and of the half spring at the towed end."""
    k = np.full(line.cells, line.EA * line.cells / line.length)
    k[0] *= 2
    return np.diag(k + np.append(k[1:], 0.0)) - np.diag(k[1:], 1) - np.diag(k[1:], -1)


def tow(
    line: Line,
    drives: Sequence[Drive],
    slopes: Sequence[float],
    tails: Sequence[float],
    trough: Trough,
    t: Array,
    stations: Sequence[float],
    substeps: int,
) -> Array:
    """Tensions (records, 1 + stations, samples) [N]: at the towed end and at the stations.

    Parameters
    ----------
    drives : sequence of callables
        Position, speed and acceleration of the towed end at given instants, one per record.
    slopes, tails : sequences of float
        Inclination [rad] and tail tension [N] of each record.
    t : (samples,) array
        Equally spaced instants [s].
    substeps : int
        Time steps between two of them.
    """
    R, N, h = len(drives), line.cells, line.length / line.cells
    dt = float(t[1] - t[0]) / substeps
    fine: Array = np.arange((len(t) - 1) * substeps + 1, dtype=float) * dt
    p, pv = (np.array(x) for x in list(zip(*(d(fine) for d in drives), strict=True))[:2])
    K, beta, x = _operator(line), line.beta, line.centres
    mass = np.broadcast_to(line.mass + np.asarray(trough.load, float), N)
    inverse = np.linalg.inv(np.diag(h * mass) + (dt * beta / 2 + dt**2 / 4) * K)
    normal = h * mass * GRAVITY * np.cos(np.asarray(slopes))[:, None]
    drag = h * np.broadcast_to(trough.drag, N)
    half = 2 * line.EA / h
    u, v, a, z, way, last = (np.zeros((R, N)) for _ in range(6))
    kept = np.zeros((R, 1 + len(stations), len(t)))
    faces = np.arange(N + 1) * h
    for n in range(1, len(fine)):
        guess, rate = u + dt * v + dt**2 / 4 * a, v + dt / 2 * a
        gone = guess + dt**2 / 4 * a - last  # friction moves with the explicit prediction
        last = guess + dt**2 / 4 * a
        way = np.where(gone * z < 0, 0.0, way + np.abs(gone))
        z = np.clip(z + gone, -line.presliding, line.presliding)
        mu = line.friction + trough.more(np.abs(rate), way, x)
        resist = mu * normal * z / line.presliding + drag * rate + h * trough.quadratic * rate * np.abs(rate)
        force = -(guess + beta * rate) @ K - resist
        force[:, 0] += half * (p[:, n] + beta * pv[:, n])
        a = force @ inverse
        u, v = guess + dt**2 / 4 * a, rate + dt / 2 * a
        if n % substeps == 0:
            w = u + beta * v
            end = half * (p[:, n] + beta * pv[:, n] - w[:, 0])
            inner = line.EA / h * (w[:, :-1] - w[:, 1:])
            profile = np.column_stack([end, inner, np.zeros(R)])
            kept[:, 0, n // substeps] = end
            for k, s in enumerate(stations):
                j = min(int(s / h), N - 1)
                q = (s - faces[j]) / h
                kept[:, 1 + k, n // substeps] = (1 - q) * profile[:, j] + q * profile[:, j + 1]
    at = np.array([0.0, *stations])
    for r in range(R):
        kept[r] += rest_tension(line, trough.load, slopes[r], tails[r], at)[:, None]
    return kept
