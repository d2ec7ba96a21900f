"""The 1 + 6 strand: strand models to their printed digits, and the 2D cell in the band between them (cases T5, T6)."""

import numpy as np
import pytest

from homogenize.benchmark_sections import strand_section
from homogenize.benchmark_strand import seven_wire, strand_cases
from homogenize.benchmark_strand_sweep import strand_sweep_cases
from homogenize.strand_theory import bending_slip, bending_stick, costello, energy_consistent, free_twist


@pytest.mark.parametrize("case", strand_cases(), ids=str)
def test_strand(case):
    """Printed digits of the models; the cell between energy and rigid model; Costello's EI when the wires slide."""
    assert not [b.sentence() for b in case.benchmarks() if not b.passed]


@pytest.mark.parametrize("case", strand_sweep_cases(), ids=str)
def test_models_have_the_printed_digits_everywhere(case):
    """Sweep of the lay angle to five decimals (T6); other lay angles, other strands, the example of Costello's book (T5)."""
    assert not [b.sentence() for b in case.benchmarks() if not b.passed]


def test_models_are_ordered():
    """Rigid sections are stiffest; Costello's coupling is not symmetric, the energy's is; free rotation is softer."""
    strand = seven_wire(17.0)
    energy, rigid, book = energy_consistent(strand), energy_consistent(strand, contraction=False), costello(strand)
    assert energy[0, 0] < book[0, 0] < rigid[0, 0]
    assert 0.05 < book[0, 1] / book[1, 0] - 1 < 0.07
    assert energy[0, 1] == energy[1, 0]
    assert free_twist(energy) < 0.6 * energy[0, 0]
    assert bending_slip(strand) < bending_stick(strand) / 7


def test_section_has_the_area_of_its_wires():
    """Pappus: pi R1^2 + 6 pi R2^2 / cos(beta); the wires touch the core and nothing else."""
    strand = seven_wire(17.0)
    apart, joined = strand_section(strand, joined=False), strand_section(strand)
    assert len(apart.points) - len(joined.points) == 6
    x, y = apart.points[apart.cells].transpose(2, 0, 1)[:, :, [0, 3, 1, 4, 2, 5]]
    polygons = 0.5 * (x * np.roll(y, -1, axis=1) - y * np.roll(x, -1, axis=1)).sum(axis=1)
    exact = np.pi * (strand.core**2 + 6 * strand.wire**2 / np.cos(strand.beta))
    assert polygons.sum() == pytest.approx(exact, rel=5e-3)  # straight sides of the polygon
