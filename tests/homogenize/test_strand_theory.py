"""The 1 + 6 strand: strand models to their printed digits, and the 2D cell in the band between them (cases T5, T6)."""

import numpy as np
import pytest

from homogenize.benchmark_sections import strand_section
from homogenize.benchmark_strand import seven_wire, strand_cases
from homogenize.strand_theory import Strand16, bending_slip, bending_stick, costello, energy_consistent, free_twist

SWEEP = {  # lay angle: kee/EA, ket/(EA R), ktt/(EA R^2) of the energy model, then of the rigid one
    2.5: (0.99661, 0.02475, 0.02189, 0.99758, 0.02477, 0.02189),
    5.0: (0.98652, 0.04901, 0.02421, 0.99035, 0.04919, 0.02422),
    7.5: (0.96994, 0.07233, 0.02801, 0.97842, 0.07291, 0.02805),
    10.0: (0.94721, 0.09425, 0.03318, 0.96195, 0.09561, 0.03329),
    12.5: (0.91881, 0.11439, 0.03958, 0.94117, 0.11698, 0.03984),
    15.0: (0.88530, 0.13239, 0.04703, 0.91638, 0.13673, 0.04754),
    17.5: (0.84734, 0.14796, 0.05533, 0.88792, 0.15460, 0.05625),
    20.0: (0.80566, 0.16087, 0.06426, 0.85616, 0.17038, 0.06577),
    25.0: (0.71424, 0.17815, 0.08310, 0.78452, 0.19498, 0.08641),
    30.0: (0.61733, 0.18377, 0.10165, 0.70515, 0.20959, 0.10773),
}


@pytest.mark.parametrize("case", strand_cases(), ids=str)
def test_strand(case):
    """Printed digits of the models; the cell between energy and rigid model; Costello's EI when the wires slide."""
    assert not [b.sentence() for b in case.benchmarks() if not b.passed]


@pytest.mark.parametrize("degrees", SWEEP)
def test_dimensionless_sweep(degrees):
    """R1 1, R2 0.967, nu 0.3: five printed decimals (T6)."""
    strand = Strand16(1.0, 0.967, np.radians(degrees), 1.0, 0.3)
    R = strand.core + 2 * strand.wire
    scale = strand.EA * np.array([1.0, R, R**2])
    for contraction, row in ((True, SWEEP[degrees][:3]), (False, SWEEP[degrees][3:])):
        K = energy_consistent(strand, contraction)
        np.testing.assert_allclose(np.array([K[0, 0], K[0, 1], K[1, 1]]) / scale, row, rtol=0, atol=5.1e-6)


def test_other_printed_sets():
    """Rc 2.675, Rh 2.59, pitch 230 mm, and the example of Costello's book in inch and pound; half of the sixth digit."""
    long = Strand16(2.675, 2.59, np.arctan(2 * np.pi * 5.265 / 230), 188e3, 0.3)
    np.testing.assert_allclose(costello(long).ravel(), [2.71385e7, 1.73788e7, 1.64989e7, 5.00517e7], rtol=3.1e-6)
    E, K = energy_consistent(long), energy_consistent(long, contraction=False)
    np.testing.assert_allclose([E[0, 0], E[0, 1], E[1, 1]], [2.69982e7, 1.72643e7, 5.06303e7], rtol=3.1e-6)
    np.testing.assert_allclose([K[0, 0], K[0, 1], K[1, 1]], [2.72794e7, 1.74307e7, 5.07148e7], rtol=3.1e-6)
    book = Strand16(0.103, 0.101, np.arctan(2 * np.pi * 0.204 / 9.75), 28.5e6, 0.25)
    np.testing.assert_allclose(costello(book).ravel(), [6.26823e6, 142761, 135353, 17114], rtol=3e-5)


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
