r"""Contact that can open, in tension and torsion: a convex minimum with one-sided bounds.

The interface carries no shear and no tension. With the gap g of two parts that are pressed together at zero stretch and twist,
the section condensed onto the openings s (:mod:`homogenize.interface_condensation`, harmonic 0; tangential slips are free) obeys

.. math::
   \min_s\; \tfrac12 s^T S s + s^T (A e + q), \qquad g = s + g_0 \ge 0, \qquad
   w\, p = q + A e + S s \ge 0, \qquad p\, g = 0 ,

e = (stretch, twist rate), g_0 a gap (negative: an interference) of the unloaded parts, q = w p_0 the force of a grip that is there at
zero strain, w the surface per length. The answer F = C e + A^T s is path-independent and piecewise linear in e; without gap
and grip it is homogeneous of degree one. The energy per length W = e C e / 2 + s^T A e + s S s / 2 + q^T s has F as its derivative.

Solved exactly. With S = M^T M and A e + q - S g_0 = M^T c it is the least-squares problem min |M g + c| over g >= 0: an active
set that ends after finitely many steps (Lawson, Hanson, Solving Least Squares Problems, 1974, ch. 23). A motion of a part in the
null space of S has no say in F and p; it is taken as small as the bounds allow, and named by :meth:`OpeningSection.loose_parts`.
Without friction a part that is open all round could also move like the first harmonic (a shift that stands still in space); nothing here
drives it.

Kinematics are small: the pairs of nodes that meet do not change.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import nnls

from geometry.cell_mesh import CrossSectionMesh
from geometry.errors import ConvergenceError, SpecError
from homogenize.coulomb_interface import Coulomb
from homogenize.free_motion import free_motions
from homogenize.interface_choice import Interfaces
from homogenize.interface_condensation import CondensedHarmonic, Progress, condense, without_torque
from homogenize.section_field import FloatArray
from homogenize.section_system import section_system
from homogenize.sliding_interface import SlidingField

_NULL = 1e-9
"""Eigenvalues of S below this share of the largest are motions of whole parts."""
_BALANCE = 1e-6
"""Share of the grip's force that may act on such a motion."""
_ZERO = 1e-8
"""Contact forces below this share of the largest force that the load can put on a node are none."""


@dataclass(frozen=True)
class Unilateral:
    """Contact that can open; `gap` [m] of the unloaded parts, negative for an interference, and friction coefficient.

    Friction makes the answer depend on the history of the load: :func:`homogenize.rubbing_section.contact_section`.

    Raises
    ------
    SpecError
        If the gap is not finite, or the friction is negative.

    Examples
    --------
    >>> Unilateral().describe()
    'contact that can open'
    """

    gap: float = 0.0
    friction: float = 0.0

    def __post_init__(self) -> None:
        if not np.isfinite(self.gap):
            raise SpecError(f"the gap of an interface must be a finite length, found {self.gap:g} m.")
        if not (np.isfinite(self.friction) and self.friction >= 0):
            raise SpecError(f"a friction coefficient must be zero or positive, found {self.friction:g}.")

    @property
    def holds(self) -> bool:
        """Resists a small slip wherever it is pressed; without friction it does not."""
        return self.friction > 0

    @property
    def opens(self) -> bool:
        """The normal jump is an unknown."""
        return True

    def describe(self) -> str:
        """The law in words."""
        word = "gap" if self.gap > 0 else "interference"
        words = ["contact that can open"]
        words += [f"{word} {abs(self.gap):g} m"] if self.gap else []
        return ", ".join([*words, f"friction {self.friction:g}"] if self.friction else words)


@dataclass(frozen=True)
class OpeningSection:
    """A section condensed onto the openings of its interfaces (m nodes) and its strains (p).

    Attributes
    ----------
    harmonic : C (p, p), A (m, p), S (m, m)
    strains, forces : names of the strains that a path prescribes and of the forces that answer
    gap : (m,) g_0 [m]
    surface : (m,) w, surface of each node per length of cable [m]
    position : (2, m) in the rotating frame at phase zero [m]
    normal : (3, m) of the interface, out of the first of its two parts
    parts : (m,) names of the two parts
    closed_motions : motions without energy while everything is closed, in words; they are held
    """

    harmonic: CondensedHarmonic
    strains: tuple[str, ...]
    forces: tuple[str, ...]
    gap: FloatArray
    surface: FloatArray
    position: FloatArray
    normal: FloatArray
    parts: tuple[tuple[str, str], ...]
    closed_motions: tuple[str, ...]
    mesh: CrossSectionMesh
    sliding: SlidingField

    @property
    def closed(self) -> FloatArray:
        """Stiffness (p, p) while nothing opens."""
        return np.real(self.harmonic.C)

    @property
    def open(self) -> FloatArray:
        """Stiffness (p, p) when everything is open."""
        return np.real(self.harmonic.frictionless)

    def loose_parts(self, is_open: NDArray[np.bool_]) -> tuple[str, ...]:
        """Motions that nothing resists once the nodes of a mask (m,) are open, and that a closed interface would stop."""
        doubled, opening = self.sliding.doubled, self.sliding.opening
        kept = np.setdiff1d(np.arange(len(doubled.child)), opening[is_open])
        holds = np.array([law.holds for law in self.sliding.laws.values()])[doubled.law]
        reduced = replace(
            doubled,
            child=doubled.child[kept],
            parent=doubled.parent[kept],
            law=doubled.law[kept],
            regions=doubled.regions[kept],
            frame=doubled.frame[:, :, kept],
            surface=doubled.surface[kept],
        )
        found = free_motions(self.sliding.undoubled, self.mesh, reduced, holds[kept]).sentences
        return tuple(dict.fromkeys(sentence for sentence in found if sentence not in self.closed_motions))


@dataclass(frozen=True)
class OpeningPath:
    """A path of strains and the answer (n steps, p strains, m nodes).

    Attributes
    ----------
    strain, force : (n, p), in the order and with the names of the section
    gap : (n, m) between the parts [m]
    pressure : (n, m) [Pa]
    is_open : (n, m) nodes without pressure
    energy : (n,) per length [J/m]
    loose : (n,) motions of parts that nothing resists in this step
    """

    section: OpeningSection
    strain: FloatArray
    force: FloatArray
    gap: FloatArray
    pressure: FloatArray
    is_open: NDArray[np.bool_]
    energy: FloatArray
    loose: tuple[tuple[str, ...], ...]

    @property
    def open_share(self) -> FloatArray:
        """Share of the interfaces' surface that carries no pressure, (n,)."""
        w = self.section.surface
        return np.where(self.is_open, w, 0.0).sum(axis=1) / w.sum()

    def slope(self, step: int, strain: int = 0) -> float:
        """Change of force over change of strain in one step."""
        dF, de = self.force[step] - self.force[step - 1], self.strain[step] - self.strain[step - 1]
        return float(dF[strain] / de[strain])


def opening_section(mesh: CrossSectionMesh, interfaces: Interfaces, free_twist: bool = False) -> OpeningSection:
    """Condense a section for paths of (stretch, twist rate), or of the stretch alone with ends that are free to turn.

    Parameters
    ----------
    mesh : CrossSectionMesh
        Six-node triangles.
    interfaces : Interfaces
        At least one of them :class:`Unilateral`; frictionless and elastic ones keep their laws.
    free_twist : bool
        The torque is zero and the twist follows.

    Raises
    ------
    SpecError, MeshError
        If nothing can open, an interface rubs, or names do not fit the parts.
    ConvergenceError
        If the section with closed interfaces is not connected.
    """
    laws = interfaces.laws.values()
    if not any(isinstance(law, Unilateral) for law in laws):
        raise SpecError("no interface can open: give at least one of them the law Unilateral().")
    if any(isinstance(law, Coulomb) or (isinstance(law, Unilateral) and law.friction) for law in laws):
        raise SpecError(
            "friction beside contact that opens depends on the history of the load: follow it with contact_section and friction_loop."
        )
    system = section_system(mesh, interfaces, opening=True)
    sliding = system.sliding
    assert sliding is not None
    links, doubled = sliding.opening, sliding.doubled
    harmonic = condense(system, sliding.first_opening + np.arange(len(links)), 0)
    return OpeningSection(
        harmonic=without_torque(harmonic) if free_twist else harmonic,
        strains=("stretch",) if free_twist else ("stretch", "twist"),
        forces=("N",) if free_twist else ("N", "M_z"),
        gap=sliding.constant_of_links("gap")[links],
        surface=doubled.surface[links],
        position=doubled.nodes[:, doubled.child[links]],
        normal=doubled.frame[0][:, links],
        parts=tuple((mesh.regions[a].name, mesh.regions[b].name) for a, b in doubled.regions[links]),
        closed_motions=system.free_motions,
        mesh=mesh,
        sliding=sliding,
    )


def opening_path(
    section: OpeningSection, strain: FloatArray, grip: float | FloatArray = 0.0, progress: Progress | None = None
) -> OpeningPath:
    """Gap, pressure and section forces at each row of a path; rows do not depend on each other.

    Parameters
    ----------
    section : OpeningSection
    strain : (n, p) array
    grip : float or (m,) array
        Pressure that is on the closed interfaces at zero strain [Pa]; forces count from that state.

    Raises
    ------
    SpecError
        If the path has the wrong shape, the grip is negative, or it is not in equilibrium on a part that is free to move.
    ConvergenceError
        If the active set does not end.
    """
    path = _path(section, strain)
    C, A = section.closed, np.real(section.harmonic.A)
    solver = _Complementarity(np.real(section.harmonic.S), section.gap)
    q = _grip(section, grip) * section.surface
    if np.abs(solver.null.T @ q).max(initial=0.0) > _BALANCE * float(np.abs(q).max()):
        raise SpecError(
            "this grip is not in equilibrium: it would push a part out of its seat that nothing else holds "
            f"({', '.join(section.loose_parts(np.ones(len(q), dtype=bool)))}); give the interface an interference, Unilateral(gap < 0)."
        )
    n, m = len(path), len(q)
    force, energy = np.zeros(path.shape), np.zeros(n)
    gap, pressure = np.zeros((n, m)), np.zeros((n, m))
    is_open = np.zeros((n, m), dtype=bool)
    loose: dict[bytes, tuple[str, ...]] = {}
    resting: list[tuple[str, ...]] = []
    for i, e in enumerate(path):
        load = A @ e + q
        s, f = solver.solve(load, float(np.sqrt(e @ C @ e)))
        force[i] = C @ e + A.T @ s
        energy[i] = 0.5 * e @ (C @ e) + s @ load + 0.5 * s @ (solver.S @ s)
        gap[i], pressure[i] = s + section.gap, f / section.surface
        is_open[i] = f == 0
        apart = (gap[i] > 0).tobytes()
        if apart not in loose:
            loose[apart] = section.loose_parts(gap[i] > 0)
        resting.append(loose[apart])
        if progress:
            progress((i + 1) / n, f"step {i + 1} of {n}")
    return OpeningPath(section, path, force, gap, pressure, is_open, energy, tuple(resting))


class _Complementarity:
    """min s S s / 2 + b s over s >= -g0, for one S and many b in its range."""

    def __init__(self, S: FloatArray, g0: FloatArray) -> None:
        values, vectors = np.linalg.eigh(S)
        kept = values > _NULL * values[-1]
        self.S, self.g0, self.null = S, g0, vectors[:, ~kept]
        self.stiffest = float(np.sqrt(S.diagonal().max()))
        root = np.sqrt(values[kept])
        self.M = root[:, None] * vectors[:, kept].T
        self.inverse = vectors[:, kept].T / root[:, None]  # c = inverse b solves M^T c = b

    def solve(self, b: FloatArray, work: float) -> tuple[FloatArray, FloatArray]:
        """s, and the contact forces S s + b, zero where open.

        `work` is the root of e C e: as the energy is never negative, |A e| <= root(S_ii) work, the scale of what counts as zero.
        """
        shifted = b - self.S @ self.g0
        scale = max(float(np.abs(b).max()), float(np.abs(self.S @ self.g0).max()), self.stiffest * work)
        if scale == 0.0:
            return -self.g0, np.zeros_like(b)
        try:
            g, _ = nnls(self.M, -self.inverse @ shifted, maxiter=30 * len(b))
        except RuntimeError:
            raise ConvergenceError(
                f"the contact problem did not end within {30 * len(b)} changes of its {len(b)} nodes between open and closed."
            ) from None
        g = self._centred(g)
        f = self.S @ g + shifted
        f[np.abs(f) < _ZERO * scale] = 0.0
        if f.min() < 0 or f[g > 0].any():
            worst = max(-float(f.min()), float(np.abs(f[g > 0]).max(initial=0.0))) / scale
            raise ConvergenceError(f"the contact problem is out of balance by {worst:.1e} of its nodal forces.")
        return g - self.g0, f

    def _centred(self, g: FloatArray) -> FloatArray:
        """The same state with as little of the motions without energy as g >= 0 allows."""
        if self.null.shape[1] == 0:
            return g
        excess = self.null @ (self.null.T @ (g - self.g0))
        shrinks = excess > 0
        if not shrinks.any() or not excess.any():
            return g
        return np.maximum(g - min(1.0, float((g[shrinks] / excess[shrinks]).min())) * excess, 0.0)


def _path(section: OpeningSection, strain: FloatArray) -> FloatArray:
    path = np.asarray(strain, dtype=float)
    if path.ndim != 2 or path.shape[1] != len(section.strains) or len(path) == 0 or not np.isfinite(path).all():
        raise SpecError(f"a load path needs finite rows of {', '.join(section.strains)}; found shape {path.shape}.")
    return path


def _grip(section: OpeningSection, grip: float | FloatArray) -> FloatArray:
    pressure = np.broadcast_to(np.asarray(grip, dtype=float), section.surface.shape)
    if not (np.isfinite(pressure).all() and (pressure >= 0).all()):
        raise SpecError("the grip must be a pressure of zero or more at every node of the interfaces that can open.")
    return pressure
