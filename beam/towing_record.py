"""The towing run in numbers: forces at the published nodes beside what the source reports."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from beam.section_stress import largest_normal_stress
from geometry.errors import InputError

if TYPE_CHECKING:
    import xarray

    from beam.towing_run import TowingRun

PUBLISHED_NODES = (54, 199, 220, 370)
"""Nodes of the source: at the shearer, upper and lower end of the bend, at the power end; counted from the shearer."""

PLATEAU_FROM = 6.0
"""s; the source calls its curves steady from here on."""


def towing_record(run: TowingRun) -> dict[str, Any]:
    """Numbers of a run with fixed keys; SI, finite, ``None`` where there is none, with the reason in ``notes``."""
    data = run.dataset
    time = data["time"].values
    nodes = {}
    for published in PUBLISHED_NODES:
        force = data["force_global"].sel(node=run.node(published)).values
        nodes[str(published)] = {
            "Fx_plateau": _plateau(time, force[:, 0]),
            "Fy_plateau": _plateau(time, force[:, 1]),
            "Fx_max": _largest(force[:, 0]),
            "Fy_max": _largest(force[:, 1]),
        }
    up, down = run.formula_forces()
    energy = data["energy"].values
    entries = run.scenario.entries()
    published = {k.split(".")[1]: e.value for k, e in entries.items() if k.startswith("published_results.")}
    return {
        "schema": 1,
        "scenario": run.scenario.name,
        "status": "completed" if run.outcome.completed else run.status,
        "seconds_simulated": float(time[-1]),
        "seconds_wall": run.seconds_wall,
        "elements": run.scenario.elements,
        "element": run.scenario.element,
        "constants": run.scenario.constants,
        "peak_tension": float(data["force_local"].values[:, :, 0].max()),
        "bend_radius_min": float(data["bend_radius"].values.min()),
        "normal_stress_max": _largest_stress(run),
        "pull_force_plateau": _plateau(time, data["pull_force"].values[:, 0]),
        "pull_force_max": _largest(data["pull_force"].values[:, 0]),
        "formula_22_peak": float(up.max()),
        "formula_23_peak": float(down.max()),
        "energy_balance_error": float(run.balance_error),
        "energies": dict(zip(map(str, data["source"].values), (energy[-1] - energy[0]).tolist(), strict=True)),
        "static_residual": {"force": run.static_residual[0], "moment": run.static_residual[1]},
        "deepest_penetration": run.deepest_penetration[0],
        "contacts": contact_record(data),
        "nodes": nodes,
        "bushing_3_amplitude": None,
        "contact_35": None,
        "lateral_displacement_max": float(np.abs(data["position"].values[:, :, 2]).max()),
        "published": published,
        "assumed": {key: entry.text for key, entry in entries.items() if entry.status == "assumed"},
        "notes": _notes(run),
    }


def contact_record(data: xarray.Dataset) -> dict[str, dict[str, float | None]]:
    """By surface: smallest gap, largest and last normal force and friction, share that slips at the end, turning."""
    out = {}
    for name in map(str, data["surface"].values):
        one = {key: data[f"surface_{key}"].sel(surface=name).values for key in SURFACE_COLUMNS}
        gaps = one["gap"][np.isfinite(one["gap"])]
        slip = float(one["slip"][-1])
        out[name] = {
            "gap_min": float(gaps.min()) if gaps.size else None,
            "normal_max": float(one["normal"].max()),
            "normal_end": float(one["normal"][-1]),
            "friction_max": float(one["friction"].max()),
            "friction_end": float(one["friction"][-1]),
            "slip_share_end": slip if np.isfinite(slip) else None,
            "turn_end": float(one["turn"][-1]),
        }
    return out


SURFACE_COLUMNS = {"gap": "m", "normal": "N", "friction": "N", "slip": "1", "turn": "rad", "spin": "rad/s"}
"""What is recorded of a surface over time, with its unit."""


def write_contact_table(data: xarray.Dataset, path: str | Path) -> Path:
    """Contacts over time as CSV: time, then for every surface gap, normal force, friction, slip share, turning; empty where none.

    Raises
    ------
    InputError
        If the file cannot be written.
    """
    path = Path(path)
    surfaces = [str(name) for name in data["surface"].values]
    head = ["time [s]", *(f"{name} {key} [{unit}]" for name in surfaces for key, unit in SURFACE_COLUMNS.items())]
    columns = [data["time"].values]
    columns += [data[f"surface_{key}"].sel(surface=name).values for name in surfaces for key in SURFACE_COLUMNS]
    try:
        with path.open("w", newline="", encoding="utf-8") as file:
            table = csv.writer(file)
            table.writerow(head)
            table.writerows(["" if np.isnan(x) else f"{x:.9g}" for x in row] for row in zip(*columns, strict=True))
    except OSError as error:
        raise InputError(f"{path}: the contacts cannot be written there: {error}.") from None
    return path


def _notes(run: TowingRun) -> list[str]:
    notes = [
        "bushing_3_amplitude is null: clamps enter as mass only, there are no bushings yet.",
        "contact_35 is null: clamps enter as mass only, there is no clamp-cable contact yet.",
        _lateral_note(run),
        "Forces at a node are what the shearer's side exerts on the supply's side; x is the direction of travel.",
        "The tension at rest depends on layout.slack (not published): a bend wants to open, and a taut stiff cable holds it.",
        f"Plateaus are means from {PLATEAU_FROM:g} s on, or over the last quarter of a shorter run.",
    ]
    if not run.outcome.completed:
        notes.insert(0, run.status)
    return notes


def _lateral_note(run: TowingRun) -> str:
    if np.abs(run.dataset["position"].values[:, :, 2]).max() < 1e-6:
        return "The run is plane: nothing disturbs it sideways, the lateral displacement is round-off."
    return "The section's coupling of stretch and twist moves the cable sideways; there are no trough walls yet."


def _largest_stress(run: TowingRun) -> float:
    """Largest tensile stress of the equivalent circle [Pa], instant by instant, so that a long run stays in its file."""
    frames, diameter = run.frames.values("gauss_force"), run.scenario.cable.diameter.value
    return float(max(largest_normal_stress(S, diameter)[0].max() for S in frames))


def _plateau(time: np.ndarray, values: np.ndarray) -> float:
    begin = PLATEAU_FROM if time[-1] > PLATEAU_FROM else time[0] + 0.75 * (time[-1] - time[0])
    return float(values[time >= begin].mean())


def _largest(values: np.ndarray) -> float:
    """The value of largest magnitude, with its sign."""
    return float(values[np.argmax(np.abs(values))])
