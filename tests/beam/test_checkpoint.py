"""A run that goes on from a checkpoint gives the same bits as one that never stopped; every step reports its own error."""

import numpy as np
import pytest

from beam.benchmark_dynamics import pendulum, swing
from beam.benchmark_friction import cable_on_floor
from beam.checkpoint import read_checkpoint, write_checkpoint
from beam.generalized_alpha import Integrator, StepSettings
from beam.motion import SpeedRamp
from beam.rod_model import Support
from geometry.errors import InputError


def pulled(h=5e-3) -> Integrator:
    model = cable_on_floor(8, [Support(-1, travel=SpeedRamp(0.2, 0.0, 0.5))], length=2.0)
    return Integrator(model, model.q0, settings=StepSettings(h))


def test_restart_is_bit_exact(tmp_path):
    """With friction, adaptive steps and a kept factorised matrix: positions, velocities, energies and counters."""
    whole = pulled()
    assert whole.advance(60)
    first = pulled()
    assert first.advance(37)
    path = write_checkpoint(first, tmp_path / "run.checkpoint")
    second = pulled()
    read_checkpoint(second, path)
    assert second.t == first.t
    assert second.advance(23)
    np.testing.assert_array_equal(second.q, whole.q)
    np.testing.assert_array_equal(second.v, whole.v)
    np.testing.assert_array_equal(second.reaction, whole.reaction)
    assert second.ledger.totals == whole.ledger.totals
    assert second.counters == whole.counters


def test_checkpoint_of_another_run_is_refused(tmp_path):
    """Other step settings, another model, a file that is none, one with damaged bytes."""
    path = write_checkpoint(pulled(), tmp_path / "run.checkpoint")
    with pytest.raises(InputError, match=r"other step settings \(largest_step 0.005, not 0.001\)"):
        read_checkpoint(pulled(1e-3), path)
    with pytest.raises(InputError, match="run of another model"):
        model = cable_on_floor(8, [], length=2.0)
        read_checkpoint(Integrator(model, model.q0, settings=StepSettings(5e-3)), path)
    (tmp_path / "torn").write_bytes(path.read_bytes()[:-40].replace(b"beam.newton_step", b"beam.newton_stop"))
    with pytest.raises(InputError, match="no checkpoint"):
        read_checkpoint(pulled(), tmp_path / "torn")
    (tmp_path / "no").write_bytes(b"no")
    with pytest.raises(InputError, match="no checkpoint"):
        read_checkpoint(pulled(), tmp_path / "no")
    with pytest.raises(InputError, match="cannot be written"):
        write_checkpoint(pulled(), tmp_path / "missing" / "run")


def test_own_errors_of_the_steps_sum_to_the_error_of_the_run():
    """Pendulum to 0.2 s: the sum falls with the square of the step, and is the true error within a factor of ten."""
    model = pendulum(3)
    fine = swing(model, 1e-4, 0.2, tight=True).q[-1, :2]
    runs = [swing(model, h, 0.2, tight=True) for h in (2e-3, 1e-3)]
    assert 3.0 < runs[0].error_sum / runs[1].error_sum < 5.0
    for run in runs:
        true = np.linalg.norm(run.q[-1, :2] - fine)
        assert 0.1 < run.error_sum / true < 10
        assert "node 3" in run.step_error[1]


def test_steps_are_cut_to_the_wished_error():
    """A bound on the own error makes more and shorter steps, and every one of them keeps it."""
    model = pendulum(3)
    free = Integrator(model, model.q0, settings=StepSettings(2e-3, first_level=0))
    bound = Integrator(model, model.q0, settings=StepSettings(2e-3, first_level=0, error=1e-7))
    assert free.advance(50) and bound.advance(50)
    assert free.step_error[0] > 1e-7 >= bound.step_error[0]
    assert bound.counters.steps > free.counters.steps
