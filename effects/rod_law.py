r"""Effects of the section at work in a rod: the same laws that a bench shows, at every Gauss point.

An effect that was found in a test of one kind adds K c to one section force, where c is the strain that
:meth:`effects.effect.ActiveEffect.advance` gives for the strain of that kind:

=========  ==========================  =====================  ==================
kind       strain                      section force          K
=========  ==========================  =====================  ==================
tension    stretch                     N                      EA
torsion    twist                       M_z                    GJ
bending    kappa_x, and kappa_y apart  M_x, M_y               EI_x, EI_y
=========  ==========================  =====================  ==================

K is the diagonal entry of the section stiffness. Layers are gripped by N = EA epsilon + coupling, the linear axial force of
the same instant, or by a given tension. The two curvatures are treated **component by component**: exact for bending in one of
the planes, and in any plane for linear laws (damping, relaxation); a stick-slip limit is then a square instead of a
circle, up to sqrt(2) too strong for bending along its diagonal.

An effect of the stage ``cross`` is a coupling of stretch and twist. To take no energy from nowhere it acts on both, by the
potential W = K f(x) y per length: K f(x) on the force of y, and K f'(x) y on that of x (x the strain of its kind).

Tangents are differences along the direction in which the strain is going, exact where a law is made of straight pieces.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from beam.section_law import rod_order
from effects.effect import ActiveEffect
from geometry.errors import InputError
from homogenize.section_stiffness import SectionStiffness

Array = NDArray[np.float64]

STRAINS_OF = {"tension": (0,), "torsion": (3,), "bending": (4, 5)}
"""Entries of the rod's strains (stretch, shear x, shear y, twist, kappa_x, kappa_y) on which an effect of a kind acts."""
PARTNER = {0: 3, 3: 0}
DIFFERENCE = 1e-6
"""Step of the tangent over the largest strain or strain increment of the rod."""


@dataclass(frozen=True)
class RodLaw:
    """Section law of effects, for :class:`beam.rod_model.RodModel` and :func:`beam.towing.tow`.

    Parameters
    ----------
    section : SectionStiffness
        The linear section of the rod, whose stiffness the strengths multiply.
    active : sequence of ActiveEffect
        Section effects; one for each kind of strain that it shall act on.
    tension : float or None
        Axial tension that grips the layers [N]; None takes the rod's own.
    temperature : float
        [K].

    Raises
    ------
    InputError
        If an effect does not act in the section, or the coupling of stretch and twist is given twice.

    Examples
    --------
    >>> from effects import find
    >>> effect = find("plasticity")
    >>> bar = SectionStiffness.uncoupled(EA=1e6, GA_x=1e5, GA_y=1e5, EI_x=10.0, EI_y=10.0, GJ=5.0, area=1e-3)
    >>> law = RodLaw(bar, [ActiveEffect(effect, effect.forms[0], "bending", shape=(0.1,), strength=(2.0,))])
    >>> E = np.array([[0.0, 0.0, 0.0, 0.0, 0.3, 0.05]])
    >>> S, _, state = law.advance(E, 0 * E, 1.0, np.zeros((1, law.memory)), tangent=False)
    >>> S[0, 4:].round(12).tolist()  # EI a min(kappa, 0.1), component by component
    [2.0, 1.0]
    """

    section: SectionStiffness
    active: Sequence[ActiveEffect]
    tension: float | None = None
    temperature: float = 293.15
    C: Array = field(init=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "active", tuple(one for one in self.active if not one.neutral))
        object.__setattr__(self, "C", rod_order(self.section.C))
        for one in self.active:
            _require_section_effect(one)
        crossing = [one.kind for one in self.active if one.form.stage == "cross"]
        if len(set(crossing)) > 1:
            raise InputError(
                "the coupling of stretch and twist was given twice, from a tension and from a torsion test: it is one "
                "property of the section and acts on both forces of the rod; pass one of them."
            )

    @property
    def memory(self) -> int:
        """State variables per Gauss point."""
        return sum(one.form.memory * len(STRAINS_OF[one.kind]) for one in self.active)

    def advance(
        self, E: Array, before: Array, dt: float, state: Array, tangent: bool
    ) -> tuple[Array, Array | None, Array]:
        """Forces of all effects after one step, see :class:`beam.section_law.SectionLaw`."""
        S, after = self._step(E, before, dt, state)
        return S, self._tangent(E, before, dt, state, S) if tangent else None, after

    def _step(self, E: Array, before: Array, dt: float, state: Array) -> tuple[Array, Array]:
        S, after = np.zeros_like(E), np.empty_like(state)
        N = E @ self.C[0] if self.tension is None else np.full(len(E), float(self.tension))
        T = np.full(len(E), self.temperature)
        for one, k, part in self._parts():
            c, after[:, part] = one.advance(E[:, k], before[:, k], dt, N, T, state[:, part])
            if one.form.stage == "section":
                S[:, k] += self.C[k, k] * c
                continue
            h = 1e-4 * max(float(np.abs(E[:, k]).max(initial=0.0)), 1e-6)
            high, low = (one.advance(E[:, k] + d, before[:, k], dt, N, T, state[:, part])[0] for d in (h, -h))
            partner = PARTNER[k]
            S[:, partner] += self.C[k, k] * c
            S[:, k] += self.C[k, k] * (high - low) / (2 * h) * E[:, partner]
        return S, after

    def _tangent(self, E: Array, before: Array, dt: float, state: Array, S: Array) -> Array:
        T = np.zeros((len(E), 6, 6))
        acting = {k for _, k, _ in self._parts()}
        if self.tension is None and acting:
            acting |= set(np.nonzero(self.C[0])[0].tolist())
        acting |= {PARTNER[k] for one, k, _ in self._parts() if one.form.stage == "cross"}
        for k in sorted(acting):
            scale = max(float(np.abs(E[:, k]).max(initial=0.0)), float(np.abs(before[:, k]).max(initial=0.0)), 1e-9)
            h = np.where(E[:, k] >= before[:, k], 1.0, -1.0) * DIFFERENCE * scale
            ahead = E.copy()
            ahead[:, k] += h
            T[:, :, k] = (self._step(ahead, before, dt, state)[0] - S) / (ahead[:, k] - E[:, k])[:, None]
        return T

    def _parts(self) -> Iterator[tuple[ActiveEffect, int, slice]]:
        """Every effect with each strain that it acts on, and where its state is."""
        start = 0
        for one in self.active:
            for k in STRAINS_OF[one.kind]:
                yield one, k, slice(start, start + one.form.memory)
                start += one.form.memory


def _require_section_effect(one: ActiveEffect) -> None:
    name, stage = one.effect.name, one.form.stage
    if stage not in ("section", "cross"):
        where = {"fixture": "between the rig and the section of a specimen", "filter": "in the sensor"}.get(
            stage, "in the sensor"
        )
        raise InputError(f"{name} acts {where}, not in the section: it cannot act in a rod. Leave it out.")
    if one.form.advance is None:
        raise InputError(f'{name}, form "{one.form.name}", has no step (advance), so that a rod cannot call it.')
    if one.kind not in STRAINS_OF or (stage == "cross" and one.kind == "bending"):
        raise InputError(
            f"{name} was given for {one.kind} tests, whose path is no strain of the section: "
            f"give it for {'tension or torsion' if stage == 'cross' else 'tension, torsion or bending'}."
        )
    if stage == "cross" and one.form.memory:
        raise InputError(
            f'{name}, form "{one.form.name}": a coupling with a memory has no energy; take a form without.'
        )
