"""Apparent moduli from load steps: what a specimen that is not linear says, by the definitions of the linear one.

The modulus is the slope of the line through the average stress-strain points, the unloaded specimen included; the displacements are
those of the whole load. The published figure draws such points and states slope and R2.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from geometry.errors import SpecError
from homogenize.specimen.apparent_modulus import ApparentModulus
from homogenize.specimen.contact_condensation import ContactSpecimen
from homogenize.specimen.large_displacement_specimen import FollowedLoad
from homogenize.specimen.load_case import LoadCase
from homogenize.specimen.opening_specimen import ContactStep
from homogenize.specimen.stress_strain_curve import stress_strain_curve

MOST_STEPS = 50


def equal_steps(count: int) -> tuple[float, ...]:
    """Shares of a load that grows in `count` equal steps.

    Raises
    ------
    SpecError
        If there are none, or more than 50.

    Examples
    --------
    >>> equal_steps(4)
    (0.25, 0.5, 0.75, 1.0)
    """
    if not 1 <= count <= MOST_STEPS:
        raise SpecError(f"a load grows in 1 to {MOST_STEPS} steps, found {count}.")
    return tuple((k + 1) / count for k in range(count))


def followed_modulus(followed: FollowedLoad, length: float) -> ApparentModulus:
    """Of a load followed with large displacements on a specimen of a length [m]."""
    area = followed.path.wedges.section.area
    load, direction = followed.load, followed.load.direction
    axis = int(np.argmax(np.abs(direction)))
    strain = followed.gradient[:, axis, 2] + (followed.gradient[:, 2, axis] if axis < 2 else 0.0)
    u_mean = float(followed.end_mean[-1] @ direction)
    return _modulus(load, length, area, followed.shares, direction[axis] * strain, float(followed.largest[-1]), u_mean)


def contact_modulus(
    specimen: ContactSpecimen, load: int, start: ContactStep, steps: Sequence[ContactStep]
) -> ApparentModulus:
    """Of a load on a specimen whose parts open, counted from an unloaded state `start`; `steps` have positive or negative shares."""
    case = specimen.loads[load]
    sign = float(np.sign(steps[-1].share))
    direction = sign * case.direction
    axis = int(np.argmax(np.abs(direction)))
    component = (1, 2, 0)[axis]
    strain = np.array([step.strain[component] - start.strain[component] for step in steps]) * direction[axis]
    along = steps[-1].face @ direction
    area = float(specimen.face_weight.sum())
    u_mean = float(specimen.face_weight @ along / area)
    shares = np.abs([step.share for step in steps])
    turned = LoadCase(case.kind, sign * case.size, case.axis)
    return _modulus(turned, specimen.specimen.length, area, shares, strain, float(along.max()), u_mean)


def _modulus(
    load: LoadCase,
    length: float,
    area: float,
    shares: ArrayLike,
    strain: NDArray[np.float64],
    u_max: float,
    u_mean: float,
) -> ApparentModulus:
    stress = np.asarray(shares, dtype=float) * abs(load.size) / area
    curve = stress_strain_curve([0.0, *strain], [0.0, *stress])
    last = float(stress[-1])
    return ApparentModulus(
        load.name,
        curve.slope,
        last,
        float(strain[-1]),
        u_max,
        u_mean,
        last * length / u_max,
        last * length / u_mean,
        curve,
    )
