r"""The cable as small-deflection modal bodies joined by bushings, in the plane: the baseline of flexible multibody programs.

Every body is a straight segment of the length l in a floating frame (x, y, phi) at its root; it bends by clamped-free beam modes,

.. math:: w(\xi, t) = \sum_k \eta_k(t) Y_k(\xi), \qquad
          Y_k = \cosh\beta\xi - \cos\beta\xi - \sigma(\sinh\beta\xi - \sin\beta\xi), \quad \cos\beta l \cosh\beta l = -1,

with \int Y^2 = l and the stiffness EI beta^4 l. Linear modes keep the segment's projection l on its frame however far it bends: the
foreshortening \int w'^2 / 2 is missing, and a body that turns by theta between root and tip is too long by theta^2/6 of its length.
Eigenmodes converge slowly under an end moment: m of them give the share

.. math:: \sum_{k=1}^{m} \frac{Y_k'(l)^2}{\beta_k^4 l^2} \approx 1 - \frac{4}{\pi^2 m}

of the tip's turn M l / EI: 0.61, 0.80, 0.87 for one, two, three modes. Stretch and shear lie in the bushings. Friction
is Coulomb's with anchors, as for the rod.
Source: A. A. Shabana, Dynamics of Multibody Systems, 4th ed., Cambridge 2013, chapters 5 and 6 (floating frame of reference).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from geometry.errors import ConvergenceError, SpecError

Array = NDArray[np.float64]

ROOTS = (1.8751040687119611, 4.694091132974174, 7.854757438237613, 10.99554073487547, 14.13716839104647)
"""beta l of the first modes."""
STATIONS = 6
"""Gauss points of a segment that carry its mass and touch."""
STEP = 1e-7
"""Step of the forward differences."""

Touch = Callable[[float, Array, Array, Array], tuple[Array, Array]]
"""(t, points (n, k, 2), velocities, anchors (n, k)) -> (force per length of cable (n, k, 2), new anchors)."""


def clamped_free_modes(x: Array, length: float, count: int) -> tuple[Array, Array]:
    """Modes (count, k) and slopes [1/m] at the places `x` (k,) [m].

    Examples
    --------
    >>> Y, _ = clamped_free_modes(np.array([0.0, 2.0]), 2.0, 2)
    >>> Y.round(6).tolist()
    [[0.0, 2.0], [0.0, -2.0]]
    """
    if not 1 <= count <= len(ROOTS):
        raise SpecError(f"between 1 and {len(ROOTS)} modes of a segment are known, asked for {count}.")
    b = np.array(ROOTS[:count])[:, None]
    sigma = (np.sinh(b) - np.sin(b)) / (np.cosh(b) + np.cos(b))
    z = b * x / length
    Y = np.cosh(z) - np.cos(z) - sigma * (np.sinh(z) - np.sin(z))
    slope = b / length * (np.sinh(z) + np.sin(z) - sigma * (np.cosh(z) - np.cos(z)))
    return Y, slope


@dataclass(frozen=True)
class ModalChain:
    """`count` segments of the length `length` [m], with EI [N m2], mass per length [kg/m], `modes` each.

    `stiffness` of a bushing: along [N/m], across [N/m], turning [N m/rad]. `damping` is a time [s] for all of them. `ends` are whether
    the root of the first and the tip of the last segment are held (then at the places and angles of `hold`).
    """

    count: int
    length: float
    EI: float
    mass: float
    stiffness: tuple[float, float, float]
    modes: int = 3
    damping: float = 0.0
    gravity: tuple[float, float] = (0.0, 0.0)
    touch: Touch | None = None
    hold: Callable[[float], tuple[Array, Array]] | None = None
    end_moment: float = 0.0
    xi: Array = field(init=False, repr=False)
    weights: Array = field(init=False, repr=False)
    Y: Array = field(init=False, repr=False)
    tip: Array = field(init=False, repr=False)
    tip_slope: Array = field(init=False, repr=False)
    modal_stiffness: Array = field(init=False, repr=False)

    def __post_init__(self) -> None:
        x, w = np.polynomial.legendre.leggauss(STATIONS)
        object.__setattr__(self, "xi", 0.5 * self.length * (x + 1))
        object.__setattr__(self, "weights", 0.5 * self.length * w)
        object.__setattr__(self, "Y", clamped_free_modes(self.xi, self.length, self.modes)[0])
        tip, slope = clamped_free_modes(np.array([self.length]), self.length, self.modes)
        object.__setattr__(self, "tip", tip[:, 0])
        object.__setattr__(self, "tip_slope", slope[:, 0])
        beta = np.array(ROOTS[: self.modes]) / self.length
        object.__setattr__(self, "modal_stiffness", self.EI * beta**4 * self.length)

    @property
    def size(self) -> int:
        """Unknowns of a segment."""
        return 3 + self.modes

    def points(self, X: Array, xi: Array, Y: Array) -> Array:
        """Places (n, k, 2) of the points `xi` (k,) with the mode values `Y` (modes, k)."""
        c, s = np.cos(X[:, 2:3]), np.sin(X[:, 2:3])
        w = X[:, 3:] @ Y
        return np.stack([X[:, 0:1] + c * xi - s * w, X[:, 1:2] + s * xi + c * w], axis=-1)

    def jacobian(self, X: Array, xi: Array, Y: Array) -> Array:
        """Derivatives of :meth:`points`, (n, k, 2, size)."""
        c, s = np.cos(X[:, 2:3]), np.sin(X[:, 2:3])
        w = X[:, 3:] @ Y
        out = np.zeros((len(X), len(xi), 2, self.size))
        out[:, :, 0, 0] = out[:, :, 1, 1] = 1.0
        out[:, :, 0, 2], out[:, :, 1, 2] = -s * xi - c * w, c * xi - s * w
        out[:, :, 0, 3:] = -s[:, :, None] * Y.T
        out[:, :, 1, 3:] = c[:, :, None] * Y.T
        return out

    def residual(self, t: float, X: Array, V: Array, A: Array, anchors: Array | None) -> tuple[Array, Array | None]:
        """Inertia plus inner minus outer forces (n, size), and where the friction's anchors go."""
        J = self.jacobian(X, self.xi, self.Y)
        rate = V[:, None, 2:3]
        arm = np.einsum("nkif,nf->nki", J[..., 2:3], np.ones((len(X), 1)))  # A' s
        flex = np.einsum("nkif,nf->nki", J[..., 3:], V[:, 3:])  # A s'
        turned = np.stack([-flex[..., 1], flex[..., 0]], axis=-1)
        outward = np.stack([arm[..., 1], -arm[..., 0]], axis=-1)  # A s
        acceleration = np.einsum("nkif,nf->nki", J, A) - rate**2 * outward + 2 * rate * turned
        pull = self.mass * (acceleration - np.array(self.gravity))
        moved = anchors
        if self.touch is not None and anchors is not None:
            place = self.points(X, self.xi, self.Y)
            force, moved = self.touch(t, place, np.einsum("nkif,nf->nki", J, V), anchors)
            pull = pull - force
        R = np.einsum("nkif,nki,k->nf", J, pull, self.weights)
        R[:, 3:] += self.modal_stiffness * (X[:, 3:] + self.damping * V[:, 3:])
        self._bushings(t, X, V, R)
        return R, moved

    def bushing_forces(self, t: float, X: Array, V: Array) -> tuple[Array, Array]:
        """Tension [N] and moment [N m] of the bushings: root of the first, between neighbours, tip of the last, (n + 1,)."""
        d, rate, _, _ = self._relative(t, X, V)
        f = np.array(self.stiffness)[:, None] * (d + self.damping * rate)
        return f[0], f[2]

    def _relative(self, t: float, X: Array, V: Array) -> tuple[Array, Array, Array, Array]:
        """Displacement and rate (3, n + 1) in the frame of the tip before, its angle (n + 1,), and the gap (n + 1, 2)."""
        tip = self.points(X, np.array([self.length]), self.tip[:, None])[:, 0]
        J = self.jacobian(X, np.array([self.length]), self.tip[:, None])[:, 0]
        speed = np.einsum("nif,nf->ni", J, V)
        angle, spin = X[:, 2] + X[:, 3:] @ self.tip_slope, V[:, 2] + V[:, 3:] @ self.tip_slope
        first, last = (np.zeros(6), np.zeros(6)) if self.hold is None else self.hold(t)  # x, y, angle and their rates
        alpha, turn = np.append(first[2], angle), np.append(first[5], spin)
        gap = np.vstack([X[:, :2], last[:2]]) - np.vstack([first[:2], tip])
        open_ = np.vstack([V[:, :2], last[3:5]]) - np.vstack([first[3:5], speed])
        c, s = np.cos(alpha), np.sin(alpha)
        ahead, beside = c * gap[:, 0] + s * gap[:, 1], c * gap[:, 1] - s * gap[:, 0]
        d = np.array([ahead, beside, np.append(X[:, 2], last[2]) - alpha])
        rate = np.array([
            c * open_[:, 0] + s * open_[:, 1] + turn * beside, c * open_[:, 1] - s * open_[:, 0] - turn * ahead,
            np.append(V[:, 2], last[5]) - turn,
        ])  # fmt: skip
        if self.hold is None:  # free tip
            d[:, -1], rate[:, -1] = 0.0, 0.0
        return d, rate, alpha, gap

    def _bushings(self, t: float, X: Array, V: Array, R: Array) -> None:
        d, rate, alpha, _ = self._relative(t, X, V)
        f = np.array(self.stiffness)[:, None] * (d + self.damping * rate)
        c, s = np.cos(alpha), np.sin(alpha)
        force = np.stack([c * f[0] - s * f[1], s * f[0] + c * f[1]], axis=1)
        on_frame = f[0] * d[1] - f[1] * d[0] - f[2]  # by the angle of the tip before
        R[:, :2] += force[:-1]
        R[:, 2] += f[2, :-1]
        J = self.jacobian(X, np.array([self.length]), self.tip[:, None])[:, 0]
        R -= np.einsum("nif,ni->nf", J, force[1:])
        R[:, 2] += on_frame[1:]
        R[:, 3:] += on_frame[1:, None] * self.tip_slope
        R[-1, 2] -= self.end_moment
        R[-1, 3:] -= self.end_moment * self.tip_slope


@dataclass
class ModalMotion:
    """Implicit steps of a chain: Newmark's method with a little damping (gamma 0.6, beta 0.3025), Newton with full tangents on demand."""

    chain: ModalChain
    X: Array
    V: Array
    t: float = 0.0
    iterations: int = 0
    tangents: int = 0

    def __post_init__(self) -> None:
        self.A = np.zeros_like(self.X)
        touch = self.chain.touch is not None
        self.anchors = np.full((self.chain.count, STATIONS), np.nan) if touch else None
        self._inverse: Array | None = None
        self._step = 0.0

    def step(self, h: float, tolerance: float, rest: bool = False, most: int = 40) -> None:
        """One step of `h` [s]; with `rest` towards the equilibrium: backward Euler from rest, without keeping anchors.

        Raises
        ------
        ConvergenceError
            If the residual stays above `tolerance` [N].
        """
        beta, gamma = (1.0, 1.0) if rest else (0.3025, 0.6)
        if rest:
            self.V, self.A = 0 * self.V, 0 * self.A
        v0 = self.V + (1 - gamma) * h * self.A
        x0 = self.X + h * self.V + h * h * (0.5 - min(beta, 0.5)) * self.A
        X, A, t = self.X.copy(), np.zeros_like(self.A), self.t + (0.0 if rest else h)
        A = (X - x0) / (beta * h * h)
        last, moved = np.inf, self.anchors
        for k in range(most):
            V = v0 + gamma * h * A
            R, moved = self.chain.residual(t, X, V, A, self.anchors)
            size = float(np.abs(R).max())
            if size <= tolerance:
                break
            if self._inverse is None or self._step != h or size > 0.4 * last or k % 10 == 9:
                self._inverse, self._step = self._tangent(t, X, V, A, gamma / (beta * h), 1 / (beta * h * h)), h
            last = size
            dX = -(self._inverse @ R.ravel()).reshape(X.shape)
            dX *= min(1.0, max(0.05, 0.2 * self.chain.length) / max(float(np.abs(dX[:, :3]).max()), 1e-12))
            X = X + dX
            A = (X - x0) / (beta * h * h)
            self.iterations += 1
        else:
            raise ConvergenceError(
                f"the chain of modal bodies found no step of {h:g} s at {self.t:.3f} s: {size:.1e} N are left; take shorter steps."
            )
        self.X, self.V, self.A, self.t = X, v0 + gamma * h * A, A, t
        if not rest:
            self.anchors = moved

    def advance(self, duration: float, h: float, tolerance: float) -> None:
        """Go on for `duration` [s] in steps of `h`; one that does not converge is halved, eight times at most.

        Raises
        ------
        ConvergenceError
            If the shortest step does not converge.
        """
        steps, done = round(duration / h), 0.0
        parts = 1
        while done < steps - 1e-9:
            try:
                self.step(h / parts, tolerance)
            except ConvergenceError:
                if parts >= 256:
                    raise
                parts *= 2
                continue
            done += 1 / parts
            whole = abs(done - round(done)) < 1e-9
            parts = max(parts // 2, 1) if whole else parts

    def _tangent(self, t: float, X: Array, V: Array, A: Array, factor: float, factor_a: float) -> Array:
        """Inverse of the iteration matrix by differences: segments three apart are moved together."""
        n, f = X.shape
        base = self.chain.residual(t, X, V, A, self.anchors)[0]
        K = np.zeros((n, f, n, f))
        for colour in range(3):
            moved = np.arange(colour, n, 3)
            for c in range(f):
                D = np.zeros_like(X)
                D[moved, c] = STEP
                R = self.chain.residual(t, X + D, V + factor * D, A + factor_a * D, self.anchors)[0]
                change = (R - base) / STEP
                for j in moved:
                    near = slice(max(j - 1, 0), j + 2)
                    K[near, :, j, c] = change[near]
        self.tangents += 1
        return np.asarray(np.linalg.inv(K.reshape(n * f, n * f)), dtype=np.float64)


def modal_equilibrium(chain: ModalChain, X: Array, tolerance: float = 1e-3, steps: int = 120) -> ModalMotion:
    """Rest shape from the shape `X` (n, size): steps that grow from 1 ms, each from rest.

    Raises
    ------
    ConvergenceError
        If the chain does not come to rest.
    """
    motion, h = ModalMotion(chain, X.copy(), np.zeros_like(X)), 1e-3
    for _ in range(steps):
        before = motion.X
        try:
            motion.step(h, tolerance, rest=True)
        except ConvergenceError:
            if h < 1e-6:
                raise
            h *= 0.25
            continue
        if h >= 10.0 and float(np.abs(motion.X - before).max()) < 1e-8:
            break
        h = min(1.5 * h, 100.0)
    else:
        raise ConvergenceError(
            f"the chain of modal bodies did not come to rest in {steps} steps; the last had {h:g} s."
        )
    motion.V, motion.A = 0 * X, 0 * X
    motion.iterations = motion.tangents = 0
    motion._inverse = None
    return motion
