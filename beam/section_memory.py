r"""What a section law with internal state adds to the rod: its forces, their tangent, and the memory of every Gauss point.

The law gives section forces S on top of the linear ones. They act on z = (theta, theta', r') like any section force,
f = B(z)^T S (:func:`beam.strain.force_of_section`), and their tangent is

.. math:: \frac{df}{dz} = \frac{\partial B^T}{\partial z} S + B^T\, T\, B, \qquad T = \frac{dS}{dE}.

A :class:`SectionMemory` is a committed state and is never changed. Every evaluation of the forces goes *from* it and
proposes the next one; who accepts the step keeps the proposal, who rejects it keeps the old one.

The work that the law takes up per length in a step is the trapezoidal rule of S over the path of the strain,

.. math:: w = \tfrac12 (S_n + S_{n+1}) \cdot (E_{n+1} - E_n),

stored and lost together: what is stored comes back with a negative sign, over a closed loop the loss is left.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from beam.compiled import kernel
from beam.element import gather, on_two_branches, reference_strains, scatter, shape_on_one_branch
from beam.element_tangent import scatter_tangent
from beam.hermite import hermite
from beam.rotation_vector import force_on_branch, rotation_coefficients
from beam.section_law import SectionLaw
from beam.strain import force_of_section, strain
from geometry.errors import SpecError

Array = NDArray[np.float64]

LONG = 1e9
"""Duration of a static load step [s]: long enough for every rate to vanish and every relaxation to end."""


@dataclass(frozen=True)
class SectionMemory:
    """Committed state of the law at the Gauss points.

    Attributes
    ----------
    E : (n, 3, 6) array
        Strains minus those of the stress-free shape.
    S : (n, 3, 6) array
        Section forces of the law, without the linear ones.
    state : (3 n, m) array
        The law's internal variables.
    """

    E: Array
    S: Array
    state: Array

    @classmethod
    def fresh(cls, law: SectionLaw, elements: int, points: int) -> SectionMemory:
        """A rod of `elements` that was never strained."""
        zero = np.zeros((elements, points, 6))
        return cls(zero, zero, np.zeros((elements * points, law.memory)))


@dataclass(frozen=True)
class LawStep:
    """One evaluation: the proposed `memory`, the tangent `T` (n, 3, 6, 6) if asked for, the work taken up (n, 3) [N]."""

    memory: SectionMemory
    T: Array | None
    work: Array


def law_step(law: SectionLaw, memory: SectionMemory, E: Array, dt: float | None, tangent: bool) -> LawStep:
    """From `memory` to the strains `E` (n, 3, 6) in the time `dt` [s]; None takes the memory as it is.

    Raises
    ------
    SpecError
        If the memory belongs to another rod, or the law returns arrays of another shape.
    """
    if memory.E.shape != E.shape:
        raise SpecError(f"the memory of the section law is of {memory.E.shape[0]} elements, the rod has {E.shape[0]}.")
    if dt is None:
        return LawStep(memory, np.zeros((*E.shape, 6)) if tangent else None, np.zeros(E.shape[:2]))
    S, T, state = law.advance(E.reshape(-1, 6), memory.E.reshape(-1, 6), dt, memory.state, tangent)
    if S.shape != (memory.state.shape[0], 6) or state.shape != memory.state.shape:
        raise SpecError(
            f"the section law returned forces {S.shape} and a state {state.shape}; "
            f"expected {(memory.state.shape[0], 6)} and {memory.state.shape}."
        )
    S = np.ascontiguousarray(S, dtype=float).reshape(E.shape)
    work = 0.5 * np.einsum("egi,egi->eg", S + memory.S, E - memory.E)
    T = None if T is None else np.ascontiguousarray(T, dtype=float).reshape(*E.shape, 6)
    return LawStep(SectionMemory(E, S, state), T, work)


def strains(q: Array, lengths: Array, x: Array, E0: Array) -> Array:
    """Strains of the shape `q` minus `E0`, (n, 3, 6)."""
    E = np.empty_like(E0)
    reference_strains(q, lengths, x, E)
    return E - E0


@kernel
def section_force_on_nodes(q: Array, lengths: Array, H: Array, w: Array, S: Array, F: Array) -> None:
    """Add what the section forces `S` (n, 3, 6) exert on the nodes to `F` (n + 1, 12)."""
    ends, P = np.empty((2, 12)), np.empty((2, 12))
    for e in range(lengths.size):
        shape_on_one_branch(q, e, ends)
        element_section_force(ends, e, lengths[e], H, w, S, P)
        if on_two_branches(q, e):
            force_on_branch(q[e + 1, 6:9], q[e + 1, 9:12], P[1, 6:9], P[1, 9:12])
        for i in range(2):
            for k in range(12):
                F[e + i, k] += P[i, k]


@kernel
def element_section_force(ends: Array, e: int, length: float, H: Array, w: Array, S: Array, P: Array) -> None:
    """Write what the section forces of element `e` exert on its `ends` (2, 12), both on one branch, into `P` (2, 12)."""
    z, E, f = np.empty(9), np.empty(6), np.empty(9)
    P[:] = 0.0
    for g in range(w.size):
        gather(ends, 0, H, g, length, z)
        force_at_point(z, S[e, g], E, f)
        scatter(f, 0, H, g, length, w[g], P)


@kernel
def force_at_point(z: Array, S: Array, E: Array, f: Array) -> None:
    """Write strains into `E` (6,) and the generalised force of `S` (6,) into `f` (9,)."""
    a, b, c, db, dc = rotation_coefficients(z[0] * z[0] + z[1] * z[1] + z[2] * z[2])
    p0, p1, p2, q0, q1, q2 = strain(z, a, b, c, E)
    force_of_section(z, a, b, c, db, dc, E, p0, p1, p2, q0, q1, q2, S, f)


@kernel
def section_force_tangent(
    q: Array, lengths: Array, x: Array, H: Array, w: Array, S: Array, T: Array, D: Array, U: Array, L: Array
) -> None:
    """Add the tangent of :func:`section_force_on_nodes` with dS = T dE to the blocks; of elements on one branch only."""
    step = 1e-7
    N, dN, z, here, ahead = np.empty(4), np.empty(4), np.empty(9), np.empty(9), np.empty(9)
    E, E_ahead, turned, S_ahead, G = np.empty(6), np.empty(6), np.empty(9), np.empty(6), np.empty((9, 9))
    for e in range(lengths.size):
        if on_two_branches(q, e):
            continue
        for g in range(x.size):
            hermite(x[g], lengths[e], N, dN)
            gather(q, e, H, g, lengths[e], z)
            force_at_point(z, S[e, g], E, here)
            for j in range(9):
                zj = z[j]
                z[j] = zj + step
                force_at_point(z, S[e, g], E_ahead, turned)
                for i in range(6):
                    S_ahead[i] = S[e, g, i]
                    for k in range(6):
                        S_ahead[i] += T[e, g, i, k] * (E_ahead[k] - E[k])
                force_at_point(z, S_ahead, E_ahead, ahead)
                z[j] = zj
                for i in range(9):
                    G[i, j] = (ahead[i] - here[i]) / step
            scatter_tangent(G, e, w[g] * lengths[e], N, dN, D, U, L)
