"""Measurements beside the model: campaigns in, misfit over the noise floor out.

>>> campaign = Campaign.read("my-campaign")                          # doctest: +SKIP
>>> comparison = compare(BenchModel(campaign.section), campaign)     # doctest: +SKIP
>>> plot_comparison(comparison, "out")                               # doctest: +SKIP
>>> findings = explain(BenchModel(campaign.section), campaign)       # doctest: +SKIP
>>> better = BenchModel(campaign.section).add(findings.effects)      # doctest: +SKIP
"""

from compare.bench_model import BenchModel
from compare.calibration import CalibratedValue, Calibration, calibrate
from compare.campaign import Campaign
from compare.comparison import ChannelFit, Comparison, compare
from compare.comparison_plot import plot_comparison
from compare.experiment import Channel, Experiment, Record
from compare.explain import explain, open_and_validate
from compare.findings import Check, Findings
from compare.noise_covariance import NoiseCovariance
from compare.noise_floor import NoiseModel, measure_noise
from compare.nominal_section import BenchSection, NominalSection
from compare.testability import check

__all__ = [
    "BenchModel",
    "BenchSection",
    "CalibratedValue",
    "Calibration",
    "Campaign",
    "Channel",
    "ChannelFit",
    "Check",
    "Comparison",
    "Experiment",
    "Findings",
    "NoiseCovariance",
    "NoiseModel",
    "NominalSection",
    "Record",
    "calibrate",
    "check",
    "compare",
    "explain",
    "measure_noise",
    "open_and_validate",
    "plot_comparison",
]
