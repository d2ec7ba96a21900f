"""Interfaces of a specimen that open and rub, as they are written on the command line: `core-filler=opening:0.05 mm+coulomb:0.3`."""

from __future__ import annotations

from geometry.errors import SpecError
from geometry.units import read_quantity
from homogenize import Interfaces
from homogenize.specimen.frictional_contact import FrictionalContact

LAWS = "opening, opening:GAP (negative: an interference), either with +coulomb:COEFFICIENT and +grip:PRESSURE"
MOST_FRICTION = 2.0
"""Coefficient above which a slip of the pen is more likely than rubber on rubber."""


def read_opening(text: str, where: str = "--interface") -> Interfaces | None:
    """Laws of interfaces that open; None if no interface of the text does.

    Raises
    ------
    SpecError
        If a law or a unit is not known, a coefficient or a grip is out of place, or interfaces that open stand beside others.

    Examples
    --------
    >>> read_opening("core-filler=opening:-0.02 mm+coulomb:0.3").describe()
    'core-filler contact that opens, friction 0.3, interference 2e-05 m'
    >>> read_opening("core-filler=opening+coulomb:0.3+grip:20 kPa").describe()
    'core-filler contact that opens, friction 0.3, grip 20000 Pa'
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
    first, *others = (part.strip() for part in text.split("+"))
    _, colon, gap = (part.strip() for part in first.partition(":"))
    found: dict[str, str] = {}
    for entry in others:
        word, _, value = (part.strip() for part in entry.partition(":"))
        if word not in ("coulomb", "grip") or not value or word in found:
            raise SpecError(f'{where} has the law "{text}", which is not known; write {LAWS}.')
        found[word] = value
    friction = read_quantity(found["coulomb"], "1", f"{where} coulomb") if "coulomb" in found else 0.0
    if not 0 <= friction <= MOST_FRICTION:
        raise SpecError(
            f"{where} has a coefficient of friction of {friction:g}; give one from 0 to {MOST_FRICTION:g}, or leave the pair out (bonded)."
        )
    grip = read_quantity(found["grip"], "Pa", f"{where} grip") if "grip" in found else 0.0
    if grip < 0:
        raise SpecError(f"{where} has a grip of {grip:g} Pa; a grip presses the parts together, give zero or more.")
    return FrictionalContact(friction, grip, read_quantity(gap, "m", f"{where} opening") if colon else 0.0)
