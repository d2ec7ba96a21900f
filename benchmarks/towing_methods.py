"""The same large bend and the same short towing run with three methods: rod, rigid links with bushings, modal bodies with bushings.

`python -m benchmarks.towing_methods` writes the table and the picture of docs/towing-methods.md.
"""

from __future__ import annotations

import json
import time
from dataclasses import asdict, dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from beam import read_scenario, tow
from beam.generalized_alpha import Integrator, StepSettings
from beam.modal_body_chain import ModalChain, ModalMotion, modal_equilibrium
from beam.modal_towing import PlaneTrough, modal_towing
from beam.rigid_link_chain import cantilever_of_links, pin_forces, towing_of_links
from beam.scenario import Scenario, published_section
from beam.statics import equilibrium
from homogenize.section_stiffness import SectionInertia, SectionStiffness

Array = NDArray[np.float64]

FRAME = 0.1
"""s between recorded instants."""


@dataclass
class Run:
    """Of one method: pull force over time [N], along the cable at the end tension [N] and moment [N m], seconds of computing."""

    method: str
    pieces: int
    unknowns: int
    seconds: float
    rest: float
    steady: float
    moment: float
    time: list[float]
    pull: list[float]
    s: list[float]
    tension: list[float]
    bending: list[float]


def towing_scenario(length: float = 5.0, duration: float = 3.0) -> Scenario:
    """A short cable round the roller, clamps as mass on it, published constants; the shearer is at full speed after 1.5 s."""
    return read_scenario("intelligent-horizontal").changed(
        chain="smeared", cable__length=f"{length} m", cable__elements=round(length / 0.025), layout__upper_strand="2 m",
        drive__ramp_end="1.5 s", time__duration=f"{duration} s", time__frame=f"{FRAME} s",
    )  # fmt: skip


def rod_run(scenario: Scenario, elements: int) -> Run:
    """The rod of this project."""
    begin = time.process_time()
    run = tow(scenario.changed(cable__elements=elements))
    seconds = time.process_time() - begin
    data, instants = run.dataset, run.dataset["time"].values
    pull = data["pull_force"].values[:, 0]
    tension, bending = data["force_local"].values[-1, :, 0], data["moment_local"].values[-1, :, 2]
    return _run(
        "rod",
        elements,
        12 * (elements + 1),
        seconds,
        instants,
        pull,
        data["s"].values,
        tension,
        bending,
    )


def link_run(scenario: Scenario, links: int) -> Run:
    """Rigid links with bushings."""
    begin = time.process_time()
    section = published_section(scenario)
    model = towing_of_links(scenario, links, section, scenario.cable_inertia)
    start = equilibrium(model)
    start.outcome.require_success()
    motion = Integrator(model, start.q, anchors=start.anchors, settings=StepSettings(5e-3))
    instants, pull = [0.0], [float(motion.reaction[model.row(f"link {links - 1}"), 0])]
    for _ in range(round(scenario.time.duration.value / FRAME)):
        if not motion.advance(round(FRAME / 5e-3)):
            motion.outcome.require_success()
        instants.append(motion.t)
        pull.append(float(motion.reaction[model.row(f"link {links - 1}"), 0]))
    seconds = time.process_time() - begin
    tension, moment = pin_forces(model, motion.t, motion.q, motion.v)
    s = np.arange(1.0, links) * (scenario.cable.length.value / links)
    return _run("rigid links", links, 6 * links, seconds, np.array(instants), np.array(pull), s, tension, moment)


def modal_run(scenario: Scenario, bodies: int, modes: int = 3) -> Run:
    """Small-deflection modal bodies with bushings."""
    begin = time.process_time()
    section = published_section(scenario)
    chain, X = modal_towing(scenario, bodies, section, scenario.cable_inertia, modes)
    smooth = replace(chain, touch=PlaneTrough(scenario, friction=False))
    motion = ModalMotion(chain, modal_equilibrium(smooth, X, 1e-2).X, np.zeros_like(X))
    instants, pull = [0.0], [float(chain.bushing_forces(0.0, motion.X, motion.V)[0][-1])]
    for _ in range(round(scenario.time.duration.value / FRAME)):
        motion.advance(FRAME, 5e-3, 1e-2)
        instants.append(motion.t)
        pull.append(float(chain.bushing_forces(motion.t, motion.X, motion.V)[0][-1]))
    seconds = time.process_time() - begin
    tension, moment = chain.bushing_forces(motion.t, motion.X, motion.V)
    s = np.arange(bodies + 1.0) * chain.length
    unknowns = bodies * chain.size
    return _run("modal bodies", bodies, unknowns, seconds, np.array(instants), np.array(pull), s, tension, moment)


def _run(
    method: str,
    pieces: int,
    unknowns: int,
    seconds: float,
    instants: Array,
    pull: Array,
    s: Array,
    tension: Array,
    bending: Array,
) -> Run:
    late = instants > 0.75 * instants[-1]
    moment = float(np.abs(bending).max())
    lists = [np.round(x, 5).tolist() for x in (instants, pull, s, tension, np.abs(bending))]
    return Run(method, pieces, unknowns, seconds, float(pull[0]), float(pull[late].mean()), moment, *lists)


def half_circle(pieces: int, modes: int = 3) -> dict[str, float]:
    """A cantilever whose end moment bends it to a half circle: relative error of the turn of its end and of the bend's diameter."""
    EI, L = 50.0, 2.0
    section = SectionStiffness.uncoupled(EA=3e5, GA_x=1e5, GA_y=1e5, EI_x=EI, EI_y=EI, GJ=30.0, area=2e-3)
    l, M = L / pieces, np.pi * EI / L
    model = cantilever_of_links(L, pieces, section, SectionInertia.solid_circle(10.0, 0.05), M)
    q = equilibrium(model).q
    last = q[model.row(f"link {pieces - 1}")]
    turn = last[8] + 0.5 * M * l / EI  # the second half of the last link
    tip = last[:2] + 0.5 * l * np.array([np.cos(last[8]), np.sin(last[8])])
    chain = ModalChain(pieces, l, EI, 10.0, (3e5 / l, 1e5 / l, 1e4 * EI / l), modes, end_moment=M)
    X = np.zeros((pieces, chain.size))
    X[:, 0] = l * np.arange(pieces)
    X = modal_equilibrium(chain, X, 1e-5).X
    end = chain.points(X, np.array([l]), chain.tip[:, None])[-1, 0]
    exact = 2 * L / np.pi
    return {
        "pieces": pieces,
        "links: turn": turn / np.pi - 1,
        "links: diameter": float(np.hypot(*tip)) / exact - 1,
        "modal: turn": float(X[-1, 2] + X[-1, 3:] @ chain.tip_slope) / np.pi - 1,
        "modal: diameter": float(np.hypot(*end)) / exact - 1,
    }


def main(out: Path = Path("docs/pictures/towing-methods.png")) -> None:
    """Compute everything once, write the numbers beside this file and draw the picture."""
    scenario = towing_scenario()
    rod_run(scenario.changed(time__duration="0.2 s", time__frame="0.1 s"), 200)  # compile
    runs = [rod_run(scenario, 200)]
    for links in (20, 40, 80):
        runs.append(link_run(scenario, links))
    for bodies in (20, 40):
        runs.append(modal_run(scenario, bodies))
    record = {"half circle": [half_circle(n) for n in (4, 8, 16)], "towing": [asdict(run) for run in runs]}
    Path(__file__).with_suffix(".json").write_text(json.dumps(record), encoding="utf-8")
    draw(record, out)


def draw(record: dict, out: Path) -> None:
    """Pull force over time, tension and moment along the cable at the end."""
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(1, 3, figsize=(13, 4.2), layout="constrained")
    looks = {"rod": ("black", 2.2), "rigid links": ("#0072B2", 1.2), "modal bodies": ("#D55E00", 1.2)}
    styles = {20: ":", 40: "--", 80: "-", 200: "-"}
    for run in record["towing"]:
        colour, width = looks[run["method"]]
        style = {
            "color": colour,
            "linewidth": width,
            "linestyle": styles[run["pieces"]],
            "label": f"{run['method']}, {run['pieces']}",
        }
        axes[0].plot(run["time"], run["pull"], **style)
        axes[1].plot(run["s"], run["tension"], **style)
        axes[2].plot(run["s"], run["bending"], **style)
    axes[0].set(xlabel="time [s]", ylabel="pull force [N]", title="Pull force of the shearer")
    axes[1].set(xlabel="arc length from the supply [m]", ylabel="tension [N]", title="Tension at 3 s")
    axes[2].set(
        xlabel="arc length from the supply [m]", ylabel="bending moment [N m]", title="Bending moment (size) at 3 s"
    )
    axes[0].legend(fontsize=8, loc="upper right", bbox_to_anchor=(1.0, 0.87))  # between the curves
    for ax in axes:
        ax.grid(True, color="#e5e5e5", linewidth=0.6)
        for side in ("top", "right"):
            ax.spines[side].set_visible(False)
    figure.savefig(out, dpi=100)


if __name__ == "__main__":
    main()
