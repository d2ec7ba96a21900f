"""A frame in series with the specimen: apparent stiffness K/(1 + c/L)."""

import numpy as np
import pytest

from effects.effect import BenchPath
from effects.end_load_introduction import EFFECT as TWIN
from effects.rig_compliance import EFFECT

FORM = EFFECT.forms[0]
STRAIN = np.linspace(-0.01, 0.01, 21)


def at(length):
    return BenchPath("tension", STRAIN, length=length, largest=0.01)


@pytest.mark.parametrize("length", [0.5, 1.0, 4.0])
def test_two_springs_in_series(length):
    """EA/L of the specimen and k of the frame: F = u/(L/EA + 1/k)."""
    EA, k = 4e5, 2e6
    force = EA * FORM.respond(at(length), EA / k)
    assert force == pytest.approx(STRAIN * length / (length / EA + 1 / k), rel=1e-12)


def test_a_stiff_frame_leaves_the_path_exactly_as_it_is():
    assert np.array_equal(FORM.respond(at(2.0), 0.0), STRAIN)


@pytest.mark.parametrize(
    ("lengths", "word"),
    [((None, None), "no specimen length"), ((2.0, 2.0), "2 m"), ((2.0, 2.02), "2 m"), ((1.0, 2.0), None)],
)
def test_one_length_cannot_show_it(lengths, word):
    why = EFFECT.why_untestable([at(length) for length in lengths])
    assert why is None if word is None else word in str(why)


@pytest.mark.parametrize("length", [None, 0.7, 3.0])
def test_it_is_the_twin_of_the_load_through_the_sheath(length):
    """Same law, same search, same bounds: no data of the bench can prefer one of the two."""
    twin = TWIN.forms[0]
    assert EFFECT.kinds == TWIN.kinds and len(EFFECT.forms) == len(TWIN.forms) == 1
    assert np.array_equal(FORM.respond(at(length), 0.3), twin.respond(at(length), 0.3))
    mine, other = FORM.shape[0], twin.shape[0]
    assert (mine.low, mine.high, mine.plausible) == (other.low, other.high, other.plausible)
    assert mine.starts is not None and np.array_equal(mine.starts([at(length)]), other.starts([at(length)]))
