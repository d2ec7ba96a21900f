"""campaign.toml: what the cable is and what the sensors can do, read strictly into SI."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from compare.kinds import QUANTITIES, channel_quantity
from compare.nominal_section import NominalSection
from compare.text_file import LARGEST, decode, suggestion
from geometry.errors import SpecError
from geometry.units import read_quantity

FILE = "campaign.toml"
_TOP = ("title", "cable", "section", "sensors", "towing")
_SECTION = {"EA": "N", "GA": "N", "EI": "N m^2", "GJ": "N m^2", "mass_per_length": "kg/m"}
_TOWING = {
    "friction_coefficient": "1",
    "cable_length": "m",
    "mass_per_length": "kg/m",
    "EA": "N",
    "tail_tension": "N",
    "inclination": "rad",
    "damping_ratio": "1",
    "presliding": "m",
}
_NEEDS_NO_SIGN = ("friction_coefficient", "tail_tension", "damping_ratio", "presliding")


@dataclass(frozen=True)
class CampaignFile:
    """Content of campaign.toml in SI: `sensors` by channel, `towing` by its key."""

    title: str
    cable: str | None
    section: NominalSection | None
    sensors: Mapping[str, float]
    towing: Mapping[str, float]


def read_campaign_file(raw: bytes) -> CampaignFile:
    """What campaign.toml says.

    Raises
    ------
    SpecError
        For text that is no TOML, an unknown key, a quantity without unit or with a wrong one, or if neither ``cable``
        nor ``[section]`` is there.
    """
    try:
        content = tomllib.loads(decode(raw, FILE))
    except tomllib.TOMLDecodeError as error:
        raise SpecError(f"{FILE}: this is not TOML: {error}.") from None
    _require_known(content, _TOP, "")
    section = _positive_table(content, "section", _SECTION)
    towing = _positive_table(content, "towing", _TOWING)
    cable = _text(content, "cable")
    if cable is None and "section" not in content:
        raise SpecError(
            f"{FILE}: neither `cable` nor [section] is there; name a cable, or give the nominal "
            'section such as EA = "4.0e5 N".'
        )
    return CampaignFile(
        title=_text(content, "title") or "",
        cable=cable,
        section=NominalSection(section) if section else None,
        sensors=_sensors(content),
        towing=towing,
    )


def _text(content: Mapping[str, Any], key: str) -> str | None:
    value = content.get(key)
    if value is None:
        return None
    if not isinstance(value, str) or not value.strip():
        raise SpecError(f"{FILE}, {key}: expected text in quotes, found {value!r}.")
    return value


def _table(content: Mapping[str, Any], name: str) -> Mapping[str, Any]:
    table = content.get(name, {})
    if not isinstance(table, dict):
        raise SpecError(f"{FILE}, {name}: expected a table [{name}], found {table!r}.")
    return table


def _require_known(table: Mapping[str, Any], known: tuple[str, ...], name: str) -> None:
    for key in table:
        if key not in known:
            raise SpecError(f'{FILE}{name and f", [{name}]"}: the key "{key}" is not known; {suggestion(key, known)}')


def _positive_table(content: Mapping[str, Any], name: str, units: Mapping[str, str]) -> dict[str, float]:
    table = _table(content, name)
    if name in content and not table:
        raise SpecError(f"{FILE}, [{name}]: the table is empty; known keys are {', '.join(units)}.")
    _require_known(table, tuple(units), name)
    values = {}
    for key, text in table.items():
        where = f"{FILE}, [{name}] {key}"
        values[key] = read_quantity(text, units[key], where)
        if abs(values[key]) > LARGEST:
            raise SpecError(f"{where}: {text!r} is beyond {LARGEST:g}; check the value.")
        lowest_is_zero = key in _NEEDS_NO_SIGN
        if key != "inclination" and (values[key] < 0 or (values[key] == 0 and not lowest_is_zero)):
            raise SpecError(f"{where}: {text!r} must {'not be negative' if lowest_is_zero else 'be positive'}.")
    return values


def _sensors(content: Mapping[str, Any]) -> dict[str, float]:
    sensors = {}
    for key, text in _table(content, "sensors").items():
        where = f"{FILE}, [sensors] {key}"
        quantity = channel_quantity(key)
        if quantity is None:
            raise SpecError(f"{where}: there is no channel of this name; {suggestion(key, QUANTITIES)}")
        sensors[key] = read_quantity(text, quantity.unit, where)
        if sensors[key] <= 0:
            raise SpecError(f"{where}: a standard uncertainty must be positive, found {text!r}.")
    return sensors
