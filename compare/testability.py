r"""What these experiments can show, before any verdict: every effect against the refitted base, and pair by pair.

Each effect is given its smallest size of interest, a change whose rms is 2 % of the rms of the linear load (for a channel
without a linear load: 2 noise floors). With W whitening and P the projection off the base columns,

.. math::  D_i = |P W c_i| , \qquad D_{ij} = \min_\theta |P_{j(\theta)} W c_i| , \qquad
           \text{confusion}_{ij} = \Phi(-D_{ij}/2)

D_i below 3 cannot be told from a refitted base: the effect is not testable. D_ij is what is left of i when j is fitted to it
in the shape that suits it best. An effect of size s is seen about when s D_i / (2 %) is 6.
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtr

from compare.bench_design import Block, make_blocks
from compare.bench_model import BenchModel
from compare.calibration import calibrate
from compare.campaign import Campaign
from compare.findings import Check, Separation, Untestable
from compare.form_fit import Site, shape_grid, sites
from compare.noise_floor import measure_noise
from compare.search import Progress
from effects.effect import Effect
from effects.library import library as whole_library

Array = NDArray[np.float64]
SIZE = 0.02
TESTABLE, SEEN = 3.0, 6.0
_PER_SITE = 7
_TIED = 0.8
_VARIES = 1.02


@dataclass(frozen=True)
class Signatures:
    """White changes (N, m) that one effect makes at one place for several shapes, each of the smallest size of interest."""

    site: Site
    columns: Array = field(repr=False)

    @property
    def D(self) -> float:
        """Largest distance from the refitted base over the shapes."""
        return float(np.sqrt(np.max(np.sum(self.columns**2, axis=0), initial=0.0)))


def signatures(block: Block, index: int, library: Sequence[Effect]) -> list[Signatures]:
    """Signatures of every effect at every place of a block, the base projected out."""
    base = np.vstack([record.whitened(()) for record in block.records])
    Q, R = np.linalg.qr(base)
    Q = Q[:, np.abs(np.diag(R)) > 1e-9 * np.abs(np.diag(R)).max()] if base.size else Q
    found = []
    for site in sites(block, index, library):
        changes = []
        for shape in _some(shape_grid(site.effect.forms[0], block)):
            change = _change(block, site, shape)
            if change is not None:
                changes.append(change - Q @ (Q.T @ change))
        columns = np.hstack(changes) if changes else np.zeros((len(base), 1))
        found.append(Signatures(site, columns))
    return found


def _some(shapes: Sequence[tuple[float, ...]]) -> list[tuple[float, ...]]:
    if len(shapes) <= _PER_SITE:
        return list(shapes)
    return [shapes[i] for i in np.unique(np.linspace(0, len(shapes) - 1, _PER_SITE).round().astype(int))]


def _change(block: Block, site: Site, shape: tuple[float, ...]) -> Array | None:
    """White change of the readings by the effect at its smallest size of interest, (N, 1) or None if there is none."""
    term = site.term(site.effect.forms[0], shape)
    raw, white, size, noise = [], [], 0.0, 0.0
    for record in block.records:
        base = record.columns(())
        changed = record.columns((term,))
        for reading, Z0, Z1 in zip(record.readings, base, changed, strict=True):
            linear = Z0.sum(axis=1)
            delta = (Z1[:, Z0.shape[1] :] if term.form.strength else Z1 - Z0).sum(axis=1)
            raw.append(float(delta @ delta))
            touched = bool(delta.any())
            size += float(linear @ linear) if touched else 0.0
            noise += len(delta) * reading.whiten.noise.sample_variance * reading.whiten.factor**2 if touched else 0.0
            white.append(reading.whiten(delta[:, None]))
    rms = np.sqrt(sum(raw))
    if rms <= 1e-12 * np.sqrt(size + noise) or rms == 0:
        return None
    wanted = SIZE * np.sqrt(size) if size > 0 else 2 * np.sqrt(noise)
    return np.vstack(white) * (wanted / rms)


def check(
    model: BenchModel,
    campaign: Campaign,
    progress: Progress | None = None,
    library: Sequence[Effect] | None = None,
) -> Check:
    """Whether the data are readable, what was recorded, how noisy it is, and what these experiments can show.

    Parameters
    ----------
    model : BenchModel
        With the nominal stiffness.
    campaign : Campaign
        Sealed experiments are left alone.
    """
    tell = progress or (lambda _fraction, _sentence: None)
    tell(0.0, "learning the noise from repeats")
    noise = measure_noise(campaign)
    bench = [e for e in campaign.of_set("calibrate") if model.covers(e)]
    tell(0.3, "calibrating the linear stiffness")
    linear = calibrate(model.linear, bench, noise)
    tell(0.5, "asking what these experiments can tell apart")
    blocks = make_blocks(bench, linear.model, noise)
    effects = tuple(library) if library is not None else whole_library()
    separation, untestable, smallest, _ = testability(blocks, effects)
    notes = linear.notes
    sealed = [e.id for e in campaign.experiments if not e.is_open]
    if sealed:
        notes = (*notes, f"sealed, not read: {', '.join(sealed)}.")
    if not bench:
        notes = (*notes, "no open bench experiment is in the set calibrate: these data can show nothing.")
    return Check(campaign, noise, noise.notes, separation, untestable, smallest, notes)


def testability(
    blocks: Sequence[Block], library: Sequence[Effect]
) -> tuple[Separation, tuple[Untestable, ...], dict[str, str], dict[str, float]]:
    """Separation of the testable effects, the others with the reason, the smallest sizes seen, and every D."""
    by_effect: dict[str, list[Signatures]] = {e.name: [] for e in library}
    for i, block in enumerate(blocks):
        for found in signatures(block, i, library):
            by_effect[found.site.effect.name].append(found)
    D = {name: max((s.D for s in found), default=0.0) for name, found in by_effect.items()}
    testable, untestable = [], []
    for effect in library:
        why = _why_not(effect, blocks, by_effect[effect.name], D[effect.name])
        if why is None:
            testable.append(effect.name)
        else:
            untestable.append(Untestable(effect.name, why))
    smallest = {name: f"{100 * SIZE * SEEN / D[name]:.2g} % of the load (rms)" for name in testable}
    confusion = np.full((len(testable), len(testable)), 0.5)
    for (i, a), (j, b) in itertools.permutations(enumerate(testable), 2):
        confusion[i, j] = float(ndtr(-_distance(by_effect[a], by_effect[b]) / 2))
    size = tuple(f"{100 * SIZE:.0f} % of the load (rms)" for _ in testable)
    distance = np.array([D[name] for name in testable])
    return Separation(tuple(testable), distance, size, confusion, confounded(blocks)), tuple(untestable), smallest, D


def _distance(one: Sequence[Signatures], rival: Sequence[Signatures]) -> float:
    """Left of one effect where it is seen best, when the rival is fitted to it in its best shape."""
    best = max(one, key=lambda s: s.D)
    c = best.columns[:, int(np.argmax(np.sum(best.columns**2, axis=0)))]
    own = [s for s in rival if s.site.block == best.site.block]
    left = float(c @ c)
    for s in own:
        norms = np.sum(s.columns**2, axis=0)
        good = norms > 1e-9 * max(float(norms.max(initial=0.0)), 1e-300)
        if good.any():
            along = (c @ s.columns[:, good]) ** 2 / norms[good]
            left = min(left, float(c @ c - along.max()))
    return float(np.sqrt(max(left, 0.0)))


def _why_not(effect: Effect, blocks: Sequence[Block], found: Sequence[Signatures], D: float) -> str | None:
    """Sentence why an effect is not testable with these blocks, or None."""
    reason = cannot_act(effect, blocks, bool(found))
    if reason or TESTABLE <= D:
        return reason
    kinds = [block for block in blocks if block.kind in effect.kinds]
    if effect.stage == "cross" and any("coupling" in block.base for block in kinds):
        return "the coupling is part of the section already and is calibrated with it"
    return f"at 2 % of the load it is only {D:.1f} noise units away from a refitted linear model (3 are needed); {effect.needs}"


def cannot_act(effect: Effect, blocks: Sequence[Block], has_place: bool) -> str | None:
    """Sentence why an effect cannot show in these experiments whatever its size, or None."""
    kinds = [block for block in blocks if block.kind in effect.kinds]
    if not kinds:
        return f"acts in {', '.join(effect.kinds)} experiments, of which there are none"
    reasons = [effect.why_untestable(block.paths) for block in kinds]
    if all(reasons):
        return str(reasons[0])
    if not has_place:
        return "the other load (torque of a tension test, force of a torsion test) was not recorded"
    return None


def worth_trying(library: Sequence[Effect], blocks: Sequence[Block], D: Mapping[str, float]) -> list[Effect]:
    """Effects that could show if they are large, also those whose smallest size of interest would not.

    Left out are those that cannot act here, and those that would not show at ten times that size.
    """
    return [e for e in library if D[e.name] >= TESTABLE / 10 and cannot_act(e, blocks, True) is None]


def covariates(block: Block) -> dict[str, Array]:
    """Largest strain, largest rate, tension, temperature and length of every record, where all of them have it."""
    rows: dict[str, list[float | None]] = {}
    for record in block.records:
        path = record.led.path
        strain = path.strain[record.led.lead :]
        rate = None
        if path.time is not None and len(strain) > 2:
            rate = float(np.abs(np.diff(strain) / np.diff(path.time[record.led.lead :])).max())
        of_conditions = (
            None if block.kind == "tension" else (None if path.tension is None else float(path.tension.mean()))
        )
        values = {
            "amplitude": float(np.abs(strain).max()), "rate": rate, "axial tension": of_conditions,
            "temperature": path.temperature, "specimen length": path.length,
        }  # fmt: skip
        for name, value in values.items():
            rows.setdefault(name, []).append(value)
    return {name: np.array(v, dtype=float) for name, v in rows.items() if all(x is not None for x in v)}


def confounded(blocks: Sequence[Block]) -> tuple[str, ...]:
    """Sentences on conditions that vary together, so that what is due to one may be due to the other."""
    sentences = []
    for block in blocks:
        values = {}
        for name, v in covariates(block).items():
            u = np.log(np.maximum(v, 1e-300)) if name != "temperature" else v
            if np.ptp(u) > (np.log(_VARIES) if name != "temperature" else 0.5):
                values[name] = u
        for a, b in itertools.combinations(values, 2):
            r = float(np.corrcoef(values[a], values[b])[0, 1])
            if abs(r) > _TIED:
                way = "rises" if r > 0 else "falls"
                sentences.append(
                    f"{block.kind}: {a} {way} with {b} (correlation {r:.2f}), so that what is due to one may be due to "
                    "the other."
                )
    return tuple(sentences)
