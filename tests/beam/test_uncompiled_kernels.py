"""The kernels are plain Python: without compilation they give the same numbers; stale machine code is never used."""

import os
import subprocess
import sys

import numpy as np
import pytest

SCRIPT = """
import numpy as np
from beam.generalized_alpha import Integrator, StepSettings
from beam.rod import Rod
from beam.rod_model import RodModel, Support
from beam.shape import straight
from beam.surface import ContactLaw, Plane
from homogenize.section_stiffness import SectionInertia, SectionStiffness

section = SectionStiffness.uncoupled(EA=1e4, GA_x=1e4, GA_y=1e4, EI_x=2.0, EI_y=2.0, GJ=1.0, area=1e-3)
rod = Rod.straight(1.0, 3, section, SectionInertia(1.0, 1e-2, 1e-2, 1e-2))
floor = Plane("floor", ContactLaw(stiffness=1e5, friction=0.3), offset=-0.01)
model = RodModel(rod, straight(rod.s), [Support(0)], gravity=(1.0, -9.81, 0.5), surfaces=[floor])
motion = Integrator(model, model.q0, settings=StepSettings(4e-3, adaptive=False))
motion.advance(30)
print(" ".join(f"{x:.9e}" for x in motion.q[-1]), motion.counters.iterations)
"""


def result(**environment: str) -> list[str]:
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT], env={**os.environ, **environment}, capture_output=True, text=True, check=True
    )
    return done.stdout.split()


def test_same_numbers_without_compilation():
    """A cantilever that falls on a floor with friction, 30 steps: nine digits agree."""
    compiled, plain = result(), result(NUMBA_DISABLE_JIT="1")
    np.testing.assert_allclose(np.array(compiled, float), np.array(plain, float), rtol=1e-7, atol=1e-10)


def test_machine_code_is_renewed_with_any_kernel_file():
    """numba looks at the kernel's own file only; the stamp of all kernel files must stand in for it."""
    pytest.importorskip("numba")
    from beam.compiled import source_stamp
    from beam.element import internal_force

    if not hasattr(internal_force, "py_func"):
        pytest.skip("compilation is switched off")
    assert internal_force._cache._cache_file._source_stamp == source_stamp()  # type: ignore[attr-defined]
