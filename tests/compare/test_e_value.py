"""Evidence: an e-value is at most 1 on average where nothing is missing, and grows with what is missing."""

from dataclasses import replace

import numpy as np
import pytest
from made_bench import MODEL, RICH, blank, refer, switched

from compare import NoiseCovariance, NoiseModel
from compare.bench_design import make_blocks
from compare.evidence import Null, log_e_value, log_marginal, splits
from compare.form_fit import shape_grid
from compare.gram import Scan

S = 0.5  # N m
KNOWN = NoiseCovariance(s=S, phi=0.4, gain=0.005, offset=0.2, contrasts=6)
SAMPLES_ONLY = NoiseCovariance(s=S, contrasts=6)
TRIED = ("stiffening", "viscous-damping", "thermal-softening", "backlash")
RUNS = 70


def block_of(rng, truth=MODEL, noise=KNOWN, group_gain=0.0, group_offset=0.0):
    """Six conditions in pairs; records of one group may share a gain and an offset that their difference cannot show."""
    experiments = blank("bending", RICH[:6], n=40)
    done, shared = [], (0.0, 0.0)
    for e in experiments:
        y = truth.predict(e)["moment"]
        if e.repeat_of is None:
            shared = (group_gain * rng.normal(), group_offset * rng.normal())
        wave = np.empty(len(y))
        wave[0] = rng.normal()
        for t in range(1, len(y)):
            wave[t] = noise.phi * wave[t - 1] + np.sqrt(1 - noise.phi**2) * rng.normal()
        own = (shared[0] + noise.gain * rng.normal()) * y + shared[1] + noise.offset * rng.normal()
        channels = {
            **e.record.channels,
            "moment": replace(e.record.channels["moment"], values=y + noise.s * wave + own),
        }
        done.append(replace(e, table=replace(e.record, channels=channels)))
    return make_blocks(done, MODEL, NoiseModel({("bending", "moment"): noise}, (), ()))[0]


def log_e(block, name):
    term = switched(name, "bending")
    scan, shapes = Scan(block, ()), shape_grid(term.form, block)
    grid = scan.grid(replace(term, shape=shapes[0]), shapes)
    return log_e_value(grid, Null.of(scan.base()), splits(len(block.groups)))


@pytest.fixture(scope="module")
def nulls():
    """log e of every effect tried on many campaigns in which nothing is missing."""
    rng = np.random.default_rng(5)
    return np.array([[log_e(block, name) for name in TRIED] for block in (block_of(rng) for _ in range(RUNS))])


def test_mean_is_at_most_one(nulls):
    """E e <= 1 under the null, so that P(e > 1/alpha) <= alpha, for each effect, from campaigns with known covariance."""
    e = np.exp(nulls)
    for column in e.T:
        assert column.mean() <= 1 + 3 * column.std() / np.sqrt(RUNS)
    for alpha in (0.5, 0.1, 0.01):
        allowed = alpha + 3 * np.sqrt(alpha * (1 - alpha) / RUNS)
        assert np.all(np.mean(e > 1 / alpha, axis=0) <= allowed)


def test_is_not_empty_of_power(nulls):
    """The bound is not kept by an e-value that is always nothing: what may be zero loses no more than a few nats.

    Backlash, whose search begins at a play of 1 % of the path, predicts something that is not there and loses more.
    """
    middle = dict(zip(TRIED, np.median(nulls, axis=0)))
    assert middle.pop("backlash") < -10
    assert all(-6 < value < 0 for value in middle.values())


@pytest.mark.parametrize(
    ("name", "shape"), [("stiffening", ()), ("viscous-damping", ()), ("backlash", (0.1,)), ("thermal-softening", ())]
)
def test_grows_with_the_effect(name, shape):
    """Evidence grows with the size of what is missing, and passes any gate."""
    whole = {"stiffening": 0.1, "viscous-damping": 0.1, "backlash": 0.1, "thermal-softening": 0.01}[name]
    found = []
    for size in (0.0, 0.1, 0.3, 1.0):
        effects = [switched(name, "bending", tuple(size * v for v in shape), () if shape else (size * whole,))]
        truth = refer(effects, blank("bending", RICH[:6], n=40)) if size else MODEL
        found.append(log_e(block_of(np.random.default_rng(11), truth), name))
    assert np.all(np.diff(found) > 0)
    assert found[0] < 0 and found[-1] > 10


@pytest.mark.parametrize("scatter", ["gain", "offset"])
def test_scatter_that_repeats_cannot_see(scatter):
    """Specimens that differ between conditions, where both repeats are of one specimen, do not make an effect.

    The null may call all that gain or offset; so no effect passes the gate of one in hundred over eighteen.
    """
    rng = np.random.default_rng(17)
    size = {"gain": {"group_gain": 0.03}, "offset": {"group_offset": 2.0}}[scatter]
    worst = max(
        log_e(block, name)
        for block in (block_of(rng, noise=SAMPLES_ONLY, **size) for _ in range(12))
        for name in ("thermal-softening", "tension-stiffening", "direction-asymmetry", "stiffening", "cyclic-softening")
    )
    assert worst < np.log(18 / 0.01)


def test_halves_of_normals():
    """A strength that may not be negative has a half-normal prior: its marginal is the integral over the positive side."""
    truth = refer([switched("stiffening", "bending", (), (0.002,))], blank("bending", RICH[:6], n=40))
    block = block_of(np.random.default_rng(2), truth)
    grams = Scan(block, ()).candidate(switched("stiffening", "bending"))
    mean, precision = grams.prior()
    assert grams.positive.tolist() == [False, True]
    A = grams.S.sum(axis=0)
    a = np.linspace(0.0, 0.05, 20001)  # far beyond the posterior

    def log_integral(S):
        """ln of the integral over the strength of exp of the log density with the stiffness integrated out."""
        p0 = S[0, 0] + precision[0]
        b = S[0, 2] + precision[0] * mean[0] - a * S[0, 1]
        square = S[2, 2] + precision[0] * mean[0] ** 2 - 2 * a * S[1, 2] + a**2 * (S[1, 1] + precision[1])
        log_f = -0.5 * (square - b**2 / p0) + 0.5 * np.log(precision[0] / p0)
        top = log_f.max()
        return top + np.log(np.trapezoid(np.exp(log_f - top), a) * 2 * np.sqrt(precision[1] / (2 * np.pi)))

    assert float(log_marginal(grams, A)) == pytest.approx(log_integral(A), rel=1e-6)


def test_splits_are_parts():
    """Every split keeps something to learn from and something to predict; none is counted twice."""
    for groups in range(2, 12):
        parts = splits(groups)
        assert np.all(parts.any(axis=1)) and not np.any(parts.all(axis=1))
        assert len(np.unique(parts, axis=0)) == len(parts)
