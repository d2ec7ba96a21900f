"""Laws that every finite specimen obeys: patch tests, cantilever, energy, reciprocity, end conditions, convergence."""

import dataclasses

import numpy as np
import pytest
from section_meshes import rectangle, rings

from geometry.errors import SpecError
from homogenize import Elastic, Frictionless, Interfaces, solve_helical_cell
from homogenize.section_system import section_system
from homogenize.specimen import AxialGrading, Held, LoadCase, Plate, Specimen, Traction, read_end, solve_specimen
from homogenize.specimen.apparent_modulus import apparent_moduli, end_displacement, end_rotation, mean_stress
from homogenize.specimen.axial_basis import AxialBasis
from homogenize.specimen.gauge_length import gauge_modulus
from homogenize.specimen.length_law import length_law
from homogenize.specimen.shear_lag import shear_lag
from homogenize.specimen.swept_operator import SweptOperator

R, E = 0.01, 2e9
COARSE = AxialGrading(end_size=0.3, growth=2.0, largest=1.0, degree=4)
TENSION, SHEAR_X, SHEAR_Y = LoadCase("tension", 1000.0), LoadCase("shear", 50.0, "x"), LoadCase("shear", 50.0, "y")
RATES = (0.0, 40.0, -75.0)


def bar(nu=0.0, rate=0.0, **kw):
    """A round homogeneous bar; its boundary is curved, so that its area is that of the circle to 1e-4."""
    return rings([R], (E, nu), per_ring=1, around=12, twist_rate=rate, **kw)


def two_parts(rate=30.0, contrast=50.0):
    """A strip, one half stiff: no symmetry that could hide an error."""
    return rectangle(4, 2, 2 * R, R, (E, 0.3), (contrast * E, 0.3), split_x=0.002, twist_rate=rate)


@pytest.mark.parametrize("rate", RATES)
def test_uniform_stress_is_in_balance_inside(rate):
    """Patch test: the displacement of uniform tension, and of torsion of a round bar, needs no force inside or on the sides."""
    system = section_system(bar(0.3, rate))
    axial = AxialBasis(np.array([0.0, 0.01, 0.03, 0.04]), 2)
    operator = SweptOperator(system.pencil, axial)
    X, Y = system.field.nodes
    z, zero = axial.stations, np.zeros((len(X), len(axial.stations)))
    one = np.ones_like(z)
    pull = np.stack([-0.3 * np.outer(X, one), -0.3 * np.outer(Y, one), np.outer(one[:1].repeat(len(X)), z)], axis=1)
    turned = np.stack([-np.outer(Y, z), np.outer(X, z), zero], axis=1)
    for u in (pull, turned):
        f = operator.apply(u.reshape(-1, len(z), 1))[:, :, 0]
        scale = np.abs(f[:, -1]).max()
        # round-off; the straight chords of the mesh leave the sides of torsion free of traction to its curvature
        assert np.abs(f[:, 1:-1]).max() < (1e-10 if u is pull else 2e-3) * scale
    top = operator.apply(pull.reshape(-1, len(z), 1))[2::3, -1, 0]
    assert top.sum() == pytest.approx(E * system.field.area, rel=1e-10)  # exact: uniform stress


@pytest.mark.parametrize("rate", RATES)
def test_bar_without_contraction_has_its_own_modulus_at_any_pitch(rate):
    """nu = 0: the held end does not disturb; E_app = E and the end turns by T L / (G J), whatever the turning of the frame."""
    solution = solve_specimen(
        Specimen(0.1, grading=COARSE), bar(0.0, rate), [TENSION, LoadCase("torsion", 2.0)], tolerance=1e-8
    )
    pulled, twisted = apparent_moduli(solution)
    assert pulled.modulus == pytest.approx(E, rel=1e-7)  # uniform stress is in the space; solver 1e-8
    assert pulled.u_max == pytest.approx(pulled.u_mean, rel=1e-6)
    assert twisted.modulus == pytest.approx(E / 2 * np.pi * R**4 / 2, rel=1e-3)  # curved chords of 12 segments
    assert gauge_modulus(solution, 0) == pytest.approx(E, rel=1e-7)


@pytest.mark.parametrize("rate", (0.0, 40.0))
def test_cantilever_deflects_as_timoshenko(rate):
    """u = F L^3 / 3 E I + F L / (k G A), k = 6/7 for a circle at nu = 0; theta = M L / E I; the turning frame does not matter."""
    L, inertia, area = 0.2, np.pi * R**4 / 4, np.pi * R**2
    solution = solve_specimen(Specimen(L, grading=COARSE), bar(0.0, rate), [SHEAR_Y, LoadCase("bending", 3.0, "y")])
    u = end_displacement(solution)
    expected = 50 * L**3 / (3 * E * inertia) + 50 * L / (6 / 7 * E / 2 * area)
    assert u[1, 0] == pytest.approx(
        expected, rel=2e-3
    )  # restrained warping of the held end: (R / L)^3 of the shear part
    assert abs(u[0, 0]) < 1e-3 * expected
    assert end_rotation(solution)[1, 1] == pytest.approx(3 * L / (E * inertia), rel=1e-3)
    assert u[0, 1] == pytest.approx(3 * L**2 / (2 * E * inertia), rel=1e-3)


@pytest.fixture(scope="module")
def odd():
    loads = [TENSION, SHEAR_X, SHEAR_Y, LoadCase("bending", 1.0, "x"), LoadCase("torsion", 1.0)]
    return solve_specimen(Specimen(0.08, grading=COARSE), two_parts(), loads, tolerance=1e-8)


def test_reciprocity_and_energy(odd):
    """Betti: the work of one load on the displacement of another is mutual; Clapeyron: work = 2 energy."""
    work = np.einsum("nmi,nmj->ij", odd.F, odd.U)
    assert np.allclose(work, work.T, rtol=1e-6, atol=1e-7 * np.abs(work).max())  # solver 1e-8
    assert odd.energy == pytest.approx(np.diag(work) / 2, rel=1e-6)
    assert all(check.holds for check in odd.checks), odd.checks


def test_reactions_balance_the_load(odd):
    """Forces and moments about the held end."""
    L = odd.specimen.length
    expected = np.zeros((6, 5))
    expected[[2, 0, 1, 3, 5], range(5)] = [-1000, -50, -50, -1, -1]
    expected[4, 1], expected[3, 2] = -50 * L, 50 * L
    assert odd.reactions[:3] == pytest.approx(expected[:3], abs=0.05)  # 1000 N; polynomials in the turning frame
    assert odd.reactions[3:] == pytest.approx(expected[3:], abs=4e-3)


def test_mean_stress_is_the_load_over_the_area(odd):
    """<s_zz> = F / A and <t_xz> = F / A by equilibrium, in fixed axes."""
    stress = mean_stress(odd) * odd.system.field.area
    assert [stress[2, 0], stress[4, 1], stress[3, 2]] == pytest.approx([1000, 50, 50], rel=1e-3)
    assert shear_lag(odd, 0).force.sum(axis=0)[6:-8] == pytest.approx(1000, rel=2e-2)  # pointwise in z: not an average


def test_a_quarter_turn_exchanges_the_planes(odd):
    """The section turned by 90 degrees under x is the section as drawn under y: exact, on the same mesh."""
    turned = solve_specimen(
        dataclasses.replace(odd.specimen, phase=np.pi / 2), odd.mesh, [SHEAR_X, SHEAR_Y], tolerance=1e-8
    )
    x, y = apparent_moduli(turned)
    _, x0, y0, *_ = apparent_moduli(odd)
    assert [x.modulus, y.modulus] == pytest.approx([y0.modulus, x0.modulus], rel=1e-6)
    assert [x.u_max, y.u_max] == pytest.approx([y0.u_max, x0.u_max], rel=1e-6)
    assert abs(x0.u_max / y0.u_max - 1) > 1e-3  # else the exchange would say nothing


def test_error_falls_with_the_order_of_the_polynomials():
    """The energy of degree 2 converges with h^4 along a turning bar."""
    energies = []
    for layers in (24, 48, 96):
        grading = AxialGrading(end_size=5.0 / layers, largest=5.0 / layers, growth=1.0, degree=2)
        solution = solve_specimen(Specimen(0.1, grading=grading), bar(0.0, 40.0), [SHEAR_X], tolerance=1e-9)
        assert solution.operator.axial.layers == layers
        energies.append(solution.energy[0])
    steps = np.diff(energies)
    assert (steps > 0).all()  # a compatible model is too stiff
    assert np.log2(steps[:-1] / steps[1:])[-1] == pytest.approx(4.0, abs=0.7)


@pytest.mark.parametrize("traction_part", ["part 0", "part 1"])
def test_shear_lag_of_coaxial_bars(traction_part):
    """A core and a tube joined by a shear stiffness k = 2 pi a k_t per length: N_1 = F s_1 (1 - cosh bz / cosh bL) if the tube is loaded,
    b^2 = k (1 / EA_1 + 1 / EA_2), s_1 = EA_1 / (EA_1 + EA_2)."""
    a, b, L = 0.005, 0.01, 0.2
    EA = np.array([4 * E * np.pi * a**2, E * np.pi * (b**2 - a**2)])
    beta = 1 / 0.04
    k = beta**2 / (1 / EA).sum()
    mesh = rings([a, b], (4 * E, 0.0), (E, 0.0), per_ring=1, around=16)
    law = Interfaces({"part 0-part 1": Elastic(k / (2 * np.pi * a))})
    specimen = Specimen(L, loaded=Traction((traction_part,)), interface=law, grading=COARSE)
    lag = shear_lag(solve_specimen(specimen, mesh, [TENSION]))
    loaded = int(traction_part[-1])
    unloaded = 1 - loaded
    share = EA[unloaded] / EA.sum()
    expected = 1000 * share * (1 - np.cosh(beta * lag.z) / np.cosh(beta * L))
    inside = lag.z < L - b  # bars: not the local field at the loaded face
    assert lag.force[unloaded][inside] == pytest.approx(expected[inside], abs=0.02 * 1000)  # (beta b)^2 / 4 = 1.6 %
    assert np.ptp(lag.force[unloaded][inside]) > 0.3 * 1000 * share


def test_long_specimen_tends_to_the_cell():
    """L/E = c + L/E_inf with E_inf of the cell, free to twist under traction, blocked in a plate that does not twist."""
    mesh = rectangle(6, 2, 4 * R, R, (E, 0.3), twist_rate=50.0)
    cell = solve_helical_cell(mesh).stiffness
    assert cell.E_blocked_twist > 1.1 * cell.E_free_twist
    grading = AxialGrading(end_size=0.1, growth=2.0, largest=1.0)
    for end, E_cell in ((Traction(), cell.E_free_twist), (Plate(tilt=False, twist=False), cell.E_blocked_twist)):
        lengths = [0.25, 0.4]
        solved = [solve_specimen(Specimen(L, loaded=end, grading=grading), mesh, [TENSION]) for L in lengths]
        law = length_law(lengths, [apparent_moduli(s)[0].modulus_of_mean for s in solved])
        assert apparent_moduli(solved[0])[0].modulus == pytest.approx(
            E, rel=1e-2
        )  # one material: <s> = C <e> but for the held end
        assert law.E_infinite == pytest.approx(E_cell, rel=5e-3)  # two lengths, end effects that decay with the width
        assert gauge_modulus(solved[1]) == pytest.approx(E_cell, rel=1e-2)


def test_plate_moves_as_a_rigid_body_and_blocks_what_it_is_told():
    """A plate without tilt and twist has the same translation everywhere, and a torque as reaction; it is stiffer than traction."""
    mesh = two_parts()
    solved = {
        name: solve_specimen(Specimen(0.08, loaded=end, grading=COARSE), mesh, [TENSION], tolerance=1e-8)
        for name, end in (("free", Traction()), ("plate", Plate()), ("blocked", Plate(tilt=False, twist=False)))
    }
    u = solved["blocked"].displacement[:, :, -1, 0]
    assert np.ptp(u, axis=0) == pytest.approx(0, abs=1e-9 * np.abs(u).max())
    assert abs(solved["blocked"].reactions[5, 0]) > 1e-3
    assert abs(solved["plate"].reactions[5, 0]) < 1e-4
    work = [s.energy[0] for s in solved.values()]
    assert work[0] > 1.01 * work[1] > 1.02 * work[2]
    assert all(check.holds for s in solved.values() for check in s.checks)


def test_grips_on_one_part():
    """Gripping the stiff part at both ends: the grip carries the load, the rest of the end-section is free of traction."""
    mesh = rings([0.005, 0.01], (50 * E, 0.3), (E, 0.3), per_ring=1, around=12)
    grip = Specimen(0.06, loaded=Plate(parts=("part 0",)), held=Held(("part 0",)), grading=COARSE)
    solution = solve_specimen(grip, mesh, [TENSION], tolerance=1e-8)
    outer = np.setdiff1d(
        *(np.unique(solution.system.field.cells[:, solution.system.field.region_of == r]) for r in (1, 0))
    )
    assert solution.reactions[2, 0] == pytest.approx(-1000, rel=1e-6)
    assert np.abs(solution.forces.reshape(-1, 3, *solution.forces.shape[1:])[outer]).max() < 1e-3
    assert np.abs(solution.displacement[outer, 2, 0, 0]).max() > 0


def test_slip_softens_from_bonded_to_frictionless():
    """An elastic interface lies between no slip and free slip; a very stiff one is bonded."""
    mesh = rings([0.005, 0.01], (50 * E, 0.3), (E, 0.3), per_ring=1, around=12, twist_rate=40.0)
    name = "part 0-part 1"
    ties = ["bonded", *(Interfaces({name: law}) for law in (Elastic(1e16), Elastic(1e12), Frictionless()))]
    work = [
        solve_specimen(Specimen(0.06, interface=tie, grading=COARSE), mesh, [TENSION], tolerance=1e-6).energy[0]
        for tie in ties
    ]
    assert work[1] == pytest.approx(work[0], rel=2e-3)
    assert work[1] < 0.99 * work[2] < 0.98 * work[3]


def test_bad_input_is_a_sentence():
    mesh = bar()
    with pytest.raises(SpecError, match="length of a specimen must be positive"):
        Specimen(-1.0)
    with pytest.raises(SpecError, match="is not a part"):
        solve_specimen(Specimen(0.1, loaded=Traction(("copper",))), mesh, [TENSION])
    with pytest.raises(SpecError, match="moves nothing"):
        LoadCase("tension", 0.0)
    with pytest.raises(SpecError, match="is not known"):
        LoadCase("pull", 1.0)
    with pytest.raises(SpecError, match="loaded end"):
        read_end("glue")
    with pytest.raises(SpecError, match="at least one load"):
        solve_specimen(Specimen(0.1), mesh, [])
    with pytest.raises(SpecError, match="two different lengths"):
        length_law([0.1, 0.1], [1e6, 1e6])
