"""Every benchmark of the rod: at rest, in motion, with friction, towed; and of the ANCF cable."""

from __future__ import annotations

from beam.benchmark_ancf_cable import ancf_cable_cases
from beam.benchmark_closed_forms import closed_form_cases
from beam.benchmark_dynamics import dynamic_cases
from beam.benchmark_friction import friction_cases
from beam.benchmark_right_angle import right_angle_cases
from beam.benchmark_roller import roller_cases
from beam.benchmark_spin_up import spin_up_cases
from beam.benchmark_statics import static_cases
from beam.benchmark_towing import towing_cases
from homogenize.benchmark import Case


def rod_cases() -> tuple[Case, ...]:
    """The cases; run them with :func:`homogenize.benchmark.run_cases`."""
    still = (*static_cases(), *closed_form_cases())
    moving = (
        *dynamic_cases(),
        *spin_up_cases(),
        *right_angle_cases(),
        *friction_cases(),
        *roller_cases(),
        *towing_cases(),
    )
    return (*still, *moving, *ancf_cable_cases())
