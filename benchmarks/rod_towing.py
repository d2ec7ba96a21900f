"""Time and memory of the towing run over the number of elements, and what a step costs.

Two tables, read as ratios within one run, because seconds depend on the machine and its load:

1. cost of one evaluation at 400 elements, relative to the factorisation of the block-tridiagonal matrix;
2. the built-in towing run with 100 to 800 elements: growth with n, error of the pull force against the finest mesh.

Run: python -m benchmarks.rod_towing (about a minute). The last results are in benchmarks/rod_towing.md.
"""

from __future__ import annotations

import copy
import multiprocessing
import resource
import sys
import time
from collections.abc import Callable

import numpy as np

from beam import read_scenario, tow
from beam.generalized_alpha import Integrator, StepSettings
from beam.linear_solve import Factor
from beam.rod_model import Blocks, RodModel
from beam.scenario import published_section
from beam.statics import equilibrium
from beam.towing import towing_model

SCENARIO = "intelligent-horizontal"
ELEMENTS = (100, 200, 400, 800)
DURATION = "4 s"


def smallest_time(work: Callable[[], object], calls: int) -> float:
    """Smallest mean time of one call [s] in five batches of `calls`."""
    work()
    times = []
    for _ in range(5):
        start = time.perf_counter()
        for _ in range(calls):
            work()
        times.append((time.perf_counter() - start) / calls)
    return min(times)


def step_costs() -> None:
    """Table 1."""
    scenario = read_scenario(SCENARIO)
    model = towing_model(scenario, published_section(scenario), scenario.cable_inertia)
    rest = equilibrium(model)
    motion = Integrator(model, rest.q, anchors=rest.anchors, settings=StepSettings(5e-3))
    motion.advance(300)
    q, v, anchors = motion.q, motion.v, motion.anchors
    bare = RodModel(model.rod, model.q0, model.supports, model.gravity)
    blocks = Blocks.zeros(model.rod.nodes)
    model.forces(motion.t, q, v, anchors, blocks=blocks, factor=400.0)
    model.add_mass(1e5, blocks)
    model.fix(blocks)
    copied = smallest_time(lambda: copy.deepcopy(blocks), 20)
    factored = Factor(copy.deepcopy(blocks))
    scratch = Blocks.zeros(model.rod.nodes)
    costs = {
        "factor": smallest_time(lambda: Factor(copy.deepcopy(blocks)), 20) - copied,
        "solve": smallest_time(lambda: factored.solve(q), 50),
        "force of the rod": smallest_time(lambda: bare.forces(motion.t, q, v, []), 50),
        "force with contact": smallest_time(lambda: model.forces(motion.t, q, v, anchors), 50),
        "force and tangent": smallest_time(
            lambda: model.forces(motion.t, q, v, anchors, blocks=scratch, factor=400.0), 10
        ),
    }
    print(f"\nCost of one evaluation, {scenario.elements} elements, {model.rod.nodes * 12} unknowns\n")
    print(f"| {'evaluation':<20} | {'ms':>7} | {'of a factorisation':>18} |\n|{'-' * 22}|{'-' * 9}|{'-' * 20}|")
    for name, cost in costs.items():
        print(f"| {name:<20} | {cost * 1e3:7.3f} | {cost / costs['factor']:18.2f} |")


def towing_case(elements: int) -> dict[str, float]:
    """One run in a process of its own, so that its peak memory is its own."""
    scenario = read_scenario(SCENARIO).changed(cable__elements=elements, time__duration="0.05 s")
    tow(scenario)
    start = time.process_time()
    run = tow(scenario.changed(time__duration=DURATION))
    run.outcome.require_success()
    seconds = time.process_time() - start
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * (1 if sys.platform == "darwin" else 1024)
    force = run.dataset["pull_force"].values[-20:, 0]
    return {
        "seconds": seconds,
        "iterations": run.counters.iterations,
        "factorisations": run.counters.factorisations,
        "force": float(np.mean(force)),
        "balance": abs(run.balance_error),
        "memory": peak / 1e6,
    }


def towing_runs() -> None:
    """Table 2."""
    context = multiprocessing.get_context("spawn")
    results = {}
    for n in ELEMENTS:
        with context.Pool(1) as pool:
            results[n] = pool.apply(towing_case, (n,))
    finest = results[ELEMENTS[-1]]["force"]
    print(f"\nTowing run {SCENARIO}, {DURATION} simulated, steps up to 5 ms, one core (CPU seconds)\n")
    head = ("n", "s", "s / s(n/2)", "iterations", "factored", "us/(it n)", "pull N", "off n 800", "balance", "MB")
    print("| " + " | ".join(f"{name:>10}" for name in head) + " |\n|" + ("-" * 12 + "|") * len(head))
    previous = None
    for n, r in results.items():
        growth = f"{r['seconds'] / previous:.2f}" if previous else "-"
        previous = r["seconds"]
        cost = r["seconds"] / (r["iterations"] * n) * 1e6
        cells = (
            str(n), f"{r['seconds']:.2f}", growth, f"{r['iterations']:.0f}", f"{r['factorisations']:.0f}", f"{cost:.2f}",
            f"{r['force']:.2f}", f"{r['force'] / finest - 1:+.2%}", f"{r['balance']:.0e}", f"{r['memory']:.0f}",
        )  # fmt: skip
        print("| " + " | ".join(f"{cell:>10}" for cell in cells) + " |")


def main() -> None:
    """Print both tables."""
    step_costs()
    towing_runs()


if __name__ == "__main__":
    main()
