"""Lame's bonded core and tube: exact EA with Poisson mismatch, up to nu = 0.4999 without locking (verification case T3)."""

import numpy as np
import pytest
from section_meshes import linear, rings, swept

from homogenize import solve_helical_cell, solve_periodic_cell


def lame(core, tube, a, b):
    """Energy of u_r = B1 r in the core, B2 r + C2 / r in the tube, at unit axial strain and no lateral pressure."""
    (E1, n1), (E2, n2) = core, tube
    m1, m2 = E1 / (2 * (1 + n1)), E2 / (2 * (1 + n2))
    l1, l2 = E1 * n1 / ((1 + n1) * (1 - 2 * n1)), E2 * n2 / ((1 + n2) * (1 - 2 * n2))
    # unknowns B1, B2, C2: continuity of u_r and sigma_rr at a, sigma_rr(b) = 0
    A = np.array(
        [
            [a, -a, -1 / a],
            [2 * (l1 + m1), -2 * (l2 + m2), 2 * m2 / a**2],
            [0, 2 * (l2 + m2), -2 * m2 / b**2],
        ]
    )
    B1, B2, _ = np.linalg.solve(A, [0, l2 - l1, -l2])
    return np.pi * (a**2 * (l1 + 2 * m1 + 2 * l1 * B1) + (b**2 - a**2) * (l2 + 2 * m2 + 2 * l2 * B2))


ROWS = [
    ((8.0, 0.45), (80000.0, 0.34), 5.0, 10.0, 18850288.96),
    ((8.0, 0.499), (80000.0, 0.34), 5.0, 10.0, 18860140.19),
    ((8.0, 0.4999), (80000.0, 0.34), 5.0, 10.0, 18915363.996),
    ((210000.0, 0.30), (1000.0, 0.45), 1.0, 3.0, 684952.78),
    ((110000.0, 0.34), (10.0, 0.4995), 4.0, 11.3, 5532726.83),
]


@pytest.mark.parametrize(("core", "tube", "a", "b", "expected"), ROWS)
@pytest.mark.parametrize("pitch", [np.inf, 60.0])
def test_axial_stiffness_is_lames(core, tube, a, b, expected, pitch):
    """EA to 1e-6 at any pitch; the printed values are reproduced by the closed form first."""
    assert lame(core, tube, a, b) == pytest.approx(expected, rel=1e-8)  # ten printed digits, the last row eight
    C = solve_helical_cell(rings((a, b), core, tube, per_ring=4, around=48, twist_rate=2 * np.pi / pitch)).stiffness.C
    assert C[2, 2] == pytest.approx(expected, rel=2e-6)


def test_mean_dilatation_wedges_do_not_lock():
    """3D cell at nu = 0.4999: the Poisson mismatch, 3.458e-3 of EA, is met to a fiftieth; locking would multiply it."""
    core, tube, a, b, exact = ROWS[2]
    around = 48
    section = linear(rings((a, b), core, tube, per_ring=4, around=around, twist_rate=0.05))
    stiffness = solve_periodic_cell(swept(section, 0.2, 1)).stiffness
    step = 2 * np.pi / around
    polygon = np.sin(step) / step  # area of the polygon over the circle
    assert stiffness[0, 0] / polygon == pytest.approx(exact, rel=3.458e-3 / 50)
