"""Units at the border: text such as ``"9.05 mm"`` becomes a float in SI, or a sentence that says why not.

Inside helicable every number is SI (m, kg, s, N, Pa, rad; temperatures in kelvin, or in degC where a column says so).
pint is imported here and nowhere else.
"""

from __future__ import annotations

import math
from functools import lru_cache

import pint

from geometry.errors import SpecError


@lru_cache(maxsize=1)
def _registry() -> pint.UnitRegistry:
    registry: pint.UnitRegistry = pint.UnitRegistry(autoconvert_offset_to_baseunit=True)
    return registry


@lru_cache(maxsize=4096)
def _converted(text: str, unit: str) -> float:
    """Magnitude in `unit`; the same text is parsed once (2 ms), errors of pint are passed on."""
    return float(_registry().Quantity(text).to(unit).magnitude)


@lru_cache(maxsize=512)
def _base(unit: str) -> object:
    """Base units of `unit`."""
    return _registry().Quantity(1.0, unit).to_base_units().units


def read_quantity(text: object, unit: str, where: str) -> float:
    """SI value of a quantity that a user wrote with its unit.

    Parameters
    ----------
    text : object
        What stands in the file, for instance ``"9.05 mm"``. A bare number is accepted only where `unit` is ``"1"``.
    unit : str
        The SI unit that is expected, for instance ``"m"`` or ``"N m^2"``; ``"1"`` for a pure number.
    where : str
        The place in the user's file, named in the error.

    Returns
    -------
    float
        The value in `unit`.

    Raises
    ------
    SpecError
        If the text is not a finite number with a unit of the expected dimension.

    Examples
    --------
    >>> read_quantity("9.05 mm", "m", "conductor.diameter")
    0.00905
    >>> read_quantity("80 GPa", "Pa", "strand.E")
    80000000000.0
    """
    if isinstance(text, bool) or not isinstance(text, (str, int, float)):
        raise SpecError(f'{where}: expected a quantity such as "1 {unit}", found {text!r}.')
    if isinstance(text, (int, float)) and unit != "1":
        raise SpecError(
            f'{where}: the number {text} has no unit; write it as text with its unit, such as "{text} {unit}".'
        )
    try:
        converted = _converted(str(text).strip(), unit if unit != "1" else "dimensionless")
    except pint.DimensionalityError as error:
        raise SpecError(f'{where}: "{text}" cannot be read in {unit}, because {_dimension_sentence(error)}.') from None
    except Exception:  # pint raises many kinds (tokenizer, undefined unit, assertion) for text that is no quantity
        raise SpecError(
            f'{where}: "{text}" is not a quantity with a known unit; expected one such as "1 {unit}".'
        ) from None
    if not math.isfinite(converted):
        raise SpecError(f'{where}: "{text}" is not a finite number.')
    return converted


def conversion(unit: str, to: str, where: str) -> tuple[float, float]:
    """Factor and offset that turn a column in `unit` into `to`: ``si = factor * value + offset``.

    Raises
    ------
    SpecError
        If `unit` is unknown or has another dimension than `to`.

    Examples
    --------
    >>> conversion("mm", "m", "column 2")
    (0.001, 0.0)
    """
    registry = _registry()
    plain = "dimensionless" if unit.strip() in {"", "-", "1"} else unit
    target = "dimensionless" if to in {"", "-", "1"} else to
    try:
        zero = float(registry.Quantity(0.0, plain).to(target).magnitude)
        one = float(registry.Quantity(1.0, plain).to(target).magnitude)
    except pint.DimensionalityError as error:
        raise SpecError(
            f"{where}: the unit [{unit}] cannot be read in [{to}], because {_dimension_sentence(error)}."
        ) from None
    except Exception:  # see read_quantity
        raise SpecError(f"{where}: the unit [{unit}] is not known; expected one that converts to [{to}].") from None
    return one - zero, zero


_NAMED_SI = (
    "1",
    "rad",
    "m",
    "s",
    "kg",
    "K",
    "N",
    "Pa",
    "N m",
    "N m^2",
    "J/m^2",
    "m/s",
    "m/s^2",
    "1/m",
    "rad/m",
    "1/s",
    "rad/s",
    "W",
)


def si_unit(unit: str, where: str) -> str:
    """The SI unit that a column in `unit` converts to, angles kept apart from pure numbers.

    A full turn and the number one have the same dimension, so that a dimension check alone would take a frequency in
    rad/s for one in 1/s, wrong by 2 pi; the answers ``"rad/s"`` and ``"1/s"`` differ.

    Raises
    ------
    SpecError
        If `unit` is not known.

    Examples
    --------
    >>> si_unit("kN", "column 2"), si_unit("degC", "column 3"), si_unit("rpm", "column 4"), si_unit("Hz", "column 5")
    ('N', 'K', 'rad/s', '1/s')
    """
    try:
        base = _base("dimensionless" if unit.strip() in {"", "-", "1"} else unit)
    except Exception:  # see read_quantity
        raise SpecError(f"{where}: the unit [{unit}] is not known.") from None
    for name in _NAMED_SI:
        if _base("dimensionless" if name == "1" else name) == base:
            return name
    return f"{base:~C}"


def _dimension_sentence(error: pint.DimensionalityError) -> str:
    return (
        f"{error.units1} is {error.dim1 or '[dimensionless]'} and {error.units2} is {error.dim2 or '[dimensionless]'}"
    )
