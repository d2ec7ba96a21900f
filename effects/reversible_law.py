"""Laws without memory: the strain that is added depends on strain, tension and temperature of the moment alone."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from effects.effect import UNKNOWN, BenchPath, Form, Parameter, Stage

Array = NDArray[np.float64]
Law = Callable[..., Array]
"""``law(strain, tension, temperature, reference, *shape)`` gives columns (n, k); tension [N] and temperature [K] may be
(n,), a number, or None where nothing was recorded."""


def reversible_form(
    name: str,
    law: Law,
    shape: tuple[Parameter, ...] = (),
    strength: tuple[Parameter, ...] = (),
    stage: Stage = "section",
) -> Form:
    """A form whose record is the law at every sample, and whose step is the law at the end of the step."""

    def respond(path: BenchPath, *shape: float) -> Array:
        return law(path.strain, path.tension, path.temperature, path, *shape)

    def advance(
        strain: Array,
        before: Array,
        dt: float,
        tension: Array,
        temperature: Array,
        state: Array,
        *shape: float,
        reference: BenchPath = UNKNOWN,
    ) -> tuple[Array, Array]:
        return law(strain, tension, temperature, reference, *shape), state

    return Form(name, stage, respond, shape, strength, advance)
