"""The towing scenario with small-deflection modal bodies for the cable, in the plane; see :mod:`beam.modal_body_chain`.

Trough, deck and roller act on the Gauss points of the segments, with the laws of the scenario; the clamps are mass on the cable. The
bushings carry stretch and shear, and turn a hundred times as hard as a segment bends.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from beam.incline_formula import STANDARD_GRAVITY
from beam.modal_body_chain import ModalChain
from beam.scenario import Scenario
from beam.towing_model import mass_per_length
from beam.towing_path import chain_pins
from geometry.errors import SpecError
from homogenize.section_stiffness import SectionInertia, SectionStiffness

Array = NDArray[np.float64]

STIFF = 100.0
"""Turning stiffness of a bushing over EI / l."""


@dataclass(frozen=True)
class PlaneTrough:
    """Trough, deck and smooth roller of a scenario in the plane."""

    scenario: Scenario
    friction: bool = True

    def __call__(self, t: float, place: Array, speed: Array, anchors: Array) -> tuple[Array, Array]:
        """Force per length on the points (n, k, 2), and the friction anchors (n, k) after it."""
        law, R = self.scenario.contact, self.scenario.layout.bend_radius.value
        u, du, _ = self.scenario.trolley(t)
        centre, height = self.scenario.roller_start + float(u[0]), self.scenario.deck_height
        x, y = place[..., 0], place[..., 1]
        force = np.zeros_like(place)
        deck = (y > 0.5 * height) & (x > centre)
        depth = np.where(deck, height - y, -y)
        normal = _push(depth, -speed[..., 1], law.stiffness.value, law.damping_time.value)
        force[..., 1] += normal
        moved = np.where(normal > 0, np.where(np.isnan(anchors), x, anchors), np.nan)
        if self.friction:
            kt, limit = 0.5 * law.stiffness.value, law.friction.value * normal
            trial = np.where(normal > 0, -kt * (x - np.nan_to_num(moved)), 0.0)
            held = np.clip(trial, -limit, limit)
            force[..., 0] += held
            moved = np.where(normal > 0, x + held / kt, np.nan)
        out = np.stack([x - centre, y - R], axis=-1)
        distance = np.maximum(np.linalg.norm(out, axis=-1), 1e-9)
        out = out / distance[..., None]
        leaving = out[..., 0] * (speed[..., 0] - float(du[0])) + out[..., 1] * speed[..., 1]
        force += _push(R - distance, -leaving, law.roller_stiffness.value, law.damping_time.value)[..., None] * out
        return force, moved


def _push(depth: Array, rate: Array, stiffness: float, damping_time: float) -> Array:
    return np.where(depth > 0, np.maximum(stiffness * (depth + damping_time * rate), 0.0), 0.0)


def modal_towing(
    scenario: Scenario, count: int, section: SectionStiffness, inertia: SectionInertia, modes: int = 3
) -> tuple[ModalChain, Array]:
    """Chain of `count` bodies and its starting shape (count, 3 + modes): straight segments between pins on the cable's path.

    Raises
    ------
    SpecError
        If the scenario has no roller that turns freely.
    """
    if scenario.towing != "intelligent" or scenario.roller.friction is not None:
        raise SpecError(
            "modal bodies are towed round a smooth roller only: take an intelligent scenario without [roller]."
        )
    if scenario.contact.friction_fall is not None or scenario.contact.drag is not None:
        raise SpecError("modal bodies know Coulomb's friction only: leave out contact.friction_fall and contact.drag.")
    C = np.asarray(section.C, dtype=float).diagonal()
    length = scenario.cable.length.value
    l, EI = length / count, float(C[4])
    pins, directions = chain_pins(scenario.pieces, np.linspace(0.0, length, count + 1), l)
    chord = np.diff(pins, axis=0)
    turns = np.arctan2(chord[:, 1], chord[:, 0])
    turns += 2 * np.pi * np.round((0.5 * (directions[:-1] + directions[1:]) - turns) / (2 * np.pi))
    X = np.zeros((count, 3 + modes))
    X[:, :2], X[:, 2] = pins[:-1, :2], turns
    end = np.array([pins[-1, 0], pins[-1, 1], directions[-1]])

    towed_end = scenario.pull

    def hold(t: float) -> tuple[Array, Array]:
        u, du, _ = towed_end(t)
        first = np.array([0.0, 0.0, directions[0], 0.0, 0.0, 0.0])
        return first, np.array([end[0] + u[0], end[1], end[2], du[0], 0.0, 0.0])

    slope = scenario.layout.inclination.value
    chain = ModalChain(
        count, l, EI, mass_per_length(scenario, inertia), (C[2] / l, C[0] / l, STIFF * EI / l), modes,
        scenario.cable.damping_time_bending.value,
        (-STANDARD_GRAVITY * np.sin(slope), -STANDARD_GRAVITY * np.cos(slope)), PlaneTrough(scenario), hold,
    )  # fmt: skip
    return chain, X
