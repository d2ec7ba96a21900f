"""What a towing run leaves behind: an xarray dataset with units and meanings, in memory or in a NetCDF file that grows.

``force_global`` at a node is what the part of the cable on the shearer's side exerts on the part on the supply's side, so
that a pulled upper strand has a positive x component and a pulled lower strand a negative one, as published.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from beam.generalized_alpha import Counters, Integrator
from beam.record_file import RecordFile
from beam.rod import GAUSS_X
from beam.rod_model import RodModel
from beam.scenario import Scenario
from beam.section_stress import point_strains, point_stresses
from beam.status import Outcome
from beam.towing_frame import empty_dataset, formula_forces, frame
from geometry.errors import InputError
from homogenize.section_stiffness import SectionStiffness

if TYPE_CHECKING:
    import xarray

Array = NDArray[np.float64]

STATUS_LENGTH = 800
"""Characters that are kept free for the status in a file that is being written."""


@dataclass
class Frames:
    """Instants of a run as they are computed: rows in memory, or records of a file (then nothing stays in memory)."""

    scenario: Scenario
    model: RodModel
    file: RecordFile | None = None
    rows: list[dict[str, Any]] = field(default_factory=list)

    def take(self, motion: Integrator) -> None:
        """Append the present state of `motion`."""
        values = frame(self.scenario, motion)
        if self.file is not None:
            self.file.append(values)
        else:
            self.rows.append({name: np.array(value, dtype=float) for name, value in values.items()})

    def values(self, name: str) -> Array:
        """A variable at all instants; mapped from the file if there is one."""
        if self.file is not None:
            return self.file.read(name)
        return np.array([row[name] for row in self.rows])

    @property
    def times(self) -> Array:
        """Instants [s]."""
        return self.values("time")


def run_attributes(scenario: Scenario, section: SectionStiffness, mass_per_length: float) -> dict[str, Any]:
    """Attributes of the dataset; those that the run decides stand at their start values and keep their length."""
    entries = "; ".join(f"{key} = {entry.text} ({entry.status})" for key, entry in scenario.entries().items())
    return {
        "title": scenario.title,
        "scenario": scenario.name,
        "constants": scenario.constants,
        "status": fixed_length("not finished: it is running, or was ended from outside"),
        "elements": scenario.elements,
        "element": scenario.element,
        "towing": scenario.towing,
        "chain": "clamps" if scenario.has_clamps else "smeared",
        "diameter_m": scenario.cable.diameter.value,
        "mass_per_length_kg_per_m": mass_per_length,
        "section_stiffness_order": "gamma_x, gamma_y, epsilon, kappa_x, kappa_y, tau",
        "section_stiffness": np.ravel(section.C),
        "energy_balance_error": np.nan,
        "static_residual_N": np.nan,
        "static_residual_N_m": np.nan,
        "deepest_penetration_m": np.nan,
        "steps": 0,
        "entries": entries,
    }


def fixed_length(status: str) -> str:
    """`status` cut or filled with blanks to :data:`STATUS_LENGTH` bytes, all ASCII."""
    plain = status.encode("ascii", "replace").decode("ascii")
    return plain[:STATUS_LENGTH].ljust(STATUS_LENGTH)


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
        """Everything over time and node; built at every call, from the file if the run was written to one."""
        empty = empty_dataset(self.frames.model, self.attributes())
        data = {name: (x.dims, self.frames.values(str(name)), x.attrs) for name, x in empty.data_vars.items()}
        fixed = {name: x for name, x in empty.coords.items() if name != "time"}
        time = ("time", self.frames.times, empty["time"].attrs)
        return type(empty)(data, {**fixed, "time": time}, empty.attrs)

    def formula_forces(self) -> tuple[Array, Array]:
        """Formulas (22) and (23) over the frames for the mass of the upper strand, which moves with the shearer [N]."""
        return formula_forces(self.scenario, self.mass_per_length, self.frames.times)

    def strains(self, xi: float, y: ArrayLike, z: ArrayLike) -> Array:
        """(epsilon, gamma_12, gamma_13) at the point (xi, y, z) of every element, (time, element, 3).

        Parameters
        ----------
        xi : float
            Place in the element, 0 to 1 from the supply's side.
        y, z : array_like
            Point of the section along e2 and e3 [m]: one number, or one per element.
        """
        return point_strains(self._at("gauss_strain", xi), y, z)

    def stresses(self, xi: float, y: ArrayLike, z: ArrayLike) -> Array:
        """(sigma, tau_12, tau_13) [Pa] at the point (xi, y, z) of every element, (time, element, 3).

        Smeared over the circle of the cable's diameter, see :mod:`beam.section_stress`; parameters as of :meth:`strains`.

        Raises
        ------
        InputError
            If the point lies outside the section or the element.
        """
        return point_stresses(self._at("gauss_force", xi), y, z, self.scenario.cable.diameter.value)

    def _at(self, name: str, xi: float) -> Array:
        """Gauss-point values of `name` at the place `xi` by the parabola through them."""
        if not 0.0 <= xi <= 1.0:
            raise InputError(f"the place xi in an element is {xi:g}; it must lie between 0 and 1.")
        return np.einsum("g,tegi->tei", through_gauss_points(xi), self.frames.values(name))

    def node(self, published: int) -> int:
        """Label of the dataset's node for number `published` of the source's 400, at the same fraction of the length."""
        return round(published * self.scenario.elements / 400)

    def write(self, path: str | Path) -> Path:
        """Write the dataset as NetCDF: version 4 by h5netcdf where h5py is installed, otherwise version 3 by scipy.

        A run that was written to this file while it ran is there already.

        Raises
        ------
        InputError
            If the file cannot be written.
        """
        path = Path(path)
        file = self.frames.file
        if file is not None and path.resolve() == file.path.resolve():
            return path
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

    def attributes(self) -> dict[str, Any]:
        """Attributes of the dataset: what was run, and how it ended."""
        attributes = run_attributes(self.scenario, self.section, self.mass_per_length)
        return attributes | {
            "status": self.status,
            "energy_balance_error": self.balance_error,
            "static_residual_N": self.static_residual[0],
            "static_residual_N_m": self.static_residual[1],
            "deepest_penetration_m": self.deepest_penetration[0],
            "steps": self.counters.steps,
        }

    def close(self) -> None:
        """Write how the run ended into its file, if it has one."""
        if self.frames.file is not None:
            attributes = self.attributes()
            attributes["status"] = fixed_length(self.status)
            self.frames.file.restate(empty_dataset(self.frames.model, attributes))


def through_gauss_points(xi: float) -> Array:
    """Weights (3,) of the values at the Gauss points in the parabola through them at `xi`.

    Examples
    --------
    >>> through_gauss_points(0.5).round(12) + 0.0
    array([0., 1., 0.])
    """
    x = GAUSS_X
    others = [np.delete(x, g) for g in range(x.size)]
    return np.array([np.prod((xi - rest) / (x[g] - rest)) for g, rest in enumerate(others)])
