"""Stick-slip of helical layers from the lay-up: stick stiffness, capstan-like slip limits, and a real moment-curvature line."""

import dataclasses
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from effects.helical_layer import HelicalLayer, layers_of
from effects.layer_slip import expected, layer_slip, slip_of_layers
from geometry import Helix, read_cable
from geometry.errors import InputError
from homogenize import homogenize_cable
from homogenize.stiffness_bounds import spring_bending

CARDINAL = Path(__file__).resolve().parents[3] / "shared" / "data" / "cardinal-acsr-bending"
LAYER = HelicalLayer("outer", 24, 0.0116, 0.23, 6e5)


def under(*layers: HelicalLayer, mu: float = 0.5, tension: float = 2e4):
    return slip_of_layers(layers, EI_slip=20.0, EA_straight=3e6, friction_coefficient=mu, tension=tension)


def test_stick_stiffness_is_the_moment_of_wires_that_follow_the_section():
    """24 wires on a helix: axial strain is kappa times the height of their points; virtual work along a turn (1e-6)."""
    pitch = 2 * np.pi * LAYER.radius / np.tan(LAYER.lay_angle)
    energy = 0.0
    for k in range(24):
        helix = Helix(LAYER.radius, pitch, "Z", phase=2 * np.pi * k / 24)
        z = np.linspace(0, pitch, 401)
        strain = helix.position(z)[:, 1] * helix.tangent(z)[:, 2] ** 2  # kappa = 1; d(axial)/ds twice projected
        energy += LAYER.EA * np.trapezoid(strain**2, z) / np.cos(LAYER.lay_angle)
    assert LAYER.stick_stiffness == pytest.approx(energy / pitch, rel=1e-6)


def test_slip_limit_solves_the_friction_equation():
    """dF/dphi = mu [(t + F) sin + 2 Q r / sin] integrated numerically, for a layer with another one outside (1e-7)."""
    inner = HelicalLayer("inner", 18, 0.0083, 0.2, 6e5)
    slip = under(inner, LAYER)
    strain = 2e4 / slip.EA
    t = inner.EA * np.cos(0.2) ** 2 * strain
    pull_outside = LAYER.EA * np.cos(0.23) ** 2 * strain
    Q = 24 * pull_outside * np.sin(0.23) ** 2 / LAYER.radius / np.cos(0.23) * np.cos(0.2) / 18

    def growth(phi, F):
        return 0.5 * ((t + F) * np.sin(0.2) + 2 * Q * inner.radius / np.sin(0.2))

    solved = solve_ivp(growth, (0, np.pi / 2), [0.0], rtol=1e-10, atol=1e-10, dense_output=True)
    phi = np.linspace(0.1, np.pi / 2, 9)
    force = slip.layers[0].slip_curvature(phi) * inner.EA * inner.radius * np.cos(0.2) ** 2 * np.sin(phi)
    np.testing.assert_allclose(force, solved.sol(phi)[0], rtol=1e-7)
    assert slip.layers[0].slip_begin == pytest.approx(slip.layers[0].slip_curvature(np.array([1e-6]))[0], rel=1e-5)


def test_soft_seat_hands_on_its_share():
    """EA u'' = s (u - u_plane) with u_plane sinusoidal along the wire: finite differences round one turn (1e-4)."""
    layer = dataclasses.replace(LAYER, seat=4e7)
    n, q = 800, np.sin(layer.lay_angle) / layer.radius
    h = 2 * np.pi / q / n
    plane = np.cos(2 * np.pi * np.arange(n) / n)
    second = (np.roll(np.eye(n), 1, 0) - 2 * np.eye(n) + np.roll(np.eye(n), -1, 0)) / h**2
    u = np.linalg.solve(layer.seat * np.eye(n) - layer.EA * second, layer.seat * plane)
    assert layer.eta == pytest.approx(u[0], rel=1e-4)
    assert layer.stick_stiffness == pytest.approx(layer.eta * LAYER.stick_stiffness)


def test_moment_goes_from_stick_to_slip():
    """EI_stick at small curvature; past the last slip EI_slip kappa and the slip moments of closed form (0.1 %: 64 angles)."""
    slip = under(LAYER)
    begin, end = slip.slip_curvature
    assert slip.moment(0.99 * begin)[0] == pytest.approx(0.99 * begin * slip.EI_stick, rel=1e-9)
    a = 0.5 * np.sin(0.23)
    t = LAYER.EA * np.cos(0.23) ** 2 * 2e4 / slip.EA
    closed = 24 * LAYER.radius * np.cos(0.23) * t * 2 / np.pi * ((a * np.exp(a * np.pi / 2) + 1) / (1 + a**2) - 1)
    assert slip.layers[0].slip_moment == pytest.approx(closed, rel=1e-3)
    assert slip.moment(5 * end)[0] == pytest.approx(slip.EI_slip * 5 * end + closed, rel=1e-3)
    assert slip.moment(-end)[0] == -slip.moment(end)[0]
    assert (np.diff(slip.moment(np.linspace(0, 5 * end, 50)), 2) < 1e-9).all()


def test_slip_grows_with_tension_friction_and_outer_layers():
    """Proportional to tension; to friction, and more (exponential); a layer outside presses."""
    base, pulled, rough = under(LAYER), under(LAYER, tension=4e4), under(LAYER, mu=1.0)
    assert pulled.slip_curvature[1] == pytest.approx(2 * base.slip_curvature[1])
    assert rough.slip_curvature[0] == pytest.approx(2 * base.slip_curvature[0])
    assert rough.slip_curvature[1] > 2.05 * base.slip_curvature[1]
    inner = HelicalLayer("inner", 18, 0.0083, 0.2, 6e5)
    alone = slip_of_layers(
        [inner], EI_slip=20.0, EA_straight=under(inner, LAYER).EA - 18 * 6e5 * np.cos(0.2) ** 3,
        friction_coefficient=0.5, tension=2e4,
    )  # fmt: skip
    assert under(inner, LAYER).layers[0].slip_begin > 2 * alone.layers[0].slip_begin


def test_cores_in_rubber_take_a_small_share_of_the_bonded_cell():
    """What the bonded cell adds to members that bend for themselves: the cores would give 3.8 N m2 without their soft seat;
    the theory with it is an upper estimate, up to 3 times the cell (the bedding gives way as well, which it leaves out)."""
    cable = read_cable("example-three-core")
    stiffer = [
        p
        if p.kind == "conductor"
        else dataclasses.replace(p, material=dataclasses.replace(p.material, E=10 * p.material.E))
        for p in cable.parts
    ]
    cable = dataclasses.replace(cable, parts=tuple(stiffer))
    own = sum(
        p.material.E * np.pi / 4 * (p.outer_radius**4 - p.inner_radius**4) * spring_bending(p.lay_angle, p.material.nu)
        for p in stiffer
        if p.kind != "interstices"
    )
    rest = homogenize_cable(cable, size=2.5e-3).section.EI_x - own
    (cores,) = (one for one in layers_of(cable) if one.group == "cores")
    assert 1.0 < cores.stick_stiffness / rest < 3.0
    assert dataclasses.replace(cores, seat=np.inf).stick_stiffness > 10 * rest


def test_reference_cable():
    """Strands in the power conductors hold most of what can slip, 42.6 of 59.6 N m2 (by hand 1/2 n E A r^2 cos^3 each, times 3), and the
    bonded cell, 71.8 N m2 with solid conductors, is not far from all stuck (15 %)."""
    cable = read_cable("mcpt-1.9-3.3-3x35")
    slip = layer_slip(cable, 0.3, 1000.0)
    strands = max(slip.layers, key=lambda one: one.stick_stiffness)
    assert strands.layer.name == "power strands, layer 2"
    by_hand = 3 * 0.5 * 6 * 80e9 * 7.143e-6 * 3.016e-3**2 * np.cos(np.deg2rad(8.49)) ** 3
    assert strands.stick_stiffness == pytest.approx(by_hand, rel=0.08)  # the host's lay takes 5 %
    assert slip.EI_stick == pytest.approx(71.8, rel=0.15)
    tension = sum(one.layer.count * one.layer.axial_stiffness for one in slip.layers if one.layer.group == "cores")
    assert pytest.approx(tension + 1.721e6, rel=1e-3) == slip.EA


def test_expected_parameters_contain_every_friction_between():
    """Keys are the names of the parameters of interlayer-friction; larger tension moves the slip strain in proportion."""
    from effects import find

    cable = read_cable("mcpt-1.9-3.3-3x35")
    form = find("interlayer-friction").forms[0]
    ranges = expected(cable, 1000.0)
    names = {p.name for p in (*form.shape, *form.strength)}
    assert set(ranges) <= names
    assert ranges["stick stiffness"][0] < ranges["stick stiffness"][1] == layer_slip(cable, 0.3, 1.0).stiffness_ratio
    doubled = expected(cable, 2000.0)["slip strain"]
    np.testing.assert_allclose(doubled, 2 * np.array(ranges["slip strain"]))


def test_what_cannot_slip_is_a_sentence():
    """No layer; straight members; a negative tension."""
    with pytest.raises(InputError, match="no helical layer"):
        under()
    with pytest.raises(InputError, match="straight members do not slip"):
        under(dataclasses.replace(LAYER, lay_angle=0.0))
    with pytest.raises(InputError, match="must not be negative"):
        under(LAYER, tension=-1.0)


@pytest.mark.skipif(not CARDINAL.exists(), reason="the published line is not here")
def test_cardinal_conductor_untuned():
    """Steel 1 + 6, aluminium 12 + 18 + 24 at 40 kN, mu 0.7, lays in the middle of the standard's bounds, E 207 and 69 GPa. The line
    lies within 25 % of the theory at every point, below it (measured or computed by others: not settled)."""
    d_s, d_a = 3.34e-3, 3.32e-3
    radii = np.array([d_s, *(1.5 * d_s + d_a * np.array([0.5, 1.5, 2.5]))])
    lays = np.array([0.2104, 0.2166, 0.3029, 0.3593])
    EA = np.pi / 4 * np.array([207e9 * d_s**2, *(69e9 * np.full(3, d_a) ** 2)])
    angles = np.arctan(2 * np.pi * radii / lays)
    layers = [
        HelicalLayer(f"layer {i + 1}", n, float(radii[i]), float(angles[i]), float(EA[i]), group="conductor")
        for i, n in enumerate((6, 12, 18, 24))
    ]
    own = np.pi / 64 * (7 * 207e9 * d_s**4 + 54 * 69e9 * d_a**4)
    slip = slip_of_layers(layers, EI_slip=own, EA_straight=float(EA[0]), friction_coefficient=0.7, tension=4e4)
    kappa, moment = np.loadtxt(CARDINAL / "moment_curvature_40kN.csv", delimiter=",", skiprows=1).T
    ratio = slip.moment(kappa) / moment
    assert ratio.min() > 1.0 and ratio.max() < 1.25
    assert slip.EI_stick == pytest.approx(np.sum(kappa[:4] * moment[:4]) / np.sum(kappa[:4] ** 2), rel=0.2)
