r"""Slip ring: the cells between a conductor that turns and the host round it, exactly conforming.

At the station w of its centre line a conductor has turned by omega w against the host. The plane z meets the point (rho, phi)
of its normal planes at the station w = z + rho s sin(phi) (wire_trace.py, s = sin beta), so that a node (rho, phi0) of the
conductor is found in this plane where

.. math::  \phi - \omega \rho s \sin\phi = \phi_0 + \omega z ,

which is Kepler's equation with the eccentricity omega rho s. Nodes on the conductor's outer circle and on the hole of the host stand at
equal steps 2 pi / N of the left side, so that between z = 0 and z they have slid past each other by the index
sigma = omega z N / (2 pi), everywhere at once.

In every layer node i of the conductor is paired with node i + n of the host, n the whole number nearest to sigma at
mid-height: a ring of hexahedra, sheared by about half an index at most. Where n goes on by one, the quadrilaterals of the ring below and
above a plane do not have the same pairs. Both are cut by one diagonal each into the same triangles, which have their edges at sigma
about +1/2 and -1/2. A hexahedron with a face cut so becomes 5 pyramids and 2 tetrahedra round a node in its middle (4 and 4
with two such faces), and all faces that cells outside the ring see stay quadrilaterals. It cannot do without the node: a
pyramid on one face would have its apex in a corner, and cut two other faces, one of them on the conductor or on the host.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from geometry.errors import MeshError

MIRRORED = [0, 3, 2, 1, 4, 7, 6, 5]
BOTTOM, TOP = [0, 1, 2, 3], [4, 7, 6, 5]
SIDES = [[0, 4, 5, 1], [1, 5, 6, 2], [2, 6, 7, 3], [3, 7, 4, 0]]
"""Faces of a hexahedron, anticlockwise seen from inside."""


def kepler_angle(theta: ArrayLike, eccentricity: ArrayLike) -> NDArray[np.float64]:
    """Angle phi [rad] with phi - eccentricity sin(phi) = theta, by Newton steps; the arguments broadcast.

    Raises
    ------
    MeshError
        If an eccentricity is one or more in size: the conductor turns faster than the plane passes through it.

    Examples
    --------
    >>> float(kepler_angle(np.pi / 2 - 0.1, 0.1)) == np.pi / 2
    True
    """
    mean, e = np.broadcast_arrays(np.asarray(theta, dtype=float), np.asarray(eccentricity, dtype=float))
    if np.abs(e).max(initial=0.0) >= 0.9:
        raise MeshError(
            f"strands turn too fast for the lay of their core (omega rho sin beta = {np.abs(e).max():.2f}, at most 0.9): "
            "lengthen their lay."
        )
    phi = mean + e * np.sin(mean)
    for _ in range(12):
        step = (phi - e * np.sin(phi) - mean) / (1 - e * np.cos(phi))
        phi = phi - step
        if np.abs(step).max(initial=0.0) < 1e-14:
            break
    return phi


def pairing(steps: int, layers: int) -> NDArray[np.int64]:
    """Pair number n of every layer, shape (layers,), while the index grows from 0 to `steps` (signed).

    The whole number nearest to steps (l + 1/2) / layers, halves towards zero, so that opposite hands mirror each other.

    Raises
    ------
    MeshError
        If there are not more layers than steps: then the pairs at both ends could not be those of the end faces.

    Examples
    --------
    >>> pairing(2, 8).tolist()
    [0, 0, 1, 1, 1, 1, 2, 2]
    """
    if layers <= abs(steps):
        raise MeshError(
            f"{layers} layers are too few for a conductor that slips by {abs(steps)} nodes: take at least {abs(steps) + 1}."
        )
    middle = 2 * np.arange(layers) + 1
    return (1 if steps >= 0 else -1) * ((2 * abs(steps) * middle + 2 * layers - 1) // (4 * layers))


@dataclass(frozen=True)
class SlipRing:
    """Cells of a slip ring by node number, in meshio order.

    Attributes
    ----------
    hexahedra, pyramids, tetrahedra : (m, 8), (m, 5), (m, 4)
    divided : (q, 8) the hexahedra that are pyramids and tetrahedra now; the node in the middle of number k is `first` + k
    """

    hexahedra: NDArray[np.int64]
    pyramids: NDArray[np.int64]
    tetrahedra: NDArray[np.int64]
    divided: NDArray[np.int64]


def slip_ring(inner: NDArray[np.int64], outer: NDArray[np.int64], steps: int, first: int) -> SlipRing:
    """Cells between the conductor's circle and the hole of the host.

    Parameters
    ----------
    inner, outer : (layers + 1, N) node numbers round the conductor and round the hole in every plane, at equal steps of
        the left side of Kepler's equation, anticlockwise; inner node i stands at the index i + steps k / layers in plane k
    steps : indices slipped over all layers, signed
    first : number of the first of the nodes inside the ring

    Raises
    ------
    MeshError
        If there are not more layers than steps.
    """
    layers, N = len(inner) - 1, inner.shape[1]
    if steps < 0:  # seen in a mirror: cells turned inside out, and back
        ring = slip_ring(_mirrored(inner), _mirrored(outer), -steps, first)
        return SlipRing(
            ring.hexahedra[:, MIRRORED],
            ring.pyramids[:, [0, 3, 2, 1, 4]],
            ring.tetrahedra[:, [0, 2, 1, 3]],
            ring.divided[:, MIRRORED],
        )
    n = pairing(steps, layers)
    i, plane = np.arange(N), np.arange(layers)[:, None]
    following = (i + 1) % N
    j, beside = (i + n[:, None]) % N, (i + n[:, None] + 1) % N
    cells = np.stack(
        [
            pick
            for k in (plane, plane + 1)
            for pick in (inner[k, i], outer[k, j], outer[k, beside], inner[k, following])
        ],
        axis=-1,
    )
    changed = np.concatenate([[False], n[1:] != n[:-1], [False]])
    below, above = (np.repeat(c, N) for c in (changed[:-1], changed[1:]))
    cells = cells.reshape(-1, 8)
    cut = below | above
    return SlipRing(cells[~cut], *_divided(cells[cut], below[cut], above[cut], first), cells[cut])


def _divided(
    cells: NDArray[np.int64], below: NDArray[np.bool_], above: NDArray[np.bool_], first: int
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Pyramids and tetrahedra round a node in the middle of hexahedra whose bottom (`below`) or top face is cut in two."""
    middle = first + np.arange(len(cells))[:, None]
    pyramids = [np.hstack([cells[:, face], middle]) for face in SIDES]
    pyramids += [np.hstack([cells[:, face], middle])[~cut] for face, cut in ((BOTTOM, below), (TOP, above))]
    tetrahedra = [np.hstack([cells[:, face], middle])[below] for face in ([0, 1, 3], [1, 2, 3])]
    tetrahedra += [np.hstack([cells[:, face], middle])[above] for face in ([4, 6, 5], [4, 7, 6])]
    return np.concatenate(pyramids), np.concatenate(tetrahedra)


def _mirrored(nodes: NDArray[np.int64]) -> NDArray[np.int64]:
    """Node numbers with the index counted the other way round, 0 kept."""
    return np.roll(nodes[:, ::-1], 1, axis=1)
