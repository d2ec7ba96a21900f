"""The models of the 1 + m strand on everything that is printed of them: sweep of the lay angle (T6), other angles and strands (T5).

Sweep: R1 = 1, R2 = 0.967, nu 0.3, dimensionless. Others: the strand of case T5 at more lay angles and without radial contraction, a
strand of 230 mm pitch, and the example of Costello's book in inch and pound (Theory of Wire Rope, 2nd ed. 1997, chapter 3).
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from homogenize.benchmark import Benchmark, Case, components
from homogenize.benchmark_strand import seven_wire
from homogenize.strand_theory import Strand16, costello, energy_consistent, free_twist

TABLE = "verification table"
SWEEP = {
    2.5: (0.99661, 0.02475, 0.02189, 0.99758, 0.02477, 0.02189),
    5.0: (0.98652, 0.04901, 0.02421, 0.99035, 0.04919, 0.02422),
    7.5: (0.96994, 0.07233, 0.02801, 0.97842, 0.07291, 0.02805),
    10.0: (0.94721, 0.09425, 0.03318, 0.96195, 0.09561, 0.03329),
    12.5: (0.91881, 0.11439, 0.03958, 0.94117, 0.11698, 0.03984),
    15.0: (0.88530, 0.13239, 0.04703, 0.91638, 0.13673, 0.04754),
    17.5: (0.84734, 0.14796, 0.05533, 0.88792, 0.15460, 0.05625),
    20.0: (0.80566, 0.16087, 0.06426, 0.85616, 0.17038, 0.06577),
    25.0: (0.71424, 0.17815, 0.08310, 0.78452, 0.19498, 0.08641),
    30.0: (0.61733, 0.18377, 0.10165, 0.70515, 0.20959, 0.10773),
}
"""kee/EA, ket/(EA R), ktt/(EA R^2) of the energy model, then of the rigid one, by lay angle [deg]."""
RIGID = {
    9.2: (1.41489e7, 7.35070e6, 1.48695e7, 1.05151e7),
    11.834: (1.38499e7, 9.25803e6, 1.79574e7, 9.07687e6),
    17.0: (1.30768e7, 1.25616e7, 2.57714e7, 6.95400e6),
}
"""kee, ket, ktt and EA with free rotation without radial contraction; N and mm."""
BETWEEN = {
    12.2: ((1.36468e7, 9.45103e6, 8.93402e6, 1.80168e7, 8.96034e6), (1.34923e7, 9.31262e6, 1.83293e7, 8.76083e6)),
    14.0: ((1.33532e7, 1.06306e7, 1.00172e7, 2.04019e7, 8.13369e6), (1.31549e7, 1.04253e7, 2.07897e7, 7.92702e6)),
    16.2: ((1.29506e7, 1.19585e7, 1.12171e7, 2.36302e7, 7.27393e6), (1.26946e7, 1.16486e7, 2.41065e7, 7.06578e6)),
}
"""Costello kee, ket, kte, ktt, EA free, and the energy model kee, ket, ktt, EA free; N and mm."""
FOUR = ("kee [N]", "ket [N mm]", "ktt [N mm2]", "EA, rotation free [N]")
FIVE = (FOUR[0], FOUR[1], "kte [N mm]", *FOUR[2:])


def _symmetric(K: np.ndarray) -> tuple[float, float, float, float]:
    return float(K[0, 0]), float(K[0, 1]), float(K[1, 1]), free_twist(K)


def sweep() -> Iterable[Benchmark]:
    """Half of the fifth printed decimal."""
    names = ("kee / EA", "ket / (EA R)", "ktt / (EA R2)")
    for degrees, row in SWEEP.items():
        strand = Strand16(1.0, 0.967, float(np.radians(degrees)), 1.0, 0.3)
        R = strand.core + 2 * strand.wire
        scale = strand.EA * np.array([1.0, R, R**2])
        for model, printed, contracts in (("energy", row[:3], True), ("rigid", row[3:], False)):
            found = np.array(_symmetric(energy_consistent(strand, contracts))[:3]) / scale
            name = f"T6 sweep, {model} model, {degrees:g} deg"
            yield from components(name, TABLE, names, printed, found, 5.1e-6, scale=1.0)


def other_angles() -> Iterable[Benchmark]:
    """The printed digits, as for the three main angles."""
    for degrees, row in RIGID.items():
        found = _symmetric(energy_consistent(seven_wire(degrees), contraction=False))
        yield from components(f"T5 rigid model, {degrees} deg", TABLE, FOUR, row, found, 2e-5)
    for degrees, (of_costello, of_energy) in BETWEEN.items():
        K, E = costello(seven_wire(degrees)), energy_consistent(seven_wire(degrees))
        found = (*K.ravel(), free_twist(K))
        yield from components(f"T5 Costello, {degrees} deg", TABLE, FIVE, of_costello, found, 2e-5)
        yield from components(f"T5 energy model, {degrees} deg", TABLE, FOUR, of_energy, _symmetric(E), 2e-5)


def other_strands() -> Iterable[Benchmark]:
    """Half of the sixth digit; the book's inputs are rounded."""
    long = Strand16(2.675, 2.59, float(np.arctan(2 * np.pi * 5.265 / 230)), 188e3, 0.3)
    name, digits = "T5 strand of pitch 230 mm", 3.1e-6
    printed = (2.71385e7, 1.73788e7, 1.64989e7, 5.00517e7)
    yield from components(f"{name}, Costello", TABLE, FIVE[:4], printed, costello(long).ravel(), digits)
    for model, printed, contracts in (
        ("energy model", (2.69982e7, 1.72643e7, 5.06303e7), True),
        ("rigid model", (2.72794e7, 1.74307e7, 5.07148e7), False),
    ):
        found = _symmetric(energy_consistent(long, contracts))[:3]
        yield from components(f"{name}, {model}", TABLE, FOUR[:3], printed, found, digits)
    book = Strand16(0.103, 0.101, float(np.arctan(2 * np.pi * 0.204 / 9.75)), 28.5e6, 0.25)
    names = ("kee [lb]", "ket [lb in]", "kte [lb in]", "ktt [lb in2]")
    printed = (6.26823e6, 142761.0, 135353.0, 17114.0)
    yield from components("T5 example of Costello's book", TABLE, names, printed, costello(book).ravel(), 3e-5)


def strand_sweep_cases() -> tuple[Case, ...]:
    """Sweep, angles, strands."""
    return (
        Case("T6 sweep of the lay angle", TABLE, sweep),
        Case("T5 other lay angles", TABLE, other_angles),
        Case("T5 other strands", TABLE, other_strands),
    )
