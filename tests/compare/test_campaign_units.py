"""Units: in whatever unit a column is written, the same physical loop arrives; another dimension is refused."""

from __future__ import annotations

import numpy as np
import pytest

from compare import Campaign
from geometry.errors import SpecError

KIND = "id,kind,file,specimen,repeat_of,set,specimen length [{length}],temperature [{temperature}],{more}\n"


def one(folder, kind, head, rows, length="m", temperature="degC", more="axial tension [N]", cells="2,20,5"):
    listed = KIND.format(length=length, temperature=temperature, more=more) + f"a,{kind},a.csv,S,,calibrate,{cells}\n"
    table = head + "\n" + "\n".join(",".join(f"{v:.17g}" for v in row) for row in rows) + "\n"
    return Campaign.read(folder({"experiments.csv": listed, "a.csv": table}))["a"]


@pytest.mark.parametrize(
    ("kind", "path", "unit", "si", "per_si"),
    [
        ("tension", "extension", "mm", "m", 1e3),
        ("tension", "extension", "m", "m", 1.0),
        ("tension", "strain", "-", "1", 1.0),
        ("tension", "strain", "%", "1", 1e2),
        ("tension", "strain", "mm/m", "1", 1e3),
        ("torsion", "rotation", "deg", "rad", 180 / np.pi),
        ("torsion", "rotation", "turn", "rad", 1 / (2 * np.pi)),
        ("torsion", "twist", "deg/m", "rad/m", 180 / np.pi),
        ("bending", "curvature", "1/km", "1/m", 1e3),
        ("bending", "curvature", "rad/m", "1/m", 1.0),
    ],
)
def test_path_in_any_unit(folder, kind, path, unit, si, per_si):
    load = {"tension": "force [kN]", "torsion": "torque [kN m]", "bending": "moment [N mm]"}[kind]
    per_load = {"tension": 1e-3, "torsion": 1e-3, "bending": 1e3}[kind]
    true_path, true_load = np.array([0.0, 0.01, 0.03, -0.02]), np.array([0.0, 100.0, 290.0, -210.0])
    rows = np.column_stack([true_path * per_si, true_load * per_load])
    record = one(folder, kind, f"{path} [{unit}],{load}", rows).record
    # two conversions in double precision
    np.testing.assert_allclose(record[path], true_path, rtol=1e-13)
    np.testing.assert_allclose(record[record.measured[0]], true_load, rtol=1e-13)
    assert record.channels[path].unit == si


@pytest.mark.parametrize(
    ("unit", "cell", "kelvin"),
    [("degC", 20, 293.15), ("K", 293.15, 293.15), ("degF", 68, 293.15), ("degC", -40, 233.15)],
)
def test_temperature_scales_have_their_zero(folder, unit, cell, kelvin):
    rows = [(0, 0), (1, 2), (2, 4)]
    experiment = one(folder, "bending", "curvature [1/m],moment [N m]", rows, temperature=unit, cells=f"2,{cell},5")
    assert experiment.conditions["temperature"] == pytest.approx(kelvin, rel=1e-12)


@pytest.mark.parametrize(
    ("column", "cell", "name", "si"),
    [
        ("axial tension [kN]", 4, "axial tension", 4000.0),
        ("inclination [deg]", 6, "inclination", np.pi / 30),
        ("frequency [1/min]", 30, "frequency", 0.5),
        ("frequency [mHz]", 247, "frequency", 0.247),
        ("drum diameter [mm]", 450, "drum diameter", 0.45),
        ("motor speed [rpm]", 60, "motor speed", 2 * np.pi),
    ],
)
def test_conditions_of_any_name_are_si(folder, column, cell, name, si):
    rows = [(0, 0), (1, 2), (2, 4)]
    experiment = one(folder, "bending", "curvature [1/m],moment [N m]", rows, more=column, cells=f"2,20,{cell}")
    assert experiment.conditions[name] == pytest.approx(si, rel=1e-12)


def test_clock_in_minutes(folder):
    rows = [(0, 0, 0), (1, 1, 2), (2, 2, 4)]
    record = one(folder, "bending", "time [min],curvature [1/m],moment [N m]", rows).record
    np.testing.assert_allclose(record.time, [0, 60, 120], rtol=1e-15)


@pytest.mark.parametrize(
    ("kind", "head", "column"),
    [
        ("tension", "extension [mm],force [N m]", "force [N m]"),
        ("tension", "strain [mm],force [N]", "strain [mm]"),
        ("tension", "strain [deg],force [N]", "strain [deg]"),
        ("torsion", "rotation [m],torque [N m]", "rotation [m]"),
        ("torsion", "rotation [%],torque [N m]", "rotation [%]"),
        ("bending", "curvature [1/m],moment [Nm]", "moment [Nm]"),
        ("bending", "curvature [m],moment [N m]", "curvature [m]"),
        ("bending", "curvature [1/m],moment [furlongish]", "moment [furlongish]"),
        ("bending", "time [m],curvature [1/m],moment [N m]", "time [m]"),
        ("bending", "curvature [],moment [N m]", "curvature []"),
        ("bending", "curvature,moment [N m]", "curvature"),
    ],
)
def test_wrong_dimension_names_file_row_and_column(folder, kind, head, column):
    with pytest.raises(SpecError) as caught:
        one(folder, kind, head, [tuple(range(head.count(",") + 1))] * 3)
    assert f'a.csv, row 1, column "{column}"' in str(caught.value)


@pytest.mark.parametrize("column", ["temperature [m]", "frequency [rad/s]", "axial tension [kg]", "drum [parsnip]"])
def test_wrong_dimension_of_a_condition(folder, column):
    listed = f"id,kind,file,specimen,repeat_of,set,{column}\na,bending,a.csv,S,,calibrate,1\n"
    with pytest.raises(SpecError) as caught:
        Campaign.read(folder({"experiments.csv": listed}))
    assert f'experiments.csv, row 1, column "{column}"' in str(caught.value)
