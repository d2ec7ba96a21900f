# ---
# jupyter:
#   jupytext:
#     formats: ipynb,py:percent
#   kernelspec:
#     display_name: Python 3
#     name: python3
# ---

# %% [markdown]
# # What makes the stiffness
#
# **Question.** The copper of a shearer cable is the same in all of its data sheets, and yet its stiffness can be a dozen megapascals or
# gigapascals. What decides: the lay, the rubber's Poisson's ratio, whether the ends can twist, or whether the conductors stick in their
# insulation? Each is swept here by itself, with the limits of the textbook drawn in.

# %%
import re
import tempfile
from functools import cache
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from geometry import cable_files, read_cable
from homogenize import homogenize_cable
from homogenize.stiffness_bounds import loose_stiffness

testing = __name__ == "testing"
text = cable_files()["mcpt-1.9-3.3-3x35"].read_text(encoding="utf-8")
folder = Path(tempfile.mkdtemp())
size = 7e-3  # of the elements in the bulk; thin layers are finer by themselves
BLUE, ORANGE, GREY = "#0072b2", "#d55e00", "0.45"


@cache
def variant(lay=0.234, nu=0.49):
    """The reference cable with another cabling lay [m], or another Poisson's ratio of everything that has 0.49: the rubbers."""
    new = re.sub(r'(lay = \{ value = )"234 mm"', rf'\1"{1e3 * lay:g} mm"', text)
    new = re.sub(r"(nu = \{ value = )0\.49,", rf"\g<1>{nu},", new)
    file = folder / f"lay-{1e3 * lay:g}-nu-{nu}.toml"
    file.write_text(new, encoding="utf-8")
    return read_cable(file)


@cache
def solved(interface="bonded", lay=0.234, nu=0.49):
    """The 6x6 averaged over the pitch, and the volume averages."""
    return homogenize_cable(variant(lay, nu), interface=interface, size=size)


# %% [markdown]
# ## The textbook limits
#
# Laid conductors at the angle β and the radius r carry S = Σ E A₀ (A₀: normal section); s = sin β, c = cos β. The rubber has the area
# A_r, the shear modulus G_r and, spread over its area, J = A_r²/2π.
#
# | limit | EA |
# |---|---|
# | rule of mixtures: everything straight | Σ E A₀ |
# | twist blocked, radius held | E_c A_c + S c³ |
# | twist blocked, rubber incompressible | E_c A_c + (S/c)(c² − s²/2)² + 3 G_r A_r |
# | ends free, rubber incompressible | E_c A_c + G_r J (c/s)²/r² + 3 G_r A_r |
# | any interface, any ends | E_c A_c, the straight centre |
#
# The middle rows let the rubber between the conductors deform evenly. A real one also lets them cut through it, which is softer: rows
# two and three are upper estimates, row four is a limit for small angles only.


# %%
def limits(cable):
    """The rows of the table [N], and the limits of EI and GJ [N m²]."""
    conductors = [p for p in cable.parts if p.kind == "conductor"]
    centre = sum(p.material.E * p.area for p in conductors if p.centre_radius == 0)
    laid = [p for p in conductors if p.centre_radius > 0]
    soft = [p for p in cable.parts if p.kind != "conductor"]
    area = sum(p.area for p in soft)
    G = sum(p.material.G * p.area for p in soft) / area
    beta, r = laid[0].lay_angle, laid[0].centre_radius
    s, c = np.sin(beta), np.cos(beta)
    S = sum(p.material.E * np.pi * p.outer_radius**2 for p in laid)
    rubber = 3 * G * area
    own = sum(p.material.E * np.pi * p.outer_radius**4 / 4 for p in conductors)
    soft_bending = sum(p.material.E * (p.moments[3] + p.moments[4]) / 2 for p in soft)
    soft_torsion = sum(p.material.G * (p.moments[3] + p.moments[4]) for p in soft)
    return {
        "beta": np.degrees(beta),
        "mixture": centre + S + rubber,
        "stiff radius": centre + S * c**3 + rubber,
        "incompressible": centre + S / c * (c**2 - s**2 / 2) ** 2 + rubber,
        "free": centre + G * area**2 / (2 * np.pi) * (c / s) ** 2 / r**2 + rubber,
        "centre": centre,
        "EI slip": own + soft_bending,
        "EI stick": own + soft_bending + S * c**3 * r**2 / 2,
        "EI wires": loose_stiffness(cable).EI,
        "GJ slip": soft_torsion,
        "GJ stick": soft_torsion + S * c * s**2 * r**2 + own / (1 + 0.34),
    }


# %% [markdown]
# ## 1 The lay, with the twist blocked and free

# %%
lays = (0.234, 1.0) if testing else (0.234, 0.3, 0.42, 1.0)
sections = {k: [solved(k, lay).section for lay in lays] for k in ("bonded", "frictionless")}
beta = np.array([limits(variant(lay))["beta"] for lay in lays])
smooth = [limits(variant(lay)) for lay in 0.234 / np.linspace(1.0, 0.22, 5 if testing else 25)]
angle = np.array([b["beta"] for b in smooth])


def bound(ax, name, words, style, scale, shift=0):
    """A limit over the lay angle, named at its right end."""
    values = [b[name] / scale for b in smooth]
    ax.plot(angle, values, style, color=GREY, lw=1.2)
    ax.annotate(
        words,
        (angle[0], values[0]),
        xytext=(6, shift),
        textcoords="offset points",
        color="0.3",
        va="center",
        fontsize=9,
    )


def lay_axes(ax, title, ylabel, ticks):
    """Logarithmic values over the lay angle, with room for words on the right."""
    ax.set(xlabel="lay angle of the cores [deg]", ylabel=ylabel, title=title, yscale="log", xlim=(3.5, 25))
    ax.set_xticks(range(4, 19, 2))
    ax.set_yticks(ticks, [f"{t:g}" for t in ticks])
    ax.set_yticks([], minor=True)
    ax.spines[["top", "right"]].set_visible(False)


fig, ax = plt.subplots(figsize=(9, 5.2))
for k, colour in (("bonded", BLUE), ("frictionless", ORANGE)):
    ax.plot(beta, [s.EA_blocked_twist / 1e6 for s in sections[k]], "o-", color=colour, label=f"twist blocked, {k}")
    ax.plot(beta, [s.EA_free_twist / 1e6 for s in sections[k]], "o--", mfc="w", color=colour, label=f"ends free, {k}")
bound(ax, "mixture", "rule of mixtures", ":", 1e6)
bound(ax, "stiff radius", "radius held, cos³", "-", 1e6, 3)
bound(ax, "incompressible", "incompressible, twist blocked", "-.", 1e6, -4)
bound(ax, "free", "incompressible, ends free,\nslack conductors", "--", 1e6, 8)
bound(ax, "centre", "straight centre alone", ":", 1e6, -4)
lay_axes(ax, "Axial stiffness over the lay", "EA [MN]", [2, 3, 5, 10, 15])
ax.legend(frameon=False, loc=(0.68, 0.4), fontsize=9)
plt.show()

# %%
short, long = 0, len(lays) - 1
for k, found in sections.items():
    for s, lay in zip(found, lays, strict=True):
        b = limits(variant(lay))
        assert b["centre"] < s.EA_free_twist < s.EA_blocked_twist < b["stiff radius"] < b["mixture"]
    gain = found[long].EA_blocked_twist / found[short].EA_blocked_twist
    print(f"{k}: from {beta[short]:.1f} to {beta[long]:.1f} deg the blocked EA grows {gain:.2f} times, to "
          f"{found[long].EA_blocked_twist / limits(variant(lays[long]))['mixture']:.3f} of the rule of mixtures")  # fmt: skip
assert sections["bonded"][long].EA_blocked_twist > 2.6 * sections["bonded"][short].EA_blocked_twist
assert sections["bonded"][long].EA_blocked_twist > 0.9 * limits(variant(lays[long]))["mixture"]

# %% [markdown]
# The lay is the strongest single number: at 17 degrees two thirds of the copper's stiffness are gone, because the conductors cut
# through the rubber towards the axis instead of stretching. cos³ would have taken an eighth.
#
# ## 2 The rubber's Poisson's ratio
#
# What holds the conductors out is the rubber's bulk modulus E / 3(1 − 2ν): ten times larger at 0.499 than at 0.49.

# %%
ratios = (0.45, 0.4999) if testing else (0.45, 0.48, 0.49, 0.499, 0.4999)
by_ratio = {nu: solved("bonded", nu=nu).section for nu in ratios}
fig, ax = plt.subplots(figsize=(8, 4.4))
slack = [1 - 2 * nu for nu in ratios]
ax.plot(slack, [s.EA_blocked_twist / 1e6 for s in by_ratio.values()], "o-", color=BLUE, label="twist blocked")
ax.plot(slack, [s.EA_free_twist / 1e6 for s in by_ratio.values()], "o--", mfc="w", color=BLUE, label="ends free")
at = [limits(variant(nu=nu)) for nu in ratios]
ax.plot(slack, [b["incompressible"] / 1e6 for b in at], "-.", color=GREY, label="incompressible, even strain")
ax.plot(slack, [b["centre"] / 1e6 for b in at], ":", color=GREY, label="straight centre alone")
ax.set(
    xscale="log",
    xlabel="1 - 2 nu of the rubbers",
    ylabel="EA [MN]",
    title="Axial stiffness over Poisson's ratio",
    ylim=(0, 13),
)
ax.set_xticks(slack, [f"{x:.2g}\nnu {nu:g}" for x, nu in zip(slack, ratios, strict=True)])
ax.set_xticks([], minor=True)
ax.invert_xaxis()
ax.spines[["top", "right"]].set_visible(False)
ax.legend(frameon=False, loc=(0.02, 0.6), fontsize=9)
plt.show()
spread = by_ratio[0.4999].EA_blocked_twist / by_ratio[0.45].EA_blocked_twist
spread_free = by_ratio[0.4999].EA_free_twist / by_ratio[0.45].EA_free_twist
print(f"from 0.45 to 0.4999: blocked EA {spread:.2f} times, free {spread_free:.2f} times")
assert 1.1 < spread < 2.5 and spread_free < spread
assert all(s.EA_blocked_twist < b["incompressible"] for s, b in zip(by_ratio.values(), at, strict=True))

# %% [markdown]
# ## 3 The ends
#
# Between blocked and free lies a torsional spring k (torque per twist per length, of the machine or of the rest of the cable): EA = C33
# − C36² / (C66 + k).

# %%
reference = {k: solved(k).section for k in ("bonded", "frictionless")}
spring = np.geomspace(0.1, 1e5, 200)
fig, ax = plt.subplots(figsize=(8, 4.2))
for (k, s), colour in zip(reference.items(), (BLUE, ORANGE), strict=True):
    held = s.C[2, 2] - s.C[2, 5] ** 2 / (s.C[5, 5] + spring)
    ax.semilogx(spring, held / 1e6, color=colour, label=k)
    ax.plot(s.GJ, (s.C[2, 2] - s.C[2, 5] ** 2 / (2 * s.GJ)) / 1e6, "o", color=colour)
ax.annotate(
    "k = GJ of the cable",
    (reference["bonded"].GJ, 4.51),
    xytext=(12, -12),
    textcoords="offset points",
    color="0.3",
    fontsize=9,
)
ax.set(
    xlabel="torsional stiffness k of the ends [N m²]",
    ylabel="EA [MN]",
    title="From free to blocked ends",
    ylim=(3, 5.6),
)
ax.spines[["top", "right"]].set_visible(False)
ax.legend(frameon=False, loc="upper left")
plt.show()
ends = {k: s.EA_blocked_twist / s.EA_free_twist for k, s in reference.items()}
print("blocked over free:", {k: round(float(r), 3) for k, r in ends.items()})
assert 1.3 < ends["bonded"] < 1.4 and 1.1 < ends["frictionless"] < 1.25
straight = {k: found[long].EA_blocked_twist / found[long].EA_free_twist for k, found in sections.items()}
assert max(straight.values()) < ends["bonded"]

# %% [markdown]
# The gap between both ends is smaller than the slack limit of section 1 says, because solid conductors resist being twisted back.
# Conductors of strands that slide resist less: `two_stage(cable, "frictionless")` gives 2.3 MN with free ends (docs/section-
# stiffness.md).
#
# ## 4 The interface: bending and torsion

# %%
fig, (left, right) = plt.subplots(1, 2, figsize=(12, 4.8))
for k, colour in (("bonded", BLUE), ("frictionless", ORANGE)):
    left.plot(beta, [s.EI_x for s in sections[k]], "o-", color=colour, label=k)
    right.plot(beta, [s.GJ for s in sections[k]], "o-", color=colour, label=k)
bound(left, "EI stick", "all sections plane (stick)", "-", 1)
bound(left, "EI slip", "conductors each by itself", "--", 1)
bound(left, "EI wires", "every wire by itself (slip)", ":", 1)
bound(right, "GJ stick", "conductors held along", "-", 1)
bound(right, "GJ slip", "rubber alone", ":", 1)
lay_axes(left, "Bending stiffness", "EI [N m²]", [2, 10, 50, 100, 500, 1000])
lay_axes(right, "Torsional stiffness, stretch blocked", "GJ [N m²]", [2, 10, 50, 100, 200])
left.legend(frameon=False, loc=(0.05, 0.25))
fig.tight_layout()
plt.show()

# %%
for found in sections.values():
    for s, lay in zip(found, lays, strict=True):
        b = limits(variant(lay))
        assert b["EI wires"] < s.EI_x < b["EI stick"] and b["GJ slip"] < s.GJ < b["GJ stick"]
b, s = limits(variant()), reference
print(
    f"EI: bonded {s['bonded'].EI_x:.1f}, frictionless {s['frictionless'].EI_x:.1f} N m2; limits {b['EI wires']:.1f} .. {b['EI stick']:.0f}"
)
print(
    f"GJ: bonded {s['bonded'].GJ:.1f}, frictionless {s['frictionless'].GJ:.1f} N m2; limits {b['GJ slip']:.1f} .. {b['GJ stick']:.0f}"
)
assert abs(s["frictionless"].EI_x / b["EI slip"] - 1) < 0.06
assert s["bonded"].EI_x < 0.1 * b["EI stick"]
for k in ("EA_blocked_twist", "EA_free_twist", "GJ", "EI_x"):
    assert getattr(s["frictionless"], k) < getattr(s["bonded"], k)

# %% [markdown]
# Bonded does not mean plane sections. The rubber between the conductors shears instead (1.3 MPa of shear modulus against 60 GPa of
# copper), so that the bonded cable bends at a twelfth of the stick limit, and at 17 degrees less than a tenth above its sliding value.
# The rubber's thickness, not the glue, decides.
#
# ## Answer

# %%
effect = {
    "lay 17.3 → 4.2 deg": sections["bonded"][long].EA_blocked_twist / sections["bonded"][short].EA_blocked_twist,
    "Poisson's ratio 0.45 → 0.4999": spread,
    "ends free → blocked": ends["bonded"],
    "conductors slide → bonded": s["bonded"].EA_blocked_twist / s["frictionless"].EA_blocked_twist,
}
fig, ax = plt.subplots(figsize=(8, 2.6))
ax.barh(list(effect)[::-1], [v - 1 for v in list(effect.values())[::-1]], left=1, color=BLUE, height=0.6)
for y, value in enumerate(list(effect.values())[::-1]):
    ax.text(value + 0.03, y, f"{value:.2f}", va="center")
ax.set(xlabel="factor on EA", xlim=(1, 3.1), title="What each one does to the axial stiffness of the reference cable")
ax.spines[["top", "right"]].set_visible(False)
plt.show()
print({name: round(float(value), 2) for name, value in effect.items()})
assert max(effect, key=effect.get).startswith("lay")
assert min(effect.values()) > 1.15

# %% [markdown]
# The lay decides first: a factor of 2.6 over the angles of real cables. Then come the ends, the rubber's Poisson's ratio and the
# interface of the conductors. None of them is on a data sheet, except the lay. A single number "E" without the end condition is off by
# a third; for bending the range between wires that slide and cores that stick is a factor of 400, and a bonded model of a rubber cable
# still sits at the lower twelfth of it.
#
# **What would change this conclusion.** Stiffer filling (a thermoplastic instead of rubber) moves bending to the stick limit and EA to
# cos³. Strands that slide inside their conductors soften twist and bending further, see the two-stage route.
