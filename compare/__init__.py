"""Measurements beside the model: campaigns in, misfit over the noise floor out.

>>> campaign = Campaign.read("my-campaign")                          # doctest: +SKIP
>>> comparison = compare(BenchModel(campaign.section), campaign)     # doctest: +SKIP
>>> plot_comparison(comparison, "out")                               # doctest: +SKIP
"""

from compare.bench_model import BenchModel
from compare.calibration import CalibratedValue, Calibration, calibrate
from compare.campaign import Campaign
from compare.comparison import ChannelFit, Comparison, compare
from compare.comparison_plot import plot_comparison
from compare.experiment import Channel, Experiment, Record
from compare.noise_covariance import NoiseCovariance
from compare.noise_floor import NoiseModel, measure_noise
from compare.nominal_section import BenchSection, NominalSection

__all__ = [
    "BenchModel",
    "BenchSection",
    "CalibratedValue",
    "Calibration",
    "Campaign",
    "Channel",
    "ChannelFit",
    "Comparison",
    "Experiment",
    "NoiseCovariance",
    "NoiseModel",
    "NominalSection",
    "Record",
    "calibrate",
    "compare",
    "measure_noise",
    "plot_comparison",
]
