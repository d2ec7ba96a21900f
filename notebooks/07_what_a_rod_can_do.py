# ---
# jupyter:
#   jupytext:
#     formats: ipynb,py:percent
#   kernelspec:
#     display_name: Python 3
#     name: python3
# ---

# %% [markdown]
# # What a rod can do
#
# **Question.** Can one believe the forces of a towing run? The element and the solver that compute it are put here to the classical
# problems, one by one, each beside its exact solution or beside what two independent codes agree on.

# %%
import matplotlib.pyplot as plt
import numpy as np

from beam.ancf_cable import AncfCable
from beam.benchmark_ancf_cable import CABLE2D_TIPS, elastica_tip
from beam.benchmark_dynamics import PENDULUM_TIPS, advanced, pendulum, swing
from beam.benchmark_friction import EA, MU, WEIGHT, cable_on_floor, capstan, pulled_cable
from beam.benchmark_statics import BEND_CASES, PRINCETON_CASES, princeton_tip, rolled
from beam.generalized_alpha import Integrator, StepSettings
from beam.incline_formula import towing_force_up
from beam.motion import SpeedRamp, Turn
from beam.rod import Rod
from beam.rod_model import RodModel, Support
from beam.shape import straight, strands_and_arcs
from beam.statics import equilibrium
from homogenize.section_stiffness import SectionInertia, SectionStiffness

testing = __name__ == "testing"
BLUE, ORANGE, GREEN, GREY = "#0072b2", "#d55e00", "#009e73", "0.45"
INERTIA = SectionInertia(1.0, 1e-3, 1e-3, 2e-3)
worst = {}


def panel(ax, title, xlabel, ylabel, equal=False):
    """The same dress for every picture."""
    ax.set(title=title, xlabel=xlabel, ylabel=ylabel)
    ax.spines[["top", "right"]].set_visible(False)
    if equal:
        ax.set_aspect("equal", adjustable="box")


def section(EA, GA, EI, GJ):
    """A section with one bending stiffness."""
    return SectionStiffness.uncoupled(EA=EA, GA_x=GA, GA_y=GA, EI_x=EI, EI_y=EI, GJ=GJ, area=1.0)


def at_rest(rod, supports, load, start=None):
    """The equilibrium, or a sentence."""
    result = equilibrium(RodModel(rod, straight(rod.s) if start is None else start, supports, load=load))
    result.outcome.require_success()
    return result


# %% [markdown]
# ## 1 Bent in the plane
#
# A cantilever rolled up by an end moment M is an arc of radius EI/M. Under a force across its end it is Euler's elastica, known by
# elliptic integrals. Twelve and 24 elements here.

# %%
fig, (left, right) = plt.subplots(1, 2, figsize=(11, 4.4))
for turns, colour in ((0.25, GREY), (0.5, BLUE), (1.0, ORANGE)):
    found = rolled(12, 1.0, 1e4, 1e4, 2.0, turns * 4 * np.pi)
    angle = np.linspace(0, 2 * np.pi * turns, 200)
    radius = 1 / (2 * np.pi * turns)
    left.plot(radius * np.sin(angle), radius * (1 - np.cos(angle)), color=colour, lw=1)
    left.plot(*found.q[:, :2].T, "o", ms=4, color=colour, label=f"M = {turns * 4:g} pi N m")
    tip = radius * np.array([np.sin(2 * np.pi * turns), 1 - np.cos(2 * np.pi * turns)])
    worst[f"roll-up, {turns:g} turn"] = float(np.linalg.norm(found.q[-1, :2] - tip))
panel(left, "Roll-up: arcs of radius EI/M", "x [m]", "y [m]", equal=True)
left.legend(frameon=False, fontsize=9)
forces = np.array([2.0, 5.0, 10.0, 20.0])
exact = np.array([elastica_tip(1.0, 2.0, F) for F in forces])
for k, F in enumerate(forces):
    rod = Rod.straight(1.0, 24, section(1e6, 1e6, 2.0, 2.0), INERTIA)
    load = np.zeros((25, 12))
    load[-1, 1] = -F
    q = at_rest(rod, [Support(0)], load).q
    right.plot(*q[:, :2].T, "o-", ms=3, color=BLUE, lw=0.8, label="rod, 24 elements" if k == 0 else None)
    worst[f"elastica, {F:g} N"] = float(np.hypot(q[-1, 0] - exact[k, 0], q[-1, 1] + exact[k, 1]))
fine = np.array([elastica_tip(1.0, 2.0, F) for F in np.geomspace(0.05, 25, 120)])
right.plot(fine[:, 0], -fine[:, 1], color=GREY, lw=1, label="elliptic integrals: path of the end")
right.plot(exact[:, 0], -exact[:, 1], "x", color=ORANGE, ms=9, mew=2, label="exact end")
panel(right, "Elastica: 2, 5, 10, 20 N across the end", "x [m]", "y [m]", equal=True)
right.set(xlim=(-0.05, 1.25), ylim=(-0.9, 0.3))
right.legend(frameon=False, fontsize=9, loc="upper left")
fig.tight_layout()
plt.show()
print({name: f"{1e3 * value:.4f} mm" for name, value in worst.items()})
assert worst["roll-up, 0.5 turn"] < 2e-5 and worst["roll-up, 1 turn"] < 2e-3
assert max(worst[f"elastica, {F:g} N"] for F in forces) < 3e-4

# %% [markdown]
# ## 2 Bent and twisted in space
#
# The Princeton beam is a blade whose end is loaded askew. The 45-degree bend is an eighth of a circle that is lifted out of its plane.
# For both, two independent codes agree to six digits. An end moment about a skew axis winds a straight rod into a helix: with the moment
# vector m = (m₁ along the helix' axis, m₂ across) the bending and torsional strains are those of a helix of the radius and pitch below.

# %%
fig, (left, right) = plt.subplots(1, 2, figsize=(11, 4.2))
cases = [c for c in PRINCETON_CASES if c[0] == 13.345 or not testing]
for load, colour in ((4.448, GREY), (8.896, ORANGE), (13.345, BLUE)):
    chosen = [c for c in cases if c[0] == load]
    if not chosen:
        continue
    tips = np.array([princeton_tip(16, load, degrees) for _, degrees, _ in chosen])
    published = np.array([tip for _, _, tip in chosen])
    angle = [degrees for _, degrees, _ in chosen]
    for component, mark in ((2, "o"), (1, "s")):
        left.plot(angle, 1e3 * np.abs(published[:, component]), color=colour, lw=1)
        left.plot(angle, 1e3 * np.abs(tips[:, component]), mark, ms=5, color=colour, mfc="w" if mark == "s" else colour)
    left.text(92, 1e3 * published[-1, 2], f"{load:g} N", color=colour, va="center")
    worst[f"Princeton beam, {load:g} N"] = float(np.abs(tips - published).max())
panel(left, "Princeton beam: two codes (lines), rod (marks)", "angle of the load [deg]", "end moves [mm]")
left.plot([], [], "o", color="k", label="flap (thin way)")
left.plot([], [], "s", mfc="w", color="k", label="lag (stiff way)")
left.legend(frameon=False, fontsize=9)
left.set_xlim(-5, 115)
bend = section(1e7, 5e6, 1e7 / 12, 1e7 / 12)
length = 100 * np.pi / 4
start = strands_and_arcs(np.linspace(0, length, 17), [(length, 1 / 100)])
rod = Rod.build(np.full(16, length / 16), bend, INERTIA, stress_free=start)
right.remove()
right = fig.add_subplot(1, 2, 2, projection="3d")
right.plot(*start[:, :3].T, color=GREY, lw=1, label="unloaded")
for (force, tip), colour in zip(BEND_CASES, (GREEN, ORANGE, BLUE), strict=True):
    load = np.zeros((17, 12))
    load[-1, 2] = force
    q = at_rest(rod, [Support(0)], load, start).q
    right.plot(*q[:, :3].T, "o-", ms=2.5, lw=1, color=colour, label=f"F = {force}")
    right.plot(*np.array(tip)[:, None], "x", color="k", ms=8, mew=1.5)
    worst[f"45-degree bend, F {force}"] = float(np.abs(q[-1, :3] - tip).max())
right.set(title="45-degree bend, end of two codes (x)", xlabel="x", ylabel="y", zlabel="z")
right.legend(frameon=False, fontsize=9, loc="upper left")
right.view_init(22, -62)
fig.tight_layout()
plt.show()
assert worst["Princeton beam, 13.345 N"] < 1e-5
assert max(worst[f"45-degree bend, F {F}"] for F, _ in BEND_CASES) < 1e-3

# %% [markdown]
# A helix of radius a and pitch angle α (tan α = rise over circumference) has the curvature κ = cos²α/a and the torsion τ = sin α cos α/a.
# For a rod with EI = GJ the moment EI (κ b + τ t) is parallel to the axis of the helix everywhere, so that an end moment along
# that axis alone holds it. The clamp is laid along the helix' first tangent; the moment is applied to the free end.

# %%
EI, a, alpha, turns = 2.0, 0.1, np.radians(35.0), 0.9
span = turns * 2 * np.pi * a / np.cos(alpha)
axis = np.array([np.sin(alpha), 0.0, np.cos(alpha)])  # the first tangent is x
moment = EI * np.cos(alpha) / a
rod = Rod.straight(span, 16, section(1e6, 1e6, EI, EI), INERTIA)
turn = rod.s * moment / EI  # R = exp(s m/EI axis): the rotation vector is linear in s
start = straight(rod.s)
start[:, 6:9], start[:, 9:12] = turn[:, None] * axis, moment / EI * axis


def helix(s):
    """Exact centre line: x-axis tangent turned about the axis by s m/EI."""
    e1 = np.array([1.0, 0.0, 0.0])
    along, across = axis * (axis @ e1), e1 - axis * (axis @ e1)
    third = np.cross(axis, e1)
    w = moment / EI
    return np.outer(s, along) + np.outer(np.sin(w * s) / w, across) + np.outer((1 - np.cos(w * s)) / w, third)


start[:, 0:3] = helix(rod.s)
start[:, 3:6] = np.gradient(helix(rod.s), rod.s, axis=0)
load = np.zeros((17, 12))
load[-1, 6:9] = moment * axis
found = at_rest(rod, [Support(0)], load, start)
line = helix(np.linspace(0, span, 300))
fig = plt.figure(figsize=(6.4, 5.2))
ax = fig.add_subplot(projection="3d")
ax.plot(*line.T, color=GREY, lw=1.2, label="exact helix")
ax.plot(*found.q[:, :3].T, "o", ms=4, color=BLUE, label="rod, 16 elements")
ax.set(title="A straight rod wound by one end moment", xlabel="x [m]", ylabel="y [m]", zlabel="z [m]")
ax.legend(frameon=False, loc="lower left", bbox_to_anchor=(-0.25, 0.9))
ax.set_aspect("equal")
for ticks in (ax.set_xticks, ax.set_yticks, ax.set_zticks):
    ticks([0, 0.1, 0.2])
ax.view_init(18, -125)
plt.show()
worst["helix"] = float(np.linalg.norm(found.q[:, :3] - helix(rod.s), axis=1).max())
print(f"helix of radius {1e3 * a:g} mm: nodes off by at most {1e3 * worst['helix']:.4f} mm")
assert worst["helix"] < 1e-4
np.testing.assert_allclose(found.forces.S[:, :, 3], moment * np.sin(alpha), rtol=2e-3)

# %% [markdown]
# ## 3 In motion
#
# A flexible pendulum falls from the horizontal. The marks are tips of two codes: an independent program with shear, and Exudyn's cable
# without. The ANCF cable of this package, which has no shear either, is drawn dashed.

# %%
fig, ax = plt.subplots(figsize=(7.6, 5.4))
steps, h = (10, 1e-3) if testing else (20, 5e-4)
tips = {}
for kind, style in ((Rod, "-"), (AncfCable, "--")):
    motion = swing(pendulum(16, kind=kind), h, 0.0)
    path = [motion.q[-1, :2].copy()]
    shapes = {}
    for k in range(60):
        advanced(motion, steps)
        path.append(motion.q[-1, :2].copy())
        if (k + 1) % 20 == 0:
            shapes[round(motion.t, 1)] = motion.q[:, :2].copy()
            tips[kind.name, round(motion.t, 1)] = motion.q[-1, :2].copy()
    path = np.array(path)
    ax.plot(path[:, 0], path[:, 1], style, color=GREY, lw=1.2, label=f"path of the tip, {kind.name}")
    for shape in shapes.values():
        ax.plot(shape[:, 0], shape[:, 1], style, color=BLUE if kind is Rod else ORANGE, lw=1.6)
    worst[f"pendulum, energy ({kind.name})"] = abs(motion.ledger.balance_error)
ax.plot(*np.array(list(PENDULUM_TIPS.values())).T, "x", color="k", ms=8, mew=1.5, label="published tips, with shear")
ax.plot(*np.array(list(CABLE2D_TIPS[7e6].values())).T, "+", color="k", ms=10, label="published tips, no shear")
panel(ax, "Flexible pendulum at 0.2, 0.4, 0.6 s", "x [m]", "y [m]", equal=True)
ax.set(xlim=(-0.7, 1.9), ylim=(-1.3, 0.6))
ax.legend(frameon=False, fontsize=9, loc="upper left", ncols=2)
plt.show()
for name, published in (("rod", PENDULUM_TIPS), ("ancf-cable", CABLE2D_TIPS[7e6])):
    for time, tip in published.items():
        worst[f"pendulum, {name}, {time} s"] = float(np.linalg.norm(tips[name, time] - np.array(tip)))
assert max(worst[f"pendulum, {n}, {t} s"] for n in ("rod", "ancf-cable") for t in (0.2, 0.4, 0.6)) < 2e-3

# %% [markdown]
# A blade on a hub is spun up to 6 rad/s in 15 s (after Simo and Vu-Quoc). It lags behind the hub while the speed grows, and stands
# straight afterwards, stretched by m ω² L³ / 3 EA.

# %%
L, speed, rise = 10.0, 6.0, 15.0


def hub(t):
    """Angle, speed and acceleration of the hub."""
    if t >= rise:
        return speed * t - 45.0, speed, 0.0
    w = 2 * np.pi / rise
    return (
        speed / rise * (t**2 / 2 + (np.cos(w * t) - 1) / w**2),
        speed / rise * (t - np.sin(w * t) / w),
        speed / rise * (1 - np.cos(w * t)),
    )


rod = Rod.straight(L, 8, section(2.8e7, 1e7, 1.4e4, 1.4e4), SectionInertia(1.2, 6e-4, 6e-4, 1.2e-3))
motion = Integrator(
    RodModel(rod, straight(rod.s), [Support(0, turn=Turn(hub))]), straight(rod.s), settings=StepSettings(2.5e-2)
)
times, seen = [], []
for _ in range(180):
    motion.advance(4)
    angle = hub(motion.t)[0]
    x, y = motion.q[-1, :2]
    times.append(motion.t)
    seen.append((x * np.cos(angle) + y * np.sin(angle) - L, y * np.cos(angle) - x * np.sin(angle)))
seen, times = np.array(seen), np.array(times)
reference = {2.5: -0.15141, 5: -0.46855, 7.5: -0.55907, 10: -0.36272, 12.5: -0.11263, 15: 1.29e-3}
fig, ax = plt.subplots(figsize=(7.6, 4))
ax.plot(times, seen[:, 1], color=BLUE, label="rod, 8 elements, steps of 25 ms")
ax.plot(list(reference), list(reference.values()), "x", color="k", ms=8, mew=1.5, label="another code, 32 elements")
panel(ax, "Spin-up: how far the tip lags", "time [s]", "tip across the turning hub's axis [m]")
ax.legend(frameon=False, fontsize=9, loc="lower right")
plt.show()
lag = np.interp(list(reference), times, seen[:, 1])
stretch = float(seen[times > 16, 0].mean())
expected = 1.2 * speed**2 * L**3 / (3 * 2.8e7)
worst["spin-up, lag"] = float(np.abs(lag - list(reference.values())).max())
print(f"largest lag {seen[:, 1].min():.4f} m; steady stretch {1e3 * stretch:.4f} mm, exact {1e3 * expected:.4f} mm")
assert worst["spin-up, lag"] < 6e-3
assert abs(stretch / expected - 1) < 0.05

# %% [markdown]
# ## 4 With friction
#
# A cable on a floor, pulled slowly by u at one end, slips over the length F/(μ w) and sticks beyond: F = √(2 EA μ w u). Round a drum that
# does not turn, the tension grows as exp(μ β). Up a slope, towing needs m g L (μ cos a + sin a).

# %%
fig, (left, middle, right) = plt.subplots(1, 3, figsize=(14, 4.3))
motion, cones = pulled_cable()
s = motion.model.rod.s
tension = np.interp(s, *np.array([((s[:-1] + s[1:]) / 2), motion.forces.S[:, 1, 0]]))
pull = np.sqrt(2 * EA * MU * WEIGHT * 5e-3)
left.plot(s, np.maximum(pull - MU * WEIGHT * (16 - s), 0), color=GREY, lw=1.2, label="exact")
left.plot(s[::2], tension[::2], "o", ms=4, color=BLUE, label="rod, 64 elements")
panel(left, "Pulled by 5 mm: slips, then sticks", "arc length [m]", "tension [N]")
left.legend(frameon=False)
worst["stick-slip, pull"] = abs(float(motion.reaction[-1, 0]) / pull - 1)
angles = (90, 180) if testing else (90, 135, 180)
grip = {b: next(x for x in capstan(0.3, np.radians(b)) if "T2 / T1" in x.quantity) for b in angles}
beta = np.linspace(60, 200, 100)
middle.plot(beta, np.exp(0.3 * np.radians(beta)), color=GREY, lw=1.2, label="exp(0.3 β)")
middle.plot(list(grip), [x.computed for x in grip.values()], "o", color=BLUE, label="rod, 40 elements on the arc")
panel(middle, "Capstan: tension ratio over a fixed drum", "angle β on the drum [deg]", "T2 / T1")
middle.legend(frameon=False)
worst["capstan"] = max(abs(x.computed / x.expected - 1) for x in grip.values())
slopes = (0.0, 0.4) if testing else (-0.2, 0.0, 0.2, 0.4)
found = []
for slope in slopes:
    model = cable_on_floor(12, [Support(-1, ("x", "theta"), SpeedRamp(0.2, 0.1, 0.9))], slope=slope, bristle_ratio=0.5)
    motion = advanced(Integrator(model, model.q0, settings=StepSettings(5e-3)), 600)
    values = []
    motion.advance(100, lambda m, values=values: values.append(m.reaction[-1, 0]))
    found.append(np.mean(values))
smooth = np.linspace(-0.25, 0.45, 50)
right.plot(np.degrees(smooth), towing_force_up(160.0, smooth, 0.3), color=GREY, lw=1.2, label="m g L (μ cos a + sin a)")
right.plot(np.degrees(slopes), found, "o", color=BLUE, label="rod, steady towing")
panel(right, "Towing up a slope", "inclination a [deg]", "pull [N]")
right.legend(frameon=False)
fig.tight_layout()
plt.show()
worst["incline"] = float(np.abs(np.array(found) / towing_force_up(160.0, np.array(slopes), 0.3) - 1).max())
print({k: f"{100 * worst[k]:.2f} %" for k in ("stick-slip, pull", "capstan", "incline")})
assert worst["stick-slip, pull"] < 3e-3 and worst["capstan"] < 1e-2 and worst["incline"] < 5e-3

# %% [markdown]
# ## Answer
#
# Every classical case is met with eight to thirty-two elements: shapes to a thousandth of the length or better, forces with friction to
# better than half a percent, the capstan to one. What is not tested by these cases is in the verification page: damping that leaves the
# static shape alone, the error of the interpolated rotation vector under a superposed turn, the order of the time steps.
#
# **What would change this conclusion.** Shear so soft that √(EI/GA) reaches the bend radius (then take the rod, never the ANCF
# cable); loops tighter than five elements a turn; contact lengths shorter than an element.
