"""Each signature of the residual has the value that follows from the law in the data; noise alone has none."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from made_bent_cable import EI, GRID, bent_campaign, compared
from made_campaign import made_campaign

from compare import NoiseCovariance
from compare.localisation import marks
from compare.record_signature import record_signatures, std_of_sum


def found(law, **options):
    campaign = bent_campaign(law, **options)
    return {m.name: m for m in marks(compared(campaign), campaign)}


def linear(b):
    return EI * b.k


def near(mark, value, at_least=1e-12):
    """Within 4 std, which are themselves small enough to mean something."""
    return abs(mark.value - value) < 4 * max(mark.std, at_least) and mark.std < 0.25 * abs(value)


def test_stiffness_that_falls_with_amplitude_and_nothing_else():
    """A factor 1 - 0.03 log2(a / 0.8) is -3 % of the mean per doubling; rate, tension and temperature have no part in it."""
    m = found(lambda b: linear(b) * (1 - 0.03 * np.log2(b.amplitude / 0.8)))
    fitted = -100 * 0.03 / (1 - 0.03)  # over the common stiffness, that of the largest amplitude by its weight
    assert m["stiffness over amplitude"].value == pytest.approx(fitted, rel=0.05)  # the common one lies in between
    assert m["stiffness over amplitude"].sentence.startswith("apparent stiffness falls with amplitude: -3.0")
    for other in ("rate", "axial tension", "temperature"):
        assert "does not depend" in m[f"stiffness over {other}"].sentence
        assert abs(m[f"stiffness over {other}"].value) < 4 * m[f"stiffness over {other}"].std


def test_stiffness_over_temperature_is_per_10_kelvin():
    m = found(lambda b: linear(b) * (1 - 0.004 * (b.temperature - 293.15)))
    assert m["stiffness over temperature"].value == pytest.approx(-4.0, rel=0.03)  # over a mean that is 1 to 2 %
    assert next(iter(m)) == "stiffness over temperature"


def test_tied_conditions_are_said_to_be_tied():
    """Amplitude and rate vary together: neither is claimed without the other being named."""
    grid = [(0.4, 0.02, 2e3, 293.15), (0.8, 0.04, 2e3, 293.15), (1.6, 0.08, 2e3, 293.15), (1.2, 0.06, 2e3, 293.15)]
    m = found(lambda b: linear(b) * (1 - 0.03 * np.log2(b.amplitude / 0.8)), grid=grid)
    assert "not to be told from rate: they vary together, correlation 1.00" in m["stiffness over amplitude"].sentence
    assert "not to be told from amplitude" in m["stiffness over rate"].sentence


def test_viscous_loop_energy_goes_with_the_square_of_the_amplitude_and_with_rate():
    """W = pi c w a^2: loss factor c w / EI, exponents 2 and 1; the lead c / EI is a time."""
    c = 6.0
    m = found(lambda b: linear(b) + c * b.rate)
    assert near(m["loop energy over amplitude"], 2.0) and near(m["loop energy over rate"], 1.0)
    assert m["lag"].value == pytest.approx(-1e3 * c / EI, rel=0.01) and "ahead" in m["lag"].sentence
    assert "same time at all rates" in m["lag over rate"].sentence
    loss = np.mean([c * 2 * np.pi * f / EI for _, f, _, _ in GRID])
    assert abs(m["loop"].value - loss) < 2 * m["loop"].std


def test_rate_independent_loop_energy_does_not_depend_on_rate():
    """Dry friction: W = 4 M a, exponents 1 and 0, loss factor 4 M / (pi EI a); the lead is a phase."""
    m = found(lambda b: linear(b) + 2.0 * np.sign(b.rate))
    assert near(m["loop energy over amplitude"], 1.0)
    assert abs(m["loop energy over rate"].value) < 4 * m["loop energy over rate"].std < 0.3
    assert "loop energy does not depend on rate" in m["loop energy over rate"].sentence
    assert "same phase at all rates" in m["lag over rate"].sentence


def test_lag_of_the_sensor_is_a_time_and_its_loops_run_backwards():
    def lagged(b):  # steady answer of a first-order lag, whose phase is that of a shift for w tau << 1
        return linear(replace(b, k=b.amplitude * np.sin(2 * np.pi * b.frequency * (b.t - 0.05))))

    m = found(lagged)
    assert m["lag"].value == pytest.approx(50.0, rel=0.02)  # ms; sin(w tau) for w tau up to 0.06
    assert "backwards" in m["loop"].sentence and m["loop"].value < 0
    assert "lag of the load is the same time" in m["lag over rate"].sentence


def test_harmonics_are_chebyshev_coefficients():
    """k^3 / a^2 holds a quarter of T3, k |k| / a stays odd, k^2 / a holds one half of T2."""
    odd = found(lambda b: linear(b) + 0.1 * EI * b.k**3 / b.amplitude**2)
    assert odd["third harmonic"].value == pytest.approx(100 * 0.1 / 4 / 1.075, rel=0.02)  # the line takes 3/4 of it
    assert "curves up" in odd["third harmonic"].sentence and "even harmonic" not in odd
    even = found(lambda b: linear(b) + 0.1 * EI * b.k**2 / b.amplitude)
    assert even["even harmonic"].value == pytest.approx(100 * 0.1 / 2, rel=0.02)
    assert "third harmonic" not in even


def test_one_sided_path_that_stiffens_curves_up():
    m = found(lambda b: linear(b) + 0.1 * EI * b.k**2 / b.amplitude, one_sided=True)
    assert m["curvature"].value > 4 * m["curvature"].std and "curves up" in m["curvature"].sentence
    assert "even harmonic" not in m and "third harmonic" not in m


def test_offset_and_trend_are_in_the_unit_of_the_channel():
    offset = found(lambda b: linear(b) + 1.5)
    assert offset["offset of moment"].value == pytest.approx(1.5, rel=0.02) and set(offset) == {"offset of moment"}
    trend = found(lambda b: linear(b) + 0.02 * b.t)
    assert trend["trend of moment"].value == pytest.approx(0.02, rel=0.02)
    assert trend["trend of moment"].sentence.endswith("N m/s")


def test_first_loading_stiffer_than_later():
    """A factor 1.06 while the curvature is larger than ever before."""

    def mullins(b):
        first = np.abs(b.k) >= np.maximum.accumulate(np.abs(b.k))
        return linear(b) * (1 + 0.06 * first)

    m = found(mullins)
    assert m["first loading"].value == pytest.approx(6.0, rel=0.05)  # over the common stiffness, 1 to 2 % larger


@pytest.mark.parametrize("scatter", [0.0, 0.01])
def test_noise_alone_gives_no_mark(scatter):
    """A mark in at most one campaign of 20 is allowed; P(more than 3 of 15) is below 0.6 % then."""
    hits = sum(bool(found(linear, seed=s, scatter=scatter)) for s in range(15))
    assert hits <= 3


def test_only_the_set_calibrate_is_looked_at():
    """What happens in a validation record changes nothing."""
    campaign = bent_campaign(lambda b: linear(b) + 1.5)
    before = marks(compared(campaign), campaign)
    spoilt = [
        e
        if e.set == "calibrate"
        else replace(
            e,
            table=replace(
                e.record,
                channels={
                    **e.record.channels,
                    "moment": replace(
                        e.record.channels["moment"], values=e.record["moment"] + 20 * e.record["curvature"]
                    ),
                },
            ),
        )
        for e in campaign.experiments
    ]
    other = made_campaign(spoilt, campaign.section)
    after = marks(compared(other), other)
    assert [m.sentence for m in before] == [m.sentence for m in after] and before


def test_a_prescribed_load_shows_the_same_signs_as_a_prescribed_path():
    """k = M / EI lags by c / EI under viscous damping: the load is ahead, whichever of the two was measured."""

    def swapped(campaign):
        made = []
        for e in campaign.experiments:
            record = replace(e.record, prescribed="moment", measured=("curvature",))
            made.append(replace(e, table=record, control="moment"))
        return made_campaign(made, campaign.section)

    c = 1.0
    campaign = bent_campaign(lambda b: linear(b) + c * b.rate, noise=1e-6)
    shaken = np.random.default_rng(4)
    records = []
    for e in swapped(campaign).experiments:
        k = e.record.channels["curvature"]
        channels = {
            **e.record.channels,
            "curvature": replace(k, values=k.values + shaken.normal(0, 2e-3, len(k.values))),
        }
        records.append(replace(e, table=replace(e.record, channels=channels)))
    other = made_campaign(records, campaign.section)
    m = {x.name: x for x in marks(compared(other), other)}
    assert m["lag"].value == pytest.approx(-1e3 * c / EI, rel=0.05) and m["loop"].value > 0


def test_std_of_a_sum_is_that_of_the_dense_matrix():
    n, rng = 40, np.random.default_rng(0)
    m, w = rng.normal(size=n), rng.normal(size=n)
    noise = NoiseCovariance(s=0.7, phi=0.8, gain=0.2, offset=0.4, white=0.5)
    lag = np.abs(np.subtract.outer(np.arange(n), np.arange(n)))
    C = 0.49 * 0.8**lag + 0.25 * np.eye(n) + 0.04 * np.outer(m, m) + 0.16
    assert std_of_sum(w, noise, m) == pytest.approx(np.sqrt(w @ C @ w), rel=1e-12)  # sums of 40 terms


def test_stiffness_of_one_record_is_its_regression():
    """For nearly white noise the ratio is sum(m y) / sum(m m); its std is s / |m| or more."""
    comparison = compared(bent_campaign(linear))
    signature = record_signatures(comparison)[0]
    fit = signature.fit
    noise = comparison.noise.of(fit.experiment, fit.channel)
    alone = noise.s / np.linalg.norm(fit.model)
    std = signature.numbers["stiffness"][1]
    assert std == pytest.approx(np.hypot(alone, noise.gain), rel=0.3)  # phi of some 0.05 is all that is found besides
    plain = fit.model @ fit.measured / (fit.model @ fit.model)
    assert signature.numbers["stiffness"][0] == pytest.approx(plain, rel=1e-3)  # weights differ by the fitted phi
