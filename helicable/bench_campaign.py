"""A campaign folder as the verbs check, explain, add and next take it: bench experiments and a model of their section."""

from __future__ import annotations

from pathlib import Path

from compare import BenchModel, Campaign
from compare.bench_model import BENCH_KINDS
from geometry.errors import SpecError
from helicable.commands.compare import campaign_section


def read_bench_campaign(path: Path, verb: str) -> tuple[Campaign, tuple[str, ...]]:
    """The campaign, and a note on experiments that this verb leaves aside.

    Raises
    ------
    SpecError
        If there is nothing but towing experiments.
    """
    campaign = Campaign.read(path)
    aside = [e.id for e in campaign.experiments if e.kind not in BENCH_KINDS]
    if len(aside) == len(campaign.experiments):
        raise SpecError(
            f"{path}: `helicable {verb}` takes the bench kinds only so far ({', '.join(BENCH_KINDS)}), and all "
            f"{len(aside)} experiments of this campaign are of the kind towing; add bench experiments of the same cable."
        )
    if not aside:
        return campaign, ()
    shown = ", ".join(aside[:5]) + (f" and {len(aside) - 5} more" if len(aside) > 5 else "")
    return campaign, (f"left aside, because only bench kinds are explained so far: {shown} (towing).",)


def bench_model(campaign: Campaign) -> BenchModel:
    """The linear model of the section that the campaign states, or of its cable."""
    return BenchModel(campaign_section(campaign))
