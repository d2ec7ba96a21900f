"""What a towing run leaves behind: an xarray dataset with units and meanings, written as NetCDF.

``force_global`` at a node is what the part of the cable on the shearer's side exerts on the part on the supply's side, so
that a pulled upper strand has a positive x component and a pulled lower strand a negative one, as published.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

from beam.energy_ledger import energy_names
from beam.generalized_alpha import Counters, Integrator
from beam.incline_formula import towing_force_down, towing_force_up
from beam.rod_model import RodModel
from beam.scenario import Scenario
from beam.section_force import nodal_section_forces
from beam.status import Outcome
from geometry.errors import InputError
from homogenize.section_stiffness import SectionStiffness

if TYPE_CHECKING:
    import xarray

Array = NDArray[np.float64]

VECTORS: dict[str, tuple[str, str, str]] = {
    # name: (second axis, unit, long name)
    "position": ("axis", "m", "position of the centre line"),
    "tangent": ("axis", "1", "derivative of the position by arc length"),
    "rotation_vector": ("axis", "rad", "total rotation vector of the section"),
    "force_local": ("section_axis", "N", "section force: tension N, shear Q2, Q3, in the section's axes"),
    "moment_local": ("section_axis", "N m", "section moment: torque, bending M2, M3, in the section's axes"),
    "force_global": ("axis", "N", "section force of the shearer's side on the supply's side, global axes"),
    "moment_global": ("axis", "N m", "section moment of the shearer's side on the supply's side, global axes"),
    "contact_force": ("axis", "N", "contact force of trough, deck and roller on the cable, collected at the node"),
    "friction_force": ("axis", "N", "friction part of contact_force"),
}
ENDS: dict[str, str] = {
    "pull_force": "force of the shearer on the cable's end",
    "supply_reaction": "force of the fixed support at the supply end",
}


@dataclass
class Frames:
    """Output frames as they are computed; rows of plain arrays."""

    model: RodModel
    times: list[float] = field(default_factory=list)
    vectors: dict[str, list[Array]] = field(default_factory=lambda: {name: [] for name in VECTORS})
    ends: dict[str, list[Array]] = field(default_factory=lambda: {name: [] for name in ENDS})
    energies: list[list[float]] = field(default_factory=list)

    def take(self, motion: Integrator) -> None:
        """Append the present state of `motion`."""
        q, forces = motion.q, motion.forces
        local, turned = nodal_section_forces(q, self.model.rod.lengths, forces.S)
        values = {
            "position": q[:, 0:3],
            "tangent": q[:, 3:6],
            "rotation_vector": q[:, 6:9],
            "force_local": local[:, :3],
            "moment_local": local[:, 3:],
            "force_global": turned[:, :3],
            "moment_global": turned[:, 3:],
            "contact_force": forces.contact,
            "friction_force": forces.friction,
        }
        self.times.append(motion.t)
        for name, value in values.items():
            self.vectors[name].append(value.copy())
        reaction = motion.reaction
        self.ends["pull_force"].append(reaction[-1, 0:3].copy())
        self.ends["supply_reaction"].append(reaction[0, 0:3].copy())
        self.energies.append([float(motion.ledger.totals[name]) for name in energy_names(self.model)])


@dataclass(frozen=True)
class TowingRun:
    """A finished, or stopped, towing run.

    Attributes
    ----------
    outcome : Outcome
        How it ended; ``status`` is the short form.
    counters : Counters
        Steps, iterations, factorisations, cuts.
    balance_error : float
        Energy that appeared from nowhere over the throughput.
    static_residual : (N, N m)
        Residual of the equilibrium it started from.
    deepest_penetration : (m, str)
        Largest penetration of a contact, and where.
    """

    scenario: Scenario
    section: SectionStiffness
    mass_per_length: float
    frames: Frames
    outcome: Outcome
    counters: Counters
    balance_error: float
    static_residual: tuple[float, float]
    deepest_penetration: tuple[float, str]
    seconds_wall: float

    @property
    def status(self) -> str:
        """``"completed"`` or the sentence that says why not."""
        return str(self.outcome)

    @property
    def dataset(self) -> xarray.Dataset:
        """Everything over time and node; built at every call."""
        import xarray as xr

        frames = self.frames
        nodes = frames.model.rod.nodes
        data: dict[str, Any] = {}
        for name, (axis, unit, meaning) in VECTORS.items():
            data[name] = (("time", "node", axis), np.array(frames.vectors[name]), {"units": unit, "long_name": meaning})
        for name, meaning in ENDS.items():
            data[name] = (("time", "axis"), np.array(frames.ends[name]), {"units": "N", "long_name": meaning})
        up, down = self.formula_forces()
        data["formula_up"] = ("time", up, {"units": "N", "long_name": "towing force of formula (22)"})
        data["formula_down"] = ("time", down, {"units": "N", "long_name": "towing force of formula (23)"})
        meaning = "energies stored and spent, work of the drives, by source"
        data["energy"] = (("time", "source"), np.array(frames.energies), {"units": "J", "long_name": meaning})
        count = {"long_name": "node, counted from the shearer", "units": "1"}
        coords = {
            "time": ("time", np.array(frames.times), {"units": "s", "long_name": "time"}),
            "node": ("node", np.arange(nodes - 1, -1, -1), count),
            "s": ("node", frames.model.rod.s, {"units": "m", "long_name": "arc length from the supply, unstretched"}),
            "axis": ("axis", ["x", "y", "z"], {"long_name": "global axes: travel, normal to the trough, across"}),
            "section_axis": ("section_axis", ["1", "2", "3"], {"long_name": "axes of the section, 1 along the cable"}),
            "source": ("source", list(energy_names(frames.model)), {"long_name": "where the energy is or went"}),
        }
        return xr.Dataset(data, coords, self._attributes())

    def formula_forces(self) -> tuple[Array, Array]:
        """Formulas (22) and (23) over the frames for the mass of the upper strand, which moves with the shearer [N]."""
        scenario, times = self.scenario, self.frames.times
        pull = [scenario.pull(t) for t in times]
        travel = np.array([scenario.trolley(t)[0][0] for t in times])
        stroke = np.array([u[0] for u, _, _ in pull])
        mass = self.mass_per_length * (scenario.layout.upper_strand.value + stroke - travel)
        acceleration = np.array([a[0] for _, _, a in pull])
        slope, mu = scenario.layout.inclination.value, scenario.contact.friction.value
        return towing_force_up(mass, slope, mu, acceleration), towing_force_down(mass, slope, mu, acceleration)

    def node(self, published: int) -> int:
        """Label of the dataset's node for number `published` of the source's 400, at the same fraction of the length."""
        return round(published * self.scenario.elements / 400)

    def write(self, path: str | Path) -> Path:
        """Write the dataset as NetCDF: version 4 by h5netcdf where h5py is installed, otherwise version 3 by scipy.

        Raises
        ------
        InputError
            If the file cannot be written.
        """
        path = Path(path)
        engine: Literal["h5netcdf", "scipy"] = "h5netcdf" if find_spec("h5py") else "scipy"
        try:
            self.dataset.to_netcdf(path, engine=engine)
        except OSError as error:
            raise InputError(f"{path}: the run cannot be written there: {error}.") from None
        return path

    def record(self) -> dict[str, Any]:
        """The run in numbers, see :func:`beam.towing_record.towing_record`."""
        from beam.towing_record import towing_record

        return towing_record(self)

    def _attributes(self) -> dict[str, Any]:
        scenario = self.scenario
        return {
            "title": scenario.title,
            "scenario": scenario.name,
            "constants": scenario.constants,
            "status": self.status,
            "elements": scenario.elements,
            "mass_per_length_kg_per_m": self.mass_per_length,
            "section_stiffness_order": "gamma_x, gamma_y, epsilon, kappa_x, kappa_y, tau",
            "section_stiffness": np.ravel(self.section.C),
            "energy_balance_error": self.balance_error,
            "static_residual_N": self.static_residual[0],
            "static_residual_N_m": self.static_residual[1],
            "deepest_penetration_m": self.deepest_penetration[0],
            "steps": self.counters.steps,
            "entries": "; ".join(f"{key} = {entry.text} ({entry.status})" for key, entry in scenario.entries().items()),
        }
