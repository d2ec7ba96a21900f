"""Bonded strands in 3D: a flat of fixed width gives the stiffness a limit under refinement; one that follows the mesh does not.

One conductor of 1 + 6 strands, lay 150 mm, in a rubber cover; 30 000 and 49 000 unknowns.
"""

import numpy as np
import pytest

from geometry import read_cable
from geometry.nested_cell import nested_cell
from homogenize.periodic_cell import solve_periodic_cell
from homogenize.strand_section import strand_mesh, strand_section

MARK = 'status = "published", source = "test"'
ONE_CORE = f"""name = "one-core"
title = "one conductor of seven strands"
[materials.rubber]
E = {{ value = "20 MPa", {MARK} }}
nu = {{ value = 0.45, {MARK} }}
density = {{ value = "1200 kg/m^3", {MARK} }}
[strands.power]
wire_diameter = {{ value = "3 mm", {MARK} }}
layers = {{ value = [1], {MARK} }}
wire_density = {{ value = "8900 kg/m^3", {MARK} }}
E = {{ value = "80 GPa", {MARK} }}
nu = {{ value = 0.34, {MARK} }}
[conductors.power]
strand = "power"
layers = {{ value = [1, 6], {MARK} }}
lay = {{ value = "150 mm", {MARK} }}
VOIDS
[centre]
conductor = "power"
cover_wall = {{ value = "1.5 mm", {MARK} }}
cover_material = "rubber"
"""
COARSE, FINE = 2e-3, 1.4e-3


@pytest.fixture(scope="module")
def one_core(tmp_path_factory):
    """The cable, empty and with rubber in its voids."""
    cables = []
    for k, voids in enumerate(("", 'voids = "rubber"')):
        path = tmp_path_factory.mktemp("one") / f"core-{k}.toml"
        path.write_text(ONE_CORE.replace("VOIDS", voids), encoding="utf-8")
        cables.append(read_cable(path))
    return cables


@pytest.fixture(scope="module")
def stiffness(one_core):
    """EA, coupling and GJ by size and width of the flats."""
    found = {}
    for size, width in ((COARSE, 0.45e-3), (FINE, 0.45e-3), (COARSE, 0.72e-3), (FINE, 0.504e-3)):
        cell = nested_cell(one_core[0], size=size, flat_width=width, layers=20)
        assert f"flats {1e3 * width:.3g} mm wide." in cell.notes[0]
        K = solve_periodic_cell(cell).stiffness
        found[size, width] = np.array([K[0, 0], K[0, 1], K[1, 1]])
    return found


def test_flat_of_fixed_width_has_a_limit(stiffness):
    """EA moves by less than 1e-3, coupling by 4 %, GJ by 3 % where the unknowns grow by 1.6 (bilinear bricks still converge)."""
    change = stiffness[FINE, 0.45e-3] / stiffness[COARSE, 0.45e-3] - 1
    assert (np.abs(change) < [1e-3, 0.04, 0.03]).all()


def test_flat_that_follows_the_mesh_has_none(stiffness):
    """Flats of a fifth of the size to each side, as the mesh would draw them: EA, coupling and GJ move three times as much."""
    fixed = stiffness[FINE, 0.45e-3] / stiffness[COARSE, 0.45e-3] - 1
    follows = stiffness[FINE, 0.504e-3] / stiffness[COARSE, 0.72e-3] - 1
    assert (np.abs(follows) > 3 * np.abs(fixed)).all()


def test_wider_flats_hold_better(stiffness):
    """EA and GJ grow with the width of bonded flats, on one mesh; the torque that a blocked end feels falls."""
    wide, narrow = stiffness[COARSE, 0.72e-3], stiffness[COARSE, 0.45e-3]
    assert wide[0] > narrow[0] and wide[1] < narrow[1] and wide[2] > narrow[2]


def test_filled_voids_only_add(one_core):
    """Material where there was none, bonded: no load finds the conductor softer (3D: EA, GJ and determinant; 2D: all six)."""
    empty, filled = (solve_periodic_cell(nested_cell(c, size=4e-3, layers=20)).stiffness for c in one_core)
    assert np.linalg.eigvalsh(filled - empty).min() > 0
    assert filled[0, 0] < 1.01 * empty[0, 0]  # 20 MPa on a fifth of the section beside 80 GPa
    rope = [strand_section(c.conductors["power"]).stiffness.C for c in one_core]
    scale = 1 / np.sqrt(np.diag(rope[0]))
    assert np.linalg.eigvalsh((rope[1] - rope[0]) * np.outer(scale, scale)).min() > -1e-9
    assert rope[1][2, 2] > rope[0][2, 2]
    mesh = strand_mesh(one_core[1].conductors["power"])
    assert (mesh.regions[-1].name, mesh.regions[-1].material.name) == ("voids", "rubber")
