"""An effect of your own in ten lines: the function is the law, on the bench and, if it has no memory, in the rod."""

import numpy as np
import pytest

from effects import BenchPath, Parameter, find, of_strain, register, section_effect, unregister
from effects.effect import ActiveEffect
from effects.effect_check import defect, probe
from geometry.errors import SpecError

ONSET = Parameter("onset", "strain", "where it locks", starts=of_strain(0.1, 0.9, 5))


@section_effect("locking", shape=[ONSET])
def locking(path, onset):
    """The armour locks at large strain.

    More words.
    """
    return np.sign(path.strain) * np.maximum(np.abs(path.strain) - onset, 0.0)


def test_the_law_is_the_column():
    path = probe()
    column = locking.forms[0].respond(path, 0.004)
    assert column.shape == (241, 1)
    assert np.abs(column).max() == pytest.approx(np.abs(path.strain).max() - 0.004, rel=1e-12)


def test_texts_have_sound_defaults():
    assert locking.title == "The armour locks at large strain"
    assert locking.equation == "load = K (strain + strength locking(strain, onset))"
    assert locking.kind == "physics" and locking.stage == "section"
    assert locking.why_untestable([probe()]) is None
    assert locking.forms[0].strength[0].low == -np.inf


def test_strength_of_zero_is_neutral():
    assert ActiveEffect(locking, locking.forms[0], "bending", shape=(0.004,), strength=(0.0,)).neutral


def test_a_law_without_memory_steps_in_a_rod():
    """Many points of one instant: each gets the column of its own strain, tension and temperature."""

    @section_effect("warm-grip", strength=[Parameter("a", "1", "a"), Parameter("b", "1", "b")])
    def warm_grip(path):
        return np.column_stack([path.strain * path.tension / path.typical_tension, path.strain * path.temperature])

    strain, tension, warm = np.array([1e-3, 2e-3]), np.array([500.0, 2000.0]), np.array([300.0, 310.0])
    reference = BenchPath("bending", np.zeros(0), typical_tension=1000.0)
    advance = warm_grip.forms[0].advance
    columns, state = advance(strain, 0 * strain, 0.1, tension, warm, np.zeros((2, 0)), reference=reference)
    assert columns == pytest.approx(np.column_stack([[5e-4, 4e-3], strain * warm]), rel=1e-12)
    assert state.shape == (2, 0)
    assert defect(warm_grip) is None


def test_a_law_with_a_memory_must_say_so():
    def law(path):
        return -path.strain * np.maximum.accumulate(np.abs(path.strain))

    with pytest.raises(SpecError, match="memoryless=False"):
        register(section_effect("worn")(law))
    worn = section_effect("worn", memoryless=False)(law)
    assert worn.forms[0].advance is None and defect(worn) is None


def test_registered_it_is_found_with_the_others():
    register(locking)
    try:
        assert find("locking") is locking
    finally:
        unregister("locking")
    with pytest.raises(SpecError, match='no effect "locking"'):
        find("locking")


def test_a_law_that_is_wrong_is_refused_with_a_sentence():
    with pytest.raises(SpecError, match=r"one column per strength, shape \(241, 1\); it gives \(241, 2\)"):
        register(section_effect("two")(lambda path: np.column_stack([path.strain, path.strain])))
    with pytest.raises(SpecError, match="fails with TypeError"):
        register(section_effect("three", shape=[ONSET])(lambda path: path.strain))
    with pytest.raises(SpecError, match="onset has no starts"):
        bare = Parameter("onset", "strain", "where")
        register(section_effect("four", shape=[bare])(lambda path, onset: path.strain))
