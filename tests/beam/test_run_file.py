"""A run grows in its file: a file torn at any byte is readable, a killed run goes on bit by bit, memory stays bounded."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from beam import accurate_settings, read_scenario, tow
from beam.record_file import RecordFile
from geometry.errors import InputError

SHORT = {
    "cable__length": "4 m", "cable__elements": 24, "layout__upper_strand": "1.4 m", "layout__slack": "20 mm",
    "time__duration": "0.4 s", "time__frame": "10 ms", "drive__ramp_start": "0 s", "drive__ramp_end": "0.3 s",
}  # fmt: skip
ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def scenario():
    return read_scenario("intelligent-horizontal").changed(**SHORT)


@pytest.fixture(scope="module")
def whole(scenario, tmp_path_factory):
    """A run that was written while it ran, never interrupted."""
    return tow(scenario, file=tmp_path_factory.mktemp("whole") / "run.nc")


def small():
    data = {"x": (("time", "node"), np.zeros((0, 3)), {"units": "m"}), "e": (("time",), np.zeros(0))}
    coords = {"time": ("time", np.zeros(0)), "node": ("node", [2, 1, 0]), "axis": ("axis", ["a", "b"])}
    return xr.Dataset(data, coords, {"status": "open  "})


def test_a_file_torn_at_any_byte_ends_with_a_whole_record(tmp_path):
    """Cut the bytes of the record that is being written, at every place, before it is counted."""
    file = RecordFile.create(tmp_path / "a.nc", small())
    for k in range(3):
        file.append({"x": [k, k + 0.5, -k], "e": 10.0 * k, "time": 0.1 * k})
    head = (tmp_path / "a.nc").read_bytes()
    for extra in (0, 1, 7, 39):
        (tmp_path / "torn.nc").write_bytes(head + b"\x55" * extra)
        with xr.open_dataset(tmp_path / "torn.nc") as data:
            np.testing.assert_array_equal(data["x"].values[:, 1], [0.5, 1.5, 2.5])
            np.testing.assert_array_equal(data["e"].values, [0.0, 10.0, 20.0])
            assert list(data["axis"].values) == ["a", "b"] and data["x"].attrs["units"] == "m"


def test_reopening_drops_what_came_later(tmp_path):
    """Go on after the second of three records; the status is replaced in place."""
    file = RecordFile.create(tmp_path / "a.nc", small())
    for k in range(3):
        file.append({"x": [k, k, k], "e": k, "time": k})
    again = RecordFile.reopen(tmp_path / "a.nc", small(), 2)
    again.append({"x": [9, 9, 9], "e": 9, "time": 9})
    again.restate(small().assign_attrs(status="closed"))
    with xr.open_dataset(tmp_path / "a.nc") as data:
        np.testing.assert_array_equal(data["e"].values, [0, 1, 9])
        assert data.attrs["status"] == "closed"
    with pytest.raises(InputError, match="holds 3 instants of the run; 7 are needed"):
        RecordFile.reopen(tmp_path / "a.nc", small(), 7)
    (tmp_path / "no.nc").write_text("no")
    with pytest.raises(InputError, match="is not the file of a run"):
        RecordFile.reopen(tmp_path / "no.nc", small(), 0)
    with pytest.raises(InputError, match="cannot be written"):
        RecordFile.create(tmp_path / "missing" / "a.nc", small())


def test_the_file_holds_the_run_and_memory_nothing(scenario, whole):
    """Same numbers as a run in memory, and no row is kept; no checkpoint is left."""
    kept = tow(scenario)
    assert whole.frames.rows == [] and len(kept.frames.rows) == 41
    with xr.open_dataset(whole.frames.file.path) as data:
        for name in kept.dataset.data_vars:
            np.testing.assert_array_equal(data[name].values, kept.dataset[name].values, err_msg=str(name))
        assert data.attrs["status"].rstrip() == "completed"
        assert data.attrs["energy_balance_error"] == kept.balance_error
    assert [p.name for p in whole.frames.file.path.parent.iterdir()] == ["run.nc"]


def test_a_killed_run_is_readable_and_goes_on_bit_by_bit(scenario, whole, tmp_path):
    """Kill -9 in the middle: the instants so far are there; resumed, the file has the same bytes as one never stopped."""
    path = tmp_path / "run.nc"
    code = (
        "import sys, time; from beam import read_scenario, tow; s = read_scenario('intelligent-horizontal').changed("
        f"**{SHORT!r}); tow(s, file=sys.argv[1], checkpoint_every=0.0, progress=lambda f, _: time.sleep(0.05 if f else 0))"
    )
    child = subprocess.Popen(
        [sys.executable, "-c", code, str(path)], cwd=ROOT, env={**os.environ, "PYTHONPATH": str(ROOT)}
    )
    try:
        while not (path.is_file() and int.from_bytes(path.read_bytes()[4:8], "big") > 8):
            assert child.poll() is None, "the run ended before it was killed"
            time.sleep(0.02)
    finally:
        child.send_signal(signal.SIGKILL)
        child.wait()
    with xr.open_dataset(path) as data:
        there = data.sizes["time"]
        assert 8 < there < 41
        np.testing.assert_array_equal(data["position"].values, whole.dataset["position"].values[:there])
        assert data.attrs["status"].startswith("not finished")
    run = tow(scenario, file=path, resume=True)
    assert run.outcome.completed
    assert path.read_bytes() == whole.frames.file.path.read_bytes()


def test_nothing_to_resume_is_a_sentence(scenario, whole, tmp_path):
    """No file, no run in it, a complete run, a run of something else or with other steps."""
    path = whole.frames.file.path
    with pytest.raises(InputError, match="there is no run in"):
        tow(scenario, file=tmp_path / "none.nc", resume=True)
    with pytest.raises(InputError, match="in which file"):
        tow(scenario, resume=True)
    with pytest.raises(InputError, match="this run is complete"):
        tow(scenario, file=path, resume=True)
    (tmp_path / "x.nc").write_text("x")
    with pytest.raises(InputError, match="not the file of a run"):
        tow(scenario, file=tmp_path / "x.nc", resume=True)

    def stop(fraction, sentence):
        if fraction > 0.2:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        tow(scenario, file=tmp_path / "run.nc", progress=stop)
    with pytest.raises(InputError, match=r"drive.speed = 6.86 m/min \(published\), not 9 m/min"):
        tow(scenario.changed(drive__speed="9 m/min"), file=tmp_path / "run.nc", resume=True)
    with pytest.raises(
        InputError, match=r"other step settings \(largest_step 0.005, not 0.0025; relative 1e-06, not 1e-08"
    ):
        tow(scenario, settings=accurate_settings(scenario), file=tmp_path / "run.nc", resume=True)
    (tmp_path / "run.checkpoint").unlink()
    with pytest.raises(InputError, match="ended before its first checkpoint"):
        tow(scenario, file=tmp_path / "run.nc", resume=True)


def test_recorded_quantities_agree_with_each_other(whole):
    """Bend radius and curvatures, C times strain and force at rest, energies and their error, friction inside its cone."""
    data = whole.dataset
    E, S = data["gauss_strain"].values, data["gauss_force"].values
    curvature = np.hypot(E[..., 4], E[..., 5]).max(axis=(1, 2))
    np.testing.assert_allclose(data["bend_radius"].values, 1 / curvature, rtol=1e-12)
    C = np.diag(whole.section.C)[[2, 0, 1, 5, 3, 4]]
    scale = np.abs(S[0]).max(axis=(0, 1)) + 1e-9
    assert (np.abs(S[0] - C * E[0]).max(axis=(0, 1)) / scale).max() < 1e-6  # at rest: no damping
    energy = data["energy"].values
    error = (energy[:, :-1] - energy[0, :-1]).sum(axis=1) - energy[:, -1]
    np.testing.assert_allclose(data["energy_error"].values, error, rtol=0, atol=1e-9)
    use = data["friction_use"].values
    assert use.min() >= 0 and use.max() <= 1 + 1e-9
    assert data["friction_use"].sel(surface="roller").values.max() == 0  # it turns freely


def test_stress_at_a_point_of_the_cable(whole):
    """On the outside of the bend sigma = N/A + M R/I at the middle Gauss point; the section's strain times E likewise."""
    D = whole.scenario.cable.diameter.value
    S = whole.dataset["gauss_force"].values[-1, :, 1]
    A, W = np.pi * D**2 / 4, np.pi * D**3 / 32
    sigma = whole.stresses(0.5, D / 2, 0.0)[-1, :, 0]
    np.testing.assert_allclose(sigma, S[:, 0] / A - S[:, 5] / W, rtol=1e-9, atol=1e-3)
    epsilon = whole.strains(0.5, D / 2, 0.0)[0, :, 0]
    E = whole.scenario.published_constants.E.value
    np.testing.assert_allclose(E * epsilon, whole.stresses(0.5, D / 2, 0.0)[0, :, 0], rtol=1e-6, atol=1.0)
    with pytest.raises(InputError, match="between 0 and 1"):
        whole.stresses(1.5, 0.0, 0.0)
