"""The clamp chain of a towing run in numbers: bushing 3, contact 35, and the real tension by the source's similarity.

The source states its simulated tensions times 2.5 as real ones, and for a pin with two bushings twice that. Amplitude of a bushing:
its largest force along the chain. Contact 35: the force of link 35 on the cable, across it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    import xarray

Array = NDArray[np.float64]

SIMILARITY = 2.5
"""Real over simulated tension, Ge et al. (2023)."""
BUSHING, CONTACT = 3, 35
TOUCHES = 0.05
"""Share of its maximum from which a contact counts as begun."""


def chain_record(data: xarray.Dataset) -> dict[str, Any]:
    """Keys ``bushing_3_amplitude``, ``bushing_3``, ``contact_35``, ``chain_force_max``, ``pin_angle_max``; ``None`` without clamps."""
    if "clamp" not in data.dims:
        return {"bushing_3_amplitude": None, "contact_35": None}
    along = data["bushing_force"].sel(bushing=BUSHING, direction="x").values
    chain = data["chain_force"].values
    return {
        "bushing_3_amplitude": float(np.abs(along).max()),
        "bushing_3": {"start": float(along[0]), "max": float(along.max()), "min": float(along.min())},
        "contact_35": contact_course(data["time"].values, pressure(data, CONTACT)),
        "clamps": int(data.sizes["clamp"]),
        "chain_force_max": float(np.linalg.norm(chain, axis=2).max()),
        "pin_angle_max": float(np.abs(data["pin_angle"].values).max()),
    }


def pressure(data: xarray.Dataset, number: int) -> Array:
    """Force of link `number` on the cable across it, over time [N]; of the last link if there are fewer."""
    return data["clamp_cable_pressure"].sel(clamp=min(number, data.sizes["clamp"])).values


def contact_course(time: Array, force: Array) -> dict[str, float]:
    """Largest force [N], when it is largest, when it begins and when it ends [s].

    Examples
    --------
    >>> contact_course(np.arange(4.0), np.array([0.0, 0.0, 8.0, 0.0]))
    {'max': 8.0, 'max_at': 2.0, 'begins': 2.0, 'ends': 2.0}
    """
    k = int(force.argmax())
    touching = time[force > TOUCHES * force[k]] if force[k] > 0 else time[:1]
    return {
        "max": float(force[k]), "max_at": float(time[k]), "begins": float(touching[0]), "ends": float(touching[-1]),
    }  # fmt: skip


def nearest_pin(data: xarray.Dataset, node: int) -> int:
    """Number of the pin that is nearest to the cable's `node`, at the start."""
    here = data["position"].sel(node=node).values[0]
    links = data["clamp_position"].values[0]
    k = int(np.argmin(np.linalg.norm(links - here, axis=1)))
    return int(data["clamp"].values[k])


def similar(tension: float | None, bushings: int = 1) -> float | None:
    """Real tension [N] of a simulated one by the source's rule, of so many bushings together.

    Examples
    --------
    >>> similar(500.0, bushings=2)
    2500.0
    """
    return None if tension is None else SIMILARITY * bushings * tension
