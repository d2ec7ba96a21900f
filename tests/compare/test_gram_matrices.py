"""Gram matrices of whitened columns hold everything: fits, left-out scores and marginals equal those of dense covariances."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from made_bench import MODEL, RICH, blank, measured, refer, switched, white
from scipy.linalg import block_diag, toeplitz
from scipy.optimize import lsq_linear

from compare import NoiseCovariance, NoiseModel
from compare.bench_design import make_blocks
from compare.evidence import left_out, log_marginal
from compare.gram import Scan, energy

NOISE = NoiseCovariance(s=0.8, phi=0.6, gain=0.03, offset=0.5, white=0.4, contrasts=6)
TERMS = {
    "section": [switched("plasticity", "bending", (0.3,)), switched("viscous-damping", "bending")],
    "fixture": [switched("plasticity", "bending", (0.3,)), switched("backlash", "bending", (0.1,))],
    "filter": [switched("stiffening", "bending"), switched("sensor-lag", "bending", (0.4,), channel="moment")],
    "bias": [switched("sensor-drift", "bending", channel="moment"), switched("stiffening", "bending")],
}


@pytest.fixture(scope="module")
def block():
    experiments = blank("bending", RICH[:4], n=40)
    truth = refer([switched("plasticity", "bending", (0.2,), (0.3,))], experiments)
    campaign = measured(truth, experiments, white(0.02), seed=1)
    return make_blocks(campaign.experiments, MODEL, NoiseModel({("bending", "moment"): NOISE}, (), ()))[0]


def dense(signal, gain=NOISE.gain, offset=NOISE.offset):
    n = len(signal)
    C = NOISE.s**2 * toeplitz(NOISE.phi ** np.arange(n)) + NOISE.white**2 * np.eye(n)
    return C + gain**2 * np.outer(signal, signal) + offset**2


def signal_of(record):
    return MODEL.predict(record.experiment)["moment"]


def raw(record, terms):
    """Columns and target of a record that has one reading."""
    return np.column_stack([record.columns(terms)[0], record.readings[0].y])


@pytest.mark.parametrize("stage", TERMS)
def test_energy_is_the_whitened_residual(block, stage):
    """(x, -1) S (x, -1)^T = sum over the records of r^T C^-1 r, whatever stage the terms act in."""
    terms = TERMS[stage]
    grams = Scan(block, terms[:1]).candidate(terms[1])
    rng = np.random.default_rng(0)
    x = np.concatenate([[1.0], 0.2 * rng.normal(size=grams.P - 1)])
    residual = [raw(r, terms) @ [*x, -1.0] for r in block.records]
    expected = [
        sum(residual[i] @ np.linalg.solve(dense(signal_of(block.records[i])), residual[i]) for i in g)
        for g in block.groups
    ]
    np.testing.assert_allclose(energy(grams.S, x), expected, rtol=1e-9)  # of sums of squares after one factorization
    grid = Scan(block, terms[:1]).grid(terms[1], [terms[1].shape])
    np.testing.assert_allclose(grid.S[0], grams.S, rtol=1e-9, atol=1e-9 * np.abs(grams.S).max())


def test_shared_products_are_those_of_repeats(block):
    """X holds r_a^T C^-1/2 C^-1/2 r_b of different repeats only, scaled to all records of the group."""
    terms = TERMS["section"]
    grams = Scan(block, terms[:1]).candidate(terms[1])
    x = np.array([1.0, 0.2, 0.1])
    for g, members in enumerate(block.groups):
        a, b = (block.records[i].target - block.records[i].whitened(terms) @ x for i in members)
        assert energy(grams.X[g], x) == pytest.approx(2 * a @ b, rel=1e-9)
    assert grams.repeated.all() and grams.n.tolist() == [80] * 4


@pytest.mark.parametrize("pair", [(0.0, 0.0), (2.0, 0.0), (0.0, 8.0), (4.0, 1.0)])
def test_gain_and_offset_integrated_out(block, pair):
    """More scatter of gain and offset is a larger rank-2 term of C; the log determinant is that of C over C without it."""
    grams = Scan(block, ()).base()
    S, log_det = grams.scatter.marginal(grams.A, [pair])
    x = np.array([1.05])
    for g, members in enumerate(block.groups):
        square, det = 0.0, 0.0
        for i in members:
            m, r = signal_of(block.records[i]), raw(block.records[i], ()) @ [*x, -1.0]
            samples = dense(m, 0.0, 0.0)
            more = [f**2 / (u @ np.linalg.solve(samples, u)) for f, u in zip(pair, (m, np.ones(len(m))))]
            C = dense(m, np.sqrt(NOISE.gain**2 + more[0]), np.sqrt(NOISE.offset**2 + more[1]))
            square += r @ np.linalg.solve(C, r)
            det += np.linalg.slogdet(C)[1] - np.linalg.slogdet(samples)[1]
        assert energy(S[0, g], x) == pytest.approx(square, rel=1e-9)
        assert log_det[0, g] == pytest.approx(det, rel=1e-8)


@pytest.mark.parametrize("stage", ["section", "bias"])
def test_left_out_scores_are_refits(block, stage):
    """The score of a group left out is that of a fit to the white rows of all the others, prior and bounds included."""
    terms = TERMS[stage]
    grams = Scan(block, terms[:1]).candidate(terms[1])
    found = left_out(grams)
    mean, precision = grams.prior()
    Z, y = [r.whitened(terms) for r in block.records], [r.target for r in block.records]
    for g, members in enumerate(block.groups):
        rest = [i for i in range(len(Z)) if i not in members]
        rows = np.vstack([*[Z[i] for i in rest], np.diag(np.sqrt(precision))])
        target = np.concatenate([*[y[i] for i in rest], np.sqrt(precision) * mean])
        low = np.where(grams.positive, 0.0, -np.inf)
        x = lsq_linear(rows, target, (low, np.inf), method="bvls", tol=1e-14).x
        r = [y[i] - Z[i] @ x for i in members]
        assert found.square[g] == pytest.approx(sum(v @ v for v in r), rel=1e-7)  # fits by QR and normal equations
        assert found.shared[g] == pytest.approx(2 * r[0] @ r[1], rel=1e-6)


def test_left_out_shape_is_that_of_the_others(block):
    """Of several shapes the one that fits the other groups best is read on the group left out, not the one that fits it."""
    term = switched("plasticity", "bending")
    shapes = [(0.05,), (0.2,), (0.8,)]
    scan = Scan(block, ())
    grid = scan.grid(term, shapes)
    one_by_one = [scan.candidate(replace(term, shape=s)) for s in shapes]
    mean, _ = grid.prior()
    for g in range(len(block.groups)):
        costs = []
        for grams in one_by_one:
            others = grams.S.sum(axis=0) - grams.S[g]
            x = grams.fit(others)
            costs.append(energy(others, x) + np.sum(grams.prior()[1] * (x - mean) ** 2))
        k = int(np.argmin(costs))
        expected = left_out(one_by_one[k]).square[g]
        assert left_out(replace(grid, repeated=grid.repeated & False)).square[g] == pytest.approx(expected, rel=1e-9)


def test_marginal_likelihood_is_gaussian(block):
    """Over coefficients without bounds: ln N(y; Z mean, C + Z diag(1/precision) Z^T), the difference of two data sets."""
    terms = TERMS["bias"][:1]  # of either sign
    grams = Scan(block, ()).candidate(terms[0])
    mean, precision = grams.prior()
    assert not grams.positive.any()

    def log_density(members):
        Z = np.vstack([raw(block.records[i], terms)[:, :-1] for i in members])
        y = np.concatenate([block.records[i].readings[0].y for i in members])
        noise = block_diag(*[dense(signal_of(block.records[i])) for i in members])
        C, r = noise + Z @ np.diag(1 / precision) @ Z.T, y - Z @ mean
        without = -0.5 * np.linalg.slogdet(noise)[1]
        return -0.5 * r @ np.linalg.solve(C, r) - 0.5 * np.linalg.slogdet(C)[1] - without

    values = [float(log_marginal(grams, grams.S[g])) for g in range(4)]
    expected = [log_density(members) for members in block.groups]
    np.testing.assert_allclose([b - a for a, b in pairwise(values)], [b - a for a, b in pairwise(expected)], rtol=1e-8)
