"""`helicable compare`: a campaign of measurements beside the linear model."""

from __future__ import annotations

from compare import BenchModel, BenchSection, Campaign, plot_comparison
from compare import compare as compare_with
from geometry import read_cable
from geometry.errors import ConvergenceError, SpecError
from helicable.options import CampaignArgument, JsonOption, OutOption
from helicable.screen import folder, progress, say, sheet, table, write_json
from homogenize import homogenize_cable

_STIFFNESS = {"EA", "GA", "EI", "GJ"}


def compare(
    campaign: CampaignArgument,
    json: JsonOption = None,
    out: OutOption = None,
) -> None:
    """Compare measurements with the linear cable model, after calibrating its stiffness.

    Example: `helicable compare my-campaign --out report`
    """
    read = Campaign.read(campaign)
    section = campaign_section(read)
    with progress("comparing") as tell:
        comparison = compare_with(BenchModel(section), read, progress=tell)
    record = comparison.record()
    sheet(read.title, [("", comparison.headline()), ("", "")])
    rows = [
        (r["id"], r["kind"], r["channel"], r["set"], *(_short(r[k]) for k in ("rmse", "bias", "noise_floor", "excess")))
        for r in record["experiments"]
    ]
    columns = ("id", "kind", "channel", "set", "rmse", "bias", "noise floor", "excess")
    table("Calibrated model against measurement (SI units)", columns, rows, right=(4, 5, 6, 7))
    calibrated = [(k, _short(v["value"]), _short(v["std"]), v["unit"]) for k, v in record["calibrated"].items()]
    table("Calibrated stiffness", ("", "value", "std", "unit"), calibrated, right=(1, 2))
    sheet("Notes", [("-", note) for note in comparison.notes])
    write_json(json, record)
    if out is not None:
        pictures = plot_comparison(comparison, folder(out))
        write_json(out / "comparison.json", record)
        say("written: " + ", ".join(str(p) for p in (*pictures, out / "comparison.json")))
    if not comparison.fits:
        raise ConvergenceError("no experiment of this campaign could be compared; see the notes above.")


def campaign_section(campaign: Campaign) -> BenchSection:
    """The section that the campaign states; where it names a cable, that is homogenized and answers for the rest.

    A section that states every stiffness needs the cable only for the coupling, where the other load was recorded too.
    """
    if campaign.cable is None:
        if campaign.section is None:
            raise SpecError("campaign.toml names neither a cable nor a [section]; add one of them.")
        return campaign.section
    if campaign.section is not None and _STIFFNESS <= set(campaign.section.stated) and not _other_load(campaign):
        return campaign.section
    path = campaign.folder / campaign.cable
    with progress("homogenizing") as tell:
        base = homogenize_cable(read_cable(path if path.is_file() else campaign.cable), progress=tell).section
    return base if campaign.section is None else campaign.section.completed_by(base)


def _other_load(campaign: Campaign) -> bool:
    """Whether a torque was recorded in tension, or a force in torsion."""
    beside = {("tension", "torque"), ("torsion", "force")}
    return any((e.kind, c) in beside for e in campaign.readable for c in e.record.measured)


def _short(value: float | None) -> str:
    return "-" if value is None else f"{value:.4g}"
