r"""The cable as a chain of rigid links and bushings: the plainest baseline, as multibody programs model chains and ropes.

Links of the length l carry the mass; the bushing between two of them has the stiffness of the cable between their middles,

.. math:: K = \frac1l (EA,\; GA,\; GA,\; GJ,\; EI,\; EI), \qquad C = \eta K .

Angles are exact at any size, so that a chain bends as far as one likes, but it is a polygon: under an end moment M it turns by
theta = M l / EI from link to link and its pins lie on a circle of the radius

.. math:: R_p = \frac{l}{2\sin(\theta/2)} = \frac{EI}{M} \Bigl(1 + \frac{\theta^2}{24} + \dots\Bigr).

Between its pins there is no moment, no curvature, and no contact except at the points of the links.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from beam.bodies_alone import bodies_alone
from beam.body_record import bushing_states
from beam.bushing import Bushing
from beam.incline_formula import STANDARD_GRAVITY
from beam.rigid_body import RigidBody
from beam.rod_model import RodModel
from beam.scenario import Scenario
from beam.section_law import DampingTimes
from beam.support import Support
from beam.towing_model import mass_per_length, towing_surfaces
from beam.towing_path import chain_pins
from homogenize.section_stiffness import SectionInertia, SectionStiffness

Array = NDArray[np.float64]

NO_DAMPING = DampingTimes(0.0, 0.0)
TOUCH = 0.5 / np.sqrt(3.0)
"""Place of a link's two contact points, from its middle, over its length: the Gauss points, which ride on the cable's radius."""


@dataclass(frozen=True)
class LinkLaw:
    """One link: `length` [m], section, inertia, and damping of the bushings."""

    length: float
    section: SectionStiffness
    inertia: SectionInertia
    damping: DampingTimes = NO_DAMPING

    def bushing(self, first: str, second: str, number: int) -> Bushing:
        """The bushing between two neighbouring links, half a link from the middle of either."""
        C = np.asarray(self.section.C, dtype=float).diagonal()  # gamma_x, gamma_y, epsilon, kappa_x, kappa_y, tau
        K = np.array([C[2], C[0], C[1], C[5], C[3], C[4]]) / self.length
        eta = np.array([*[self.damping.axial] * 3, *[self.damping.bending] * 3])
        half = 0.5 * self.length
        return Bushing(
            first, second, K, damping=eta * K, first_point=(half, 0.0, 0.0), second_point=(-half, 0.0, 0.0),
            name=f"pin {number}",
        )  # fmt: skip

    def body(self, name: str, position: Array, turn: float) -> RigidBody:
        """The link with its middle at `position`, turned by `turn` [rad] about z."""
        mass = self.inertia.mass_per_length * self.length
        along = mass * self.length**2 / 12
        inertia = self.inertia
        J = (self.length * inertia.J_z, self.length * inertia.J_x + along, self.length * inertia.J_y + along)
        touch = TOUCH * self.length
        points = ((-touch, 0.0, 0.0), (touch, 0.0, 0.0))
        return RigidBody(name, mass, J, tuple(position), (0.0, 0.0, turn), points=points, contact_length=self.length)


def chain_of_links(pins: Array, turns: Array, law: LinkLaw) -> tuple[list[RigidBody], list[Bushing]]:
    """Links "link 0" ... between the `pins` (n + 1, 3) [m], turned by `turns` (n,) [rad] about z, and their bushings."""
    middles = 0.5 * (pins[:-1] + pins[1:])
    bodies = [
        law.body(f"link {k}", middle, float(turn)) for k, (middle, turn) in enumerate(zip(middles, turns, strict=True))
    ]
    bushings = [law.bushing(f"link {k}", f"link {k + 1}", k + 1) for k in range(len(bodies) - 1)]
    return bodies, bushings


def cantilever_of_links(
    length: float, links: int, section: SectionStiffness, inertia: SectionInertia, moment: float
) -> RodModel:
    """A straight cantilever of `links` links along x under the end moment `moment` [N m] about z.

    The first bushing stands half a link off the wall, with twice the stiffness: the cable between wall and first middle.
    """
    law = LinkLaw(length / links, section, inertia)
    pins = np.zeros((links + 1, 3))
    pins[:, 0] = np.linspace(0.0, length, links + 1)
    bodies, bushings = chain_of_links(pins, np.zeros(links), law)
    inner = law.bushing("link 0", "link 1", 0)
    wall = Bushing(
        "ground", "link 0", 2 * np.asarray(inner.stiffness), first_point=(0.0, 0.0, 0.0), second_point=(-0.5 * law.length, 0.0, 0.0),
        name="wall",
    )  # fmt: skip
    load = Bushing("ground", f"link {links - 1}", 0.0, preload=(0, 0, 0, 0, 0, moment), name="end moment")
    return bodies_alone(bodies, [wall, *bushings, load])


def towing_of_links(scenario: Scenario, links: int, section: SectionStiffness, inertia: SectionInertia) -> RodModel:
    """The towing scenario with a chain of `links` links for the cable; the clamps are mass on it.

    The first link is held at the supply, the last one by the shearer.
    """
    length = scenario.cable.length.value
    pins, directions = chain_pins(scenario.pieces, np.linspace(0.0, length, links + 1), length / links)
    chord = np.diff(pins, axis=0)
    turns = np.arctan2(chord[:, 1], chord[:, 0])
    turns += 2 * np.pi * np.round((0.5 * (directions[:-1] + directions[1:]) - turns) / (2 * np.pi))
    cable = scenario.cable
    heavy = SectionInertia(mass_per_length(scenario, inertia), inertia.J_x, inertia.J_y, inertia.J_z)
    damping = DampingTimes(cable.damping_time_axial.value, cable.damping_time_bending.value)
    bodies, bushings = chain_of_links(pins, turns, LinkLaw(length / links, section, heavy, damping))
    slope = scenario.layout.inclination.value
    gravity = (-STANDARD_GRAVITY * np.sin(slope), -STANDARD_GRAVITY * np.cos(slope), 0.0)
    supports = [Support("link 0"), Support(f"link {links - 1}", travel=scenario.pull)]
    return bodies_alone(bodies, bushings, (), supports, gravity, towing_surfaces(scenario))


def pin_forces(model: RodModel, t: float, q: Array, v: Array) -> tuple[Array, Array]:
    """Tension [N] and bending moment about z [N m] of every pin, (links - 1,), positive as in the cable."""
    states = bushing_states(model, t, q, v)
    pins = [k for k, bushing in enumerate(model.bushings) if bushing.name.startswith("pin")]
    return -states.force[pins, 0], -states.force[pins, 5]
