"""One instant of a towing run: everything that is recorded, with axes, unit and meaning.

Forces at nodes come from :mod:`beam.section_force`; strains and section forces at the Gauss points are those of the element
itself. Elements are counted from the supply, nodes from the shearer.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from beam.body_record import bushing_states
from beam.clamp_record import CLAMP_VARIABLES, Variables, clamp_coordinates, clamp_frame, has_chain
from beam.contact_state import ContactState
from beam.energy_ledger import energy_names
from beam.generalized_alpha import Integrator
from beam.incline_formula import towing_force_down, towing_force_up
from beam.rod import GAUSS_X
from beam.rod_model import RodModel
from beam.scenario import Scenario
from beam.surface import FreeTurn, Surface

if TYPE_CHECKING:
    import xarray

Array = NDArray[np.float64]

VARIABLES: Variables = {
    # name: (axes besides time, unit, long name)
    "position": (("node", "axis"), "m", "position of the centre line"),
    "tangent": (("node", "axis"), "1", "derivative of the position by arc length"),
    "rotation_vector": (("node", "axis"), "rad", "rotation vector of the section"),
    "force_local": (("node", "section_axis"), "N", "section force: tension N, shear Q2, Q3, in the section's axes"),
    "moment_local": (
        ("node", "section_axis"),
        "N m",
        "section moment: torque, bending M2, M3, in the section's axes",
    ),
    "force_global": (
        ("node", "axis"),
        "N",
        "section force of the shearer's side on the supply's side, global axes",
    ),
    "moment_global": (
        ("node", "axis"),
        "N m",
        "section moment of the shearer's side on the supply's side, global axes",
    ),
    "contact_force": (
        ("node", "axis"),
        "N",
        "contact force of trough, deck and roller on the cable, collected at the node",
    ),
    "friction_force": (("node", "axis"), "N", "friction part of contact_force"),
    "gauss_strain": (
        ("element", "gauss", "strain"),
        "1 (stretch, shears), 1/m (twist, curvatures)",
        "strains at the Gauss points, minus those of the stress-free shape",
    ),
    "gauss_force": (
        ("element", "gauss", "strain"),
        "N (N, Q2, Q3), N m (M1, M2, M3)",
        "section forces and moments at the Gauss points, each conjugate to its strain",
    ),
    "friction_use": (
        ("element", "surface"),
        "1",
        "largest |t| / (mu f_n) of the element's contact points: below 1 it sticks, 1 it slips; 0 without contact or friction",
    ),
    "contact_gap": (
        ("element", "surface"),
        "m",
        "smallest gap of the element's contact points, negative: gone into the surface; NaN beyond the surface's extent",
    ),
    "contact_normal": (("element", "surface"), "N", "normal force of the surface on the element, sum of magnitudes"),
    "contact_friction": (("element", "surface"), "N", "friction of the surface on the element, sum of magnitudes"),
    "contact_slip": (
        ("element", "surface"),
        "1",
        "share of contact_normal at points that slip: 0 sticks, 1 slips; NaN without contact",
    ),
    "surface_gap": (("surface",), "m", "smallest gap of the surface; NaN if nothing is within its extent"),
    "surface_force": (("surface", "axis"), "N", "force of the surface on cable or links"),
    "surface_normal": (("surface",), "N", "normal force of the surface, sum of magnitudes"),
    "surface_friction": (("surface",), "N", "friction of the surface, sum of magnitudes"),
    "surface_slip": (("surface",), "1", "share of surface_normal at points that slip; NaN without contact"),
    "surface_turn": (("surface",), "rad", "angle by which the surface has turned about z"),
    "surface_spin": (("surface",), "rad/s", "its angular velocity"),
    "pull_force": (("axis",), "N", "force of the shearer on the cable's end"),
    "pull_moment": (("axis",), "N m", "moment of the shearer on the cable's end"),
    "supply_reaction": (("axis",), "N", "force of support and tensioner at the supply end"),
    "supply_moment": (("axis",), "N m", "moment of the fixed support at the supply end"),
    "bend_radius": ((), "m", "smallest bend radius of the centre line"),
    "bend_radius_at": ((), "m", "arc length from the supply where the bend radius is smallest"),
    "formula_up": ((), "N", "towing force of formula (22)"),
    "formula_down": ((), "N", "towing force of formula (23)"),
    "energy": (("source",), "J", "energies stored and spent, work of the drives, by source"),
    "energy_error": ((), "J", "stored since the start + lost - work of the drives: from nowhere"),
}

STRAINS = ("Gamma_1", "Gamma_2", "Gamma_3", "kappa_1", "kappa_2", "kappa_3")


def frame(scenario: Scenario, motion: Integrator) -> dict[str, Any]:
    """Values of ``time`` and all :func:`variables` at the present state of `motion`."""
    forces, model = motion.forces, motion.model
    rod = model.rod
    q, reaction = motion.q[: rod.nodes], motion.reaction[: rod.nodes]
    theta, local, turned = rod.sections(q, forces.S)
    E = rod.strains(q)
    radius, where = _bend_radius(E + rod.E0, gauss_arc_length(model))
    mass = rod.mass_per_length + (scenario.cable.clamp_mass_per_length.value if scenario.has_clamps else 0.0)
    up, down = formula_forces(scenario, mass, np.array([motion.t]))
    first, last = (rod.moment(q[k], reaction[k]) for k in (0, -1))
    return {
        "time": motion.t,
        "position": q[:, 0:3],
        "tangent": q[:, 3:6],
        "rotation_vector": theta,
        "force_local": local[:, :3],
        "moment_local": local[:, 3:],
        "force_global": turned[:, :3],
        "moment_global": turned[:, 3:],
        "contact_force": forces.contact,
        "friction_force": forces.friction,
        "gauss_strain": E,
        "gauss_force": rod.in_section_axes(q, forces.S),
        **_contacts(motion),
        **(clamp_frame(motion) if has_chain(model) else {}),
        "pull_force": reaction[-1, 0:3],
        "pull_moment": last,
        "supply_reaction": reaction[0, 0:3] + tensioner_force(motion),
        "supply_moment": first,
        "bend_radius": radius,
        "bend_radius_at": where,
        "formula_up": up[0],
        "formula_down": down[0],
        "energy": np.array([motion.ledger.totals[name] for name in energy_names(model)]),
        "energy_error": motion.ledger.balance_error * motion.ledger.throughput,
    }


def _contacts(motion: Integrator) -> dict[str, Array]:
    """Gap, normal force, friction and slip, of elements and of surfaces; of surfaces alone where links touch them."""
    states = motion.contacts
    return {**(_of_elements(motion, states) if motion.model.surfaces else {}), **_of_surfaces(motion, states)}


def _of_elements(motion: Integrator, states: list[ContactState]) -> dict[str, Array]:
    states = states[: len(motion.model.surfaces)]
    return {
        "friction_use": np.stack([cone.max(axis=1) for cone in motion.forces.cones], axis=1),
        "contact_gap": np.stack([s.element_gap for s in states], axis=1),
        "contact_normal": np.stack([s.normal.sum(axis=1) for s in states], axis=1),
        "contact_friction": np.stack([s.friction.sum(axis=1) for s in states], axis=1),
        "contact_slip": np.stack([s.element_slip for s in states], axis=1),
    }


def _of_surfaces(motion: Integrator, states: list[ContactState]) -> dict[str, Array]:
    if not states:
        return {}
    turned = surface_turns(motion)
    return {
        "surface_gap": np.array([s.smallest_gap for s in states]),
        "surface_force": np.array([s.force.sum(axis=(0, 1)) for s in states]),
        "surface_normal": np.array([s.normal.sum() for s in states]),
        "surface_friction": np.array([s.friction.sum() for s in states]),
        "surface_slip": np.array([s.slip_share for s in states]),
        "surface_turn": turned[:, 0],
        "surface_spin": turned[:, 1],
    }


def surface_turns(motion: Integrator) -> Array:
    """Angle [rad] and angular velocity [rad/s] of every surface, zero for those that do not turn, (surfaces, 2)."""
    model = motion.model
    surfaces = touched_surfaces(model)
    out = np.zeros((len(surfaces), 2))
    for k, surface in enumerate(surfaces):
        turn = getattr(surface, "turn", None)
        if turn is not None and not isinstance(turn, FreeTurn):
            out[k] = turn(motion.t)[:2]
    out[model.free_rollers] = motion.rollers.turned
    return out


def touched_surfaces(model: RodModel) -> list[Surface]:
    """Surfaces that the cable touches, then those that the links touch."""
    return [*model.surfaces, *model.body_surfaces]


def tensioner_force(motion: Integrator) -> Array:
    """Force of the tensioner on the supply's end (3,) [N]; zero without one."""
    model = motion.model
    of_tensioner = [bushing.name.startswith("tensioner") for bushing in model.bushings]
    if not any(of_tensioner):
        return np.zeros(3)
    return bushing_states(model, motion.t, motion.q, motion.v).force_global[of_tensioner].sum(axis=0)


def variables(model: RodModel) -> Variables:
    """What is recorded of `model`: of contacts only what can be touched, of the clamps if they are bodies."""
    left_out = set() if model.surfaces else {"element"} if model.body_surfaces else {"surface"}
    own = {k: x for k, x in VARIABLES.items() if "surface" not in x[0] or not left_out.intersection(x[0])}
    return own | (CLAMP_VARIABLES if has_chain(model) else {})


def empty_dataset(model: RodModel, attributes: dict[str, Any]) -> xarray.Dataset:
    """All variables, coordinates and attributes of a run, with no instant of it."""
    import xarray as xr

    coords = _coordinates(model)
    sizes = {name: len(values) for name, (dims, values, _) in coords.items() if dims == (name,)}
    data = {}
    for name, (dims, unit, meaning) in variables(model).items():
        shape = (0, *(sizes[dim] for dim in dims))
        data[name] = (("time", *dims), np.zeros(shape), {"units": unit, "long_name": meaning})
    return xr.Dataset(data, coords, attributes)


def gauss_arc_length(model: RodModel) -> Array:
    """Arc length of the Gauss points from the supply, unstretched (n, 3) [m]."""
    return model.rod.s[:-1, None] + GAUSS_X * model.rod.lengths[:, None]


def formula_forces(scenario: Scenario, mass_per_length: float, times: Array) -> tuple[Array, Array]:
    """Formulas (22) and (23) at `times` [s] for the mass of the upper strand, which moves with the shearer [N]."""
    towed_end, trolley = scenario.pull, scenario.trolley
    pull = [towed_end(t) for t in times]
    travel = np.array([trolley(t)[0][0] for t in times])
    stroke = np.array([u[0] for u, _, _ in pull])
    mass = mass_per_length * (scenario.layout.upper_strand.value + stroke - travel)
    acceleration = np.array([a[0] for _, _, a in pull])
    slope, mu = scenario.layout.inclination.value, scenario.contact.friction.value
    return towing_force_up(mass, slope, mu, acceleration), towing_force_down(mass, slope, mu, acceleration)


def _bend_radius(E: Array, s: Array) -> tuple[float, float]:
    curvature = np.hypot(E[:, :, 4], E[:, :, 5])
    k = int(curvature.argmax())
    return 1.0 / max(float(curvature.flat[k]), 1e-9), float(s.flat[k])


def _coordinates(model: RodModel) -> dict[str, tuple[tuple[str, ...], Any, dict[str, str]]]:
    nodes, elements = model.rod.nodes, model.rod.lengths.size
    count = {"long_name": "node, counted from the shearer", "units": "1"}
    touched = {"long_name": "what cable or links touch"}
    surfaces = [surface.name for surface in touched_surfaces(model)]
    return {
        "time": (("time",), np.zeros(0), {"units": "s", "long_name": "time"}),
        "node": (("node",), np.arange(nodes - 1, -1, -1), count),
        "s": (("node",), model.rod.s, {"units": "m", "long_name": "arc length from the supply, unstretched"}),
        "element": (
            ("element",),
            np.arange(elements),
            {"long_name": "element, counted from the supply", "units": "1"},
        ),
        "gauss": (("gauss",), GAUSS_X, {"long_name": "place of the Gauss point in the element, 0 to 1", "units": "1"}),
        "s_gauss": (
            ("element", "gauss"),
            gauss_arc_length(model),
            {"units": "m", "long_name": "arc length of the Gauss points from the supply, unstretched"},
        ),
        "axis": (
            ("axis",),
            ["x", "y", "z"],
            {"long_name": "global axes: travel, normal to the trough, across"},
        ),
        "section_axis": (
            ("section_axis",),
            ["1", "2", "3"],
            {"long_name": "axes of the section, 1 along the cable"},
        ),
        "strain": (("strain",), list(STRAINS), {"long_name": "stretch, two shears, twist, two curvatures"}),
        **({"surface": (("surface",), surfaces, touched)} if surfaces else {}),
        **(clamp_coordinates(model) if has_chain(model) else {}),
        "source": (("source",), list(energy_names(model)), {"long_name": "where the energy is or went"}),
    }
