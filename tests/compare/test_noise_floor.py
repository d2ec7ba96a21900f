"""Noise from repeats: contrasts are free of the signal, also where repeats were sampled differently; without repeats it is assumed."""

from __future__ import annotations

import numpy as np
import pytest

from compare import Campaign, measure_noise
from compare.repeats import find_repeats, helmert

T = np.linspace(0, 60, 400)


def path(t):
    return 0.8 * np.sin(0.4 * t)


def moment(t):
    return 95 * path(t) + 12 * np.tanh(8 * np.cos(0.4 * t))  # a loop, which no linear model follows


def campaign_with(campaign_of, records, toml_end="", **columns):
    """One bending experiment and its repeats; a record is (time or None, curvature, moment)."""
    from sound_campaign import TOML

    rows, tables = [], {}
    for i, (t, x, y) in enumerate(records):
        rows.append({"id": f"e{i}", "kind": "bending", "repeat_of": "e0" if i else "", **columns})
        clock = {} if t is None else {"time [s]": t}
        tables[f"e{i}"] = {**clock, "curvature [1/m]": x, "moment [N m]": y}
    return Campaign.read(campaign_of(rows, tables, TOML + toml_end))


def noise_of(campaign):
    return measure_noise(campaign).by_channel["bending", "moment"]


def test_helmert_contrasts_are_orthonormal_and_signal_free():
    for k in (2, 3, 5):
        H = helmert(k)
        np.testing.assert_allclose(H @ H.T, np.eye(k - 1), atol=1e-14)
        np.testing.assert_allclose(H.sum(axis=1), 0, atol=1e-14)


def test_same_sampling_any_signal(campaign_of):
    rng = np.random.default_rng(0)
    records = [(T, path(T), moment(T) + rng.normal(size=T.size)) for _ in range(4)]
    assert noise_of(campaign_with(campaign_of, records)).s == pytest.approx(1.0, rel=3 / np.sqrt(2 * 3 * T.size))


@pytest.mark.parametrize("clocks", [True, False])
def test_other_sampling_and_length_do_not_shrink_the_noise(campaign_of, clocks):
    """Linear interpolation would report sqrt(2/3 + 1)/sqrt 2 = 0.91 of the noise; nearest samples report all of it.

    The bound: three standard errors, and half a step of a loop whose residual turns over 8 N m within 0.9 s.
    """
    rng = np.random.default_rng(1)
    sampled = [np.linspace(0, 60, 2000), np.linspace(0, 48, 2311)]
    records = [(t if clocks else None, path(t), moment(t) + rng.normal(size=t.size)) for t in sampled]
    noise = noise_of(campaign_with(campaign_of, records))
    assert not noise.assumed
    assert noise.s == pytest.approx(1.0, rel=3 / np.sqrt(2 * 1600) + 0.02)


def test_difference_of_the_path_between_nearest_samples_is_no_noise(campaign_of):
    """Half a step of the path times the stiffness is ten times the noise here; what a stiffness explains is taken out."""
    rng = np.random.default_rng(5)
    sampled = [np.linspace(0, 60, 400), np.linspace(0, 60, 463)]
    records = [(t, path(t), 950 * path(t) + rng.normal(size=t.size)) for t in sampled]
    noise = noise_of(campaign_with(campaign_of, records))
    assert not noise.assumed
    assert noise.s == pytest.approx(1.0, rel=3 / np.sqrt(2 * 400))


def test_another_path_is_no_repeat(campaign_of):
    rng = np.random.default_rng(2)
    records = [(T, f * path(T), moment(T) + rng.normal(size=T.size)) for f in (1.0, 1.5)]
    found = measure_noise(campaign_with(campaign_of, records))
    assert found.by_channel["bending", "moment"].assumed
    assert any("e1 is not used as a repeat of e0" in note and "curvature differs" in note for note in found.notes)


def test_a_copied_table_is_no_repeat(campaign_of):
    records = [(T, path(T), moment(T))] * 2
    found = measure_noise(campaign_with(campaign_of, records))
    assert found.by_channel["bending", "moment"].assumed
    assert any("byte for byte" in note for note in found.notes)


def test_repeat_of_a_repeat_belongs_to_the_same_experiment(campaign_of):
    rng = np.random.default_rng(3)
    records = [(T, path(T), moment(T) + rng.normal(size=T.size)) for _ in range(3)]
    campaign = campaign_with(campaign_of, records)
    text = (campaign.folder / "experiments.csv").read_text().replace("e2.csv,S1,e0", "e2.csv,S1,e1")
    (campaign.folder / "experiments.csv").write_text(text)
    repeats, _ = find_repeats(Campaign.read(campaign.folder).readable)
    assert [[e.id for e in r.experiments] for r in repeats] == [["e0", "e1", "e2"]]


def test_without_repeats_the_sensor_speaks(campaign_of):
    found = measure_noise(campaign_with(campaign_of, [(T, path(T), moment(T))], '[sensors]\nmoment = "50 N mm"\n'))
    noise = found.by_channel["bending", "moment"]
    assert (noise.s, noise.assumed, noise.source) == (pytest.approx(0.05), True, "sensor uncertainty")
    assert any("noise assumed for moment in bending" in note for note in found.notes)


def test_without_repeats_and_sensor_the_roughness_speaks(campaign_of):
    rng = np.random.default_rng(4)
    t = np.linspace(0, 60, 4000)
    found = measure_noise(campaign_with(campaign_of, [(t, path(t), moment(t) + 0.5 * rng.normal(size=t.size))]))
    noise = found.by_channel["bending", "moment"]
    assert noise.assumed and noise.source == "second differences"
    # the median of 4000 correlated second differences scatters by about 2.5 %; three times that
    assert noise.s == pytest.approx(0.5, rel=0.075)


def test_data_without_noise_keep_a_finite_floor(campaign_of):
    noise = noise_of(campaign_with(campaign_of, [(T, path(T), 95 * path(T) + 0.0 * i) for i in range(2)]))
    assert np.isfinite(noise.s) and noise.s > 0
