"""Exports to other beam programs: the numbers in the file, permuted back, are the 6x6; order, units, and what is dropped."""

import csv
import json

import numpy as np
import pytest

from geometry.errors import InputError, SpecError
from homogenize import SectionInertia, SectionStiffness
from homogenize.section_export import (
    AXIAL_FIRST,
    FORMATS,
    ORDERS,
    ExportedSection,
    dropped,
    export_format,
    export_section,
    export_text,
    mass_matrix,
    permuted,
    restored,
)


@pytest.fixture(scope="module")
def cable() -> ExportedSection:
    """Every entry of C is another number, so that no exchange of two can hide."""
    A = np.random.default_rng(7).standard_normal((6, 6))
    scale = np.diag([4e2, 5e2, 2e3, 8.0, 9.0, 10.0])
    section = SectionStiffness(scale @ (A @ A.T + 6 * np.eye(6)) @ scale, 2e-3)
    return ExportedSection("cable", section, SectionInertia(4.05, 6e-4, 7e-4, 13e-4), 0.0516)


def numbers(text: str, width: int) -> np.ndarray:
    """The lines of the text that are `width` numbers."""
    rows = []
    for line in text.splitlines():
        try:
            row = [float(word) for word in line.split()]
        except ValueError:
            continue
        if len(row) == width:
            rows.append(row)
    return np.array(rows)


def test_orders_are_permutations_and_come_back(cable):
    for order in ORDERS.values():
        assert sorted(order) == list(range(6))
        np.testing.assert_array_equal(restored(permuted(cable.section.C, order), order), cable.section.C)


def test_axial_first_is_a_cyclic_renaming_of_the_axes(cable):
    """x1 = z, x2 = x, x3 = y is a rotation: forces and moments as vectors in the new axes give the same matrix, signs included."""
    Q = np.array([[0, 0, 1.0], [1, 0, 0], [0, 1, 0]])
    assert np.linalg.det(Q) == pytest.approx(1.0)
    turn = np.kron(np.eye(2), Q)
    np.testing.assert_allclose(permuted(cable.section.C, AXIAL_FIRST), turn @ cable.section.C @ turn.T, rtol=1e-12)


def test_vabs_round_trip(cable):
    """Stiffness and flexibility, all digits; positive definite; stretch first, twist fourth."""
    rows = numbers(export_text(cable, "vabs"), 6)
    K, F = rows[:6], rows[6:]
    np.testing.assert_array_equal(restored(K, ORDERS["vabs"]), cable.section.C)
    np.testing.assert_allclose(K @ F, np.eye(6), atol=1e-9)
    assert np.linalg.eigvalsh(K).min() > 0
    assert (
        K[0, 0] == cable.section.EA_blocked_twist and K[3, 3] == cable.section.GJ and K[0, 3] == cable.section.coupling
    )


def test_beamdyn_round_trip(cable):
    """Two stations with the same 6x6 stiffness and mass; damping zero."""
    rows = numbers(export_text(cable, "beamdyn"), 6)
    np.testing.assert_array_equal(rows[0], np.zeros(6))
    for station in (rows[1:13], rows[13:25]):
        np.testing.assert_array_equal(station[:6], cable.section.C)
        np.testing.assert_array_equal(station[6:], mass_matrix(cable.inertia))
    assert len(rows) == 25
    np.testing.assert_array_equal(numbers(export_text(cable, "beamdyn"), 1).ravel(), [0.0, 1.0])


def test_exudyn_round_trip(cable):
    """Keys are the attributes of BeamSection; inertia about the beam axis first."""
    record = json.loads(export_text(cable, "exudyn"))
    np.testing.assert_array_equal(restored(np.array(record["stiffnessMatrix"]), ORDERS["exudyn"]), cable.section.C)
    assert record["massPerLength"] == 4.05
    assert np.diag(record["inertia"]).tolist() == [13e-4, 6e-4, 7e-4]


def test_moordyn_line_types(cable):
    """Two line types, twist blocked and free; SI; ten columns as named."""
    lines = export_text(cable, "moordyn").splitlines()
    header = next(line.split() for line in lines if line.startswith("TypeName"))
    rows = [dict(zip(header, line.split())) for line in lines if line.startswith("cable_")]
    assert [row["TypeName"] for row in rows] == ["cable_blocked", "cable_free"]
    expected = (cable.section.EA_blocked_twist, cable.section.EA_free_twist)
    np.testing.assert_allclose([float(row["EA"]) for row in rows], expected, rtol=1e-9)
    assert float(rows[0]["Diam"]) == 0.0516 and float(rows[0]["Mass/m"]) == 4.05
    assert float(rows[0]["EI"]) == pytest.approx(0.5 * (cable.section.EI_x + cable.section.EI_y), rel=1e-9)
    assert all(len(row) == 10 for row in rows)


def test_orcaflex_units(cable):
    """kN, t, m: a thousandth of SI; coupling and both axial stiffnesses."""
    rows = {row[0]: float(row[2]) for row in list(csv.reader(export_text(cable, "orcaflex").splitlines()))[2:]}
    s = cable.section
    assert rows["Axial stiffness"] == pytest.approx(s.EA_blocked_twist / 1e3, rel=1e-9)
    assert rows["Axial stiffness without torsion"] == pytest.approx(s.EA_free_twist / 1e3, rel=1e-9)
    assert rows["Tension/torque coupling"] == pytest.approx(s.coupling / 1e3, rel=1e-9)
    assert rows["Torsional stiffness"] == pytest.approx(s.GJ / 1e3, rel=1e-9)
    assert rows["Mass per unit length"] == pytest.approx(4.05e-3)


@pytest.mark.parametrize("format", FORMATS)
def test_every_format_says_what_it_drops(cable, format):
    assert dropped(format) in export_text(cable, format)
    assert ("Lost" in dropped(format)) == (format in ("moordyn", "orcaflex"))


def test_format_by_ending_and_refusals(cable, tmp_path):
    assert export_format("section.K") == "vabs" and export_format("blade.dat") == "beamdyn"
    assert export_section(cable, tmp_path / "new" / "line.csv").read_text().startswith('"cable"')
    with pytest.raises(SpecError, match="names no format"):
        export_format("section.xyz")
    with pytest.raises(SpecError, match="is not known"):
        export_format("a.dat", "abaqus")
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match="cannot be written"):
        export_section(cable, tmp_path / "file" / "line.csv")
