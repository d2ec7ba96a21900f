"""A truth that is not in the library is never called identified: a proxy is no explanation."""

import pytest
from made_bench import RICH, made, one_sided, switched

from compare import BenchModel, explain
from effects.library import library

MISSING = {
    "a drift without drift": ("bending", switched("sensor-drift", "bending", (), (0.3,), channel="moment"),
                              {"sensor-drift"}),
    "a lag without lag or damping": ("bending", switched("sensor-lag", "bending", (1.0,), channel="moment"),
                                     {"sensor-lag", "viscous-damping", "viscoelasticity"}),
    "warmth without temperature": ("bending", switched("thermal-softening", "bending", (), (0.015,)),
                                   {"thermal-softening"}),
    "a slip without slips": ("bending", switched("plasticity", "bending", (0.3,), (0.6,)),
                             {"plasticity", "interlayer-friction", "cyclic-softening", "grip-slip"}),
}  # fmt: skip


@pytest.mark.parametrize("case", MISSING)
def test_never_identified(case):
    """With the true effect and its mimics taken out of the library the verdict admits that something is not explained."""
    kind, effect, out = MISSING[case]
    campaign = made([effect], kind, one_sided(RICH) if kind == "tension" else RICH, n=40, seed=2)
    known = [e for e in library() if e.name not in out]
    findings = explain(BenchModel(campaign.section), campaign, library=known)
    assert findings.verdict != "identified"
    if findings.verdict == "unknown":
        assert findings.effects == findings.confusable == ()
        assert findings.closest is not None and 0 <= findings.closest[1] < 0.95
    assert findings.verdict != "none"
