"""Every benchmark of section and cell, in the order of the theory: bars, cylinders, springs, strands, limits, cables."""

from __future__ import annotations

from homogenize.benchmark import Case
from homogenize.benchmark_cables import cable_cases
from homogenize.benchmark_cylinder import cylinder_cases
from homogenize.benchmark_layers import layer_cases
from homogenize.benchmark_limits import limit_cases
from homogenize.benchmark_prismatic import prismatic_cases
from homogenize.benchmark_rubber_ring import rubber_ring_cases
from homogenize.benchmark_slices import slice_cases
from homogenize.benchmark_spring import spring_cases
from homogenize.benchmark_strand import strand_cases
from homogenize.benchmark_strand_sweep import strand_sweep_cases


def section_cases() -> tuple[Case, ...]:
    """The cases; run them with :func:`homogenize.benchmark.run_cases`."""
    simple = (*prismatic_cases(), *cylinder_cases(), *slice_cases(), *spring_cases())
    strands = (*strand_cases(), *strand_sweep_cases())
    return (*simple, *strands, *limit_cases(), *layer_cases(), *cable_cases(), *rubber_ring_cases())
