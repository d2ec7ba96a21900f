"""Interfaces as they are written on the command line: `conductor-insulation=frictionless,core-filler=elastic:1e9 Pa/m`."""

from __future__ import annotations

from geometry.errors import SpecError
from geometry.units import read_quantity
from homogenize import INTERFACES, Coulomb, Elastic, Frictionless, Interfaces, Unilateral
from homogenize.interface_choice import InterfaceLaw

LAWS = (
    "frictionless, elastic:STIFFNESS (such as elastic:1e9 Pa/m), and in `helicable loop` coulomb:COEFFICIENT, opening, opening:GAP (such "
    "as opening:0.05 mm), opening:GAP+coulomb:COEFFICIENT"
)


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
    parts = [name for name, law in found.laws.items() if isinstance(law, Unilateral)]
    if parts:
        raise SpecError(
            f'{where}: where "{parts[0]}" opens, and so the stiffness, depends on the load; follow a load path with '
            f'`helicable loop CABLE --interface "{parts[0]}=opening"`, which prints the closed and the open limit, or close it here with '
            "frictionless."
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
    >>> read_laws("core-filler=opening:0.05 mm+coulomb:0.2").describe()
    'core-filler contact that can open, gap 5e-05 m, friction 0.2'
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


def _opening(text: str, where: str) -> Unilateral:
    """`opening`, `opening:GAP`, and either with `+coulomb:COEFFICIENT`; a negative gap is an interference."""
    first, plus, second = (part.strip() for part in text.partition("+"))
    _, colon, gap = (part.strip() for part in first.partition(":"))
    friction = 0.0
    if plus:
        law = _law(second, where)
        if not isinstance(law, Coulomb):
            raise SpecError(f'{where} has the law "{text}"; contact that opens goes with coulomb:COEFFICIENT only.')
        friction = law.friction
    return Unilateral(read_quantity(gap, "m", f"{where} opening") if colon else 0.0, friction)


def _law(text: str, where: str) -> InterfaceLaw:
    kind, _, value = (part.strip() for part in text.partition(":"))
    if kind == "frictionless" and not value:
        return Frictionless()
    if kind == "elastic" and value:
        return Elastic(read_quantity(value, "Pa/m", f"{where} elastic"))
    if kind == "coulomb" and value:
        return Coulomb(read_quantity(value, "1", f"{where} coulomb"))
    if kind.partition("+")[0].strip() == "opening":
        return _opening(text, where)
    bonded = "; pairs that are not named are bonded" if kind == "bonded" else ""
    raise SpecError(f'{where} has the law "{text}", which is not known; choose one of {LAWS}{bonded}.')
