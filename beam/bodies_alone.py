"""A model of bodies, bushings and joints without a cable: the rod is one element that is held, and weighs on nothing."""

from __future__ import annotations

from collections.abc import Sequence

from numpy.typing import ArrayLike

from beam.bushing import Bushing
from beam.joint import Joint
from beam.rigid_body import RigidBody
from beam.rod import Rod
from beam.rod_model import RodModel
from beam.shape import straight
from beam.support import Support
from beam.surface import Surface
from homogenize.section_stiffness import SectionInertia, SectionStiffness


def bodies_alone(
    bodies: Sequence[RigidBody],
    bushings: Sequence[Bushing] = (),
    joints: Sequence[Joint] = (),
    supports: Sequence[Support] = (),
    gravity: ArrayLike = (0.0, 0.0, 0.0),
    surfaces: Sequence[Surface] = (),
) -> RodModel:
    """Model of the bodies; parameters as of :class:`beam.rod_model.RodModel`, `surfaces` are those that bodies touch.

    Examples
    --------
    >>> model = bodies_alone([RigidBody("stone", 2.0, (1.0, 1.0, 1.0), (0.0, 0.0, 0.0))], gravity=(0.0, -9.81, 0.0))
    >>> model.row("stone")
    2
    """
    section = SectionStiffness.uncoupled(EA=1.0, GA_x=1.0, GA_y=1.0, EI_x=1.0, EI_y=1.0, GJ=1.0, area=1.0)
    rod = Rod.straight(1.0, 1, section, SectionInertia(1e-9, 1e-9, 1e-9, 2e-9))
    held = [Support(node, ("r", "r'", "theta", "theta'")) for node in (0, 1)]
    return RodModel(
        rod, straight(rod.s), [*held, *supports], gravity, bodies=bodies, bushings=bushings, joints=joints,
        body_surfaces=surfaces,
    )  # fmt: skip
