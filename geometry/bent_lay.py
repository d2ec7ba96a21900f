r"""What becomes of the lay of a conductor when it is bent onto a core helix: the pitch correction.

Strands of radius r2 and lay p2 (per arc length s of the conductor's centre line, turns counted in its frame of parallel
transport, nested_helix.py) sit on a core helix with the turn rate tau = 2 pi / pitch (signed) at radius r, lay angle
beta = atan(tau r), curvature kappa = sin^2 beta / r, torsion tau cos^2 beta. This is formula (2) of Ge et al., PLoS ONE
18(2) e0281136 (2023). The core's own frame (phi = 0 away from the cable axis) turns by the torsion against the
transported one, so that per height z of the cable the strands turn in it by

.. math::  \omega = \frac{h_2\, 2\pi/p_2 - \tau\cos^2\beta}{\cos\beta} .

At the angle psi from the inside of the bend (the principal normal) a strand has the lay angle

.. math::  \tan\beta_2 = \frac{2\pi r_2/p_2}{1 - \kappa r_2\cos\psi},

the ratio of the two components of its velocity in nested_helix.py. On the inside it lies steeper than in the straight
conductor, and neighbours that just cleared there overlap. The corrected lay is the one at which the smallest clearance
along the bent conductor equals that of the straight one. The worst pair of n strands straddles the inside, so that for
small kappa r2 and small lay angles it is p2 / (1 - kappa r2 cos(pi / n)). Strands keep exactly their distance r2 from the
centre line, so that the contact with the centre strand does not change.

The core helix goes over into itself by a screw motion, so that all pairs of neighbours pass through the same positions
while they turn once relative to it: one pair and one turn are the whole common period. Both strands are in closed form.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from geometry.errors import GeometryError
from geometry.helix import HANDS, Helix, lay_angle
from geometry.strand_layer import StrandLayer, layer_gap

POSITIONS = 48
"""Directions of the first strand of a pair, over a turn; the clearance is a smooth, nearly harmonic function of them."""


@dataclass(frozen=True)
class BentLay:
    """A layer of a conductor before and after it is bent onto a core helix; lengths [m], angles [rad], rates [rad/m].

    Attributes
    ----------
    lay, corrected_lay : per arc length of the conductor, without the torsion of the core; None for straight strands
    straight_clearance : smallest clearance of neighbours in the straight conductor, negative where they overlap
    bent_clearance, corrected_clearance : the same on the core helix, with either lay
    centre_clearance : clearance to the centre strand or layer below, not changed by bending; None if none was given
    steepest_lay_angle : lay angle of the strands at the inside of the bend, with `lay`
    turn_rate, corrected_turn_rate : omega, turns in the core's own frame per height z of the cable, signed
    turn_rate_in_cable : turns against fixed axes per height z of the cable, omega + tau, with `lay`
    lay_in_core : arc length of the conductor in which strands turn once in the core's own frame, with `lay`; inf for none
    """

    lay: float | None
    corrected_lay: float | None
    straight_clearance: float
    bent_clearance: float
    corrected_clearance: float
    centre_clearance: float | None
    steepest_lay_angle: float
    turn_rate: float
    corrected_turn_rate: float
    turn_rate_in_cable: float
    lay_in_core: float

    @property
    def height_of_turn(self) -> float:
        """Height z [m] over which strands turn once in the core's own frame, with `lay`; inf if they do not turn."""
        return 2 * np.pi / abs(self.turn_rate) if self.turn_rate else np.inf


def bent_lay(core: Helix, layer: StrandLayer, hand: str = "Z") -> BentLay:
    """Clearance of the strands of one layer of a conductor on a core helix, and the lay that restores it.

    Parameters
    ----------
    core : centre line of the conductor in the cable; of radius 0 for a conductor on the axis
    layer : the layer in the straight conductor
    hand : of the strands, "Z" or "S"

    Raises
    ------
    GeometryError
        If the core bends more sharply than the strands can follow.

    Examples
    --------
    Power conductor of a shearer cable, strands of 2.967 mm that just touch:

    >>> from geometry.strand_layer import solve_layer
    >>> bent = bent_lay(Helix(11.625e-3, 0.234), solve_layer(count=6, lay=0.127, radius_below=1.508e-3))
    >>> round(1e6 * bent.bent_clearance, 2), round(1e3 * (bent.corrected_lay or 0), 1)
    (-0.99, 129.6)
    """
    radius, lay = layer.radius, layer.lay
    _check_bend(core, radius)
    straight = layer_gap(layer.count, layer.diameter, radius, lay)
    bent = bent_clearance(core, layer.count, layer.diameter, radius, lay, hand)
    corrected = _corrected_lay(core, layer, straight, hand)
    rate = relative_turn_rate(core.radius, core.turn_rate, lay, hand)
    return BentLay(
        lay=lay,
        corrected_lay=corrected,
        straight_clearance=straight,
        bent_clearance=bent,
        corrected_clearance=bent_clearance(core, layer.count, layer.diameter, radius, corrected, hand),
        centre_clearance=layer.gap_below,
        steepest_lay_angle=float(np.arctan(np.tan(lay_angle(radius, lay)) / (1 - core.curvature * radius))),
        turn_rate=rate,
        corrected_turn_rate=relative_turn_rate(core.radius, core.turn_rate, corrected, hand),
        turn_rate_in_cable=rate + core.turn_rate,
        lay_in_core=2 * np.pi / (abs(rate) * float(np.cos(core.lay_angle))) if rate else np.inf,
    )


def bent_clearance(
    core: Helix, count: int, diameter: float, radius: float, lay: float | None, hand: str = "Z"
) -> float:
    """Smallest clearance [m] of neighbouring strands along a conductor on a core helix; inf for a single strand.

    Parameters
    ----------
    core : centre line of the conductor
    count, diameter, radius : strands of the layer, their diameter and the radius of their centres [m]
    lay : per arc length of the conductor [m], without the torsion of the core; None for straight strands
    """
    _check_bend(core, radius)
    if count == 1:
        return np.inf
    rate = lay_rate(lay, hand) - core.torsion
    step = 2 * np.pi / count
    directions = np.linspace(0, 2 * np.pi, POSITIONS, endpoint=False)
    spacing = 2 * np.pi / POSITIONS
    best = np.inf
    for _ in range(4):
        distances = _distances(core, radius, rate, directions, step)
        worst = directions[int(np.argmin(distances))]
        best = min(best, float(distances.min()))
        directions = np.linspace(worst - spacing, worst + spacing, 17)
        spacing /= 8
    return best - diameter


def _distances(
    core: Helix, radius: float, rate: float, directions: NDArray[np.float64], step: float
) -> NDArray[np.float64]:
    """Distance of the strand at each direction, at s = 0, from the centre line of its neighbour, shape (m,)."""
    here = strand_points(core, radius, np.zeros_like(directions), directions)
    middle, half, count = np.zeros_like(directions), 2 * np.pi * radius, 161
    best = np.full_like(directions, np.inf)
    for _ in range(5):
        s = middle[:, None] + np.linspace(-half, half, count)
        there = strand_points(core, radius, s, directions[:, None] + step + rate * s)
        squares = ((there - here[:, None, :]) ** 2).sum(-1)
        rows = np.arange(len(directions)), squares.argmin(1)
        middle, best, half = s[rows], np.minimum(best, squares[rows]), 2 * half / count
        count = 33
    return np.sqrt(best)


def strand_points(
    core: Helix, radius: float, s: NDArray[np.float64], direction: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Points (..., 3) [m] at arc length s (...) of a core and in a `direction` (...) of its own frame, 0 away from the axis."""
    z = s * np.cos(core.lay_angle)
    _, N, B = np.moveaxis(core.frenet_frame(z), -2, 0)
    return core.position(z) - radius * (np.cos(direction)[..., None] * N + np.sin(direction)[..., None] * B)


def _corrected_lay(core: Helix, layer: StrandLayer, wanted: float, hand: str) -> float | None:
    """Lay at which the smallest clearance on the core is `wanted`; it grows with the lay."""
    if layer.lay is None or layer.count == 1 or core.curvature == 0:
        return layer.lay

    def spare(lay: float) -> float:
        return bent_clearance(core, layer.count, layer.diameter, layer.radius, lay, hand) - wanted

    high = layer.lay / (1 - core.curvature * layer.radius)
    for _ in range(40):
        if spare(high) >= 0:
            break
        high *= 1.5
    else:
        raise GeometryError(
            f"no lay restores the clearance of {layer.count} strands of {1e3 * layer.diameter:.4g} mm bent onto a core of radius "
            f"{1e3 * core.radius:.4g} mm: lengthen the cabling lay of {1e3 * core.pitch:.4g} mm."
        )
    if spare(layer.lay) >= 0:
        return layer.lay
    return float(brentq(spare, layer.lay, high, xtol=1e-9 * layer.lay))  # type: ignore[arg-type]


def _check_bend(core: Helix, radius: float) -> None:
    if core.curvature * radius >= 1:
        raise GeometryError(
            f"strands on a radius of {1e3 * radius:.4g} mm cannot follow a core that bends to {1e3 / core.curvature:.4g} mm: "
            f"lengthen the cabling lay of {1e3 * core.pitch:.4g} mm."
        )


def relative_turn_rate(core_radius: float, cabling_rate: float, strand_lay: float | None, strand_hand: str) -> float:
    """Rate [rad per m of z] at which strands turn in the frame that turns with their core; see the module docstring.

    Parameters
    ----------
    core_radius : radius r [m] of the core helix; 0 for a conductor on the cable axis
    cabling_rate : tau = 2 pi / cabling lay [rad/m], positive for Z, zero for a straight cable
    strand_lay : lay [m] per arc length of the conductor, counted without the torsion of the core; None for strands that
        were straight before the conductor was laid up
    strand_hand : "Z" or "S"

    Raises
    ------
    GeometryError
        If the radius is negative, the lay not positive, or the hand unknown.

    Examples
    --------
    The three straight strands on the axis of a cable with lay 234 mm stand still while the section turns:

    >>> round(relative_turn_rate(0.0, 2 * np.pi / 0.234, None, "Z") * 0.234 / (2 * np.pi), 12)
    -1.0
    """
    if not (np.isfinite(core_radius) and core_radius >= 0 and np.isfinite(cabling_rate)):
        raise GeometryError(
            f"a core helix needs a radius that is not negative and a finite turn rate, found {core_radius:g} m and {cabling_rate:g} rad/m."
        )
    stretch = float(np.sqrt(1 + (core_radius * cabling_rate) ** 2))
    return lay_rate(strand_lay, strand_hand) * stretch - cabling_rate / stretch


def lay_rate(lay: float | None, hand: str) -> float:
    """Turn rate h 2 pi / lay [rad/m], signed; zero for straight members (lay None)."""
    if hand not in HANDS:
        raise GeometryError(f'the hand of a lay is "Z" (right) or "S" (left), found "{hand}".')
    if lay is None:
        return 0.0
    if not (np.isfinite(lay) and lay > 0):
        raise GeometryError(
            f"a lay must be a positive length, found {lay:g} m; give the hand as Z or S instead of a sign."
        )
    return float(HANDS[hand] * 2 * np.pi / lay)
