r"""Rotations written as a total rotation vector theta, R = exp(theta^).

With p = |theta|, a = sin p / p, b = (1 - cos p) / p^2, c = (p - sin p) / p^3,

.. math:: R = I + a\,\hat\theta + b\,\hat\theta^2, \qquad T = I - b\,\hat\theta + c\,\hat\theta^2,

where T turns the rate of theta into the angular velocity seen from the section, omega = T theta_dot. T is singular at
p = 2 pi. The same rotation is described by the vector on the other branch,

.. math:: \theta^* = G(\theta) = \theta - 2\pi\,u, \qquad u = \theta / p ,

to which a vector longer than :data:`LARGEST_ROTATION` is taken. Derivatives by arc length and time follow by the chain rule,

.. math:: \theta^{*\prime} = DG[\theta'], \quad \dot\theta^{*\prime} = DG[\dot\theta'] + D^2G[\theta', \dot\theta], \quad
          \ddot\theta^* = DG[\ddot\theta] + D^2G[\dot\theta, \dot\theta], \dots

so that R, its curvature, angular velocity and acceleration are the same before and after.

Source: A. Cardona, M. Geradin, Int. J. Numer. Meth. Eng. 26 (1988) 2403-2438, doi 10.1002/nme.1620261105.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from beam.compiled import kernel

Array = NDArray[np.float64]

LARGEST_ROTATION = 1.25 * np.pi
"""A rotation vector that is longer [rad] at the end of a step goes to the other branch, where it has 2 pi less."""
TURN = 2 * np.pi


@kernel
def rotation_coefficients(p2: float) -> tuple[float, float, float, float, float]:
    """(a, b, c, db, dc): coefficients of R and T, and the derivatives of b and c by p^2."""
    if p2 < 1e-2:
        a = 1 - p2 / 6 * (1 - p2 / 20 * (1 - p2 / 42 * (1 - p2 / 72)))
        b = 0.5 - p2 / 24 * (1 - p2 / 30 * (1 - p2 / 56 * (1 - p2 / 90)))
        c = 1 / 6 - p2 / 120 * (1 - p2 / 42 * (1 - p2 / 72 * (1 - p2 / 110)))
        db = -1 / 24 + p2 / 360 * (1 - p2 / (112 / 3) * (1 - p2 / 67.5))
        dc = -1 / 120 + p2 / 2520 * (1 - p2 / 48 * (1 - p2 / 82.5))
        return a, b, c, db, dc
    inverse = 1.0 / p2
    p = np.sqrt(p2)
    sine, cosine = np.sin(0.5 * p), np.cos(0.5 * p)
    a = 2.0 * sine * cosine / p
    b = 2.0 * sine * sine * inverse
    c = (1.0 - a) * inverse
    return a, b, c, 0.5 * (a - 2.0 * b) * inverse, 0.5 * (b - 3.0 * c) * inverse


def rotation_matrix(theta: Array) -> Array:
    """R of rotation vectors `theta` (..., 3), shape (..., 3, 3); its columns are the section's axes e1, e2, e3.

    Examples
    --------
    >>> rotation_matrix(np.array([0.0, 0.0, np.pi / 2])).round(12)[:, 0] + 0.0
    array([0., 1., 0.])
    """
    theta = np.asarray(theta, dtype=float)
    p = np.linalg.norm(theta, axis=-1)
    a = np.sinc(p / np.pi)
    b = 0.5 * np.sinc(p / (2 * np.pi)) ** 2
    hat = np.zeros((*theta.shape, 3))
    hat[..., 0, 1], hat[..., 0, 2], hat[..., 1, 2] = -theta[..., 2], theta[..., 1], -theta[..., 0]
    hat = hat - np.swapaxes(hat, -1, -2)
    return np.eye(3) + a[..., None, None] * hat + b[..., None, None] * (hat @ hat)


@kernel
def dot(x: Array, y: Array) -> float:
    """x . y of two vectors (3,)."""
    return x[0] * y[0] + x[1] * y[1] + x[2] * y[2]


@kernel
def branch_slope(theta: Array, x: Array, out: Array) -> None:
    """Write DG[x] into `out` (3,), which may be `x`; a symmetric map."""
    p2 = dot(theta, theta)
    shift = TURN / np.sqrt(p2)
    along = shift * dot(theta, x) / p2
    for i in range(3):
        out[i] = (1.0 - shift) * x[i] + along * theta[i]


@kernel
def add_branch_second(factor: float, theta: Array, x: Array, y: Array, out: Array) -> None:
    """Add factor D^2 G[x, y] to `out` (3,); z . D^2 G[x, y] is symmetric in all three."""
    p = np.sqrt(dot(theta, theta))
    ux, uy = dot(theta, x) / p, dot(theta, y) / p
    scale = factor * TURN / (p * p)
    along = (dot(x, y) - 3.0 * ux * uy) / p
    for i in range(3):
        out[i] += scale * (x[i] * uy + y[i] * ux + theta[i] * along)


@kernel
def add_branch_third(theta: Array, x: Array, y: Array, out: Array) -> None:
    """Add D^3 G[x, y, y] to `out` (3,)."""
    p = np.sqrt(dot(theta, theta))
    ux, uy, xy, yy = dot(theta, x) / p, dot(theta, y) / p, dot(x, y), dot(y, y)
    scale = -TURN / (p * p * p)
    along = (3.0 * (2.0 * xy * uy + yy * ux) - 15.0 * ux * uy * uy) / p
    on_x, on_y = 3.0 * uy * uy - yy, 2.0 * (3.0 * ux * uy - xy)
    for i in range(3):
        out[i] += scale * (x[i] * on_x + y[i] * on_y + theta[i] * along)


@kernel
def accelerate_on_branch(
    theta: Array, slope: Array, rate: Array, slope_rate: Array, acceleration: Array, slope_acceleration: Array
) -> None:
    """Take the accelerations of a rotation vector and of its slope to the other branch, in place."""
    branch_slope(theta, slope_acceleration, slope_acceleration)
    add_branch_second(2.0, theta, slope_rate, rate, slope_acceleration)
    add_branch_second(1.0, theta, slope, acceleration, slope_acceleration)
    add_branch_third(theta, slope, rate, slope_acceleration)
    branch_slope(theta, acceleration, acceleration)
    add_branch_second(1.0, theta, rate, rate, acceleration)


@kernel
def move_on_branch(theta: Array, slope: Array, rate: Array, slope_rate: Array) -> None:
    """Take a rotation vector, its derivative by arc length, and their velocities to the other branch, in place."""
    branch_slope(theta, slope_rate, slope_rate)
    add_branch_second(1.0, theta, slope, rate, slope_rate)
    branch_slope(theta, rate, rate)
    branch_slope(theta, slope, slope)
    scale = 1.0 - TURN / np.sqrt(dot(theta, theta))
    for i in range(3):
        theta[i] *= scale


@kernel
def force_on_branch(theta: Array, slope: Array, force: Array, slope_force: Array) -> None:
    """Take generalised forces on (theta*, theta*') back to those on (`theta`, `slope`), in place: the transposed map."""
    branch_slope(theta, force, force)
    add_branch_second(1.0, theta, slope, slope_force, force)
    branch_slope(theta, slope_force, slope_force)


@kernel
def turn_back(q: Array, v: Array, a: Array, b: Array) -> int:
    """Take the nodes of `q` (n, 12) that turned further than :data:`LARGEST_ROTATION` to the other branch, all in place.

    `v` are the velocities, `a` and `b` two accelerations. Returns how many nodes were taken; none of a cable, which has no rotations.
    """
    count = 0
    if q.shape[1] < 9:
        return count
    for i in range(q.shape[0]):
        for _ in range(64):
            theta, slope, rate, slope_rate = q[i, 6:9], q[i, 9:12], v[i, 6:9], v[i, 9:12]
            if not dot(theta, theta) > LARGEST_ROTATION * LARGEST_ROTATION:
                break
            accelerate_on_branch(theta, slope, rate, slope_rate, a[i, 6:9], a[i, 9:12])
            accelerate_on_branch(theta, slope, rate, slope_rate, b[i, 6:9], b[i, 9:12])
            move_on_branch(theta, slope, rate, slope_rate)
            count += 1
    return count
