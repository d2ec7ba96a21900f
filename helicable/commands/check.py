"""`helicable check`: is the data readable, what was recorded, how noisy is it, and what can it show?"""

from __future__ import annotations

from typing import Any

from compare.findings import Check
from compare.findings_record import check_record
from helicable.bench_campaign import bench_model, read_bench_campaign
from helicable.campaign_tables import (
    CONFUSED,
    NOISE_COLUMNS,
    TESTABLE_COLUMNS,
    condition_rows,
    confused_rows,
    kind_rows,
    noise_cells,
    testable_rows,
)
from helicable.explain_screen import untestable_sentences
from helicable.options import CampaignArgument, JsonOption
from helicable.screen import progress, sheet, table, write_json


def check(campaign: CampaignArgument, json: JsonOption = None) -> None:
    """Check a campaign before any verdict: readable, what was recorded, the noise, and which effects it can show.

    Example: `helicable check my-campaign`
    """
    read, notes = read_bench_campaign(campaign, "check")
    from compare.testability import check as check_campaign

    with progress("checking") as tell:
        found = check_campaign(bench_model(read), read, progress=tell)
    record = check_record(found)
    record["notes"] = [*notes, *record["notes"]]
    show_check(found, record)
    write_json(json, record)


def show_check(found: Check, record: dict[str, Any]) -> None:
    """Print what was recorded, the noise, and what can be tested."""
    rows = record["experiments"]
    sheet(record["campaign"], [("readable", f"{len(rows)} experiments, every file, row and column was understood.")])
    columns = ("kind", "experiments", "repeats", "sets", "path", "largest", "measured")
    table("What was recorded (SI units)", columns, kind_rows(rows), right=(1, 2, 5))
    spans = condition_rows(rows)
    table("Conditions (SI units)", ("kind", "condition", "from", "to", "values"), spans, right=(2, 3, 4))
    title = "Noise: sample, correlation, white part, scatter of gain and offset"
    table(title, NOISE_COLUMNS, noise_cells(record["noise"]), right=(2, 3, 4, 5, 6))
    table(
        "What these experiments can show",
        TESTABLE_COLUMNS,
        testable_rows(found.separation, found.smallest_seen),
        right=(1,),
    )
    confused = confused_rows(found.separation)
    title = f"Pairs that may be taken for each other in more than {100 * CONFUSED:.0f} %"
    table(title, ("effect", "taken for", "chance"), confused, right=(2,)) if confused else None
    sentences = [("not testable", s) for s in untestable_sentences(found.untestable)]
    sentences += [("confounded", s) for s in found.separation.confounded]
    sentences += [("note", s) for s in record["notes"]]
    sheet("Mind", sentences or [("", "nothing: every effect can be tested, no covariates vary together.")])
