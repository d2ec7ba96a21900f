"""Compile the kernels of rods, cables, bodies and their contacts once, before processes that run at the same time need them.

Processes that start together with an empty cache would each compile the same kernels, which takes half a minute of CPU.
Run: python -m beam.precompile. Where the compiled code cannot be kept on disk, nothing is gained and nothing breaks.
"""

from __future__ import annotations

import logging
from collections.abc import Callable

from beam.ancf_cable import AncfCable
from beam.benchmark_friction import FLOOR_SECTION, cable_on_floor
from beam.bushing import Bushing
from beam.generalized_alpha import Integrator, StepSettings
from beam.joint import Joint
from beam.rigid_body import RigidBody
from beam.rod import Rod
from beam.rod_model import RodModel, Support
from beam.section_law import DampingTimes
from beam.shape import straight
from beam.statics import equilibrium
from beam.surface import ContactLaw, Plane
from homogenize.section_stiffness import SectionInertia

logger = logging.getLogger(__name__)


def run(model: RodModel) -> None:
    """Statics and one step, with what a run reports."""
    start = equilibrium(model)
    motion = Integrator(model, start.q, anchors=start.anchors, settings=StepSettings(1e-4))
    motion.advance(1)
    _ = motion.forces, motion.contacts


def rod() -> None:
    """A rod on a floor with friction."""
    run(cable_on_floor(2, [Support(0), Support(-1)], length=0.1))


def cable() -> None:
    """The same of the ANCF cable."""
    run(cable_on_floor(2, [Support(0), Support(-1, ("r",))], length=0.1, kind=AncfCable))


def bodies() -> None:
    """A rod with two bodies, a bushing and a joint, one of them on a floor."""
    line = Rod.straight(0.2, 2, FLOOR_SECTION, SectionInertia(10.0, 0.0026, 0.0026, 0.0052), DampingTimes(5e-3, 2e-2))
    q = straight(line.s)
    stones = [
        RigidBody(
            name, 1.0, (1e-3, 1e-3, 1e-3), tuple(q[i, 0:3]), points=((0.0, -0.02, 0.0),), contact_length=0.1
        )
        for name, i in (("first", 1), ("second", 2))
    ]  # fmt: skip
    run(
        RodModel(
            line, q, [Support(0)], (0.0, -9.81, 0.0), bodies=stones, bushings=[Bushing("first", 1, 1e4, 10.0)],
            joints=[Joint("pinned", "second", 2)],
            body_surfaces=[Plane("floor", ContactLaw(friction=0.3), offset=-0.0199)],
        )
    )  # fmt: skip


CASES: tuple[Callable[[], None], ...] = (rod, cable, bodies)


def main() -> None:
    """Compile everything; what cannot be compiled is left to those that need it."""
    for case in CASES:
        try:
            case()
        except Exception as error:  # a cache that cannot be written must not stop the tests
            logger.warning("kernels of %s were not compiled ahead: %s", case.__name__, error)


if __name__ == "__main__":
    main()
