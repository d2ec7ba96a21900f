"""Small towing campaigns with a known truth: four conditions, each twice, 60 samples, one station inside the cable."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np

from compare import BenchModel, Campaign, NominalSection
from compare.towing_setup import TowingSetup
from effects.towed_cable import TowedCable

CONDITIONS = ((0.35, 0.0, 800.0), (0.35, 10.0, 800.0), (0.08, 10.0, 1600.0), (0.6, 0.0, 1600.0))
TOML = """title = "towed"
[towing]
friction_coefficient = 0.30
cable_length = "30 m"
mass_per_length = "4.6 kg/m"
EA = "4.0e5 N"
damping_ratio = 0.1
presliding = "0.3 mm"
[section]
EI = "95 N m^2"
"""
FRICTION, ELEMENTS = 0.35, 8


def motion(speed: float, duration: float = 6.0) -> tuple[np.ndarray, np.ndarray]:
    """Forth and half back, smooth, with rests; the travel grows with the speed."""
    t = np.linspace(0.0, duration, round(10 * duration))

    def eased(start: float, length: float) -> np.ndarray:
        s = np.clip((t - start) / length, 0.0, 1.0)
        return s**3 * (10 - 15 * s + 6 * s**2)

    unit = duration / 9.0
    return t, speed * 1.6 * unit * (eased(0.4 * unit, 3.0 * unit) - 0.6 * eased(4.6 * unit, 3.0 * unit))


def tow_campaign(
    folder: Path,
    act=lambda cable: cable,
    noise: float = 3.0,
    seed: int = 1,
    sensor=None,
    conditions=CONDITIONS,
    stations=(12.0,),
    duration=6.0,
) -> Path:
    """Write a campaign whose cable `act` changes (TowedCable to TowedCable) and whose readings `sensor` changes (t, y)."""
    folder.mkdir(parents=True, exist_ok=True)
    rng = np.random.default_rng(seed)
    rows = ["id,kind,file,specimen,repeat_of,set,speed [m/s],inclination [deg],tail tension [N]"]
    (folder / "campaign.toml").write_text(TOML)
    for i, (speed, slope, tail) in enumerate(conditions):
        t, p = motion(speed, duration)
        setup = TowingSetup(FRICTION, 30.0, 4e5, 4.6, tail, math.radians(slope), elements=ELEMENTS)
        chain = setup.chain(FRICTION, tail, math.radians(slope))
        readings = act(TowedCable(chain, t, p)).tensions(stations)
        if sensor is not None:
            readings = [sensor(t, y) for y in readings]
        for k in "ab":
            id = f"e{i}{k}"
            table = np.column_stack([t, p, *(y + noise * rng.standard_normal(len(t)) for y in readings)])
            np.savetxt(
                folder / f"{id}.csv", table, fmt="%.8g", delimiter=",", comments="",
                header=",".join(["time [s],position [m],tension [N]", *(f"tension at {s:g} [N]" for s in stations)]),
            )  # fmt: skip
            rows.append(f"{id},towing,{id}.csv,S,{f'e{i}a' if k == 'b' else ''},calibrate,{speed},{slope},{tail}")
    (folder / "experiments.csv").write_text("\n".join(rows) + "\n")
    return folder


def towing_model(campaign: Campaign) -> BenchModel:
    """The base model on the coarse chain on which the campaigns are made."""
    setup = TowingSetup.of(campaign)
    assert setup is not None
    return BenchModel(campaign.section or NominalSection({}), towing=replace(setup, elements=ELEMENTS))
