"""Make data/campaigns/example-hidden-effect: synthetic bending tests of a cable whose layers slip, for `helicable explain`.

The moment is that of two layers which slip round the section wire by wire after Papailiou, 12 + 10 stick-slip elements, with a
grip that rises with a power of the axial tension and a part that the sheath makes. That is more than any form of the library
has; law and noise are those of :mod:`benchmarks.blind`, which never imports `effects`. What is true stands in
data/campaigns/truth.md, beside the folder, not in it.

Run: python -m benchmarks.shipped_campaigns example-hidden-effect
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from benchmarks.blind.bench import Array, Bench
from benchmarks.blind.noise import Noise
from benchmarks.blind.strength import base_signal, channel_rms
from benchmarks.blind.truth import respond
from benchmarks.blind.truths_hysteresis import InterlayerFriction

FOLDER = Path(__file__).resolve().parents[1] / "data" / "campaigns" / "example-hidden-effect"
SEED = 20230218
SAMPLES = 141
TENSION = 3000.0
BASE, POWER = 0.3, 0.85
NOISE = Noise("ar", 0.05, gain=0.012, offset=0.01)
EI = 4.2


@dataclass(frozen=True)
class Layer:
    """Stick stiffness [N m^2], first and last slip curvature at the typical tension [1/m], elements round the section."""

    name: str
    stick: float
    first: float
    last: float
    elements: int

    def sliders(self) -> tuple[Array, Array]:
        """Stiffness (elements,) and slip curvature (elements,), from the neutral axis to the outermost wire."""
        theta = (np.arange(self.elements) + 0.5) * np.pi / 2 / self.elements
        weight = np.sin(theta) ** 2
        rise = np.geomspace(self.first, self.last, self.elements)
        return self.stick * weight / weight.sum(), rise


LAYERS = (Layer("strands", 9.0, 0.025, 0.05, 12), Layer("cores", 8.5, 0.13, 0.24, 10))

CONDITIONS = (
    # name, largest curvature 1/m, tension N, frequency Hz, path, set
    ("b01", 0.15, 1000, 0.05, "sine", "calibrate"),
    ("b02", 0.30, 6000, 0.02, "triangle", "calibrate"),
    ("b03", 0.60, 3000, 0.05, "growing", "calibrate"),
    ("b04", 0.60, 1000, 0.01, "sine", "calibrate"),
    ("b05", 0.30, 3000, 0.10, "sine", "calibrate"),
    ("b06", 0.50, 6000, 0.05, "growing", "calibrate"),
    ("b07", 0.45, 3000, 0.02, "sine", "validate"),
    ("b08", 0.60, 6000, 0.10, "triangle", "validate"),
    ("b09", 0.85, 3000, 0.05, "sine", "sealed"),
    ("b10", 0.60, 9000, 0.02, "growing", "sealed"),
)
"""The sealed ones go beyond the others in curvature and in tension."""

CAMPAIGN = """title = "Example: bending of a cable under axial tension (synthetic)"

[section]                 # nominal: the long-cable section of that cable, all parts bonded
EA = "5.2 MN"
GA = "358 kN"
EI = "70.4 N m^2"
GJ = "98.7 N m^2"
mass_per_length = "4.05 kg/m"
"""

README = """# Example: something is missing here

**Synthetic.** Bending tests of a cable under axial tension, ten conditions, each done twice on newly mounted specimens:
six to calibrate, two to validate, two sealed (one with a larger curvature, one with a higher tension than all the others).
Nominal stiffness: the cell of `mcpt-1.9-3.3-3x35` with everything bonded.

The law behind the moments is richer than the forms in the library of effects. It stands in [../truth.md](../truth.md), outside this folder:
`helicable explain` reads this folder only, and of the sealed tables it takes the SHA-256 until it is told to open them.

Made by `python -m benchmarks.shipped_campaigns`.
"""


def truth_text() -> str:
    """What is true of the campaign, from the very numbers that made it."""
    rows = "\n".join(
        f"| {one.name} | {one.stick:g} | {one.first:g} to {one.last:g} | {one.elements} |" for one in LAYERS
    )
    return f"""# Truth of the synthetic campaigns

Nothing in helicable reads this page, nor [truth.json](truth.json), from which only the score
is taken. Made by `python -m benchmarks.shipped_campaigns`.

## example-hidden-effect

Missing in the linear model: **interlayer friction**, and nothing else. M = EI kappa + sum of stick-slip elements, EI = {EI:g} N m^2.

| layer | stick stiffness N m^2 | slip curvature 1/m at {TENSION:g} N | elements round the section |
|---|---|---|---|
{rows}

The slip curvature grows with the axial tension N as {BASE:g} + {1 - BASE:g} (N / {TENSION:g} N)^{POWER:g}: a part is the grip
of the sheath. Noise: autoregressive (0.7), {100 * NOISE.size:g} % of the rms of EI kappa; per record a gain of
{100 * NOISE.gain:g} % and an offset of {100 * NOISE.offset:g} % (standard deviations).

No effect of rate, temperature, rig or sensor.

## example-tension

Nothing is missing; see its [provenance.toml](example-tension/provenance.toml).
"""


def path(kind: str, amplitude: float, frequency: float) -> tuple[Array, Array]:
    """Instants [s] and curvature [1/m] of two cycles, or of three growing ones."""
    cycles = 3 if kind == "growing" else 2
    phase = np.linspace(0, cycles, SAMPLES)
    shape = np.sin(2 * np.pi * phase)
    if kind == "triangle":
        shape = 2 / np.pi * np.arcsin(shape)
    if kind == "growing":
        shape = shape * np.minimum(np.floor(phase) + 1, cycles) / cycles
    return phase / frequency, amplitude * shape


def make_bench() -> Bench:
    """All conditions."""
    made = [path(shape, amplitude, frequency) for _, amplitude, _, frequency, shape, _ in CONDITIONS]
    full = np.ones(len(CONDITIONS))
    return Bench(
        kind="bending",
        strain=np.array([kappa for _, kappa in made]),
        time=np.array([t for t, _ in made]),
        count=np.full(len(CONDITIONS), SAMPLES),
        length=full,
        tension=np.array([float(c[2]) for c in CONDITIONS]),
        temperature=20 * full,
        frequency=np.array([c[3] for c in CONDITIONS]),
        stiffness=EI,
        set_names=tuple(c[5] for c in CONDITIONS),
        typical_tension=TENSION,
    )


def hidden_truth() -> InterlayerFriction:
    """The slip of both layers."""
    weight, limit = (np.concatenate(parts) for parts in zip(*(one.sliders() for one in LAYERS), strict=True))
    numbers = {"law": "power", "power": POWER, "base": BASE, "weight": weight / weight.sum(), "limit": limit}
    return InterlayerFriction("two-layer", float(weight.sum() / EI), numbers)


def main() -> None:
    """Write the campaign; the truth beside it is written by :mod:`benchmarks.shipped_campaigns`."""
    rng, bench = np.random.default_rng(SEED), make_bench()
    moment = respond(bench, [hidden_truth()])["main"]
    rms = channel_rms(bench, base_signal(bench))
    FOLDER.mkdir(parents=True, exist_ok=True)
    rows = ["id,kind,file,specimen,repeat_of,set,axial tension [N],frequency [Hz],temperature [degC]"]
    for c, (name, _, tension, frequency, _, purpose) in enumerate(CONDITIONS):
        for repeat in ("a", "b"):
            of = "" if repeat == "a" else f"{name}a"
            file = f"{name}{repeat}.csv"
            rows.append(f"{name}{repeat},bending,{file},{repeat.upper()},{of},{purpose},{tension},{frequency:g},20")
            noisy = moment[c] + NOISE.draw(rng, moment[c], rms)
            table = zip(bench.time[c], bench.strain[c], noisy, strict=True)
            lines = ["time [s],curvature [1/m],moment [N m]", *(f"{t:.3f},{k:.6f},{m:.5f}" for t, k, m in table)]
            (FOLDER / file).write_text("\n".join(lines) + "\n", encoding="utf-8")
    (FOLDER / "experiments.csv").write_text("\n".join(rows) + "\n", encoding="utf-8")
    (FOLDER / "campaign.toml").write_text(CAMPAIGN, encoding="utf-8")
    (FOLDER / "README.md").write_text(README, encoding="utf-8")


if __name__ == "__main__":
    main()
