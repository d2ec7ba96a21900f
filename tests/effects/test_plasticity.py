"""Plasticity: bilinear loading and unloading, a permanent set, and no influence of tension."""

from dataclasses import replace

import numpy as np
from scipy.optimize import brentq, nnls

from effects.effect import BenchPath
from effects.plasticity import ISOTROPIC, KINEMATIC, MANY_ELEMENTS


def path_of(strain: np.ndarray, tension: float = 1000.0) -> BenchPath:
    return BenchPath("tension", strain, None, 1.0, np.full(strain.size, tension), largest=0.02, typical_tension=1000.0)


def test_bilinear_and_permanent_set():
    """K = 1, a = 3, yield at 0.005: slope 4, then 1; back with 4 to the set 0.02 (1 - 4/4) ..., found from zero load."""
    strain = np.array([0.0, 0.005, 0.02, 0.01, 0.0])
    load = strain + 3.0 * KINEMATIC.respond(path_of(strain), 0.005)[:, 0]
    np.testing.assert_allclose(load, [0.0, 0.02, 0.035, -0.005, -0.015], rtol=1e-12)

    def left_over(back: float) -> float:
        s = np.array([0.0, 0.02, back])
        return float(s[-1] + 3.0 * KINEMATIC.respond(path_of(s), 0.005)[-1, 0])

    np.testing.assert_allclose(brentq(left_over, 0.005, 0.02), 0.02 - 0.035 / 4, rtol=1e-10)


def test_isotropic_limit_is_symmetric():
    """After 0.02 forwards the limit on the way back is the one reached, not the one at first."""
    strain = np.array([0.0, 0.02, -0.02])
    s = ISOTROPIC.respond(path_of(strain), 0.005, 1.0)[:, 0]
    np.testing.assert_allclose(s[1], 0.005 + 0.5 * 0.015, rtol=1e-12)
    np.testing.assert_allclose(s[2], -(s[1] + 0.5 * (0.04 - 2 * s[1])), rtol=1e-12)


def test_tension_plays_no_part():
    """The same path at two tensions gives the same columns: what tells it from interlayer friction."""
    strain = 0.02 * np.sin(np.linspace(0.0, 12.0, 200))
    for form, shape in ((KINEMATIC, (0.004,)), (MANY_ELEMENTS, ()), (ISOTROPIC, (0.004, 0.1))):
        low, high = form.respond(path_of(strain, 100.0), *shape), form.respond(path_of(strain, 9000.0), *shape)
        np.testing.assert_array_equal(low, high)


def test_many_elements_follow_ramberg_osgood():
    """Strain = s + s^5 / s0^4 with Masing's branches: the elements leave less than 1 % of the load, one more than 3 %."""
    s0 = 0.006

    def first_loading(e: float) -> float:
        return brentq(lambda s: s + s**5 / s0**4 - e, 0.0, e + 1e-12) if e > 0.0 else 0.0

    up = np.linspace(0.0, 0.02, 60)
    down = np.linspace(0.02, -0.02, 120)[1:]
    load_up = np.array([first_loading(e) for e in up])
    load_down = load_up[-1] - 2 * np.array([first_loading((0.02 - e) / 2) for e in down])
    load_again = load_down[-1] + 2 * np.array([first_loading((e + 0.02) / 2) for e in -down])
    strain, load = np.concatenate([up, down, -down]), np.concatenate([load_up, load_down, load_again])
    path = path_of(strain)

    def left(columns: np.ndarray) -> float:
        return nnls(np.column_stack([strain, columns]), load)[1] / float(np.linalg.norm(load))

    assert left(MANY_ELEMENTS.respond(path)) < 0.01
    assert min(left(KINEMATIC.respond(path, x)) for x in np.geomspace(0.001, 0.02, 30)) > 0.03


def test_scales_with_the_largest_strain():
    """The many-element form is the same law in every unit of strain."""
    strain = 0.02 * np.sin(np.linspace(0.0, 12.0, 200))
    big = replace(path_of(50.0 * strain), largest=1.0)
    np.testing.assert_allclose(MANY_ELEMENTS.respond(big), 50.0 * MANY_ELEMENTS.respond(path_of(strain)), rtol=1e-12)
