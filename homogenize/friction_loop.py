r"""Loops of tension, torsion and bending of a section whose parts rub or open.

A load path is followed step by step (:mod:`homogenize.contact_step`); each step leaves

.. math::  F = C e + A^H x, \qquad \Delta D = \sum_i c_i\, |\Delta s_i|, \qquad \oint F\, de = \oint \Delta D

(per length, mean over the pitch; the last for a closed loop). Each component of the path is a strain, or the force in its place: then the
strain is part of the same problem (:func:`homogenize.interface_condensation.force_driven`), solved as exactly. The first slope is that of
the bonded section, the last that of the section without friction. With constant grip an unloading branch is the first
loading twice as large (Masing): friction has to be turned round from -c to c. This is exact where the tractions keep their lines,
and a rule of thumb (1e-3 in bending) where they turn.

The pressure p that rubs is, where parts stay closed, a given grip, or a grip that grows with the tension of the step, p = p_0 + p_1 N >= 0;
where they can part it is the contact pressure of the step itself, a given grip included.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geometry.errors import ConvergenceError, SpecError
from homogenize.contact_step import NodeLaws, UnsettledError, contact_step
from homogenize.interface_condensation import Progress
from homogenize.interface_operator import InterfaceOperator
from homogenize.rubbing_section import RubbingSection
from homogenize.section_field import FloatArray

_NULL, _BALANCE = 1e-9, 1e-6
_SAME_GRIP, _MOST_GRIPS = 1e-5, 30
"""Change of the grip, relative to its largest, below which it fits the tension; number of corrections allowed."""
_TOUCHING = 1e-7
"""Gaps below this share of the largest one are none."""


@dataclass(frozen=True)
class FrictionLoop:
    """A load path and the answer (n steps, p strains, j stations, m nodes).

    Attributes
    ----------
    strain, force : (n, p), in the order and with the names of the section
    slip : (n, j, m, 2) along the two tangents of the interface [m]; zero where slips are free and not followed
    traction : (n, j, m, 2) [Pa], on the first part of each interface
    sliding : (n, j, m) whether the node slid in the step
    gap : (n, j, m) between the parts [m]
    pressure : (n, j, m) contact pressure where parts can open, else the grip [Pa]
    dissipation : (n,) heat per length since the start [J/m]
    cap : (n, j, m) largest tangential traction, mu p [Pa]
    iterations : (n,)
    """

    section: RubbingSection
    strain: FloatArray
    force: FloatArray
    slip: FloatArray
    traction: FloatArray
    sliding: NDArray[np.bool_]
    gap: FloatArray
    pressure: FloatArray
    dissipation: FloatArray
    cap: FloatArray
    iterations: NDArray[np.int64]

    def work(self, start: int = 0, stop: int | None = None) -> float:
        """Work of the section forces per length between two steps [J/m]; over a closed loop its area."""
        F, e = self.force[start:stop], self.strain[start:stop]
        return float(np.einsum("np,np->", 0.5 * (F[1:] + F[:-1]), np.diff(e, axis=0)))

    @property
    def is_open(self) -> NDArray[np.bool_]:
        """Nodes with a gap, (n, j, m)."""
        return self.gap > _TOUCHING * self.gap.max(initial=0.0)

    @property
    def open_share(self) -> FloatArray:
        """Share of the surface that can open, along the pitch, that has a gap, (n,)."""
        w = np.where(self.section.opens, self.section.surface, 0.0)
        return self.is_open.mean(axis=1) @ w / max(w.sum(), 1e-300)

    @property
    def cone_violation(self) -> float:
        """Largest |t| / (mu p) - 1 over all steps and nodes; 0 if the cone is kept."""
        gripped = self.cap > (1e-3 if self.section.opens.any() else 1e-9) * self.cap.max(initial=0.0)
        if not gripped.any():
            return 0.0
        length = np.linalg.norm(self.traction, axis=-1)
        return max(0.0, float((length[gripped] / self.cap[gripped]).max()) - 1.0)

    def slope(self, step: int, strain: int = 0) -> float:
        """Change of force over change of strain in one step."""
        dF, de = self.force[step] - self.force[step - 1], self.strain[step] - self.strain[step - 1]
        return float(dF[strain] / de[strain])


def friction_loop(
    section: RubbingSection,
    path: FloatArray,
    grip: float | FloatArray = 0.0,
    grip_per_tension: FloatArray | None = None,
    drives: Sequence[str] | None = None,
    progress: Progress | None = None,
) -> FrictionLoop:
    """Follow a load path from the stress-free section.

    Parameters
    ----------
    section : RubbingSection
        From :func:`~homogenize.rubbing_section.axial_friction`, :func:`~homogenize.rubbing_section.bending_friction` or
        :func:`~homogenize.rubbing_section.contact_section`.
    path : (n, p) array
        It starts at zero, which is put before the first row if it is not there.
    grip : float or (m,) array
        Pressure on the interfaces [Pa]. Where parts can open it is there at zero strain, and forces count from that state.
    grip_per_tension : (m,) array, optional
        Pressure per tension [Pa/N] that is added for the tension of the same step, where parts stay closed; see
        :func:`homogenize.grip_pressure.grip_per_tension`.
    drives : names, optional
        For each column of the path a strain of the section or the force in its place, such as ("stretch", "M_z") for a pull with ends
        that are free to turn, or ("N", "twist"); strains throughout if not given.

    Raises
    ------
    SpecError
        If the path has the wrong shape, a name does not fit, the grip is negative, or it is not in equilibrium on a part that is free.
    ConvergenceError
        If a step does not converge, with the two parts where it is farthest off.

    Examples
    --------
    A pull of 1 kN to and fro with ends that are free to turn::

        found = friction_loop(section, [[1e3, 0.0], [-1e3, 0.0]], grip=1e5, drives=("N", "M_z"))
    """
    forced = section.forced(drives)
    rows = _path(section, path, drives)
    pressure = _Pressure(section, _grip(section, grip), grip_per_tension, forced)
    follow = _Follower(section, section.driven(drives), pressure)
    steps = []
    for i, row in enumerate(rows):
        steps.append(follow.step(row, f"step {i} of {len(rows) - 1}"))
        if progress:
            progress(i / max(len(rows) - 1, 1), f"step {i} of {len(rows) - 1}")
    answer = np.array([step.answer for step in steps])
    return _loop(section, np.where(forced, -answer, rows), np.where(forced, rows, answer), steps)


@dataclass(frozen=True)
class _Step:
    """State after a load step: answer (p,), jumps and forces (j, u), caps (j, rubbing) [N/m], grip (m,) [Pa]."""

    y: FloatArray
    answer: FloatArray
    jumps: FloatArray
    before: FloatArray
    force: FloatArray
    caps: FloatArray
    grip: FloatArray
    iterations: int


class _Pressure:
    """The grip, as far as it depends on the tension."""

    def __init__(
        self, section: RubbingSection, grip: FloatArray, per_tension: FloatArray | None, forced: NDArray[np.bool_]
    ) -> None:
        if per_tension is not None and "N" not in section.forces:
            raise SpecError("in bending the tension is constant: give its grip as grip = T * grip_per_tension.")
        self.grip, self.forced = grip, bool(forced[0])
        self.per_tension = None if per_tension is None else np.where(section.opens, 0.0, per_tension)

    def at(self, tension: float) -> FloatArray:
        """Pressure (m,) [Pa]."""
        return self.grip if self.per_tension is None else np.maximum(self.grip + self.per_tension * tension, 0.0)

    def tension(self, y: FloatArray, answer: FloatArray) -> float:
        """The tension among loads and answers."""
        return float(y[0] if self.forced else answer[0])


class _Follower:
    """The state of a section along its path."""

    def __init__(self, section: RubbingSection, operator: InterfaceOperator, pressure: _Pressure) -> None:
        self.section, self.op, self.pressure = section, operator, pressure
        self.laws: NodeLaws = section.laws
        self.slips = 2 * operator.rubbing
        self.push = np.zeros(operator.unknowns)
        self.push[self.slips :] = (pressure.grip * section.surface)[section.opens]
        _check_grip(section, self.push)
        nothing = np.zeros((operator.stations, operator.unknowns))
        p = len(section.strains)
        self.last = _Step(
            np.zeros(p), np.zeros(p), nothing, nothing, nothing, nothing[:, : operator.rubbing], pressure.grip, 0
        )

    def step(self, y: FloatArray, where: str) -> _Step:
        """One row of the path."""
        load = self.op.load(y) + self.push
        grip = self.pressure.at(self.pressure.tension(y, self.last.answer))
        guess = self._guess(y)
        for _ in range(_MOST_GRIPS):
            found = self._settled(y, load, grip, guess, where)
            wanted = self.pressure.at(self.pressure.tension(y, found.answer))
            if np.abs(wanted - grip).max(initial=0.0) <= _SAME_GRIP * float(wanted.max(initial=0.0)):
                self.last = found
                return found
            grip, guess = wanted, found.jumps - self.last.jumps
        raise ConvergenceError(
            f"{where}: grip and tension did not settle in {_MOST_GRIPS} corrections; take smaller load steps."
        )

    def _settled(self, y: FloatArray, load: FloatArray, grip: FloatArray, guess: FloatArray, where: str) -> _Step:
        section, old = self.section, self.last
        given = (section.friction * grip * section.surface)[section.rubs]
        given[self.laws.opening_of >= 0] = 0.0
        try:
            jumps, count = contact_step(self.op, self.laws, load, old.jumps, given, guess, old.force)
        except UnsettledError as error:
            a, b = section.parts[_node_of(section, error.worst)]
            raise ConvergenceError(f"{where}, worst between {a} and {b}: {error}") from None
        force = self.op.force(jumps) + load
        caps = self.laws.caps(given, force[:, self.slips :])
        return _Step(y, self.op.answer(y, jumps), jumps, old.jumps, force, caps, grip, count)

    def _guess(self, y: FloatArray) -> FloatArray:
        """The last increment of the jumps, scaled to this step of the path; none where the path turns."""
        now, before = y - self.last.y, self.last.y - getattr(self, "previous", self.last.y)
        self.previous = self.last.y
        same = float(before @ now)
        return (
            (self.last.jumps - self.last.before) * same / float(before @ before) if same > 0 else 0.0 * self.last.jumps
        )


def _loop(section: RubbingSection, strain: FloatArray, force: FloatArray, steps: list[_Step]) -> FrictionLoop:
    n, j, m = len(steps), len(steps[0].jumps), len(section.surface)
    rubs, opens, count = section.rubs, section.opens, 2 * int(section.rubs.sum())
    jumps, forces = np.array([s.jumps for s in steps]), np.array([s.force for s in steps])
    slip, traction = np.zeros((n, j, m, 2)), np.zeros((n, j, m, 2))
    gap, cap = np.zeros((n, j, m)), np.zeros((n, j, m))
    slip[:, :, rubs] = jumps[:, :, :count].reshape(n, j, -1, 2)
    traction[:, :, rubs] = forces[:, :, :count].reshape(n, j, -1, 2) / section.surface[rubs, None]
    pressure = np.broadcast_to(np.array([s.grip for s in steps])[:, None], (n, j, m)).copy()
    pressure[:, :, opens] = np.maximum(forces[:, :, count:], 0.0) / section.surface[opens]
    gap[:, :, opens] = jumps[:, :, count:] + section.gap[opens]
    caps = np.array([s.caps for s in steps])
    cap[:, :, rubs] = caps / section.surface[rubs]
    moved = np.diff(slip, axis=0, prepend=slip[:1])
    length = np.linalg.norm(moved, axis=-1)
    heat = np.cumsum((length[:, :, rubs] * caps).sum(axis=(1, 2)) / j)
    return FrictionLoop(
        section,
        strain,
        force,
        slip,
        traction,
        length > 0,
        gap,
        pressure,
        heat,
        cap,
        np.array([s.iterations for s in steps]),
    )


def _node_of(section: RubbingSection, unknown: int) -> int:
    rubbing = int(section.rubs.sum())
    if unknown < 2 * rubbing:
        return int(np.flatnonzero(section.rubs)[unknown // 2])
    return int(np.flatnonzero(section.opens)[unknown - 2 * rubbing])


def _check_grip(section: RubbingSection, push: FloatArray) -> None:
    """Refuse a grip that is not in equilibrium on a part that nothing else holds."""
    if not push.any():
        return
    values, vectors = np.linalg.eigh(np.real(section.operator.S[0]))
    null = vectors[:, values < _NULL * values[-1]]
    work = np.abs(null.T @ push)
    if work.max(initial=0.0) > _BALANCE * float(push.max()):
        a, b = section.parts[_node_of(section, int(np.abs(null[:, work.argmax()]).argmax()))]
        raise SpecError(
            f"this grip is not in equilibrium: it would push {a} out of its seat in {b}, and nothing else holds it; give the interface an "
            "interference, Unilateral(gap < 0)."
        )


def _path(section: RubbingSection, path: FloatArray, drives: Sequence[str] | None) -> FloatArray:
    rows = np.asarray(path, dtype=float)
    p = len(section.strains)
    if rows.ndim != 2 or rows.shape[1] != p or len(rows) == 0 or not np.isfinite(rows).all():
        names = ", ".join(drives or section.strains)
        raise SpecError(f"a load path needs finite rows of {names}; found shape {rows.shape}.")
    return rows if not rows[0].any() else np.concatenate([np.zeros((1, p)), rows])


def _grip(section: RubbingSection, grip: float | FloatArray) -> FloatArray:
    pressure = np.broadcast_to(np.asarray(grip, dtype=float), section.surface.shape)
    if not (np.isfinite(pressure).all() and (pressure >= 0).all()):
        raise SpecError("the grip must be a pressure of zero or more at every node of the rubbing interfaces.")
    return pressure
