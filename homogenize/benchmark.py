"""A benchmark: a number that theory or another code knows, beside the number that was computed.

Four kinds of statement: *equal* within a tolerance, *band* (between two numbers), *at least* and *at most*. The error of an
equality is |computed - expected| / scale, the scale being |expected| unless another one is stated; the error of the others is
the distance to the allowed range over the same scale, and no tolerance is left for it.

A :class:`Case` is a computation that yields benchmarks. Cases are data: the command `helicable verify` prints them, and the tests
assert the same objects, so that no number exists twice.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

from geometry.errors import ConvergenceError

Progress = Callable[[float, str], None]

KINDS = ("equal", "band", "at least", "at most")


@dataclass(frozen=True)
class Benchmark:
    """One statement; `name` says what was computed, `source` where the expected number comes from.

    Attributes
    ----------
    name, source, quantity : text; `quantity` ends with its unit in brackets
    expected : the number of the source; the middle of a band, the bound of "at least" and "at most"
    computed : what this code finds; nan if the computation failed
    tolerance : relative to `scale`; half the width of a band
    kind : one of :data:`KINDS`
    scale : what the error is divided by; 0 takes |expected|
    note : why the computation failed, or what to know about it

    Examples
    --------
    >>> Benchmark("bar", "Hooke", "EA [N]", 200.0, 201.0, 0.01).passed
    True
    """

    name: str
    source: str
    quantity: str
    expected: float
    computed: float
    tolerance: float
    kind: str = "equal"
    scale: float = 0.0
    note: str = ""

    @property
    def error(self) -> float:
        """Distance from what is expected, over the scale."""
        scale = self.scale or abs(self.expected) or 1.0
        off = (self.computed - self.expected) / scale
        return {"at least": max(0.0, -off), "at most": max(0.0, off)}.get(self.kind, abs(off)) + 0.0 * off

    @property
    def passed(self) -> bool:
        """Whether the statement holds; false if the number could not be computed."""
        return math.isfinite(self.computed) and self.error <= self.tolerance

    def sentence(self) -> str:
        """The outcome in words, for a failing test."""
        allowed = {"at least": "at least ", "at most": "at most "}.get(self.kind, "")
        return (
            f"{self.name}: {self.quantity} is {self.computed:.8g}, expected {allowed}{self.expected:.8g} ({self.source}); "
            f"error {self.error:.2e}, allowed {self.tolerance:.2e}. {self.note}"
        ).strip()


def band(name: str, source: str, quantity: str, low: float, high: float, computed: float, note: str = "") -> Benchmark:
    """The statement low <= computed <= high.

    Examples
    --------
    >>> band("strand", "theory", "kee [N]", 1.0, 3.0, 2.9).passed
    True
    """
    middle = 0.5 * (low + high)
    return Benchmark(name, source, quantity, middle, computed, 0.5 * (high - low) / abs(middle), "band", note=note)


def components(
    name: str,
    source: str,
    quantities: Sequence[str],
    expected: Iterable[float],
    computed: Iterable[float],
    tolerance: float,
    scale: float = 0.0,
) -> list[Benchmark]:
    """One equality for each component; with a `scale` the tolerance is absolute in units of it."""
    rows = zip(quantities, expected, computed, strict=True)
    return [Benchmark(name, source, q, float(e), float(c), tolerance, scale=scale) for q, e, c in rows]


@dataclass(frozen=True)
class Case:
    """A computation with a name that yields benchmarks; `run` takes nothing and may raise ConvergenceError."""

    name: str
    source: str
    run: Callable[[], Iterable[Benchmark]]

    def __str__(self) -> str:
        return self.name

    def benchmarks(self) -> list[Benchmark]:
        """Run it; a computation that does not converge is one failed benchmark that says why."""
        try:
            return list(self.run())
        except ConvergenceError as error:
            nan = float("nan")
            return [Benchmark(self.name, self.source, "converged", 1.0, nan, 0.0, note=str(error))]


def run_cases(cases: Sequence[Case], progress: Progress | None = None) -> list[Benchmark]:
    """Run the cases one after the other and collect their benchmarks."""
    tell = progress or (lambda fraction, sentence: None)
    found: list[Benchmark] = []
    for i, case in enumerate(cases):
        tell(i / len(cases), case.name)
        found += case.benchmarks()
    tell(1.0, f"{len(found)} benchmarks computed")
    return found
