"""Interfaces of a specimen that open and rub, as they are written on the command line: `core-filler=opening:0.05 mm+coulomb:0.3`."""

from __future__ import annotations

from geometry.errors import SpecError
from geometry.units import read_quantity
from homogenize import Interfaces
from homogenize.specimen.frictional_contact import FrictionalContact

LAWS = "opening, opening:GAP (negative: an interference), either with +coulomb:COEFFICIENT"


def read_opening(text: str, where: str = "--interface") -> Interfaces | None:
    """Laws of interfaces that open; None if no interface of the text does.

    Raises
    ------
    SpecError
        If a law or a unit is not known, or interfaces that open stand beside others.

    Examples
    --------
    >>> read_opening("core-filler=opening:-0.02 mm+coulomb:0.3").describe()
    'core-filler contact that opens, friction 0.3, interference 2e-05 m'
    >>> read_opening("core-filler=frictionless") is None
    True
    """
    pairs = [[part.strip() for part in entry.partition("=")] for entry in text.split(",")]
    opens = [law.partition(":")[0].partition("+")[0].strip() == "opening" for _, _, law in pairs]
    if not any(opens):
        return None
    if not all(opens):
        name = pairs[opens.index(False)][0]
        raise SpecError(
            f'{where}: interfaces that open are followed by themselves; leave "{name}" out (bonded), or give it {LAWS}.'
        )
    laws = {name: _law(law, f'{where}: "{name}"') for name, _, law in pairs}
    if len(laws) < len(pairs) or "" in laws:
        raise SpecError(f'{where} "{text}" names a pair twice, or a law without a pair.')
    return Interfaces(laws)


def _law(text: str, where: str) -> FrictionalContact:
    first, plus, second = (part.strip() for part in text.partition("+"))
    _, colon, gap = (part.strip() for part in first.partition(":"))
    word, _, value = (part.strip() for part in second.partition(":"))
    if plus and (word != "coulomb" or not value):
        raise SpecError(f'{where} has the law "{text}", which is not known; write {LAWS}.')
    friction = read_quantity(value, "1", f"{where} coulomb") if plus else 0.0
    return FrictionalContact(friction, gap=read_quantity(gap, "m", f"{where} opening") if colon else 0.0)
