r"""Bushings: elastic, damped connections in the six directions of a frame of the first body, formula (21).

.. math:: F_i = -K_i\,(x_i - \text{play}_i) - C_i\,\dot x_i + F_{0,i}, \qquad x = (d_1, d_2, d_3, \varphi_1, \varphi_2, \varphi_3),

F acts on the second body; d is its displacement and phi the rotation vector of its turning, both in the frame that turns with the first
(:mod:`beam.relative_motion`). The moment is conjugate to phi, so that the elastic energy sum K x^2 / 2 is exact at any angle
below half a turn.

With play the direction is free between `low` and `high`; outside, with the depth g and the smoothing length e of its corner,

.. math:: F = \max(0,\; K s + C s' \dot g), \qquad s = g^2 / 2e \;(g < e), \quad s = g - e/2 \;(g \ge e),

pushes back and never pulls: a stop, a contact with gap. A round play holds directions 2 and 3 together in a hole.

Source: Ge et al., PLoS ONE 18(2) e0281136 (2023), formula (21).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from beam.compiled import kernel
from beam.relative_motion import inverse_turn, rotation_vector_of, spread
from beam.surface import Travel
from geometry.errors import SpecError

Array = NDArray[np.float64]

GROUND = "ground"
LAW = 6
"""Rows of a bushing's law: K, C, preload, low, high, edge."""

End = int | str


@dataclass(frozen=True)
class Bushing:
    """A bushing between two ends: a node of the rod (number, negative from the end), a body (its name), or ``"ground"``.

    Parameters
    ----------
    first, second : int or str
        The frame belongs to the first; :math:`F` acts on the second.
    stiffness, damping, preload : (6,) array_like or float
        [N/m, N m/rad], [N s/m, N m s/rad], [N, N m].
    play : (6,) or (6, 2) array_like or float
        Half width, or lower and upper limit, of the free range [m, rad].
    first_point, second_point : (3,) array_like, optional
        Where it is attached, in the axes of the end. Not given: the first at the origin of its end (on the ground: where the second
        is), the second where the first is at the start.
    axes : (3,) array_like
        Rotation vector of the frame in the axes of the first. Of a rod's node, axis 1 is the cable's.
    rest : str
        ``"axes"``: angles are zero where the axes of both ends are parallel; ``"start"``: as they stand at the start.
    edge : (2,) array_like
        Depth over which the corner of the play is rounded, [m] and [rad].
    round_play : bool
        Directions 2 and 3 share the round play of half width `play`[1], with the stiffness and damping of direction 2.
    travel : Travel, optional
        Motion of a point on the ground.
    name : str

    Examples
    --------
    >>> pin = Bushing("clamp 1", "clamp 2", (1e7, 1e7, 1e7, 1e4, 1e4, 50.0), play=(0, 0, 0, 0, 0, 0.2))
    >>> pin.limits[5].tolist()
    [-0.2, 0.2]
    """

    first: End
    second: End
    stiffness: ArrayLike
    damping: ArrayLike = 0.0
    preload: ArrayLike = 0.0
    play: ArrayLike = 0.0
    first_point: ArrayLike | None = None
    second_point: ArrayLike | None = None
    axes: ArrayLike = (0.0, 0.0, 0.0)
    rest: str = "axes"
    edge: ArrayLike = (0.0, 0.0)
    round_play: bool = False
    travel: Travel | None = None
    name: str = ""

    def __post_init__(self) -> None:
        for what, low in (("stiffness", 0.0), ("damping", 0.0), ("preload", -np.inf)):
            value = np.asarray(getattr(self, what), dtype=float)
            if value.shape not in ((), (6,)) or not np.isfinite(value).all() or (value < low).any():
                raise SpecError(
                    f"{self.label}: its {what} must be one or six finite numbers{' of zero or more' if low == 0 else ''}, "
                    f"found {value.tolist()}."
                )
        play = np.asarray(self.play, dtype=float)
        if play.shape not in ((), (6,), (6, 2)) or not (self.limits[:, 1] >= self.limits[:, 0]).all():
            raise SpecError(
                f"{self.label}: its play must be half widths of zero or more, or pairs of a lower and an upper limit, "
                f"found {play.tolist()}."
            )
        if self.rest not in ("axes", "start"):
            raise SpecError(f"{self.label}: rest is 'axes' or 'start', found {self.rest!r}.")
        if self.travel is not None and self.first != GROUND:
            raise SpecError(f"{self.label}: only a first end on the ground can be given a travel.")
        if self.round_play and (self.limits[1] != self.limits[2]).any():
            raise SpecError(f"{self.label}: a round play needs the same play in directions 2 and 3.")

    @property
    def label(self) -> str:
        """Name for messages."""
        return f"bushing {self.name!r}" if self.name else f"bushing between {self.first} and {self.second}"

    @property
    def limits(self) -> Array:
        """Lower and upper end of the free range (6, 2)."""
        play = np.asarray(self.play, dtype=float)
        if play.shape == (6, 2):
            return play
        half = np.broadcast_to(play, (6,))
        return np.stack([-half, half], axis=1)

    @property
    def law(self) -> Array:
        """Numbers of the law, (:data:`LAW`, 6)."""
        edge = np.repeat(np.asarray(self.edge, dtype=float), 3)
        rows = (self.stiffness, self.damping, self.preload, self.limits[:, 0], self.limits[:, 1], edge)
        return np.array([np.broadcast_to(np.asarray(row, dtype=float), (6,)) for row in rows])


@kernel
def push(depth: float, closing: float, k: float, c: float, edge: float) -> tuple[float, float, float]:
    """Force of a stop that is entered by `depth` > 0 at the speed `closing`, its energy [J] and lost power [W]."""
    if depth < edge:
        s, slope, stored = 0.5 * depth * depth / edge, depth / edge, depth * depth * depth / (6.0 * edge)
    else:
        s, slope = depth - 0.5 * edge, 1.0
        stored = 0.5 * s * s + edge * edge / 24.0
    force = max(k * s + c * slope * closing, 0.0)
    return force, k * stored, (force - k * s) * closing


@kernel
def one_direction(law: Array, i: int, x: float, rate: float) -> tuple[float, float, float]:
    """Force in direction `i` without preload, energy and lost power."""
    k, c, low, high = law[0, i], law[1, i], law[3, i], law[4, i]
    if low == high:
        return -k * (x - low) - c * rate, 0.5 * k * (x - low) * (x - low), c * rate * rate
    if x > high:
        force, stored, lost = push(x - high, rate, k, c, law[5, i])
        return -force, stored, lost
    if x < low:
        force, stored, lost = push(low - x, -rate, k, c, law[5, i])
        return force, stored, lost
    return 0.0, 0.0, 0.0


@kernel
def bushing_law(law: Array, hole: bool, x: Array, rate: Array, f: Array) -> tuple[float, float]:
    """Write formula (21) for the displacements `x` and `rate` (6,) into `f` (6,). Returns energy [J] and lost power [W]."""
    energy, power = 0.0, 0.0
    for i in range(6):
        f[i] = 0.0
        if not (hole and (i == 1 or i == 2)):
            f[i], stored, lost = one_direction(law, i, x[i], rate[i])
            energy += stored
            power += lost
    if hole:
        radius = np.sqrt(x[1] * x[1] + x[2] * x[2])
        if radius > law[4, 1]:
            closing = (x[1] * rate[1] + x[2] * rate[2]) / radius
            force, stored, lost = push(radius - law[4, 1], closing, law[0, 1], law[1, 1], law[5, 1])
            f[1], f[2] = -force * x[1] / radius, -force * x[2] / radius
            energy += stored
            power += lost
    for i in range(6):
        f[i] += law[2, i]
        energy -= law[2, i] * x[i]
    return energy, power


@kernel
def bushing_motion(D: Array, x: Array, rate: Array) -> None:
    """Write displacements and rates (6,) of the relative motion `D` of :func:`beam.relative_motion.relative`."""
    for i in range(3):
        x[i], rate[i] = D[i], D[3 + i]
    rotation_vector_of(D[6:15], x[3:6])
    inverse_turn(x[3:6], D[15:18], 1.0, rate[3:6])


@kernel
def bushing_force(
    law: Array, hole: bool, P: Array, B: Array, D: Array, x: Array, rate: Array, f: Array, m: Array, out: Array
) -> tuple[float, float]:
    """Write the generalised forces of a bushing on its ends into `out` (2, 6); poses `P`, `B`, the rest is room."""
    bushing_motion(D, x, rate)
    energy, power = bushing_law(law, hole, x, rate, f)
    inverse_turn(x[3:6], f[3:6], -1.0, m)
    spread(P, B, f, m, out)
    return energy, power
