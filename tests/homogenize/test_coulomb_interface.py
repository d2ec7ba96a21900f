"""Coulomb friction in tension and torsion: between bonded and frictionless, with heat, cone and Masing's rule."""

import dataclasses

import numpy as np
import pytest
from section_meshes import rings
from wire_in_rod import wire_in_rod

from geometry.errors import SpecError
from homogenize import solve_helical_cell
from homogenize.coulomb_interface import Coulomb
from homogenize.elastic_interface import Elastic
from homogenize.friction_loop import friction_loop
from homogenize.grip_pressure import grip_per_tension
from homogenize.interface_choice import Interfaces
from homogenize.rubbing_section import axial_friction
from homogenize.sliding_interface import Frictionless

RUBS = Interfaces({"conductor-insulation": Coulomb(0.3)})
GRIP = 2e-3


def cycle(amplitude, steps):
    """First loading to the amplitude, then once down and up again."""
    first = np.linspace(0, amplitude, steps + 1)
    down = np.linspace(amplitude, -amplitude, steps + 1)
    return np.concatenate([first, down[1:], down[::-1][1:]])


def loop_of(section, amplitude, steps=20, grip=GRIP, strain=0):
    path = np.zeros((3 * steps + 1, len(section.strains)))
    path[:, strain] = cycle(amplitude, steps)
    return friction_loop(section, path, grip)


@pytest.fixture(scope="module")
def mesh():
    return wire_in_rod(beta=np.radians(30.0))


@pytest.fixture(scope="module")
def section(mesh):
    return axial_friction(mesh, RUBS)


@pytest.fixture(scope="module")
def stretched(section):
    return loop_of(section, 0.1)


def test_condensation_keeps_both_limits(mesh, section):
    """C is the bonded stiffness of stretch and twist, C - A^T S^+ A the frictionless one, from the same section."""
    keep = np.ix_([2, 5], [2, 5])
    for word, found in (("bonded", section.bonded), ("frictionless", section.frictionless)):
        expected = np.linalg.inv(solve_helical_cell(mesh, word).stiffness.compliance[keep])
        np.testing.assert_allclose(found, expected, rtol=1e-8)


def test_free_twist_is_the_twist_of_no_torque(mesh, section):
    """Without torque one strain is left: EA = C11 - C12^2 / C22, bonded and frictionless."""
    free = axial_friction(mesh, RUBS, free_twist=True)
    for two, one in ((section.bonded, free.bonded), (section.frictionless, free.frictionless)):
        assert one[0, 0] == pytest.approx(two[0, 0] - two[0, 1] ** 2 / two[1, 1], rel=1e-9)


@pytest.mark.parametrize("strain", [0, 1])
def test_first_slope_is_bonded_and_last_is_frictionless(section, strain):
    """Of tension over stretch and of torque over twist; six digits at the start, 1e-3 of the difference at the end."""
    small = loop_of(section, 1e-6, strain=strain)
    bonded, free = section.bonded[strain, strain], section.frictionless[strain, strain]
    assert small.slope(1, strain) == pytest.approx(bonded, rel=1e-6)
    large = loop_of(section, 1.0, strain=strain)
    assert abs(large.slope(20, strain) - free) < 1e-3 * (bonded - free)


def test_no_loss_below_the_onset(section):
    """A grip a hundred times larger: nothing slides, the loop has no area and no heat."""
    loop = loop_of(section, 1e-3, grip=100 * GRIP)
    assert not loop.sliding.any() and loop.dissipation[-1] == 0.0
    assert abs(loop.work(20)) < 1e-12 * section.bonded[0, 0] * 1e-6


def test_area_is_heat_and_the_cone_is_kept(section, stretched):
    """Area of the closed loop = dissipation, with an error that falls with the step; |t| <= mu p to the tolerance."""
    heat = stretched.dissipation[-1] - stretched.dissipation[20]
    finer = loop_of(section, 0.1, steps=80)
    finer_heat = finer.dissipation[-1] - finer.dissipation[80]
    error = [abs(stretched.work(20) / heat - 1), abs(finer.work(80) / finer_heat - 1)]
    assert heat > 0 and error[1] < 0.01 and error[1] < 0.5 * error[0]
    assert stretched.cone_violation < 1e-5
    assert (np.diff(stretched.dissipation) >= 0).all()


def test_traction_opposes_the_slip_at_the_full_cone(stretched):
    """Where a node slides, its traction is mu p against the slip, to the tolerance of the step."""
    moved = np.diff(stretched.slip, axis=0)
    length = np.linalg.norm(moved, axis=-1)
    slid = length > 1e-3 * length.max()
    along = (stretched.traction[1:] * moved).sum(axis=-1)[slid] / length[slid]
    np.testing.assert_allclose(along, -0.3 * GRIP, rtol=1e-3)


def test_masing(stretched):
    """Unloading from the amplitude is the first loading, twice as large, turned round; reloading closes the loop."""
    first, down, up = stretched.force[:21, 0], stretched.force[20:41, 0], stretched.force[40:61, 0]
    np.testing.assert_allclose(down[0] - down, 2 * first, atol=2e-5 * first.max())
    np.testing.assert_allclose(up, -down, atol=2e-5 * first.max())


def test_loops_scale_with_the_grip(section, stretched):
    """Twice the grip at twice the strain is twice the force: the problem is homogeneous of degree one."""
    double = loop_of(section, 0.2, grip=2 * GRIP)
    np.testing.assert_allclose(double.force, 2 * stretched.force, atol=2e-5 * np.abs(stretched.force).max())


def test_no_friction_coefficient_is_the_frictionless_section(mesh, section):
    loop = loop_of(axial_friction(mesh, Interfaces({"conductor-insulation": Coulomb(0.0)})), 0.1, grip=GRIP, steps=4)
    np.testing.assert_allclose(loop.force, loop.strain @ section.frictionless, rtol=1e-4, atol=1e-5)
    assert loop.dissipation[-1] == 0.0


def test_grip_of_tension_is_the_pressure_of_the_coaxial_cylinder():
    """Stretched core and tube, nu 0.45 and 0.1: u_r = B r and B r + D / r, continuous u_r and pressure, free outside."""
    a, b, core, tube = 0.5, 1.0, (2.0, 0.45), (1.0, 0.1)
    mesh = rings((a, b), core, tube, per_ring=3, around=24)
    mesh = dataclasses.replace(mesh, regions=(mesh.regions[0], dataclasses.replace(mesh.regions[1], kind="sheath")))
    lame = [E * nu / ((1 + nu) * (1 - 2 * nu)) for E, nu in (core, tube)]
    G = [E / (2 * (1 + nu)) for E, nu in (core, tube)]
    rows = [
        [a, -a, -1 / a],
        [2 * (lame[0] + G[0]), -2 * (lame[1] + G[1]), 2 * G[1] / a**2],
        [0, 2 * (lame[1] + G[1]), -2 * G[1] / b**2],
    ]
    B = np.linalg.solve(rows, [0, lame[1] - lame[0], -lame[1]])
    pressure = -(2 * (lame[0] + G[0]) * B[0] + lame[0])
    axial = [lame[i] * 2 * B[i] + lame[i] + 2 * G[i] for i in (0, 1)]
    EA = np.pi * (a**2 * axial[0] + (b**2 - a**2) * axial[1])
    found = grip_per_tension(mesh, RUBS)
    assert pressure < 0  # the core shrinks more than the tube
    np.testing.assert_allclose(found, pressure / EA, rtol=3e-2)  # corners and middles of the edges differ a little
    np.testing.assert_allclose(found.reshape(2, -1).mean(), pressure / EA, rtol=1e-2)


def test_tension_grips_the_wire(mesh, section):
    """With grip in proportion to the tension the wire slides less under more tension; without tension it is free."""
    per_tension = np.abs(grip_per_tension(mesh, RUBS))
    path = np.column_stack([np.full(41, 0.05), np.concatenate([[0.0], cycle(0.05, 14)[:40]])])
    gripped = friction_loop(section, path, 0.0, per_tension)
    np.testing.assert_allclose(gripped.cap[1:, 0], 0.3 * per_tension * gripped.force[1:, :1], rtol=1e-4)
    assert gripped.cone_violation < 1e-4 and gripped.dissipation[-1] > 0


def test_what_does_not_rub_is_refused(mesh, section):
    with pytest.raises(SpecError, match="no interface rubs"):
        axial_friction(mesh, Interfaces({"conductor-insulation": Frictionless()}))
    with pytest.raises(SpecError, match="no interface rubs"):
        axial_friction(mesh, Interfaces({"conductor-insulation": Elastic(1.0)}))
    with pytest.raises(SpecError, match="zero or positive"):
        Coulomb(-0.1)
    with pytest.raises(SpecError, match="load path"):
        friction_loop(section, np.zeros((3, 1)), 1.0)
    with pytest.raises(SpecError, match="grip must be"):
        friction_loop(section, np.zeros((3, 2)), -1.0)
