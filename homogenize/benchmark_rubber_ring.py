r"""The rubber law (case T12) as the limit of many thin members: one sum of E A, shared out to n = 3 .. 48 of them on one circle.

Each member is a plate along the helix, a quarter of the spacing wide and a sixteenth of it thick. It presses into the rubber by
itself, in a field as wide as the spacing: a compliance that falls with 1 / n beside that of the ring,

.. math::  1 / EA_n = 1 / EA_\infty + k / n + O(n^{-2}) .

Where the ring is the surface of the rubber, EA_infinity is the law with even strain; where rubber lies outside the ring, as in the
table of case T12, that rubber gives way and EA_infinity is the ring's (rubber_filled_cable.py): 16 % less than with even strain at
10 deg and nu 0.45, half at 17.2 deg. With free twist both agree within 3 %.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable
from functools import partial

import numpy as np

from geometry.cell_mesh import CrossSectionMesh
from geometry.material import Material
from homogenize.benchmark import Benchmark, Case, band
from homogenize.benchmark_cables import axial_stiffness
from homogenize.benchmark_sections import regions, rings
from homogenize.rubber_filled_cable import RubberRing

MEMBERS = (3, 6, 12, 24, 48)
PER_SPACING = 4
"""Elements round the circle for each member; the member takes one of them."""
SLIMNESS = 0.25
"""Thickness of a member over its width."""
GROWTH = 1.5
"""Of the elements away from the ring."""
SUM_EA = 335e-6 * 80e9
RADIUS = 16e-3
RUBBER = Material("rubber", 8e6, 0.45, 1000.0)


def thin_members(ring: RubberRing, members: int) -> CrossSectionMesh:
    """The rubber cylinder with `members` plates on the ring (inside it, if the ring is the surface)."""
    around = PER_SPACING * members
    width = 2 * np.pi * ring.r / around
    thick = SLIMNESS * width
    outside = ring.outer_radius > ring.r
    inner, outer = (ring.r - thick / 2, ring.r + thick / 2) if outside else (ring.r - thick, ring.r)
    within = [x for x in _graded(inner, 0.0, width) if x > 0][::-1]
    radii = [*within, inner, outer, *(_graded(outer, ring.outer_radius, width) if outside else [])]
    rubber = ring.rubber.E, ring.rubber.nu
    mesh = rings(radii, *[rubber] * len(radii), per_ring=1, around=around, twist_rate=np.tan(ring.beta) / ring.r)
    column = np.concatenate([np.arange(around)] + [np.repeat(np.arange(around), 2)] * (len(radii) - 1))
    member = (mesh.region_of == len(within) + 1) & (column % PER_SPACING == 0)
    area = np.pi * (outer**2 - inner**2) / PER_SPACING
    E = ring.conductors / (area * np.cos(ring.beta))  # the plane z = 0 cuts a member of area A in A / cos(beta)
    return dataclasses.replace(mesh, region_of=member.astype(int), regions=regions(rubber, (E, 0.33)))


def _graded(start: float, end: float, first: float) -> list[float]:
    """Radii from `start` (not listed) to `end`, the steps growing from `first`."""
    found, step = [start], first
    while abs(end - found[-1]) > GROWTH * step:
        found.append(found[-1] + float(np.sign(end - start)) * step)
        step *= GROWTH
    return [*found[1:], end]


def shared_out(degrees: float, outer_radius: float) -> Iterable[Benchmark]:
    """EA rises towards the ring's with the number of members; the extra compliance halves when they double."""
    ring = RubberRing(SUM_EA, RADIUS, float(np.radians(degrees)), RUBBER, outer_radius)
    area = np.pi * outer_radius**2
    name = f"T12 thin members, {degrees:g} deg, r / R = {RADIUS / outer_radius:.2g}"
    found = [axial_stiffness(thin_members(ring, n)) for n in MEMBERS]
    low = RUBBER.E * area
    for n, (blocked, _) in zip(MEMBERS, found, strict=True):
        what = f"EA/A blocked, {n} members [MPa]"
        yield band(name, "rubber alone, ring", what, 1e-6 * low / area, 1e-6 * ring.EA() / area, 1e-6 * blocked / area)
        low = blocked
    last, before = (1 / found[-1][0], 1 / found[-2][0])
    limit = 1 / ring.EA()
    ratio = (before - limit) / (last - limit)
    yield Benchmark(name, "1 / n", "extra compliance, 24 over 48 members [-]", 2.0, ratio, 0.02)
    many = 1e-6 / (2 * last - before) / area
    yield Benchmark(name, "ring of members", "EA/A blocked, many members [MPa]", 1e-6 * ring.EA() / area, many, 5e-3)
    if outer_radius > RADIUS:  # without rubber outside, the members' own bending is what is left
        free = 1e-6 * ring.EA(free_twist=True) / area, 1e-6 * found[-1][1] / area
        yield Benchmark(name, "ring of members", "EA/A free, 48 members [MPa]", *free, 0.01)


def rubber_ring_cases() -> tuple[Case, ...]:
    """The ring inside the rubber, as in the table, at two lay angles; and on its surface."""
    return tuple(
        Case(f"T12 thin members, {b:g} deg, R {1e3 * R:g} mm", "rubber ring", partial(shared_out, b, R))
        for b, R in ((10.0, 34e-3), (17.2, 34e-3), (10.0, RADIUS))
    )
