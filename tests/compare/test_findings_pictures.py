"""Pictures of findings draw the numbers of the findings, and leave out what is not there."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from made_findings import made_findings

from compare.excess_plot import conditions_figure, covariates, loop_energy_figure, where_figure
from compare.findings import SetError
from compare.findings_plot import confusion_figure, errors_figure, path_figure, ranking_figure
from compare.residual_plot import autocorrelation, record_figure, whitened, worst_and_typical


@pytest.fixture(scope="module")
def findings():
    return made_findings("identified")


def test_autocorrelation_of_an_ar1_series_falls_by_phi_a_lag():
    rng = np.random.default_rng(3)
    x = np.zeros(200_000)
    e = rng.normal(size=x.size)
    for i in range(1, x.size):
        x[i] = 0.7 * x[i - 1] + e[i]
    np.testing.assert_allclose(autocorrelation(x, 4), 0.7 ** np.arange(5), atol=0.012)  # 4 / sqrt(n) of the sum


def test_the_whitened_residual_of_the_true_model_has_variance_one(findings):
    fit = findings.after.fits[0]
    values = np.concatenate([whitened(f, findings.after) for f in findings.after.fits])
    assert np.mean(values**2) == pytest.approx(1.0, abs=0.15)  # 1920 samples, noise known from repeats
    assert np.mean(whitened(findings.comparison.fits[0], findings.comparison) ** 2) > 10
    assert len(whitened(fit, findings.after)) == len(fit.measured)


def test_the_worst_record_is_that_with_the_largest_excess(findings):
    worst, typical = worst_and_typical(findings.comparison)
    assert worst.relative_excess == max(f.relative_excess for f in findings.comparison.fits)
    assert typical.relative_excess < worst.relative_excess


def test_a_record_shows_measurement_and_both_models(findings):
    fit = findings.comparison.fits[0]
    loop, residual, _, correlation = record_figure(fit, findings.comparison, findings.after, "friction").axes
    np.testing.assert_array_equal(loop.lines[0].get_ydata(), fit.measured)
    np.testing.assert_array_equal(loop.lines[1].get_ydata(), fit.model)
    np.testing.assert_array_equal(loop.lines[2].get_ydata(), findings.after.fits[0].model)
    np.testing.assert_array_equal(residual.lines[0].get_ydata(), fit.measured - fit.model)
    assert correlation.lines[0].get_ydata()[0] == 1.0
    alone = record_figure(fit, findings.comparison, findings.comparison, "")
    assert len(alone.axes[0].lines) == 2, "without effects there is one model"


def test_the_map_holds_the_excess_of_every_channel(findings):
    (axes,) = where_figure(findings).axes
    table = axes.images[0].get_array()
    assert table.shape == (12, 2)
    expected = sorted(f.relative_excess for f in findings.comparison.fits)
    np.testing.assert_allclose(np.sort(table[:, 0]), expected)


def test_only_what_varied_is_a_covariate(findings):
    found = covariates(findings)
    assert set(found) == {"amplitude of the curvature [1/m]", "mean rate of the curvature [1/m/s]", "axial tension [N]"}
    figure = conditions_figure(findings)
    np.testing.assert_array_equal(figure.axes[2].lines[0].get_xdata(), found["axial tension [N]"])


def test_bars_are_the_evidence_and_the_gate_is_drawn(findings):
    evidence, share = ranking_figure(findings).axes
    assert [p.get_width() for p in evidence.patches] == [c.log_e for c in findings.ranking]
    assert [p.get_width() for p in share.patches] == pytest.approx([max(100 * c.share, 0) for c in findings.ranking])
    assert evidence.lines[0].get_xdata()[0] == findings.ranking[0].needed
    assert evidence.get_yticklabels()[0].get_text() == "interlayer-friction (accepted)"


def test_a_tied_set_is_hatched_and_named():
    evidence, _ = ranking_figure(made_findings("confusable")).axes
    assert [bool(p.get_hatch()) for p in evidence.patches] == [True, True, False, False]
    assert evidence.get_yticklabels()[1].get_text() == "plasticity (in the set)"


def test_the_path_goes_from_the_base_model_to_the_last_step(findings):
    (axes,) = path_figure(findings).axes
    assert list(axes.lines[0].get_ydata()) == [3.1, 1.02]


def test_every_set_has_its_before_and_after(findings):
    sealed = replace(findings, errors={**findings.errors, "sealed": SetError(3.0, 1.1)})
    (axes,) = errors_figure(sealed).axes
    assert [t.get_text() for t in axes.get_yticklabels()] == ["calibrate", "validate", "sealed"]
    ends = [
        tuple(line.get_xdata()) for line in axes.lines if len(line.get_xdata()) == 2 and line.get_linestyle() == "-"
    ]
    assert ends == [(3.1, 1.02), (3.4, 1.05), (3.0, 1.1)]


def test_confusion_is_in_per_cent_and_the_diagonal_is_blank(findings):
    (axes,) = confusion_figure(findings.separation).axes
    np.testing.assert_allclose(axes.images[0].get_array(), 100 * findings.separation.confusion)
    assert [t.get_text() for t in axes.texts] == ["31", "31"]
    assert len(axes.patches) == 4


def test_loops_are_drawn_at_their_amplitude(findings):
    measured = loop_energy_figure(findings).axes[0].lines[0]
    assert set(np.round(measured.get_xdata(), 1)) == {0.3, 0.8, 1.2, 1.6}
    assert np.all(measured.get_ydata() > 0)
