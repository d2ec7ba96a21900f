"""Pictures of effects: the linear model in them is the least-squares one, the effect is what it leaves."""

import numpy as np
import pytest

from effects import find, library, section_effect
from effects.signature_plot import plot_signature, signature_figure
from effects.signature_scene import STIFFNESS, read_scene, scene_of


@pytest.mark.parametrize("effect", library(), ids=lambda e: e.name)
def test_every_scene_shows_its_effect(effect):
    """The linear model leaves at least 5 % of the largest load, and shapes and strengths are within their bounds."""
    scene = scene_of(effect)
    readings = read_scene(effect, scene)
    left = max(np.abs(r.load - r.linear).max() for r in readings)
    assert left > 0.05 * max(np.abs(r.load).max() for r in readings)
    assert scene.kind in effect.kinds
    form = effect.forms[0]
    for parameters, values in ((form.shape, scene.shape), (form.strength, scene.strength)):
        assert len(parameters) == len(values)
        assert all(p.low <= v <= p.high for p, v in zip(parameters, values))


def test_linear_model_of_the_picture_is_the_least_squares_one():
    """Orthogonality: what is left has no part along the linear load."""
    readings = read_scene(find("stiffening"), scene_of(find("stiffening")))
    left = np.concatenate([r.load - r.linear for r in readings])
    linear = np.concatenate([r.linear for r in readings])
    assert abs(left @ linear) < 1e-10 * np.linalg.norm(left) * np.linalg.norm(linear)


def test_friction_loops_do_not_know_the_clock_and_grow_with_tension():
    """The moment at the top is that of the stick-slip law: K (1 + slip strain with the grip of the tension)."""
    effect = find("interlayer-friction")
    scene = scene_of(effect)
    (slip, share), (stick,) = scene.shape, scene.strength
    for reading in read_scene(effect, scene):
        grip = 1 - share + share * reading.case.path.tension[0] / 2000.0
        assert reading.load.max() == pytest.approx(STIFFNESS["bending"] * (1 + stick * slip * grip), rel=1e-9)


def test_panels_carry_name_and_unit():
    for name, path, load in (("grip-slip", "strain [%]", "force [N]"), ("backlash", "twist [rad/m]", "torque [N m]")):
        axes = signature_figure(find(name)).axes
        assert [a.get_xlabel() for a in axes] == [path, path] and axes[0].get_ylabel() == load
    assert signature_figure(find("sensor-drift")).axes[1].get_xlabel() == "time [s]"
    assert signature_figure(find("tension-torsion-coupling")).axes[0].get_ylabel() == "torque [N m]"


def test_an_own_effect_is_drawn_too(tmp_path):
    own = section_effect("one-sided")(lambda path: np.maximum(path.strain, 0.0))
    file = plot_signature(own, tmp_path / "new")
    assert file == tmp_path / "new" / "one-sided.png" and file.read_bytes()[:4] == b"\x89PNG"
    reading = read_scene(own, scene_of(own))[0]
    assert reading.load.max() / -reading.load.min() == pytest.approx(1.3, rel=1e-9)
