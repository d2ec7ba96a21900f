r"""Spin-up of a flexible beam about a hub (D2): stiffening by the centrifugal force, many full turns in the plane.

L 10 m, EA 28 MN, GA 10 MN, EI 14 kN m2, 1.2 kg/m, rotary inertia 0.6 g m. The hub turns by

.. math:: \theta = \frac{\omega}{T} \Big[ \frac{t^2}{2} + \Big(\frac{T}{2\pi}\Big)^2 \Big(\cos\frac{2\pi t}{T} - 1\Big)\Big],
          \qquad \omega = 6\ \mathrm{rad/s}, \quad T = 15\ \mathrm{s},

and then by omega t less 45 rad. The tip lags behind, swings back and comes to rest in the turning frame, stretched by
rho A omega^2 L^3 / (3 EA). The rotation vectors pass full turns seven times (:mod:`beam.rotation_vector`).

Sources: J. C. Simo, L. Vu-Quoc, J. Appl. Mech. 53 (1986) 855-863, doi 10.1115/1.3171871; numbers of Exudyn 1.13.6, geometrically
exact beam, n 32, h 2.5 ms (one code).
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from beam.benchmark_dynamics import advanced
from beam.generalized_alpha import Integrator, StepSettings
from beam.motion import Turn
from beam.rod import Rod
from beam.rod_model import RodModel, Support
from beam.shape import straight
from homogenize.benchmark import Benchmark, Case
from homogenize.section_stiffness import SectionInertia, SectionStiffness

LENGTH, EA, LINE_MASS = 10.0, 2.8e7, 1.2
SPEED, RAMP = 6.0, 15.0
SOURCE = "Simo, Vu-Quoc 1986; Exudyn 1.13.6"
TIPS = {
    2.5: (-1.325e-3, -0.15141),
    5.0: (-1.2658e-2, -0.46855),
    7.5: (-1.7741e-2, -0.55907),
    10.0: (-7.069e-3, -0.36272),
    12.5: (-2.21e-4, -0.11263),
    15.0: (5.140e-4, 1.29e-3),
}
"""Time [s] and displacement [m] of the tip along and across the turning beam."""
LARGEST_LAG = -0.57380


def hub(t: float) -> tuple[float, float, float]:
    """Angle [rad], angular velocity and acceleration of the hub.

    Examples
    --------
    >>> [round(x, 9) for x in hub(15.0)]
    [45.0, 6.0, 0.0]
    """
    if t >= RAMP:
        return SPEED * t - SPEED * RAMP / 2, SPEED, 0.0
    w, a = 2 * np.pi / RAMP, SPEED / RAMP
    return a * (t**2 / 2 + (np.cos(w * t) - 1) / w**2), a * (t - np.sin(w * t) / w), a * (1 - np.cos(w * t))


def turning_beam(elements: int) -> RodModel:
    """The beam at rest along x, its first section turning with the hub."""
    GA, EI, J = 1e7, 1.4e4, 6e-4
    section = SectionStiffness.uncoupled(EA=EA, GA_x=GA, GA_y=GA, EI_x=EI, EI_y=EI, GJ=EI, area=1.0)
    rod = Rod.straight(LENGTH, elements, section, SectionInertia(LINE_MASS, J, J, 2 * J))
    return RodModel(rod, straight(rod.s), [Support(0, turn=Turn(hub))])


def tip_in_turning_frame(elements: int, h: float, end: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Times (m,) [s] of all steps and displacements (m, 2) [m] of the tip along and across the turning beam."""
    model = turning_beam(elements)
    settings = StepSettings(h, spectral_radius=0.8, adaptive=False)
    motion = Integrator(model, model.q0, settings=settings)
    times, tips = [], []
    for _ in range(round(end / h)):
        advanced(motion, 1)
        angle, (x, y) = hub(motion.t)[0], motion.q[-1, :2]
        c, s = np.cos(angle), np.sin(angle)
        times.append(motion.t)
        tips.append((c * x + s * y - LENGTH, c * y - s * x))
    return np.array(times), np.array(tips)


def spin_up() -> Iterable[Benchmark]:
    """Tip within 1 % of its largest displacement while the hub gains speed; the stretch at full speed."""
    times, tips = tip_in_turning_frame(8, 1e-2, 18.0)
    name = "D2 spin-up"
    for k, direction in enumerate(("along", "across")):
        largest = max(abs(tip[k]) for tip in TIPS.values())
        for time, tip in TIPS.items():
            found = float(tips[np.argmin(np.abs(times - time)), k])
            yield Benchmark(name, SOURCE, f"tip {direction}, {time:g} s [m]", tip[k], found, 0.01, scale=largest)
    yield Benchmark(name, SOURCE, "largest lag [m]", LARGEST_LAG, float(tips[:, 1].min()), 0.01)
    stretch = LINE_MASS * SPEED**2 * LENGTH**3 / (3 * EA)
    steady = float(tips[times > RAMP, 0].mean())
    yield Benchmark(name, "rho A w^2 L^3 / (3 EA)", "stretch at full speed [m]", stretch, steady, 0.01)


def spin_up_cases() -> tuple[Case, ...]:
    """D2."""
    return (Case("D2 spin-up", SOURCE, spin_up),)
