"""Writes a campaign folder: campaign.toml, experiments.csv and one table per record; nothing about the truth."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from benchmarks.blind.bench import Bench

Array = NDArray[np.float64]
_PATH = {
    "extension": ("extension [mm]", 1e3, True),
    "strain": ("strain [-]", 1.0, False),
    "twist": ("twist [rad/m]", 1.0, False),
    "rotation": ("rotation [deg]", 180 / np.pi, True),
    "curvature": ("curvature [1/m]", 1.0, False),
    "deflection": ("deflection [mm]", 1e3, True),
}
"""Header, factor from SI, and whether it is multiplied with the specimen length."""
_LOAD = {"tension": "force [N]", "torsion": "torque [N m]", "bending": "moment [N m]", "shear": "force [N]"}
_SECOND = {"tension": "torque [N m]", "torsion": "force [N]"}


@dataclass(frozen=True)
class MeasuredKind:
    """Records of one kind: path (or load, if that was prescribed) and measured channels per record, in SI per length.

    `condition` and `specimen` say of every record which condition and specimen it is.
    """

    bench: Bench
    path_name: str
    condition: list[int]
    specimen: list[str]
    prescribed: list[Array]
    main: list[Array]
    second: list[Array] | None
    clock: bool
    direction: list[str] | None = None


def _table(kind: MeasuredKind, r: int) -> str:
    bench, c = kind.bench, kind.condition[r]
    header, factor, per_length = _PATH[kind.path_name]
    factor = factor * (bench.length[c] if per_length else 1.0)
    path, load = (kind.main[r], kind.prescribed[r]) if bench.load_control else (kind.prescribed[r], kind.main[r])
    columns = [(header, factor * path, "%.6g"), (_LOAD[bench.kind], load, "%.6g")]
    if kind.clock:
        columns.insert(0, ("time [s]", bench.time[c, : len(path)], "%.8g"))
    if kind.second is not None:
        columns.append((_SECOND[bench.kind], kind.second[r], "%.6g"))
    line = ",".join(form for _, _, form in columns)
    rows = zip(*(values.tolist() for _, values, _ in columns), strict=True)
    return ",".join(name for name, _, _ in columns) + "\n" + "\n".join(line % row for row in rows) + "\n"


def _cells(kind: MeasuredKind, r: int) -> dict[str, str]:
    bench, c = kind.bench, kind.condition[r]
    cells = {
        "kind": bench.kind,
        "specimen": kind.specimen[r],
        "set": bench.set_names[c],
        "temperature [degC]": f"{bench.temperature[c]:g}",
        "specimen length [m]": f"{bench.length[c]:g}",
    }
    if kind.clock:
        cells["frequency [Hz]"] = f"{bench.frequency[c]:.3g}"
    if bench.kind in ("bending", "torsion"):
        cells["axial tension [N]"] = f"{bench.tension[c]:g}"
    if kind.direction is not None:
        cells["direction"] = kind.direction[c]
    if bench.load_control:
        cells["control"] = _LOAD[bench.kind].split(" [")[0]
    return cells


def write_campaign(
    folder: Path,
    title: str,
    section: dict[str, str],
    sensors: dict[str, str],
    kinds: list[MeasuredKind],
    order: list[tuple[int, int]],
) -> None:
    """Write the folder.

    Parameters
    ----------
    folder : Path
        Made if it is not there.
    section, sensors : dict of str to str
        Tables of campaign.toml; an empty `sensors` is left out.
    kinds : list of MeasuredKind
        The records.
    order : list of (int, int)
        Kind and record in the order of the list; a later record of the same condition is a repeat of the first.
    """
    folder.mkdir(parents=True, exist_ok=True)
    lines = [f'title = "{title}"', "", "[section]", *(f'{k} = "{v}"' for k, v in section.items())]
    if sensors:
        lines += ["", "[sensors]", *(f'{k} = "{v}"' for k, v in sensors.items())]
    (folder / "campaign.toml").write_text("\n".join(lines) + "\n", encoding="utf-8")
    rows: list[dict[str, str]] = []
    first: dict[tuple[int, int], str] = {}
    for number, (k, r) in enumerate(order, start=1):
        name = f"e{number:02d}"
        (folder / f"{name}.csv").write_text(_table(kinds[k], r), encoding="utf-8")
        repeat_of = first.setdefault((k, kinds[k].condition[r]), name)
        rows.append(
            {
                "id": name,
                "file": f"{name}.csv",
                "repeat_of": "" if repeat_of == name else repeat_of,
                **_cells(kinds[k], r),
            }
        )
    required = ["id", "kind", "file", "specimen", "repeat_of", "set"]
    optional = [
        "control",
        "direction",
        "frequency [Hz]",
        "axial tension [N]",
        "temperature [degC]",
        "specimen length [m]",
    ]
    header = required + [name for name in optional if any(name in row for row in rows)]
    table = [header] + [[row.get(name, "") for name in header] for row in rows]
    (folder / "experiments.csv").write_text("\n".join(",".join(row) for row in table) + "\n", encoding="utf-8")
