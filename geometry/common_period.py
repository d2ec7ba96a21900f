r"""Common period of nested lays: the height after which everything in a cable stands as before, and the nearest lays that have one.

A cell of height H whose ends are joined by the motion x -> R_z(Omega H) x + H e_z serves a layer when that motion carries
the layer into itself. A layer of `fold` equal members that turns at the rate omega against the motion does so when

.. math::  \omega H = 2\pi k / \mathrm{fold}, \qquad k \text{ whole} .

About the cable axis omega = h 2 pi / p - Omega; for a pure translation (Omega = 0) this is the rule l = k_j p_j / n_j of
Menard and Cartraud, Marine Structures 91 (2023) 103465. For strands of a conductor on a core helix omega is the turn
rate in the core's own frame (bent_lay.py), and Omega the cabling rate. Lays drawn from a real cable are never exactly
commensurate: they are adjusted. With omega given, the lay follows from h 2 pi / p = (omega + Omega / q) / q,
q = sqrt(1 + (r Omega)^2), and the lay angle from tan beta = 2 pi radius / p.

Which period is taken: the shortest at which no lay angle changes by more than the tolerance counts as the measure; of
all periods up to `ECONOMY` times that one, the one with the smallest largest change is chosen. For a combination of
whole numbers k the smallest largest change is found exactly, by bisection on the change that makes the intervals of H
that the layers allow overlap. Straight members stay straight where that is possible, else they are given a long lay.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import reduce
from math import ceil, floor, gcd, inf

import numpy as np

from geometry.bent_lay import lay_rate, relative_turn_rate
from geometry.cable import Cable
from geometry.errors import GeometryError
from geometry.helix import lay_angle
from geometry.strand import layer_radii

TOLERANCE = float(np.radians(0.5))
"""Change of a lay angle [rad] that is accepted when nothing else is asked for."""

ECONOMY = 1.25
"""A period may be longer than the shortest acceptable one by this factor if that lessens the changes."""

EXACT = 1e-9
"""Relative precision to which straight members, which are not adjusted, have to match a period."""

STEEPEST = float(np.radians(80.0))


@dataclass(frozen=True)
class LayeredLay:
    """A layer of `fold` equal members at the `radius` [m] from the line they are laid on.

    Attributes
    ----------
    name : for reports
    radius : of the members' centres about the cable axis, or about the centre line of their conductor [m]
    lay : [m], None for straight members; hand "Z" or "S"
    fold : rotational symmetry, the number of members in the layer
    core_radius : radius [m] of the core helix on which the conductor lies; 0 on the cable axis
    """

    name: str
    radius: float
    lay: float | None
    hand: str
    fold: int
    core_radius: float = 0.0

    def __post_init__(self) -> None:
        lay_rate(self.lay, self.hand)
        if not (np.isfinite(self.radius) and self.radius > 0 and self.core_radius >= 0):
            raise GeometryError(f"{self.name}: the radius of a layer must be positive, found {self.radius:g} m.")
        if self.fold < 1 or int(self.fold) != self.fold:
            raise GeometryError(f"{self.name}: a layer needs a whole number of members, found {self.fold}.")

    @property
    def lay_angle(self) -> float:
        """Lay angle [rad], not signed."""
        return lay_angle(self.radius, self.lay)


@dataclass(frozen=True)
class MatchedLay:
    """A layer whose `lay` [m] has been adjusted to a period, in which it goes on by `turns` / fold of a turn.

    `nominal` is the layer as it was; `change` [rad] of its lay angle, positive where it became steeper.
    """

    nominal: LayeredLay
    turns: int
    lay: float | None
    hand: str
    change: float

    @property
    def name(self) -> str:
        """Name of the layer."""
        return self.nominal.name

    @property
    def fold(self) -> int:
        """Rotational symmetry of the layer."""
        return self.nominal.fold

    @property
    def lay_angle(self) -> float:
        """Adjusted lay angle [rad], not signed."""
        return lay_angle(self.nominal.radius, self.lay)


@dataclass(frozen=True)
class CommonPeriod:
    """The period: `height` [m], `twist_rate` [rad/m] of the motion that joins the ends of the cell, and the matched layers."""

    height: float
    twist_rate: float
    layers: tuple[MatchedLay, ...]

    @property
    def largest_change(self) -> float:
        """Largest change of a lay angle [rad], not signed; 0 without layers."""
        return max((abs(layer.change) for layer in self.layers), default=0.0)

    def layer(self, name: str, core_radius: float | None = None) -> MatchedLay:
        """The layer of that name, on that core radius [m] if several cores carry the same conductor.

        Raises
        ------
        GeometryError
            If there is none.
        """
        for layer in self.layers:
            if layer.name == name and (core_radius is None or abs(layer.nominal.core_radius - core_radius) < 1e-9):
                return layer
        raise GeometryError(
            f'the common period has no layer "{name}"; known are {", ".join(item.name for item in self.layers)}.'
        )


def common_period(
    layers: Sequence[LayeredLay],
    reference: str | None = None,
    *,
    twist_rate: float = 0.0,
    tolerance: float = TOLERANCE,
    longest: float | None = None,
    height: float | None = None,
) -> CommonPeriod | None:
    """Nearest commensurate lays and their common period; None where every height will do, because no layer turns.

    Parameters
    ----------
    layers : the layers that have to match
    reference : layer that the cell's motion follows, so that only turning relative to it counts; None for `twist_rate`
    twist_rate : of the cell's motion [rad/m], signed; 0 for a pure translation
    tolerance : largest accepted change of a lay angle [rad]
    longest : longest accepted period [m]; None takes the longest lay there is
    height : period to match [m] instead of a search; the nearest whole numbers of turns are taken

    Raises
    ------
    GeometryError
        If a lay angle would change by more than the tolerance; names the layer, and the longer period or the larger
        tolerance that would do.

    Examples
    --------
    Two layers of wires that need 0.6 m together, of which a thirtieth will do:

    >>> inner = LayeredLay("inner", 0.020, 0.300, "Z", 30)
    >>> outer = LayeredLay("outer", 0.024, 0.402, "S", 40)
    >>> cell = common_period([inner, outer])
    >>> round(cell.height, 5), [layer.turns for layer in cell.layers]
    (0.01002, [1, -1])
    """
    _check(tolerance, longest, height, twist_rate)
    if reference is not None:
        followed = next((layer for layer in layers if layer.name == reference), None)
        if followed is None:
            raise GeometryError(
                f'there is no layer "{reference}" to follow; known are {", ".join(l.name for l in layers)}.'
            )
        twist_rate = lay_rate(followed.lay, followed.hand)
    search = _Search(tuple(layers), twist_rate)
    if height is not None:
        return search.at(height, tolerance)
    if all(search.rate(layer) == 0 for layer in layers):
        return None
    return search.best(tolerance, longest or search.longest_lay())


def cell_of(cable: Cable, longest: float | None = None, tolerance: float = TOLERANCE) -> CommonPeriod | None:
    """Period of a cable whose conductors have strands, or which has wires of several lays: the cabling lay is kept.

    A conductor that lies in several cores of one radius counts once, with one lay for all its layers; the angle that
    counts is that of its outer strands. Conductors given as one cylinder ask for nothing.

    Parameters
    ----------
    longest : longest accepted period [m]; None takes the longest lay in the cable
    tolerance : largest accepted change of a lay angle [rad]

    Returns
    -------
    CommonPeriod or None
        Layers carry the name of the conductor or of the layer of wires. None if no part turns relative to the
        cable's section: then every height is a period.

    Raises
    ------
    GeometryError
        As `common_period`.

    Examples
    --------
    >>> from geometry import read_cable
    >>> cell = cell_of(read_cable("mcpt-1.9-3.3-3x35"))
    >>> round(1e3 * cell.height, 3), round(1e3 * cell.layer("power").lay, 2), cell.layer("power").turns
    (78.0, 125.42, 2)
    """
    return common_period(_layers_of(cable), twist_rate=cable.twist_rate, tolerance=tolerance, longest=longest)


def _layers_of(cable: Cable) -> list[LayeredLay]:
    """Stranded conductors by name and core radius, and layers of wires laid about the cable axis."""
    found: dict[tuple[str, float], LayeredLay] = {}
    wires = [part.layer for part in cable.parts]
    for part in cable.parts:
        conductor = cable.conductor_of(part)
        if part.layer is not None:
            lay = 2 * np.pi / abs(part.twist_rate) if part.twist_rate else None
            hand = "S" if part.twist_rate < 0 else "Z"
            layer = LayeredLay(part.layer, part.centre_radius, lay, hand, wires.count(part.layer))
            found.setdefault((part.layer, 0.0), layer)
        elif conductor is not None and conductor.strand is not None and sum(conductor.layers) > 1:
            radius = layer_radii(conductor.layers, conductor.strand.diameter, conductor.name)[-1]
            fold = reduce(gcd, [count for count in conductor.layers if count > 1])
            r = part.centre_radius
            layer = LayeredLay(conductor.name, radius, conductor.lay, conductor.hand, fold, r)
            found.setdefault((conductor.name, round(r, 9)), layer)
    return list(found.values())


@dataclass(frozen=True)
class _Search:
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


def _check(tolerance: float, longest: float | None, height: float | None, twist_rate: float) -> None:
    if not (0 <= tolerance < STEEPEST):
        raise GeometryError(
            f"the tolerance of a lay angle must lie between 0 and {np.degrees(STEEPEST):.0f} deg, found {np.degrees(tolerance):.4g} deg."
        )
    for what, length in (("longest period", longest), ("height of a cell", height)):
        if length is not None and not (np.isfinite(length) and length > 0):
            raise GeometryError(f"the {what} must be a positive length, found {length:g} m.")
    if not np.isfinite(twist_rate):
        raise GeometryError(f"the twist rate of a cell must be finite, found {twist_rate:g} rad/m.")


def _rounded_up(length: float) -> float:
    """To five digits, upwards, so that advice that is followed works."""
    step = 10 ** (np.floor(np.log10(length)) - 4)
    return float(np.ceil(length / step - EXACT) * step)


def _mm(length: float) -> str:
    return f"{1e3 * length:.5g} mm"
