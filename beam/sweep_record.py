"""The folder of a sweep: what it is about, one file per finished run, and the tables made of them.

``sweep.json`` says which scenario, axes and sections; ``runs/ID.json`` is one finished run, ID the digest of its inputs. Each
file is complete or absent.
"""

from __future__ import annotations

import csv
import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from beam.scenario import Scenario
from beam.sweep_axis import Axis
from geometry.errors import InputError
from homogenize.section_stiffness import SectionStiffness

if TYPE_CHECKING:
    import xarray

MANIFEST = "sweep.json"
MISSING = "not run yet"

RESULTS: dict[str, tuple[str, str]] = {
    # name: (unit, long name)
    "pull_force_max": ("N", "pull force of largest size"),
    "pull_force_plateau": ("N", "pull force, steady: mean after 6 s, or over the last quarter of a shorter run"),
    "peak_tension": ("N", "largest tension anywhere"),
    "bend_radius_min": ("m", "smallest bend radius of the centre line"),
    "normal_stress_max": ("Pa", "largest tensile stress of the equivalent circle"),
    "deepest_penetration": ("m", "deepest penetration of a contact"),
    "drive_work": ("J", "work of the drives"),
    "friction_loss": ("J", "lost in friction"),
    "damping_loss": ("J", "lost in the cable's damping"),
    "elastic": ("J", "gain of elastic energy"),
    "kinetic": ("J", "gain of kinetic energy"),
    "gravity": ("J", "gain of energy of height"),
    "energy_balance_error": ("1", "energy from nowhere over the throughput"),
    "seconds_simulated": ("s", "simulated"),
    "seconds_wall": ("s", "computing time"),
}


@dataclass(frozen=True)
class SweepFolder:
    """An open folder: `places` are (place in the grid, id) of every run."""

    path: Path
    axes: list[Axis]
    places: list[tuple[tuple[int, ...], str]]
    title: str

    @classmethod
    def open(
        cls,
        path: str | Path,
        scenario: Scenario,
        axes: list[Axis],
        sections: Mapping[str, SectionStiffness],
        notes: Mapping[str, str],
        places: list[tuple[tuple[int, ...], str]],
    ) -> SweepFolder:
        """Make the folder, or find the one of the same sweep.

        Raises
        ------
        InputError
            If it cannot be made, or holds another sweep.
        """
        path = Path(path)
        about = _about(scenario, axes, sections, notes)
        there = read_manifest(path)
        if there is not None and there != about:
            raise InputError(
                f"{path} holds another sweep ({_difference(there, about)}): choose another folder, or repeat its command."
            )
        try:
            (path / "runs").mkdir(parents=True, exist_ok=True)
            if there is None:
                _write(path / MANIFEST, about)
        except OSError as error:
            raise InputError(
                f"the folder {path} cannot be used: {error.strerror or error}; choose another place."
            ) from None
        return cls(path, axes, places, scenario.title)

    def run_file(self, id: str) -> Path:
        """NetCDF file of a run."""
        return self.path / "runs" / f"{id}.nc"

    def has(self, id: str) -> bool:
        """True if the row of this run is there."""
        return self._row_file(id).is_file()

    def keep(self, row: dict[str, Any]) -> None:
        """Write a finished row."""
        try:
            _write(self._row_file(row["id"]), row)
        except OSError as error:
            raise InputError(f"{self.path}: a finished run cannot be kept: {error}; free some space.") from None

    def rows(self) -> list[dict[str, Any] | None]:
        """Rows in the order of the grid; None where a run is missing.

        Raises
        ------
        InputError
            If the file of a run is damaged.
        """
        return [self._row(id) if self.has(id) else None for _, id in self.places]

    def _row(self, id: str) -> dict[str, Any]:
        try:
            return json.loads(self._row_file(id).read_text("utf-8"))
        except (OSError, ValueError) as error:
            raise InputError(
                f"{self._row_file(id)} cannot be read: {error}; delete it and repeat the command, which makes this run again."
            ) from None

    def counts(self) -> tuple[int, int, int]:
        """Completed, failed and missing runs."""
        rows = self.rows()
        completed = sum(row is not None and row["status"] == "completed" for row in rows)
        missing = sum(row is None for row in rows)
        return completed, len(rows) - completed - missing, missing

    @property
    def dataset(self) -> xarray.Dataset:
        """Results over the axes of the sweep; NaN where there are none, the sentence then in ``status``."""
        import xarray as xr

        shape = tuple(len(axis.texts) for axis in self.axes)
        dims = [axis.name for axis in self.axes]
        values = {name: np.full(shape, np.nan) for name in RESULTS}
        status = np.full(shape, MISSING, dtype=object)
        ids = np.full(shape, "", dtype=object)
        for (place, id), row in zip(self.places, self.rows(), strict=True):
            ids[place] = id
            if row is not None:
                status[place] = row["status"]
                for name in RESULTS:
                    values[name][place] = row["results"].get(name, np.nan)
        data: dict[str, Any] = {n: (dims, values[n], {"units": u, "long_name": m}) for n, (u, m) in RESULTS.items()}
        data["status"] = (dims, status, {"long_name": "completed, or why there is no result"})
        data["run"] = (dims, ids, {"long_name": "name of the run: digest of its inputs"})
        coords = {
            a.name: (
                a.name,
                np.array(a.numbers) if a.unit else np.array(a.texts, dtype=object),
                {"units": a.unit or "1"},
            )
            for a in self.axes
        }
        return xr.Dataset(data, coords, {"title": self.title})

    def write_tables(self) -> list[Path]:
        """Write ``sweep.csv`` and ``sweep.nc``."""
        table, file = self.path / "sweep.csv", self.path / "sweep.nc"
        head = [axis.label for axis in self.axes] + [f"{n} [{u}]" for n, (u, _) in RESULTS.items()] + ["status", "run"]
        try:
            with table.open("w", newline="", encoding="utf-8") as stream:
                out = csv.writer(stream)
                out.writerow(head)
                for (place, id), row in zip(self.places, self.rows(), strict=True):
                    values = [a.numbers[i] if a.unit else a.texts[i] for a, i in zip(self.axes, place, strict=True)]
                    found = {} if row is None else row["results"]
                    results = [f"{found[n]:.9g}" if n in found else "" for n in RESULTS]
                    out.writerow([*values, *results, MISSING if row is None else row["status"], id])
            self.dataset.to_netcdf(file)
        except OSError as error:
            raise InputError(f"{self.path}: the tables cannot be written: {error}.") from None
        return [table, file]

    def _row_file(self, id: str) -> Path:
        return self.path / "runs" / f"{id}.json"


def read_manifest(path: str | Path) -> dict[str, Any] | None:
    """What the sweep in a folder is about; None if there is none.

    Raises
    ------
    InputError
        If the folder holds other things, or the file cannot be read.
    """
    path = Path(path)
    file = path / MANIFEST
    if not file.is_file():
        if path.is_dir() and any(path.iterdir()):
            raise InputError(f"the folder {path} holds other files; a sweep needs a folder of its own.")
        return None
    try:
        return json.loads(file.read_text("utf-8"))
    except (OSError, ValueError) as error:
        raise InputError(f"{file} cannot be read: {error}; choose another folder.") from None


def _about(
    scenario: Scenario, axes: list[Axis], sections: Mapping[str, SectionStiffness], notes: Mapping[str, str]
) -> dict[str, Any]:
    return {
        "schema": 1,
        "choices": choices(scenario),
        "entries": {key: entry.value for key, entry in scenario.entries().items()},
        "axes": {axis.key: list(axis.texts) for axis in axes},
        "sections": {name: {"C": np.asarray(s.C).tolist(), "area": s.area} for name, s in sections.items()},
        "notes": dict(notes),
    }


def choices(scenario: Scenario) -> dict[str, str]:
    """What a scenario says in words, such as its constants; not its title.

    Examples
    --------
    >>> from beam import read_scenario
    >>> choices(read_scenario("intelligent-horizontal"))["constants"]
    'published'
    """
    said = {name: getattr(scenario, name) for name in type(scenario).model_fields if name != "title"}
    return {name: value for name, value in said.items() if isinstance(value, str)}


def _difference(there: Mapping[str, Any], here: Mapping[str, Any]) -> str:
    """The first thing in which two sweeps differ, in words."""
    for key, value in here.items():
        old = there.get(key)
        if old == value:
            continue
        if isinstance(value, dict) and isinstance(old, dict):
            names = [n for n in {**value, **old} if value.get(n) != old.get(n)]
            if key == "sections":
                return f"the section of {names[0]} is another one"
            return f"{names[0]}: there {_show(old.get(names[0]))}, here {_show(value.get(names[0]))}"
        return f"{key}: there {_show(old)}, here {_show(value)}"
    return "it was written by another version"


def _show(value: Any) -> str:
    if value is None:
        return "absent"
    return ", ".join(map(str, value)) if isinstance(value, list) else str(value)


def _write(file: Path, record: Mapping[str, Any]) -> None:
    part = file.with_name(file.name + ".part")
    part.write_text(json.dumps(record, indent=1) + "\n", encoding="utf-8")
    part.replace(file)
