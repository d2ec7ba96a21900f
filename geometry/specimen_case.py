"""The finite specimen that a cable file stands for: its length, how it is turned, and what holds and loads its ends.

The words for the ends and the interface are those of the command line; who solves the specimen reads them.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class SpecimenCase:
    """The table [specimen] of a cable file.

    Parameters
    ----------
    length : [m]
    phase : angle by which the drawn section stands turned at the held end [rad]
    loaded, held : the ends in words, such as "uniform" and "fixed"
    interface : in words, such as "bonded"
    """

    length: float
    phase: float = 0.0
    loaded: str = "uniform"
    held: str = "fixed"
    interface: str = "bonded"
