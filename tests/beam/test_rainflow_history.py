"""Fatigue histories: the worked example of ASTM E1049-85, Miner's sum, and what a run's file, pictures and page are made of."""

from __future__ import annotations

import csv
import json
import re

import numpy as np
import pytest
import xarray as xr

from beam import read_scenario
from beam.fatigue_history import count_cycles, fatigue_history


def test_rainflow_counts_the_worked_example_of_the_standard():
    """ASTM E1049-85, figure 6: ranges 3, 4, 6, 8, 9 are counted 0.5, 1.5, 0.5, 1.0, 0.5 times."""
    cycles = count_cycles([-2, 1, -3, 5, -1, 3, -4, 4, -2])
    found = {float(size): float(cycles.count[cycles.range == size].sum()) for size in np.unique(cycles.range)}
    assert found == {3.0: 0.5, 4.0: 1.5, 6.0: 0.5, 8.0: 1.0, 9.0: 0.5}


def test_equivalent_range_adds_damages_after_miner():
    """Three equal full cycles of the range 2: (3 x 2^m)^(1/m); nothing is counted below the smallest range."""
    cycles = count_cycles([0, 2, 0, 2, 0, 2, 0])
    assert cycles.total == pytest.approx(3.0, rel=1e-12)
    assert cycles.equivalent_range(5.0) == pytest.approx((3 * 2.0**5) ** 0.2, rel=1e-12)
    assert count_cycles([0, 2, 0, 2, 0], smallest=2.0).equivalent_range(5.0) == 0.0


def made_run() -> xr.Dataset:
    """Three elements, four nodes, 9 instants: one bent to and fro, one pulled to and fro, one at rest; two links on it."""
    t = np.linspace(0.0, 2.0, 9)
    wave = np.abs(np.sin(np.pi * t / 2))  # 0 -> 1 -> 0
    strain, force = np.zeros((9, 3, 3, 6)), np.zeros((9, 3, 3, 6))
    strain[:, 0, :, 5] = 3.0 * wave[:, None]
    force[:, 1, :, 0] = 100.0 + 50.0 * wave[:, None]
    names = ["Gamma_1", "Gamma_2", "Gamma_3", "kappa_1", "kappa_2", "kappa_3"]
    position = np.zeros((9, 4, 3))
    position[:, :, 0] = np.linspace(-8.0, 0.0, 4) + 0.1 * t[:, None]
    clamp = np.zeros((9, 2, 3))
    clamp[:, :, 0] = (-4.0, -3.84)
    bushings = np.zeros((9, 6, 6))
    bushings[:, :, 0] = (5.0, 5.0, 15.0, 15.0, 25.0, 25.0)
    tension = np.zeros((9, 4, 3))
    tension[:, :, 0] = 40.0
    return xr.Dataset(
        {
            "gauss_strain": (("time", "element", "gauss", "strain"), strain),
            "gauss_force": (("time", "element", "gauss", "strain"), force),
            "bend_radius": ("time", 0.3 + 0 * t),
            "position": (("time", "node", "axis"), position),
            "force_local": (("time", "node", "section_axis"), tension),
            "pull_force": (("time", "axis"), np.tile([120.4, 0.0, 0.0], (9, 1))),
            "clamp_position": (("time", "clamp", "axis"), clamp),
            "clamp_rotation_vector": (("time", "clamp", "axis"), np.zeros((9, 2, 3))),
            "bushing_force": (("time", "bushing", "direction"), bushings),
        },
        {
            "time": t, "strain": names, "s_gauss": (("element", "gauss"), np.arange(9.0).reshape(3, 3)),
            "direction": list("xyzabc"), "node": np.arange(3, -1, -1), "clamp": [2, 1],
        },
        {"title": "made"},
    )  # fmt: skip


def test_history_of_a_run_finds_range_and_cycles_of_every_section(tmp_path):
    """One bend there and back is one cycle of the whole range, at the element that is bent and nowhere else."""
    history = fatigue_history(made_run())
    assert history.curvature_range == pytest.approx([3.0, 0.0, 0.0], abs=1e-12)
    assert history.tension_range == pytest.approx([0.0, 50.0, 0.0], abs=1e-12)
    assert [one.total for one in history.bending_cycles] == [1.0, 0.0, 0.0]
    assert history.tension_cycles[1].mean == pytest.approx([125.0, 125.0], rel=1e-12)
    sections, cycles = history.write(tmp_path, diameter=0.05)
    rows = list(csv.DictReader(sections.open()))
    assert float(rows[0]["strain range at the rim [1]"]) == pytest.approx(0.5 * 0.05 * 3.0, rel=1e-6)
    assert [row["quantity"] for row in csv.DictReader(cycles.open())] == ["curvature [1/m]"] * 2 + ["tension [N]"] * 2


def test_animation_and_page_show_the_run(tmp_path):
    """The GIF has the instants that were asked for; the page holds times, tensions and links and loads nothing from elsewhere."""
    from PIL import Image

    from beam.towing_animation import chain_tension, write_animation
    from beam.towing_page import write_page

    data, scenario = made_run(), read_scenario("intelligent-horizontal")
    assert chain_tension(data)[0].tolist() == [20.0, 40.0]  # mean of 10 and 30, of 30 and 50
    written = write_animation(data, scenario, tmp_path, frames=2)
    with Image.open(written[0]) as film:
        assert film.n_frames == 2  # type: ignore[attr-defined]
    text = write_page(data, scenario, tmp_path / "towing.html").read_text(encoding="utf-8")
    found = re.search(r"const D = (\{.*\});", text)
    assert found is not None
    shown = json.loads(found[1])
    assert shown["time"][-1] == 2.0 and shown["tension"][0] == [40] * 4 and shown["pull"][0] == 120
    assert shown["links"][0][1] == [[-3.92, 0.0], [-3.76, 0.0]] and shown["chain"][0] == [20, 40]
    assert "http" not in text and "src=" not in text
