"""A section law is one law: stepped from rest, point by point as in a rod, it gives the columns of the whole record."""

from dataclasses import replace

import numpy as np
import pytest

from effects.effect import BenchPath, Form
from effects.library import library

FORMS = [
    pytest.param(effect.name, form, id=f"{effect.name}: {form.name}")
    for effect in library()
    for form in effect.forms
    if form.stage in ("section", "cross")
]


def record(direction: str | None = None, seed: int = 0) -> BenchPath:
    """Growing and falling loops with a tension that changes, at uneven instants."""
    rng = np.random.default_rng(seed)
    time = np.concatenate([[0.0], np.cumsum(rng.uniform(0.05, 0.3, size=149))])
    strain = 0.02 * np.sin(time) * (1.0 - 0.6 * np.cos(0.4 * time))
    strain[0] = 0.0
    tension = np.maximum(900.0 + 800.0 * np.sin(0.3 * time), 0.0)
    return BenchPath("torsion", strain, time, 1.5, tension, 311.0, direction, 0.03, 1000.0, 295.0)


def middle_shape(form: Form, path: BenchPath) -> list[float]:
    """The middle one of the values from which a search begins."""
    return [float(p.starts([path])[len(p.starts([path])) // 2]) for p in form.shape if p.starts]


def stepped(form: Form, path: BenchPath, shape: list[float]) -> np.ndarray:
    """The columns of a record, from the law of a material point; two equal points run side by side."""
    assert form.advance is not None and path.time is not None and path.tension is not None
    two = np.ones(2)
    reference = replace(path, strain=np.zeros(0), time=None, tension=None, temperature=None)
    state, before, columns = np.zeros((2, form.memory)), np.zeros(2), []
    steps = np.diff(path.time, prepend=path.time[0])
    for strain, h, tension in zip(path.strain, steps, path.tension):
        now, state = form.advance(
            strain * two, before, float(h), tension * two, path.temperature * two, state, *shape, reference=reference
        )
        assert state.shape == (2, form.memory)
        np.testing.assert_array_equal(now[0], now[1])
        before = strain * two
        columns.append(now[0])
    return np.array(columns)


@pytest.mark.parametrize("direction", [None, "y-"])
@pytest.mark.parametrize(("effect", "form"), FORMS)
def test_stepping_equals_record(effect, form, direction):
    """To rounding, 1e-12 of the largest value; the central difference of a rate is the mean of two steps."""
    path = record(direction)
    shape = middle_shape(form, path)
    expected = form.respond(path, *shape)
    columns = stepped(form, path, shape)
    if effect == "viscous-damping" and "step" not in form.name:
        pytest.skip("a step knows the rate before it only; see test_viscous_damping")
    np.testing.assert_allclose(columns, expected, rtol=1e-10, atol=1e-12 * np.abs(expected).max())
    assert np.abs(expected).max() > 0.0


@pytest.mark.parametrize(("effect", "form"), FORMS)
def test_every_section_form_can_be_stepped(effect, form):
    """A rod takes any of them."""
    assert form.advance is not None
