"""The rod beside Exudyn (an optional peer, `pip install exudyn`): CPU time as ratios within one run, and the same answers.

Cases whose models are the same on both sides:

1. straight cable of 16 m on a floor, pulled with 1 ms steps: 3D ANCF cable, 3D geometrically exact beam (its first 0.1 s,
   because it takes long);
2. stick-slip (F1): the same cable pulled slowly by 5 mm, whose force is known exactly;
3. flexible pendulum (D1): tip position;

and one whose models are similar, see :mod:`benchmarks.rod_exudyn_towing`: towing round a roller for 5 s.

Exudyn has the floor as nodal springs with bristle friction of a constant normal force, here it lies at Gauss points with the
true one. Both solve the equations of each step to 1e-6 of the first residual. Medians of CPU seconds, the cases in turn.

Run: python -m benchmarks.rod_exudyn [repetitions]. It writes benchmarks/rod_exudyn.md.
"""

from __future__ import annotations

import importlib.util
import os
import sys
import time
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from beam.benchmark_dynamics import pendulum, swing
from beam.benchmark_friction import EA, LENGTH, MU, WEIGHT, cable_on_floor
from beam.generalized_alpha import Integrator, StepSettings
from beam.motion import SpeedRamp
from beam.rod_model import Support

MISSING = "Exudyn is not installed, so that there is nothing to compare with: pip install exudyn."
AXIAL, BENDING, STIFFNESS = 5e-3, 2e-2, 1.25e6
Result = tuple[float, float]


def installed() -> bool:
    """True if the peer can be imported."""
    return importlib.util.find_spec("exudyn") is not None


def own_pull(elements: int, ramp: SpeedRamp, end: float, h: float) -> Result:
    """CPU seconds and pull force [N] of the cable on the floor."""
    model = cable_on_floor(elements, [Support(-1, ("x", "theta"), ramp)], bristle_ratio=0.5)
    settings = StepSettings(h, adaptive=False)
    begin = time.process_time()
    motion = Integrator(model, model.q0, settings=settings)
    if not motion.advance(round(end / h)):
        raise RuntimeError(str(motion.outcome))
    return time.process_time() - begin, float(motion.reaction[-1, 0])


def peer_beam(kind: str, mbs: Any, elements: int) -> list[int]:
    """Straight cable along x in Exudyn; its node numbers."""
    import exudyn
    import exudyn.itemInterface as items  # noqa: N813
    from exudyn.beams import GenerateStraightLineANCFCable

    if kind == "cable":
        template = items.Cable(
            physicsMassPerLength=10.0, physicsBendingStiffness=124.4, physicsAxialStiffness=EA,
            physicsBendingDamping=BENDING * 124.4, physicsAxialDamping=AXIAL * EA,
        )  # fmt: skip
        return GenerateStraightLineANCFCable(mbs, [0, 0, 0], [LENGTH, 0, 0], elements, template)[0]
    section = exudyn.BeamSection()
    stiffness = np.diag([EA, 2e5, 2e5, 86.0, 124.4, 124.4])
    section.stiffnessMatrix = stiffness
    section.dampingMatrix = stiffness * np.repeat([AXIAL, BENDING], 3)
    section.inertia = np.diag([0.0052, 0.0026, 0.0026])
    section.massPerLength = 10.0
    step = LENGTH / elements
    nodes = [
        mbs.AddNode(items.NodeRigidBodyEP(referenceCoordinates=[i * step, 0, 0, 1, 0, 0, 0]))
        for i in range(elements + 1)
    ]
    for pair in pairwise(nodes):
        mbs.AddObject(items.ObjectBeamGeometricallyExact(nodeNumbers=list(pair), length=step, sectionData=section))
    return nodes


def floor(mbs: Any, nodes: list[int], ramp: SpeedRamp) -> Any:
    """Springs and bristle friction under every node, no motion across, the pulled end; returns the constraint that pulls."""
    import exudyn.itemInterface as items  # noqa: N813

    ground = mbs.AddNode(items.NodePointGround())
    fixed = mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=ground, coordinate=0))
    step = LENGTH / (len(nodes) - 1)
    for i, node in enumerate(nodes):
        share = step * (0.5 if i in (0, len(nodes) - 1) else 1.0)
        x, y, z = (mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=node, coordinate=k)) for k in range(3))
        k = share * STIFFNESS
        mbs.AddObject(items.CoordinateSpringDamper(markerNumbers=[fixed, y], stiffness=k, damping=2e-3 * k))
        mbs.AddObject(items.CoordinateConstraint(markerNumbers=[fixed, z]))
        data = mbs.AddNode(items.NodeGenericData(initialCoordinates=[1, 0, 0], numberOfDataCoordinates=3))
        mbs.AddObject(
            items.CoordinateSpringDamperExt(
                markerNumbers=[fixed, x], nodeNumber=data, fDynamicFriction=MU * share * WEIGHT,
                stickingStiffness=0.5 * k, stickingDamping=1e-2 * 0.5 * k, frictionProportionalZone=0,
            )
        )  # fmt: skip
    last = mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=nodes[-1], coordinate=0))
    travel = items.CoordinateConstraint(
        markerNumbers=[fixed, last],
        offsetUserFunction=lambda mbs, t, number, offset: float(ramp(t)[0][0]),
        offsetUserFunction_t=lambda mbs, t, number, offset: float(ramp(t)[1][0]),
    )
    return mbs.AddObject(travel)


def solve(mbs: Any, end: float, h: float) -> float:
    """CPU seconds of Exudyn's generalised-alpha with modified Newton iteration and its sparse solver."""
    import exudyn

    mbs.Assemble()
    settings = exudyn.SimulationSettings()
    times, rule = settings.timeIntegration, settings.timeIntegration.newton
    times.numberOfSteps, times.endTime = round(end / h), end
    times.generalizedAlpha.spectralRadius = 0.7
    times.verboseMode = 0
    rule.useModifiedNewton = True
    rule.relativeTolerance, rule.absoluteTolerance = 1e-6, 1e-6
    settings.solutionSettings.writeSolutionToFile = False
    settings.linearSolverType = exudyn.LinearSolverType.EigenSparse
    settings.displayStatistics = False
    begin = time.process_time()
    mbs.SolveDynamic(settings, showHints=False)
    return time.process_time() - begin


def peer_pull(kind: str, elements: int, ramp: SpeedRamp, end: float, h: float) -> Result:
    """As :func:`own_pull`, of Exudyn's element `kind` ("cable" or "beam")."""
    import exudyn

    system = exudyn.SystemContainer()
    mbs = system.AddSystem()
    nodes = peer_beam(kind, mbs, elements)
    travel = floor(mbs, nodes, ramp)
    seconds = solve(mbs, end, h)
    return seconds, abs(float(np.ravel(mbs.GetObjectOutput(travel, exudyn.OutputVariableType.Force))[0]))


def own_pendulum(h: float) -> tuple[float, Any]:
    """CPU seconds and tip after 0.6 s."""
    model = pendulum(64)
    begin = time.process_time()
    tip = swing(model, h, 0.6).q[-1, :2]
    return time.process_time() - begin, tip


def peer_pendulum(h: float) -> tuple[float, Any]:
    """The same of Exudyn's 3D ANCF cable."""
    import exudyn
    import exudyn.itemInterface as items  # noqa: N813
    from exudyn.beams import GenerateStraightLineANCFCable

    system = exudyn.SystemContainer()
    mbs = system.AddSystem()
    m = 5540.0 * 0.0018
    template = items.Cable(
        physicsMassPerLength=m, physicsBendingStiffness=7e6 * 1.215e-8, physicsAxialStiffness=7e6 * 0.0018
    )
    nodes = GenerateStraightLineANCFCable(
        mbs, [0, 0, 0], [1.2, 0, 0], 64, template, massProportionalLoad=[0, -9.81, 0],
        fixedConstraintsNode0=[1, 1, 1, 0, 0, 0],
    )[0]  # fmt: skip
    seconds = solve(mbs, 0.6, h)
    return seconds, np.array(mbs.GetNodeOutput(nodes[-1], exudyn.OutputVariableType.Position))[:2]


def medians(cases: dict[str, Callable[[], tuple[float, Any]]], repetitions: int) -> dict[str, tuple[float, Any]]:
    """Median CPU time of every case, run in turn so that the machine's load meets all alike; the last answer."""
    times: dict[str, list[float]] = {name: [] for name in cases}
    answers: dict[str, Any] = {}
    for _ in range(repetitions):
        for name, case in cases.items():
            seconds, answers[name] = case()
            times[name].append(seconds)
    return {name: (float(np.median(times[name])), answers[name]) for name in cases}


def table(title: str, results: dict[str, tuple[float, Any]]) -> str:
    """One case; the first row is this rod, whose time the others are divided by."""
    rows = [title, "", "| element | CPU s | ratio | answer |", "|---|---|---|---|"]
    first = next(iter(results.values()))[0]
    for name, (seconds, answer) in results.items():
        shown = ", ".join(f"{x:.5g}" for x in np.atleast_1d(answer))
        rows.append(f"| {name} | {seconds:.2f} | {seconds / first:.2f} | {shown} |")
    return "\n".join(rows)


def all_cases() -> dict[str, dict[str, Callable[[], tuple[float, Any]]]]:
    """Runs by title and element; the first of every title is this rod."""
    from benchmarks.rod_exudyn_towing import own_towing, peer_towing

    pull, slow, h = SpeedRamp(0.3, 0.0, 0.5), SpeedRamp(2e-3, 0.0, 3.0), 1e-3
    exact = float(np.sqrt(2 * EA * MU * WEIGHT * 5e-3))
    rod = "this rod (3D, shear, torsion)"
    return {
        "Pulled along the floor, 400 elements, 0.5 s, steps of 1 ms; pull N": {
            rod: lambda: own_pull(400, pull, 0.5, h),
            "Exudyn ANCFCable 3D": lambda: peer_pull("cable", 400, pull, 0.5, h),
        },
        "The same, its first 0.1 s; pull N": {
            rod: lambda: own_pull(400, pull, 0.1, h),
            "Exudyn geometrically exact beam 3D": lambda: peer_pull("beam", 400, pull, 0.1, h),
        },
        "Towing round a roller, 400 elements, 5 s, steps of 5 ms, similar models; pull N": {
            rod: lambda: own_towing(400, 5e-3),
            "Exudyn ANCFCable2D, constant normal force": lambda: peer_towing(400, 5e-3),
        },
        f"Stick-slip, 100 elements, 4 s, steps of 5 ms; pull N, exact {exact:.2f}": {
            rod: lambda: own_pull(100, slow, 4.0, 5e-3),
            "Exudyn ANCFCable 3D": lambda: peer_pull("cable", 100, slow, 4.0, 5e-3),
        },
        "Flexible pendulum, 64 elements, 0.6 s, steps of 1 ms; tip m": {
            rod: lambda: own_pendulum(h),
            "Exudyn ANCFCable 3D": lambda: peer_pendulum(h),
        },
    }


def main(repetitions: int = 3) -> None:
    """Print the tables and write them down, or say why not."""
    if not installed():
        print(MISSING)
        return
    from importlib.metadata import version

    own_pull(8, SpeedRamp(0.3, 0.0, 0.5), 0.01, 1e-3)
    load = ", ".join(f"{x:.1f}" for x in os.getloadavg())
    parts = [
        "# The rod beside Exudyn",
        f"Written by `python -m benchmarks.rod_exudyn {repetitions}`: medians of {repetitions} runs in turn, Exudyn "
        f"{version('exudyn')}, numba {version('numba')}, {os.cpu_count()} cores with a load of {load} at the start. CPU seconds "
        "swing with the load, ratios less.",
    ]
    for title, cases in all_cases().items():
        parts.append(table(title, medians(cases, repetitions)))
        print(parts[-1], end="\n\n", flush=True)
        (Path(__file__).parent / "rod_exudyn.md").write_text("\n\n".join(parts) + "\n")


if __name__ == "__main__":
    main(*(int(x) for x in sys.argv[1:]))
