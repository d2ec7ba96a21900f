"""One helical wire is a spring: Kirchhoff's rod, with its stretch-twist coupling and sign (verification case T4)."""

import numpy as np
import pytest
from section_meshes import rings, wire_trace

from homogenize import pitch_average, solve_helical_cell

TABLE = {
    80: (1.058528e-3, -5.381883e-4, 0.1354339),
    60: (3.245642e-3, -3.922058e-3, 0.3700409),
    45: (4.907377e-3, -6.400926e-3, 0.4912711),
}


def kirchhoff(beta, r, a, nu=0.3):
    """K of (stretch, twist) per axial length of a rod of unit modulus: inverse of the compliance of its helix.

    The verification table calls s = cos, c = sin of the lay angle from the cable axis.
    """
    EA, EI = np.pi * a**2, np.pi * a**4 / 4
    GJ = EI / (1 + nu)
    s, c = np.cos(beta), np.sin(beta)
    FF = (s**2 / EA + r**2 * c**2 / GJ + r**2 * s**2 / EI) / s
    FM = r * s * c * (1 / GJ - 1 / EI) / s
    MM = (s**2 / GJ + c**2 / EI) / s
    return np.linalg.inv([[FF, FM], [FM, MM]])


def cell(beta, r, a, sign=1.0):
    tau = sign * np.tan(beta) / r
    mesh = rings((a,), (1.0, 0.3), per_ring=4, around=36, twist_rate=tau, shape=wire_trace(a, r, tau))
    C = pitch_average(solve_helical_cell(mesh).stiffness).C
    return C[np.ix_([2, 5], [2, 5])]


@pytest.mark.parametrize("beta", [45, 60, 80])
def test_the_closed_form_reproduces_the_printed_table(beta):
    """Values of the verification table, r = 10, a = 1. Its angle is the lay angle from the axis."""
    K = kirchhoff(np.radians(beta), 10.0, 1.0)
    np.testing.assert_allclose([K[0, 0], K[0, 1], K[1, 1]], TABLE[beta], rtol=1e-6)


@pytest.mark.parametrize("beta", [20, 45, 60])
def test_the_cell_converges_to_the_rod_as_the_wire_gets_thin(beta):
    """Error of every entry falls as (a/r)^2: by 4 when the wire is half as thick, and is below 2e-3 at r/a = 20."""
    b = np.radians(beta)
    error = []
    for a in (1.0, 0.5):
        exact = kirchhoff(b, 10.0, a)
        scale = np.sqrt(np.outer(np.diag(exact), np.diag(exact)))
        error.append(np.abs((cell(b, 10.0, a) - exact) / scale).max())
    assert error[1] < 2e-3
    assert 3.0 < error[0] / error[1] < 5.0


def test_reversing_the_lay_changes_only_the_sign_of_the_coupling():
    """Mirror symmetry S / Z."""
    Z, S = cell(np.radians(30), 10.0, 1.0), cell(np.radians(30), 10.0, 1.0, sign=-1.0)
    np.testing.assert_allclose(np.diag(Z), np.diag(S), rtol=1e-8)
    np.testing.assert_allclose(Z[0, 1], -S[0, 1], rtol=1e-8)
    assert Z[0, 1] < 0  # a free spring winds up when it is pulled; a strand, whose core holds the radius, unwinds
