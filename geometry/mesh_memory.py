"""How many elements are made, and the memory that they would take: a request for too many is refused before any work."""

from __future__ import annotations

import numpy as np

from geometry.errors import MeshError

LARGEST = 20_000_000
BYTES_PER_ELEMENT = 700
"""Measured peak of meshing, quality and export together, per hexahedron."""


def check_memory(elements: float) -> None:
    """Refuse more elements than are made.

    Raises
    ------
    MeshError
        If there are more than 20 million, with an estimate of the memory.
    """
    if elements > LARGEST:
        raise MeshError(
            f"{elements:.2g} elements need about {elements * BYTES_PER_ELEMENT / 1e9:.0f} GB of memory; at most {LARGEST:.0e} are made: "
            "try fewer elements, a larger size or fewer layers; for axial load and torsion 100000 are plenty."
        )


def check_element_count(elements: float) -> int:
    """The number of elements asked for, as an integer.

    Raises
    ------
    MeshError
        If it is not a positive whole number, or larger than 20 million (with an estimate of the memory).

    Examples
    --------
    >>> check_element_count(1_000_000_000)
    Traceback (most recent call last):
    geometry.errors.MeshError: 1e+09 elements need about 700 GB of memory; at most 2e+07 are made: try fewer elements, ...
    """
    if isinstance(elements, bool) or not np.isfinite(elements) or elements != int(elements) or elements < 1:
        raise MeshError(f"the number of elements must be a whole number from 1, found {elements!r}.")
    check_memory(elements)
    return int(elements)
