"""Viscoelasticity: a spectrum of branches reaches over the times of the data and takes any fading relaxation."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import nnls

from effects.effect import BenchPath
from effects.maxwell_branch import maxwell_record
from effects.viscoelasticity import BRANCHES, EFFECT, ONE_BRANCH, RATIO, SPECTRUM

FREQUENCIES = (0.008, 0.05, 0.3)


def records() -> list[BenchPath]:
    """Loops at three frequencies, 100 samples a period, and a ramp with a hold of 300 s."""
    paths = []
    for f in FREQUENCIES:
        t = np.linspace(0.0, 3 / f, 301)
        paths.append(BenchPath("tension", 0.01 * np.sin(2 * np.pi * f * t), t, largest=0.01))
    t = np.linspace(0.0, 300.0, 301)
    return [*paths, BenchPath("tension", np.minimum(0.01 * t / 5.0, 0.01), t, largest=0.01)]


def left(form, shape, truth) -> float:
    """Part of the load of `truth(path)` that the form, with strengths >= 0 and a linear spring, does not follow."""
    paths = records()
    load = np.concatenate([truth(p) for p in paths])
    columns = np.vstack([np.column_stack([p.strain, form.respond(p, *shape)]) for p in paths])
    scale = np.linalg.norm(columns, axis=0)
    return nnls(columns / scale, load)[1] / float(np.linalg.norm(load))


def ends() -> tuple[float, ...]:
    return tuple(float(p.starts(records())[0]) for p in SPECTRUM.shape if p.starts)


def test_spectrum_reaches_over_the_data():
    """One start: twice the longest record; the fastest branch fades within the shortest sampling interval."""
    (longest,) = ends()
    np.testing.assert_allclose(longest, 2 * 3 / 0.008, rtol=1e-12)
    assert longest / RATIO ** (BRANCHES - 1) < (3 / 0.3) / 300
    assert all(len(p.starts(records())) == 1 for p in SPECTRUM.shape)


def test_four_branches():
    """Four branches that are none of ours: 0.2 % of the load is left at most; one branch leaves ten times as much."""
    tau, a = np.array([0.3, 2.7, 19.0, 160.0]), np.array([0.3, 0.2, 0.2, 0.3])

    def truth(p):
        return p.strain + maxwell_record(p.strain, p.time, tau) @ a

    spectrum = left(SPECTRUM, ends(), truth)
    one = min(left(ONE_BRANCH, (x,), truth) for x in np.geomspace(0.05, 500.0, 30))
    assert spectrum < 2e-3
    assert one > 10 * spectrum


@pytest.mark.parametrize("alpha", [0.2, 0.5])
def test_fractional_relaxation(alpha):
    """Relaxation 1 + t^-alpha, summed exactly over straight steps of the path: 0.5 % of the load is left at most."""

    def truth(p):
        rate = np.diff(p.strain) / np.diff(p.time)
        lag = p.time[:, None] - p.time[None, :]
        faded = np.maximum(lag, 0.0) ** (1 - alpha) / (1 - alpha)  # integral of the kernel
        return p.strain + (faded[:, :-1] - faded[:, 1:]) @ rate

    assert left(SPECTRUM, ends(), truth) < 5e-3


def test_stress_fades_at_constant_strain():
    """In the hold the added load falls to 1/e in one relaxation time, to rounding."""
    path = records()[-1]
    q = ONE_BRANCH.respond(path, 40.0)[:, 0]
    np.testing.assert_allclose(q[50 + 40] / q[50], np.exp(-1.0), rtol=1e-12)


def test_needs_a_clock():
    """Without time nothing relaxes, and it is said."""
    path = replace(records()[0], time=None)
    assert "clock" in (EFFECT.why_untestable([path]) or "")
    assert not ONE_BRANCH.respond(path, 3.0).any() and not SPECTRUM.respond(path, 10.0).any()
