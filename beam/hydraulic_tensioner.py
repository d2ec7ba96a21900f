r"""Hydraulic tensioner: a cylinder at constant pressure that pulls an end of the cable, within its stroke.

.. math:: F = F_0 - c\,\dot x \quad\text{for } -S_{in} < x < S_{out}, \qquad F = F_0 - c\,\dot x - K (x - S) \text{ beyond,}

along its axis, with x the way of the end, a preloaded bushing of formula (21) with no stiffness; the ends of the stroke are a
second bushing, whose play is the stroke.
"""

from __future__ import annotations

from dataclasses import dataclass

from beam.bushing import GROUND, Bushing
from geometry.errors import SpecError

STOP_EDGE = 1e-3
"""m over which the end of the stroke sets in."""


@dataclass(frozen=True)
class HydraulicTensioner:
    """A cylinder between the ground and an `end` (node or body), along the global x axis or along `axes` [rotation vector].

    Parameters
    ----------
    end : int or str
    force : float
        On the end [N]; negative: towards -x.
    stroke : (float, float)
        How far the end can go towards -x and +x from its place at the start [m].
    damping : float
        c [N s/m].
    stop_stiffness : float
        K at the ends of the stroke [N/m].
    """

    end: int | str
    force: float
    stroke: tuple[float, float]
    damping: float = 0.0
    stop_stiffness: float = 1e6
    axes: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def bushings(self) -> list[Bushing]:
        """Cylinder, and its stops.

        Raises
        ------
        SpecError
            If the stroke, the damping or the stiffness of the stops is impossible.

        Examples
        --------
        >>> [b.name for b in HydraulicTensioner("plate", 500.0, (0.1, 0.3)).bushings()]
        ['tensioner', 'tensioner stops']
        """
        back, forth = self.stroke
        if back < 0 or forth < 0 or not back + forth > 0:
            raise SpecError(
                f"a tensioner needs a stroke to either side of zero or more, found {back:g} m and {forth:g} m."
            )
        if self.damping < 0 or not self.stop_stiffness > 0:
            raise SpecError("a tensioner needs a damping of zero or more and stops with a positive stiffness.")
        cylinder = Bushing(
            GROUND, self.end, 0.0, damping=(self.damping, 0, 0, 0, 0, 0), preload=(self.force, 0, 0, 0, 0, 0),
            axes=self.axes, rest="start", name="tensioner",
        )  # fmt: skip
        play = ((-back, forth), *[(0.0, 0.0)] * 5)
        stops = Bushing(
            GROUND, self.end, (self.stop_stiffness, 0, 0, 0, 0, 0), play=play, axes=self.axes, rest="start",
            edge=(STOP_EDGE, 0.0), name="tensioner stops",
        )  # fmt: skip
        return [cylinder, stops]
