"""Two effects at once: both are found, nothing third, and the one that hides the other does not take its place."""

import pytest
from made_bench import RICH, made, one_sided, switched

from compare import BenchModel, explain

PAIRS = {
    "friction and warmth": ("bending", [switched("interlayer-friction", "bending", (0.3, 0.7), (0.4,)),
                                        switched("thermal-softening", "bending", (), (0.008,))]),
    "stiffening and a lag": ("bending", [switched("stiffening", "bending", (), (0.2,)),
                                         switched("sensor-lag", "bending", (0.5,), channel="moment")]),
    "toe and drift": ("tension", [switched("slack", "tension", (8e-4,), (0.6,)),
                                  switched("sensor-drift", "tension", (), (3.0,), channel="force")]),
}  # fmt: skip


@pytest.mark.parametrize("pair", PAIRS)
def test_both_and_nothing_else(pair):
    """The names are the two; the path shows a fall of the error at each step down to the noise."""
    kind, effects = PAIRS[pair]
    campaign = made(effects, kind, one_sided(RICH) if kind == "tension" else RICH, n=40, seed=12)
    findings = explain(BenchModel(campaign.section), campaign)
    assert findings.verdict == "identified"
    assert set(findings.effects) == {a.effect.name for a in effects}
    errors = [step.error for step in findings.path]
    assert len(errors) == 3 and errors[0] > errors[1] > errors[2]
    assert errors[2] == pytest.approx(1.0, abs=0.1)
