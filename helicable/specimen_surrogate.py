r"""The cheap model of a specimen's calibration: a reduced basis that learns at every optimum, and curves for what it cannot hold.

Moduli, lay and length move the specimen inside a reduced basis of bonded solutions on a coarse section
(:mod:`homogenize.specimen.reduced_basis`), exact at each of them. What changes the mesh or the unknowns, a dimension or the stiffness
of an interface, enters as a factor of its own that was measured at one centre x_0 at a few places of its range,

.. math::  \ln f(x, d) = \ln f(x) + \sum_i g_i(d_i), \qquad g_i(d) = \ln \frac{f(x_0, d)}{f(x_0)}

the first order of a cut expansion (Rabitz, Alis, J. Math. Chem. 25 (1999) 197-233); between them a monotone cubic. The centre moves to
the optimum with :meth:`SpecimenSurrogate.recentre`.
"""

from __future__ import annotations

import logging
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from compare.multi_start import sobol_starts
from compare.target_file import InputParameter
from geometry import Cable, CrossSectionMesh
from geometry.errors import ConvergenceError, MeshError, SpecError
from helicable.calibration_case import CalibrationCase, cable_at, interfaces_at, is_interface, outputs_of, value_of
from homogenize.specimen import AxialGrading, Specimen, coarse_section, solve_specimen
from homogenize.specimen.reduced_basis import ReducedBasis, ReducedPlace
from homogenize.specimen.snapshot_store import SnapshotStore
from homogenize.specimen.specimen_mesh import specimen_mesh
from homogenize.specimen.unit_response import UNIT_LOADS, UnitResponse, unit_response

log = logging.getLogger(__name__)

Progress = Callable[[float, str], None]
COARSE_GRADING = AxialGrading(end_size=0.1, largest=1.0, growth=4.0)
COARSE_SIZE = 0.2
"""Of the outer diameter: element size of the cheap model where the parts are not round."""
_SEEN = 1e-4
_SPREAD = 0.7
"""Share of the ranges, about their middles, where the first snapshots lie."""
_TOLERANCE = 3e-3
_INTERFACE_PLACES = 4


def start_of(parameters: Sequence[InputParameter]) -> NDArray[np.float64]:
    """Where the search begins, in its coordinates: the start of each parameter, or the middle of its range."""
    found = [sum(p.bounds) / 2 for p in parameters]
    for i, p in enumerate(parameters):
        if p.start is not None:
            found[i] = math.log(p.start) if p.logarithmic else p.start
    return np.array(found)


@dataclass(frozen=True)
class _Curve:
    """Responses along one parameter at the coordinates `at` of the search; None for that of the basis."""

    parameter: InputParameter
    at: NDArray[np.float64]
    responses: tuple[UnitResponse | None, ...]


class SpecimenSurrogate:
    """Outputs of a specimen in milliseconds.

    Parameters
    ----------
    case : CalibrationCase
    progress : callable, optional
    seed : of the places of the first snapshots
    folder : where finished solutions are kept and found again, optional

    Raises
    ------
    SpecError
        If a parameter moves a mixture of things.
    """

    def __init__(
        self, case: CalibrationCase, progress: Progress | None = None, seed: int = 0, folder: Path | None = None
    ) -> None:
        self.case = case
        tell = progress or (lambda fraction, sentence: None)
        low, high = np.array([p.bounds for p in case.file.parameters]).T
        middle = start_of(case.file.parameters)
        self.base = self._values(middle)
        self.moduli = [p for p in case.file.parameters if all(m.endswith(".E") for m in p.moves)]
        self.apart = [p for p in case.file.parameters if _is_dimension(p) or is_interface(p)]
        self._refuse_others()
        cable = cable_at(case, self.base)
        mesh = self._mesh(cable)
        self.hand = math.copysign(1.0, mesh.twist_rate)
        specimen = Specimen(value_of(case, "length", self.base, math.nan), grading=COARSE_GRADING)
        identity = {**case.identity, "coarse": f"{case.coarse}", "base": str(sorted(self.base.items()))}
        self.store = None if folder is None else SnapshotStore(folder, identity)
        self.basis = ReducedBasis(mesh, self._groups(mesh), specimen, tolerance=_TOLERANCE, store=self.store)
        offered = middle + _SPREAD * (sobol_starts(low, high, case.snapshots, seed) - (low + high) / 2)
        offered[0] = middle
        for i, x in enumerate(np.clip(offered, low, high)):
            tell(i / (case.snapshots + len(self.apart)), f"snapshot {i + 1} of {case.snapshots}")
            self.refine(self._values(x))
        tell(case.snapshots / (case.snapshots + len(self.apart)), "dimensions and interfaces")
        self.recentre(self.base)

    def _values(self, x: NDArray[np.float64]) -> dict[str, float]:
        return {p.name: p.value(float(v)) for p, v in zip(self.case.file.parameters, x, strict=True)}

    def _mesh(self, cable: Cable) -> CrossSectionMesh:
        """A few hundred triangles on round parts, if each part is still a region then; else, or if it is asked, that of the full model
        with larger elements."""
        if self.case.coarse is None:
            try:
                mesh = coarse_section(cable)
                if {r.name for r in mesh.regions} == {part.name for part in cable.parts}:
                    return mesh
            except MeshError:
                pass
        return specimen_mesh(cable, self.case.coarse or COARSE_SIZE * cable.outer_diameter)

    def _refuse_others(self) -> None:
        for p in self.case.file.parameters:
            if not (p in self.apart or p in self.moduli or p.moves in (("length",), ("phase",), ("lay-up.lay",))):
                raise SpecError(
                    f'the parameter "{p.name}" moves {", ".join(p.moves)} together; moduli (keys that end in .E), the lay, the length, '
                    "the phase, interfaces and dimensions need a parameter each."
                )

    def _groups(self, mesh: CrossSectionMesh) -> list[int]:
        """The parameter that moves each region's modulus, seen by moving every one by a part of its own; -1 for none."""
        moved = {**self.base, **{p.name: self.base[p.name] * (1 + _SEEN * (g + 1)) for g, p in enumerate(self.moduli)}}
        parts = {part.name: part.material for part in cable_at(self.case, moved).parts}
        ratios = [parts[r.name].E / r.material.E - 1 for r in mesh.regions]  # pyright: ignore[reportAttributeAccessIssue]
        return [round(ratio / _SEEN) - 1 for ratio in ratios]

    def refine(self, values: Mapping[str, float]) -> None:
        """Take the solution at these inputs into the basis, once; one that the layers cannot resolve is left out."""
        place = self.place(values)
        if place in self.basis.places:
            return
        try:
            self.basis.add(place)
        except ConvergenceError as error:
            log.warning("no snapshot at %s: %s", place, error)

    def recentre(self, values: Mapping[str, float]) -> None:
        """Measure the curves of dimensions and interfaces anew about these inputs."""
        self.centre = dict(values)
        if self.apart:
            self.refine(values)
        self.at_centre = self.basis.evaluate(self.place(values))
        self.curves = [self._curve(p) for p in self.apart]
        self._kept: tuple[float, list[Callable[[float], NDArray[np.float64]]]] | None = None

    def _curve(self, p: InputParameter) -> _Curve:
        low, high = p.bounds
        if is_interface(p):
            at = np.linspace(low, high, _INTERFACE_PLACES)
            return _Curve(p, at, tuple(self._stepped(p, float(x)) for x in at))
        base = math.log(self.base[p.name]) if p.logarithmic else self.base[p.name]
        inside = [x for x in (low, high) if abs(x - base) > 1e-3 * (high - low)]
        at = sorted([*inside, base])
        return _Curve(p, np.array(at), tuple(None if x == base else self._stepped(p, x) for x in at))

    def _stepped(self, p: InputParameter, x: float) -> UnitResponse:
        """The response at the centre with one parameter elsewhere and the others of its kind as the basis has them."""
        values = {**self.centre, **{q.name: self.base[q.name] for q in self.apart if not is_interface(q)}}
        values[p.name] = p.value(x)
        key = {"stepped": p.name, "values": str(sorted((k, f"{v:.12g}") for k, v in values.items()))}
        kept = None if self.store is None else self.store.response(key)
        if kept is None:
            mesh = self._mesh(cable_at(self.case, values))
            length = value_of(self.case, "length", values, math.nan)
            interface = interfaces_at(self.case, values, p) if is_interface(p) else "bonded"
            layers: AxialGrading = self.basis.layers  # pyright: ignore[reportAssignmentType]
            specimen = Specimen(length, phase=-mesh.twist_rate * length, interface=interface, grading=layers)
            kept = unit_response(solve_specimen(specimen, mesh, UNIT_LOADS, tolerance=_TOLERANCE))
            if self.store is not None:
                self.store.keep_response(key, kept)
        return kept

    def place(self, values: Mapping[str, float]) -> ReducedPlace:
        """Where the basis is asked; moduli of a group go with the value."""
        factors = tuple(values[p.name] / self.base[p.name] for p in self.moduli)
        lay = value_of(self.case, "lay-up.lay", values, math.nan)
        rate = self.basis.mesh.twist_rate if math.isnan(lay) else self.hand * 2 * math.pi / lay
        return ReducedPlace(factors, rate, value_of(self.case, "length", values, math.nan))

    def __call__(self, values: Mapping[str, float]) -> dict[str, float]:
        place = self.place(values)
        found = outputs_of(self.case, self.basis.evaluate(place), values, place.twist_rate)
        for curve, factors in zip(self.curves, self._factors(value_of(self.case, "phase", values, 0.0)), strict=True):
            p = curve.parameter
            x = math.log(values[p.name]) if p.logarithmic else values[p.name]
            found = {
                name: value * factor for (name, value), factor in zip(found.items(), np.exp(factors(x)), strict=True)
            }
        return found

    def _factors(self, phase: float) -> list[Callable[[float], NDArray[np.float64]]]:
        """Logarithms of what each curve multiplies the outputs by, at a phase; kept for the last one."""
        if self._kept is None or self._kept[0] != phase:
            from scipy.interpolate import PchipInterpolator  # slow to load, needed here only

            rate = self.place(self.centre).twist_rate
            values = {p.name: phase for p in self.case.file.parameters if p.moves == ("phase",)}
            base = np.array(list(outputs_of(self.case, self.at_centre, values, rate).values()))
            found = []
            for curve in self.curves:
                there = [
                    base if r is None else list(outputs_of(self.case, r, values, rate).values())
                    for r in curve.responses
                ]
                ratios = np.array(there) / base
                ratios[:, (ratios <= 0).any(axis=0)] = 1.0  # a modulus past infinity says nothing
                found.append(PchipInterpolator(curve.at, np.log(ratios)))
            self._kept = phase, found
        return self._kept[1]


def _is_dimension(p: InputParameter) -> bool:
    return p.unit == "m" and not {"length", "lay-up.lay"} & set(p.moves)
