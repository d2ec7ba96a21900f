"""A specimen from few snapshots: exact at them, near between them, and exact under a turn of the section."""

from dataclasses import replace

import numpy as np
import pytest

from geometry import cross_section_mesh, read_cable
from homogenize.specimen import AxialGrading, Specimen
from homogenize.specimen.reduced_basis import ReducedBasis, ReducedPlace, grow
from homogenize.specimen.unit_response import unit_response

GRADING = AxialGrading(end_size=0.5, largest=1.0, growth=2.0, degree=2)


@pytest.fixture(scope="session")
def basis() -> ReducedBasis:
    """A helical rod with a core of its own; four corners of the box are offered, three are taken."""
    mesh = cross_section_mesh(read_cable("helical-rod"))
    centre = mesh.points[mesh.cells].mean(axis=1) - mesh.points.mean(axis=0)
    inner = np.hypot(*centre.T) < 0.5 * np.hypot(*centre.T).max()
    rod = mesh.regions[0]
    regions = (
        replace(rod, name="inner"),
        replace(rod, name="outer", material=replace(rod.material, E=rod.material.E / 5)),
    )
    radius = float(np.hypot(*centre.T).max())
    points = mesh.points - mesh.points.mean(axis=0) + np.array([0.2 * radius, 0.0])
    mesh = replace(mesh, points=points, regions=regions, region_of=np.where(inner, 0, 1), twist_rate=0.05 / radius)
    length = 12 * radius
    made = ReducedBasis(mesh, [0, 1], Specimen(length, grading=GRADING), tolerance=1e-7)
    t = mesh.twist_rate
    corners = [
        ReducedPlace((a, b), w * t, f * length)
        for a, b, w, f in ((1, 1, 1, 1), (2, 0.6, 0.8, 1.2), (0.5, 1.5, 1.2, 0.8), (1.5, 1.5, 0.8, 0.8))
    ]
    gaps = grow(made, corners, 3)
    assert np.isinf(gaps[0]) and min(gaps[1:]) > 0
    return made


def test_exact_at_a_snapshot(basis):
    """Galerkin on a space that holds the solution gives the solution; the small sum of matrices is the large one."""
    place = basis.places[0]
    full, small = unit_response(basis.full(place)), basis.evaluate(place)
    assert small.mean == pytest.approx(full.mean, rel=1e-4, abs=1e-4 * np.abs(full.mean).max())  # solver 1e-6 in energy
    for name, value in full.outputs(2000.0, 500.0, 0.3).items():
        assert small.outputs(2000.0, 500.0, 0.3)[name] == pytest.approx(value, rel=2e-3), name
    assert basis.residual(place) < 1e-3


def test_near_between_the_snapshots_and_never_softer(basis):
    """At a place between, F.u of the projection is at most that of the specimen (Cea), and within 2 % of it."""
    place = ReducedPlace((1.2, 0.9), 1.03 * basis.mesh.twist_rate, 1.05 * basis.places[0].length)
    full, small = unit_response(basis.full(place)), basis.evaluate(place)
    for load, component in ((0, 2), (1, 0), (2, 1)):
        ratio = small.mean[component, load] / full.mean[component, load]
        assert 0.98 < ratio < 1 + 1e-5


def test_quarter_turn_swaps_the_planes(basis):
    """Exactly: the held end does not know how the section was turned."""
    response = basis.evaluate(basis.places[0])
    a, b = response.outputs(2000.0, 500.0, 0.2), response.outputs(2000.0, 500.0, 0.2 + np.pi / 2)
    assert (a["G_yoz"], a["u_x"]) == pytest.approx((b["G_xoz"], b["u_y"]), rel=1e-10)
    assert pytest.approx(b["E"], rel=1e-12) == a["E"]


def test_stiffness_times_two_halves_the_displacement(basis):
    """All moduli by a factor: the compliance by its inverse, where every region moves."""
    groups = [0] * len(basis.mesh.regions)
    every = ReducedBasis(basis.mesh, groups, basis.specimen, tolerance=1e-7)
    place = ReducedPlace((1.0,), basis.mesh.twist_rate, basis.places[0].length)
    every.add(place)
    double = ReducedPlace((2.0,), place.twist_rate, place.length)
    assert every.evaluate(double).mean == pytest.approx(every.evaluate(place).mean / 2, rel=1e-9)
