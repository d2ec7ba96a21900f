"""Towing round a roller beside Exudyn's 2D ANCF cable: similar models, not the same ones.

Here the cable is 3D with shear and torsion, trough and deck have friction of the true normal force, and the start is an
equilibrium, whose search is counted. There the cable is plane, friction has a constant normal force, the deck holds the nodes
that begin on it, the roller is the peer's frictionless circle contact, and the start is the geometric shape.
"""

from __future__ import annotations

import time
from itertools import pairwise
from typing import Any

import numpy as np

from beam.benchmark_towing import LOWER, R, towing
from beam.generalized_alpha import Integrator, StepSettings
from beam.motion import SpeedRamp
from beam.shape import strands_and_arcs
from beam.statics import equilibrium
from benchmarks.rod_exudyn import AXIAL, BENDING, MU, STIFFNESS, WEIGHT, solve

LENGTH, EA, EI, MASS, ROLLER = 16.0, 4.712e5, 124.4, 10.0, 2.9e6
PULL, TROLLEY = SpeedRamp(0.3, 0.5, 1.5), SpeedRamp(0.3, 0.5, 1.5, ratio=0.49)
PASSES = 0.65
"""Cable that goes round the roller in the run [m]."""


def own_towing(elements: int, h: float, end: float = 5.0, adaptive: bool = True) -> tuple[float, float]:
    """CPU seconds, statics contained, and pull force [N]."""
    begin = time.process_time()
    model = towing(elements, 2e5)
    rest = equilibrium(model)
    rest.outcome.require_success()
    motion = Integrator(model, rest.q, anchors=rest.anchors, settings=StepSettings(h, adaptive=adaptive))
    if not motion.advance(round(end / h)):
        raise RuntimeError(str(motion.outcome))
    return time.process_time() - begin, float(motion.reaction[-1, 0])


def peer_cable(mbs: Any, s: np.ndarray) -> tuple[list[int], list[int]]:
    """The U of plane cable elements under its weight; nodes and elements."""
    import exudyn.itemInterface as items  # noqa: N813

    q = strands_and_arcs(s, [(LOWER, 0.0), (np.pi * R, -1 / R), (9.0, 0.0)], angle=np.pi)
    nodes = [mbs.AddNode(items.NodePoint2DSlope1(referenceCoordinates=[x[0], x[1], x[3], x[4]])) for x in q]
    cables = []
    for pair in pairwise(nodes):
        cable = items.ObjectANCFCable2D(
            nodeNumbers=list(pair), physicsLength=s[1] - s[0], physicsMassPerLength=MASS, physicsBendingStiffness=EI,
            physicsAxialStiffness=EA, physicsBendingDamping=BENDING * EI, physicsAxialDamping=AXIAL * EA,
        )  # fmt: skip
        cables.append(mbs.AddObject(cable))
        marker = mbs.AddMarker(items.MarkerBodyMass(bodyNumber=cables[-1]))
        mbs.AddLoad(items.LoadMassProportional(markerNumber=marker, loadVector=[0, -9.81, 0]))
    return nodes, cables


def moved(items: Any, markers: list[Any], ramp: SpeedRamp) -> Any:
    """Constraint that moves a coordinate along `ramp`."""
    return items.CoordinateConstraint(
        markerNumbers=markers,
        offsetUserFunction=lambda mbs, t, number, offset: float(ramp(t)[0][0]),
        offsetUserFunction_t=lambda mbs, t, number, offset: float(ramp(t)[1][0]),
    )


def peer_floor(mbs: Any, fixed: Any, nodes: list[int], s: np.ndarray) -> None:
    """Trough and deck as stops under the nodes, bristle friction of their weight."""
    import exudyn.itemInterface as items  # noqa: N813

    for node, at in zip(nodes, s, strict=True):
        k = (s[1] - s[0]) * STIFFNESS
        x, y = (mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=node, coordinate=i)) for i in range(2))
        if LOWER < at < LOWER + np.pi * R:
            continue
        data = mbs.AddNode(items.NodeGenericData(initialCoordinates=[1, 0, 0], numberOfDataCoordinates=3))
        mbs.AddObject(
            items.CoordinateSpringDamperExt(
                markerNumbers=[fixed, y], nodeNumber=data, useLimitStops=True, limitStopsLower=0.0, limitStopsUpper=1e3,
                limitStopsStiffness=k, limitStopsDamping=2e-3 * k,
            )
        )  # fmt: skip
        if LOWER - PASSES < at <= LOWER:
            continue
        data = mbs.AddNode(items.NodeGenericData(initialCoordinates=[1, 0, 0], numberOfDataCoordinates=3))
        mbs.AddObject(
            items.CoordinateSpringDamperExt(
                markerNumbers=[fixed, x], nodeNumber=data, fDynamicFriction=MU * (s[1] - s[0]) * WEIGHT,
                stickingStiffness=0.5 * k, stickingDamping=1e-2 * 0.5 * k, frictionProportionalZone=0,
            )
        )  # fmt: skip


def peer_roller(mbs: Any, fixed: Any, cables: list[int], s: np.ndarray) -> None:
    """A travelling circle, and three contact segments on every element that meets it."""
    import exudyn.itemInterface as items  # noqa: N813

    centre = mbs.AddNode(items.NodePoint2D(referenceCoordinates=[-LOWER, R]))
    mbs.AddObject(items.MassPoint2D(nodeNumber=centre, physicsMass=1.0))
    x, y = (mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=centre, coordinate=i)) for i in range(2))
    mbs.AddObject(moved(items, [fixed, x], TROLLEY))
    mbs.AddObject(items.CoordinateConstraint(markerNumbers=[fixed, y]))
    circle = mbs.AddMarker(items.MarkerNodePosition(nodeNumber=centre))
    for cable, at in zip(cables, s[:-1], strict=True):
        if LOWER - PASSES - 0.1 < at < LOWER + np.pi * R + 0.1:
            shape = mbs.AddMarker(items.MarkerBodyCable2DShape(bodyNumber=cable, numberOfSegments=3))
            data = mbs.AddNode(items.NodeGenericData(initialCoordinates=[0.1] * 3, numberOfDataCoordinates=3))
            mbs.AddObject(
                items.ObjectContactCircleCable2D(
                    markerNumbers=[circle, shape], nodeNumber=data, numberOfContactSegments=3, circleRadius=R,
                    contactStiffness=ROLLER * (s[1] - s[0]) / 3,
                )
            )  # fmt: skip


def peer_towing(elements: int, h: float, end: float = 5.0) -> tuple[float, float]:
    """The same of Exudyn's ObjectANCFCable2D."""
    import exudyn
    import exudyn.itemInterface as items  # noqa: N813

    system = exudyn.SystemContainer()
    mbs: Any = system.AddSystem()
    s = np.linspace(0.0, LENGTH, elements + 1)
    nodes, cables = peer_cable(mbs, s)
    ground: Any = mbs.AddNode(items.NodePointGround())
    fixed = mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=ground, coordinate=0))
    peer_floor(mbs, fixed, nodes, s)
    peer_roller(mbs, fixed, cables, s)
    for node, coordinates in ((nodes[0], (0, 1, 3)), (nodes[-1], (1, 3))):
        for i in coordinates:
            marker = mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=node, coordinate=i))
            mbs.AddObject(items.CoordinateConstraint(markerNumbers=[fixed, marker]))
    last = mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=nodes[-1], coordinate=0))
    travel = mbs.AddObject(moved(items, [fixed, last], PULL))
    seconds = solve(mbs, end, h)
    return seconds, abs(float(np.ravel(mbs.GetObjectOutput(travel, exudyn.OutputVariableType.Force))[0]))
