"""A limp cable that slips round a drum which does not turn: T2/T1 = exp(mu beta) (Euler, Eytelwein; case F2)."""

import pytest

from beam.benchmark_friction import capstan


@pytest.mark.parametrize("mu", [0.1, 0.3])
def test_half_turn(mu):
    """beta = pi, 40 elements on the arc; 1 %. Without friction T2 = T1."""
    assert not [b.sentence() for b in capstan(mu) if not b.passed]
