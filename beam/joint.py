r"""Joints: exact constraints between two ends by Lagrange's multipliers.

With the relative motion of :mod:`beam.relative_motion`, a joint sets some of

.. math:: \Phi = (d_1, d_2, d_3), \qquad
          \tfrac12 (Q_{32} - Q_{23},\; Q_{13} - Q_{31},\; Q_{21} - Q_{12}) \quad\text{or}\quad (Q_{21}, Q_{31})

to zero at every step. The forces are :math:`G^T \lambda` with G the derivative of Phi, and :math:`\lambda = s\,(\mu + \Phi)`
with the unknown mu: the term s Phi vanishes in the solution and makes the matrix of every body regular. Reactions of
a joint at rest do no work, since :math:`\lambda\cdot\dot\Phi = 0`.

| kind | takes | leaves |
|---|---|---|
| fixed | 3 displacements, 3 turns | nothing |
| pinned | 3 displacements | 3 turns |
| swivel | 3 displacements, 2 turns | turning about `axis`, any number of turns |
| slider | 2 displacements, 3 turns | sliding along `axis` |
| cylindrical | 2 displacements, 2 turns | both about and along `axis` |

Source: M. Arnold, O. Brüls, Multibody Syst. Dyn. 18 (2007) 185-202, doi 10.1007/s11044-007-9084-0 (generalised alpha with constraints).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from beam.bushing import GROUND, End
from beam.compiled import kernel
from beam.relative_motion import spread
from beam.surface import Travel
from geometry.errors import SpecError

Array = NDArray[np.float64]

KINDS = {
    "fixed": (True, True, True, 3),
    "pinned": (True, True, True, 0),
    "swivel": (True, True, True, 2),
    "slider": (False, True, True, 3),
    "cylindrical": (False, True, True, 2),
}
"""Which displacements a kind takes, and how many turns; direction 1 is the joint's axis."""

SCALE = (1e6, 1e4)
"""s for displacements [N/m] and turns [N m/rad]; the solution does not depend on it."""


@dataclass(frozen=True)
class Joint:
    """A joint between two ends: nodes of the rod, bodies, or ``"ground"``.

    Parameters
    ----------
    kind : str
        fixed, pinned, swivel, slider or cylindrical.
    first, second : int or str
    point : (3,) array_like, optional
        Where it is, in the axes of the first; where the second is at the start if not given.
    axis : (3,) array_like
        Axis of a swivel, slider or cylindrical joint in the axes of the first.
    travel : Travel, optional
        Motion of a point on the ground that the joint prescribes.
    name : str

    Both ends stand as the joint wants them at the start, whatever their positions are then.
    """

    kind: str
    first: End
    second: End
    point: ArrayLike | None = None
    axis: ArrayLike = (1.0, 0.0, 0.0)
    travel: Travel | None = None
    name: str = ""

    def __post_init__(self) -> None:
        if self.kind not in KINDS:
            raise SpecError(f"{self.label}: there is no kind {self.kind!r}; choose one of {', '.join(KINDS)}.")
        axis = np.asarray(self.axis, dtype=float)
        if axis.shape != (3,) or not np.linalg.norm(axis) > 0:
            raise SpecError(
                f"{self.label}: its axis must be three numbers that are not all zero, found {axis.tolist()}."
            )
        if self.travel is not None and self.first != GROUND:
            raise SpecError(f"{self.label}: only a first end on the ground can be given a travel.")

    @property
    def label(self) -> str:
        """Name for messages."""
        return f"joint {self.name!r}" if self.name else f"{self.kind} joint between {self.first} and {self.second}"

    @property
    def constraints(self) -> int:
        """Number of equations."""
        *along, turns = KINDS[self.kind]
        return sum(along) + turns

    @property
    def frame(self) -> Array:
        """Axes of the joint (3, 3) in those of the first; the first column is the axis."""
        x = np.asarray(self.axis, dtype=float)
        x = x / np.linalg.norm(x)
        across = np.eye(3)[int(np.argmin(np.abs(x)))]
        y = np.asarray(np.cross(x, across), dtype=float)
        y = y / float(np.linalg.norm(y))
        z = np.asarray(np.cross(x, y), dtype=float)
        return np.array([x, y, z], dtype=float).T


@kernel
def constraints(D: Array, along: bool, turns: int, phi: Array) -> int:
    """Write Phi of the relative motion `D` into `phi` (6,); `along` if direction 1 is taken. Returns their number."""
    n = 0
    for i in range(3):
        if i > 0 or along:
            phi[n] = D[i]
            n += 1
    if turns == 3:
        phi[n], phi[n + 1], phi[n + 2] = 0.5 * (D[13] - D[11]), 0.5 * (D[8] - D[12]), 0.5 * (D[9] - D[7])
    elif turns == 2:
        phi[n], phi[n + 1] = D[9], D[12]
    return n + turns


@kernel
def add_turn(D: Array, i: int, j: int, factor: float, m: Array) -> None:
    """Add factor times the derivative of Q_ij by the second's turning, in its axes, to `m`: e_j x (row i of Q)."""
    a, b = (j + 1) % 3, (j + 2) % 3
    m[a] -= factor * D[6 + 3 * i + b]
    m[b] += factor * D[6 + 3 * i + a]


@kernel
def joint_force(
    along: bool,
    turns: int,
    multipliers: Array,
    P: Array,
    B: Array,
    D: Array,
    phi: Array,
    f: Array,
    m: Array,
    out: Array,
) -> None:
    """Write G^T of the `multipliers` (6,) [N, N m] plus s Phi, on both ends, into `out` (2, 6); the forces are the opposite.

    `phi` receives s Phi; `f`, `m` the forces on the second in frame 1, the moments in frame 2.
    """
    n = constraints(D, along, turns, phi)
    here = 0
    for i in range(3):
        f[i], m[i] = 0.0, 0.0
    for i in range(3):
        if i > 0 or along:
            phi[here] *= SCALE[0]
            f[i] = multipliers[here] + phi[here]
            here += 1
    for i in range(here, n):
        phi[i] *= SCALE[1]
    if turns == 3:
        for k in range(3):
            a, b = (k + 1) % 3, (k + 2) % 3
            size = 0.5 * (multipliers[here + k] + phi[here + k])
            add_turn(D, b, a, size, m)
            add_turn(D, a, b, -size, m)
    elif turns == 2:
        add_turn(D, 1, 0, multipliers[here] + phi[here], m)
        add_turn(D, 2, 0, multipliers[here + 1] + phi[here + 1], m)
    spread(P, B, f, m, out)
