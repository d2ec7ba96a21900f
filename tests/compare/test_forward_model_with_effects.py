"""The forward model with effects: the four stages in their order, the linear model where nothing acts, and load control."""

from dataclasses import replace

import numpy as np
import pytest
from made_bench import MODEL, RICH, blank, measured, one_sided, refer, switched

from compare import Channel, NoiseCovariance, NoiseModel, NominalSection, Record
from compare.bench_design import make_blocks
from compare.bench_model import BenchModel

NOISE = NoiseCovariance(s=1.0)
MIXES = {
    "section": ("bending", [switched("interlayer-friction", "bending", (0.3, 0.8), (0.4,)),
                            switched("viscoelasticity", "bending", (3.0,), (0.2,))]),
    "fixture, section": ("bending", [switched("backlash", "bending", (0.2,)),
                                     switched("plasticity", "bending", (0.3,), (0.5,))]),
    "filter, section, bias": ("bending", [switched("sensor-lag", "bending", (0.7,), channel="moment"),
                                          switched("stiffening", "bending", (), (0.3,)),
                                          switched("sensor-offset", "bending", (), (2.0,), channel="moment")]),
    "cross": ("tension", [switched("tension-torsion-coupling", "tension", (), (0.003,)),
                          switched("slack", "tension", (8e-4,), (0.5,)),
                          switched("sensor-drift", "tension", (), (0.01,), channel="torque")]),
    "all": ("shear", [switched("grip-slip", "shear", (0.3, 0.04)), switched("cyclic-softening", "shear", (0.05,), (0.3,)),
                      switched("sensor-lag", "shear", (0.7,), channel="force"),
                      switched("sensor-drift", "shear", (), (0.2,), channel="force")]),
}  # fmt: skip


def experiments_of(kind, n=60):
    plan = one_sided(RICH[:4]) if kind == "tension" else RICH[:4]
    return blank(kind, plan, n, repeats=1, also=("torque",) if kind == "tension" else ())


@pytest.mark.parametrize("mix", MIXES)
def test_equals_the_columns_times_strengths(mix):
    """What is predicted is the sum of the columns that the search fits, so that what was found is what is predicted."""
    kind, effects = MIXES[mix]
    experiments = experiments_of(kind)
    model = refer(effects, experiments)
    noise = NoiseModel({(kind, c): NOISE for c in ("moment", "force", "torque")}, (), ())
    block = make_blocks(experiments, MODEL, noise)[0]
    x = np.concatenate([np.ones(len(block.base)), *[a.strength for a in effects]])
    for record in block.records:
        predicted = model.predict(record.experiment)
        for reading, Z in zip(record.readings, record.columns(effects)):
            y = predicted[reading.channel]
            np.testing.assert_allclose(Z @ x, y, rtol=0, atol=1e-12 * np.abs(y).max())


@pytest.mark.parametrize("mix", MIXES)
def test_nothing_is_the_linear_model(mix):
    """With strengths of zero, fixtures and filters with shapes of zero, every reading is that of the linear model."""
    kind, effects = MIXES[mix]
    off = [
        replace(a, strength=(0.0,) * len(a.strength), shape=a.shape if a.form.strength else (0.0,) * len(a.shape))
        for a in effects
    ]
    experiments = experiments_of(kind)
    model = refer(off, experiments)
    for e in experiments:
        base = MODEL.predict(e)
        for channel, y in model.predict(e).items():
            np.testing.assert_array_equal(y, base[channel])


def load_driven(e, load):
    """The same experiment with its load prescribed and its path measured."""
    record = e.record
    channels = {**record.channels, "moment": Channel("moment", "N m", load)}
    table = Record(record.time, "moment", ("curvature",), channels)
    return replace(e, control="moment", table=table)


LAWS = {
    "friction": switched("interlayer-friction", "bending", (0.3, 0.8), (0.6,)),
    "plasticity": switched("plasticity", "bending", (0.2,), (1.0,)),
    "viscoelasticity": switched("viscoelasticity", "bending", (3.0,), (0.4,)),
    "stiffening": switched("stiffening", "bending", (), (0.4,)),
    "softening": switched("cyclic-softening", "bending", (0.5,), (0.4,)),
}


@pytest.mark.parametrize("law", LAWS)
def test_load_control_inverts(law):
    """The load that a path causes, prescribed, brings back that path: one law, read in both directions."""
    experiments = blank("bending", RICH, 80, repeats=1)
    model = refer([LAWS[law]], experiments)
    for e in experiments:
        driven = load_driven(e, model.predict(e)["moment"])
        path = model.predict(driven)["curvature"]
        np.testing.assert_allclose(
            path, e.record["curvature"], rtol=0, atol=1e-7
        )  # of 1 1/m: 100 x the rest of the rounds


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("cut", [17, 40, 63])
def test_a_record_in_two_parts_is_the_whole(law, cut):
    """What goes on where another record ended knows what came before: a cut changes no reading."""
    whole = blank("bending", RICH[:1], 80, repeats=1)[0]
    model = refer([LAWS[law]], [whole])

    def part(id, rows, continues=None):
        channels = {k: replace(c, values=c.values[rows]) for k, c in whole.record.channels.items()}
        table = replace(whole.record, time=whole.record.time[rows], channels=channels)
        return replace(whole, id=id, continues=continues, table=table)

    first, second = part("one", slice(None, cut)), part("two", slice(cut, None), "one")
    expected = model.predict(whole)["moment"]
    parts = [model.predict(e, [first, second])["moment"] for e in (first, second)]
    np.testing.assert_allclose(np.concatenate(parts), expected, rtol=0, atol=1e-10 * np.abs(expected).max())


def test_noise_free_truth_has_no_residual():
    """The columns fit what the model predicts without noise: nothing is left at the true shapes."""
    kind, effects = MIXES["filter, section, bias"]
    experiments = experiments_of(kind)
    campaign = measured(refer(effects, experiments), experiments, None, 0)
    block = make_blocks(campaign.experiments, MODEL, NoiseModel({(kind, "moment"): NOISE}, (), ()))[0]
    Z = np.vstack([r.whitened(effects) for r in block.records])
    y = np.concatenate([r.target for r in block.records])
    x = np.linalg.lstsq(Z, y)[0]
    np.testing.assert_allclose(x, [1.0, 0.3, 2.0], rtol=1e-9)
    assert np.abs(Z @ x - y).max() < 1e-9 * np.abs(y).max()


def test_section_without_coupling_reads_no_torque():
    """The torque of a tension test is zero in a section without coupling, until the effect gives one."""
    e = experiments_of("tension")[0]
    assert not MODEL.predict(e)["torque"].any()
    coupled = BenchModel(NominalSection({"EA": 4e5, "GA": 1.6e5, "EI": 95.0, "GJ": 60.0}))
    model = refer([switched("tension-torsion-coupling", "tension", (), (0.003,))], [e], coupled)
    strain = e.record["strain"]
    np.testing.assert_allclose(model.predict(e)["torque"], 4e5 * 0.003 * strain, rtol=1e-12)
