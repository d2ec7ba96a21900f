"""End load introduction: apparent stiffness K/(1 + c/L), which grows with the specimen length."""

import numpy as np

from effects.effect import BenchPath
from effects.end_load_introduction import EFFECT, SHEAR_LAG


def path_of(length: float | None) -> BenchPath:
    return BenchPath("tension", np.array([0.0, 0.01, -0.02]), None, length)


def test_apparent_stiffness():
    """c = 0.5 m: 1/2 at a length of 0.5 m, 0.8 at 2 m, all of it for a very long cable or an unknown length."""
    for length, part in ((0.5, 0.5), (2.0, 0.8), (1e12, 1.0), (None, 1.0)):
        path = path_of(length)
        np.testing.assert_allclose(SHEAR_LAG.respond(path, 0.5), part * path.strain, rtol=1e-12)


def test_series_of_two_springs():
    """The ends are a spring in series: elongations add, L/K + c/K."""
    path = path_of(0.8)
    force = 3.0e5 * SHEAR_LAG.respond(path, 0.3)
    np.testing.assert_allclose(force * (0.8 + 0.3) / 3.0e5, path.strain * 0.8, rtol=1e-12)


def test_untestable_sentence():
    """One length, or none recorded, cannot show it."""
    assert EFFECT.why_untestable([path_of(1.5), path_of(1.5)]) == "all specimens are 1.5 m long"
    assert EFFECT.why_untestable([path_of(None)]) == "no specimen length was recorded"
    assert EFFECT.why_untestable([path_of(0.5), path_of(1.5)]) is None
