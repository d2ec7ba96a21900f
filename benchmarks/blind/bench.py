"""All conditions of one kind of experiment as one batch of equally long, padded paths: what a law is driven with.

Rows are conditions, columns samples. Short records are padded by standing still after their end, which no causal law
can feel before it. `strain` is the path per length that the rig was told: strain, twist [rad/m], curvature [1/m], or the
deflection of a cantilever over its length.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Bench:
    """C conditions of at most n samples.

    Attributes
    ----------
    kind : str
        ``tension``, ``torsion``, ``bending`` or ``shear``.
    strain, time : (C, n) arrays
        Path per length and instants [s].
    count : (C,) array of int
        Samples of each record; what follows is padding.
    length, tension, temperature, frequency : (C,) arrays
        [m], [N], [degC], [Hz]; tension is that of the conditions (0 in a tension test, where the force itself grips).
    stiffness : float
        Linear load over strain: EA, GJ, EI, or that of the cantilever times its length.
    open_rows : (C,) array of bool
        Conditions that are not sealed.
    set_names : tuple of str
        ``calibrate``, ``validate`` or ``sealed``.
    scale : float
        Largest strain of the conditions that are open.
    load_control : bool
        Whether the load is prescribed; `strain` is then the strain that the linear law would give.
    """

    kind: str
    strain: Array = field(repr=False)
    time: Array = field(repr=False)
    count: NDArray[np.int_]
    length: Array
    tension: Array
    temperature: Array
    frequency: Array
    stiffness: float
    set_names: tuple[str, ...]
    typical_tension: float = 4000.0
    load_control: bool = False

    @property
    def scale(self) -> float:
        return float(np.abs(self.strain[self.open_rows]).max())

    @property
    def open_rows(self) -> NDArray[np.bool_]:
        return np.array([name != "sealed" for name in self.set_names])

    @property
    def fitted_rows(self) -> NDArray[np.bool_]:
        """Conditions of the set *calibrate*."""
        return np.array([name == "calibrate" for name in self.set_names])

    @property
    def mask(self) -> NDArray[np.bool_]:
        """True where a sample is recorded, (C, n)."""
        return np.arange(self.strain.shape[1]) < self.count[:, None]

    @property
    def step(self) -> Array:
        """Sampling interval of each record [s], (C, 1)."""
        return (self.time[:, 1] - self.time[:, 0])[:, None]

    def increments(self, x: Array) -> Array:
        """x_i - x_{i-1} along each record, 0 at the first sample."""
        return np.diff(x, axis=1, prepend=x[:, :1])

    def grip(self, strain: Array) -> Array:
        """Tension that presses the layers together over its typical value, (C, n) or (C, 1)."""
        if self.kind == "tension":
            typical = 0.5 * self.stiffness * self.scale
            return np.maximum(self.stiffness * strain, 0.0) / typical
        return (self.tension / self.typical_tension)[:, None]
