"""The hidden-effect generator: its laws are what they say, its sizes are what was asked, its folders tell nothing."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from benchmarks.blind.bench import Bench
from benchmarks.blind.designs import DESIGNS, make_bench, varies
from benchmarks.blind.generator import label, make
from benchmarks.blind.noise import KINDS, Noise
from benchmarks.blind.plan import PAIRS, SCORE, TUNING, case_of
from benchmarks.blind.rivals import nearest_rival
from benchmarks.blind.strength import base_signal, distance, of_share, share_not_linear
from benchmarks.blind.ties import looks_like_a_condition, twins, untestable
from benchmarks.blind.truth import Truth, respond
from benchmarks.blind.truths import ALL, LIBRARY, OUTSIDE
from benchmarks.blind.truths_rate import hereditary
from benchmarks.blind.truths_sensor import low_pass
from compare import Campaign

ROOT = Path(__file__).resolve().parents[2]
VARIANTS = [(name, variant) for name, truth in ALL.items() for variant in truth.variants]


def bench_for(effect: str, seed: int = 1, design: str = "rich") -> Bench:
    """Conditions of the first kind in which the effect can act."""
    kinds = ALL[effect].kinds
    return make_bench(np.random.default_rng(seed), "bending" if "bending" in kinds else kinds[0], design)


def drawn(effect: str, bench: Bench, variant: str | None = None, size: float = 0.3) -> Truth:
    """A truth of that effect."""
    return ALL[effect].draw(np.random.default_rng(2), bench, variant).of_size(size)


def added(bench: Bench, truth: Truth) -> np.ndarray:
    """What the truth adds to the linear load."""
    return respond(bench, [truth])["main"] - base_signal(bench)


@pytest.mark.parametrize(("effect", "variant"), VARIANTS)
def test_size_zero_is_the_linear_model(effect, variant):
    """Every law has the linear model as its limit."""
    bench = bench_for(effect)
    made = respond(bench, [drawn(effect, bench, variant, 0.0)])
    # play and toe keep a size of 1e-9 of the largest strain, so that their formulas do not divide by zero
    np.testing.assert_allclose(made["main"], base_signal(bench), atol=1e-8 * np.abs(base_signal(bench)).max())
    assert not made["cross"].any()


@pytest.mark.parametrize(("effect", "variant"), VARIANTS)
def test_part_that_no_stiffness_absorbs_is_what_was_asked(effect, variant):
    """||y - x (x.y)/(x.x)|| / ||y|| = 5 %, whatever the law."""
    bench = bench_for(effect)
    truth = of_share(bench, drawn(effect, bench, variant), 0.05)
    assert share_not_linear(bench, [truth]) == pytest.approx(0.05, rel=0.1 if effect == "quantisation" else 0.015)


def test_share_is_there_in_the_files_as_a_user_would_read_them(tmp_path):
    """The same number from the folder of an almost noiseless campaign, by plain least squares."""
    changes = {"effects": ("stiffening",), "design": "rich", "kind": "bending", "noise": "white", "size": 1e-6}
    folder = make(5, tmp_path / "c", strength=0.05, two_kinds=False, **changes)
    records = [e.record for e in Campaign.read(folder).experiments if e.is_open]
    x, y = (np.concatenate([r[name] for r in records]) for name in ("curvature", "moment"))
    left = y - x * (x @ y) / (x @ x)
    assert np.linalg.norm(left) / np.linalg.norm(y) == pytest.approx(0.05, rel=0.02)


def test_distance_is_the_root_of_the_sum_of_squares_in_noise_units():
    """D^2 = 2 sum |left|^2 / s^2 for white noise: every condition is measured twice."""
    bench = bench_for("stiffening")
    truth = of_share(bench, drawn("stiffening", bench), 0.05)
    rows, x = bench.fitted_rows, base_signal(bench)
    y = respond(bench, [truth])["main"]
    x_fit, y_fit = (a[rows][bench.mask[rows]] for a in (x, y))
    left = y_fit - x_fit * (x_fit @ y_fit) / (x_fit @ x_fit)
    s = 0.02 * np.sqrt(np.mean(y[bench.open_rows][bench.mask[bench.open_rows]] ** 2))
    assert distance(bench, Noise("white", 0.02), None, [truth]) == pytest.approx(np.sqrt(2 * left @ left) / s)


@pytest.mark.parametrize("design", DESIGNS)
def test_every_design_is_a_campaign_that_reads(design, tmp_path):
    """Contract: 8 open conditions and a sealed one, each twice, and the sealed tables stay closed."""
    folder = make(3, tmp_path / design, effects=(), design=design, two_kinds=False)
    campaign = Campaign.read(folder)
    assert len(campaign.experiments) == 18
    assert sum(e.repeat_of is not None for e in campaign.experiments) == 9
    assert [e.set for e in campaign.experiments if not e.is_open] == ["sealed"] * 2
    sets = [e.set for e in campaign.experiments]
    assert (sets.count("calibrate"), sets.count("validate")) == (12, 4)
    if design == "no-clock":
        assert all(e.record.time is None for e in campaign.experiments if e.is_open)
    if design == "load-controlled":
        assert all(e.record.prescribed in ("force", "torque", "moment") for e in campaign.experiments if e.is_open)


def test_many_seeds_read_and_two_kinds_can_be_mixed(tmp_path):
    """The first odd and even seeds of the score range."""
    kinds = set()
    for seed in range(SCORE.start, SCORE.start + 10):
        campaign = Campaign.read(make(seed, tmp_path / str(seed)))
        kinds |= {e.kind for e in campaign.experiments}
    mixed = Campaign.read(make(4, tmp_path / "mixed", kind="bending", design="rich", two_kinds=True))
    assert len({e.kind for e in mixed.experiments}) == 2
    assert len(kinds) > 1


def test_a_seed_makes_the_same_bytes_again_and_another_seed_does_not(tmp_path):
    """Determinism."""
    first, again, other = (make(seed, tmp_path / name) for seed, name in ((33, "a"), (33, "b"), (35, "c")))
    files = sorted(p.name for p in first.iterdir())
    assert files == sorted(p.name for p in again.iterdir())
    assert all((first / f).read_bytes() == (again / f).read_bytes() for f in files)
    assert (first / "e01.csv").read_bytes() != (other / "e01.csv").read_bytes()
    assert label(33) == label(33)


def test_the_folder_does_not_tell_the_truth(tmp_path):
    """No name of an effect or a variant stands in any file, and there is no file but those of the contract."""
    for seed in (23, 27, 29, 33, 35):
        folder = make(seed, tmp_path / str(seed))
        text = "".join(p.read_text() for p in folder.iterdir()).lower()
        truth = label(seed)
        assert truth["effects"]
        assert not [w for w in (*ALL, *(v for _, v in VARIANTS if v not in ("linear", "sharp"))) if w in text]
        assert all(p.name in ("campaign.toml", "experiments.csv") or p.name[0] == "e" for p in folder.iterdir())


def test_the_generator_knows_neither_the_library_nor_the_comparison():
    """What makes the data must not be what explains them."""
    code = "import sys, benchmarks.blind.generator; print([m for m in sys.modules if m.split('.')[0] in ('effects', 'compare')])"
    out = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True)
    assert out.stdout.strip() == "[]"


def test_plan_has_half_nulls_all_effects_and_ranges_apart():
    """Seeds for tuning and for the score share no number."""
    assert not set(TUNING[:10]) & set(SCORE[:10])
    assert TUNING.stop <= SCORE.start
    cases = [case_of(seed) for seed in range(SCORE.start, SCORE.start + 600)]
    assert sum(c.group == "null" for c in cases) == 300
    assert {e for c in cases for e in c.effects} == set(ALL)
    assert {c.noise for c in cases if c.group == "null"} == set(KINDS)
    assert len(OUTSIDE) >= 8
    assert len(PAIRS) >= 8


# ---- the physics of the truths


@pytest.mark.parametrize("effect", ["interlayer-friction", "plasticity"])
def test_slip_and_yield_do_not_feel_the_rate_but_dissipate(effect):
    """Loops do not depend on rate; work over a closed cycle is positive."""
    bench = bench_for(effect)
    faster = replace(bench, time=bench.time / 7, frequency=bench.frequency * 7)
    for variant in ALL[effect].variants:
        truth = drawn(effect, bench, variant)
        np.testing.assert_array_equal(added(bench, truth), added(faster, truth))
        work = np.sum(added(bench, truth)[:, 1:] * np.diff(bench.strain, axis=1), axis=1)
        assert (work > 0).all()


def test_only_the_slip_limit_grows_with_tension():
    """Contract: a loop whose limit does not change with axial tension is plasticity."""
    bench = bench_for("plasticity")
    tighter = replace(bench, tension=2 * bench.tension)
    yields, slips = drawn("plasticity", bench), drawn("interlayer-friction", bench)
    np.testing.assert_array_equal(added(bench, yields), added(tighter, yields))
    assert np.abs(added(tighter, slips)).max() > 1.1 * np.abs(added(bench, slips)).max()


def test_viscous_load_is_a_power_of_the_rate():
    """sigma ~ rate^p."""
    bench = bench_for("viscous-damping")
    faster = replace(bench, time=bench.time / 2)
    truth = drawn("viscous-damping", bench, "power-0.8")
    np.testing.assert_allclose(added(faster, truth), 2**0.8 * added(bench, truth), rtol=1e-9, atol=1e-12)


def test_fractional_element_under_a_ramp():
    """Integral of (t-s)^-a de/ds ds = rate t^(1-a) / (1-a); the hereditary sum is exact for straight steps."""
    bench = bench_for("viscoelasticity")
    bench = replace(bench, strain=1e-3 * bench.time)
    got = hereditary(bench, bench.strain, lambda s: s**0.75 / 0.75)
    np.testing.assert_allclose(got, 1e-3 * bench.time**0.75 / 0.75, rtol=1e-9)


def test_relaxation_fades_at_constant_strain():
    """After a ramp the extra load falls towards zero, in every variant."""
    bench = bench_for("viscoelasticity")
    held = replace(
        bench, strain=np.minimum(bench.strain.max() * np.arange(bench.strain.shape[1]) / 5, 1.0) * np.ones((9, 1))
    )
    for variant in ALL["viscoelasticity"].variants:
        extra = added(held, drawn("viscoelasticity", held, variant))
        late = extra[:, 60:]
        assert (np.diff(late, axis=1) <= 1e-12 * extra.max()).all()
        assert (extra[:, -1] < 0.9 * extra.max(axis=1)).all()


def test_lag_of_a_ramp_is_the_time_constant():
    """y = r (t - tau (1 - exp(-t/tau))) for x = r t, first order."""
    t = np.arange(50.0)[None]
    got = low_pass(2 * t, np.ones((1, 1)), 3.0)
    np.testing.assert_allclose(got, 2 * (t - 3 * (1 - np.exp(-t / 3))), rtol=1e-12)


def test_lag_and_viscosity_turn_the_loop_in_opposite_ways():
    """A sensor that lags gives energy back on paper; a damper takes it."""
    bench = bench_for("sensor-lag")
    area = {
        name: np.sum(added(bench, drawn(name, bench, v))[:, 1:] * np.diff(bench.strain, axis=1))
        for name, v in (("sensor-lag", "first-order"), ("viscous-damping", "linear"))
    }
    assert area["sensor-lag"] < 0 < area["viscous-damping"]


def test_a_compliant_frame_and_an_end_load_are_the_same_factor():
    """F = K eps / (1 + c/L) for both: lengths alone cannot separate them."""
    bench = make_bench(np.random.default_rng(4), "tension", "rich")
    frame = respond(bench, [drawn("rig-compliance", bench, "linear", 0.2)])["main"]
    end = respond(bench, [drawn("end-load-introduction", bench, "inverse-length", 0.2)])["main"]
    np.testing.assert_allclose(frame, bench.stiffness * bench.strain / (1 + 0.2 / bench.length[:, None]), rtol=1e-7)
    np.testing.assert_allclose(frame, end, rtol=1e-7)


def test_play_and_slip_are_lengths_of_the_grips():
    """Their strain goes with 1/L, and a slip does not come back while a play does."""
    bench = make_bench(np.random.default_rng(4), "tension", "rich")
    longer = replace(bench, length=2 * bench.length)
    for name, variant in (("backlash", "sharp"), ("grip-slip", "threshold")):
        truth = drawn(name, bench, variant, 0.05)
        moved = bench.strain > 0.5 * bench.scale
        np.testing.assert_allclose(added(longer, truth)[moved], added(bench, truth)[moved] / 2, rtol=1e-6)
    slip = added(bench, drawn("grip-slip", bench, "threshold"))
    assert (np.diff(slip, axis=1) <= 1e-9).all()


def test_softening_remembers_the_largest_strain_only():
    """Factor 1 - a g(max |strain| so far): after the largest strain the secant does not change any more."""
    bench = bench_for("cyclic-softening")
    factor = drawn("cyclic-softening", bench, "exponential").factor(bench, bench.strain)
    assert (np.diff(factor, axis=1) <= 0).all()
    for c in range(9):
        top = int(np.abs(bench.strain[c]).argmax())
        assert np.ptp(factor[c, top:]) == 0


def test_signs_of_the_reversible_laws():
    """Stiffening adds, a toe takes, heat softens, tension stiffens, drift starts at zero, coupling leaves the load alone."""
    bench = bench_for("stiffening")
    moved = np.abs(bench.strain) > 0.3 * bench.scale
    outward = np.sign(bench.strain)
    assert ((added(bench, drawn("stiffening", bench)) * outward)[moved] > 0).all()
    slopes = respond(bench, [drawn("thermal-softening", bench)])["main"].std(axis=1) / bench.strain.std(axis=1)
    assert np.corrcoef(slopes, bench.temperature)[0, 1] < -0.8
    slopes = respond(bench, [drawn("tension-stiffening", bench)])["main"].std(axis=1) / bench.strain.std(axis=1)
    assert np.corrcoef(slopes, bench.tension)[0, 1] > 0.8
    assert not added(bench, drawn("sensor-drift", bench))[:, 0].any()
    pull = make_bench(np.random.default_rng(4), "tension", "rich")
    assert (added(pull, drawn("slack", pull, size=0.2)) <= 1e-9).all()
    coupled = respond(pull, [drawn("tension-torsion-coupling", pull)])
    np.testing.assert_array_equal(coupled["main"], base_signal(pull))
    assert coupled["cross"].any()


def test_rig_is_outside_section_and_section_inside_sensor():
    """An offset is not filtered by the play, and a play shifts what the toe sees."""
    bench = make_bench(np.random.default_rng(4), "tension", "rich")
    play, toe, bias = (drawn(n, bench, size=0.05) for n in ("backlash", "slack", "sensor-offset"))
    both = respond(bench, [bias, toe, play])["main"]
    inside = play.fixture(bench, bench.strain)
    expected = bench.stiffness * (inside + toe.elastic(bench, inside)) + 0.05 * bias.numbers["unit"]
    np.testing.assert_allclose(both, expected, rtol=1e-12)


def test_path_found_under_a_prescribed_load_gives_that_load():
    """Load control is the inverse of path control."""
    bench = make_bench(np.random.default_rng(4), "bending", "load-controlled", load_control=True)
    for name in ("stiffening", "viscoelasticity", "interlayer-friction"):
        truth = of_share(bench, drawn(name, bench, size=0.1), 0.05)
        path = respond(bench, [truth])["main"]
        back = respond(replace(bench, strain=path, load_control=False), [truth])["main"]
        np.testing.assert_allclose(back, bench.stiffness * bench.strain, atol=1e-5 * bench.stiffness * bench.scale)


# ---- noise, designs, ties


@pytest.mark.parametrize("kind", KINDS)
def test_whitened_noise_has_variance_one(kind):
    """Noise and its whitening know the same covariance; 3 % is four standard errors of 40 000 independent samples."""
    rng = np.random.default_rng(8)
    clean = 5 * np.sin(np.linspace(0, 19, 300))
    noise = Noise(kind, 0.02, 0.01, 0.005) if kind == "scatter" else Noise(kind, 0.02)
    draws = np.column_stack([noise.draw(rng, clean, 3.5) for _ in range(400)])
    white = noise.whiten(draws, clean, 3.5)
    assert np.mean(white**2) == pytest.approx(1, rel=0.12 if kind == "heavy-tail" else 0.03)
    assert np.corrcoef(white[:-1].ravel(), white[1:].ravel())[0, 1] == pytest.approx(0, abs=0.02)


def test_designs_hold_what_they_promise_to_hold():
    """Amplitude only, amplitude tied to rate, one tension, one length."""
    rng = np.random.default_rng(9)
    only = make_bench(rng, "torsion", "amplitude-only")
    assert not any(varies(only, f) for f in ("frequency", "temperature", "tension", "length"))
    tied = make_bench(rng, "bending", "amplitude-rate")
    top = np.abs(tied.strain).max(axis=1)[tied.open_rows]
    assert np.corrcoef(np.log(top), np.log(tied.frequency[tied.open_rows]))[0, 1] < -0.95
    assert not varies(make_bench(rng, "bending", "one-tension"), "tension")
    assert not varies(make_bench(rng, "tension", "one-length"), "length")
    rich = make_bench(rng, "torsion", "rich")
    assert all(varies(rich, f) for f in ("frequency", "temperature", "tension"))


def test_ties_and_untestable_effects_follow_the_contract():
    """Friction and plasticity at one tension; end load and frame always; no clock, no rate; one temperature, no heat."""
    rng = np.random.default_rng(9)
    one, rich = make_bench(rng, "bending", "one-tension"), make_bench(rng, "bending", "rich")
    assert set(twins("plasticity", one, "one-tension")) == {"plasticity", "interlayer-friction"}
    assert twins("plasticity", rich, "rich") == ()
    pull = make_bench(rng, "tension", "rich")
    assert set(twins("rig-compliance", pull, "rich")) == {"rig-compliance", "end-load-introduction"}
    assert untestable("viscous-damping", rich, clock=False, second_channel=False)
    assert not untestable("viscous-damping", rich, clock=True, second_channel=False)
    assert untestable("thermal-softening", make_bench(rng, "bending", "one-temperature"), True, False)
    assert untestable("direction-asymmetry", pull, True, False)
    assert len(LIBRARY) == 18


def test_a_stiffness_that_follows_a_condition_is_noticed():
    """Stiffness falling with temperature looks like a condition; a peak at 20 degC need not."""
    bench = bench_for("thermal-softening")
    assert looks_like_a_condition(bench, respond(bench, [drawn("thermal-softening", bench)])["main"])
    assert not looks_like_a_condition(bench, base_signal(bench))


def test_nearest_rival_of_yield_at_one_tension_is_slip():
    """The contract's tie: their loops are the same, so that the distance falls to a fraction of that from a straight line."""
    bench = make_bench(np.random.default_rng(9), "bending", "one-tension")
    truth = of_share(bench, drawn("plasticity", bench, "multi-yield"), 0.05)
    noise = Noise("white", 0.02)
    name, apart = nearest_rival(np.random.default_rng(1), bench, noise, truth, clock=True)
    assert name == "interlayer-friction"
    assert apart < 0.3 * distance(bench, noise, None, [truth])
