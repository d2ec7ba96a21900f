"""A sweep: every combination once, failures kept as rows, nothing computed twice, the same rows wherever they were computed."""

import csv
import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import beam.worker_pool as pool
from beam import read_scenario, tow
from beam.parameter_sweep import grid, sweep
from beam.sweep_axis import read_axes, read_axis
from beam.worker_pool import finished
from geometry.errors import InputError, SpecError
from homogenize.section_stiffness import SectionStiffness

SHORT = {
    "cable__length": "4 m", "cable__elements": 24, "layout__upper_strand": "1.4 m", "layout__slack": "20 mm",
    "time__duration": "0.2 s", "time__frame": "20 ms", "drive__ramp_start": "0 s", "drive__ramp_end": "0.15 s",
}  # fmt: skip
OVER = ["inclination=0, 20 deg", "duration=0.2 s, 300 s"]
ROOT = Path(__file__).resolve().parents[2]
SOFT = SectionStiffness.uncoupled(EA=2e5, GA_x=8e4, GA_y=8e4, EI_x=40.0, EI_y=40.0, GJ=30.0, area=2e-3)


@pytest.fixture(scope="module")
def scenario():
    return read_scenario("intelligent-horizontal").changed(**SHORT)


@pytest.fixture(scope="module")
def done(scenario, tmp_path_factory):
    """Two inclinations, and two durations of which one cannot be: two runs, two failures."""
    told = []
    axes = read_axes(OVER, scenario)
    folder = sweep(scenario, axes, tmp_path_factory.mktemp("sweep"), progress=lambda f, s: told.append((f, s)))
    assert [round(4 * f) for f, _ in told] == [0, 1, 2, 3, 4]
    return folder


BAD_AXES = [
    ("friction", 'write NAME=VALUES'),
    ("friction=", 'write NAME=VALUES'),
    ("inclinaton=0,10 deg", "did you mean inclination.*What can be swept: constants, E,"),
    ("inclination=0,10", "has no unit; write it behind the last value"),
    ("inclination=0,10 kg", "cannot be read in|not known"),
    ("inclination=0,80 deg", "80 deg is outside what can be computed"),
    ("inclination=0,zero deg", "not a quantity"),
    ("friction=0.2,,0.3", "a value is missing"),
    ("speed=6 m/min, 0.1 m/s", '"0.1 m/s" stands there twice'),
    ("constants=cell,cell", '"cell" stands there twice'),
    ("node_54_Fx_plateau=1 N", "cannot be swept"),
]  # fmt: skip


@pytest.mark.parametrize(("text", "words"), BAD_AXES, ids=[text for text, _ in BAD_AXES])
def test_bad_axes_are_sentences(scenario, text, words):
    """Names, values and units; what can be swept is listed."""
    with pytest.raises(SpecError, match=words):
        read_axis(text, scenario)


def test_axes_that_cannot_be_together(scenario, tmp_path):
    """The same name twice; no axis; a grid too large."""
    with pytest.raises(SpecError, match="friction is swept twice"):
        read_axes(["friction=0.2", "contact.friction=0.3"], scenario)
    with pytest.raises(SpecError, match="needs one axis"):
        sweep(scenario, [], tmp_path)
    many = ",".join(f"{0.1 + 1e-3 * k:.3f}" for k in range(400))
    with pytest.raises(SpecError, match="at most 100000 runs"):
        grid(
            scenario,
            read_axes([f"friction={many}", "speed=" + ",".join(map(str, range(1, 300))) + " m/min"], scenario),
            {},
        )


def test_a_unit_counts_for_all_values_before_it(scenario):
    """Own units stay; numbers are shown in the unit of the last."""
    axis = read_axis("slack=0.01 m, 20, 30 mm", scenario)
    assert (axis.key, axis.unit, axis.numbers) == ("layout.slack", "mm", (10.0, 20.0, 30.0))
    assert axis.texts == ("0.01 m", "20 mm", "30 mm")


def test_every_combination_has_its_own_name(scenario):
    """Full grid, last axis fastest; ids differ in values and in the section, and follow from nothing else."""
    axes = read_axes(["friction=0.2,0.3,0.4", "constants=published,soft"], scenario)
    points = grid(scenario, axes, {"soft": SOFT})
    assert [p.place for p in points] == [(i, j) for i in range(3) for j in range(2)]
    assert len({p.id for p in points}) == 6
    assert [p.id for p in grid(scenario, axes, {"soft": SOFT})] == [p.id for p in points]
    other = SectionStiffness(1.01 * SOFT.C, SOFT.area)
    changed = [a.id != b.id for a, b in zip(points, grid(scenario, axes, {"soft": other}))]
    assert changed == [False, True] * 3
    assert not {p.id for p in points} & {
        p.id for p in grid(scenario.changed(drive__speed="5 m/min"), axes, {"soft": SOFT})
    }


def test_a_row_is_the_run(scenario, done):
    """The numbers of the table are those of the same run on its own; a failed one has its sentence and no numbers."""
    run = tow(scenario.changed(layout__inclination="20 deg", time__duration="0.2 s")).record()
    row = done.dataset.sel(inclination=20.0, duration=0.2)
    for name in ("pull_force_max", "pull_force_plateau", "bend_radius_min", "energy_balance_error"):
        assert float(row[name]) == run[name]
    assert float(row["drive_work"]) == run["energies"]["drive_work"]
    failed = done.dataset.sel(inclination=20.0, duration=300.0)
    assert np.isnan(failed["pull_force_max"]) and "the stroke of" in str(failed["status"].values)
    assert done.counts() == (2, 2, 0)


def test_tables_and_picture(done):
    """CSV and NetCDF hold the grid with the swept axes as dimensions; the picture counts the runs."""
    from beam.sweep_plot import sweep_figure

    table, file = done.write_tables()
    rows = list(csv.DictReader(table.open(encoding="utf-8")))
    assert len(rows) == 4 and rows[2]["inclination [deg]"] == "20.0" and rows[1]["pull_force_max [N]"] == ""
    with xr.open_dataset(file, decode_timedelta=False) as data:
        assert dict(data.sizes) == {"inclination": 2, "duration": 2}
        np.testing.assert_array_equal(data["pull_force_max"].values, done.dataset["pull_force_max"].values)
        assert data["inclination"].attrs["units"] == "deg" and data["status"].values[0, 0] == "completed"
        assert float(rows[2]["pull_force_max [N]"]) == pytest.approx(float(data["pull_force_max"][1, 0]), rel=1e-8)
    figure = sweep_figure(done)
    assert "2 runs completed, 2 failed" in figure.get_suptitle()
    drawn = figure.axes[0].lines[0]
    np.testing.assert_array_equal(drawn.get_ydata(), data["pull_force_plateau"].values[:, 0])


def test_many_values_make_a_map(scenario, done, monkeypatch):
    """A colour axis with more than seven numbers becomes the vertical axis of a map."""
    from beam.sweep_plot import sweep_figure

    monkeypatch.setattr("beam.sweep_plot.MANY", 1)
    figure = sweep_figure(done)
    assert figure.axes[0].get_ylabel() == "duration [s]" and figure.axes[0].collections


def test_nothing_is_computed_twice(scenario, done, monkeypatch):
    """The same sweep again finds all its rows; one that was deleted is made again, alone; a damaged one is a sentence."""
    import beam.parameter_sweep as module

    asked = []
    real = module.run_point
    monkeypatch.setattr(module, "run_point", lambda *task: asked.append(task[1].id) or real(*task))
    sweep(scenario, done.axes, done.path)
    assert asked == []
    _, id = done.places[2]
    file = done.path / "runs" / f"{id}.json"
    file.write_text("{")
    with pytest.raises(InputError, match="delete it and repeat the command"):
        done.rows()
    file.unlink()
    sweep(scenario, done.axes, done.path)
    assert asked == [id]


def test_a_folder_of_another_sweep_is_refused(scenario, done, tmp_path):
    """Other values, another scenario, other files: what differs is named."""
    with pytest.raises(
        InputError, match=r"another sweep \(layout.inclination: there 0 deg, 20 deg, here 0 deg, 30 deg\)"
    ):
        sweep(scenario, read_axes(["inclination=0,30 deg", OVER[1]], scenario), done.path)
    with pytest.raises(InputError, match=r"another sweep .drive.speed"):
        sweep(scenario.changed(drive__speed="5 m/min"), done.axes, done.path)
    (tmp_path / "thesis.txt").write_text("")
    with pytest.raises(InputError, match="holds other files"):
        sweep(scenario, done.axes, tmp_path)


def test_an_unexpected_error_is_a_row(scenario, tmp_path, monkeypatch):
    """A fault of the program in one run does not end the others."""
    monkeypatch.setattr("beam.parameter_sweep.published_section", lambda s: 1 / 0)
    folder = sweep(scenario, read_axes(["friction=0.2,0.3"], scenario), tmp_path)
    assert folder.counts() == (0, 2, 0)
    assert "failed unexpectedly: ZeroDivisionError" in str(folder.dataset["status"].values[0])


def test_an_unreachable_scheduler_is_a_sentence(scenario, tmp_path, monkeypatch):
    """Nobody listens; the address is no address; no workers."""
    monkeypatch.setattr(pool, "CONNECT_SECONDS", 0.5)
    for address in ("tcp://127.0.0.1:9", "nowhere"):
        with pytest.raises(InputError, match=rf"scheduler {address} cannot be reached"):
            sweep(scenario, read_axes(["friction=0.2"], scenario), tmp_path / "a", scheduler=address)
    with pytest.raises(InputError, match="0 workers"):
        sweep(scenario, read_axes(["friction=0.2"], scenario), tmp_path / "b", workers=0)


def test_a_scheduler_without_workers_is_a_sentence(scenario, tmp_path, monkeypatch):
    """It is reached, but nobody works there: the sweep ends instead of waiting for ever."""
    distributed = pytest.importorskip("distributed")
    monkeypatch.setattr(pool, "WORKER_SECONDS", 0.3)
    settings = {"processes": False, "dashboard_address": None, "host": "tcp://127.0.0.1", "silence_logs": 50}
    with (
        distributed.LocalCluster(n_workers=0, **settings) as cluster,
        pytest.raises(InputError, match="has had no workers or was out of reach"),
    ):
        sweep(scenario, read_axes(["friction=0.2"], scenario), tmp_path, scheduler=cluster.scheduler_address)


def test_a_scheduler_gives_the_same_rows(scenario, done, tmp_path):
    """The address of a running scheduler instead of this process: equal numbers, failures included, full runs as files."""
    distributed = pytest.importorskip("distributed")
    settings = {"processes": True, "dashboard_address": None, "host": "tcp://127.0.0.1", "silence_logs": 50}
    with distributed.LocalCluster(n_workers=1, threads_per_worker=1, **settings) as cluster:
        folder = sweep(scenario, done.axes, tmp_path, scheduler=cluster.scheduler_address, full=True)
    for name in ("pull_force_max", "elastic", "bend_radius_min", "status", "run"):
        np.testing.assert_array_equal(folder.dataset[name].values, done.dataset[name].values, err_msg=name)
    with xr.open_dataset(folder.run_file(folder.places[0][1])) as data:
        assert float(np.abs(data["pull_force"][:, 0]).max()) == float(folder.dataset["pull_force_max"][0, 0])


def test_processes_work_and_a_broken_task_is_its_own():
    """Two processes: results by task, an exception as a value, the others untouched."""
    tasks = [(2, 3), (0, -1), (5, 2)]
    found = dict(finished(pow, tasks, workers=2))
    assert (found[0], found[2]) == (8, 25) and isinstance(found[1], ZeroDivisionError)


def test_a_killed_sweep_goes_on(scenario, done, tmp_path):
    """Kill -9 after the first row: it stays as it is, the rest is computed, the table is that of a sweep never killed."""
    code = (
        "import sys, time; from beam import read_scenario; from beam.parameter_sweep import sweep; from beam.sweep_axis import read_axes\n"
        f"s = read_scenario('intelligent-horizontal').changed(**{SHORT!r})\n"
        f"sweep(s, read_axes({OVER!r}, s), sys.argv[1], progress=lambda f, _: time.sleep(60 if f else 0))"
    )
    child = subprocess.Popen(
        [sys.executable, "-c", code, str(tmp_path)], cwd=ROOT, env={**os.environ, "PYTHONPATH": str(ROOT)}
    )
    try:
        while not list((tmp_path / "runs").glob("*.json")):
            assert child.poll() is None, "the sweep ended before it was killed"
            time.sleep(0.05)
    finally:
        child.send_signal(signal.SIGKILL)
        child.wait()
    (first,) = (tmp_path / "runs").glob("*.json")
    stamp, wall = first.stat().st_mtime_ns, json.loads(first.read_text())["results"]["seconds_wall"]
    folder = sweep(scenario, done.axes, tmp_path)
    assert first.stat().st_mtime_ns == stamp and folder.counts() == (2, 2, 0)
    assert float(folder.dataset["seconds_wall"][0, 0]) == wall
    for name in ("pull_force_max", "drive_work", "status", "run"):
        np.testing.assert_array_equal(folder.dataset[name].values, done.dataset[name].values, err_msg=name)
