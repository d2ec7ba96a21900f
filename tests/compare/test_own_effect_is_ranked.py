"""An effect that a user writes in ten lines is tried, ranked and named like those of the library."""

import numpy as np
import pytest
from made_bench import MODEL, RICH, blank, measured, refer, white

from compare import explain
from effects import Parameter, of_strain, register, section_effect, unregister
from effects.effect import ActiveEffect


@pytest.fixture(scope="module")
def waves():
    """A law that no effect of the library has: the load ripples along the strain."""

    @section_effect(
        "ripple",
        shape=[Parameter("wavelength", "strain", "strain from crest to crest", starts=of_strain(0.1, 0.6, 12))],
        strength=[Parameter("height", "1", "height of the ripple over K times the wavelength", low=0.0)],
    )
    def ripple(path, wavelength):
        """The armour ripples over its lay"""
        return wavelength * np.sin(2 * np.pi * path.strain / wavelength)

    register(ripple)
    yield ripple
    unregister("ripple")


@pytest.fixture(scope="module")
def campaign(waves):
    experiments = blank("bending", RICH, 60)
    term = ActiveEffect(waves, waves.forms[0], "bending", None, (0.3,), (0.2,))
    return measured(refer([term], experiments), experiments, white(0.01), seed=2)


def test_is_named(waves, campaign):
    """It is identified with its parameters, and the model handed back has it."""
    findings = explain(MODEL, campaign)
    assert (findings.verdict, findings.effects) == ("identified", ("ripple",))
    assert findings.ranking[0].effect == "ripple" and findings.ranking[0].behind == 0
    found = findings.after.calibration.parameters
    for name, value in (("wavelength", 0.3), ("height", 0.2)):
        assert abs(found[f"ripple: {name}"].value - value) < 4 * found[f"ripple: {name}"].std
    again = {e.id: findings.model.predict(e)["moment"] for e in campaign.experiments}
    assert all(np.isfinite(y).all() for y in again.values())


def test_without_it_the_truth_is_not_identified(waves, campaign):
    """The same data without the effect in the library are not identified as something else."""
    from effects.library import library

    findings = explain(MODEL, campaign, library=[e for e in library() if e.name != "ripple"])
    assert findings.verdict in ("unknown", "family-identified") and "ripple" not in findings.effects


def test_does_not_disturb_the_others(waves):
    """With the own effect registered and nothing missing, nothing is found."""
    quiet = measured(MODEL, blank("bending", RICH, 60), white(0.01), seed=4)
    findings = explain(MODEL, quiet)
    assert findings.verdict == "none"
    assert "ripple" in {c.effect for c in findings.ranking}
