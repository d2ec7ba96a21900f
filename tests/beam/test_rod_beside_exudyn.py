"""The same models in Exudyn (an optional peer): pull on a floor, stick-slip, pendulum give the same answers."""

import numpy as np
import pytest

from beam.benchmark_friction import EA, MU, WEIGHT
from beam.motion import SpeedRamp

rod_exudyn = pytest.importorskip("benchmarks.rod_exudyn")
if not rod_exudyn.installed():
    pytest.skip(rod_exudyn.MISSING, allow_module_level=True)


def test_pull_along_the_floor():
    """40 elements, half a second: within 1 % of the 3D ANCF cable (nodal floor there, Gauss points here)."""
    ramp = SpeedRamp(0.3, 0.0, 0.5)
    own, peer = rod_exudyn.own_pull(40, ramp, 0.5, 2e-3)[1], rod_exudyn.peer_pull("cable", 40, ramp, 0.5, 2e-3)[1]
    assert own == pytest.approx(peer, rel=1e-2)


def test_stick_slip_against_the_exact_force():
    """sqrt(2 EA mu w u) at u = 5 mm: this rod within 0.3 %, the peer with its nodal floor within 2 %."""
    ramp, exact = SpeedRamp(2e-3, 0.0, 3.0), np.sqrt(2 * EA * MU * WEIGHT * 5e-3)
    assert rod_exudyn.own_pull(64, ramp, 4.0, 5e-3)[1] == pytest.approx(exact, rel=3e-3)
    assert rod_exudyn.peer_pull("cable", 64, ramp, 4.0, 5e-3)[1] == pytest.approx(exact, rel=2e-2)


def test_pendulum():
    """Tip after 0.6 s within 1 mm; the peer has no shear."""
    np.testing.assert_allclose(rod_exudyn.own_pendulum(1e-3)[1], rod_exudyn.peer_pendulum(1e-3)[1], rtol=0, atol=1e-3)
