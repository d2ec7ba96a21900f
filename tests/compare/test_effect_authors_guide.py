"""The effect author's guide does what it says: its blocks run, its laws hold, its effects are found again among rivals."""

import re
from dataclasses import replace
from pathlib import Path

import pytest
from made_bench import RICH, made, switched
from made_towing import tow_campaign, towing_model

from compare import BenchModel, Campaign, explain
from effects import find, unregister

PAGE = Path(__file__).resolve().parents[2] / "docs" / "effect-authors-guide.md"
MADE = ("clamp-contact", "tail-weight-error")


@pytest.fixture(scope="module")
def guide():
    """Everything that the blocks of the page define, run one after the other."""
    space: dict = {}
    try:
        for block in re.findall(r"```python\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL):
            exec(block, space)
        yield space
    finally:
        for name in MADE:
            unregister(name)


def test_the_laws_of_the_guide_hold(guide):
    """Its own tests pass, and fail for a law with a wrong sign."""
    tests = [law for name, law in guide.items() if name.startswith("test_")]
    assert len(tests) == 2
    for law in tests:
        law()
    right = guide["clamp_contact"]
    form = right.forms[0]
    wrong = replace(right, forms=(replace(form, respond=lambda path, onset: abs(form.respond(path, onset))),))
    guide["clamp_contact"] = wrong
    with pytest.raises(AssertionError):
        guide[tests[0].__name__]()
    guide["clamp_contact"] = right


def test_the_bench_effect_is_found_among_its_rivals(guide):
    """Onset 0.5 /m and gain 0.3 come back within 4 standard deviations; the error is at the noise floor."""
    campaign = made([switched("clamp-contact", "bending", (0.5,), (0.3,))], "bending", RICH[:5], seed=3, n=40)
    rivals = [guide["clamp_contact"], find("stiffening"), find("plasticity")]
    assert campaign.section is not None
    findings = explain(BenchModel(campaign.section), campaign, library=rivals)
    assert (findings.verdict, findings.effects) == ("identified", ("clamp-contact",))
    found = findings.after.calibration.parameters
    for name, truth in (("onset", 0.5), ("gain", 0.3)):
        value = found[f"clamp-contact: {name}"]
        assert abs(value.value - truth) < 4 * value.std < 0.4 * truth
    assert findings.errors["calibrate"].after == pytest.approx(1.0, abs=0.1)


def test_the_towing_effect_is_found_and_is_no_offset(guide, tmp_path):
    """5 % of two tail tensions: no single offset of the sensor, no added load."""
    folder = tow_campaign(
        tmp_path,
        act=lambda cable: guide["other_weight"](cable, (0.05,)),
        conditions=((0.3, 0.0, 800.0), (0.3, 5.0, 1600.0)),
    )
    campaign = Campaign.read(folder)
    rivals = [guide["tail_weight_error"], find("sensor-offset"), find("added-load")]
    findings = explain(towing_model(campaign), campaign, library=rivals)
    assert (findings.verdict, findings.effects) == ("identified", ("tail-weight-error",))
    value = findings.after.calibration.parameters["tail-weight-error: error"]
    assert abs(value.value - 0.05) < 4 * value.std < 0.01
