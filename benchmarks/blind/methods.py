"""The methods that are scored: each takes a campaign folder and says verdict, effects, confusable, and how well it fits.

Here and in :mod:`benchmarks.blind.baselines` alone are `compare` and `effects` imported.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any

Method = Callable[[Path], dict[str, Any]]


def explain_method(folder: Path) -> dict[str, Any]:
    """`compare.explain` as a user would call it."""
    from compare import BenchModel, Campaign
    from compare.explain import explain

    campaign = Campaign.read(folder)
    assert campaign.section is not None
    found = explain(BenchModel(campaign.section), campaign)
    held_out = found.errors.get("validate")
    return {
        "verdict": found.verdict,
        "effects": list(found.effects),
        "confusable": list(found.confusable),
        "closest": list(found.closest) if found.closest else None,
        "ranking": [
            [c.effect, c.form, round(c.log_e, 2), round(c.share, 3), round(c.behind, 2)] for c in found.ranking[:5]
        ],
        "needed": round(found.ranking[0].needed, 2) if found.ranking else None,
        "untestable": [u.effect for u in found.untestable],
        "path": [[s.added, s.form, round(s.log_e, 2), round(s.share, 3)] for s in found.path],
        "before": held_out.before if held_out else None,
        "after": held_out.after if held_out else None,
        "ratio": held_out.ratio if held_out else None,
        "ratio_high": held_out.ratio_high if held_out else None,
        "notes": list(found.notes),
    }


def says_none(_folder: Path) -> dict[str, Any]:
    """Names nothing, ever; to try the machinery."""
    return {"verdict": "none", "effects": [], "confusable": [], "ratio": None, "untestable": []}


def baselines_method(folder: Path) -> dict[str, Any]:
    """All baselines at once; their columns are the dear part."""
    from benchmarks.blind.baselines import all_baselines

    return {"several": all_baselines(folder)}


BASELINE_NAMES = ("greedy-aic", "greedy-bic", "omp-cv", "stlsq", "gaussian-process", "refit")
METHODS: Mapping[str, Method] = MappingProxyType(
    {"explain": explain_method, "says-none": says_none, "baselines": baselines_method}
)
