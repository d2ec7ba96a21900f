"""Supports: nodes and bodies whose unknowns are held or move as prescribed."""

from __future__ import annotations

from dataclasses import dataclass

from beam.motion import Turn
from beam.surface import Travel


@dataclass(frozen=True)
class Support:
    """Node (negative: from the end), or body by its name, whose fields are held at their starting values.

    Fields are r, x, y, z, theta; of nodes r', theta' as well, of bodies theta_x, theta_y, theta_z. `travel` moves the position,
    `turn` the section or the body about a fixed axis, from theta = 0 at the start.
    """

    node: int | str
    held: tuple[str, ...] = ("r", "theta")
    travel: Travel | None = None
    turn: Turn | None = None
