"""The towing run from scenario to dataset, record, file and pictures."""

import json

import numpy as np
import pytest

from beam import accurate_settings, read_scenario, tow
from geometry.errors import InputError


@pytest.fixture(scope="module")
def run():
    scenario = read_scenario("intelligent-horizontal").changed(
        cable__elements=100, time__duration="3 s", drive__ramp_end="1.5 s"
    )
    told: list[float] = []
    result = tow(scenario, progress=lambda fraction, sentence: told.append(fraction))
    assert told[-1] == 1.0 and sorted(told) == told
    return result


def test_every_variable_has_unit_and_meaning(run):
    """units and long_name on everything but the axes' names."""
    data = run.dataset
    assert run.status == "completed"
    for name, variable in data.data_vars.items():
        assert variable.attrs["units"] and variable.attrs["long_name"], name
        if name not in (
            "contact_gap",
            "contact_slip",
            "surface_gap",
            "surface_slip",
        ):  # not a number where nothing touches
            assert np.isfinite(variable.values).all(), name
    assert data.sizes == {
        "time": 61, "node": 101, "axis": 3, "section_axis": 3, "source": 9, "element": 100, "gauss": 3, "strain": 6, "surface": 3,
    }  # fmt: skip
    np.testing.assert_allclose(data["time"].values, np.arange(61) * 0.05, rtol=0, atol=1e-12)


def test_nodes_are_counted_from_the_shearer(run):
    """Node 0 is pulled, the last one is held at the supply."""
    position = run.dataset["position"]
    ramp = run.scenario.pull(3.0)[0][0]
    start, end = position.sel(node=0).values[[0, -1]]
    assert end[0] - start[0] == pytest.approx(ramp, abs=1e-12)
    np.testing.assert_array_equal(position.sel(node=100).values, 0.0)
    assert run.node(220) == 55


def test_roller_runs_at_half_speed(run):
    """The bend travels half as far as the shearer: movable pulley."""
    left = run.dataset["position"].values[:, :, 0].min(axis=1)
    travelled = run.scenario.pull(3.0)[0][0]
    np.testing.assert_allclose(left[-1] - left[0], travelled / 2, rtol=0, atol=3e-3)


def test_local_and_global_forces_have_the_same_size(run):
    """A rotation of axes keeps lengths: at the straight ends N is the x component."""
    data = run.dataset
    pulled, held = data.sel(node=5), data.sel(node=95)
    np.testing.assert_allclose(pulled["force_global"][:, 0], pulled["force_local"][:, 0], rtol=1e-3)
    np.testing.assert_allclose(held["force_global"][:, 0], -held["force_local"][:, 0], rtol=1e-3)
    local = np.linalg.norm(data["force_local"].values, axis=2)
    turned = np.linalg.norm(data["force_global"].values, axis=2)
    np.testing.assert_allclose(turned, local, rtol=1e-12)


def test_pull_force_is_the_tension_at_the_shearer(run):
    """Reaction of the driven end = section force there, less half an element's weight and friction."""
    data = run.dataset
    tension = data["force_local"].sel(node=0).values[:, 0]
    np.testing.assert_allclose(data["pull_force"].values[:, 0], tension, rtol=0, atol=5.0)


def test_tension_grows_by_friction_over_the_upper_strand(run):
    """Steady pull: between nodes 10 and 30, d N/ds = mu w; 2 %."""
    data = run.dataset.isel(time=-1)
    slope = (data["force_local"].sel(node=10)[0] - data["force_local"].sel(node=30)[0]) / (20 * 0.16)
    np.testing.assert_allclose(float(slope), 0.3 * run.mass_per_length * 9.81, rtol=2e-2)


def test_contact_carries_the_weight(run):
    """At the end of the run the vertical contact forces balance the weight, up to what the supports carry."""
    data = run.dataset.isel(time=-1)
    weight = run.mass_per_length * 9.81 * 16.0
    supports = float(data["pull_force"][1] + data["supply_reaction"][1])
    assert float(data["contact_force"].values[:, 1].sum()) + supports == pytest.approx(weight, rel=2e-3)


def test_upper_strand_slips_and_lower_strand_sticks(run):
    """|t| = mu f_n on the deck behind the shearer; below it in the trough near the supply, which does not move."""
    use = run.dataset["friction_use"].isel(time=-1)
    np.testing.assert_allclose(use.sel(surface="deck").values[80:98], 1.0, rtol=1e-9)
    assert use.sel(surface="trough").values[5:20].max() < 0.99


def test_energy_is_closed(run):
    """The balance closes to 1e-5 of the throughput."""
    assert abs(run.balance_error) < 1e-5


def test_energy_is_closed_to_a_millionth_of_the_work_done(run):
    """At every instant, with the accurate settings: what `helicable tow --accurate` does."""
    fine = tow(run.scenario, settings=accurate_settings(run.scenario)).dataset
    work = float(fine["energy"].sel(source="drive_work")[-1])
    assert work > 10
    assert np.abs(fine["energy_error"].values).max() < 1e-6 * work


def test_record_has_the_agreed_keys(run):
    """Keys fixed for machines; finite numbers, null only with a reason."""
    record = json.loads(json.dumps(run.record(), allow_nan=False))
    assert set(record) >= {
        "schema", "scenario", "status", "seconds_simulated", "seconds_wall", "elements", "peak_tension",
        "energy_balance_error", "nodes", "bushing_3_amplitude", "contact_35", "lateral_displacement_max", "published", "notes",
    }  # fmt: skip
    assert set(record["nodes"]) == {"54", "199", "220", "370"}
    for values in record["nodes"].values():
        assert set(values) >= {"Fx_plateau", "Fx_max", "Fy_max"}
    for key, value in record.items():
        assert value is not None or any(key in note for note in record["notes"]), key
    assert record["published"]["node_54_Fx_plateau"] == 1300.0
    assert record["nodes"]["54"]["Fx_plateau"] > 0 > record["nodes"]["370"]["Fx_plateau"]


def test_netcdf_is_read_back(run, tmp_path):
    """The file holds the same numbers."""
    xarray = pytest.importorskip("xarray")
    path = run.write(tmp_path / "run.nc")
    with xarray.open_dataset(path) as data:
        np.testing.assert_array_equal(data["pull_force"].values, run.dataset["pull_force"].values)
        assert data["pull_force"].attrs["units"] == "N"
        assert data.attrs["scenario"] == "intelligent-horizontal"


def test_file_that_cannot_be_written(run, tmp_path):
    """A missing folder is a sentence."""
    with pytest.raises(InputError, match="cannot be written there"):
        run.write(tmp_path / "missing" / "run.nc")


def test_pictures_show_what_they_claim(run):
    """Tension as colour at every time; published numbers marked as published."""
    from beam.towing_plot import cable_figure, energy_figure, node_force_figure, pull_force_figure

    figure = cable_figure(run)
    panels = [ax for ax in figure.axes if ax.collections and ax.get_ylabel() == "y [m]"]
    assert len(panels) == 4
    texts = [text.get_text() for ax in pull_force_figure(run).axes for text in ax.texts]
    assert any(text.startswith("published") and "1300 N" in text for text in texts)
    assert len(node_force_figure(run).axes) == 2
    assert "energy balance" in energy_figure(run).axes[0].get_title()
