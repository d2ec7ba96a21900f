"""`helicable compare`: a campaign of measurements beside the linear model."""

from __future__ import annotations

from typing import Any

from compare import BenchModel, BenchSection, Campaign, plot_comparison
from compare import compare as compare_with
from compare.nominal_section import NominalSection
from compare.towing_setup import TowingSetup
from geometry import read_cable
from geometry.errors import ConvergenceError, SpecError
from helicable.carried_law import BendRadiusOption, CarryOption, carry_into, change_of_carrying
from helicable.options import CampaignArgument, JsonOption, OutOption
from helicable.rod_correction import FullRod, rod_correction, show_correction
from helicable.screen import folder, progress, say, sheet, table, write_json
from homogenize import homogenize_cable

_STIFFNESS = {"EA", "GA", "EI", "GJ"}


def compare(
    campaign: CampaignArgument,
    json: JsonOption = None,
    out: OutOption = None,
    full_rod: FullRod = False,
    carry: CarryOption = None,
    bend_radius: BendRadiusOption = None,
) -> None:
    """Compare measurements with the linear cable model, after calibrating its stiffness.

    Example: `helicable compare my-campaign --out report`
    """
    read = Campaign.read(campaign)
    plain = campaign_model(read)
    model = carry_into(plain, carry, bend_radius)
    with progress("comparing") as tell:
        comparison = compare_with(model, read, progress=tell)
    record = comparison.record()
    if carry is not None:
        with progress("comparing without what was carried"):
            record["carried"] = change_of_carrying(compare_with(plain, read), comparison)
    sheet(read.title, [("", comparison.headline()), ("", "")])
    rows = [
        (r["id"], r["kind"], r["channel"], r["set"], *(_short(r[k]) for k in ("rmse", "bias", "noise_floor", "excess")))
        for r in record["experiments"]
    ]
    show_carried(record)
    columns = ("id", "kind", "channel", "set", "rmse", "bias", "noise floor", "excess")
    table("Calibrated model against measurement (SI units)", columns, rows, right=(4, 5, 6, 7))
    calibrated = [(k, _short(v["value"]), _short(v["std"]), v["unit"]) for k, v in record["calibrated"].items()]
    table("Calibrated stiffness", ("", "value", "std", "unit"), calibrated, right=(1, 2))
    correction, said = rod_correction(comparison) if full_rod else (None, ())
    record["notes"] = [*said, *record["notes"]]
    sheet("Notes", [("-", note) for note in (*said, *comparison.notes)])
    if correction is not None:
        show_correction(correction)
        record["full_rod"] = correction.record()
    write_json(json, record)
    if out is not None:
        pictures = plot_comparison(comparison, folder(out))
        write_json(out / "comparison.json", record)
        say("written: " + ", ".join(str(p) for p in (*pictures, out / "comparison.json")))
    if not comparison.fits:
        raise ConvergenceError("no experiment of this campaign could be compared; see the notes above.")


def show_carried(record: dict[str, Any]) -> None:
    """What a carried law changes, if there is one."""
    if "carried" not in record:
        return
    rows = [(r["what"], _short(r["without"]), _short(r["with"]), r["unit"]) for r in record["carried"]["rows"]]
    table(
        f"The prediction without and with {record['carried']['title']}",
        ("", "without", "with", "unit"),
        rows,
        right=(1, 2),
    )


def campaign_model(campaign: Campaign) -> BenchModel:
    """The base model of every kind of experiment in the campaign: the section on the bench, the axial chain in the trough.

    A campaign of towing alone needs no section beside what [towing] says.
    """
    towed = any(e.kind == "towing" for e in campaign.experiments)
    on_bench = any(e.kind != "towing" for e in campaign.experiments)
    if towed and not on_bench and (campaign.cable is None or {"EA", "mass_per_length"} <= set(campaign.towing)):
        return BenchModel(campaign.section or NominalSection({}), towing=TowingSetup.of(campaign))
    section = campaign_section(campaign)
    mass = None
    if towed and campaign.cable is not None and "mass_per_length" not in campaign.towing:
        mass = equivalent_mass(campaign)
    stated = campaign.section is not None and "EA" in campaign.section.stated
    EA = section.EA_blocked_twist if towed and not stated and "EA" not in campaign.towing else None
    return BenchModel(section, towing=TowingSetup.of(campaign, EA, mass))


def equivalent_mass(campaign: Campaign) -> float:
    """Mass per length [kg/m] of the campaign's cable, from its materials."""
    assert campaign.cable is not None
    path = campaign.folder / campaign.cable
    return read_cable(path if path.is_file() else campaign.cable).mass_per_length


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
