"""Each effect of the library, put into data by the forward model, is named, and its parameters come back."""

import numpy as np
import pytest
from made_bench import LOAD, RICH, made, one_sided, switched
from made_campaign import NOMINAL

from compare import BenchModel, explain
from effects import find
from effects.library import NAMES

CASES = {
    "interlayer-friction": ("bending", (0.3, 0.7), (0.4,)),
    "plasticity": ("bending", (0.3,), (0.4,)),
    "viscous-damping": ("bending", (), (0.15,)),
    "viscoelasticity": ("bending", (3.0,), (0.3,)),
    "stiffening": ("bending", (), (0.2,)),
    "slack": ("tension", (8e-4,), (0.6,)),
    "cyclic-softening": ("bending", (0.5,), (0.3,)),
    "thermal-softening": ("bending", (), (0.008,)),
    "tension-stiffening": ("bending", (), (0.15,)),
    "tension-torsion-coupling": ("tension", (), (0.004,)),
    "direction-asymmetry": ("bending", (), (0.2,)),
    "end-load-introduction": ("tension", (0.15,), ()),
    "backlash": ("bending", (0.1,), ()),
    "grip-slip": ("tension", (0.3, 1.5e-3), ()),
    "rig-compliance": ("tension", (0.15,), ()),
    "sensor-offset": ("bending", (), (5.0,)),
    "sensor-drift": ("bending", (), (0.1,)),
    "sensor-lag": ("bending", (0.5,), ()),
}
TWINS = ("end-load-introduction", "rig-compliance")


def test_every_effect_has_its_case():
    """No effect of the bench goes without a test of its recovery; those of towing have theirs in test_towing_campaigns."""
    assert set(CASES) == {name for name in NAMES if find(name).kinds != ("towing",)}


@pytest.mark.parametrize("name", CASES)
def test_named_with_its_parameters(name):
    """The effect stands alone (two of the same law as the set of both), in its plain form, within 4 standard deviations."""
    kind, shape, strength = CASES[name]
    channel = LOAD[kind] if name.startswith("sensor") else None
    truth = switched(name, kind, shape, strength, channel=channel)
    coupled = name == "tension-torsion-coupling"
    campaign = made(
        [truth], kind, one_sided(RICH) if kind == "tension" else RICH, seed=3, n=40,
        also=("torque",) if coupled else (), scale={"torque": 5.0} if coupled else None,
    )  # fmt: skip
    assert campaign.section is not None
    findings = explain(BenchModel(campaign.section), campaign)
    if name in TWINS:
        assert findings.verdict == "confusable"
        assert set(findings.confusable) == set(TWINS) and findings.effects == ()
        assert findings.next_experiment is not None and "same law" in findings.next_experiment.sentence
    else:
        assert (findings.verdict, findings.effects, findings.confusable) == ("identified", (name,), ())
    tail = f" ({channel})" if channel else ""
    found = findings.after.calibration.parameters
    named = findings.model.effects[0].effect.name
    form = findings.model.effects[0].effect.forms[0]
    assert named == name or {named, name} == set(TWINS)
    for parameter, value in zip((*form.shape, *form.strength), (*shape, *strength), strict=True):
        got = found[f"{named}: {parameter.name}{tail}"]
        assert abs(got.value - value) < 4 * got.std
        assert got.std < 0.2 * abs(value)  # it is known, not merely not contradicted
    base = {"bending": "EI", "tension": "EA"}[kind]
    stiffness = findings.after.calibration.values[base]
    assert abs(stiffness.value - 1.1 * NOMINAL[base]) < 4 * stiffness.std
    assert findings.errors["calibrate"].after == pytest.approx(1.0, abs=0.05)
    assert np.isfinite(findings.ranking[0].log_e)
