"""What a nested cell is made of: period, turn rates, sections of host and conductors, and the number of layers.

The edge length of the section is chosen so that layers of 0.7 to 1.5 times its height give the number of elements that is
asked for. Conductors are meshed finer, by `IN_CONDUCTOR`, and finer again round thin covers.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import reduce
from math import ceil, gcd, lcm

import numpy as np

from geometry.bent_lay import relative_turn_rate
from geometry.cable import Cable, Part
from geometry.common_period import TOLERANCE, cell_of
from geometry.conductor_section import PATCH, ConductorSection, conductor_section
from geometry.errors import MeshError
from geometry.host_section import Hole, HostSection, host_section, layer_round
from geometry.mesh_memory import check_memory
from geometry.section_mesh import DEFAULT_SIZE
from geometry.strand import Conductor
from geometry.turning_conductor import TurningConductor, own_turn_rate

DENSITY = 5.0
"""Cells of a section per (size^2) of its area, refinement at contacts included."""
FLATTEST, TALLEST = 0.7, 1.5
"""Height of a layer over the edge length of the section."""
IN_CONDUCTOR = 0.3
"""Edge length in conductors over that in the bulk of the section."""
COARSEST = 1.25
"""Largest edge length over the default one: beyond, contacts and thin layers decide the number of cells."""
LARGEST_TURN = float(np.radians(9.0))
"""Turn of a section in a layer [rad]; straight edges between planes take a sixth of its square off the area, here 0.4 %."""
SURPLUS = 1.2
"""Elements over those that are asked for, which a coarser section could spare."""
ATTEMPTS = 5
Progress = Callable[[float, str], None]


@dataclass(frozen=True)
class NestedPlan:
    """Period [m], number of layers, section of the host and the conductors that turn."""

    height: float
    layers: int
    host: HostSection
    conductors: tuple[TurningConductor, ...]

    @property
    def cells_per_layer(self) -> int:
        """Cells of a layer; slip rings count as hexahedra."""
        return len(self.host.mesh.cells) + sum(len(c.section.cells) + len(c.section.ring) for c in self.conductors)

    @property
    def hexahedra(self) -> int:
        """Hexahedra of all layers, without the cells of the slip rings that are cut up."""
        cut = sum(len(c.section.ring) * 2 * abs(c.steps(self.height)) for c in self.conductors)
        return self.layers * self.cells_per_layer - cut


def plan_of_cell(
    cable: Cable,
    elements: int | None,
    size: float | None,
    height: float | None,
    layers: int | None,
    lay_tolerance: float | None,
    progress: Progress | None,
    flat_width: float | None = None,
) -> NestedPlan:
    """Arguments and errors as ``nested_cell``."""
    _check_numbers(elements, size, layers)
    cable.check_single_lay()
    height, rates = _period(cable, height, TOLERANCE if lay_tolerance is None else lay_tolerance)
    largest = COARSEST * DEFAULT_SIZE * cable.outer_diameter
    edge = min(largest, _first_size(cable, height, elements, layers)) if size is None else size
    _check_estimate(cable, height, elements, edge, layers)
    best: NestedPlan | None = None
    least = np.inf
    for attempt in range(ATTEMPTS):
        if progress:
            progress(0.8 * attempt / ATTEMPTS, f"meshing the section with edges of {1e3 * edge:.2f} mm")
        plan = _planned(cable, height, rates, edge, elements, layers, flat_width)
        slimness = plan.height / plan.layers / edge
        surplus = 1.0 if elements is None else plan.hexahedra / elements
        misfit = abs(np.log(slimness)) + abs(np.log(surplus))
        if surplus >= 1 and misfit < least:
            best, least = plan, misfit
        good = elements is None or layers is not None or (FLATTEST <= slimness <= TALLEST and surplus < SURPLUS)
        coarsest = edge >= largest and (slimness > TALLEST or surplus >= SURPLUS)
        if size is not None or (surplus >= 1 and (good or coarsest)):
            break
        if layers is not None:
            edge *= 0.97 * float(np.sqrt(surplus))
        else:
            edge *= float(np.clip(np.cbrt(surplus) if surplus >= SURPLUS else np.sqrt(slimness), 0.6, 1.6))
        edge = min(edge, largest)
    if best is None:
        raise MeshError(
            f"{plan.layers} layers of {plan.cells_per_layer} elements make only {plan.hexahedra} hexahedra of the {elements} "
            "that are asked for: leave out the size or the number of layers."
        )
    return best


def _planned(
    cable: Cable,
    height: float,
    rates: dict[str, float],
    edge: float,
    elements: int | None,
    layers: int | None,
    flat_width: float | None,
) -> NestedPlan:
    """The sections for an edge length, and the layers that they need."""
    conductors = _conductors(cable, rates, edge, flat_width)
    holes = {c.part.name: Hole(c.hole_radius, len(c.section.ring), c.turn_rate) for c in conductors}
    host = host_section(cable, holes, edge)
    plan = NestedPlan(height, 1, host, conductors)
    fewest = max([abs(c.steps(height)) + 1 for c in conductors] + [1])
    turn = max([abs(cable.twist_rate)] + [abs(cable.twist_rate + c.turn_rate) for c in conductors]) * height
    fewest = max(fewest, ceil(turn / LARGEST_TURN - 1e-9))
    if layers is None:
        layers = max(fewest, ceil(height / edge - 1e-9))
        if elements is not None:
            cut = plan.cells_per_layer - plan.hexahedra
            layers = max(fewest, ceil((elements + cut) / plan.cells_per_layer))
    if layers < fewest:
        raise MeshError(
            f"{layers} layers are too few for the turning of the strands over {1e3 * height:.4g} mm: take at least {fewest}."
        )
    return NestedPlan(height, layers, host, conductors)


def _conductors(
    cable: Cable, rates: dict[str, float], edge: float, flat_width: float | None
) -> tuple[TurningConductor, ...]:
    found = []
    sections: dict[tuple[str, float], tuple[ConductorSection, float]] = {}
    for name, rate in rates.items():
        part = cable.part(name)
        make_up = _make_up(cable, part)
        assert make_up is not None and make_up.strand is not None
        layer = layer_round(cable, part)
        wall = layer.outer_radius - part.outer_radius
        key = (make_up.name, round(part.centre_radius, 9))
        if key not in sections:
            nodes, radius = ring_nodes(make_up, IN_CONDUCTOR * edge, wall), make_up.strand.diameter / 2
            own = own_turn_rate(part, rate)
            flat = make_up.flat_width if flat_width is None else flat_width
            filled = make_up.voids is not None
            section = conductor_section(
                make_up.layers, radius, part.outer_radius, own, nodes, IN_CONDUCTOR * edge, flat, filled
            )
            step = 2 * np.pi * part.outer_radius / nodes
            sections[key] = section, part.outer_radius + min(1.2 * step, 0.55 * wall)
        section, hole = sections[key]
        found.append(TurningConductor(part, make_up, rate, section, layer.name, hole))
    return tuple(found)


def ring_nodes(make_up: Conductor, edge: float, wall: float) -> int:
    """Nodes round a conductor: even, a multiple of its symmetry, with edges of about `edge` [m], shorter in a thin `wall` [m]."""
    assert make_up.strand is not None
    unit = lcm(2, fold_of(make_up))
    edge = min(edge, max(0.75 * wall, edge / 4))
    fewest = np.pi * make_up.diameter / (0.98 * PATCH * make_up.strand.diameter / 2)
    return unit * max(ceil(fewest / unit), round(np.pi * make_up.diameter / edge / unit))


def fold_of(make_up: Conductor) -> int:
    """Rotational symmetry of the strands of a conductor."""
    return reduce(gcd, [count for count in make_up.layers if count > 1])


def _make_up(cable: Cable, part: Part) -> Conductor | None:
    """Make-up of a conductor of several strands, else None."""
    make_up = cable.conductor_of(part)
    return make_up if make_up is not None and make_up.strand is not None and sum(make_up.layers) > 1 else None


def _period(cable: Cable, height: float | None, tolerance: float) -> tuple[float, dict[str, float]]:
    """Height [m] and turn rate [rad/m] of every stranded conductor, by the name of its part."""
    if height is not None and not (np.isfinite(height) and height > 0):
        raise MeshError(f"the height of a cell must be a positive length, found {height:g} m.")
    stranded = [part for part in cable.parts if _make_up(cable, part) is not None]
    period = cell_of(cable, tolerance=tolerance) if stranded else None
    if period is None:
        free = cable.outer_diameter / 2 if cable.lay is None else cable.lay / 8
        return height or free, {part.name: 0.0 for part in stranded}
    times = 1.0 if height is None else height / period.height
    if round(times) < 1 or abs(times - round(times)) > 1e-6:
        raise MeshError(
            f"a cell of {cable.name} must be {1e3 * period.height:.6g} mm high or a multiple of that, the common period of its lays, "
            f"not {1e3 * (height or 0):.6g} mm: leave the height out."
        )
    rates = {}
    for part in stranded:
        make_up = _make_up(cable, part)
        assert make_up is not None
        lay = period.layer(make_up.name, part.centre_radius)
        rates[part.name] = relative_turn_rate(part.centre_radius, cable.twist_rate, lay.lay, lay.hand)
    return period.height * round(times), rates


def _first_size(cable: Cable, height: float, elements: int | None, layers: int | None) -> float:
    """Edge length [m] that should give the number of elements."""
    if elements is None:
        return cable.outer_diameter * DEFAULT_SIZE
    if layers is not None:
        return float(np.sqrt(DENSITY * cable.area * layers / elements))
    return float((DENSITY * cable.area * height / elements) ** (1 / 3))


def _check_numbers(elements: int | None, size: float | None, layers: int | None) -> None:
    for what, number in (("elements", elements), ("layers", layers)):
        if number is None:
            continue
        if isinstance(number, bool) or not np.isfinite(number) or number != int(number) or number < 1:
            raise MeshError(f"the number of {what} must be a whole number from 1, found {number!r}.")
    if size is not None and not (np.isfinite(size) and size > 0):
        raise MeshError(f"the mesh size must be a positive length, found {size:g} m.")


def _check_estimate(cable: Cable, height: float, elements: int | None, size: float, layers: int | None) -> None:
    """Refuse what would be too large, before any work."""
    per_layer = DENSITY * cable.area / size**2
    wanted = per_layer * (layers or height / size)
    check_memory(max(wanted, elements or 0))
