r"""Slip ring: the cells between a conductor that turns and the host round it, exactly conforming.

At the station w of its centre line a conductor has turned by omega w against the host. The plane z meets the point (rho, phi)
of its normal planes at the station w = z + rho s sin(phi) (wire_trace.py, s = sin beta), so that a node (rho, phi0) of the
conductor is found in this plane where

.. math::  \phi - \omega \rho s \sin\phi = \phi_0 + \omega z ,

which is Kepler's equation with the eccentricity omega rho s. Nodes on the conductor's outer circle and on the hole of the host stand at
equal steps 2 pi / N of the left side, so that between z = 0 and z they have slid past each other by the index
sigma = omega z N / (2 pi), everywhere at once.

In every plane node i of the conductor is paired with node i + n of the host, n the whole number nearest to sigma. Layers between
planes of the same n are hexahedra, sheared by at most half an index. Where n grows by one the ring of
quadrilaterals below and the one above do not have the same pairs. That layer of the ring gets one node s_i in the middle for every
index: its quadrilaterals on the planes, on the conductor and on the host are the bases of 4 pyramids with the apex s_i, and 5 tetrahedra
stand about each edge from s_(i-1) to s_i. So all faces that other cells see stay quadrilaterals. A hexahedron alone cannot be
cut so without a node inside it: a pyramid on one face has its apex in a corner, hence in two more of the faces that must stay whole.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from geometry.errors import MeshError


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
            f"strands turn too fast for the lay of their core (omega rho sin beta = {np.abs(e).max():.2f}, at most 0.9): lengthen their lay."
        )
    phi = mean + e * np.sin(mean)
    for _ in range(12):
        step = (phi - e * np.sin(phi) - mean) / (1 - e * np.cos(phi))
        phi = phi - step
        if np.abs(step).max(initial=0.0) < 1e-14:
            break
    return phi


def pairing(steps: int, layers: int) -> NDArray[np.int64]:
    """Pair number n of every plane 0 .. layers, shape (layers + 1,), while the index grows from 0 to `steps` (signed).

    The whole number nearest to steps k / layers, halves towards zero, so that opposite hands mirror each other.

    Raises
    ------
    MeshError
        If there are fewer layers than steps, for then a layer would have to slip by more than one index.

    Examples
    --------
    >>> pairing(2, 6).tolist()
    [0, 0, 1, 1, 1, 2, 2]
    """
    if layers < abs(steps):
        raise MeshError(
            f"{layers} layers are too few for a conductor that slips by {abs(steps)} nodes: take at least {abs(steps)}."
        )
    k = np.arange(layers + 1)
    return np.sign(steps) * ((2 * abs(steps) * k + layers - 1) // (2 * layers))


@dataclass(frozen=True)
class SlipRing:
    """Cells of a slip ring by node number.

    Attributes
    ----------
    hexahedra, pyramids, tetrahedra : (m, 8), (m, 5), (m, 4) in meshio order
    slips : (t,) the layers in which the pairs change; each has N inner nodes, numbered from `first` on, layer by layer
    places : (t, N) their places as an index of the host, 0 .. N, at mid-height and mid-radius
    """

    hexahedra: NDArray[np.int64]
    pyramids: NDArray[np.int64]
    tetrahedra: NDArray[np.int64]
    slips: NDArray[np.int64]
    places: NDArray[np.float64]


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
        If there are fewer layers than steps.
    """
    layers, N = len(inner) - 1, inner.shape[1]
    if steps < 0:  # seen in a mirror; node numbers keep their places, cells are turned inside out and back
        ring = slip_ring(_mirrored(inner), _mirrored(outer), -steps, first)
        return SlipRing(
            ring.hexahedra[:, [0, 3, 2, 1, 4, 7, 6, 5]],
            ring.pyramids[:, [0, 3, 2, 1, 4]],
            ring.tetrahedra[:, [0, 1, 3, 2]],
            ring.slips,
            -ring.places,
        )
    n = pairing(steps, layers)
    k = np.arange(layers)
    same, slips = k[n[1:] == n[:-1]], k[n[1:] != n[:-1]]
    i = np.arange(N)

    def c(plane: NDArray[np.int64], shift: int = 0) -> NDArray[np.int64]:
        return inner[plane[:, None], (i + shift) % N]

    def h(plane: NDArray[np.int64], pair: NDArray[np.int64], shift: int = 0) -> NDArray[np.int64]:
        return outer[plane[:, None], (i + pair[:, None] + shift) % N]

    low, high = same, same + 1
    hexahedra = [c(low), h(low, n[low]), h(low, n[low], 1), c(low, 1)]
    hexahedra += [c(high), h(high, n[low]), h(high, n[low], 1), c(high, 1)]
    low, high, p = slips, slips + 1, n[slips]
    s = first + np.arange(len(slips))[:, None] * N + i
    pyramids = [
        (c(low), h(low, p), h(low, p, 1), c(low, 1), s),
        (c(high), c(high, 1), h(high, p, 2), h(high, p, 1), s),
        (c(low), c(low, 1), c(high, 1), c(high), s),
        (h(low, p), h(high, p), h(high, p, 1), h(low, p, 1), s),
    ]
    around = [c(low), h(low, p), h(high, p), h(high, p, 1), c(high), c(low)]  # closed line between groups i - 1 and i
    before = first + np.arange(len(slips))[:, None] * N + (i - 1) % N
    tetrahedra = [(before, s, end, start) for start, end in zip(around[:-1], around[1:], strict=True)]
    sigma = steps * np.arange(layers + 1) / layers - n
    return SlipRing(
        _rows([tuple(hexahedra)], 8),
        _rows(pyramids, 5),
        _rows(tetrahedra, 4),
        slips,
        i + (p + (2.5 + sigma[low] + sigma[high] + 1) / 4)[:, None],
    )


def _mirrored(nodes: NDArray[np.int64]) -> NDArray[np.int64]:
    """Node numbers with the index counted the other way round, 0 kept."""
    return np.roll(nodes[:, ::-1], 1, axis=1)


def _rows(cells: list[tuple[NDArray[np.int64], ...]], width: int) -> NDArray[np.int64]:
    return np.concatenate([np.stack(nodes, axis=-1).reshape(-1, width) for nodes in cells])
