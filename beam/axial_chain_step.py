r"""Time steps of the axial chain (:mod:`beam.axial_chain`): Newmark's average acceleration with friction at the end of a step.

With the displacement u1 at the end of a step,

.. math::  v_1 = 2 (u_1 - u_0)/\Delta t - v_0, \qquad a_1 = 4 (u_1 - u_0)/\Delta t^2 - 4 v_0/\Delta t - a_0

and friction N mu(|v1|) z1/d with the bristle z1 = z0 + u1 - u0 held within +-d. The speed at the end of the step, not its mean, keeps
the order two: with the mean the oscillation of sticking and slipping is damped numerically.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from beam.compiled import embedded, kernel

Array = NDArray[np.float64]
TOLERANCE = 1e-7  # of the friction limit: the residual at which a step is settled


@embedded
def exponential(x: float) -> float:
    """exp(x) by its series for |x| < 1/16, to 1e-12."""
    return 1 + x * (1 + x * (1 / 2 + x * (1 / 6 + x * (1 / 24 + x * (1 / 120 + x * (1 / 720))))))


@kernel
def march(  # noqa: C901, PLR0915 - one step of the chain, node by node
    t: Array,
    motion: Array,
    substeps: int,
    M: Array,
    k: float,
    beta: float,
    normal: Array,
    law: Array,
    drag: float,
    out: Array,
    energies: Array,
) -> int:
    """Every step begins with the friction of the last one made linear, and the tangent of the last one as it is factorised.

    All but friction is linear, so that after a solve the residual is what friction does beside its linear form. The tangent
    is factorised again, from the first node on that has changed, where a slope moves by a ten-thousandth of the inertia.
    """
    mu, fall, fall_speed, power, travel = law[0], law[1], law[2], law[3], law[4]
    n = len(M)
    u, v, a, f = np.zeros(n), np.zeros(n), np.zeros(n), np.zeros(n)
    u1, v1, a1, f1 = np.zeros(n), np.zeros(n), np.zeros(n), np.zeros(n)
    z, z1 = np.zeros(n), np.zeros(n)  # of the bristles, counted where friction falls with speed
    known, right, r, new, tangent = np.zeros(n), np.zeros(n), np.zeros(n), np.zeros(n), np.zeros(n)
    inverse, link, inertia, begin, moved = np.zeros(n), np.zeros(n), np.zeros(n), np.zeros(n), np.zeros(n)
    viscous = np.full(n, drag)
    viscous[0] = 0.5 * drag
    viscous[n - 1] = 0.5 * drag
    stiff = normal * ((mu + fall) / travel)
    slope = stiff.copy()
    close = normal * ((mu + fall) * TOLERANCE)
    row, led, lost_f, lost_d, lost_c, pull = 0, 0.0, 0.0, 0.0, 0.0, 0.0
    dt, kk, per_fall = 0.0, 0.0, 0.0
    counted = len(energies) > 0
    told, excess = np.full(n, -1.0), np.zeros(n)  # where the excess of friction was last worked out in full
    stale = 1  # the first node whose factors are not those of `slope`
    v[0], a[0] = motion[0, 1], motion[0, 2]
    for i in range(len(t)):
        if i > 0:
            if abs(t[i] - t[i - 1] - dt) > 1e-9 * dt:  # steps that differ by rounding are the same
                dt = t[i] - t[i - 1]
                kk = k * (1.0 + 2.0 * beta / dt)
                per_fall = 2.0 / (dt * fall_speed)
                stale = 1
                for j in range(n):
                    inertia[j] = 4.0 * M[j] / dt**2 + 2.0 * viscous[j] / dt
            half = 0.5 * dt**2
            for j in range(n):
                u1[j] = u[j] + dt * v[j] + half * a[j]
                v1[j] = v[j] + dt * a[j]
            u1[0], v1[0] = motion[i, 0], motion[i, 1]
            for j in range(n):
                f1[j] = f[j] + slope[j] * (u1[j] - u[j] - begin[j])
                known[j] = k * (u1[j] + beta * v1[j])
            for j in range(1, n - 1):
                r[j] = M[j] * a[j] + viscous[j] * v1[j] + f1[j] + 2.0 * known[j] - known[j - 1] - known[j + 1]
            j = n - 1
            r[j] = M[j] * a[j] + viscous[j] * v1[j] + f1[j] + known[j] - known[j - 1]
            settled = False
            for round_ in range(60):
                damp = 1.0 if round_ < 20 else 0.5
                for j in range(stale, n):
                    ends = 2.0 if j < n - 1 else 1.0
                    d = inertia[j] + ends * kk + slope[j]
                    if j > 1:
                        d -= link[j - 1] * kk
                    inverse[j] = 1.0 / d
                    link[j] = kk * inverse[j]
                stale = n
                carried = 0.0
                for j in range(1, n):
                    carried = link[j - 1] * carried - r[j]
                    right[j] = carried * inverse[j]
                step = 0.0
                for j in range(n - 1, 0, -1):
                    step = right[j] + link[j] * step
                    moved[j] = damp * step
                for j in range(n):
                    u1[j] += moved[j]
                    f1[j] += slope[j] * moved[j]
                if fall > 0.0:
                    for j in range(n):
                        du = u1[j] - u[j]
                        rate = 2.0 / dt * du - v[j] if j > 0 else motion[i, 1]
                        q, rise = abs(rate) / fall_speed, power
                        if power == 0.0:
                            e = fall / (1.0 + q * q)
                            rise = 2.0 * q / (1.0 + q * q)
                        else:
                            if power == 2.0:
                                q, rise = q * q, 2.0 * q
                            elif power != 1.0:
                                ratio = q
                                q = ratio**power
                                rise = power * q / (ratio + 1e-300)
                            ahead = told[j] - q
                            if abs(ahead) > 0.0625:
                                told[j], excess[j], ahead = q, fall * math.exp(-q), 0.0
                            e = excess[j] * exponential(ahead)
                        z1[j] = min(max(z[j] + du, -travel), travel)
                        top = normal[j] * (mu + e)
                        new[j] = top * z1[j] / travel
                        tangent[j] = -normal[j] * z1[j] / travel * math.copysign(e * rise * per_fall, rate)
                        if abs(z1[j]) < travel:
                            tangent[j] += top / travel
                else:
                    for j in range(n):
                        trial = f[j] + stiff[j] * (u1[j] - u[j])
                        top = normal[j] * mu
                        held = min(max(trial, -top), top)
                        new[j] = held
                        tangent[j] = stiff[j] if held == trial else 0.0
                balanced = 0
                r[0], f1[0] = 0.0, new[0]
                for j in range(n):
                    r[j] = (1.0 - damp) * r[j] + new[j] - f1[j]
                    f1[j] = new[j]
                    balanced += abs(r[j]) <= close[j]
                for j in range(1, n):
                    if abs(tangent[j] - slope[j]) > 1e-4 * inertia[j]:
                        stale = j
                        break
                for j in range(stale, n):
                    slope[j] = tangent[j]
                if balanced == n:
                    settled = True
                    break
            if not settled:
                return i
            for j in range(n):
                du = u1[j] - u[j]
                begin[j] = 0.0 if (abs(z1[j]) < travel if fall > 0.0 else tangent[j] == stiff[j]) else du
                v1[j] = 2.0 / dt * du - v[j]
                a1[j] = 4.0 / dt**2 * du - 4.0 / dt * v[j] - a[j]
            v1[0], a1[0] = motion[i, 1], motion[i, 2]
            if counted:
                for j in range(1, n):
                    rate = v1[j] - v1[j - 1] + v[j] - v[j - 1]
                    lost_d += k * beta * 0.5 * rate * (u1[j] - u1[j - 1] - u[j] + u[j - 1])
                for j in range(n):
                    lost_f += 0.5 * (f[j] + f1[j]) * (u1[j] - u[j])
                    lost_c += viscous[j] * 0.5 * (v[j] + v1[j]) * (u1[j] - u[j])
        else:
            u1[:], v1[:], a1[:], f1[:] = u, v, a, f
        now = k * (u1[0] - u1[1] + beta * (v1[0] - v1[1])) + M[0] * a1[0] + f1[0] + viscous[0] * v1[0]
        led += 0.5 * (pull + now) * (u1[0] - u[0])
        pull = now
        u, u1 = u1, u
        v, v1 = v1, v
        a, a1 = a1, a
        f, f1 = f1, f
        z, z1 = z1, z
        if i % substeps == 0:
            out[row, 0] = pull
            for j in range(1, n):
                out[row, j] = k * (u[j - 1] - u[j] + beta * (v[j - 1] - v[j]))
            if counted:
                kinetic, elastic = 0.5 * M[0] * v[0] ** 2, 0.0
                for j in range(1, n):
                    kinetic += 0.5 * M[j] * v[j] ** 2
                    elastic += 0.5 * k * (u[j] - u[j - 1]) ** 2
                energies[row, 0], energies[row, 1], energies[row, 2] = led, kinetic, elastic
                energies[row, 3], energies[row, 4], energies[row, 5] = lost_f, lost_d, lost_c
            row += 1
    return -1
