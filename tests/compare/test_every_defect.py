"""Every kind of defect through every verb: a sentence that names file, row and column, or a stated limitation.

Never a traceback, never a number in the JSON that is not finite, never a verdict about data that were not understood.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from helicable.main import main

Array = NDArray[np.float64]
TOML = 'title = "a test"\n[section]\nEI = "95 N m^2"\nEA = "4.0e5 N"\nGA = "1.6e5 N"\nGJ = "60 N m^2"\n'
HEAD = "id,kind,file,specimen,repeat_of,set,specimen length [m]\n"
COLUMNS = "time [s],curvature [1/m],moment [N m]\n"
FEW = "interlayer-friction,viscous-damping,sensor-offset"
VERBS: dict[str, list[str]] = {
    "check": [],
    "compare": [],
    "explain": ["--effects", FEW],
    "add": ["viscous-damping"],
    "next": [],
}


def curve(n: int = 40, largest: float = 0.4, seed: int = 0) -> Array:
    """Time, curvature and moment of one cycle of a linear specimen, white noise of 0.3 N m."""
    time = np.linspace(0, 20, n)
    curvature = largest * np.sin(np.linspace(0, 2 * np.pi, n))
    return np.column_stack([time, curvature, 90 * curvature + np.random.default_rng(seed).normal(0, 0.3, n)])


def text(values: Array) -> str:
    return COLUMNS + "".join(",".join(f"{v:.9g}" for v in row) + "\n" for row in values)


def rows(*lines: str) -> str:
    return HEAD + "".join(f"{line}\n" for line in lines)


PAIR = rows("a,bending,a.csv,S1,,calibrate,1", "b,bending,b.csv,S1,a,calibrate,1", "c,bending,c.csv,S1,,validate,1")
SOUND = {
    "campaign.toml": TOML,
    "experiments.csv": PAIR,
    "a.csv": text(curve(seed=1)),
    "b.csv": text(curve(seed=2)),
    "c.csv": text(curve(largest=0.3, seed=3)),
}


def changed(row: int, line: str) -> str:
    """Table a with one line of the file replaced; the header is row 1."""
    lines = SOUND["a.csv"].splitlines()
    lines[row - 1] = line
    return "\n".join(lines) + "\n"


@pytest.fixture
def campaign(tmp_path: Path) -> Callable[..., Path]:
    def write(changes: Mapping[str, str]) -> Path:
        folder = tmp_path / "campaign"
        folder.mkdir()
        for name, content in {**SOUND, **changes}.items():
            (folder / name).write_text(content)
        return folder

    return write


def finite(value: Any, where: str = "") -> list[str]:
    """Places in a JSON object that hold a number which is not finite."""
    if isinstance(value, Mapping):
        return [w for k, v in value.items() for w in finite(v, f"{where}.{k}")]
    if isinstance(value, list):
        return [w for i, v in enumerate(value) for w in finite(v, f"{where}[{i}]")]
    return [where] if isinstance(value, float) and not math.isfinite(value) else []


def run(verb: str, folder: Path, out: Path) -> tuple[int, dict[str, Any] | None]:
    """Exit code and JSON of one verb."""
    code = main([verb, str(folder), *VERBS[verb], "--json", str(out)])
    record = json.loads(out.read_text()) if out.exists() else None
    assert record is None or finite(record) == []
    return code, record


REFUSED = {
    "wrong unit": ({"a.csv": changed(1, "time [s],curvature [1/m],moment [N]")}, ["a.csv, row 1", "moment [N]"]),
    "unit of no meaning": (
        {"a.csv": changed(1, "time [s],curvature [1/m],moment [N blob]")},
        ["a.csv, row 1", "moment [N blob]"],
    ),
    "missing column": ({"a.csv": changed(1, "time [s],curvature [1/m]")}, ["a.csv, row 1", "moment [N m]", "missing"]),
    "missing cell": ({"a.csv": changed(7, "1.5,0.1")}, ["a.csv, row 7", "2 cell(s)"]),
    "text in a number": ({"a.csv": changed(9, "3.6,0.36,about 30")}, ["a.csv, row 9", "moment [N m]", "about 30"]),
    "duplicate id": (
        {"experiments.csv": rows("a,bending,a.csv,S1,,calibrate,1", "a,bending,b.csv,S1,,calibrate,1")},
        ["experiments.csv, row 3", '"id"', '"a"'],
    ),
    "NaN row": ({"a.csv": changed(12, "5.2,nan,nan")}, ["a.csv, row 12", "curvature [1/m]", "nan"]),
    "NaN instant": ({"a.csv": changed(12, "nan,0.4,36")}, ["a.csv, row 12", "time [s]", "nan"]),
    "time backwards": ({"a.csv": changed(12, "0.1,0.4,36")}, ["a.csv, row 12", "time [s]", "runs backwards"]),
    "empty table": ({"a.csv": ""}, ["a.csv", "empty"]),
    "empty list": ({"experiments.csv": ""}, ["experiments.csv", "empty"]),
    "empty campaign.toml": ({"campaign.toml": ""}, ["campaign.toml", "empty"]),
    "header only": ({"a.csv": COLUMNS}, ["a.csv", "no row"]),
    "single sample": ({"a.csv": COLUMNS + "0,0,0\n"}, ["a.csv", "1 row(s)"]),
    "unknown set": (
        {"experiments.csv": rows("a,bending,a.csv,S1,,training,1")},
        ["experiments.csv, row 2", '"set"', '"training"'],
    ),
    "a towing record of four samples": (
        {
            "campaign.toml": TOML
            + '[towing]\nfriction_coefficient = 0.3\ncable_length = "9 m"\nmass_per_length = "4 kg/m"\n'
            + 'tail_tension = "50 N"\ninclination = "0 deg"\n',
            "experiments.csv": rows("a,towing,a.csv,S1,,calibrate,"),
            "a.csv": "time [s],position [m],tension [N]\n0,0,50\n1,0.1,60\n2,0.2,61\n3,0.2,61\n",
        },
        ["a.csv", "4 samples are no towing record"],
    ),
}


@pytest.mark.parametrize("verb", VERBS)
@pytest.mark.parametrize("defect", REFUSED)
def test_what_is_not_understood_is_refused_by_every_verb(campaign, tmp_path, capsys, defect, verb):
    changes, words = REFUSED[defect]
    code, record = run(verb, campaign(changes), tmp_path / "out.json")
    said = capsys.readouterr().err
    assert code == 2 and record is None
    assert said.count("helicable: ") == 1
    for word in words:
        assert word in said
    assert "Traceback" not in said


ZERO = text(curve(seed=1) * [1, 1, 0])
SILENT = text(curve(seed=1) * [1, 0, 0])
STILL = text(curve(seed=1) * [1, 0, 0] + [0, 0.2, 18.0] + np.random.default_rng(4).normal(0, 0.3, (40, 3)) * [0, 0, 1])
EXACT = text(np.outer(np.arange(40), [0.5, 0.01, 0.9]))

LIMITED = {
    "no repeats": (
        {"experiments.csv": PAIR.replace(",a,calibrate", ",,calibrate")},
        "noise assumed",
    ),
    "one experiment": ({"experiments.csv": rows("a,bending,a.csv,S1,,calibrate,1")}, "noise assumed"),
    "one experiment, no specimen, no length": (
        {"experiments.csv": rows("a,bending,a.csv,,,calibrate,")},
        "noise assumed",
    ),
    "constant path": (
        {"experiments.csv": rows("a,bending,a.csv,S1,,calibrate,1"), "a.csv": STILL},
        "noise assumed",
    ),
    "path of zero": (
        {"experiments.csv": rows("a,bending,a.csv,S1,,calibrate,1"), "a.csv": SILENT},
        "not determined",
    ),
    "channel of zeros": ({"experiments.csv": rows("a,bending,a.csv,S1,,calibrate,1"), "a.csv": ZERO}, "not positive"),
    "no noise at all": (
        {"experiments.csv": rows("a,bending,a.csv,S1,,calibrate,1"), "a.csv": EXACT},
        "so smooth that they show no noise",
    ),
    "repeats of different length": ({"b.csv": text(curve(seed=2)[:25])}, ""),
    "repeats that are copies": ({"b.csv": SOUND["a.csv"]}, "byte for byte"),
    "repeats of another path": ({"b.csv": text(curve(largest=0.3, seed=2))}, "not used as a repeat"),
    "three samples": (
        {"experiments.csv": rows("a,bending,a.csv,S1,,calibrate,1"), "a.csv": COLUMNS + "0,0,0\n1,0.1,9.1\n2,0.2,18\n"},
        "noise assumed",
    ),
    "validation only": ({"experiments.csv": rows("c,bending,c.csv,S1,,validate,1")}, ""),
    "sealed only": ({"experiments.csv": rows("c,bending,c.csv,S1,,sealed,1")}, "sealed"),
}
NO_CALIBRATION = ("validation only", "sealed only")


@pytest.mark.parametrize("verb", VERBS)
@pytest.mark.parametrize("limit", LIMITED)
def test_what_is_poor_is_read_and_its_limit_is_stated(campaign, tmp_path, capsys, limit, verb):
    changes, words = LIMITED[limit]
    code, record = run(verb, campaign(changes), tmp_path / "out.json")
    said = capsys.readouterr()
    assert "Traceback" not in said.err
    if record is None:  # one sentence why, and what to do
        assert code in (1, 2) and limit in NO_CALIBRATION
        assert "calibrate" in said.err and said.err.count("helicable: ") == 1
    else:
        assert code == 0 or limit in NO_CALIBRATION
        notes = " ".join(record["notes"])
        assert words in notes or limit in NO_CALIBRATION
        if verb == "explain":
            assert record["verdict"] in ("none", "identified", "family-identified", "confusable", "unknown")


@pytest.mark.parametrize("verb", ("check", "compare", "explain"))
def test_a_million_rows_are_read(campaign, tmp_path, verb):
    """A long record of one experiment: 10^6 rows beside short ones."""
    n = 10**6
    values = curve(n, seed=5)
    table = COLUMNS + "\n".join(f"{t:.6f},{k:.6f},{m:.4f}" for t, k, m in values.tolist()) + "\n"
    code, record = run(verb, campaign({"c.csv": table}), tmp_path / "out.json")
    assert code == 0 and record is not None
    if verb == "compare":
        assert {row["id"] for row in record["experiments"]} == {"a", "b", "c"}
