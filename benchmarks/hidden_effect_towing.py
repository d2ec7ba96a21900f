"""Make data/campaigns/towing-1, towing-2, towing-3 and face-1: synthetic towing runs in Exudyn, for `helicable explain`.

Six conditions each, done twice: four to calibrate, one to validate, one sealed. The runs come from
:mod:`benchmarks.blind_towing.exudyn_line`; noise is drawn with a fixed seed. In face-1 the towed end is drawn over
a bend, whose loss :mod:`benchmarks.layers_over_a_bend` adds. What is true stands in data/campaigns/truth.json and in
truth.md, beside the folders, not in them.

Run: python -m benchmarks.shipped_campaigns, which makes all shipped campaigns and the truth.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.blind.noise import Noise
from benchmarks.blind_towing.exudyn_line import Extra, tow_exudyn
from benchmarks.blind_towing.folder import write_folder
from benchmarks.blind_towing.generator import Condition
from benchmarks.blind_towing.motion import to_and_fro
from benchmarks.blind_towing.towed_line import Drive, Line, rest_tension
from benchmarks.layers_over_a_bend import Bend

Array = NDArray[np.float64]
DURATION, SAMPLES = 16.0, 201
LAB = "example-hidden-effect"
GAIN, OFFSET = 0.003, 0.004


@dataclass(frozen=True)
class Ripple:
    """Speed of the drive times 1 + sum of r_k cos(2 pi k x/pitch + phase_k): a chain that runs over a polygon."""

    pitch: float
    ratio: tuple[float, ...]
    phase: tuple[float, ...]

    def __call__(self, told: Drive) -> Drive:
        """The drive that really moves the end; its speed and acceleration by the chain rule."""

        def drive(t: Array) -> tuple[Array, Array, Array]:
            x, v, a = told(t)
            p, slope, bend = x.copy(), np.ones_like(x), np.zeros_like(x)
            for k, (r, f) in enumerate(zip(self.ratio, self.phase, strict=True), start=1):
                w = 2 * math.pi * k / self.pitch
                p += r / w * (np.sin(w * x + f) - math.sin(f))
                slope += r * np.cos(w * x + f)
                bend -= r * w * np.sin(w * x + f)
            return p, slope * v, slope * a + bend * v**2

        return drive


@dataclass(frozen=True)
class Site:
    """One shipped campaign: line, what is hidden, conditions (speed, inclination deg, tail tension, set), noise and seed."""

    name: str
    line: Line
    nominal_friction: float
    station: float
    extra: Extra
    ripple: Ripple | None
    plan: tuple[tuple[float, float, float, str], ...]
    noise: Noise
    seed: int
    effects: tuple[str, ...]
    words: str
    bend: Bend | None = None

    def conditions(self) -> list[Condition]:
        """As the writer and the line ask for them."""
        return [Condition(to_and_fro(v, DURATION), math.radians(i), N, v, purpose) for v, i, N, purpose in self.plan]

    def clean(self, condition: Condition, t: Array) -> Array:
        """Tensions (2, samples) [N] of one condition without noise."""
        drive = self.ripple(condition.motion) if self.ripple else condition.motion
        found = tow_exudyn(self.line, drive, condition.slope, condition.tail, self.extra, t, (self.station,))
        if self.bend:
            found[0] += self.bend.tension(t, drive(t)[0], found[0])
        return found

    def truth(self) -> dict[str, Any]:
        """For the score: names, and the numbers they were made with."""
        e, r = self.extra, self.ripple
        numbers: dict[str, Any] = {"friction_coefficient": self.line.friction}
        if e.fall:
            numbers |= {"fall": e.fall, "fall_speed": e.fall_speed}
        if e.load or e.drag:
            numbers |= {"load": e.load, "drag": e.drag, "stretch": list(e.stretch)}
        if r:
            numbers |= {"pitch": r.pitch, "ratio": list(r.ratio), "phase": list(r.phase)}
        truth = {"effects": list(self.effects), "kind": "towing", "numbers": numbers}
        if self.bend:
            truth["carried"] = {"from": LAB, "effect": "interlayer-friction", "bend_radius": self.bend.radius}
        return truth


def _plan(tail: float, steep: float) -> tuple[tuple[float, float, float, str], ...]:
    return (
        (0.08, 0.0, tail, "calibrate"), (0.25, steep, tail, "calibrate"), (0.50, 0.0, 1.5 * tail, "calibrate"),
        (0.12, steep, 1.5 * tail, "calibrate"), (0.40, steep / 2, tail, "validate"), (0.65, 1.5 * steep, tail, "sealed"),
    )  # fmt: skip


SITES = (
    Site(
        "towing-1", Line(40.0, 4.27e5, 4.83, 0.312, 0.1, 2.6e-4), 0.36, 17.0, Extra(fall=0.055, fall_speed=0.13), None,
        _plan(950.0, 8.0), Noise("ar", 0.01, GAIN, OFFSET), 20230301, ("trough-friction-stribeck",),
        "the friction coefficient falls with the sliding speed v: 0.312 + 0.055 / (1 + (v / 0.13 m/s)^2)",
    ),
    Site(
        "towing-2", Line(32.0, 3.6e5, 4.2, 0.338, 0.1, 3e-4), 0.30, 12.0, Extra(),
        Ripple(0.148, (0.055, 0.018), (0.7, -1.1)), _plan(800.0, 10.0), Noise("heavy-tail", 0.01, GAIN, OFFSET), 20230302,
        ("polygon-effect",),
        "the speed of the drive ripples with its travel x: 1 + 0.055 cos(2 pi x / 0.148 m + 0.7) + 0.018 cos(4 pi x / 0.148 m - 1.1)",
    ),
    Site(
        "towing-3", Line(36.0, 4.0e5, 5.1, 0.375, 0.1, 2.4e-4), 0.34, 20.0, Extra(), None,
        _plan(1100.0, 9.0), Noise("ar", 0.012, GAIN, OFFSET), 20230303, (), "nothing is missing",
    ),
    Site(
        "face-1", Line(16.0, 1.6e5, 4.05, 0.09, 0.1, 3e-4), 0.12, 7.0, Extra(fall=0.013, fall_speed=0.15), None,
        (
            (0.08, 0.0, 900.0, "calibrate"), (0.25, 6.0, 2000.0, "calibrate"), (0.50, 0.0, 2000.0, "calibrate"),
            (0.12, 6.0, 900.0, "calibrate"), (0.40, 3.0, 1400.0, "validate"), (0.60, 8.0, 1400.0, "sealed"),
        ),
        Noise("ar", 0.01, GAIN, OFFSET), 20230304, ("trough-friction-stribeck",),
        "the friction coefficient falls with the sliding speed v: 0.09 + 0.013 / (1 + (v / 0.15 m/s)^2)",
        Bend(0.25),
    ),
)  # fmt: skip

README = """# Towing runs, site {number}

**Synthetic.** A cable is towed to and fro along a trough; the tension is read at the towed end and {station:g} m from it. Six conditions,
each done twice: four to calibrate, one to validate, one sealed (faster and steeper than the others).

Whether an effect beyond an elastic cable with Coulomb friction is hidden here stands in
[../truth.md](../truth.md), outside this folder. Made in Exudyn by `python -m benchmarks.shipped_campaigns`,
with no code of the model that explains.
"""


BEND_README = """# Towing runs at the face, over a bend

**Synthetic.** The cable of [{lab}](../{lab}/README.md) (4.05 kg/m; it lies in waves, so that it stretches far more easily than a
straight one) is towed to and fro along a trough. Its towed end is drawn over a bend of radius **{radius:g} m**, half a turn; the
tension is read behind the bend, and in the trough {station:g} m from its begin. Six conditions at three tail tensions, each done
twice: four to calibrate, one to validate, one sealed (faster and steeper than the others).

Whether an effect beyond an elastic cable with Coulomb friction is hidden in the trough stands in
[../truth.md](../truth.md), outside this folder. The line is made in Exudyn and the bend of layers that slip point by point, by
`python -m benchmarks.shipped_campaigns {name}`, with no code of the model that explains.

```sh
helicable explain data/campaigns/{lab} --json found.json
helicable explain data/campaigns/{name} --carry found.json --bend-radius "{radius:g} m"
```
"""


def noise_words(noise: Noise) -> str:
    """For truth.md."""
    kind = {"ar": "autoregressive (0.7)", "heavy-tail": "heavy-tailed (Student t with 3 degrees)"}[noise.kind]
    return (
        f"Noise: {kind}, {100 * noise.size:g} % of the rms of the tension that motion makes; per record a gain of "
        f"{100 * noise.gain:g} % and an offset of {100 * noise.offset:g} % (standard deviations)."
    )


def clean_runs(site: Site) -> tuple[Array, Sequence[Condition], Array]:
    """Clock, conditions and tensions (conditions, 2, samples) without noise."""
    t = np.linspace(0.0, DURATION, SAMPLES)
    conditions = site.conditions()
    return t, conditions, np.array([site.clean(c, t) for c in conditions])


def with_noise(site: Site, conditions: Sequence[Condition], clean: Array) -> list[tuple[Condition, Array]]:
    """Every condition twice; the noise is relative to the rms of the tension that motion makes on the open runs."""
    rng = np.random.default_rng(site.seed)
    at = np.array([0.0, site.station])
    rest = np.array([rest_tension(site.line, 0.0, c.slope, c.tail, at) for c in conditions])[:, :, None]
    open_rows = [c.purpose != "sealed" for c in conditions]
    unit = np.sqrt(np.mean((clean - rest)[open_rows] ** 2, axis=(0, 2)))
    records = []
    for condition, y, r in zip(conditions, clean, rest, strict=True):
        for _ in range(2):
            noisy = [
                one + site.noise.draw(rng, one - at_rest, float(s)) for one, at_rest, s in zip(y, r, unit, strict=True)
            ]
            records.append((condition, np.array(noisy)))
    return records


def make_site(site: Site, parent: Path) -> None:
    """Write one campaign folder and its README."""
    t, conditions, clean = clean_runs(site)
    folder = parent / site.name
    title = "at the face, over a bend" if site.bend else f"site {site.name[-1]}"
    write_folder(folder, site.line, site.nominal_friction, t, (site.station,), with_noise(site, conditions, clean),
                 title=f"Cable towed to and fro in a trough, {title} (synthetic)")  # fmt: skip
    text = README.format(number=site.name[-1], station=site.station)
    if site.bend:
        text = BEND_README.format(name=site.name, lab=LAB, radius=site.bend.radius, station=site.station)
    (folder / "README.md").write_text(text, encoding="utf-8")


def truth_section(site: Site) -> str:
    """Section of truth.md."""
    what = ", ".join(f"**{name}**" for name in site.effects)
    head = f"Missing in the base model: {what}, and nothing else: {site.words}." if what else "Nothing is missing."
    if site.bend:
        head = (
            f"Missing in the base model: what the layers of [{LAB}]({LAB}/README.md) lose at a bend of radius "
            f"{site.bend.radius:g} m, which is carried from there and is no effect of towing; beside it {what}, "
            f"and nothing else: {site.words}."
        )
    friction = f"True friction coefficient {site.line.friction:g}, nominal {site.nominal_friction:g}."
    return f"## {site.name}\n\n{head}\n{friction} {noise_words(site.noise)}\n"
