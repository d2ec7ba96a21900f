r"""A towing record in the full rod: the geometrically exact cable on the floor of the trough, in the place of the axial chain.

The rod (:mod:`beam.rod_model`) lies along x on a plane, its towed end at x = L, and is held there along x and against turning.
Gravity is turned by the inclination, the tail tension is a force on node 0, and the contact has the chain's friction law,

.. math::

    |f| \le \mu(v)\,k_n g, \qquad k_t = \mu(0)\,m g\cos\alpha / d, \qquad k_n g = m g\cos\alpha \text{ at rest}

so that a travel d mobilises it at rest (Dahl's bristle, :mod:`beam.contact_force`). The chain's bristle is held at the travel d
whatever the speed, the rod's at the friction of the speed: where friction falls, they part while a cable breaks away, by less
than a travel d. Stretch is damped by the chain's Kelvin-Voigt time. Drag is that of the contact, an added load that lies all
along the cable is mass; the drives lead the end as they lead the chain's, and the bend is lost from what is read.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from beam.axial_chain import GRAVITY, AxialChain
from beam.generalized_alpha import Integrator, StepSettings
from beam.rod import GAUSS_X, Rod
from beam.rod_model import RodModel
from beam.section_law import DampingTimes
from beam.shape import straight
from beam.statics import equilibrium
from beam.support import Support
from beam.surface import ContactLaw, Plane
from compare.nominal_section import BenchSection
from effects.towed_cable import TowedCable
from geometry.errors import ConvergenceError, SpecError
from homogenize.section_stiffness import SectionInertia, SectionStiffness

Array = NDArray[np.float64]
ELEMENT, FEWEST = 0.8, 20
"""Length of an element [m], and the fewest: those of the run that the chain is tested against."""
_FLOOR = 1.25e6  # N/m^2
_RADIUS_OF_GYRATION = 0.016  # m: turning inertia, which a straight trough does not ask for
_BENDING = {"EI": 100.0, "GJ": 100.0}
_PORTIONS = 20  # of a run, between which progress is told


@dataclass(frozen=True)
class Section:
    """Stiffness beside EA: GA [N], EI, GJ [N m^2], and a sentence if some of it was taken because nothing states it."""

    GA: float
    EI: float
    GJ: float
    note: str = ""

    @classmethod
    def of(cls, section: BenchSection, EA: float) -> Section:
        """What a section states; a straight trough hardly asks for the rest.

        Examples
        --------
        >>> from compare.nominal_section import NominalSection
        >>> Section.of(NominalSection({"EI": 95.0}), 4e5).EI
        95.0
        """
        wanted = {"GA": ("GA_x", 0.5 * EA), "EI": ("EI_x", _BENDING["EI"]), "GJ": ("GJ", _BENDING["GJ"])}
        found, taken = {}, []
        for name, (attribute, default) in wanted.items():
            try:
                found[name] = float(getattr(section, attribute))
            except SpecError:
                found[name] = default
                taken.append(f"{name} = {default:.3g}")
        note = f"the section does not state all that the rod has; taken: {', '.join(taken)} (SI)." if taken else ""
        return cls(**found, note=note)


def carried(cable: TowedCable) -> tuple[TowedCable, tuple[str, ...]]:
    """The cable with what the rod can carry, and a sentence on everything that it cannot.

    Its mass is the same everywhere: a load on a part of the cable is left out.
    """
    chain, notes = cable.chain, []
    parts = [load for load in chain.added if not _all_along(load, chain.length)]
    if parts:
        chain = replace(chain, added=tuple(load for load in chain.added if load not in parts))
        notes.append("a load on a part of the cable is not in the rod: rod and chain are compared without it")
    return replace(cable, chain=chain), tuple(notes)


def rod_tensions(
    cable: TowedCable,
    section: Section,
    stations: Sequence[float] = (),
    elements: int | None = None,
    progress: Callable[[float], None] | None = None,
) -> list[Array]:
    """Tension [N] at the towed end behind the bend, and at every station: (n,) each, as the chain gives them.

    Parameters
    ----------
    cable : TowedCable
        As :func:`carried` leaves it.
    section : Section
    stations : sequence of float
        Distances from the towed end [m].
    elements : int, optional
        By default of 0.8 m, at least 20.
    progress : callable, optional
        Called with the part of the run that is done.

    Raises
    ------
    ConvergenceError
        If the cable finds no rest, or a step no balance.
    """
    elements = elements or max(FEWEST, math.ceil(cable.chain.length / ELEMENT))
    t, motion, steps = cable.led()
    model = towed_rod(cable.chain, section, Led(t, motion), elements)
    rest = equilibrium(model)
    if not rest.outcome.completed:
        raise ConvergenceError(f"the full rod finds no rest on the trough: {rest.outcome.detail}")
    step = float(np.median(np.diff(cable.time))) / steps
    run = Integrator(model, rest.q, anchors=rest.anchors, settings=StepSettings(step))
    places = cable.chain.length - np.asarray(stations, dtype=float)
    seen = [(run.t, _tensions(run, places))]
    total = math.ceil((t[-1] - t[0]) / step - 1e-9)
    for portion in np.array_split(np.arange(total), min(_PORTIONS, total)):
        if not run.advance(len(portion), lambda r: seen.append((r.t, _tensions(r, places)))):
            raise ConvergenceError(f"the full rod stopped at t = {run.t:.4g} s: {run.outcome.detail}")
        if progress is not None:
            progress((portion[-1] + 1) / total)
    at = np.array([s for s, _ in seen])
    end, *inside = (np.interp(cable.time - cable.time[0], at, y) for y in np.array([y for _, y in seen]).T)
    return [cable.behind_the_bend(end, motion, steps), *inside]


def towed_rod(chain: AxialChain, section: Section, led: Led, elements: int) -> RodModel:
    """The rod of a chain without load on parts of it, its end led by `led`."""
    mass = chain.mass + sum(extra for extra, _, _ in chain.added)
    stiffness = SectionStiffness.uncoupled(
        EA=chain.EA, GA_x=section.GA, GA_y=section.GA, EI_x=section.EI, EI_y=section.EI, GJ=section.GJ, area=1.0
    )
    turning = mass * _RADIUS_OF_GYRATION**2
    inertia = SectionInertia(mass, turning, turning, 2 * turning)
    rod = Rod.straight(chain.length, elements, stiffness, inertia, DampingTimes(chain.damping_time, chain.damping_time))
    pressed = mass * GRAVITY * math.cos(chain.inclination)
    ratio = (chain.friction + chain.fall) * pressed / chain.presliding / _FLOOR
    law = ContactLaw(
        _FLOOR, chain.friction, bristle_ratio=ratio, bristle_time=0.0,
        fall=chain.fall, fall_speed=chain.fall_speed, fall_power=chain.fall_power, drag=chain.drag,
    )  # fmt: skip
    floor = Plane("trough", law)
    start = straight(rod.s)
    start[:, 1] = -pressed / _FLOOR
    start[:, 0] -= _stretch(chain, rod.s)
    load = np.zeros_like(start)
    load[0, 0] = -chain.tail_tension
    gravity = GRAVITY * np.array([-math.sin(chain.inclination), -math.cos(chain.inclination), 0.0])
    end = Support(-1, ("x", "theta"), led)
    return RodModel(rod, start, [end], gravity, load, [floor])


@dataclass(frozen=True)
class Led:
    """Motion along x through tabulated position, speed and acceleration (m, 3) at the instants t (m,): a cubic between them."""

    t: Array
    motion: Array

    def __call__(self, now: float) -> tuple[Array, Array, Array]:
        """Displacement, velocity, acceleration at a time, (3,) each."""
        t, i = self.t, int(np.searchsorted(self.t, now, side="right")) - 1
        i = min(max(i, 0), len(t) - 2)
        h = float(t[i + 1] - t[i])
        x = min(max((now - float(t[i])) / h, 0.0), 1.0)
        (p, v, a), (q, w, b) = self.motion[i].tolist(), self.motion[i + 1].tolist()
        u = p + (q - p) * x * x * (3 - 2 * x) + h * x * (1 - x) * (v * (1 - x) - w * x)
        du = 6 * (q - p) / h * x * (1 - x) + v * (1 - x) * (1 - 3 * x) - w * x * (2 - 3 * x)
        along = np.zeros((3, 3))
        along[:, 0] = u, du, a + (b - a) * x
        return along[0], along[1], along[2]


def _all_along(load: tuple[float, float, float], length: float) -> bool:
    return load[1] <= 0 and load[2] >= length


def _stretch(chain: AxialChain, x: Array) -> Array:
    """How far the places x are drawn towards the tail at rest without friction, to first order [m]."""
    tension = chain.rest_tension(chain.length - x)
    parts = 0.5 * (tension[1:] + tension[:-1]) * np.diff(x) / chain.EA
    return np.append(np.cumsum(parts[::-1])[::-1], 0.0)


def _tensions(run: Integrator, places: Array) -> Array:
    """At the towed end, and at the places x [m] of the unstretched rod."""
    end = float(run.reaction[run.model.rod.nodes - 1, 0])
    if not places.size:
        return np.array([end])
    begin, lengths = run.model.rod.s[:-1], run.model.rod.lengths
    x = (begin[:, None] + lengths[:, None] * GAUSS_X).ravel()
    return np.append(end, np.interp(places, x, run.forces.S[:, :, 0].ravel()))
