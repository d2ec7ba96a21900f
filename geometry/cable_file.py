"""Read a cable file: from TOML text to a Cable, or one sentence that says what is wrong and where.

Built-in cables live in data/cables/ of the source tree, which an installed package carries as geometry/cables/.
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from pydantic import BaseModel, ValidationError

from geometry.cable import Cable, MarkedNumber
from geometry.cable_schema import PLACE, CableTable, CoreTable, CylinderTable, StrandedTable
from geometry.errors import InputError, SpecError
from geometry.helix import HANDS
from geometry.lay_up import Layer, Round, lay_up, round_layers
from geometry.material import Material
from geometry.strand import Conductor, Strand, stranded_conductor

LARGEST_FILE = 1_000_000
T = TypeVar("T")


@dataclass(frozen=True)
class BuiltinCable:
    """Line of the list of built-in cables; diameter [m], mass per length [kg/m]."""

    name: str
    title: str
    outer_diameter: float
    mass_per_length: float


def cable_files() -> dict[str, Path]:
    """Built-in cable files by name."""
    here = Path(__file__).resolve().parent
    folders = [here / "cables", here.parent / "data" / "cables"]
    return {path.stem: path for folder in folders if folder.is_dir() for path in sorted(folder.glob("*.toml"))}


def builtin_cables() -> list[BuiltinCable]:
    """All built-in cables, by name."""
    cables = [read_cable(path) for _, path in sorted(cable_files().items())]
    return [BuiltinCable(c.name, c.title, c.outer_diameter, c.mass_per_length) for c in cables]


def read_cable(name_or_path: str | Path) -> Cable:
    """Read a cable by its built-in name or from a file.

    Parameters
    ----------
    name_or_path : str or Path
        A built-in name such as "mcpt-1.9-3.3-3x35", or the path of a TOML file.

    Raises
    ------
    SpecError
        If there is no such cable, or the file cannot be understood; the message names file and key.
    GeometryError
        If the parts of the cable do not fit.

    Examples
    --------
    >>> cable = read_cable("mcpt-1.9-3.3-3x35")
    >>> round(1e3 * cable.outer_diameter, 1), round(cable.mass_per_length, 2)
    (51.6, 4.05)
    """
    path = cable_files().get(str(name_or_path), Path(name_or_path))
    table = _validated(_parsed(path), path.name)
    try:
        return _assembled(table)
    except InputError as error:
        raise type(error)(f"{path.name}: {error}") from None


def _parsed(path: Path) -> dict[str, Any]:
    try:
        if not path.is_file():
            known = ", ".join(sorted(cable_files()))
            raise SpecError(
                f'there is no cable "{path}": it is neither a built-in cable ({known}) nor a file; '
                "try one of these names, or the path of a cable file that ends in .toml."
            )
        if path.stat().st_size > LARGEST_FILE:
            raise SpecError(f"{path.name}: the file is larger than {LARGEST_FILE // 1000} kB, which no cable file is.")
        text = path.read_bytes().decode("utf-8")
    except UnicodeDecodeError:
        raise SpecError(f"{path.name}: the file is not text in UTF-8; save it as UTF-8.") from None
    except (OSError, ValueError) as error:
        if isinstance(error, InputError):
            raise
        raise SpecError(f'the cable file "{path}" cannot be read: {error}.') from None
    try:
        return tomllib.loads(text)
    except (tomllib.TOMLDecodeError, RecursionError) as error:
        raise SpecError(
            f"{path.name}: this is not valid TOML: {error}; check quotes, brackets and commas there."
        ) from None


def _validated(raw: dict[str, Any], file: str) -> CableTable:
    try:
        return CableTable.model_validate(raw)
    except ValidationError as error:
        sentences = [_sentence(problem) for problem in error.errors(include_url=False)]
        others = len(sentences) - 1
        more = f" (and {others} more problem{'s' if others > 1 else ''})" if others else ""
        raise SpecError(f"{file}: {sentences[0]}{more}") from None


def _sentence(problem: Any) -> str:
    """One pydantic problem as a sentence that starts with the key."""
    loc = [
        str(step) for step in problem["loc"] if step not in ("strands", "cylinder") or problem["loc"].index(step) == 0
    ]
    key = ".".join(loc)
    match problem["type"]:
        case "value_error":
            return str(problem["ctx"]["error"]).replace(PLACE, key)
        case "missing":
            return f"{key}: this entry is missing; add it."
        case "extra_forbidden":
            return f"{key}: this key is not known here; remove it or check its spelling."
        case "literal_error":
            return f"{key}: {problem['input']!r} is not possible; expected {problem['ctx']['expected']}."
        case "model_type" | "dict_type" | "model_attributes_type":
            return f"{key}: expected a table, found {problem['input']!r}."
    return f"{key}: {problem['input']!r} is not possible: {problem['msg'][:1].lower()}{problem['msg'][1:]}."


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
    return []


def _assembled(table: CableTable) -> Cable:
    materials = {name: Material(name, _si(m.E), _si(m.nu), _si(m.density)) for name, m in table.materials.items()}
    strands = {
        name: Strand(
            name,
            _si(s.wire_diameter),
            _ints(s.layers),
            _maybe(s.lay),
            s.hand,
            _si(s.wire_density),
            _si(s.E),
            _si(s.nu),
            _maybe(s.lay_factor),
        )
        for name, s in table.strands.items()
    }
    conductors = {name: _conductor(name, c, strands) for name, c in table.conductors.items()}
    cores = {name: _core(name, core, conductors, materials) for name, core in table.cores.items()}
    spec = table.lay_up
    lay = _maybe(spec.lay)
    rate = 0.0 if lay is None else HANDS[spec.hand] * 2 * np.pi / lay
    laid = lay_up(
        centre=_centre(table, conductors, materials),
        cores=[_named(cores, name, "lay-up.cores", "cores") for name in spec.cores],
        lay=lay,
        twist_rate=rate,
        phase=_maybe(spec.phase) or 0.0,
        filler=_filler(table, materials),
        pitch_circle_radius=_maybe(spec.pitch_circle_radius),
    )
    walls = [(kind, getattr(table, kind)) for kind in ("wrap", "sheath") if getattr(table, kind)]
    layers = [(kind, _named(materials, w.material, f"{kind}.material", "materials"), _si(w.wall)) for kind, w in walls]
    parts = round_layers(laid.parts, laid.laid_up_radius, layers, rate)
    return Cable(
        name=table.name,
        title=table.title,
        parts=tuple(parts),
        conductors=conductors,
        lay=lay,
        hand=spec.hand,
        pitch_circle_radius=laid.pitch_circle_radius,
        laid_up_radius=laid.laid_up_radius,
        outer_radius=parts[-1].outer_radius,
        numbers=tuple(_collected(table)),
        notes=tuple(table.notes),
    )


def _conductor(name: str, spec: StrandedTable | CylinderTable, strands: Mapping[str, Strand]) -> Conductor:
    if isinstance(spec, StrandedTable):
        strand = _named(strands, spec.strand, f"conductors.{name}.strand", "strands")
        return stranded_conductor(name, strand, _ints(spec.layers), _maybe(spec.lay), spec.hand, _maybe(spec.diameter))
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
    return Conductor(name, stated, metal, _si(spec.E), _si(spec.nu), density, factor)


def _core(name: str, spec: CoreTable, conductors: Mapping[str, Conductor], materials: Mapping[str, Material]) -> Round:
    conductor = _named(conductors, spec.conductor, f"cores.{name}.conductor", "conductors")
    layers = [Layer("conductor", conductor.material, conductor.diameter / 2, conductor.name)]
    insulation = _named(materials, spec.insulation_material, f"cores.{name}.insulation_material", "materials")
    layers.append(Layer("insulation", insulation, layers[-1].outer_radius + _si(spec.insulation_wall)))
    if _together(spec.screen_wall, spec.screen_material, f"cores.{name}", "screen"):
        screen = _named(materials, str(spec.screen_material), f"cores.{name}.screen_material", "materials")
        layers.append(Layer("screen", screen, layers[-1].outer_radius + (_maybe(spec.screen_wall) or 0.0)))
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
        raise SpecError(f"{where}.{missing}: this entry is missing; a {kind} needs both its wall and its material.")
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
