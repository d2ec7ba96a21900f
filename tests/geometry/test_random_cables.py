"""Whatever the cable: its parts fill its circle, it weighs something, and its mirror image differs in hand only."""

import tempfile
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from geometry import read_cable
from geometry.wire_layer import largest_count, neighbour_clearances

FEW = settings(max_examples=15, deadline=None)


def n(value, unit="mm"):
    shown = f"{value:.9g}" if unit == "1" else f'"{value:.9g} {unit}"'
    return f'{{ value = {shown}, status = "computed", source = "test" }}'


MATERIAL = f"E = {n(5, 'MPa')}\nnu = {n(0.45, '1')}\ndensity = {n(1200, 'kg/m^3')}\n"


@st.composite
def cables(draw):
    """Text of a filled cable: cores, perhaps a centre, perhaps bedding and filled armour, sheath."""
    count, wall = draw(st.integers(1, 6)), draw(st.floats(0.5, 4.0))
    wire, ratio = draw(st.floats(1.0, 8.0)), draw(st.floats(10.0, 30.0))
    hand, armoured = draw(st.sampled_from("ZS")), draw(st.booleans())
    core = wire / 2 + wall
    packed = core / np.sin(np.pi / max(count, 2)) + core  # radius over straight cores that touch each other
    text = 'name = "random"\ntitle = "random"\n'
    text += (
        f'[conductors.a]\nwires = {{ value = 1, status = "computed", source = "test" }}\nwire_diameter = {n(wire)}\n'
    )
    text += f"wire_density = {n(8900, 'kg/m^3')}\nfill = {n(1.0, '1')}\nE = {n(100, 'GPa')}\nnu = {n(0.3, '1')}\n"
    text += f'[cores.a]\nconductor = "a"\ninsulation_wall = {n(wall)}\ninsulation_material = "soft"\n'
    if draw(st.booleans()) and count > 1:
        text += f'[centre]\nconductor = "a"\ncover_wall = {n(packed)}\ncover_material = "soft"\n'
        packed += packed + 2 * core
    text += f'[lay-up]\ncores = {["a"] * count}\nlay = {n(2 * ratio * packed)}\nhand = "{hand}"\n'.replace("'", '"')
    text += '[interstices]\nmaterial = "soft"\n'
    if armoured:
        radius, thin, lay = packed + 5, draw(st.floats(0.5, 2.0)), 16 * packed
        share = draw(st.floats(0.2, 0.95))
        wires = max(1, int(share * largest_count(radius * 1e-3, thin * 1e-3, lay * 1e-3)))
        text += f'[[layers]]\nkind = "bedding"\nwall = {n(0.3)}\nmaterial = "soft"\n'
        text += f'[[layers]]\nkind = "armour"\nwires = {{ value = {wires}, status = "computed", source = "test" }}\n'
        text += (
            f'wire_diameter = {n(thin)}\nradius = {n(radius)}\nlay = {n(lay)}\nhand = "{draw(st.sampled_from("ZS"))}"\n'
        )
        text += 'material = "soft"\nfiller = "soft"\n'
    return text + f'[sheath]\nwall = {n(1.5)}\nmaterial = "soft"\n[materials.soft]\n{MATERIAL}'


def read(text):
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "random.toml"
        path.write_text(text, encoding="utf-8")
        return read_cable(path)


def mirrored(text):
    return (
        text.replace('hand = "Z"', 'hand = "?"').replace('hand = "S"', 'hand = "Z"').replace('hand = "?"', 'hand = "S"')
    )


@FEW
@given(cables())
def test_areas_of_the_parts_add_up_to_the_outer_circle(text):
    """Filled cables have no voids; the filler is what is left, and nothing is left over."""
    cable = read(text)
    assert sum(part.area for part in cable.parts) == pytest.approx(cable.area, rel=1e-10)
    assert all(part.area > 0 for part in cable.parts)
    assert cable.mass_per_length > 0
    assert min(part.material.density for part in cable.parts) * cable.area < cable.mass_per_length


@FEW
@given(cables())
def test_the_mirror_image_differs_in_hand_only(text):
    one, other = read(text), read(mirrored(text))
    assert other.lays == pytest.approx([-rate for rate in one.lays])
    assert other.mass_per_length == pytest.approx(one.mass_per_length, rel=1e-12)
    assert [p.area for p in other.parts] == pytest.approx([p.area for p in one.parts], rel=1e-9)
    assert [c.gap for c in neighbour_clearances(other)] == pytest.approx(
        [c.gap for c in neighbour_clearances(one)], abs=1e-9
    )
    assert other.rotary_inertia.J_z == pytest.approx(one.rotary_inertia.J_z, rel=1e-9)


@FEW
@given(cables())
def test_nothing_overlaps_in_a_cable_that_was_read(text):
    assert all(c.gap >= -1e-6 for c in neighbour_clearances(read(text)))
