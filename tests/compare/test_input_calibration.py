"""Inputs from targets: known optimum, known J^T J, a null direction found, and a run that goes on after a kill."""

import json
import os
import signal
import subprocess
import sys
import time

import numpy as np
import pytest

from compare.evaluation_store import EvaluationStore, input_hash
from compare.identifiability import identifiability, profile
from compare.input_calibration import calibrate_inputs
from compare.multi_start import multi_start, sobol_starts
from compare.target_file import InputParameter, Target
from geometry.errors import ConvergenceError, InputError

POWERS = np.array([[1.0, -1.0, 0.0], [0.0, 0.0, 1.0]])  # E = a / b, u_z = c: the product a b is free


def parameter(name, low=0.1, high=10.0):
    return InputParameter(name, (name,), low, high, "m", "assumed", "made up")


def target(name, value, error=0.02):
    return Target(name, value, "m", error, "made up", "made up")


def power_law(values, powers=POWERS):
    x = np.log([values[n] for n in "abc"])
    return dict(zip(("E", "u_z"), np.exp(powers @ x), strict=True))


PARAMETERS, TARGETS = [parameter(n) for n in "abc"], [target("E", 2.0), target("u_z", 0.5)]


def test_power_law_is_met_exactly():
    """ln E = ln a - ln b: residuals vanish, one full run serves when cheap and full model are one."""
    found = calibrate_inputs(TARGETS, PARAMETERS, power_law, power_law, starts=4)
    assert len(found.runs) == 1 and found.agreed
    assert found.ratios == pytest.approx({"E": 1.0, "u_z": 1.0}, rel=1e-5)


def test_jacobian_uncertainty_and_null_direction_of_a_power_law():
    """J = powers / error; a b is open, its spread the prior's; c is fixed to its target's error over 1."""
    found = calibrate_inputs(TARGETS, PARAMETERS, power_law, power_law, starts=4).identifiability
    prior = np.log(100) / np.sqrt(12)
    assert found.prior == pytest.approx(prior, rel=1e-9)
    values = [d.eigenvalue for d in found.directions]
    assert sorted(values) == pytest.approx([0.0, (prior / 0.02) ** 2, 2 * (prior / 0.02) ** 2], rel=1e-4, abs=1e-6)
    null = found.directions[-1]
    assert null.is_open and np.abs(null.vector) == pytest.approx([np.sqrt(0.5), np.sqrt(0.5), 0.0], abs=1e-6)
    assert null.vector[0] * null.vector[1] > 0 and null.words == "a with b: not fixed by these data"
    assert "a / b is fixed to 2 %" in {d.words for d in found.directions} | {
        d.words.replace("b / a", "a / b") for d in found.directions
    }
    assert found.standard_error[2] == pytest.approx(0.02, rel=1e-3)
    assert found.correlation[0, 1] > 0.99


def test_covariance_is_the_inverse_of_jtj_with_the_prior():
    rng = np.random.default_rng(1)
    J = rng.normal(size=(5, 3))
    low, high = -np.ones(3), np.array([1.0, 3.0, 2.0])
    found = identifiability(J, np.zeros(3), low, high, "abc")
    prior = (high - low) / np.sqrt(12)
    exact = np.linalg.inv(J.T @ J + np.diag(1 / prior**2))
    assert found.standard_error**2 == pytest.approx(np.diag(exact), rel=1e-12)
    assert found.correlation * np.outer(found.standard_error, found.standard_error) == pytest.approx(exact, rel=1e-12)


def test_optimum_is_that_of_the_full_model():
    """A cheap model that is wrong by a factor and by a bend of the curve: the full run meets the targets, not the cheap one."""

    def cheap(values):
        true = power_law(values)
        return {"E": 1.4 * true["E"] ** 0.8, "u_z": 0.7 * true["u_z"] * values["a"] ** 0.1}

    found = calibrate_inputs(TARGETS, PARAMETERS, cheap, power_law, most_runs=8, agreement=0.005, starts=4)
    assert found.agreed and 2 <= len(found.runs) <= 8
    assert found.best.outputs["E"] == pytest.approx(2.0, rel=0.01)
    assert found.best.outputs["u_z"] == pytest.approx(0.5, rel=0.01)
    assert found.runs[0].disagreement > 0.1


class Tangent:
    """A cheap model that knows the true one, less a factor, near its latest refinements only: nearest value and slope in ln."""

    def __init__(self, true, start):
        self.true, self.places = true, []
        self.refine(start)

    def refine(self, values):
        self.places.append(np.log([values[n] for n in "abc"]))

    def __call__(self, values):
        x = np.log([values[n] for n in "abc"])
        near = min(self.places, key=lambda y: float(np.abs(y - x).sum()))

        def at(y):
            found = self.true(dict(zip("abc", np.exp(y), strict=True)))
            return np.log([found["E"], found["u_z"]])

        slope = np.array([(at(near + d) - at(near - d)) / 2e-4 for d in 1e-4 * np.eye(3)])
        return dict(zip(("E", "u_z"), 0.9 * np.exp(at(near) + (x - near) @ slope), strict=True))


def bent(values):
    """E = a^2 / b + b / 4, u_z = c / (1 + a / 10): logarithms are no straight lines."""
    return {"E": values["a"] ** 2 / values["b"] + values["b"] / 4, "u_z": values["c"] / (1 + values["a"] / 10)}


def test_cheap_model_is_refined_where_it_is_searched():
    """A tangent that moves along ends at the optimum of the full model, with the derivatives of the full model there."""
    cheap = Tangent(bent, dict.fromkeys("abc", 1.0))
    found = calibrate_inputs(TARGETS, PARAMETERS, cheap, bent, refine=cheap.refine, starts=4)
    assert found.agreed and found.ratios == pytest.approx({"E": 1.0, "u_z": 1.0}, rel=0.005)  # the agreement asked for
    assert len(found.runs) <= 4
    x = np.log([found.best.inputs[n] for n in "abc"])
    J = np.zeros((2, 3))
    for j in range(3):
        ends = [bent(dict(zip("abc", np.exp(x + s * 1e-4 * np.eye(3)[j]), strict=True))) for s in (1, -1)]
        J[:, j] = [np.log(ends[0][k] / ends[1][k]) / 2e-4 / 0.02 for k in ("E", "u_z")]
    exact = identifiability(J, x, np.log(np.full(3, 0.1)), np.log(np.full(3, 10.0)), "abc")
    assert found.identifiability.standard_error == pytest.approx(exact.standard_error, rel=0.02)  # within a step's bend
    steps = np.abs(np.array(cheap.places) - x) / np.log(100)
    assert all((np.abs(steps[:, j] - 0.05) < 0.01).any() for j in range(3))  # a step along every input


def test_search_comes_back_from_past_infinity():
    """E = 1 / (1/a - 1/2) is negative above a = 2: a start there has no logarithm, and still finds a = 1 where E = 2."""

    def model(values):
        return {"E": 1 / (1 / values["a"] - 0.5)}

    found = calibrate_inputs([TARGETS[0]], PARAMETERS[:1], model, model, starts=0, first=np.log([8.0]))
    assert found.best.inputs["a"] == pytest.approx(1.0, rel=1e-4)


def test_no_parameter_leaves_its_range():
    """A target that asks for more than the ranges give ends at the bound, and says so."""
    found = calibrate_inputs([target("E", 1e4), TARGETS[1]], PARAMETERS, power_law, power_law, starts=4)
    assert found.best.inputs["a"] == pytest.approx(10.0, rel=1e-6) and found.best.inputs["a"] <= 10.0
    assert found.best.inputs["b"] == pytest.approx(0.1, rel=1e-6) and found.best.inputs["b"] >= 0.1
    assert set(found.identifiability.at_bound) == {"a", "b"}


def test_profile_is_flat_along_the_null_direction_and_a_parabola_along_a_stiff_one():
    x, low, high = np.zeros(3), -np.ones(3), np.ones(3)

    def residual(y):
        return POWERS @ y / 0.02

    known = identifiability(POWERS / 0.02, x, low, high, "abc")
    flat = profile(residual, x, low, high, known.directions[-1])
    assert flat.cost.max() < 1e-6 and np.ptp(flat.step) > 3
    stiff = profile(residual, x, low, high, known.directions[0])
    assert stiff.cost == pytest.approx(0.5 * known.directions[0].eigenvalue * stiff.step**2, rel=1e-3, abs=1e-6)


def test_starts_fill_the_box_and_find_every_minimum():
    """Sobol: each half of every side holds half of the places. A double well has two minima."""
    places = sobol_starts(np.zeros(3), np.ones(3), 64)
    assert np.abs((places < 0.5).sum(axis=0) - 32).max() <= 1  # the first is the middle
    wells = multi_start(lambda x: np.array([x[0] ** 2 - 1.0, x[1] - 0.5]), np.full(2, -2.0), np.full(2, 2.0), count=16)
    assert {round(float(m.x[0])) for m in wells} == {-1, 1} and sum(m.starts for m in wells) == 16


def test_outputs_without_logarithm_are_a_sentence():
    with pytest.raises(ConvergenceError, match="no logarithm"):
        calibrate_inputs(TARGETS, PARAMETERS, lambda v: {"E": -1.0, "u_z": 1.0}, power_law)
    with pytest.raises(InputError, match="no output u_z"):
        calibrate_inputs(TARGETS, PARAMETERS, lambda v: {"E": 1.0}, power_law)


def test_finished_runs_are_not_run_again(tmp_path):
    """The second time every run is found by the hash of its inputs; another identity is another run."""
    calls = []

    def full(values):
        calls.append(values)
        return power_law(values)

    file = tmp_path / "runs.jsonl"
    first = calibrate_inputs(TARGETS, PARAMETERS, power_law, full, store=EvaluationStore(file), starts=4)
    again = calibrate_inputs(TARGETS, PARAMETERS, power_law, full, store=EvaluationStore(file, resume=True), starts=4)
    assert len(calls) == len(first.runs) and again.best.outputs == first.best.outputs
    calibrate_inputs(
        TARGETS,
        PARAMETERS,
        power_law,
        full,
        store=EvaluationStore(file, resume=True),
        identity={"mesh": "finer"},
        starts=4,
    )
    assert len(calls) == 2 * len(first.runs)
    with pytest.raises(InputError, match="--resume"):
        EvaluationStore(file)


def test_torn_line_is_passed_over(tmp_path):
    file = tmp_path / "runs.jsonl"
    store = EvaluationStore(file)
    store.put({"a": 1.0}, {"E": 2.0})
    with file.open("a") as out:
        out.write(
            '{"hash": "ab',
        )
    store = EvaluationStore(file, resume=True)
    store.put({"a": 2.0}, {"E": 3.0})
    again = EvaluationStore(file, resume=True)
    assert again.get({"a": 1.0}) == {"E": 2.0} and again.get({"a": 2.0}) == {"E": 3.0} and len(again) == 2
    assert input_hash({"a": 1.0}) != input_hash({"a": 1.0000001})


KILLED = """
import sys, time
from pathlib import Path
from compare.evaluation_store import EvaluationStore
store = EvaluationStore(Path(sys.argv[1]), resume=True)
for k in range(1000):
    if store.get({"k": k}) is None:
        time.sleep(0.02)
        store.put({"k": k}, {"E": float(k)})
"""


def test_a_killed_run_loses_at_most_the_evaluation_at_hand(tmp_path):
    """SIGKILL in the middle: every finished evaluation is there, whole, and the next run starts after them."""
    file = tmp_path / "runs.jsonl"
    run = subprocess.Popen([sys.executable, "-c", KILLED, str(file)])
    for _ in range(600):
        if file.exists() and file.read_bytes().count(b"\n") >= 3:
            break
        time.sleep(0.05)
    os.kill(run.pid, signal.SIGKILL)
    assert run.wait() == -signal.SIGKILL
    store = EvaluationStore(file, resume=True)
    assert len(store) >= 3
    assert all(store.get({"k": k}) == {"E": float(k)} for k in range(len(store)))
    assert all(json.loads(line) for line in file.read_text().splitlines()[: len(store)])
