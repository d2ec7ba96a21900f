r"""Hertz contact of two strands that press on each other along a line: how wide the flat is.

Cylinders with parallel axes, pressed by the force p per length, touch on a strip of half-width

.. math::  a = \sqrt{\frac{4 p}{\pi E^* \kappa}}, \qquad
           \frac1{E^*} = \frac{1 - \nu_a^2}{E_a} + \frac{1 - \nu_b^2}{E_b}, \qquad \kappa = \frac1{R_a} + \frac1{R_b} .

Strands of one lay also touch along a line, a helix. What counts is the curvature of the gap across that line. In the plane
normal to the axis the gap grows as (k_a + k_b) s^2 / 2 with the distance s along the tangent t, k the curvatures of the two
traces; seen from the line, with the surface normal N and the direction h of the helix (turn rate tau, touching point x, normal n of the
traces),

.. math::  \kappa = \frac{(k_a + k_b) \cos\alpha}{1 - (t \cdot h)^2}, \quad
           \cos\alpha = \frac1{\sqrt{1 + \tau^2 (n \times x)^2}}, \quad
           t \cdot h = \frac{\tau\, n \cdot x}{\sqrt{1 + \tau^2 |x|^2}} ,

and the strip looks wider in that plane, by 1 / sqrt(1 - (t . h)^2).

Source: H. Hertz, J. reine angew. Math. 92 (1882) 156-171; K. L. Johnson, Contact Mechanics, 1985, chapter 4.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from geometry.errors import GeometryError
from geometry.material import Material
from geometry.strand_contact import touch_of
from geometry.wire_trace import WireTrace


@dataclass(frozen=True)
class LineContact:
    """`curvature` kappa of the gap across the line of contact [1/m]; `stretch` of the strip in the plane normal to the axis, >= 1."""

    curvature: float
    stretch: float


def line_contact(a: WireTrace, b: WireTrace) -> LineContact:
    """Contact line of two round strands of one lay, given by their traces (a straight one on the axis has any lay).

    Examples
    --------
    >>> core, wire = WireTrace(0.0, 0.0, 2e-3, 0.0), WireTrace(3.5e-3, 0.0, 1.5e-3, 0.0)
    >>> found = line_contact(core, wire)
    >>> round(found.curvature, 3), found.stretch
    (1166.667, 1.0)
    """
    touch = touch_of(a, b)
    n, x = touch.normal, touch.middle
    tau = a.twist_rate if a.centre_radius > 0 else b.twist_rate
    lean = tau * (n[0] * x[1] - n[1] * x[0])
    along = tau * float(n @ x) / np.sqrt(1 + tau**2 * float(x @ x))
    across = 1 - along**2
    rise = a.curvature(touch.on_first) + b.curvature(touch.on_second)
    return LineContact(float(rise / np.sqrt(1 + lean**2) / across), float(1 / np.sqrt(across)))


def hertz_half_width(line_force: float, contact: LineContact, a: Material, b: Material) -> float:
    """Half-width [m] of the strip on which two strands touch, across the line of contact.

    Parameters
    ----------
    line_force : force per length of the line of contact [N/m], not negative
    contact : from :func:`line_contact`
    a, b : materials of the two strands

    Raises
    ------
    GeometryError
        If the force is negative, or the strands do not bulge against each other.

    Examples
    --------
    >>> steel = Material("steel", 200e9, 0.3, 7850.0)
    >>> wires = LineContact(curvature=2 / 1e-3, stretch=1.0)
    >>> round(1e6 * hertz_half_width(1e4, wires, steel, steel), 3)
    7.611
    """
    if not (np.isfinite(line_force) and line_force >= 0):
        raise GeometryError(f"strands are pressed by a force per length of zero or more, found {line_force:g} N/m.")
    if not contact.curvature > 0:
        raise GeometryError(
            f"the gap between the two strands has the curvature {contact.curvature:g} 1/m: they do not touch along one line."
        )
    softness = (1 - a.nu**2) / a.E + (1 - b.nu**2) / b.E
    return float(np.sqrt(4 * line_force * softness / (np.pi * contact.curvature)))
