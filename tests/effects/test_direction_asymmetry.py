"""Direction asymmetry: two slopes that meet at zero; the direction of a test turns the sign of its load."""

import numpy as np
import pytest

from effects.direction_asymmetry import BY_PLANE, EFFECT, TWO_SLOPES
from effects.effect import BenchPath

STRAIN = np.array([-0.02, -0.01, 0.0, 0.01, 0.02])


def path_of(strain: np.ndarray = STRAIN, direction: str | None = None) -> BenchPath:
    return BenchPath("shear", strain, None, direction=direction, largest=0.02)


def test_two_slopes():
    """a = 0.4: 1.2 K on the positive side, 0.8 K on the negative one."""
    load = STRAIN + 0.4 * TWO_SLOPES.respond(path_of())[:, 0]
    np.testing.assert_allclose(load, np.where(STRAIN > 0, 1.2, 0.8) * STRAIN, rtol=1e-14)


@pytest.mark.parametrize("plane", ["x", "y"])
def test_direction_turns_the_sign(plane):
    """The same specimen pushed the other way: positive deflection in x- is negative in x+."""
    forwards = 0.4 * TWO_SLOPES.respond(path_of(STRAIN, f"{plane}+"))[:, 0]
    backwards = 0.4 * TWO_SLOPES.respond(path_of(-STRAIN, f"{plane}-"))[:, 0]
    np.testing.assert_allclose(backwards, -forwards, rtol=1e-14)


def test_planes_are_apart():
    """In each plane its own strength; without a direction it is the first."""
    assert not BY_PLANE.respond(path_of(direction="x-"))[:, 1].any()
    np.testing.assert_array_equal(
        BY_PLANE.respond(path_of(direction="y-"))[:, 1], TWO_SLOPES.respond(path_of(direction="y-"))[:, 0]
    )
    assert not BY_PLANE.respond(path_of(direction="y-"))[:, 0].any()
    np.testing.assert_array_equal(BY_PLANE.respond(path_of())[:, 0], TWO_SLOPES.respond(path_of())[:, 0])


def test_needs_both_directions():
    """Pulls only, or pushes in x+ only, cannot show it; x+ and x- together can."""
    up = np.linspace(0.0, 0.02, 5)
    assert "same direction" in (EFFECT.why_untestable([path_of(up, "x+"), path_of(up, "x+")]) or "")
    assert "same direction" in (EFFECT.why_untestable([path_of(up, "x-")]) or "")
    assert EFFECT.why_untestable([path_of(up, "x+"), path_of(up, "x-")]) is None
    assert EFFECT.why_untestable([path_of()]) is None
