"""A section law in the rod is the law of the bench: the same loops, the same relaxation, the same loss of energy."""

from dataclasses import replace

import numpy as np
import pytest

from beam import read_scenario, tow
from beam.generalized_alpha import Integrator, StepSettings
from beam.rod import Rod
from beam.rod_model import RodModel, Support
from beam.scenario import published_section
from beam.shape import straight
from beam.statics import StaticSettings, equilibrium
from effects import ActiveEffect, BenchPath, find
from effects.rod_law import RodLaw
from geometry.errors import InputError
from homogenize.section_stiffness import SectionInertia, SectionStiffness

SECTION = SectionStiffness.uncoupled(EA=5e4, GA_x=2e4, GA_y=2e4, EI_x=6.0, EI_y=6.0, GJ=4.0, area=1e-3)
INERTIA = SectionInertia(2.0, 1e-3, 1e-3, 2e-3)
LENGTH = 0.5


def active(name: str, kind: str, shape, strength, form: int = 0, **reference) -> ActiveEffect:
    effect = find(name)
    scale = BenchPath(kind, np.zeros(0), **reference)
    return ActiveEffect(effect, effect.forms[form], kind, shape=shape, strength=strength, reference=scale)


FRICTION = active("interlayer-friction", "bending", (0.3, 0.6), (2.5,), typical_tension=100.0)


def model(law: RodLaw, angle: float = 0.0, elements: int = 4) -> RodModel:
    """A straight rod, held at its start, whose end is turned by `angle` about the global z axis and may move."""
    rod = Rod.straight(LENGTH, elements, SECTION, INERTIA)
    q0 = straight(rod.s)
    q0[-1, 8] = angle
    return RodModel(rod, q0, [Support(0), Support(-1, held=("theta",))], law=law)


def bent(law: RodLaw, angles, duration: float = 1.0, load: float = 0.0):
    """Static load steps through the end `angles`; strains E and forces S of all Gauss points, (steps, points, 6)."""
    q, memory, E, S = None, None, [], []
    settings = StaticSettings(force_tolerance=1e-7, moment_tolerance=1e-9)
    for angle in angles:
        problem = model(law, angle)
        pull = np.zeros_like(problem.q0)
        pull[-1, 0:2] = load * np.cos(angle), load * np.sin(angle)
        problem = replace(problem, load=pull)
        step = equilibrium(problem, q, memory=memory, duration=duration, settings=settings)
        step.outcome.require_success()
        q, memory = step.q, step.memory
        assert memory is not None
        E.append(memory.E.reshape(-1, 6))
        S.append(step.forces.S.reshape(-1, 6))
    return np.array(E), np.array(S)


ANGLES = LENGTH * np.concatenate([np.linspace(0.15, 0.9, 6), np.linspace(0.6, -0.9, 6), np.linspace(-0.6, 0.9, 6)])


def test_bending_loop_of_the_rod_is_that_of_the_material_point():
    """Cycled end rotation with friction: every Gauss point has M = EI (kappa + a c(kappa)) with c of the bench's record, to
    1e-9 of the largest moment; and kappa is angle / length, to 2e-3 (four elements)."""
    E, S = bent(RodLaw(SECTION, [FRICTION], tension=100.0), ANGLES)
    np.testing.assert_allclose(E[:, :, 5], np.broadcast_to(ANGLES[:, None] / LENGTH, E.shape[:2]), atol=2e-3)
    for point in range(E.shape[1]):
        kappa = E[:, point, 5]
        path = BenchPath("bending", kappa, tension=np.full(kappa.size, 100.0), typical_tension=100.0)
        c = FRICTION.form.respond(path, *FRICTION.shape) @ np.array(FRICTION.strength)
        M = 6.0 * (kappa + c)
        np.testing.assert_allclose(S[:, point, 5], M, rtol=0, atol=1e-9 * np.abs(M).max())
    middle = S[:, 6, 5]
    assert abs(middle[5] - middle[-1]) < 1e-2 * middle[5] and middle[7] < 6.0 * ANGLES[7] / LENGTH


def test_grip_is_the_tension_of_the_rod():
    """The same loops while the rod is pulled by 200 N: its own axial force grips, not the typical 100 N (1e-9)."""
    E, S = bent(RodLaw(SECTION, [FRICTION]), ANGLES, load=200.0)
    np.testing.assert_allclose(E[:, :, 0].mean(axis=1) * 5e4, 200.0, rtol=0.02)
    for point in (0, 6, 11):
        kappa = E[:, point, 5]
        path = BenchPath("bending", kappa, tension=5e4 * E[:, point, 0], typical_tension=100.0)
        c = FRICTION.form.respond(path, *FRICTION.shape) @ np.array(FRICTION.strength)
        np.testing.assert_allclose(S[:, point, 5], 6.0 * (kappa + c), rtol=0, atol=1e-8)
    slipping = np.abs(S[5, :, 5] - 6.0 * E[5, :, 5]).max()
    assert slipping == pytest.approx(6.0 * 2.5 * 0.3 * 1.6, rel=0.05)  # 0.4 + 0.6 * 200 / 100 = 1.6


@pytest.mark.parametrize(
    ("name", "form", "shape", "strength"),
    [
        ("interlayer-friction", 1, (0.5,), tuple(np.linspace(0.1, 0.5, 12))),
        ("plasticity", 0, (0.2,), (1.5,)),
        ("viscoelasticity", 0, (2.0,), (0.7,)),
        ("viscous-damping", 2, (), (0.3,)),
        ("cyclic-softening", 0, (0.5,), (0.3,)),
    ],
)
def test_any_section_effect_gives_the_columns_of_its_record(name, form, shape, strength):
    """For laws with and without memory: forces of the rod at one Gauss point against `respond`, 1e-9 of the largest."""
    one = active(name, "bending", shape, strength, form, largest=0.9, typical_tension=100.0)
    if len(one.form.shape) != len(shape) or len(one.form.strength) != len(strength):
        one = replace(
            one,
            shape=tuple(np.resize(shape or (0.5,), len(one.form.shape))),
            strength=tuple(np.resize(strength, len(one.form.strength))),
        )
    E, S = bent(RodLaw(SECTION, [one], tension=100.0), ANGLES, duration=0.5)
    kappa = np.concatenate([[0.0], E[:, 4, 5]])
    n = kappa.size
    path = BenchPath(
        "bending",
        kappa,
        np.linspace(0.0, 0.5 * (n - 1), n),
        LENGTH,
        np.full(n, 100.0),
        largest=0.9,
        typical_tension=100.0,
    )
    M = 6.0 * (kappa + one.form.respond(path, *one.shape) @ np.array(one.strength))[1:]
    assert np.abs(M - 6.0 * kappa[1:]).max() > 0.05
    np.testing.assert_allclose(S[:, 4, 5], M, rtol=0, atol=1e-9 * np.abs(M).max())


def stretched(law: RodLaw) -> RodModel:
    rod = Rod.straight(LENGTH, 3, SECTION, INERTIA)
    return RodModel(rod, straight(rod.s), [Support(0), Support(-1, travel=lambda t: pull(1e-3))], law=law)


def pull(u: float):
    return np.array([u, 0.0, 0.0]), np.zeros(3), np.zeros(3)


def test_stretched_rod_relaxes_like_a_maxwell_branch():
    """A sudden stretch held: N = EA eps (1 + a exp(-t / tau)), whatever the load steps (1e-8)."""
    maxwell = active("viscoelasticity", "tension", (2.0,), (0.7,))
    problem = stretched(RodLaw(SECTION, [maxwell]))
    tight = StaticSettings(force_tolerance=1e-9, moment_tolerance=1e-9)
    step = equilibrium(problem, duration=1e-12, settings=tight)
    t = 0.0
    for dt in (0.1, 0.4, 1.5, 3.0):
        step = equilibrium(problem, step.q, memory=step.memory, duration=dt, settings=tight)
        step.outcome.require_success()
        t += dt
        expected = 5e4 * 1e-3 / LENGTH * (1 + 0.7 * np.exp(-t / 2.0))
        np.testing.assert_allclose(step.forces.S[..., 0], expected, rtol=1e-8)


def test_loss_of_the_ledger_is_the_area_of_the_loop():
    """End pulled to and fro, amplitude A: per cycle 4 EA a x (A - x) times the length (1e-4: the turning points lie between steps); the
    balance of all energies is closed to 1e-5."""
    x, a, A = 4e-4, 1.5, 1e-3
    law = RodLaw(SECTION, [active("plasticity", "tension", (x,), (a,))])
    rod = Rod.straight(LENGTH, 2, SECTION, INERTIA)
    omega = 2 * np.pi

    def travel(t):
        ramp = 1 - np.exp(-((t / 0.5) ** 3))
        u = A * LENGTH * ramp * np.sin(omega * t)
        du, ddu = _derivatives(t, A * LENGTH, omega)
        return np.array([u, 0.0, 0.0]), np.array([du, 0.0, 0.0]), np.array([ddu, 0.0, 0.0])

    problem = RodModel(rod, straight(rod.s), [Support(0), Support(-1, travel=travel)], law=law)
    run = Integrator(problem, problem.q0, settings=StepSettings(1e-3, adaptive=False, absolute=1e-7))
    losses = []
    for _ in range(4):
        assert run.advance(1000), str(run.outcome)
        losses.append(run.ledger.totals["section_law"])
    loop = 4 * 5e4 * a * x * (A - x) * LENGTH
    assert losses[3] - losses[2] == pytest.approx(loop, rel=1e-4)
    assert abs(run.ledger.balance_error) < 1e-5


def _derivatives(t: float, size: float, omega: float) -> tuple[float, float]:
    """First and second derivative of size (1 - exp(-(2 t)^3)) sin(omega t)."""
    g = np.exp(-((t / 0.5) ** 3))
    r, dr, ddr = 1 - g, 24 * t**2 * g, (48 * t - 576 * t**4) * g
    s, c = np.sin(omega * t), np.cos(omega * t)
    return size * (dr * s + r * omega * c), size * (ddr * s + 2 * dr * omega * c - r * omega**2 * s)


def states(n: int = 5):
    rng = np.random.default_rng(2)
    scale = np.array([1e-3, 0, 0, 0.3, 0.5, 0.5])
    before = scale * rng.normal(size=(n, 6))
    return before + 0.3 * scale * rng.normal(size=(n, 6)), before


COUPLED = SectionStiffness(
    SECTION.C + 60.0 * (np.eye(6)[[2]].T @ np.eye(6)[[5]] + np.eye(6)[[5]].T @ np.eye(6)[[2]]), 1e-3
)


def test_tangent_is_the_derivative_of_the_forces():
    """Friction gripped by the rod's own tension, plasticity in twist, stiffening in tension and a coupling, with a coupled
    section: central differences agree to 1e-4 of the largest entry of each row."""
    law = RodLaw(
        COUPLED,
        [
            FRICTION,
            active("plasticity", "torsion", (0.1,), (0.5,)),
            active("viscoelasticity", "tension", (2.0,), (0.7,)),
            active("tension-torsion-coupling", "tension", (), (2e-3,)),
        ],
    )
    E, before = states()
    state = np.zeros((5, law.memory))
    _, T, _ = law.advance(E, before, 0.1, state, tangent=True)
    assert T is not None
    for k in range(6):
        d = 1e-5 * np.array([1e-3, 1, 1, 1, 1, 1])[k] * np.eye(6)[k]
        plus, minus = (law.advance(E + s * d, before, 0.1, state, tangent=False)[0] for s in (1, -1))
        expected = (plus - minus) / (2 * d[k])
        np.testing.assert_allclose(T[:, :, k], expected, rtol=1e-4, atol=1e-4 * np.abs(T[:, :, k]).max() + 1e-9)


def test_coupling_has_an_energy():
    """Stretch and twist coupled from one test: dN/dtau = dM/deps, also for a coupling that changes with amplitude."""
    for form, strength in ((0, (2e-3,)), (1, (2e-3, 5e-4, 1e-3))):
        law = RodLaw(SECTION, [active("tension-torsion-coupling", "tension", (), strength, form, largest=2e-3)])
        E, before = states()
        S, T, _ = law.advance(E, before, 0.1, np.zeros((5, 0)), tangent=True)
        assert T is not None
        np.testing.assert_allclose(T[:, 0, 3], T[:, 3, 0], rtol=1e-3)
        assert np.abs(S[:, 3]).max() > 0.01
    np.testing.assert_allclose(law.advance(E * [1, 1, 1, 0, 1, 1], before, 0.1, np.zeros((5, 0)), False)[0][:, 0], 0)


def test_linear_laws_are_isotropic_in_bending():
    """A relaxing branch turns with the plane of bending; a stick-slip limit is a square of at most sqrt(2)."""
    turn = np.array([[0.6, -0.8], [0.8, 0.6]])
    E, before = states()
    turned, turned_before = E.copy(), before.copy()
    turned[:, 4:], turned_before[:, 4:] = E[:, 4:] @ turn.T, before[:, 4:] @ turn.T
    law = RodLaw(SECTION, [active("viscoelasticity", "bending", (2.0,), (0.7,))])
    state = np.zeros((5, law.memory))
    M = law.advance(E, before, 0.1, state, False)[0][:, 4:]
    np.testing.assert_allclose(law.advance(turned, turned_before, 0.1, state, False)[0][:, 4:], M @ turn.T, atol=1e-12)
    slip = RodLaw(SECTION, [FRICTION], tension=100.0)
    far = np.zeros((2, 6))
    far[:, 4:] = [[5.0, 0.0], [5.0, 5.0]]
    size = np.linalg.norm(slip.advance(far, 0 * far, 1.0, np.zeros((2, slip.memory)), False)[0], axis=1)
    assert size[1] / size[0] == pytest.approx(np.sqrt(2))


@pytest.mark.parametrize(
    ("name", "kind", "sentence"),
    [
        ("rig-compliance", "bending", "not in the section: it cannot act in a rod"),
        ("sensor-lag", "bending", "acts in the sensor"),
        ("sensor-offset", "tension", "acts in the sensor"),
        ("plasticity", "shear", "no strain of the section: give it for tension, torsion or bending"),
    ],
)
def test_what_is_not_of_the_section_is_refused(name, kind, sentence):
    """A sentence that says where the effect acts."""
    form = find(name).forms[0]
    one = active(name, kind, (0.1,) * len(form.shape), (0.1,) * len(form.strength))
    with pytest.raises(InputError, match=sentence):
        RodLaw(SECTION, [one])


def test_coupling_given_twice_is_refused():
    """The tension test and the torsion test see one coupling."""
    both = [active("tension-torsion-coupling", kind, (), (1e-3,)) for kind in ("tension", "torsion")]
    with pytest.raises(InputError, match="given twice"):
        RodLaw(SECTION, both)


def test_neutral_effects_leave_the_rod_linear():
    """Strength zero: no memory, no force."""
    law = RodLaw(SECTION, [active("plasticity", "bending", (0.1,), (0.0,))])
    E, before = states()
    S, T, _ = law.advance(E, before, 1.0, np.zeros((5, law.memory)), True)
    assert law.memory == 0 and not S.any() and T is not None and not T.any()


def test_towing_with_friction_between_the_layers():
    """The bend travels through the cable and every section slips twice: more pull, and the balance is closed to 1e-5."""
    scenario = read_scenario("intelligent-horizontal").changed(
        chain="smeared", cable__elements=88, time__duration="3 s", drive__ramp_end="1.5 s"
    )
    section = published_section(scenario)
    law = RodLaw(section, [active("interlayer-friction", "bending", (0.5, 0.7), (2.0,), typical_tension=500.0)])
    linear, slipping = tow(scenario, section), tow(scenario, section, law=law)
    assert slipping.status == "completed"
    assert abs(slipping.balance_error) < 1e-5
    energy = slipping.dataset["energy"].sel(source="section_law").values
    assert energy[-1] - energy[len(energy) // 2] > 1.0
    pull = [run.dataset["pull_force"].values[:, 0] for run in (linear, slipping)]
    gain = [force[-1] - force[0] for force in pull]
    assert gain[1] > 1.05 * gain[0]
    assert "section_law" not in linear.dataset["source"].values
