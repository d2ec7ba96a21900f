"""The arithmetic of a benchmark: what passes, what fails, and a computation that does not converge."""

import math

import pytest

from beam.verification import rod_cases
from geometry.errors import ConvergenceError
from homogenize.benchmark import Benchmark, Case, band, run_cases
from homogenize.verification import section_cases


@pytest.mark.parametrize(
    ("kind", "computed", "passes"),
    [
        ("equal", 102.0, True),
        ("equal", 104.0, False),
        ("equal", 96.0, False),
        ("at least", 1e9, True),
        ("at least", 96.0, False),
        ("at most", -1e9, True),
        ("at most", 104.0, False),
        ("equal", math.nan, False),
        ("at most", math.nan, False),
        ("at least", math.inf, False),
    ],
)
def test_statements(kind, computed, passes):
    """Expected 100, tolerance 3 %."""
    assert Benchmark("b", "s", "q", 100.0, computed, 0.03, kind).passed is passes


def test_band_is_closed_at_its_ends():
    assert band("b", "s", "q", 2.0, 4.0, 3.999).passed and not band("b", "s", "q", 2.0, 4.0, 4.01).passed
    assert not band("b", "s", "q", 2.0, 4.0, 1.99).passed


def test_a_scale_makes_the_tolerance_absolute():
    assert Benchmark("b", "s", "q", 0.0, 1e-7, 1e-6, scale=1.0).passed
    assert not Benchmark("b", "s", "q", 0.0, 2e-6, 1e-6, scale=1.0).passed


def test_a_case_that_does_not_converge_fails_with_its_sentence():
    def broken():
        raise ConvergenceError("node 3 went away.")

    told: list[float] = []
    found = run_cases([Case("c", "s", broken)], lambda fraction, sentence: told.append(fraction))
    assert [b.passed for b in found] == [False]
    assert "node 3 went away." in found[0].sentence()
    assert told == [0.0, 1.0]


def test_names_of_the_cases_are_unique():
    names = [case.name for case in (*section_cases(), *rod_cases())]
    assert len(names) == len(set(names))
