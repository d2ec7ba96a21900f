"""What experiments can show: distances are those of projections, and what no condition moves cannot be found."""

from dataclasses import replace
from statistics import NormalDist

import numpy as np
import pytest
from made_bench import MODEL, RICH, blank, made, measured, one_sided, refer, switched, white

from compare import BenchModel, NoiseCovariance, NoiseModel, check, explain
from compare.bench_design import make_blocks
from compare.testability import SEEN, SIZE, signatures
from compare.testability import testability as shown_by
from effects.library import find, library

NOISE = NoiseModel({("bending", "moment"): NoiseCovariance(s=1.0, phi=0.3, gain=0.01, offset=0.2)}, (), ())


@pytest.fixture(scope="module")
def block():
    campaign = measured(MODEL, blank("bending", RICH[:5], 40), white(0.01), seed=1)
    return make_blocks(campaign.experiments, MODEL, NOISE)[0]


def dense_root(record):
    """W with W^T W = C^-1, from the dense covariance."""
    noise, m = NOISE.by_channel["bending", "moment"], MODEL.predict(record.experiment)["moment"]
    n = len(m)
    lags = np.abs(np.subtract.outer(np.arange(n), np.arange(n)))
    C = noise.s**2 * noise.phi**lags + noise.gain**2 * np.outer(m, m) + noise.offset**2
    return np.linalg.inv(np.linalg.cholesky(C))


@pytest.mark.parametrize("name", ["stiffening", "viscous-damping", "thermal-softening", "tension-stiffening"])
def test_distance_is_that_of_a_projection(block, name):
    """D = |W c - its best fit by the base|, the change c scaled to 2 % of the rms of the linear load."""
    form = find(name).forms[0]
    W = [dense_root(r) for r in block.records]
    strain = [r.led.path.strain for r in block.records]
    K = MODEL.stiffness("EI")
    change = [K * np.reshape(form.respond(r.led.path), (-1,)) for r in block.records]
    scale = SIZE * np.sqrt(sum(K**2 * s @ s for s in strain) / sum(c @ c for c in change))
    base = np.concatenate([w @ (K * s) for w, s in zip(W, strain)])
    c = scale * np.concatenate([w @ v for w, v in zip(W, change)])
    left = c - base * (base @ c) / (base @ base)
    found = signatures(block, 0, [find(name)])[0]
    assert found.D == pytest.approx(np.linalg.norm(left), rel=1e-8)


def test_pair_distance_is_left_after_the_rival(block):
    """D_ij is what no multiple of the rival in any of its tried shapes can take away; equal laws have the distance 0."""
    names = ["stiffening", "direction-asymmetry", "interlayer-friction", "plasticity"]
    separation, _, _, D = shown_by([block], [find(n) for n in names])
    i, j = separation.effects.index("stiffening"), separation.effects.index("direction-asymmetry")
    one, rival = (signatures(block, 0, [find(n)])[0].columns for n in ("stiffening", "direction-asymmetry"))
    c = one[:, np.argmax(np.sum(one**2, axis=0))]
    left = min(np.linalg.norm(c - v * (v @ c) / (v @ v)) for v in rival.T)
    assert separation.confusion[i, j] == pytest.approx(NormalDist().cdf(-left / 2), rel=1e-6, abs=1e-12)
    assert np.all(np.diag(separation.confusion) == 0.5)
    same = replace(find("stiffening"), name="twin")
    tied, _, _, _ = shown_by([block], [find("stiffening"), same])
    np.testing.assert_allclose(tied.confusion, 0.5, atol=1e-6)
    assert set(D) == set(names)


PLANS = {
    "thermal-softening": ({"temperature": 293.15}, "all experiments at 20 degC"),
    "tension-stiffening": ({"tension": 1000.0}, "all experiments at an axial tension of 1000 N"),
}


@pytest.mark.parametrize("name", PLANS)
def test_a_condition_that_never_varies(name):
    """What a single temperature or tension cannot show is untestable, and the sentence gives its value."""
    fixed, sentence = PLANS[name]
    campaign = made([], "bending", [replace(c, **fixed) for c in RICH], n=40)
    found = check(BenchModel(campaign.section), campaign)
    why = {u.effect: u.why for u in found.untestable}
    assert why[name].startswith(sentence) and name not in found.smallest_seen
    rich = made([], "bending", RICH, n=40)
    assert name in check(BenchModel(rich.section), rich).smallest_seen


def test_what_the_kind_of_experiment_cannot_show():
    """One length, one side, no other load: sentences, not silence; and every effect is on one side or the other."""
    plan = [replace(c, length=1.0) for c in one_sided(RICH)]
    campaign = made([], "tension", plan, n=40)
    found = check(BenchModel(campaign.section), campaign)
    why = {u.effect: u.why for u in found.untestable}
    assert "long" in why["end-load-introduction"] and "long" in why["rig-compliance"]
    assert "direction" in why["direction-asymmetry"]
    assert "not recorded" in why["tension-torsion-coupling"]
    assert "torsion, bending" in why["tension-stiffening"]
    assert set(why) | set(found.smallest_seen) == {e.name for e in library()}
    assert not set(why) & set(found.smallest_seen)


def test_untestable_is_never_named():
    """An effect that the design cannot show is not named, also where it is the truth: one temperature, softened by it."""
    plan = [replace(c, temperature=333.15) for c in RICH]
    effect = switched("thermal-softening", "bending", (), (0.005,))
    experiments = blank("bending", plan, 40)
    truth = refer([effect], experiments)
    truth = replace(
        truth,
        effects=tuple(replace(a, reference=replace(a.reference, typical_temperature=293.15)) for a in truth.effects),
    )
    campaign = measured(truth, experiments, white(0.01), seed=4)
    findings = explain(BenchModel(campaign.section), campaign)
    assert findings.verdict == "none"
    assert "thermal-softening" in {u.effect for u in findings.untestable}


def test_confounded_conditions_are_flagged():
    """A rig that slows down with amplitude ties rate to amplitude; the sentence names both. Apart they are not flagged."""
    slow = [replace(c, amplitude=a, period=40 * a**2) for c, a in zip(RICH, np.linspace(0.3, 1, 8))]
    tied = check(MODEL, made([], "bending", slow, n=40)).separation.confounded
    assert any("amplitude" in s and "rate" in s and "-" in s for s in tied)
    free = check(MODEL, made([], "bending", RICH, n=40)).separation.confounded
    assert not any("amplitude" in s and "rate" in s for s in free)


@pytest.mark.parametrize("name", ["stiffening", "viscous-damping", "plasticity"])
def test_seen_from_the_size_that_is_stated(name):
    """An effect of three times the smallest size seen is found, one of a fifth of it is not."""
    shape = (0.3,) if name == "plasticity" else ()
    experiments = blank("bending", RICH, 40)
    quiet = measured(MODEL, experiments, white(0.05), seed=2)
    block = make_blocks(quiet.experiments, MODEL, explain(MODEL, quiet, library=[find("sensor-lag")]).comparison.noise)[
        0
    ]
    _, _, smallest, D = shown_by([block], [find(name)])
    seen = SIZE * SEEN / D[name]
    assert float(smallest[name].split(" %")[0]) == pytest.approx(100 * seen, rel=0.05)  # printed with two digits
    term = switched(name, "bending", shape)
    columns = [np.reshape(term.form.respond(r.led.path, *shape), (-1,)) for r in block.records]
    load = np.sqrt(sum(r.led.path.strain @ r.led.path.strain for r in block.records))
    per_strength = np.sqrt(sum(c @ c for c in columns)) / load
    named = []
    for factor in (0.2, 3.0):
        truth = refer([replace(term, strength=(factor * seen / per_strength,))], experiments)
        campaign = measured(truth, experiments, white(0.05), seed=3)
        findings = explain(MODEL, campaign)
        named.append(findings.effects + findings.confusable)
    assert named[0] == () and name in named[1]
