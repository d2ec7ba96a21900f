"""The fits of an explanation on disk, so that one that was killed goes on from what it had fitted.

What takes the time is the search of the shapes of every effect at every place beside what was accepted. Its result, the best
shapes and the evidence, is kept line by line (:mod:`compare.evaluation_store`) under a hash of the data, the base model, the
accepted effects and what was tried: another campaign, or another row in it, finds nothing of it.
"""

from __future__ import annotations

import hashlib
import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from compare.campaign import Campaign
from compare.evaluation_store import EvaluationStore
from effects.effect import ActiveEffect, Effect

FILE = "fits.jsonl"
_VERSION = 2


@dataclass
class FitStore:
    """Shapes and log evidence by what was tried.

    Attributes
    ----------
    campaign : str
        Hash of everything that the fits depend on beside what was accepted and tried.
    store : EvaluationStore
    """

    campaign: str
    store: EvaluationStore = field(repr=False)

    @classmethod
    def of(cls, campaign: Campaign, library: Sequence[Effect], model: object, path: str | Path) -> FitStore:
        """In a file; what it holds of the same campaign, effects and model is used again.

        Raises
        ------
        InputError
            If the file cannot be read.
        """
        digest = hashlib.sha256(repr((model, getattr(model, "towing", None))).encode())
        for e in campaign.experiments:
            if e.set == "calibrate" or (e.set == "validate" and e.repeat_of):
                told = (e.id, e.kind, e.set, e.specimen, sorted(e.conditions.items()), e.repeat_of, e.continues)
                digest.update(repr((*told, e.direction, e.control, e.sha256)).encode())
        digest.update(repr(sorted(campaign.sensors.items())).encode())
        digest.update(repr(sorted(campaign.towing.items())).encode())
        digest.update(repr(sorted(effect.name for effect in library)).encode())
        return cls(digest.hexdigest(), EvaluationStore(Path(path), resume=True))

    @property
    def found_again(self) -> int:
        """How many searches were not done again."""
        return self.store.found_again

    def get(
        self, accepted: Sequence[ActiveEffect], tried: Sequence[str], searched: bool
    ) -> tuple[tuple[float, ...], float] | None:
        """Shapes and log evidence of a search that was finished before."""
        found = self.store.get(self._inputs(accepted, tried, searched))
        if found is None:
            return None
        return tuple(found[f"shape {k}"] for k in range(len(found) - 1)), found["log e"]

    def put(
        self,
        accepted: Sequence[ActiveEffect],
        tried: Sequence[str],
        searched: bool,
        shape: Sequence[float],
        log_e: float,
    ) -> None:
        """Keep a finished search."""
        outputs = {f"shape {k}": float(v) for k, v in enumerate(shape)}
        outputs["log e"] = float(log_e) if math.isfinite(log_e) else -1e300
        self.store.put(self._inputs(accepted, tried, searched), outputs)

    def _inputs(self, accepted: Sequence[ActiveEffect], tried: Sequence[str], searched: bool) -> dict[str, Any]:
        beside = [[t.effect.name, t.form.name, t.kind, t.channel, *t.shape] for t in accepted]
        return {
            "version": _VERSION,
            "campaign": self.campaign,
            "accepted": beside,
            "tried": list(tried),
            "searched": searched,
        }
