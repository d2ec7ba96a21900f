r"""The base model on the bench: a straight specimen with a linear section, in every kind of slow experiment.

.. math::
    \text{tension, twist blocked:}\quad & N = EA\,\varepsilon,\; M_z = B\,\varepsilon \\
    \text{torsion, stretch blocked:}\quad & M_z = GJ\,\tau,\; N = B\,\tau \\
    \text{bending:}\quad & M = EI\,\kappa \\
    \text{shear of a cantilever:}\quad & u = F \Bigl(\frac{L^3}{3\,EI} + \frac{L}{GA}\Bigr)

B is the coupling of stretch and twist. Each line has one path and one load; where the load was prescribed it is
solved for the path. Without a direction, EI and GA are those that a specimen longer than the pitch shows: the
compliances of the two axes averaged. Source: Saint-Venant beam theory with Timoshenko shear, e.g. Timoshenko & Gere,
Mechanics of Materials.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from compare.bench_response import respond
from compare.experiment import Experiment
from compare.kinds import KINDS
from compare.nominal_section import BenchSection
from effects.effect import ActiveEffect
from effects.library import find
from geometry.errors import InputError

if TYPE_CHECKING:
    from compare.towing_setup import TowingSetup

Array = NDArray[np.float64]
BENCH_KINDS = ("tension", "torsion", "bending", "shear")
UNITS = {"EA": "N", "coupling": "N m", "GJ": "N m^2", "EI": "N m^2", "GA": "N", "friction coefficient": "1"}
_LENGTHS_DIFFER = 1.2  # ratio of specimen lengths from which a cantilever test tells bending from shear


@dataclass(frozen=True)
class StiffnessParameter:
    """One number to calibrate: the common ratio, calibrated over nominal, of the stiffnesses that it moves."""

    name: str
    moves: tuple[str, ...]


@dataclass(frozen=True)
class BenchModel:
    """A section on the bench.

    Parameters
    ----------
    section : BenchSection
        Nominal stiffness: a SectionStiffness, or the [section] of a campaign.
    ratios : mapping of str to float
        Stiffness over its nominal value, by ``EA``, ``coupling``, ``GJ``, ``EI``, ``GA``; 1 where it is absent.
    added : tuple of str
        Effects that are switched on; their parameters are found by the next calibration.
    effects : tuple of ActiveEffect
        Effects with values, kind by kind: what the calibration found.
    towing : TowingSetup or None
        The axial chain of towing experiments (:mod:`compare.towing_setup`); without it they are not covered.

    Examples
    --------
    >>> from compare.nominal_section import NominalSection
    >>> model = BenchModel(NominalSection({"EI": 95.0}), {"EI": 2.0})
    >>> model.stiffness("EI")
    190.0
    """

    section: BenchSection
    ratios: Mapping[str, float] = field(default_factory=dict)
    added: tuple[str, ...] = ()
    effects: tuple[ActiveEffect, ...] = field(default=(), repr=False)
    towing: TowingSetup | None = field(default=None, repr=False)

    def add(self, names: Sequence[str] | str) -> BenchModel:
        """The same model with effects of the library switched on, to be calibrated by :func:`compare.compare`.

        Raises
        ------
        SpecError
            If there is no effect of that name.

        Examples
        --------
        >>> from compare.nominal_section import NominalSection
        >>> BenchModel(NominalSection({"EI": 95.0})).add("plasticity").added
        ('plasticity',)
        """
        wanted = (names,) if isinstance(names, str) else tuple(names)
        found = tuple(find(name).name for name in wanted)
        return replace(self, added=tuple(dict.fromkeys((*self.added, *found))), effects=())

    @property
    def linear(self) -> BenchModel:
        """The same stiffness without effects."""
        return replace(self, added=(), effects=())

    def with_ratios(self, ratios: Mapping[str, float]) -> BenchModel:
        """The same section with other stiffness ratios."""
        return replace(self, ratios={**self.ratios, **ratios})

    def stiffness(self, name: str, direction: str | None = None) -> float:
        """EA, coupling, GJ, EI or GA in SI; EI and GA in the plane of `direction`, or averaged over the pitch."""
        return self.ratios.get(name, 1.0) * self._nominal(name, direction)

    def _nominal(self, name: str, direction: str | None) -> float:
        section = self.section
        if name == "friction coefficient":
            if self.towing is None:
                raise InputError("this model has no trough: give it the [towing] of a campaign.")
            return self.towing.friction
        if name == "EA":
            return section.EA_blocked_twist
        if name == "coupling":
            return section.coupling
        if name == "GJ":
            return section.GJ
        along = {"EI": ("EI_y", "EI_x"), "GA": ("GA_x", "GA_y")}[name]  # a deflection along x bends about y
        if direction is not None:
            return float(getattr(section, along[0] if direction[0] == "x" else along[1]))
        x, y = (float(getattr(section, axis)) for axis in along)
        return x if x == y else 2 / (1 / x + 1 / y)

    def covers(self, experiment: Experiment) -> bool:
        """Whether this model can run the experiment; towing needs a :attr:`towing`."""
        return experiment.kind in BENCH_KINDS or (experiment.kind == "towing" and self.towing is not None)

    def predict(self, experiment: Experiment, before: Sequence[Experiment] = ()) -> dict[str, Array]:
        """What the measured channels of an experiment would read without noise, each of shape (n,), SI.

        Parameters
        ----------
        experiment : Experiment
            Open.
        before : sequence of Experiment
            Experiments among which those may be that it continues; only effects with a memory need them.

        Raises
        ------
        InputError
            If the kind is not one of the bench, the experiment is sealed, or a stiffness it needs is not known.
        """
        if not self.covers(experiment):
            raise InputError(
                f"experiment {experiment.id}: a bench model has no {experiment.kind} experiment; "
                f"it has {', '.join(BENCH_KINDS)}."
            )
        if experiment.kind == "towing" and self.towing is not None:
            return self.towing.predict(experiment, self.stiffness("friction coefficient"), self.effects)
        if self.effects:
            return respond(self, experiment, before)
        kind, record = KINDS[experiment.kind], experiment.record
        over_length = (
            experiment.length
            if any(p in (record.prescribed, *record.measured) for p in ("extension", "rotation"))
            else 1.0
        )
        given = record[record.prescribed]
        load_controlled = record.prescribed == kind.load
        main = self.main_stiffness(experiment)
        strain = given / main if load_controlled else given / _path_scale(record.prescribed, over_length)
        predicted = {}
        for channel in record.measured:
            if channel == kind.load:
                predicted[channel] = main * strain
            elif channel in kind.paths:
                predicted[channel] = strain * _path_scale(channel, over_length)
            else:  # the force of a torsion test, the torque of a tension test
                predicted[channel] = self.stiffness("coupling") * strain
        return predicted

    def main_stiffness(self, experiment: Experiment) -> float:
        """Load over path, the path taken per length where the section law is."""
        if experiment.kind == "tension":
            return self.stiffness("EA")
        if experiment.kind == "torsion":
            return self.stiffness("GJ")
        if experiment.kind == "bending":
            return self.stiffness("EI", experiment.direction)
        L, direction = experiment.length, experiment.direction
        return 1 / (L**3 / (3 * self.stiffness("EI", direction)) + L / self.stiffness("GA", direction))

    def free_parameters(self, experiments: Sequence[Experiment]) -> tuple[StiffnessParameter, ...]:
        """The stiffnesses that these experiments see, to be calibrated before anything is said about an effect.

        A coupling that the section does not have is not calibrated: that one is there at all would be an effect. A
        cantilever of a single length shows one number, so that EI and GA then move together, unless bending gives EI.
        """
        seen = {e.kind for e in experiments}
        trough = (StiffnessParameter("friction coefficient", ("friction coefficient",)),) if "towing" in seen else ()
        return (*self._bench_parameters([e for e in experiments if e.kind != "towing"]), *trough)

    def _bench_parameters(self, experiments: Sequence[Experiment]) -> tuple[StiffnessParameter, ...]:
        seen = {e.kind for e in experiments}
        names = [name for kind, name in (("tension", "EA"), ("torsion", "GJ"), ("bending", "EI")) if kind in seen]
        beside = {("tension", "torque"), ("torsion", "force")}
        if any((e.kind, c) in beside for e in experiments for c in e.record.measured) and self.section.coupling != 0:
            names.append("coupling")
        parameters = [StiffnessParameter(name, (name,)) for name in names]
        lengths = [e.length for e in experiments if e.kind == "shear"]
        if not lengths:
            return tuple(parameters)
        if "bending" in seen:
            return (*parameters, StiffnessParameter("GA", ("GA",)))
        if max(lengths) > _LENGTHS_DIFFER * min(lengths):
            return (*parameters, StiffnessParameter("EI", ("EI",)), StiffnessParameter("GA", ("GA",)))
        return (*parameters, StiffnessParameter("EI and GA", ("EI", "GA")))


def _path_scale(path: str, length: float) -> float:
    """Path over the strain, twist or deflection that the section law or the cantilever is written in."""
    return length if path in ("extension", "rotation") else 1.0
