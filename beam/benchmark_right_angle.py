r"""Right-angle frame in space (D3): a cantilever with a corner, struck at the elbow, swings freely with large rotations.

Two legs of 10 m, EA = GA = 1 MN, EI = GJ = 1 kN m2, 1 kg/m, rotary inertia 20, 10, 10 kg m; the force at the elbow, across the plane,
rises to 50 N in 1 s and falls to zero in another. A rod is smooth, so that the corner is a bend of the length c with the curvature

.. math:: \kappa(s) = \frac{\pi}{2 c} \Big(1 - \cos\frac{2\pi s}{c}\Big),

which joins the straight legs without a jump of curvature. What this changes falls with c: 0.04 m at 4 s with c = 0.2 m,
half of it with 0.1 m.

Sources: J. C. Simo, L. Vu-Quoc, Comput. Methods Appl. Mech. Eng. 66 (1988) 125-161, doi 10.1016/0045-7825(88)90073-4; numbers of
Exudyn 1.13.6, geometrically exact beam, 32 elements a leg, h 12.5 ms (one code).
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from beam.benchmark_dynamics import advanced
from beam.generalized_alpha import Integrator, StepSettings
from beam.rod import Rod
from beam.rod_model import RodModel, Support
from homogenize.benchmark import Benchmark, Case
from homogenize.section_stiffness import SectionInertia, SectionStiffness

Array = NDArray[np.float64]

LEG, CORNER, ON_CORNER, STEP = 10.0, 0.05, 6, 0.0125
ELBOW = {
    1: 0.951, 2: 4.115, 4: 4.640, 6: 2.541, 8: 1.632, 10: -3.101, 15: 0.155, 20: -2.604, 25: 6.052, 30: -0.226,
}  # fmt: skip
TIP = {
    1: 0.054, 2: 0.069, 4: 3.508, 6: 6.911, 8: 7.959, 10: 4.463, 15: -9.209, 20: 0.522, 25: 6.642, 30: 0.155,
}  # fmt: skip
"""Time [s] and displacement across the plane [m]."""


def frame_shape(elements: int, corner: float = CORNER) -> tuple[Array, Array]:
    """Element lengths and nodal values of the unloaded frame, `elements` a leg; the legs' axes meet at (10, 0)."""
    fine = np.linspace(0.0, corner, 4001)
    turn = np.pi / (2 * corner) * (fine - corner / (2 * np.pi) * np.sin(2 * np.pi * fine / corner))
    along, across = (
        np.concatenate([[0.0], np.cumsum(0.5 * (f[1:] + f[:-1]))]) * fine[1] for f in (np.cos(turn), np.sin(turn))
    )
    leg, n = LEG - along[-1], elements
    lengths = np.concatenate([np.full(n, leg / n), np.full(ON_CORNER, corner / ON_CORNER), np.full(n, leg / n)])
    q = np.zeros((lengths.size + 1, 12))
    first, bend, last = slice(0, n + 1), slice(n, n + ON_CORNER + 1), slice(n + ON_CORNER, None)
    q[first, 0], q[first, 3] = np.linspace(0.0, leg, n + 1), 1.0
    s = np.linspace(0.0, corner, ON_CORNER + 1)
    q[bend, 0], q[bend, 1] = leg + np.interp(s, fine, along), np.interp(s, fine, across)
    q[bend, 8] = np.interp(s, fine, turn)
    q[bend, 3], q[bend, 4] = np.cos(q[bend, 8]), np.sin(q[bend, 8])
    q[bend, 11] = np.pi / (2 * corner) * (1 - np.cos(2 * np.pi * s / corner))
    q[last, 0], q[last, 1] = LEG, across[-1] + np.linspace(0.0, leg, n + 1)
    q[last, 3], q[last, 4], q[last, 8], q[last, 11] = 0.0, 1.0, np.pi / 2, 0.0
    return lengths, q


def swinging_frame(elements: int, corner: float, end: float) -> tuple[dict[float, Array], Integrator]:
    """Displacement across the plane of elbow and tip [m] at every whole second up to `end` [s]."""
    section = SectionStiffness.uncoupled(EA=1e6, GA_x=1e6, GA_y=1e6, EI_x=1e3, EI_y=1e3, GJ=1e3, area=1.0)
    lengths, q = frame_shape(elements, corner)
    rod = Rod.build(lengths, section, SectionInertia(1.0, 10.0, 10.0, 20.0), stress_free=q)
    model = RodModel(rod, q, [Support(0)], load=np.zeros((rod.nodes, 12)))
    settings = StepSettings(STEP, adaptive=False, spectral_radius=0.8, absolute=1e-4, relative=1e-8)
    motion = Integrator(model, q, settings=settings)
    elbow, out = elements + ON_CORNER // 2, {}
    for k in range(1, round(end / STEP) + 1):
        model.external[elbow, 2] = 50.0 * max(0.0, 1.0 - abs(k * STEP - 1.0))
        advanced(motion, 1)
        if k % round(1 / STEP) == 0:
            out[k * STEP] = motion.q[[elbow, rod.nodes - 1], 2]
    return out, motion


def right_angle_frame(end: float = 15.0) -> Iterable[Benchmark]:
    """Elbow and tip within 0.02 m to 15 s, within 0.1 m afterwards."""
    found, _ = swinging_frame(8, CORNER, end)
    for t, z in found.items():
        if t not in ELBOW:
            continue
        for what, value, reference in (("elbow", z[0], ELBOW[int(t)]), ("tip", z[1], TIP[int(t)])):
            error = 0.02 if t <= 15 else 0.1
            name, source = f"D3 right-angle frame, {t:g} s", "Simo, Vu-Quoc 1988; Exudyn 1.13.6"
            yield Benchmark(name, source, f"{what} across the plane [m]", reference, float(value), error, scale=1.0)


def right_angle_cases() -> tuple[Case, ...]:
    """Thirty seconds."""
    return (Case("D3 right-angle frame", "Simo, Vu-Quoc 1988; Exudyn 1.13.6", lambda: right_angle_frame(30.0)),)
