"""From the tables of a cable file to a Cable: names are looked up, cores laid, rings and layers of wires put round them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, TypeVar

import numpy as np
from pydantic import BaseModel

from geometry.cable import Cable, MarkedNumber, Part
from geometry.cable_schema import CableTable, CoreTable, CylinderTable, StrandedTable, StrandTable, WiresTable
from geometry.errors import SpecError
from geometry.helix import HANDS
from geometry.lay_up import Layer, Round, check_names, lay_up, ring_part
from geometry.material import Material
from geometry.specimen_case import SpecimenCase
from geometry.strand import Conductor, Strand, stranded_conductor
from geometry.strand_contact import WIDEST
from geometry.wire_layer import WireLayer, check_layer, layer_parts

T = TypeVar("T")


def _collected(table: BaseModel, prefix: str = "") -> list[MarkedNumber]:
    """All marked numbers of a table with their keys."""
    found: list[MarkedNumber] = []
    for field, info in type(table).model_fields.items():
        found += _collected_value(getattr(table, field), f"{prefix}{info.alias or field}")
    return found


def _collected_value(value: Any, key: str) -> list[MarkedNumber]:
    if isinstance(value, MarkedNumber):
        return [value._replace(key=key)]
    if isinstance(value, BaseModel):
        return _collected(value, f"{key}.")
    if isinstance(value, dict):
        return [number for name, item in value.items() for number in _collected_value(item, f"{key}.{name}")]
    if isinstance(value, list):
        named = {_named_entry(item, i): item for i, item in enumerate(value) if isinstance(item, BaseModel)}
        return _collected_value(named, key)
    return []


def _named_entry(entry: Any, i: int) -> str:
    return getattr(entry, "name", None) or str(i + 1)


def assembled(table: CableTable) -> Cable:
    """The cable that a checked file describes.

    Raises
    ------
    SpecError
        If a name is not known, or an entry does not suit another.
    GeometryError
        If parts overlap or do not fit.
    """
    materials = {name: Material(name, _si(m.E), _si(m.nu), _si(m.density)) for name, m in table.materials.items()}
    strands = {name: _strand(name, s) for name, s in table.strands.items()}
    conductors = {name: _conductor(name, c, strands, materials) for name, c in table.conductors.items()}
    cores = {name: _core(name, core, conductors, materials) for name, core in table.cores.items()}
    spec = table.lay_up
    lay, hand = _maybe(spec.lay), spec.hand
    laid = lay_up(
        centre=_centre(table, conductors, materials),
        cores=[_named(cores, name, "lay-up.cores", "cores") for name in spec.cores],
        lay=lay,
        twist_rate=_rate(lay, hand),
        phase=_maybe(spec.phase) or 0.0,
        filler=_filler(table, materials),
        pitch_circle_radius=_maybe(spec.pitch_circle_radius),
    )
    parts, layers = _over(table, materials, laid.parts, laid.laid_up_radius, _rate(lay, hand))
    check_names(parts)
    pitch, laid_up = laid.pitch_circle_radius, laid.laid_up_radius
    if layers and not any(part.centre_radius > 0 for part in laid.parts):  # the innermost wires are what is laid up
        pitch, laid_up = layers[0].radius, layers[0].outer_radius
        lay, hand = layers[0].lay, "S" if layers[0].twist_rate < 0 else "Z"
    return Cable(
        name=table.name,
        title=table.title,
        parts=tuple(parts),
        conductors=conductors,
        lay=lay,
        hand=hand,
        pitch_circle_radius=pitch,
        laid_up_radius=laid_up,
        outer_radius=max(part.centre_radius + part.outer_radius for part in parts),
        numbers=tuple(_collected(table)),
        notes=tuple(table.notes),
        data_sheet=_data_sheet(table),
        data_sheet_source="" if table.data_sheet is None else table.data_sheet.source,
        specimen=_specimen(table),
    )


def _over(
    table: CableTable, materials: Mapping[str, Material], inside: Sequence[Part], radius: float, rate: float
) -> tuple[list[Part], list[WireLayer]]:
    """All parts, and the layers of wires: [[layers]] from the inside, then [wrap] and [sheath]."""
    parts, layers = list(inside), []
    for i, spec in enumerate(table.layers):
        name = _layer_name(table, i)
        if isinstance(spec, WiresTable):
            layer = _wire_layer(name, spec, materials, radius)
            check_layer(layer, parts)
            parts += layer_parts(layer, radius)
            layers.append(layer)
            radius = max(radius, layer.outer_radius)
        else:
            material = _named(materials, spec.material, f"layers.{name}.material", "materials")
            parts.append(ring_part(spec.kind, name, material, radius, _si(spec.wall), rate))
            radius = parts[-1].outer_radius
    for kind in ("wrap", "sheath"):
        wall = getattr(table, kind)
        if wall is not None:
            material = _named(materials, wall.material, f"{kind}.material", "materials")
            parts.append(ring_part(kind, kind, material, radius, _si(wall.wall), rate))
            radius = parts[-1].outer_radius
    return parts, layers


def _layer_name(table: CableTable, i: int) -> str:
    """As the file says, or the kind; wires are named by the number of their entry."""
    spec = table.layers[i]
    default = f"layer {i + 1}" if spec.kind == "wires" else spec.kind
    return default if spec.name is None else spec.name


def _wire_layer(name: str, spec: WiresTable, materials: Mapping[str, Material], below: float) -> WireLayer:
    diameter = _si(spec.wire_diameter)
    material = _named(materials, spec.material, f"layers.{name}.material", "materials")
    filler = None if spec.filler is None else _named(materials, spec.filler, f"layers.{name}.filler", "materials")
    return WireLayer(
        name=name,
        kind="armour" if spec.kind == "armour" else "wire",
        count=sum(_ints(spec.wires)),
        diameter=diameter,
        material=material,
        radius=_maybe(spec.radius) or below + diameter / 2,
        phase=_maybe(spec.phase) or 0.0,
        twist_rate=_rate(_maybe(spec.lay), spec.hand),
        filler=filler,
    )


def _rate(lay: float | None, hand: str) -> float:
    return 0.0 if lay is None else HANDS[hand] * 2 * np.pi / lay


def _specimen(table: CableTable) -> SpecimenCase | None:
    spec = table.specimen
    if spec is None:
        return None
    return SpecimenCase(_si(spec.length), _maybe(spec.phase) or 0.0, spec.loaded, spec.held, spec.interface)


def _data_sheet(table: CableTable) -> dict[str, MarkedNumber]:
    sheet = table.data_sheet
    if sheet is None:
        return {}
    stated = {"outer_diameter": sheet.outer_diameter, "mass_per_length": sheet.mass_per_length}
    return {name: number._replace(key=f"data-sheet.{name}") for name, number in stated.items() if number is not None}


def _strand(name: str, spec: StrandTable) -> Strand:
    return Strand(
        name,
        _si(spec.wire_diameter),
        _ints(spec.layers),
        _maybe(spec.lay),
        spec.hand,
        _si(spec.wire_density),
        _si(spec.E),
        _si(spec.nu),
        _maybe(spec.lay_factor),
    )


def _conductor(
    name: str, spec: StrandedTable | CylinderTable, strands: Mapping[str, Strand], materials: Mapping[str, Material]
) -> Conductor:
    if isinstance(spec, StrandedTable):
        strand = _named(strands, spec.strand, f"conductors.{name}.strand", "strands")
        voids = None if spec.voids is None else _named(materials, spec.voids, f"conductors.{name}.voids", "materials")
        layers, widest = _ints(spec.layers), WIDEST * strand.diameter
        flat = _maybe(spec.flat_width)
        if flat is not None and flat > widest:
            raise SpecError(
                f"conductors.{name}.flat_width: flats between strands of {1e3 * strand.diameter:.4g} mm cannot be {1e3 * flat:.4g} mm "
                f"wide; state at most {1e3 * widest:.3g} mm."
            )
        return stranded_conductor(name, strand, layers, _maybe(spec.lay), spec.hand, _maybe(spec.diameter), flat, voids)
    metal = sum(_ints(spec.wires)) * np.pi * _si(spec.wire_diameter) ** 2 / 4
    if _si(spec.fill) <= 0:
        raise SpecError(f"conductors.{name}.fill: the fill must be larger than zero.")
    diameter = float(np.sqrt(4 * metal / (np.pi * _si(spec.fill))))
    stated = _maybe(spec.diameter) or diameter
    if abs(stated / diameter - 1) > 0.01:
        raise SpecError(
            f"conductors.{name}: wires, wire_diameter and fill give a diameter of {1e3 * diameter:.4g} mm, but {1e3 * stated:.4g} mm "
            "is stated: leave one of them out, or correct it."
        )
    factor = 1.0 if spec.lay_factor is None else _si(spec.lay_factor)
    density = _si(spec.fill) * _si(spec.wire_density)
    return Conductor(name, stated, metal, _si(spec.E), _si(spec.nu), density, factor, wires=sum(_ints(spec.wires)))


def _core(name: str, spec: CoreTable, conductors: Mapping[str, Conductor], materials: Mapping[str, Material]) -> Round:
    conductor = _named(conductors, spec.conductor, f"cores.{name}.conductor", "conductors")
    layers = [Layer("conductor", conductor.material, conductor.diameter / 2, conductor.name)]
    if _together(spec.insulation_wall, spec.insulation_material, f"cores.{name}", "insulation"):
        insulation = _named(materials, str(spec.insulation_material), f"cores.{name}.insulation_material", "materials")
        layers.append(Layer("insulation", insulation, layers[-1].outer_radius + (_maybe(spec.insulation_wall) or 0.0)))
    if _together(spec.screen_wall, spec.screen_material, f"cores.{name}", "screen"):
        screen = _named(materials, str(spec.screen_material), f"cores.{name}.screen_material", "materials")
        layers.append(Layer("screen", screen, layers[-1].outer_radius + (_maybe(spec.screen_wall) or 0.0)))
    if len(layers) == 1:
        return Round(name, tuple(layers), bare=True)
    return Round(name if name.endswith("core") else f"{name} core", tuple(layers))


def _centre(table: CableTable, conductors: Mapping[str, Conductor], materials: Mapping[str, Material]) -> Round | None:
    spec = table.centre
    if spec is None:
        return None
    conductor = _named(conductors, spec.conductor, "centre.conductor", "conductors")
    layers = [Layer("conductor", conductor.material, conductor.diameter / 2, conductor.name)]
    if _together(spec.cover_wall, spec.cover_material, "centre", "cover"):
        cover = _named(materials, str(spec.cover_material), "centre.cover_material", "materials")
        layers.append(Layer("cover", cover, layers[-1].outer_radius + (_maybe(spec.cover_wall) or 0.0)))
    return Round(spec.conductor, tuple(layers))


def _filler(table: CableTable, materials: Mapping[str, Material]) -> Material | None:
    """Material of the interstices; modulus and density scale with the fill, a fill of 0 leaves them empty."""
    spec = table.interstices
    if spec is None:
        return None
    solid = _named(materials, spec.material, "interstices.material", "materials")
    fill = 1.0 if spec.fill is None else _si(spec.fill)
    return Material(solid.name, E=fill * solid.E, nu=solid.nu, density=fill * solid.density) if fill > 0 else None


def _together(wall: object, material: object, where: str, kind: str) -> bool:
    if (wall is None) != (material is None):
        missing = f"{kind}_wall" if wall is None else f"{kind}_material"
        raise SpecError(f"{where}.{missing}: this entry is missing; the {kind} needs both its wall and its material.")
    return wall is not None


def _named(table: Mapping[str, T], name: str, where: str, what: str) -> T:
    if name not in table:
        raise SpecError(f'{where}: there is no "{name}" in [{what}]; known are {", ".join(sorted(table)) or "none"}.')
    return table[name]


def _si(number: MarkedNumber) -> float:
    return float(number.value)  # type: ignore[arg-type]


def _maybe(number: MarkedNumber | None) -> float | None:
    return None if number is None else _si(number)


def _ints(number: MarkedNumber) -> tuple[int, ...]:
    return number.value if isinstance(number.value, tuple) else (int(number.value),)
