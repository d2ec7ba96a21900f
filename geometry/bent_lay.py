r"""What becomes of the lay of a conductor when it is bent onto a core helix.

Strands of radius r2 and lay p2 (per arc length s of the conductor's centre line, turns counted in its frame of parallel
transport, nested_helix.py) sit on a core helix with the turn rate tau = 2 pi / pitch (signed) at radius r, lay angle
beta = atan(tau r), torsion sin beta cos beta / r = tau cos^2 beta. The core's own frame (phi = 0 away from the cable
axis) turns by the torsion against the transported one, so that per height z of the cable the strands turn in it by

.. math::  \omega = \frac{h_2\, 2\pi/p_2 - \tau\cos^2\beta}{\cos\beta} .
"""

from __future__ import annotations

import numpy as np

from geometry.errors import GeometryError
from geometry.helix import HANDS


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
    return HANDS[hand] * 2 * np.pi / lay
