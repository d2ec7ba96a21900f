"""Make data/campaigns/example-tension: a synthetic bench campaign with a disclosed truth, to show the format and `helicable compare`.

A cable of axial stiffness EA is stretched to and fro at blocked rotation, F = EA eps. Each record has its own gain (1 %, another
mounting) and first-order autoregressive noise. Nothing is hidden: the right finding is "noise only".

Run: python -m benchmarks.example_campaign
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

FOLDER = Path(__file__).resolve().parents[1] / "data" / "campaigns" / "example-tension"
EA = 4.6e6
LENGTH = 2.0
NOISE = 35.0
CONDITIONS = (
    ("t1", 1.0, 20, "calibrate"),
    ("t2", 2.0, 20, "calibrate"),
    ("t3", 1.5, 40, "calibrate"),
    ("t4", 2.5, 5, "calibrate"),
    ("t5", 2.0, 40, "validate"),
)

CAMPAIGN = """title = "Example: tension of a 2 m specimen, rotation blocked (synthetic)"

[section]                 # nominal: the long-cable section of mcpt-1.9-3.3-3x35, all parts bonded
EA = "5.2 MN"
GA = "358 kN"
EI = "70.4 N m^2"
GJ = "98.7 N m^2"
mass_per_length = "4.05 kg/m"

[sensors]
force = "35 N"
"""

PROVENANCE = f"""kind = "synthetic"
made_by = "benchmarks/example_campaign.py, seed 2026"
truth = "EA = {EA:.4g} N; no missing effect; gain of each record 1 % (standard deviation), autoregressive noise 0.5"
purpose = "shows the campaign format; every number may be disclosed"
"""


def noise(rng: np.random.Generator, count: int, size: float, phi: float = 0.5) -> NDArray[np.float64]:
    """First-order autoregressive noise of standard deviation `size`."""
    white = rng.standard_normal(count) * size * np.sqrt(1 - phi**2)
    out = np.empty(count)
    out[0] = size * rng.standard_normal()
    for i in range(1, count):
        out[i] = phi * out[i - 1] + white[i]
    return out


def record(rng: np.random.Generator, amplitude: float) -> str:
    """One table: extension up to `amplitude` [mm], there and back twice."""
    time = np.linspace(0, 80, 161)
    extension = amplitude * 0.5 * (1 - np.cos(2 * np.pi * time / 40))
    strain = 1e-3 * extension / LENGTH
    gain = 1 + 0.01 * rng.standard_normal()
    force = gain * EA * strain + noise(rng, len(time), NOISE)
    rows = [f"{t:.2f},{u:.6f},{f:.3f}" for t, u, f in zip(time, extension, force)]
    return "\n".join(["time [s],extension [mm],force [N]", *rows]) + "\n"


def main() -> None:
    """Write the campaign."""
    rng = np.random.default_rng(2026)
    FOLDER.mkdir(parents=True, exist_ok=True)
    (FOLDER / "campaign.toml").write_text(CAMPAIGN, encoding="utf-8")
    (FOLDER / "provenance.toml").write_text(PROVENANCE, encoding="utf-8")
    rows = ["id,kind,file,specimen,repeat_of,set,temperature [degC],specimen length [m]"]
    for name, amplitude, temperature, purpose in CONDITIONS:
        for repeat in ("a", "b"):
            of = "" if repeat == "a" else f"{name}a"
            rows.append(
                f"{name}{repeat},tension,{name}{repeat}.csv,{repeat.upper()},{of},{purpose},{temperature},{LENGTH:g}"
            )
            (FOLDER / f"{name}{repeat}.csv").write_text(record(rng, amplitude), encoding="utf-8")
    (FOLDER / "experiments.csv").write_text("\n".join(rows) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
