r"""Contact that opens and rubs, at a point: one-sided pressure and Coulomb friction with return mapping.

With the opening g and the slip s = (s_a, s_b) of two parts (:mod:`homogenize.sliding_interface`)

.. math::
   p = \max(0,\; p_0 - k_n (g + g_0)), \qquad t^* = t_{old} + k_t (s - s_{old}), \qquad
   t = t^* \min(1,\; \mu p / |t^*|) .

g_0 is the gap of the parts as drawn, negative for an interference; p_0 a grip that is there before the load and is in balance with
stresses that are in the parts already (so the parts do not move until a load comes). An open point forgets its friction.
k_n, k_t: stiffness of the interface; the limits are hard contact and stick.

Simo, Laursen, Comput. Struct. 42 (1992) 97-116, doi 10.1016/0045-7949(92)90540-G.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geometry.errors import SpecError

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class FrictionalContact:
    """Contact between two parts that opens under tension and rubs.

    Parameters
    ----------
    friction : Coulomb's mu
    grip : p_0 [Pa]
    gap : g_0 of the parts as drawn [m]; negative: an interference
    normal, tangential : k_n, k_t [Pa/m]; 1e11 Pa/m is 100 MPa per mm, an interface as stiff as 0.04 mm of rubber of 4 MPa

    Raises
    ------
    SpecError
        If a constant is negative or not finite, or parts with a gap are gripped.

    Examples
    --------
    >>> FrictionalContact(0.3, gap=-2e-5).describe()
    'contact that opens, friction 0.3, interference 2e-05 m'
    """

    friction: float
    grip: float = 0.0
    gap: float = 0.0
    normal: float = 1e11
    tangential: float = 1e11

    def __post_init__(self) -> None:
        constants = (self.friction, self.grip, self.normal, self.tangential)
        if not all(np.isfinite(c) and c >= 0 for c in constants) or not np.isfinite(self.gap):
            raise SpecError(
                f"friction {self.friction:g}, grip {self.grip:g} Pa and the stiffness {self.normal:g}, {self.tangential:g} Pa/m "
                "of a contact must be zero or positive, and its gap finite."
            )
        if self.normal == 0 or self.tangential == 0:
            raise SpecError("a contact needs a stiffness above zero; 1e11 Pa/m is nearly hard.")
        if self.gap > 0 and self.grip > 0:
            raise SpecError("parts with a gap between them cannot be gripped: give a grip or a gap.")

    @property
    def holds(self) -> bool:
        """A small slip is resisted once the parts are pressed together."""
        return True

    @property
    def opens(self) -> bool:
        """The normal jump is an unknown."""
        return True

    def describe(self) -> str:
        """The law in words."""
        words = [f"contact that opens, friction {self.friction:g}"]
        words += [f"grip {self.grip:g} Pa"] if self.grip else []
        words += [f"{'gap' if self.gap > 0 else 'interference'} {abs(self.gap):g} m"] if self.gap else []
        return ", ".join(words)


@dataclass(frozen=True)
class ContactConstants:
    """Constants of the law at every point, each (p,)."""

    friction: FloatArray
    grip: FloatArray
    gap: FloatArray
    normal: FloatArray
    tangential: FloatArray


@dataclass(frozen=True)
class ContactState:
    """What a contact remembers, and its forces per area.

    Attributes
    ----------
    jump : (p, 3) g, s_a, s_b [m]
    shear : (p, 2) t [Pa]
    pressure : (p,) p [Pa]
    """

    jump: FloatArray
    shear: FloatArray
    pressure: FloatArray

    def open(self) -> NDArray[np.bool_]:
        """(p,) points without pressure."""
        return self.pressure <= 0.0


def at_rest(constants: ContactConstants) -> ContactState:
    """The state before anything moved."""
    p = len(constants.grip)
    return ContactState(
        np.zeros((p, 3)), np.zeros((p, 2)), np.maximum(0.0, constants.grip - constants.normal * constants.gap)
    )


def contact_law(
    jump: FloatArray, old: ContactState, constants: ContactConstants, pressed: FloatArray | None = None
) -> tuple[ContactState, FloatArray, FloatArray]:
    """State, forces (p, 3) on (g, s_a, s_b) per area, and their derivative (p, 3, 3), for jumps (p, 3).

    With `pressed` (p,) the friction is that of these pressures, whatever the pressure is: then the derivative is symmetric.
    """
    c = constants
    closed = c.grip - c.normal * (jump[:, 0] + c.gap)
    touch = closed > 0
    pressure = np.where(touch, closed, 0.0)
    trial = old.shear + c.tangential[:, None] * (jump[:, 1:] - old.jump[:, 1:])
    size = np.maximum(np.linalg.norm(trial, axis=1), 1e-300)
    cap = c.friction * (pressure if pressed is None else pressed)
    slips = size > cap
    direction = trial / size[:, None]
    shear = np.where(slips[:, None], cap[:, None] * direction, trial)
    force = np.concatenate([(c.grip - pressure)[:, None], shear], axis=1)
    tangent = np.zeros((len(jump), 3, 3))
    tangent[:, 0, 0] = np.where(touch, c.normal, 0.0)
    ratio = np.where(slips, cap, 1.0) / np.where(slips, size, 1.0) * c.tangential
    across = np.eye(2) - np.where(slips, 1.0, 0.0)[:, None, None] * direction[:, :, None] * direction[:, None, :]
    tangent[:, 1:, 1:] = ratio[:, None, None] * across
    if pressed is None:
        tangent[:, 1:, 0] = -np.where(slips & touch, c.friction * c.normal, 0.0)[:, None] * direction
    return ContactState(jump, shear, pressure), force, tangent


def dissipation(before: ContactState, after: ContactState, constants: ContactConstants, area: FloatArray) -> float:
    """Work lost by rubbing between two states [J]: the shear on the part of the slip that is not elastic."""
    slip = after.jump[:, 1:] - before.jump[:, 1:] - (after.shear - before.shear) / constants.tangential[:, None]
    return float((area[:, None] * after.shear * slip).sum())
