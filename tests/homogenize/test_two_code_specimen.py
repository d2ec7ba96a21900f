"""The finite specimen by two programs: Kronecker sums in the turning frame, and quadratic wedges assembled by CalculiX in fixed axes."""

import numpy as np
import pytest
from section_meshes import rectangle

from benchmarks.calculix_deck import find_calculix
from benchmarks.calculix_specimen import by_calculix, swept_wedges, volume_and_mean_gradient
from homogenize.specimen import AxialGrading, LoadCase, Specimen, solve_specimen
from homogenize.specimen.apparent_modulus import apparent_moduli

LOADS = (LoadCase("tension", 1000.0), LoadCase("shear", 50.0, "x"), LoadCase("shear", 50.0, "y"))


def strip(rate):
    """Two unlike halves: no symmetry that could hide an error."""
    return rectangle(4, 2, 0.02, 0.01, (2e9, 0.3), (1e11, 0.3), split_x=0.002, twist_rate=rate)


def test_mean_gradient_of_a_linear_field_is_its_own():
    """<grad u> of u = H x is H, and the wedges fill the volume of the swept section, whatever the pitch."""
    mesh = strip(30.0)
    wedges = swept_wedges(mesh, np.linspace(0, 0.05, 9))
    H = np.arange(9.0).reshape(3, 3) / 7 - 0.4
    volume, found = volume_and_mean_gradient(wedges, (wedges.points @ H.T)[:, :, None])
    assert found[:, :, 0] == pytest.approx(H, abs=1e-12)
    assert volume == pytest.approx(0.02 * 0.01 * 0.05, rel=1e-4)  # parabolas for helices of 0.19 rad a layer


@pytest.mark.skipif(find_calculix() is None, reason="CalculiX (ccx) is not installed")
@pytest.mark.parametrize("rate", (0.0, 30.0))
def test_moduli_and_displacements_of_two_programs(rate):
    """E, both G and the largest displacements; the serendipity wedge is a little stiffer than the full one."""
    specimen = Specimen(0.06, grading=AxialGrading(end_size=0.15, growth=1.5, largest=0.3, degree=2))
    mesh = strip(rate)
    solution = solve_specimen(specimen, mesh, LOADS)
    own = np.array([(a.modulus, a.u_max) for a in apparent_moduli(solution)])
    other, _, _ = by_calculix(mesh, solution.operator.axial.levels, LOADS)
    assert other == pytest.approx(own, rel=0.01)
