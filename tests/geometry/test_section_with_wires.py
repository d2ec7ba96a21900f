"""Sections of one lay with a layer of wires: every region has its area; what one section cannot hold is refused in a sentence."""

from pathlib import Path

import numpy as np
import pytest

from geometry import MeshError, cable_files, cross_section_mesh, element_sizes, read_cable

EXAMPLE = cable_files()["example-three-core"].read_text(encoding="utf-8")
THREE = 'cores = ["core", "core", "core"]'


def n(text):
    shown = text if " " not in text else f'"{text}"'
    return f'{{ value = {shown}, status = "computed", source = "test" }}'


def armour(count, lay, filler=""):
    return (
        f'\n[[layers]]\nkind = "armour"\nwires = {n(str(count))}\nwire_diameter = {n("0.8 mm")}\nlay = {n(lay)}\nhand = "S"\n'
        f'material = "steel"\n{filler}\n[materials.steel]\nE = {n("200 GPa")}\nnu = {n("0.3")}\ndensity = {n("7850 kg/m^3")}\n'
    )


def read(folder: Path, text: str):
    path = folder / "mine.toml"
    path.write_text(text, encoding="utf-8")
    return read_cable(path)


def single(text):
    lines = text.replace(THREE, 'cores = ["core"]').splitlines()
    return "\n".join(line for line in lines if not line.startswith("lay = "))


def without_sheath(text):
    start = text.index("[sheath]")
    return text[:start] + text[text.index("[materials", start) :]


@pytest.mark.parametrize("filler", ["", 'filler = "filler rubber"'])
@pytest.mark.parametrize("sheath", [True, False])
def test_one_core_under_armour(filler, sheath, tmp_path):
    """The cable turns with its armour; areas are exact up to the closures at contacts (0.4 % of a layer)."""
    text = single(EXAMPLE) + armour(14, "60 mm", filler)
    cable = read(tmp_path, text if sheath else without_sheath(text))
    assert cable.single_lay and cable.twist_rate == pytest.approx(-2 * np.pi / 0.06)
    assert cable.twist_rate == cable.part("armour wire 1").twist_rate
    mesh = cross_section_mesh(cable)
    areas = np.bincount(mesh.region_of, element_sizes(mesh), len(mesh.regions))
    assert areas == pytest.approx([part.area for part in cable.parts], rel=0.012)
    if filler and sheath:
        assert areas.sum() == pytest.approx(cable.area, rel=1e-5)


def test_cores_in_filler_without_anything_round_them(tmp_path):
    cable = read(tmp_path, without_sheath(EXAMPLE))
    mesh = cross_section_mesh(cable)
    assert element_sizes(mesh).sum() == pytest.approx(cable.area, rel=2e-3)


def test_straight_cores_under_laid_armour_are_two_lays(tmp_path):
    text = "\n".join(line for line in EXAMPLE.splitlines() if not line.startswith("lay = "))
    with pytest.raises(MeshError, match=r"the cores straight, armour 90 mm S"):
        cross_section_mesh(read(tmp_path, text + armour(20, "90 mm")))


def test_two_layers_of_one_lay_are_refused(tmp_path):
    tape = f'\n[[layers]]\nkind = "tape"\nwall = {n("0.5 mm")}\nmaterial = "rubber sheath"\n'
    for layers, said in (
        (armour(20, "90 mm"), "armour wire 1 lies outside the interstices"),
        (tape + armour(20, "90 mm"), "tape lies between two layers"),
        (armour(20, "90 mm", 'filler = "filler rubber"'), "interstices and armour filler cannot"),
    ):
        with pytest.raises(MeshError, match=said):
            cross_section_mesh(read(tmp_path, EXAMPLE + layers))
