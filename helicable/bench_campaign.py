"""A campaign folder as the verbs check, explain, add and next take it, and the model of its cable on the bench and in the trough."""

from __future__ import annotations

from pathlib import Path

from compare import BenchModel, Campaign
from helicable.commands.compare import campaign_model


def read_bench_campaign(path: Path, verb: str) -> tuple[Campaign, tuple[str, ...]]:
    """The campaign, and notes on what this verb leaves aside: nothing any more."""
    return Campaign.read(path), ()


def bench_model(campaign: Campaign) -> BenchModel:
    """The base model of the section that the campaign states, or of its cable."""
    return campaign_model(campaign)
