"""What a hidden truth is, and how truths are put together: rig outside section outside sensor.

.. math::
    \\varepsilon = \\text{fixture}(u/L) - \\text{give}(F)/L,\\quad
    F = K\\Bigl[\\prod_i m_i\\,\\bigl(\\varepsilon + \\sum_i e_i(\\varepsilon)\\bigr) + \\sum_i h_i(\\varepsilon)\\Bigr],\\quad
    y = \\text{sensor}(F)

A truth changes one of these places and leaves the others alone. With a load prescribed, the path that gives it is found
by a fixed-point iteration over whole records; causal laws keep it causal.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, ClassVar, Self

import numpy as np

from benchmarks.blind.bench import Array, Bench

_ROUNDS = 60


@dataclass(frozen=True)
class Truth:
    """One hidden effect: its name (of the contract, or any other for one outside), its variant, how large, its numbers.

    `size` is zero for the linear model; everything else that a law needs stands in `numbers`, drawn by :meth:`draw`.
    """

    variant: str
    size: float
    numbers: dict[str, Any]

    effect: ClassVar[str] = ""
    variants: ClassVar[tuple[str, ...]] = ()
    kinds: ClassVar[tuple[str, ...]] = ("tension", "torsion", "bending")
    largest: ClassVar[float] = 5.0
    """Beyond this size the law has no meaning."""

    @classmethod
    def draw(cls, rng: np.random.Generator, bench: Bench, variant: str | None = None) -> Self:
        """A truth of this effect with random numbers."""
        chosen = variant or str(rng.choice(cls.variants))
        if chosen not in cls.variants:
            raise ValueError(f"{cls.effect} has no variant {chosen!r}; it has {', '.join(cls.variants)}.")
        return cls(chosen, 0.1, cls.numbers_for(rng, bench, chosen))

    @classmethod
    def numbers_for(cls, rng: np.random.Generator, bench: Bench, variant: str) -> dict[str, Any]:
        return {}

    def of_size(self, size: float) -> Self:
        return replace(self, size=size)

    def fixture(self, bench: Bench, strain: Array) -> Array:
        """Strain that the specimen sees when the rig is told `strain`."""
        return strain

    def give(self, bench: Bench, load: Array) -> Array:
        """Displacement of the frame under the load, divided by the specimen length."""
        return np.zeros(1)

    def elastic(self, bench: Bench, strain: Array) -> Array:
        """What the elastic curve has beside the straight line [strain]."""
        return np.zeros(1)

    def factor(self, bench: Bench, strain: Array) -> Array:
        """What the elastic part is multiplied with."""
        return np.ones(1)

    def extra(self, bench: Bench, strain: Array) -> Array:
        """What acts beside the elastic part [strain]."""
        return np.zeros(1)

    def cross(self, bench: Bench, strain: Array) -> Array:
        """Torque of a tension test or force of a torsion test, over (radius x stiffness) or stiffness / radius [strain]."""
        return np.zeros(1)

    def sensor(self, bench: Bench, load: Array) -> Array:
        """What the sensor of the load (or, with a load prescribed, of the path) makes of it."""
        return load


def section_load(bench: Bench, truths: Sequence[Truth], strain: Array) -> Array:
    """Load of the section under a strain history."""
    elastic, factor, extra = strain, np.ones(1), np.zeros(1)
    for truth in truths:
        elastic = elastic + truth.elastic(bench, strain)
        factor = factor * truth.factor(bench, strain)
        extra = extra + truth.extra(bench, strain)
    return bench.stiffness * (factor * elastic + extra)


def _through_fixture(bench: Bench, truths: Sequence[Truth], path: Array) -> tuple[Array, Array]:
    """Strain and load of the specimen in the rig."""
    strain = path
    for truth in truths:
        strain = truth.fixture(bench, strain)
    load = section_load(bench, truths, strain)
    if all(type(truth).give is Truth.give for truth in truths):
        return strain, load
    for _ in range(_ROUNDS):
        given = sum(truth.give(bench, load) for truth in truths)
        new = section_load(bench, truths, strain - given)
        change = np.abs(new - load).max()
        load = 0.5 * (load + new)
        if change < 1e-9 * np.abs(load).max():
            break
    return strain - sum(truth.give(bench, load) for truth in truths), load


def respond(bench: Bench, truths: Sequence[Truth]) -> dict[str, Array]:
    """The channels without noise, (C, n): ``main`` (load; with load control the path per length) and ``cross``."""
    if bench.load_control:
        wanted = bench.stiffness * bench.strain
        path = bench.strain.copy()
        for _ in range(2 * _ROUNDS):
            miss = (wanted - _through_fixture(bench, truths, path)[1]) / bench.stiffness
            path = path + 0.7 * miss
            if np.abs(miss).max() < 1e-9 * bench.scale:
                break
        strain, main = path, path
    else:
        strain, main = _through_fixture(bench, truths, bench.strain)
    for truth in truths:
        main = truth.sensor(bench, main)
    return {"main": main, "cross": np.zeros_like(main) + sum((t.cross(bench, strain) for t in truths), np.zeros(1))}
