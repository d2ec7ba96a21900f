r"""Search for the period that several layers have in common with the least change of their lay angles.

A layer whose lay angle may change by delta either way turns at a rate between omega(beta - delta) and omega(beta + delta),
so that k parts of a turn take a height between 2 pi k / fold over the larger and over the smaller rate. A combination of
whole numbers k is possible where the intervals of all layers overlap. The intervals grow with delta: the smallest largest
change of a combination is the delta at which they begin to overlap, found by bisection. The rule by which one of the
combinations is chosen stands in common_period.py.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import ceil, floor, inf

import numpy as np

from geometry.bent_lay import lay_rate, relative_turn_rate
from geometry.errors import GeometryError
from geometry.matched_lay import CommonPeriod, LayeredLay, MatchedLay

ECONOMY = 1.25
"""A period may be longer than the shortest acceptable one by this factor if that lessens the changes."""

EXACT = 1e-9
"""Relative precision to which straight members, which are not adjusted, have to match a period."""

STEEPEST = float(np.radians(80.0))


@dataclass(frozen=True)
class PeriodSearch:
    """The layers and the twist rate [rad/m] of the cell's motion."""

    layers: tuple[LayeredLay, ...]
    twist_rate: float

    def rate(self, layer: LayeredLay) -> float:
        """omega [rad/m] of the layer as it is; exactly zero where it is zero to round-off."""
        rate = relative_turn_rate(layer.core_radius, self.twist_rate, layer.lay, layer.hand)
        return 0.0 if abs(rate) <= 1e-12 * abs(self.twist_rate) else rate

    def rate_at(self, layer: LayeredLay, angle: float) -> float:
        """omega at a signed lay angle [rad]; grows with the angle."""
        q = self._stretch(layer)
        return float(np.tan(np.clip(angle, -STEEPEST, STEEPEST))) / layer.radius * q - self.twist_rate / q

    def longest_lay(self) -> float:
        """Longest of all lays [m], the cell's own among them."""
        rates = [lay_rate(layer.lay, layer.hand) for layer in self.layers] + [self.twist_rate]
        return max(2 * np.pi / abs(rate) for rate in rates if rate)

    def matched(self, layer: LayeredLay, turns: int, height: float) -> MatchedLay:
        """The layer with the lay that turns by `turns` / fold in `height`."""
        q, nominal = self._stretch(layer), _signed_angle(layer)
        if abs(self.rate(layer) * height * layer.fold / (2 * np.pi) - turns) <= EXACT * max(1, abs(turns)):
            return MatchedLay(layer, turns, layer.lay, layer.hand, 0.0)
        own = (2 * np.pi * turns / (layer.fold * height) + self.twist_rate / q) / q
        if abs(own) <= EXACT * abs(self.twist_rate):
            own = 0.0
        sign = 1 if nominal >= 0 else -1
        change = float(np.arctan(own * layer.radius)) - nominal
        hand = ("Z" if own > 0 else "S") if own else layer.hand
        if layer.lay is None:
            change, sign = abs(change), 1
        return MatchedLay(layer, turns, float(2 * np.pi / abs(own)) if own else None, hand, sign * change)

    def nearest(self, layer: LayeredLay, height: float) -> MatchedLay:
        """The layer with the whole number of turns that changes its lay angle least."""
        turns = self.rate(layer) * height * layer.fold / (2 * np.pi)
        return min((self.matched(layer, k, height) for k in {floor(turns), ceil(turns)}), key=lambda m: abs(m.change))

    def at(self, height: float, tolerance: float) -> CommonPeriod:
        """The period of a given height, or an error."""
        period = CommonPeriod(height, self.twist_rate, tuple(self.nearest(layer, height) for layer in self.layers))
        if period.largest_change > tolerance:
            free = all(self.rate(layer) == 0 for layer in self.layers)
            other = None if free else self._shortest(tolerance, max(self.longest_lay(), 4 * height))
            advice = [] if other is None else [f"take a height of {_mm(other.height)}"]
            raise GeometryError(_refusal(f"at a height of {_mm(height)}", period, tolerance, advice))
        return period

    def best(self, tolerance: float, longest: float) -> CommonPeriod:
        """The period of the module's rule, or an error with what would do."""
        period = self._shortest(tolerance, longest)
        if period is not None:
            return period
        advice = []
        longer = self._shortest(tolerance, 20 * longest)
        if longer is not None:
            advice.append(f"allow a period of {_mm(_rounded_up(longer.height))}")
        nearest = self._nearest(tolerance, longest)
        if nearest is None:
            advice = advice or ["lengthen the period that is allowed"]
            raise GeometryError(f"the lays have no common period up to {_mm(longest)}: {', or '.join(advice)}.")
        raise GeometryError(
            _refusal(f"at {_mm(nearest.height)}, the best period up to {_mm(longest)},", nearest, tolerance, advice)
        )

    def _shortest(self, tolerance: float, longest: float) -> CommonPeriod | None:
        """Straight members kept straight if possible; of all periods up to ECONOMY times the shortest the one of least change."""
        for adjust_straight in (False, True):
            found, limit = [], longest
            for turns in self._combinations(tolerance, longest, adjust_straight):
                height = self._least_change(turns, tolerance, longest, adjust_straight)
                if height > limit:
                    continue
                parts = [self.matched(layer, k, height) for layer, k in zip(self.layers, turns, strict=True)]
                found.append(CommonPeriod(height, self.twist_rate, tuple(parts)))
                limit = min(limit, ECONOMY * height * (1 + EXACT))
            found = [period for period in found if period.height <= limit]
            if found:
                return min(found, key=lambda p: (round(p.largest_change, 9), p.height))
        return None

    def _nearest(self, tolerance: float, longest: float) -> CommonPeriod | None:
        """The period of least change up to `longest` where none is within the tolerance: bisection on the tolerance."""
        low, high, found = tolerance, STEEPEST, None
        while high - low > 1e-4:
            middle = 0.5 * (low + high)
            turns = next(self._combinations(middle, longest, True), None)
            if turns is None:
                low = middle
                continue
            height = self._least_change(turns, middle, longest, True)
            parts = [self.matched(layer, k, height) for layer, k in zip(self.layers, turns, strict=True)]
            found = CommonPeriod(height, self.twist_rate, tuple(parts))
            high = min(middle, found.largest_change)
        return found

    def _heights(self, layer: LayeredLay, turns: int, change: float, adjust_straight: bool) -> tuple[float, float]:
        """Heights at which a number of turns changes the lay angle by no more than `change`; low > high if there are none."""
        low, high = self._rates(layer, change, adjust_straight)
        if turns == 0:
            return (0.0, inf) if low <= 0 <= high else (inf, 0.0)
        if turns < 0:
            low, high = -high, -low
        if high <= 0:
            return inf, 0.0
        full = 2 * np.pi * abs(turns) / layer.fold
        slack = EXACT if low == high else 0.0
        return full / high * (1 - slack), full / low * (1 + slack) if low > 0 else inf

    def _rates(self, layer: LayeredLay, change: float, adjust_straight: bool) -> tuple[float, float]:
        if change == 0 or (layer.lay is None and not adjust_straight):
            return self.rate(layer), self.rate(layer)
        angle = _signed_angle(layer)
        return self.rate_at(layer, angle - change), self.rate_at(layer, angle + change)

    def _combinations(self, change: float, longest: float, adjust_straight: bool) -> Iterator[tuple[int, ...]]:
        """Numbers of turns of all layers for which some height up to `longest` needs no larger change; shortest first.

        Walks through the layers from the one that asks for most; heights are bounded by ECONOMY times the first find.
        """
        spans = [self._rates(layer, change, adjust_straight) for layer in self.layers]
        rigid = [low == high for low, high in spans]
        order = sorted(
            range(len(spans)),
            key=lambda j: (not rigid[j], 0.0 if rigid[j] else self.layers[j].fold * max(map(abs, spans[j]))),
        )
        limit = longest

        def walk(depth: int, low: float, high: float, turns: dict[int, int]) -> Iterator[tuple[int, ...]]:
            nonlocal limit
            if depth == len(order):
                if low > 0:
                    limit = min(limit, ECONOMY * min(high, longest))
                    yield tuple(turns[j] for j in range(len(order)))
                return
            j = order[depth]
            for k in _whole_turns(self.layers[j].fold, spans[j], low, min(high, limit)):
                a, b = self._heights(self.layers[j], k, change, adjust_straight)
                if max(a, low) <= min(b, high, limit):
                    yield from walk(depth + 1, max(a, low), min(b, high), {**turns, j: k})

        return walk(0, 0.0, longest, {})

    def _least_change(self, turns: Sequence[int], tolerance: float, longest: float, adjust_straight: bool) -> float:
        """Height [m] up to `longest` at which these turns need the smallest largest change."""
        straight = [
            2 * np.pi * k / (item.fold * self.rate(item))
            for item, k in zip(self.layers, turns, strict=True)
            if k and item.lay is None and not adjust_straight
        ]
        if straight:
            return float(np.mean(straight))

        def span(change: float) -> tuple[float, float]:
            pairs = [
                self._heights(item, k, change, adjust_straight) for item, k in zip(self.layers, turns, strict=True)
            ]
            return max(low for low, _ in pairs), min([longest, *(high for _, high in pairs)])

        small, large = 0.0, tolerance
        low, high = span(0.0)
        if low > high:
            while large - small > 1e-13:
                middle = 0.5 * (small + large)
                low, high = span(middle)
                small, large = (middle, large) if low > high else (small, middle)
            low, high = span(large)
        return 0.5 * (low + high)

    def _stretch(self, layer: LayeredLay) -> float:
        return float(np.sqrt(1 + (layer.core_radius * self.twist_rate) ** 2))


def _whole_turns(fold: int, rates: tuple[float, float], low: float, high: float) -> list[int]:
    """Whole numbers k = fold omega H / 2 pi that can occur for the rates and heights of two intervals, smallest in size first."""
    ends = [fold * rate * height / (2 * np.pi) for rate in rates for height in (low, high)]
    return sorted(range(ceil(min(ends) - 1e-6), floor(max(ends) + 1e-6) + 1), key=abs)


def _signed_angle(layer: LayeredLay) -> float:
    return float(np.arctan(lay_rate(layer.lay, layer.hand) * layer.radius))


def _refusal(where: str, period: CommonPeriod, tolerance: float, advice: list[str]) -> str:
    """Sentence: which layer changes by how much, and what would do."""
    worst = max(period.layers, key=lambda layer: abs(layer.change))
    old, new = (f"{_mm(lay)}" if lay else "straight" for lay in (worst.nominal.lay, worst.lay))
    needed = np.ceil(np.degrees(period.largest_change) * 100 + 1e-6) / 100
    advice = [*advice, f"a tolerance of {needed:.2f} deg"]
    return (
        f"{where} the lay angle of {worst.name} would change by {np.degrees(worst.change):+.3f} deg (lay from {old} to {new}), more "
        f"than the tolerance of {np.degrees(tolerance):.3g} deg: {', or '.join(advice)}."
    )


def _rounded_up(length: float) -> float:
    """To five digits, upwards, so that advice that is followed works."""
    step = 10 ** (np.floor(np.log10(length)) - 4)
    return float(np.ceil(length / step - EXACT) * step)


def _mm(length: float) -> str:
    return f"{1e3 * length:.5g} mm"
