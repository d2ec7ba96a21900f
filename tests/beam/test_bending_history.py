"""Bending history of the sections: counted against a bend that travels as prescribed, and on the bending machine."""

import csv

import numpy as np
import pytest

from beam import read_scenario, tow
from beam.bending_history import BendingHistory, bending_history, count_bends


def test_a_bend_that_goes_to_and_fro_is_counted_as_often_as_it_passes():
    """kappa = 1/R where the bend is, two cycles: twice a cycle where it passes both ways, once where it turns back, else never."""
    t = np.linspace(0, 4, 401)
    place = np.abs((t + 1) % 2 - 1)  # 0 to 1 m and back, twice
    s = np.array([-0.5, 0.15, 0.5, 0.85, 1.6])
    size = np.where(np.abs(s[None, :] - place[:, None]) < 0.4, 3.0, 0.0)
    bends = [count_bends(one, 3.0) for one in size.T]
    assert bends == [0, 2, 4, 2, 0]


def test_strain_range_at_the_rim_is_half_the_diameter_times_the_range_of_curvature(tmp_path):
    """From +1/R to -1/R: the range is 2/R, the strain d/R."""
    history = BendingHistory(np.arange(3.0), np.array([0.1]), np.array([[2.0], [0.0], [-2.0]]), np.array([1]))
    with history.write(tmp_path / "bending.csv", 0.05).open(encoding="utf-8") as file:
        row = next(iter(csv.DictReader(file)))
    assert float(row["curvature range [1/m]"]) == pytest.approx(4.0)
    assert float(row["strain range at the rim [1]"]) == pytest.approx(0.1)


@pytest.fixture(scope="module")
def machine():
    """One stroke of 0.6 m to and fro, clamps as mass."""
    scenario = read_scenario("bending-machine").changed(
        chain="smeared", cable__length="4 m", cable__elements=40, layout__upper_strand="1.2 m", machine__stroke="0.6 m",
        machine__pause="0.1 s", time__duration="3.6 s", machine__tension="600 N", drive__ramp_end="0.8 s",
        published_constants__E="14.2 MPa",  # limp, so that the capstan holds
    )  # fmt: skip
    return tow(scenario)


def test_the_machine_bends_the_sections_that_its_stroke_takes_over_the_arch(machine):
    """Sections of the lower strand within a stroke of the arch are bent once to and fro; those beyond it never."""
    assert machine.status == "completed"
    history, lower = bending_history(machine.dataset), machine.scenario.lower_strand
    entered = (history.s > lower - 0.35) & (history.s < lower - 0.15)
    assert (history.bends[entered] == 1).all()
    assert (history.bends[history.s < lower - 0.9] == 0).all()
    assert machine.record()["bending"]["bends_max"] == 1


def test_the_arch_holds_back_as_a_capstan(machine):
    """exp(mu pi) for a limp cable; its stiffness presses it onto the ends of the arch with Q = sqrt(EI T) / R, which adds mu Q."""
    data, scenario = machine.dataset, machine.scenario
    mu, R = scenario.machine.arch_friction.value, scenario.layout.bend_radius.value
    EI = machine.section.C[3, 3]
    at = {t: data["force_local"].values[int(np.argmin(np.abs(data["time"].values - t))), :, 0] for t in (1.3, 2.9)}
    before, behind = at[1.3][int((scenario.lower_strand - 0.1) / 0.1)], at[1.3][-3]
    stiff = mu * np.sqrt(EI * np.array([before, behind])) / R
    growth = np.exp(mu * np.pi)
    assert growth * before < behind < 1.05 * (growth * (before + stiff[0]) + stiff[1])
    assert at[2.9][-3] < before / growth * 1.05  # on the way back the arch holds back the other way


def test_the_plate_goes_to_and_fro(machine):
    """The plate's end is back where it began; the other end gives the same way, pulled by its constant tension."""
    x = machine.dataset["position"].values[:, [0, -1], 0]
    assert x[:, 1].max() - x[0, 1] == pytest.approx(0.6, abs=1e-9)
    assert x[-1, 1] == pytest.approx(x[0, 1], abs=1e-9)
    k = int(np.argmax(x[:, 1]))
    stretch = 0.1 * machine.dataset["gauss_strain"].sel(strain="Gamma_1").mean("gauss").sum("element").values
    given = (x[k, 0] - x[0, 0]) + (x[k, 1] - x[0, 1])
    assert given == pytest.approx(stretch[k] - stretch[0], abs=5e-3)  # the bend does not keep its shape exactly
    reaction = machine.dataset["supply_reaction"].values[:, 0]
    np.testing.assert_array_equal(reaction, 0.0)
