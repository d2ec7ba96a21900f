"""C = s^2 AR1(phi) + g^2 m m^T + b^2 1 1^T: the O(n) formulas agree with the dense matrix written out."""

from __future__ import annotations

import numpy as np
import pytest

from compare import NoiseCovariance
from compare.noise_likelihood import Contrast, _Columns, _with_record_scatter, fit_noise
from geometry.errors import InputError

N = 37
M = 3 * np.sin(np.linspace(0, 7, N)) + 0.5
CASES = [(0.5, 0.6, 0.3, 0.2), (1.0, 0.0, 0.0, 0.0), (2.0, -0.4, 0.0, 3.0), (0.1, 0.95, 0.2, 0.0)]


def dense(s: float, phi: float, gain: float, offset: float) -> np.ndarray:
    lag = np.abs(np.subtract.outer(np.arange(N), np.arange(N)))
    return s**2 * phi**lag + gain**2 * np.outer(M, M) + offset**2


@pytest.mark.parametrize("case", CASES)
def test_agrees_with_the_dense_matrix(case):
    C, noise = dense(*case), NoiseCovariance(*case)
    x = np.random.default_rng(1).normal(size=N)
    # all are sums of 37 terms in double precision
    white = noise.whiten(x, M)
    assert white @ white == pytest.approx(x @ np.linalg.solve(C, x), rel=1e-10)
    assert noise.log_determinant(M) == pytest.approx(np.linalg.slogdet(C)[1], rel=1e-10, abs=1e-10)
    assert noise.floor(M) ** 2 == pytest.approx(np.trace(C) / N, rel=1e-12)
    assert noise.mean_std(M) == pytest.approx(np.sqrt(C.sum()) / N, rel=1e-12)


@pytest.mark.parametrize("case", CASES)
def test_whitened_covariance_is_the_identity(case):
    K = NoiseCovariance(*case).whiten(np.eye(N), M)
    np.testing.assert_allclose(K @ dense(*case) @ K.T, np.eye(N), atol=1e-9)  # condition of C times eps


def test_maximum_likelihood_finds_the_peak_of_the_dense_density(draw_noise):
    """No neighbour of the fitted covariance is more likely, judged by the dense matrix."""
    rng = np.random.default_rng(5)
    contrasts = [Contrast(draw_noise(rng, M, 0.4, 0.5, 0.1, 0.3), M) for _ in range(12)]

    def log_density(s, phi, gain, offset):
        C = dense(s, phi, gain, offset)
        return sum(-0.5 * (c.d @ np.linalg.solve(C, c.d) + np.linalg.slogdet(C)[1]) for c in contrasts)

    fit = fit_noise(contrasts)
    best = np.array([fit.s, fit.phi, fit.gain, fit.offset])
    assert (best > 0).all()
    for k in range(4):
        for step in (0.97, 1.03):
            beside = best.copy()
            beside[k] *= step
            assert log_density(*beside) < log_density(*best)


def test_maximum_likelihood_recovers_the_noise_on_average(draw_noise):
    """Mean over 30 campaigns of 8 contrasts lies within three standard errors of the truth."""
    rng = np.random.default_rng(20)
    m = 100 * np.sin(np.linspace(0, 12, 200))
    truth = np.array([1.0, 0.6, 0.02**2, 0.8**2])
    found = []
    for _ in range(30):
        fit = fit_noise([Contrast(draw_noise(rng, m, 1.0, 0.6, 0.02, 0.8), m) for _ in range(8)])
        found.append([fit.s, fit.phi, fit.gain**2, fit.offset**2])
    error = np.std(found, axis=0, ddof=1) / np.sqrt(len(found))
    assert (np.abs(np.mean(found, axis=0) - truth) < 3 * error).all()
    # 240 draws cannot give a variance better than sqrt(2/240) = 9 %; a blunt estimator would be far above
    assert (error < 0.14 * truth).all()


def test_white_noise_is_not_given_a_gain_or_an_offset(draw_noise):
    rng = np.random.default_rng(3)
    m = 50 * np.sin(np.linspace(0, 9, 300))
    fit = fit_noise([Contrast(draw_noise(rng, m, 2.0), m) for _ in range(8)])
    # gain and offset of a record are seen to s / |m| and s / sqrt n at best; twice that is the bound
    assert fit.gain < 2 * 2.0 / np.linalg.norm(m) and fit.offset < 2 * 2.0 / np.sqrt(300)
    assert abs(fit.phi) < 3 / np.sqrt(8 * 300) and fit.s == pytest.approx(2.0, rel=3 / np.sqrt(2 * 8 * 300))


def test_identical_repeats_teach_nothing():
    with pytest.raises(InputError, match="cannot be learnt"):
        fit_noise([Contrast(np.zeros(N), M)])


def test_impossible_covariance_is_refused():
    with pytest.raises(InputError, match="phi = 1"):
        NoiseCovariance(s=1.0, phi=1.0)


@pytest.mark.parametrize("white", [0.05, 0.7, 4.0])
def test_white_part_agrees_with_the_dense_matrix(white):
    """C = s^2 A + w^2 I + g^2 m m^T + b^2 1 1^T."""
    case = (0.5, 0.9, 0.3, 0.2)
    C, noise = dense(*case) + white**2 * np.eye(N), NoiseCovariance(*case, white=white)
    x = np.random.default_rng(2).normal(size=N)
    # all are sums of 37 terms in double precision
    assert np.sum(noise.whiten(x, M) ** 2) == pytest.approx(x @ np.linalg.solve(C, x), rel=1e-10)
    assert noise.log_determinant(M) == pytest.approx(np.linalg.slogdet(C)[1], rel=1e-10, abs=1e-10)
    assert noise.floor(M) ** 2 == pytest.approx(np.trace(C) / N, rel=1e-12)
    assert noise.mean_std(M) == pytest.approx(np.sqrt(C.sum()) / N, rel=1e-12)
    np.testing.assert_allclose(noise.whiten(noise.whiten(C, M).T, M), np.eye(N), atol=1e-9)  # condition times eps


def test_slopes_by_gain_and_offset_are_those_of_the_deviance(draw_noise):
    """d deviance / d ln gamma in closed form is the central difference of the deviance."""
    rng = np.random.default_rng(8)
    columns = _Columns.of([Contrast(draw_noise(rng, M, 0.4, 0.5, 0.1, 0.3), M) for _ in range(3)], 1.0)
    P, log_det = columns.products(0.4, 0.6)
    gamma, beta, h = 0.3, 0.8, 1e-5
    factors = np.exp(h * np.array([0.0, 1.0, -1.0, 0.0, 0.0])), np.exp(h * np.array([0.0, 0.0, 0.0, 1.0, -1.0]))
    at = _with_record_scatter(P, log_det, gamma * factors[0], beta * factors[1], len(columns.V))
    # differences of numbers of size 100 over 2e-5, second-order accurate
    assert at.by_gain[0] == pytest.approx((at.deviance[1] - at.deviance[2]) / (2 * h), rel=1e-6)
    assert at.by_offset[0] == pytest.approx((at.deviance[3] - at.deviance[4]) / (2 * h), rel=1e-6)
    C = dense(1.0, 0.4, gamma, beta) + 0.6**2 * np.eye(N)
    d = columns.V[:, 0].reshape(3, N)
    square = float(np.sum(d * np.linalg.solve(C, d.T).T))
    assert at.deviance[0] == pytest.approx(3 * N * np.log(square / (3 * N)) + 3 * np.linalg.slogdet(C)[1], rel=1e-10)


def test_maximum_likelihood_recovers_the_white_part_on_average(draw_noise):
    """A slow drift read with white noise; means over 20 campaigns lie within three standard errors of the truth."""
    rng = np.random.default_rng(21)
    m = 100 * np.sin(np.linspace(0, 12, 200))
    truth = np.array([0.5, 1.0])
    found = []
    for _ in range(20):
        d = [draw_noise(rng, m, 0.5, 0.95, 0.005, 0.3) + rng.normal(0, 1.0, m.size) for _ in range(8)]
        fit = fit_noise([Contrast(x, m) for x in d])
        found.append([fit.s**2, fit.white**2, fit.phi])
    error = np.std(found, axis=0, ddof=1) / np.sqrt(len(found))
    assert (np.abs(np.mean(found, axis=0) - [*truth**2, 0.95]) < 3 * error).all()
    # 1600 samples give w^2 to 4 % and some 8 x 200 / 40 independent stretches s^2 to 25 %, over root 20 campaigns
    assert error[0] < 0.1 * truth[0] ** 2 and error[1] < 0.015 * truth[1] ** 2


def test_a_white_part_is_not_given_to_plain_ar_noise(draw_noise):
    rng = np.random.default_rng(4)
    m = 50 * np.sin(np.linspace(0, 9, 300))
    assert fit_noise([Contrast(draw_noise(rng, m, 2.0, 0.6), m) for _ in range(8)]).white == 0.0
