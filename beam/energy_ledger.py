r"""Where the energy of a run goes, kept step by step.

Stored energies (kinetic, elastic, gravity, contact penalty, friction bristles) are states. Losses and work are sums over
the steps by the trapezoidal rule: damping in the cable and in the contacts, sliding friction, and the work of the drives,
that is of prescribed supports and moving surfaces. What a section law with internal state takes up counts as a loss; the
part of it that the law only stores comes back as a negative one (:mod:`beam.section_memory`). The balance

.. math:: \Delta(\text{stored}) + \text{losses} - \text{work} = \text{error}

is closed up to the time integration; its size is reported relative to the throughput, the largest of the summed
absolute work and of the energy that was exchanged.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from beam.rod_model import Forces, RodModel

STORED = ("kinetic", "elastic", "gravity", "contact", "bristle")
SPENT = ("damping_loss", "contact_damping_loss", "friction_loss")
SECTION_LAW = "section_law"
BUSHING, BUSHING_LOSS = "bushing", "bushing_damping_loss"
ENERGIES = (*STORED, *SPENT, "drive_work")


def energy_names(model: RodModel) -> tuple[str, ...]:
    """Entries of the account of `model`, the work of the drives last; more with a section law or bodies."""
    law = () if model.law is None else (SECTION_LAW,)
    stored, loss = ((), ()) if model.system is None else ((BUSHING,), (BUSHING_LOSS,))
    return (*STORED, *stored, *SPENT, *loss, *law, "drive_work")


@dataclass
class EnergyLedger:
    """Running account of one model; :meth:`start` once, :meth:`step` after every accepted step."""

    model: RodModel
    totals: dict[str, float] = field(default_factory=dict)
    throughput: float = 0.0
    _first: float = 0.0
    _friction_work: float = 0.0
    _bristle_first: float = 0.0
    _offset: float = 0.0
    _powers: tuple[float, ...] = (0.0,) * 5
    _last: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        self.totals = dict.fromkeys(energy_names(self.model), 0.0)

    def start(self, forces: Forces) -> None:
        """Take the state at the beginning."""
        self._store(forces)
        self._first = self._stored_sum()
        self._bristle_first = forces.bristle
        self._powers = self._power(forces)
        self._last = self._stored()

    def step(self, h: float, forces: Forces) -> None:
        """Add the step of length `h` [s] that ended with these forces."""
        powers = self._power(forces)
        damping, contact, friction, drive, bushing = (
            0.5 * h * (x + y) for x, y in zip(powers, self._powers, strict=True)
        )
        self._powers = powers
        self._store(forces)
        self.totals["damping_loss"] += damping
        self.totals["contact_damping_loss"] += contact
        if self.model.system is not None:
            self.totals[BUSHING_LOSS] += bushing
        self._friction_work += friction
        self.totals["friction_loss"] = self._friction_work - (forces.bristle - self._bristle_first)
        law = forces.law_work
        if self.model.law is not None:
            self.totals[SECTION_LAW] += law
        self.totals["drive_work"] += drive
        stored = self._stored()
        exchanged = 0.5 * sum(abs(x - y) for x, y in zip(stored, self._last, strict=True))
        self._last = stored
        self.throughput += max(
            abs(drive), exchanged, abs(damping) + abs(contact) + abs(friction) + abs(law) + abs(bushing)
        )

    def shift(self, forces: Forces, potential: float) -> None:
        """A rotation vector went to its other branch, where constant moments have the potential `potential` [J]."""
        self._offset += forces.potential - potential

    @property
    def balance_error(self) -> float:
        """(stored + lost - work) over the throughput; positive if energy appeared from nowhere."""
        lost = sum(self.totals[name] for name in SPENT) + self.totals.get(SECTION_LAW, 0.0)
        lost += self.totals.get(BUSHING_LOSS, 0.0)
        error = self._stored_sum() - self._first + lost - self.totals["drive_work"]
        return error / self.throughput if self.throughput > 0 else 0.0

    def _store(self, forces: Forces) -> None:
        self.totals["kinetic"] = forces.kinetic
        self.totals["elastic"] = forces.elastic
        self.totals["gravity"] = forces.potential + self._offset
        self.totals["contact"] = forces.penalty
        self.totals["bristle"] = forces.bristle
        if self.model.system is not None:
            self.totals[BUSHING] = forces.bushing

    def _power(self, forces: Forces) -> tuple[float, ...]:
        drive = forces.held_power + forces.surface_power
        return (
            forces.damping_power,
            forces.contact_damping_power,
            forces.friction_power,
            drive,
            forces.bushing_damping_power,
        )

    def _stored(self) -> tuple[float, ...]:
        return tuple(self.totals[name] for name in (*STORED, BUSHING) if name in self.totals)

    def _stored_sum(self) -> float:
        return sum(self._stored())
