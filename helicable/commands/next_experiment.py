"""`helicable next`: the experiment that would best separate the effects that these data cannot tell apart."""

from __future__ import annotations

from helicable.bench_campaign import bench_model, read_bench_campaign
from helicable.explain_screen import show_next
from helicable.options import CampaignArgument, JsonOption
from helicable.screen import progress, write_json


def next_experiment(campaign: CampaignArgument, json: JsonOption = None) -> None:
    """Suggest the experiment that separates the rivals, with the probability of being wrong before and after it.

    Example: `helicable next my-campaign`
    """
    read, notes = read_bench_campaign(campaign, "next")
    from compare.explain import explain as explain_campaign

    with progress("explaining") as tell:
        findings = explain_campaign(bench_model(read), read, progress=tell, library=None)
    show_next(findings.next_experiment, findings)
    record = findings.record()
    keys = ("schema", "campaign", "verdict", "effects", "confusable", "closest", "next_experiment")
    write_json(json, {**{key: record[key] for key in keys}, "notes": [*notes, *record["notes"]]})
