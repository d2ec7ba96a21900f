r"""Which other effects could imitate a towing truth within the noise: each fitted to what the truth makes, by the generator's own line.

.. math::  d_j = \sqrt 2 \min_{\Delta\mu, a} \bigl\| W\,[y_\text{truth} - y_j(\mu + \Delta\mu, a)] \bigr\|

W whitens with the noise that was drawn, the root of two counts the repeats, j is an effect of :mod:`benchmarks.blind_towing.truths`
in its first variant, with a strength a >= 0 (either sign for an offset, a drift, a ratio) and a few drawn shapes. The first fit
is linear in the change at a = 1; what comes near is run at what was fitted and mended by Gauss-Newton steps, so that a distance
below half of that of the base model is one that a run has, and an upper limit. The same
definition (both repeats, close below 5) as :mod:`benchmarks.blind.rivals` has for the bench.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from benchmarks.blind.judge import CLOSE
from benchmarks.blind_towing.truths import LIBRARY, Hidden, Truth, combined, draw

if TYPE_CHECKING:
    from benchmarks.blind_towing.generator import TowingCampaign

Array = NDArray[np.float64]
CELLS, STEP = 16, 6e-3  # of the line that truth and rivals share here
_SHAPES = {"trough-friction-stribeck": 4, "roller-resistance": 2, "polygon-effect": 2}
_EITHER_SIGN = ("sensor-offset", "sensor-drift", "trolley-ratio-error")
_ROUNDS = 2


def rivals(made: TowingCampaign, names: Sequence[str] = ()) -> dict[str, float]:
    """Distance of the nearest run of every other effect from the truth of a single campaign, in units of the noise.

    Parameters
    ----------
    made : TowingCampaign
        With one truth.
    names : sequence of str
        Effects that may be rivals; all of the library by default.
    """
    (truth,) = made.truths
    fit = _Fit(made)
    rng = np.random.default_rng([808, made.case.seed])
    found: dict[str, float] = {}
    for name in names or LIBRARY:
        if name == truth.name or name not in LIBRARY:
            continue
        shapes = (draw(rng, name, LIBRARY[name][1][0]) for _ in range(_SHAPES.get(name, 1)))
        found[name] = min(fit.distance(rival) for rival in shapes)
    return found


def twins(distances: dict[str, float]) -> list[str]:
    """Those that are too close for any method to be sure of the name."""
    return sorted(name for name, d in distances.items() if d < CLOSE)


class _Fit:
    """The records to calibrate on a coarser line, whitened: what the truth makes, and the column of the friction coefficient."""

    def __init__(self, made: TowingCampaign) -> None:
        self.made = made
        self.rows = [r for r, c in enumerate(made.conditions) if c.purpose == "calibrate"]
        self.line = replace(made.line, cells=CELLS)
        self.base = self._run(Hidden(), 0.0)
        self.clean = self._run(combined([t.hidden(self.line) for t in made.truths]), 0.0)
        self.step = 0.02 * made.line.friction
        self.truth = self._white(self.clean - self.base)
        self.slope = self._white(self._run(Hidden(), self.step) - self.base) / self.step

    def _run(self, hidden: Hidden, more: float) -> Array:
        line = replace(self.line, friction=self.line.friction + more)
        return self.made.towed(line, hidden, [self.made.conditions[r] for r in self.rows], STEP)

    def _white(self, change: Array) -> Array:
        """A change of the readings (records, channels, samples) in units of the noise, both repeats: one column."""
        rest = self.made.at_rest[self.rows]
        return math.sqrt(2) * np.concatenate(
            [
                self.made.noise.whiten(change[r, k][:, None], self.clean[r, k] - rest[r, k], float(rms))[:, 0]
                for r in range(len(self.rows))
                for k, rms in enumerate(self.made.unit)
            ]
        )

    def distance(self, rival: Truth) -> float:
        """Of one shape: linear, and where that is near the least that a run has."""
        columns = np.column_stack([self.slope, self._change(rival, np.array([0.0, 1.0]))])
        g = self.slope / np.linalg.norm(self.slope)
        alone = float(np.linalg.norm(self.truth - g * (g @ self.truth)))
        x = self._solved(rival, columns, np.zeros(2), self.truth)
        linear = float(np.linalg.norm(self.truth - columns @ x))
        if linear > 0.5 * alone:
            return linear
        return min([alone, *self._runs(rival, x)])

    def _runs(self, rival: Truth, x: Array) -> Iterator[float]:
        """Distances of runs at ever better fits (Gauss-Newton, columns by forward differences)."""
        for _ in range(_ROUNDS):
            now = self._change(rival, x)
            yield float(np.linalg.norm(self.truth - now))
            steps = (self.step, 0.05 * (abs(float(x[1])) or 1.0))
            columns = np.column_stack(
                [(self._change(rival, x + h * e) - now) / h for h, e in zip(steps, np.eye(2), strict=True)]
            )
            x = self._solved(rival, columns, x, self.truth - now)
        yield float(np.linalg.norm(self.truth - self._change(rival, x)))

    def _change(self, rival: Truth, x: Array) -> Array:
        return self._white(self._run(rival.of_size(float(x[1])).hidden(self.line), float(x[0])) - self.base)

    def _solved(self, rival: Truth, columns: Array, at: Array, left: Array) -> Array:
        """Friction and strength of the linear fit; a strength that must not be negative ends at a trace."""
        x = at + np.linalg.lstsq(columns, left, rcond=None)[0]
        if rival.name not in _EITHER_SIGN and x[1] < 1e-3:
            g = columns[:, 0]
            x = np.array([at[0] + g @ (left - columns[:, 1] * (1e-3 - at[1])) / (g @ g), 1e-3])
        return x
