"""Section with holes for conductors that turn: nodes of the holes solve Kepler's equation, everything else keeps its area."""

from dataclasses import replace

import numpy as np
import pytest

from geometry import MeshError, read_cable, region_sizes, scaled_jacobian
from geometry.host_section import Hole, host_section, layer_round
from geometry.wire_trace import WireTrace

RATE = 27.0


@pytest.fixture(scope="module")
def cable():
    return read_cable("mcpt-1.9-3.3-3x35")


@pytest.fixture(scope="module")
def holes(cable):
    found = {f"power core {k} conductor": Hole(5.1e-3, 36, RATE) for k in (1, 2, 3)}
    return found | {"earth conductor": Hole(3.5e-3, 54, -cable.twist_rate)}


@pytest.fixture(scope="module")
def section(cable, holes):
    return host_section(cable, holes, 2e-3)


def test_nodes_of_a_hole_stand_at_equal_steps_of_keplers_equation(cable, holes, section):
    """phi - omega R s sin(phi) = 2 pi j / N on the exact trace; the shift is seen: it is 2 degrees on the power cores."""
    for name, hole in holes.items():
        part, nodes = cable.part(name), section.rings[name]
        trace = WireTrace(part.centre_radius, part.phase, hole.radius, part.twist_rate)
        points = section.mesh.points[nodes]
        phi = trace.nearest(points)
        np.testing.assert_allclose(points, trace.point(phi), atol=1e-12)
        eccentricity = hole.turn_rate * hole.radius * np.sin(trace.lay_angle)
        expected = 2 * np.pi * np.arange(hole.nodes) / hole.nodes
        turn = phi - eccentricity * np.sin(phi) - expected
        np.testing.assert_allclose((turn + np.pi) % (2 * np.pi), np.pi, atol=1e-9)
        if part.centre_radius:
            assert np.degrees(np.abs(eccentricity)) > 2


def test_the_holes_and_the_rest_fill_the_cable(cable, holes, section):
    """Conductors have no cells, other parts the areas of the section without holes, the layers round the holes what is left."""
    areas = region_sizes(section.mesh)
    for region, area in zip(section.mesh.regions, areas, strict=True):
        part = cable.part(region.name)
        round_holes = [name for name in holes if layer_round(cable, cable.part(name)).name == region.name]
        expected = part.area
        if region.name in holes:
            expected = 0.0
        for name in round_holes:
            conductor, hole = cable.part(name), holes[name]
            widened = WireTrace(conductor.centre_radius, conductor.phase, hole.radius, conductor.twist_rate)
            polygon = np.sin(2 * np.pi / hole.nodes) / (2 * np.pi / hole.nodes)  # of the hole's circle
            expected = part.area + conductor.area - widened.area * polygon
        assert area == pytest.approx(expected, rel=6e-3, abs=1e-12)


def test_no_element_is_inside_out(section):
    assert scaled_jacobian(section.mesh).min() > 0.1


@pytest.mark.parametrize(
    ("hole", "message"),
    [
        (Hole(4.0e-3, 36, RATE), "must have a radius between"),
        (Hole(7.0e-3, 36, RATE), "must have a radius between"),
        (Hole(5.1e-3, 35, RATE), "even number of nodes"),
    ],
)
def test_a_hole_that_does_not_fit_is_refused(cable, hole, message):
    with pytest.raises(MeshError, match=message):
        host_section(cable, {"power core 1 conductor": hole}, 2e-3)


def test_a_bare_conductor_is_refused(cable):
    bare = replace(cable, parts=tuple(p for p in cable.parts if p.name != "earth cover"))
    with pytest.raises(MeshError, match="no layer round it"):
        host_section(bare, {"earth conductor": Hole(3.5e-3, 54, RATE)}, 2e-3)
