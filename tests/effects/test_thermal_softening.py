"""Thermal softening: nothing at the typical temperature, softer above, stiffer below, and any falling law in pieces."""

import numpy as np
import pytest
from scipy.optimize import nnls

from effects.effect import BenchPath
from effects.thermal_softening import EFFECT, EXPONENTIAL, LINEAR, PIECES, STEP

STRAIN = np.linspace(-0.01, 0.01, 21)
SHAPES = {LINEAR.name: (), EXPONENTIAL.name: (0.03,), STEP.name: (290.0, 8.0), PIECES.name: ()}


def path_at(temperature: float | None) -> BenchPath:
    return BenchPath("tension", STRAIN, None, temperature=temperature, largest=0.01, typical_temperature=295.0)


@pytest.mark.parametrize("form", EFFECT.forms, ids=lambda f: f.name)
def test_signs(form):
    """K is that of the typical temperature; every strength softens above and stiffens below; reversible."""
    shape = SHAPES[form.name]
    assert not form.respond(path_at(295.0), *shape).any()
    assert not form.respond(path_at(None), *shape).any()
    warm, cold = (form.respond(path_at(T), *shape)[-1].sum() for T in (315.0, 275.0))
    assert warm < 0.0 < cold


def test_linear_and_exponential_laws():
    """2 % per kelvin for 20 K takes 40 %; an exponential falls by the factor exp(-b dT)."""
    np.testing.assert_allclose(STRAIN + 0.02 * LINEAR.respond(path_at(315.0))[:, 0], 0.6 * STRAIN, rtol=1e-12)
    load = STRAIN + EXPONENTIAL.respond(path_at(315.0), 0.03)[:, 0]
    np.testing.assert_allclose(load, np.exp(-0.6) * STRAIN, rtol=1e-12)


def test_step_has_height_one():
    """From far below to far above the transition one unit of stiffness is lost per unit of strength."""
    lost = STEP.respond(path_at(200.0), 290.0, 5.0) - STEP.respond(path_at(400.0), 290.0, 5.0)
    np.testing.assert_allclose(lost[:, 0], STRAIN, rtol=1e-12)


def test_pieces_cover_a_transition():
    """A glass transition measured every 5 K between 0 and 45 degC: pieces with strengths >= 0 leave 2 % of the load."""
    temperatures = np.arange(273.15, 319.0, 5.0)
    truth = [1.5 - np.tanh((T - 300.0) / 12.0) for T in temperatures]
    columns = np.array([np.append(1.0, PIECES.respond(path_at(T))[-1] / STRAIN[-1]) for T in temperatures])
    assert nnls(columns, np.array(truth))[1] < 0.02 * np.linalg.norm(truth)


def test_untestable_sentence():
    """One temperature, or none recorded, cannot show it."""
    assert EFFECT.why_untestable([path_at(293.15), path_at(293.15)]) == "all experiments at 20 degC"
    assert EFFECT.why_untestable([path_at(None)]) == "no temperature was recorded"
    assert EFFECT.why_untestable([path_at(293.15), path_at(310.0)]) is None
