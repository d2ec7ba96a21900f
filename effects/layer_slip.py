r"""Stick and slip bending stiffness of helical layers from the lay-up: what friction between the layers should look like.

A member of area A, modulus E at radius r with lay angle beta (from the cable axis), at the angle phi from the neutral axis:

* While it sticks, bending by kappa strains it by :math:`\kappa r\cos^2\beta\sin\varphi`. The force times the lever, summed
  over the n members of the layer, is the **stick stiffness** :math:`k = \tfrac12 n\,EA\,r^2\cos^3\beta\;\eta`. eta is 1 for
  members in direct contact. A member in a soft seat of stiffness s [N/m^2] (shear of rings of rubber,
  1/s = sum ln(R_o/R_i)/(2 pi G)) slides in it elastically: EA u'' = s (u - u_plane) along a helix with phase rate sin(beta)/r gives
  :math:`\eta = 1/(1 + EA\sin^2\beta/(s r^2))`.
* Axial tension N strains the cable by N / EA_cable; the member carries :math:`t = EA\cos^2\beta\,N/EA_{cable}`, and presses
  on what lies inside it by :math:`t\sin^2\beta/r` per length. Layers further out press as well, by Q per length of member.
* It **slips** at phi where the friction collected from the neutral axis cannot hold the stick force. With friction on the
  inner and the outer side, :math:`dF/d\varphi = \mu[(t + F)\sin\beta + 2 Q r/\sin\beta]`, so that

  .. math:: F(\varphi) = (t + B)\,(e^{\mu\varphi\sin\beta} - 1), \qquad B = \frac{2 Q r}{\sin^2\beta} ,
            \qquad \kappa(\varphi) = \frac{F(\varphi)}{\eta\,EA\,r\cos^2\beta\,\sin\varphi} .

  The first to slip are the members on the neutral axis, :math:`\kappa_{begin} = \mu (t + B)\sin\beta/(\eta EA r\cos^2\beta)`;
  the last those at phi = pi/2, kappa_end.
* The **slip moment** of a layer that slips all round is the mean of :math:`n F r\cos\beta\sin\varphi`.

Members in members (wires in strands in conductors in the cable) are layers of their own; the strain by tension reaches them
through cos^2 of every lay above, and they bend with the cable's curvature.

Derived here after the ideas of K. O. Papailiou, IEEE Trans. Power Delivery 12 (1997) 1576-1588, doi 10.1109/61.634188 (force that a
wire can collect by friction, exponential growth) and F. Foti, L. Martinelli, J. Sound Vib. 374 (2016) (layers that slip one
after the other). The soft seat is an addition. Neither paper was available: the formulas are worked out from general knowledge.
Not contained: pressure of a sheath, shrinkage or clamps, which can exceed that of tension many times; friction that changes
with pressure; contact that opens.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from effects.helical_layer import HelicalLayer, layers_of
from geometry import Cable
from geometry.errors import InputError
from homogenize.stiffness_bounds import loose_stiffness

Array = NDArray[np.float64]

FRICTION = (0.1, 1.0)
"""Friction coefficients to sweep: wire on wire 0.1 to 0.4, wire on rubber 0.3 to 1.0 (general knowledge)."""
_AROUND = (np.arange(64) + 0.5) * np.pi / 128


@dataclass(frozen=True)
class SlippingLayer:
    """A layer under tension: stick stiffness [N m^2], curvatures at which slip begins and ends [1/m], slip moment [N m]."""

    layer: HelicalLayer
    friction_coefficient: float
    pull: float

    @property
    def stick_stiffness(self) -> float:
        """k [N m^2] until it slips."""
        return self.layer.stick_stiffness

    @property
    def slip_begin(self) -> float:
        """Curvature at which the members on the neutral axis slip."""
        exponent = self.friction_coefficient * np.sin(self.layer.lay_angle)
        return float(self.pull * exponent / self._strain_force)

    @property
    def slip_end(self) -> float:
        """Curvature at which the members furthest from the neutral axis slip."""
        return float(self.slip_curvature(np.array([np.pi / 2]))[0])

    @property
    def slip_moment(self) -> float:
        """Moment of the layer when it slips all round."""
        return float(self.moment(np.array([1e3 * max(self.slip_end, 1e-12)]))[0])

    def slip_curvature(self, phi: Array) -> Array:
        """Curvature at which a member at the angle `phi` in (0, pi/2] from the neutral axis slips [1/m]."""
        exponent = self.friction_coefficient * np.sin(self.layer.lay_angle)
        return self.pull * np.expm1(exponent * phi) / (self._strain_force * np.sin(phi))

    def moment(self, curvature: Array) -> Array:
        """Moment (n,) of the layer in first bending to `curvature` (n,)."""
        limit = self.slip_curvature(_AROUND)
        reached = np.minimum(np.abs(curvature)[:, None], limit)
        share = 2 * np.mean(reached * np.sin(_AROUND) ** 2, axis=1)
        return np.sign(curvature) * self.stick_stiffness * share

    @property
    def _strain_force(self) -> float:
        layer = self.layer
        return layer.eta * layer.EA * layer.radius * float(np.cos(layer.lay_angle)) ** 2


@dataclass(frozen=True)
class LayerSlip:
    """Bending of a cable whose layers stick and slip.

    Attributes
    ----------
    EI_slip : float
        All layers slip: the members bend for themselves [N m^2].
    layers : tuple of SlippingLayer
    EA : float
        Axial stiffness by which the tension was shared out [N].
    """

    EI_slip: float
    layers: tuple[SlippingLayer, ...]
    EA: float

    @property
    def EI_stick(self) -> float:
        """No layer slips [N m^2]."""
        return self.EI_slip + sum(one.stick_stiffness for one in self.layers)

    @property
    def stiffness_ratio(self) -> float:
        """(EI_stick - EI_slip) / EI_slip: the strength that friction between layers can have at most."""
        return (self.EI_stick - self.EI_slip) / self.EI_slip if self.EI_slip > 0 else np.inf

    @property
    def slip_curvature(self) -> tuple[float, float]:
        """From the first member that slips to the last [1/m]."""
        return min(one.slip_begin for one in self.layers), max(one.slip_end for one in self.layers)

    def moment(self, curvature: ArrayLike) -> Array:
        """Moment [N m] of first bending to `curvature` (n,) [1/m]."""
        kappa = np.atleast_1d(np.asarray(curvature, dtype=float))
        return self.EI_slip * kappa + np.sum([one.moment(kappa) for one in self.layers], axis=0)


def slip_of_layers(
    layers: Sequence[HelicalLayer], *, EI_slip: float, EA_straight: float, friction_coefficient: float, tension: float
) -> LayerSlip:
    """Layers under an axial `tension` [N]; `EA_straight` [N] is that of the straight parts, which carry their share.

    Raises
    ------
    InputError
        If there is no layer, or a number is negative.

    Examples
    --------
    >>> layer = HelicalLayer("outer", 24, 11.0e-3, 0.2, 6e5)
    >>> slip = slip_of_layers([layer], EI_slip=20.0, EA_straight=3e6, friction_coefficient=0.5, tension=2e4)
    >>> round(slip.EI_stick), slip.layers[0].slip_begin < slip.layers[0].slip_end
    (840, True)
    """
    if not layers:
        raise InputError("there is no helical layer: a cable of straight parts has no slip between layers.")
    if any(not 0 < one.lay_angle < np.pi / 2 for one in layers):
        raise InputError("every layer needs a lay angle between 0 and 90 degrees: straight members do not slip.")
    if min(friction_coefficient, tension, EI_slip, EA_straight) < 0:
        raise InputError(
            f"friction coefficient {friction_coefficient:g}, tension {tension:g} N and stiffnesses must not be negative."
        )
    EA = EA_straight + sum(one.copies * one.strain_share * one.count * one.axial_stiffness for one in layers)
    strain = tension / EA
    pulls = {id(one): _member_tension(one, strain) for one in layers}
    found = []
    for one in layers:
        outside = [o for o in layers if o.group == one.group and o.radius > one.radius]
        pressure = sum(o.count * pulls[id(o)] * np.sin(o.lay_angle) * np.tan(o.lay_angle) / o.radius for o in outside)
        Q = pressure * np.cos(one.lay_angle) / one.count
        B = 2 * Q * one.radius / np.sin(one.lay_angle) ** 2
        found.append(SlippingLayer(one, friction_coefficient, float(pulls[id(one)] + B)))
    return LayerSlip(EI_slip, tuple(found), float(EA))


def _member_tension(layer: HelicalLayer, strain: float) -> float:
    return layer.EA * float(np.cos(layer.lay_angle)) ** 2 * layer.strain_share * strain


def layer_slip(cable: Cable, friction_coefficient: float, tension: float) -> LayerSlip:
    """Stick and slip in bending of a `cable` under `tension` [N], by its own lay-up.

    One friction coefficient serves all layers. Tension is the only grip; see the module docstring for what is left out.

    Raises
    ------
    InputError
        If the cable has no lay, or a number is negative.
    """
    layers = layers_of(cable)
    straight = [p for p in cable.parts if (p.centre_radius == 0 or cable.lay is None) and p.kind != "interstices"]
    cores = [one for one in layers if one.group == "cores"]
    EA = float(sum(p.material.E * p.area for p in straight) + sum(one.count * one.axial_stiffness for one in cores))
    if not layers:
        raise InputError(f"{cable.name}: no lay of cores, strands or wires is known, so that no layer can slip.")
    found: list[SlippingLayer] = []
    for group in dict.fromkeys(one.group for one in layers):
        # each group carries the force that strains it like its host; what else the host is made of is no matter here
        members = [one for one in layers if one.group == group]
        own = sum(one.copies * one.strain_share * one.count * one.axial_stiffness for one in members)
        found += slip_of_layers(
            members, EI_slip=0.0, EA_straight=0.0, friction_coefficient=friction_coefficient, tension=tension * own / EA
        ).layers
    return LayerSlip(loose_stiffness(cable).EI, tuple(found), EA)


def expected(cable: Cable, tension: float, friction: tuple[float, float] = FRICTION) -> dict[str, tuple[float, float]]:
    """What the parameters of interlayer-friction in bending should be, from the lay-up; keys are their names.

    Layers count that hold at least 5 % of what can slip. ``stick stiffness``: from the weakest of them slipping alone to all
    layers; ``slip strain`` [1/m]: from the first member at the least friction to the last at the most, at that `tension` [N],
    the only grip that is counted: a sheath that squeezes makes it larger, never smaller.
    """
    low, high = (layer_slip(cable, mu, tension) for mu in friction)
    enough = 0.05 * (low.EI_stick - low.EI_slip)
    weakest = min(one.stick_stiffness for one in low.layers if one.stick_stiffness >= enough)
    begin = min(one.slip_begin for one in low.layers if one.stick_stiffness >= enough)
    end = max(one.slip_end for one in high.layers if one.stick_stiffness >= enough)
    return {"stick stiffness": (weakest / (low.EI_stick - weakest), low.stiffness_ratio), "slip strain": (begin, end)}
