"""The kernels are plain Python: without compilation they give the same numbers; stale machine code is never used."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from beam.generalized_alpha import Integrator, StepSettings
from beam.rod import Rod
from beam.rod_model import RodModel, Support
from beam.shape import straight
from beam.surface import ContactLaw, Plane
from homogenize.section_stiffness import SectionInertia, SectionStiffness

HERE = Path(__file__).parent
SCRIPT = """
import sys
sys.path.insert(0, sys.argv[1])
from test_clamp_chain import one_step
from test_uncompiled_kernels import fall_on_a_floor
for numbers in (fall_on_a_floor(), one_step()):
    print(" ".join(f"{x:.9e}" for x in numbers))
"""


def fall_on_a_floor() -> np.ndarray:
    """A cantilever on a floor with friction, pushed along it: end node and iterations."""
    section = SectionStiffness.uncoupled(EA=1e4, GA_x=1e4, GA_y=1e4, EI_x=2.0, EI_y=2.0, GJ=1.0, area=1e-3)
    rod = Rod.straight(1.0, 3, section, SectionInertia(1.0, 1e-2, 1e-2, 1e-2))
    floor = Plane("floor", ContactLaw(stiffness=1e5, friction=0.3), offset=-0.01)
    model = RodModel(rod, straight(rod.s), [Support(0)], gravity=(1.0, -9.81, 0.5), surfaces=[floor])
    motion = Integrator(model, model.q0, settings=StepSettings(4e-3, adaptive=False))
    motion.advance(30)
    assert motion.forces.contact[:, 1].sum() > 0  # it has landed
    return np.append(motion.q[-1], motion.counters.iterations)


@pytest.fixture(scope="module")
def uncompiled() -> list[np.ndarray]:
    """Both results of one child process without compilation."""
    given = [sys.executable, "-c", SCRIPT, str(HERE)]
    environment = {**os.environ, "NUMBA_DISABLE_JIT": "1"}
    done = subprocess.run(given, env=environment, capture_output=True, text=True, check=True)
    return [np.array(line.split(), float) for line in done.stdout.splitlines()]


def test_cable_on_a_floor(uncompiled):
    """30 steps of a cantilever that falls on a floor with friction: nine digits agree, and the number of iterations."""
    np.testing.assert_allclose(fall_on_a_floor(), uncompiled[0], rtol=1e-7, atol=1e-10)


def test_clamps_bushings_and_a_joint(uncompiled):
    """One step of two clamps on a floor, one of them on a swivel."""
    sys.path.insert(0, str(HERE))
    from test_clamp_chain import one_step

    np.testing.assert_allclose(one_step(), uncompiled[1], rtol=1e-7, atol=1e-10)


def test_machine_code_is_renewed_with_any_kernel_file():
    """numba looks at the kernel's own file only; the stamp of all kernel files must stand in for it."""
    pytest.importorskip("numba")
    from beam.compiled import source_stamp
    from beam.element import internal_force

    if not hasattr(internal_force, "py_func"):
        pytest.skip("compilation is switched off")
    assert internal_force._cache._cache_file._source_stamp == source_stamp()  # type: ignore[attr-defined]
