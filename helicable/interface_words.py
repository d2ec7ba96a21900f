"""Interfaces as they are written on the command line: `conductor-insulation=frictionless,core-filler=elastic:1e9 Pa/m`."""

from __future__ import annotations

from geometry.errors import SpecError
from geometry.units import read_quantity
from homogenize import INTERFACES, Coulomb, Elastic, Frictionless, Interfaces
from homogenize.interface_choice import InterfaceLaw

LAWS = "frictionless, elastic:STIFFNESS (such as elastic:1e9 Pa/m), coulomb:COEFFICIENT (in `helicable loop`)"


def read_interface(text: str, where: str = "--interface") -> str | Interfaces:
    """A word for the whole section, or laws by the name of the two sides.

    Raises
    ------
    SpecError
        If a word, a law or a unit is not known, a pair is named twice, or a law depends on the history of the load.

    Examples
    --------
    >>> read_interface("bonded")
    'bonded'
    >>> read_interface("conductor-insulation=frictionless, core-filler=elastic:1 MPa/mm").describe()
    'conductor-insulation frictionless; core-filler elastic, 1e+09 Pa/m'
    """
    word = text.strip()
    if word in INTERFACES:
        return word
    if "=" not in word:
        raise SpecError(
            f'{where} "{text}" is not known; choose {" or ".join(INTERFACES)}, or name pairs of parts with a law each, such as '
            '"conductor-insulation=frictionless,core-filler=elastic:1e9 Pa/m".'
        )
    found = read_laws(word, where)
    rubs = [name for name, law in found.laws.items() if isinstance(law, Coulomb)]
    if rubs:
        raise SpecError(
            f'{where}: friction at "{rubs[0]}" has no single stiffness, since its slip depends on the history of the load; follow a load '
            f'path with `helicable loop CABLE --interface "{rubs[0]}"`, or take frictionless or elastic here.'
        )
    return found


def read_laws(text: str, where: str = "--interface", friction: float | None = None) -> Interfaces:
    """Laws by the name of the two sides; a name without a law rubs with the coefficient `friction`, if one is given.

    Raises
    ------
    SpecError
        If a law or a unit is not known, or a pair is named twice.

    Examples
    --------
    >>> read_laws("conductor-insulation", friction=0.3).describe()
    'conductor-insulation Coulomb friction 0.3'
    """
    laws: dict[str, InterfaceLaw] = {}
    for entry in text.split(","):
        name, equals, law = (part.strip() for part in entry.partition("="))
        if not name:
            raise SpecError(
                f'{where} "{text}" has a place without the name of a pair; write for instance "core-filler".'
            )
        if name in laws:
            raise SpecError(f'{where} names "{name}" twice; give it one law.')
        if not equals and friction is None:
            raise SpecError(f'{where}: "{name}" needs a law after an equals sign: {LAWS}.')
        laws[name] = _law(law, f'{where}: "{name}"') if equals or friction is None else Coulomb(friction)
    return Interfaces(laws)


def _law(text: str, where: str) -> InterfaceLaw:
    kind, _, value = (part.strip() for part in text.partition(":"))
    if kind == "frictionless" and not value:
        return Frictionless()
    if kind == "elastic" and value:
        return Elastic(read_quantity(value, "Pa/m", f"{where} elastic"))
    if kind == "coulomb" and value:
        return Coulomb(read_quantity(value, "1", f"{where} coulomb"))
    bonded = "; pairs that are not named are bonded" if kind == "bonded" else ""
    raise SpecError(f'{where} has the law "{text}", which is not known; choose one of {LAWS}{bonded}.')
