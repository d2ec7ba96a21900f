"""What the drives do to the pull force: teeth of the travelling wheel, pockets of the trolley's chain, error of its ratio, tensioner.

`python -m benchmarks.towing_drives` draws the picture of docs/towing-drives.md and prints its table.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

from beam import read_scenario, tow

TEETH: dict[str, object] = {"drive__tooth_error": "0.5 mm", "drive__tooth_pitch": "125 mm"}
CHAIN: dict[str, object] = {"drive__chain_pockets": 5, "drive__chain_radius": "80 mm"}
CASES: dict[str, dict[str, object]] = {
    "ramp only": {},
    "teeth 0.5 mm, pitch 125 mm": TEETH,
    "chain wheel, 5 pockets, 80 mm": CHAIN,
    "trolley 2 % too fast": {"drive__trolley_error": 0.02},
    "trolley 0.5 % too slow": {"drive__trolley_error": -0.005},
    "tensioner 300 N at the supply": {"drive__tensioner_force": "300 N", "drive__tensioner_damping": "5 kN*s/m"},
}
"""Changes of the scenario by name."""


def main(out: Path = Path("docs/pictures/towing-drives.png")) -> None:
    """Run every case with 100 elements and clamps as mass, draw speeds and pull forces, say means and ripples."""
    import matplotlib.pyplot as plt

    plain = read_scenario("intelligent-horizontal").changed(chain="smeared", cable__elements=100)
    figure, (speed, pull) = plt.subplots(2, 1, figsize=(9, 6.6), sharex=True, layout="constrained")
    colours = ("black", "#0072B2", "#D55E00", "#009E73", "#E69F00", "#8856A7")
    for colour, (name, change) in zip(colours, CASES.items(), strict=True):
        scenario = plain.changed(**change)
        run = tow(scenario)
        time, force = run.dataset["time"].values, run.dataset["pull_force"].values[:, 0]
        late = force[time >= 6.0]
        sys.stdout.write(f"| {name} | {force[0]:.0f} | {late.mean():.0f} | {np.ptp(late):.0f} | {run.status} |\n")
        pull.plot(time, force, color=colour, linewidth=1.5, label=name)
        if "tooth" in str(change) or "pockets" in str(change) or not change:
            fine = np.linspace(0, time[-1], 1500)
            of = scenario.trolley if "pockets" in str(change) else scenario.pull
            label = ("trolley, " if "pockets" in str(change) else "shearer, ") + name
            speed.plot(fine, [of(float(t))[1][0] for t in fine], color=colour, linewidth=1.3, label=label)
    speed.set(ylabel="speed [m/s]", title="Drives")
    pull.set(xlabel="time [s]", ylabel="force [N]", title="Pull force of the shearer")
    for ax in (speed, pull):
        ax.legend(fontsize=8, loc="lower right" if ax is speed else (0.12, 0.02))
        ax.grid(True, color="#e5e5e5", linewidth=0.6)
        for side in ("top", "right"):
            ax.spines[side].set_visible(False)
    figure.savefig(out, dpi=100)


if __name__ == "__main__":
    main()
