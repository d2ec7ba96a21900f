"""Interlayer friction: the slip limit follows the axial tension; many elements make the loops of richer layups."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import nnls

from effects.effect import BenchPath
from effects.interlayer_friction import DISTRIBUTED, EFFECT, ONE_ELEMENT, SLIP_STRAINS
from effects.plasticity import EFFECT as PLASTICITY


def loops(tension: float | np.ndarray | None, amplitude: float = 1.0) -> BenchPath:
    """Loops of growing curvature [1/m]; largest 1, typical tension 2 kN."""
    t = np.linspace(0.0, 3.0, 301)
    strain = amplitude * np.sin(2 * np.pi * t) * np.minimum(0.4 + 0.3 * np.floor(t), 1.0)
    grip = None if tension is None else np.broadcast_to(np.asarray(tension, dtype=float), t.shape)
    return BenchPath("bending", strain, 10 * t, 1.0, grip, largest=1.0, typical_tension=2000.0)


@pytest.mark.parametrize(("tension", "limit"), [(2000.0, 0.2), (4000.0, 0.32), (0.0, 0.08), (-500.0, 0.08)])
def test_slip_limit_grows_with_tension(tension, limit):
    """Limit x [(1 - g) + g N/N_typ] with x = 0.2, g = 0.6; compression grips no less than no tension."""
    stress = ONE_ELEMENT.respond(loops(tension), 0.2, 0.6)[:, 0]
    np.testing.assert_allclose([stress.max(), stress.min()], [limit, -limit], rtol=1e-13)


def test_no_recorded_tension_is_the_typical_one():
    """Without a tension the limit is that at the typical tension."""
    np.testing.assert_array_equal(
        ONE_ELEMENT.respond(loops(None), 0.2, 0.6), ONE_ELEMENT.respond(loops(2000.0), 0.2, 0.6)
    )


def test_tension_that_varies_in_the_record():
    """As in a tension test: the stress stays within the limit of the moment, and touches it."""
    path = loops(2000.0)
    path = replace(path, tension=np.maximum(4000.0 * path.strain, 0.0))
    stress = ONE_ELEMENT.respond(path, 0.3, 0.75)[:, 0]
    limit = 0.3 * (0.25 + 0.75 * path.tension / 2000.0)
    assert np.all(np.abs(stress) <= limit + 1e-15)
    assert np.sum(np.isclose(np.abs(stress), limit, rtol=1e-12)) > 30


def test_distributed_form_is_elements_in_parallel():
    """Its columns are single elements with fixed multiples of the largest strain."""
    path = loops(3000.0)
    columns = DISTRIBUTED.respond(path, 0.7)
    for j, x in enumerate(SLIP_STRAINS):
        np.testing.assert_array_equal(columns[:, j], ONE_ELEMENT.respond(path, float(x), 0.7)[:, 0])


def progressive_slip(path: BenchPath, share: float, onset: float) -> np.ndarray:
    """A layer of 200 wires round the section: stick stiffness ~ sin^2, slip curvature ~ angle / sin of the angle."""
    angle = (np.arange(200) + 0.5) * np.pi / 400
    stiffness, slip = np.sin(angle) ** 2 / 100, onset * angle / np.sin(angle)
    grip = (1 - share) + share * path.tension / path.typical_tension
    stress, before, load = np.zeros(200), 0.0, []
    for kappa, r in zip(path.strain, grip):
        stress = np.clip(stress + kappa - before, -slip * r, slip * r)
        before = kappa
        load.append(stiffness @ stress)
    return np.array(load)


def test_covers_progressive_slip_of_two_layers():
    """Two layers that slip wire by wire, at three tensions: the elements leave less than 1 % of their load, one over 4 %."""
    paths = [loops(N, A) for N in (800.0, 2000.0, 4500.0) for A in (0.3, 1.0)]
    truth = np.concatenate([progressive_slip(p, 0.7, 0.15) + 0.5 * progressive_slip(p, 0.7, 0.5) for p in paths])

    def left(form, shape):
        columns = np.vstack([form.respond(p, *shape) for p in paths])
        base = np.concatenate([p.strain for p in paths])[:, None]
        return nnls(np.hstack([base, columns]), truth)[1] / np.linalg.norm(truth)

    assert left(DISTRIBUTED, (0.7,)) < 0.01
    assert min(left(ONE_ELEMENT, (x, 0.7)) for x in np.geomspace(0.05, 1.0, 20)) > 0.04


def test_testable_wherever_its_twin_is():
    """On a path that only grows it softens as plasticity does: were it left out there, its twin would be named alone."""
    path = loops(2000.0)
    up = replace(path, strain=np.linspace(0.0, 1.0, 301))
    still = replace(path, strain=np.full(301, 0.5))
    for paths in ([up], [up, path], [still]):
        assert (EFFECT.why_untestable(paths) is None) == (PLASTICITY.why_untestable(paths) is None)
    assert EFFECT.why_untestable([up]) is None and "stands still" in (EFFECT.why_untestable([still]) or "")
