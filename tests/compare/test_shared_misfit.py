"""The misfit that repeats share: its expectation is the energy of the misfit alone, whatever the noise is."""

import numpy as np
import pytest
from made_bench import MODEL, RICH, blank, measured

from compare import NoiseCovariance, NoiseModel
from compare.bench_design import make_blocks
from compare.shared_misfit import shared_misfit

BELIEVED = 1.0  # N m, the noise that the model believes in
RUNS = 120


def student(rng, n):
    return rng.standard_t(3, size=n) / np.sqrt(3.0)


def correlated(rng, n):
    e = rng.normal(size=n + 30)
    for t in range(1, n + 30):
        e[t] = 0.5 * e[t - 1] + np.sqrt(0.75) * e[t]
    return e[30:]


DRAW = {
    "as believed": lambda rng, n: BELIEVED * rng.normal(size=n),
    "three times as large": lambda rng, n: 3 * BELIEVED * rng.normal(size=n),
    "heavy tails": lambda rng, n: BELIEVED * student(rng, n),
    "correlated": lambda rng, n: BELIEVED * correlated(rng, n),
}


def found(draw, size, seed, repeats=2, n=96):
    """Shared misfit of the true linear model where a wave of that size [N m] is missing, and the energy of the wave."""
    rng = np.random.default_rng(seed)
    experiments = blank("bending", RICH[:6], n=n, repeats=repeats)
    wave = size * np.sin(np.linspace(0, 20, n))
    campaign = measured(MODEL, experiments, None, 0)
    for e in campaign.experiments:
        e.record.channels["moment"].values[:] += wave + draw(rng, n)
    noise = NoiseModel({("bending", "moment"): NoiseCovariance(s=BELIEVED)}, (), ())
    block = make_blocks(campaign.experiments, MODEL, noise)
    energy = len(experiments) * wave @ wave / BELIEVED**2
    return shared_misfit(block, ((),), [np.ones(1)]), energy


@pytest.mark.parametrize("noise", DRAW)
def test_expectation_is_the_energy_of_the_misfit(noise):
    """E T = sum of the squared white misfit, with noise of another size, shape or correlation than the model believes."""
    draws = [found(DRAW[noise], 1.5, seed) for seed in range(RUNS)]
    T, energy = np.array([d.T for d, _ in draws]), draws[0][1]
    error = T.std() / np.sqrt(RUNS)
    assert abs(T.mean() - energy) < 3.5 * error
    assert error < 0.05 * energy  # the test can see a twentieth


@pytest.mark.parametrize("noise", DRAW)
def test_standard_deviation_holds(noise):
    """Where nothing is missing T over its own standard deviation is about standard normal, so that z > 3 is rare."""
    z = np.array([found(DRAW[noise], 0.0, seed)[0].z for seed in range(RUNS)])
    assert abs(z.mean()) < 3.5 / np.sqrt(RUNS)
    assert 0.75 < z.std() < 1.25  # 120 draws know it within 7 %; correlation over one run of 12 is cut at its ends
    assert np.count_nonzero(z > 3) <= 2  # 0.16 expected of a normal, a few times that of a ratio


def test_without_repeats():
    """Without repeats T is the square residual less what the assumed noise gives, with the scatter of chi-square."""
    draws = [found(DRAW["as believed"], 0.5, seed, repeats=1) for seed in range(RUNS)]
    T, energy = np.array([d.T for d, _ in draws]), draws[0][1]
    assert not draws[0][0].from_repeats
    assert abs(T.mean() - energy) < 3.5 * T.std() / np.sqrt(RUNS)
    assert draws[0][0].std == pytest.approx(np.sqrt(2 * 6 * 96))
    assert draws[0][0].F == pytest.approx(1 + draws[0][0].T / (6 * 96))


def test_four_repeats_count_every_pair():
    """With k repeats all k (k - 1)/2 pairs enter, scaled to the readings of all k records."""
    one, energy = found(lambda rng, n: np.zeros(n), 0.5, 0, repeats=4)
    assert one.T == pytest.approx(energy, rel=1e-12)
    assert one.n == 4 * 6 * 96
