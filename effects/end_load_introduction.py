r"""End load introduction: a short specimen held by its sheath is stretched less in its core than between its grips.

.. math::  \varepsilon = \frac{u/L}{1 + c/L}

c is the length over which shear in the soft sheath hands the load to the core, both ends together; the apparent
stiffness K/(1 + c/L) grows with the specimen length. A compliant rig follows the same formula.
Source: shear lag, Volkersen 1938; Cox 1952.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from effects.effect import BenchPath, Effect, Form, Parameter, of_length
from effects.loading_path import spread

Array = NDArray[np.float64]

END_LENGTH = Parameter(
    "end length",
    "m",
    "length of cable that would be as compliant as the two ends",
    plausible=(0.0, 5.0),
    source="shear lag length of a core in a rubber sheath, some diameters to some metres (estimate)",
    starts=of_length(0.005, 2.0, 16),
)


def _strain(path: BenchPath, end_length: float) -> Array:
    if path.length is None:
        return path.strain
    return path.strain / (1.0 + end_length / path.length)


def _why_untestable(paths: Sequence[BenchPath]) -> str | None:
    lengths = [p.length for p in paths if p.length is not None]
    if not lengths:
        return "no specimen length was recorded"
    if spread(lengths) < 1.05:
        return f"all specimens are {np.mean(lengths):.3g} m long"
    return None


SHEAR_LAG = Form("shear lag at the ends", "fixture", _strain, shape=(END_LENGTH,))

EFFECT = Effect(
    name="end-load-introduction",
    kind="physics",
    title="short specimen loaded through its sheath: apparent stiffness grows with specimen length",
    equation="load = K (u/L) / (1 + c/L)",
    source="shear lag: Volkersen 1938, Cox 1952",
    needs="at least two specimen lengths; lengths alone cannot tell it from rig-compliance",
    signature="apparent stiffness rises with specimen length towards a limit; no loop",
    kinds=("tension", "torsion"),
    forms=(SHEAR_LAG,),
    why_untestable=_why_untestable,
)
