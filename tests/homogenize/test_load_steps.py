"""Apparent moduli from load steps: the linear limit, the sign of a load; a coarse section has the areas of its parts."""

import dataclasses

import numpy as np
import pytest
from section_meshes import rings

from geometry import read_cable
from geometry.errors import MeshError, SpecError
from homogenize.interface_choice import Interfaces
from homogenize.section_field import section_field
from homogenize.specimen import (
    AxialGrading,
    FrictionalContact,
    LoadCase,
    Specimen,
    coarse_section,
    contact_path,
    contact_specimen,
    follow_specimen,
    initial_state,
    solve_specimen,
)
from homogenize.specimen.apparent_modulus import apparent_moduli
from homogenize.specimen.load_steps import contact_modulus, equal_steps, followed_modulus

GRADING = AxialGrading(end_size=0.3, largest=1.0, growth=2.0, degree=2)
SPECIMEN = Specimen(0.04, grading=GRADING)
NUMBERS = ("modulus", "mean_stress", "mean_strain", "u_max", "u_mean", "modulus_of_maximum", "modulus_of_mean")


@pytest.fixture(scope="module")
def mesh():
    """A stiff core in rubber, nu 0.3 so that no volume strain is smoothed away."""
    return rings((0.006, 0.012), (60e6, 0.3), (4e6, 0.3), around=8, per_ring=1, twist_rate=20.0)


def linear(mesh, load):
    return apparent_moduli(solve_specimen(SPECIMEN, mesh, [load], tolerance=1e-8))[0]


@pytest.mark.parametrize("load", [LoadCase("tension", 1e-3), LoadCase("shear", -1e-4, "y")], ids=lambda load: load.name)
def test_small_loads_have_the_numbers_of_the_linear_specimen(mesh, load):
    """Every definition, R2 of 1. rtol 1e-6: strains of 1e-6. The stress is F / A, of which the linear specimen's average over its
    volume is off by 1e-3 on these layers."""
    (followed,) = follow_specimen(SPECIMEN, mesh, [load], shares=equal_steps(2), volume_strain="full")
    found, want = followed_modulus(followed, SPECIMEN.length), linear(mesh, load)
    for name in NUMBERS:
        rtol = 2e-3 if name in ("modulus", "mean_stress") else 1e-6
        assert getattr(found, name) == pytest.approx(getattr(want, name), rel=rtol), name
    area = section_field(mesh).area
    assert found.mean_stress == pytest.approx(abs(load.size) / area) == pytest.approx(found.modulus * found.mean_strain)
    assert found.load == load.name and found.curve.R2 == pytest.approx(1.0)


def test_held_contacts_have_the_numbers_of_the_linear_specimen(mesh):
    """Gripped beyond any load, both signs. rtol 2e-3: the interface itself yields by 1e-12 m/Pa."""
    law = FrictionalContact(10.0, grip=1e9, normal=1e12, tangential=1e12)
    named = dataclasses.replace(SPECIMEN, interface=Interfaces({"part 0-part 1": law}))
    contacts = contact_specimen(named, mesh, [LoadCase("tension", 1.0), LoadCase("shear", 1.0, "y")])
    start = initial_state(contacts)
    for k, sign in ((0, 1.0), (1, 1.0), (1, -1.0)):
        load = dataclasses.replace(contacts.loads[k], size=sign)
        found = contact_modulus(contacts, k, start, contact_path(contacts, k, [0.5 * sign, sign], start))
        want = linear(mesh, load)
        assert found.load == load.name
        for name in NUMBERS:
            assert getattr(found, name) == pytest.approx(getattr(want, name), rel=2e-3), name


def test_steps_are_counted():
    assert equal_steps(2) == (0.5, 1.0)
    with pytest.raises(SpecError, match="1 to 50 steps"):
        equal_steps(0)


def test_a_coarse_section_has_the_areas_of_its_parts():
    """Ellipses R by R / cos beta for round parts at a lay angle. rtol 1e-2: eight quadratic edges to a circle, which
    give way in the neck of 0.2 mm at the centre."""
    cable = read_cable("paper-specimen-3x35")
    mesh = coarse_section(cable)
    field = section_field(mesh)
    assert len(mesh.cells) < 500
    area = {r.name: field.weight[field.region_of == k].sum() for k, r in enumerate(mesh.regions)}
    for part in cable.parts:
        if part.kind in ("conductor", "insulation"):
            assert area[part.name] == pytest.approx(part.area, rel=1e-2)
    assert field.area == pytest.approx(np.pi * cable.outer_radius**2, rel=5e-3)


def test_a_filler_unlike_the_sheath_is_a_region_of_its_own():
    """The cores bite into the sheath by 0.3 mm; it keeps its area within 5 %. A layer between the two has no coarse section."""
    cable = read_cable("mcpt-1.9-3.3-3x35-specimen")
    mesh = coarse_section(cable)
    field = section_field(mesh)
    area = {r.name: field.weight[field.region_of == k].sum() for k, r in enumerate(mesh.regions)}
    assert set(area) == {part.name for part in cable.parts}
    for part in cable.parts:
        assert area[part.name] == pytest.approx(part.area, rel=0.08 if part.name == "interstices" else 0.05)
    assert len(mesh.cells) < 500
    with pytest.raises(MeshError, match="wrap lies between"):
        coarse_section(read_cable("mcpt-1.9-3.3-3x35"))
