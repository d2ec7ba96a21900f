r"""What every contact point does at one instant: gap, normal force, friction, stick or slip; and sums over elements and surfaces.

With the penetration g, the force per length f_n, t of :mod:`beam.contact_force` and the weight w of a point (its length of cable),

.. math:: \text{gap} = -g, \qquad N = w f_n, \qquad T = w\,|t|, \qquad \text{use} = T / (\mu(v) N) \le 1 .

A point slips where its use is one; a point without friction (mu = 0) slips, too. Sums are of magnitudes, so that
T <= mu N holds for an element and for a surface as it does for a point.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from beam.compiled import kernel
from beam.contact_force import gap_and_normal, point_contact, shapes_at
from beam.rod_model import RodModel

Array = NDArray[np.float64]

SLIPS = 1.0 - 1e-9
"""Use of the friction cone from which on a point slips."""


@kernel
def contact_table(
    p: Array, q: Array, v: Array, lengths: Array, xs: Array, ws: Array, anchors: Array, table: Array
) -> None:  # fmt: skip
    """Write penetration (NaN outside the surface's box), N, friction (3 numbers), force (3) and mu of every point of a surface."""
    N, moved, report, at = np.empty((xs.size, 4)), np.empty_like(anchors), np.zeros(16), -1.0
    d = np.zeros(3)
    for e in range(lengths.size):
        if lengths[e] != at:
            at = lengths[e]
            shapes_at(xs, at, N)
        for g in range(xs.size):
            j, w = e * xs.size + g, ws[g] * at
            x = np.zeros(3)
            for i in range(3):
                for k in range(4):
                    x[i] += N[g, k] * q[e + k // 2, 3 * (k % 2) + i]
            depth, _, a0, a1, a2 = gap_and_normal(p, x[0], x[1], x[2])
            table[j, :] = 0.0
            table[j, 0] = depth if a0 != 0.0 or a1 != 0.0 or a2 != 0.0 else np.nan
            if depth <= 0.0:
                continue
            fn, n0, n1, n2, t0, t1, t2, _, mu = point_contact(p, e, g, j, q, v, N, anchors, moved, report, w, d)
            table[j, 1] = w * fn
            table[j, 2], table[j, 3], table[j, 4] = w * t0, w * t1, w * t2
            table[j, 5], table[j, 6], table[j, 7] = w * (fn * n0 + t0), w * (fn * n1 + t1), w * (fn * n2 + t2)
            table[j, 5], table[j, 6], table[j, 7] = (
                table[j, 5] + w * d[0],
                table[j, 6] + w * d[1],
                table[j, 7] + w * d[2],
            )
            table[j, 8] = mu


@dataclass(frozen=True)
class ContactState:
    """The contacts of one surface, by element and point (n, points).

    Attributes
    ----------
    gap : (n, points) array
        Distance from the surface [m], negative where the point has gone into it; NaN outside the surface's extent.
    normal, friction : (n, points) array
        Forces on the cable [N], magnitudes; a drag is not in the friction.
    force : (n, points, 3) array
        Force on the cable [N], global axes.
    use : (n, points) array
        T / (mu N); 0 without contact, 1 in contact without friction.
    """

    gap: Array
    normal: Array
    friction: Array
    force: Array
    use: Array

    @property
    def touching(self) -> NDArray[np.bool_]:
        """Points that carry a normal force."""
        return self.normal > 0

    @property
    def slips(self) -> NDArray[np.bool_]:
        """Points in contact that slip; the others stick."""
        return self.touching & (self.use >= SLIPS)

    @property
    def smallest_gap(self) -> float:
        """Over all points [m]; NaN if no point is within the surface's extent."""
        return _smallest(self.gap.ravel())

    @property
    def element_gap(self) -> Array:
        """Smallest gap of every element (n,) [m]; NaN outside the surface's extent."""
        there = np.where(np.isnan(self.gap), np.inf, self.gap).min(axis=1)
        return np.where(np.isinf(there), np.nan, there)

    @property
    def element_slip(self) -> Array:
        """Share of every element's normal force that its slipping points carry (n,): 0 sticks, 1 slips, NaN no contact."""
        return _share(np.where(self.slips, self.normal, 0.0).sum(axis=1), self.normal.sum(axis=1))

    @property
    def slip_share(self) -> float:
        """The same of the whole surface."""
        return float(_share(np.where(self.slips, self.normal, 0.0).sum(), self.normal.sum()))


def contact_states(
    model: RodModel, t: float, q: Array, v: Array, anchors: list[Array], turned: Array | None = None
) -> list[ContactState]:
    """State of the contacts of every surface of `model` at time `t` [s].

    Parameters
    ----------
    model : RodModel
    t : float
    q, v : (n + 1, dof) array
    anchors : list of array
        Friction anchors before the step that led to this state, see :attr:`beam.generalized_alpha.Integrator.contacts`.
    turned : (rollers, 2) array, optional
        Angles and speeds of the free rollers.
    """
    lengths, out = model.rod.lengths, []
    P = model.surface_parameters(t, turned=turned)
    for k, (p, anchor) in enumerate(zip(P, anchors[: len(P)], strict=True)):
        i, j = model.first[k], model.first[k + 1]
        table = np.empty((lengths.size * (j - i), 9))
        contact_table(
            p, q, v, lengths, model.xs[i:j], model.ws[i:j], np.ascontiguousarray(anchor).reshape(-1, 3), table
        )
        table = table.reshape(lengths.size, j - i, 9)
        normal, friction = table[..., 1], np.linalg.norm(table[..., 2:5], axis=2)
        limit = table[..., 8] * normal
        use = np.divide(friction, limit, out=(normal > 0).astype(float), where=limit > 0)
        out.append(ContactState(-table[..., 0], normal, friction, table[..., 5:8], use))
    return out


def _smallest(gap: Array) -> float:
    there = gap[~np.isnan(gap)]
    return float(there.min()) if there.size else float("nan")


def _share(part: Array, whole: Array) -> Array:
    return np.divide(part, whole, out=np.full(np.shape(whole), np.nan), where=np.asarray(whole) > 0)
