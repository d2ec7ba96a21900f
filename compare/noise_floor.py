"""The noise of every kind and channel: from repeats, from the stated sensors, or from the roughness of the data.

1. Repeats that were read (calibrate and validate) are the measure of the noise.
2. Without them the sensor uncertainty of campaign.toml, taken as independent from sample to sample.
3. Without that the second differences y_{t-1} - 2 y_t + y_{t+1}, whose variance is 6 s^2 for independent noise on a
smooth
   signal; the median of their size is not disturbed by the turning points.

2 and 3 are marked *assumed*: a gain or an offset of whole records cannot be seen there. Sealed experiments never enter,
also when they are open, so that opening them does not change the noise.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from compare.campaign import Campaign
from compare.experiment import Experiment
from compare.kinds import station
from compare.noise_covariance import NoiseCovariance
from compare.noise_likelihood import Contrast, fit_noise
from compare.repeats import Repeats, find_repeats

_NORMAL_MEDIAN = 0.6744897501960817  # median of |z| for a standard normal z
_RESOLUTION = 1e-6  # of the rms of a channel: below it a noise of zero is not believed, and squares lose their digits


@dataclass(frozen=True)
class NoiseModel:
    """Noise by (kind, channel), the repeats it was learnt from, and sentences on what could not be used."""

    by_channel: Mapping[tuple[str, str], NoiseCovariance]
    repeats: tuple[Repeats, ...]
    notes: tuple[str, ...]

    def of(self, experiment: Experiment, channel: str) -> NoiseCovariance:
        """Noise of one channel of one experiment."""
        return self.by_channel[experiment.kind, channel]


def measure_noise(campaign: Campaign) -> NoiseModel:
    """Noise of all channels that the readable experiments recorded."""
    known = [e for e in campaign.readable if e.set != "sealed"]
    repeats, notes = find_repeats(known)
    keys = dict.fromkeys((e.kind, channel) for e in campaign.readable for channel in e.record.measured)
    noise = {}
    for kind, channel in keys:
        contrasts = [
            d for r in repeats if r.experiments[0].kind == kind and channel in r.channels for d in r.contrasts(channel)
        ]
        records = [e for e in known if e.kind == kind and channel in e.record.measured]
        # a channel that only sealed experiments recorded has nothing else to be judged by, once they are open
        records = records or [e for e in campaign.readable if e.kind == kind and channel in e.record.measured]
        noise[kind, channel], note = _noise_of(kind, channel, contrasts, records, campaign.sensors)
        notes += note
    return NoiseModel(noise, tuple(repeats), tuple(notes))


def _noise_of(
    kind: str, channel: str, contrasts: list[Contrast], records: list[Experiment], sensors: Mapping[str, float]
) -> tuple[NoiseCovariance, list[str]]:
    values = [e.record[channel] for e in records]
    size = float(np.sqrt(np.mean(np.concatenate(values) ** 2))) or 1.0
    if contrasts and max(float(np.sqrt(np.mean(c.d**2))) for c in contrasts) > _RESOLUTION * size:
        return fit_noise(contrasts, source=f"{len(contrasts)} repeat(s)"), []
    why = "the repeats do not differ" if contrasts else "no repeats"
    stated = sensors.get(channel, sensors.get(channel.split(" at ")[0]) if station(channel) is not None else None)
    if stated is not None:
        note = (
            f"noise assumed for {channel} in {kind}: {why}; the sensor uncertainty of campaign.toml is taken instead."
        )
        return NoiseCovariance(s=stated, assumed=True, source="sensor uncertainty"), [note]
    rough = np.concatenate([np.abs(np.diff(y, 2)) for y in values])
    s = float(np.median(rough)) / _NORMAL_MEDIAN / np.sqrt(6.0)
    note = (
        f"noise assumed for {channel} in {kind}: {why} and no sensor uncertainty; the roughness of "
        "the records is taken instead."
    )
    if s <= _RESOLUTION * size:
        s = _RESOLUTION * size
        note += " The records are so smooth that they show no noise; the floor is one part in 1e6 of the signal."
    return NoiseCovariance(s=s, assumed=True, source="second differences"), [note]
