"""What a bend costs: the loop of the section law per length of cable that passes, the turn of the motion, and the rod."""

import math

import numpy as np
import pytest

from beam.generalized_alpha import Integrator, StepSettings
from beam.motion import Turn
from beam.rod import Rod
from beam.rod_model import RodModel, Support
from beam.shape import straight
from effects import ActiveEffect, BenchPath, find
from effects.bending_loss import TURNS, BendingLoss
from effects.rod_law import RodLaw
from geometry.errors import InputError
from homogenize.section_stiffness import SectionInertia, SectionStiffness

EI, R, KAPPA = 6.0, 0.4, 2.5


def law(name: str, shape, strength, form: int = 0, kind: str = "bending", **reference) -> ActiveEffect:
    effect = find(name)
    scale = BenchPath(kind, np.zeros(0), **reference)
    return ActiveEffect(effect, effect.forms[form], kind, shape=shape, strength=strength, reference=scale)


def friction(x: float = 0.3, a: float = 2.5, share: float = 0.6) -> ActiveEffect:
    return law("interlayer-friction", (x, share), (a,), typical_tension=100.0)


def test_one_stick_slip_element_loses_two_yield_moments_times_the_slip():
    """W = 2 M_y (1/R - 2 kappa_y), M_y = EI a kappa_y, kappa_y = x (1 - g + g T/T_typ); 0 where 1/R < 2 kappa_y. rtol 1e-4: kinks
    between steps of 1/200 of the curvature."""
    loss = BendingLoss([friction()], EI, R)
    for T in (20.0, 100.0, 250.0):
        yields = 0.3 * (0.4 + 0.6 * T / 100.0)
        assert loss.work(T) == pytest.approx(2 * EI * 2.5 * yields * (KAPPA - 2 * yields), rel=1e-4)
    assert abs(loss.work(1000.0)) < 1e-12


def test_an_elastic_law_costs_nothing():
    """A reversible law gives back on straightening what bending took."""
    stiffening = find("stiffening")
    shape = tuple(
        float(p.starts([BenchPath("bending", np.zeros(0))])[0]) if p.starts else 0.1 for p in stiffening.forms[0].shape
    )
    loss = BendingLoss([law("stiffening", shape, (0.5,) * len(stiffening.forms[0].strength))], EI, R)
    moment = abs(EI * 0.5 * KAPPA)
    assert abs(loss.work(500.0)) < 1e-10 * moment * KAPPA


def test_a_maxwell_branch_in_closed_form_slow_and_fast():
    """q' = kappa' - q/tau through the ramp lambda/v, the stay R theta/v and the ramp back; rtol 1e-3: 200 steps a ramp."""
    tau, a, T = 0.5, 1.4, 60.0
    loss = BendingLoss([law("viscoelasticity", (tau,), (a,))], EI, R, angle=math.pi / 2)
    rise, stay = math.sqrt(EI / T), R * math.pi / 2
    found = []
    for v in (0.05, 0.5, 5.0):
        t1, t2 = rise / v, stay / v
        rate, fade = KAPPA / t1, 1 - math.exp(-t1 / tau)
        ramp = tau * (t1 - tau * fade)
        W = EI * a * rate * (2 * rate * ramp - rate * tau * fade * math.exp(-t2 / tau) * tau * fade)
        assert loss.work(T, v) == pytest.approx(W, rel=1e-3)
        found.append(W)
    assert max(found) > 1.5 * min(found)


def test_tension_reads_the_work_with_the_sign_of_the_motion():
    """Far from a turn +W pulled and -W let down, at the tension of the instant (1e-3: table over the tension)."""
    loss = BendingLoss([friction()], EI, R)
    p = np.concatenate([np.linspace(0, 3, 60), np.linspace(3, 0, 60)])
    v = np.repeat([0.3, -0.3], 60)
    T = np.linspace(80.0, 160.0, 120)
    found = loss.resistance(p, v, T)
    assert found[0] == 0
    assert found[55] == pytest.approx(loss.work(float(T[55])), rel=1e-3)
    assert found[118] == pytest.approx(-loss.work(float(T[118])), rel=1e-3)


def test_a_turn_begins_with_the_stiffness_of_layers_that_stick():
    """dT/d(travel) = K (1/R) (1/R - 2 kappa_y) / lambda, K = EI a: all that had slipped sticks (1 %: the first travels are not 0)."""
    x = 0.2
    loss = BendingLoss([friction(x=x)], EI, R)
    T = 100.0
    rise = loss.work(T) * float(np.diff(loss.turn(T)[:2])[0])
    width = loss.transition(T)
    slope = EI * 2.5 * KAPPA * (KAPPA - 2 * x) / width
    assert rise / (float(np.diff(TURNS[:2])[0]) * width) == pytest.approx(slope, rel=0.01)


def test_a_turn_is_that_of_points_which_pass_the_bend():
    """Closed form for one element: sigma = -1 + mean over the curvatures k of what each side has turned; entering points go from
    k exp(-u) to k, leaving ones from min(k exp(u), 1/R) to k (2 %: 48 curvatures)."""
    x = 0.2
    loss = BendingLoss([friction(x=x, share=0.25)], EI, R)
    k = (np.arange(4000) + 0.5) / 4000 * KAPPA
    M, W = EI * 2.5 * x, loss.work(100.0)
    for u, found in zip(TURNS[3:12:4], loss.turn(100.0)[3:12:4], strict=True):
        up, down = np.minimum(k * np.exp(u), KAPPA), k * np.exp(-u)
        gone = _element(np.stack([_passes(k), up, k]), x) / x
        come = _element(np.stack([_passes(k), np.full_like(k, KAPPA), down, k]), x) / x
        assert M * np.mean(come - gone) * KAPPA / W == pytest.approx(found, abs=0.02)


def _passes(k):
    return np.zeros_like(k)


def _element(path, x):
    """Stress of an element that has passed the bend before, (points,)."""
    s, last = np.full(path.shape[1], -x), np.zeros(path.shape[1])
    for now in path:
        s, last = np.clip(s + now - last, -x, x), now
    return s


def test_the_stops_add_up_and_follow_the_turn():
    """Weights sum to 1, none is negative, and after a turn their sum is the curve (1e-9)."""
    loss = BendingLoss([friction()], EI, R)
    d, w = loss.stops(100.0)
    assert w.sum() == pytest.approx(1.0, abs=1e-12) and (w >= 0).all()
    travel = TURNS * loss.transition(100.0)
    sigma = -1 + 2 * np.minimum(travel[:, None] / (2 * d), 1.0) @ w
    np.testing.assert_allclose(sigma, loss.turn(100.0), atol=5e-3)  # the curve is made concave


def test_a_rod_bent_and_straightened_loses_the_same_per_length():
    """A geometrically exact rod whose end is turned to 1/R and back, twice: what its ledger of energies books for the section law in
    the second time is W times its length. rtol 1e-3: the step of 1/40 of a bend, and waves of a light rod."""
    T, length, period, steps = 100.0, 0.2, 4.0, 80
    section = SectionStiffness.uncoupled(EA=5e4, GA_x=2e4, GA_y=2e4, EI_x=EI, EI_y=EI, GJ=4.0, area=1e-3)
    rod = Rod.straight(length, 2, section, SectionInertia(0.02, 1e-6, 1e-6, 2e-6))
    one, w = friction(), 2 * math.pi / period

    def angle(t: float) -> tuple[float, float, float]:
        half = KAPPA * length / 2
        return half * (1 - math.cos(w * t)), half * w * math.sin(w * t), half * w * w * math.cos(w * t)

    supports = [Support(0), Support(-1, held=("theta",), turn=Turn(angle))]
    problem = RodModel(rod, straight(rod.s), supports, law=RodLaw(section, [one], tension=T))
    run = Integrator(problem, problem.q0, settings=StepSettings(period / steps, adaptive=False, absolute=1e-8))
    lost = []
    for _ in range(2):
        assert run.advance(steps), str(run.outcome)
        lost.append(run.ledger.totals["section_law"])
    assert lost[1] - lost[0] == pytest.approx(BendingLoss([one], EI, R).work(T) * length, rel=1e-3)


def test_what_is_no_law_in_bending_is_refused():
    with pytest.raises(InputError, match="no law of the section in bending"):
        BendingLoss([law("plasticity", (0.1,), (1.0,), kind="tension")], EI, R)
    with pytest.raises(InputError, match="radius must be positive"):
        BendingLoss([friction()], EI, -1.0)
