"""A rod on a floor whose friction falls with sliding speed, and with a viscous drag: steady sliding, deceleration, the chain."""

import numpy as np
import pytest

from beam import read_scenario, tow
from beam.axial_chain import AxialChain
from beam.benchmark_friction import EA, LENGTH, MU, WEIGHT, cable_on_floor
from beam.generalized_alpha import Integrator, StepSettings
from beam.motion import SpeedRamp
from beam.rigid_body import RigidBody
from beam.rod_model import Blocks, RodModel
from beam.shape import straight
from beam.sliding_friction import coefficient_slope
from beam.statics import equilibrium
from beam.support import Support
from beam.surface import ContactLaw, Plane
from geometry.errors import SpecError

FALL, V_FALL = 0.2, 0.05


def law(power=1.0, drag=0.0, friction=MU, fall=FALL, ratio=5.0):
    return ContactLaw(friction=friction, bristle_ratio=ratio, fall=fall, fall_speed=V_FALL, fall_power=power, drag=drag)


def on_floor(contact, elements, supports, length=2.0):
    model = cable_on_floor(elements, supports, length=length)
    return RodModel(model.rod, model.q0, supports, gravity=(0.0, -9.81, 0.0), surfaces=[Plane("floor", contact)])


def pulled(contact, speed, steps, elements=4, length=2.0, ramp=0.2, dt=4e-3):
    model = on_floor(contact, elements, [Support(-1, ("x", "theta"), SpeedRamp(speed, 0.0, ramp))], length)
    start = equilibrium(model)
    start.outcome.require_success()
    motion = Integrator(model, start.q, anchors=start.anchors, settings=StepSettings(dt))
    read = []
    assert motion.advance(steps, lambda m: read.append((m.t, float(m.reaction[-1, 0]))))
    return motion, np.array(read)


@pytest.mark.parametrize("power", [0.0, 1.0, 2.0, 0.5])
def test_the_coefficient_is_that_of_the_chain_and_its_slope_the_derivative(power):
    """mu + fall exp(-(v/v_s)^p), rational for p = 0; slope by central differences."""
    chain = AxialChain(1.0, 1.0, 1.0, MU, fall=FALL, fall_speed=V_FALL, fall_power=power)
    p = Plane("floor", law(power)).parameters(0.0)
    for v in (0.003, 0.04, 0.2):
        assert law(power).coefficient(v) == pytest.approx(MU + chain.excess(v), rel=1e-14)
        slope = (chain.excess(v + 1e-6) - chain.excess(v - 1e-6)) / 2e-6
        assert coefficient_slope(p, v) == pytest.approx(slope, rel=1e-7)
    assert law(power).coefficient(0.0) == MU + FALL


@pytest.mark.parametrize(("speed", "power"), [(0.02, 1.0), (0.1, 1.0), (0.1, 0.0)])
def test_steady_sliding_is_pulled_by_the_friction_of_its_speed(speed, power):
    """T = (mu(v) m g + c v) L."""
    motion, read = pulled(law(power, drag=30.0), speed, 300)
    expected = (law(power).coefficient(speed) * WEIGHT + 30.0 * speed) * 2.0
    assert read[-1, 1] == pytest.approx(expected, rel=1e-5)  # what is left of the first jerk
    (floor,) = motion.contacts
    assert floor.slips.all() and floor.use.max() == pytest.approx(1.0, abs=1e-12)
    assert floor.friction.sum() == pytest.approx(law(power).coefficient(speed) * WEIGHT * 2.0, rel=1e-5)
    assert floor.force[..., 0].sum() == pytest.approx(-expected, rel=1e-5)
    assert abs(motion.ledger.balance_error) < 1e-4


def test_at_rest_the_cone_is_the_upper_one():
    """On a slope between arctan(mu) and arctan(mu + fall) the cable rests, and slides without the fall."""
    slope = np.arctan(MU + 0.5 * FALL)
    for fall, rests in ((FALL, True), (0.0, False)):
        model = cable_on_floor(4, [], length=2.0, slope=slope)
        floor = [Plane("floor", law(fall=fall))]
        gravity = 9.81 * np.array([-np.sin(slope), -np.cos(slope), 0.0])
        motion = Integrator(RodModel(model.rod, model.q0, gravity=gravity, surfaces=floor), model.q0)
        assert motion.advance(100)
        assert (abs(motion.v[0, 0]) < 1e-4) == rests
        assert (motion.contacts[0].use.max() < 0.99) == rests


def test_a_gliding_cable_is_slowed_by_the_friction_of_its_speed_and_drag():
    """dv/dt = -mu(v) g - c v / m, by its own fine integration, within 2e-5 of the speed at the start; energy closes."""
    contact = law(drag=20.0)
    model = on_floor(contact, 4, [])
    v = np.zeros_like(model.q0)
    v[:, 0] = 0.3
    motion = Integrator(model, model.q0, v=v, settings=StepSettings(1e-3))
    read = []
    assert motion.advance(60, lambda m: read.append((m.t, float(m.v[:, 0].mean()))))
    at, speed = np.array(read).T
    fine = np.linspace(0.0, at[-1], 6001)
    glide = [0.3]
    for h in np.diff(fine):

        def rate(u):
            return -contact.coefficient(u) * 9.81 - 2.0 * u

        middle = glide[-1] + 0.5 * h * rate(glide[-1])
        glide.append(glide[-1] + h * rate(middle))
    assert glide[-1] > 0.02
    np.testing.assert_allclose(speed, np.interp(at, fine, glide), rtol=0, atol=2e-5 * 0.3)
    assert abs(motion.ledger.balance_error) < 1e-5
    assert motion.ledger.totals["friction_loss"] > 0


def test_statics_without_friction_is_without_its_fall():
    """Anchors far behind pull with nothing while friction is left out, and with mu + fall after that."""
    model = on_floor(law(), 4, [])
    (anchors,) = model.forces(0.0, model.q0, 0 * model.q0, model.fresh_anchors()).moved
    pulls = [
        model.forces(0.0, model.q0, 0 * model.q0, [anchors - [0.1, 0.0, 0.0]], friction=on).friction[:, 0].sum()
        for on in (False, True)
    ]
    np.testing.assert_allclose(pulls, [0.0, -(MU + FALL) * WEIGHT * 2.0], rtol=1e-9)


def test_no_fall_and_no_drag_is_coulomb_to_the_last_digit():
    """The speed and the power of a fall of nothing change no number."""

    def bits(contact):
        motion, read = pulled(contact, 0.1, 60)
        return motion.q.tobytes() + motion.v.tobytes() + read.tobytes() + repr(motion.ledger.totals).encode()

    assert bits(ContactLaw(friction=MU, bristle_ratio=5.0)) == bits(law(2.0, fall=0.0))


@pytest.mark.parametrize(("slip", "speed"), [(1e-7, 0.0), (1e-2, 0.05), (1e-2, -0.05)])
@pytest.mark.parametrize("power", [0.0, 1.0])
def test_the_tangent_is_the_derivative(slip, speed, power):
    """Stick and slip, onward and turning back: central differences of the force along q and v = factor q at once."""
    model = on_floor(ContactLaw(1e5, 0.4, 1e-3, fall=0.3, fall_speed=V_FALL, fall_power=power, drag=50.0), 2, [], 1.2)
    rng, factor, step = np.random.default_rng(7), 25.0, 1e-6
    q = model.q0 + 1e-3 * rng.normal(size=model.q0.shape)
    q[:, 1] = -2e-3
    q[:, 3:6] = [1.0, 0.0, 0.0]
    v = 1e-3 * rng.normal(size=q.shape)
    (anchors,) = model.forces(0.0, q, 0 * v, model.fresh_anchors()).moved
    anchors = [anchors + np.array([-slip, 0.0, 0.4 * slip])]
    v[:, 0] += speed
    v[:, 2] -= 0.4 * speed
    blocks = Blocks.zeros(model.rod.nodes)
    model.forces(0.0, q, v, anchors, blocks=blocks, factor=factor)
    n = blocks.D.shape[0]
    A = np.zeros((n, 12, n, 12))
    for i in range(n):
        A[i, :, i] = blocks.D[i]
        if i + 1 < n:
            A[i, :, i + 1], A[i + 1, :, i] = blocks.U[i], blocks.L[i]
    columns = []
    for k in range(q.size):
        d = np.zeros(q.size)
        d[k] = step
        d = d.reshape(q.shape)
        plus = model.forces(0.0, q + d, v + factor * d, anchors).F
        minus = model.forces(0.0, q - d, v - factor * d, anchors).F
        columns.append(((plus - minus) / (2 * step)).ravel())
    columns = np.array(columns).T
    np.testing.assert_allclose(A.reshape(columns.shape), columns, rtol=0, atol=1e-5 * np.abs(columns).max())


def test_the_pull_of_the_chain_is_that_of_the_rod():
    """One end led from rest to 0.1 m/s: within 0.2 % of the friction at rest, rms over the run, in N; energies close."""
    motion, read = pulled(law(drag=20.0), 0.1, 200, elements=20, length=LENGTH, ramp=0.6)
    at, rod = read.T
    travel = (MU + FALL) * WEIGHT / (5.0 * 1.25e6)
    chain = AxialChain(
        LENGTH, EA, 10.0, MU, presliding=travel, damping_ratio=0.0, elements=64, fall=FALL, fall_speed=V_FALL, drag=20.0
    )
    chain = AxialChain(**{**vars(chain), "damping_ratio": 2.5e-3 * chain.first_frequency})
    time, ramp = 4e-3 * np.arange(201.0), SpeedRamp(0.1, 0.0, 0.6)
    run = chain.run(time, np.array([ramp(t)[0][0] for t in time]), substeps=4)
    limit = (MU + FALL) * WEIGHT * LENGTH

    assert rod.max() > 1.1 * rod[-1]
    assert np.sqrt(np.mean((np.interp(at, time, run.tension) - rod) ** 2)) < 0.002 * limit
    assert abs(motion.ledger.balance_error) < 2e-4


def test_a_body_slides_by_the_same_law():
    """A stone that glides: deceleration mu(v) g + c L v / m, cone and friction of its contact report."""
    contact = law(drag=20.0)
    rod = cable_on_floor(4, [], length=2.0).rod
    q = straight(rod.s)
    q[:, 1] = 1.0
    stone = RigidBody(
        "stone",
        1.0,
        (1e-3, 1e-3, 1e-3),
        (0.0, -9.81 / (0.1 * 1.25e6), 0.0),
        points=((0.0, 0.0, 0.0),),
        contact_length=0.1,
    )
    model = RodModel(
        rod, q, [Support(0), Support(-1)], (0.0, -9.81, 0.0), bodies=[stone], body_surfaces=[Plane("floor", contact)]
    )
    for speed in (0.02, 0.1):
        v = np.zeros_like(model.q0)
        v[-1, 0] = speed
        forces = model.forces(0.0, model.q0, v, model.fresh_anchors())
        friction = contact.coefficient(speed) * 9.81
        assert forces.body_contact[0, 0] == pytest.approx(-friction - 20.0 * 0.1 * speed, rel=1e-6)
        assert forces.friction_power == pytest.approx((friction + 2.0 * speed) * speed, rel=1e-6)


@pytest.mark.parametrize("element", ["rod", "ancf-cable"])
def test_a_towing_scenario_has_both_on_its_deck(element):
    """Deck friction over normal force is mu(v) of the shearer; the pull rises by what friction and drag do on it, c v L."""
    base = read_scenario("intelligent-horizontal").changed(
        chain="smeared", cable__length="8 m", cable__elements=44, layout__upper_strand="4 m", time__duration="1.2 s",
        drive__ramp_start="0 s", drive__ramp_end="0.6 s", element=element,
    )  # fmt: skip
    changed = base.changed(
        contact__friction_fall="0.2", contact__fall_speed="50 mm/s", contact__fall_power=2, contact__drag="100 N s/m^2"
    )
    speed = base.drive.speed.value
    plain, slowed = (tow(scenario) for scenario in (base, changed))
    ends = []
    for run, extra in ((plain, 0.0), (slowed, 0.2 * np.exp(-((speed / 0.05) ** 2)))):
        assert run.outcome.completed and abs(run.balance_error) < 1e-4
        normal, friction = (run.frames.values(f"surface_{name}")[-1, 1] for name in ("normal", "friction"))
        assert friction == pytest.approx((0.3 + extra) * normal, rel=2e-3)  # waves of the strand
        along = float(-run.frames.values("surface_force")[-1, 1, 0])
        ends.append((float(run.frames.values("pull_force")[-1, 0]), along, along - friction))
        lies = int((run.frames.values("contact_normal")[-1, :, 1] > 0).sum()) * 8.0 / 44
    (pull, _, none), (more, along, drag) = ends
    last = [slowed.frames.values(name)[-1] for name in ("pull_force", "supply_reaction", "surface_force")]
    assert none == pytest.approx(0.0, abs=1e-2) and drag == pytest.approx(100.0 * speed * lies, rel=0.05)  # one element
    assert sum(float(np.sum(x[..., 0])) for x in last) == pytest.approx(0.0, abs=0.3)  # but for inertia
    assert 0.85 < (more - pull) / (along - ends[0][1]) < 1.0  # a longer strand holds the bend by less


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        ({"friction_fall": "0.1"}, "add contact.fall_speed"),
        ({"fall_speed": "1 m/s"}, "add contact.friction_fall"),
        ({"friction_fall": "0.1", "fall_speed": "1 m/s", "fall_power": 1.5}, "contact.fall_power is 1.5"),
        ({"friction_fall": "-0.1", "fall_speed": "1 m/s"}, "outside what can be computed"),
        ({"drag": "-1 N s/m^2"}, "outside what can be computed"),
    ],
)
def test_a_fall_that_cannot_be_is_refused(changes, expected):
    with pytest.raises(SpecError, match=expected):
        read_scenario("intelligent-horizontal").changed(**{f"contact__{k}": v for k, v in changes.items()})
