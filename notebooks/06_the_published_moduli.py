# ---
# jupyter:
#   jupytext:
#     formats: ipynb,py:percent
#   kernelspec:
#     display_name: Python 3
#     name: python3
# ---

# %% [markdown]
# # The published moduli
#
# **Question.** A finite-element test of a piece of shearer cable gave E = 142 MPa, G = 53 and 45 MPa. Those numbers went into a beam model
# of the whole cable. What are they numbers of, and which of them belong into a beam?
#
# The way is the one for any missing effect: compare, see where it fails, learn what is missing, add it, and watch the error fall. The
# drawing and the length of the specimen are not published; the section here is constructed (`paper-specimen-3x35`), 182.3 mm long.

# %%
import dataclasses
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from geometry import read_cable
from homogenize import solve_helical_cell
from homogenize.specimen import AxialGrading, LoadCase, Plate, Specimen, coarse_section, solve_specimen
from homogenize.specimen.apparent_modulus import apparent_moduli
from homogenize.specimen.gauge_length import gauge_modulus
from homogenize.specimen.ladder import PUBLISHED, linear_rung, long_cable_rungs
from homogenize.specimen.ladder_plot import ladder_plot
from homogenize.specimen.ladder_record import read_ladder

cable = read_cable("paper-specimen-3x35")
section = coarse_section(cable)  # some 200 curved triangles: 5 % too stiff, and quick
specimen = Specimen(0.1823, grading=AxialGrading(end_size=0.1, largest=0.9, growth=4.0, degree=3))
BLUE, ORANGE, GREY = "#0072b2", "#d55e00", "0.45"


def show(rung):
    """Its numbers over the published ones, and the root mean square of the logarithms."""
    ratio = {k: v / PUBLISHED.numbers()[k] for k, v in rung.numbers().items()}
    print(
        f"{rung.name:28s}",
        "  ".join(f"{k} {v:.3g}" for k, v in ratio.items()),
        f"  misfit {rung.misfit(PUBLISHED):.2f}",
    )


# %% [markdown]
# ## 1 Compare: the long cable
#
# The section of an endless cable has E = 6.6 GPa with the twist blocked. Take it as a rod, fix one end, pull with 2000 N and 500 N.

# %%
blocked, released = long_cable_rungs(section, specimen.length)
for rung in (blocked, released):
    show(rung)
assert 30 < released.E / PUBLISHED.E < 40
assert released.u_z < 0.02 * PUBLISHED.u_z
assert 0.5 < PUBLISHED.u_plus_x / released.u_plus_x < 1.5

# %% [markdown]
# **Where it fails.** Along the cable by a factor of thirty, across it by less than a half. Something is soft along the cable only, and
# releasing the twist (a third) is not enough. A material cannot do that: copper is there.
#
# ## 2 Learn what is missing: the end
#
# The published test puts its force on the end-section. The rubber there is pulled, not the copper. Compare a rigid plate with a traction.

# %%
plate = linear_rung("finite, rigid plate", dataclasses.replace(specimen, loaded=Plate()), section)
traction = linear_rung("traction on the end-section", specimen, section)
for rung in (plate, traction):
    show(rung)
assert plate.misfit(PUBLISHED) > 2 * traction.misfit(PUBLISHED)
assert abs(traction.E / PUBLISHED.E - 1) < 0.15 and abs(traction.u_z / PUBLISHED.u_z - 1) < 0.1

# %% [markdown]
# With the traction E falls to 0.94 of the published value, the largest displacement agrees within a few percent, and nothing was fitted in
# this step. The error falls from "thirty times" to "a third in G and the deflections". What the traction measures can be seen on the face:

# %%
pulled = solve_specimen(specimen, section, [LoadCase("tension", 2000.0)])
face = 1e3 * pulled.displacement[:, 2, -1, 0]
cells, Q = pulled.system.field.cells[:3].T, pulled.system.field.nodes
fig, (left, right) = plt.subplots(1, 2, figsize=(11, 4.4), gridspec_kw={"width_ratios": (1, 1.3)})
drawn = left.tripcolor(1e3 * Q[0], 1e3 * Q[1], cells, face, shading="gouraud", cmap="cividis")
left.set(aspect="equal", xlabel="x [mm]", ylabel="y [mm]", title="Loaded face, axial displacement [mm]")
fig.colorbar(drawn, ax=left)
stations = pulled.operator.axial.stations
mass = pulled.F[:, -1, 0] / 2000.0
mean = 1e3 * np.einsum("n,nm->m", mass, pulled.U[:, :, 0])
right.plot(1e3 * stations, mean, "o-", color=BLUE)
right.axvspan(182.3 - 25, 182.3, color=ORANGE, alpha=0.15, lw=0)
right.annotate("last radius", (158, 1.2), color=ORANGE, ha="right")
right.set(xlabel="z [mm]", ylabel="mean axial displacement [mm]", title="Where the specimen gets longer")
right.spines[["top", "right"]].set_visible(False)
fig.tight_layout()
plt.show()
share = 1 - np.interp(0.1823 - 0.025, stations, mean) / mean[-1]
print(
    f"largest over mean displacement of the face: {face.max() / mean[-1]:.2f}; {100 * share:.0f} % of it in the last radius"
)
assert face.max() / mean[-1] > 2.5
assert share > 0.8

# %% [markdown]
# The soft material bulges out between conductors that hardly move. E of this test is the compliance of an end.
#
# ## 3 Two lengths settle it
#
# If 142 MPa were the cable's, a specimen twice as long would show it again. If it is an end, L/E = c + L/E∞.

# %%
lengths = (0.0912, 0.1823) if __name__ == "testing" else (0.0912, 0.1823, 0.3646, 0.9115)
found, gauge = [], []
for L in lengths:
    one = solve_specimen(dataclasses.replace(specimen, length=L), section, [LoadCase("tension", 2000.0)])
    found.append(apparent_moduli(one)[0].modulus)
    gauge.append(gauge_modulus(one, 0))
cell = solve_helical_cell(section).stiffness
fig, ax = plt.subplots(figsize=(8.5, 4.4))
L = np.geomspace(0.05, 60, 200)
end = np.mean([a / b - a / cell.E_free_twist for a, b in zip(lengths, found)])
ax.loglog(L, L / (end + L / cell.E_free_twist) / 1e6, color=GREY, label="c + L/E of the cell, twist free")
ax.loglog(lengths, np.array(found) / 1e6, "o", color=BLUE, label="whole specimen")
ax.loglog(lengths, np.array(gauge) / 1e6, "s", color=ORANGE, label="strain of the middle fifth")
ax.axhline(cell.E_free_twist / 1e6, color=GREY, ls=":", lw=1)
ax.axhline(142, color="k", ls="--", lw=1)
ax.annotate("published 142 MPa", (10, 142), xytext=(0, 4), textcoords="offset points")
ax.set(xlabel="length of the specimen [m]", ylabel="E [MPa]", title="One cable, many moduli")
ax.spines[["top", "right"]].set_visible(False)
ax.legend(frameon=False)
plt.show()
print("E [MPa]:", [round(E / 1e6) for E in found], " middle fifth [GPa]:", [round(E / 1e9, 2) for E in gauge],
      f" c {1e9 * end:.2f} mm/MPa, half of the long cable's E at {end * cell.E_free_twist:.1f} m")  # fmt: skip
assert 1.8 < found[1] / found[0] < 2.05  # proportional to the length: no material
assert all(g > 5 * E for g, E in zip(gauge, found))

# %% [markdown]
# E doubles with the length: it is no property of the cable. A second specimen of another length, or a gauge over the middle, says so
# at the price of one more test. From the lengths E∞ cannot be had below a metre (the law is ill-conditioned); from the gauge it can.
#
# ## 4 The ladder
#
# What is left: deflections a quarter too large, G a quarter too small, and what a linear bonded model cannot give: G of 53 in one plane
# and 45 in the other, 6.95 mm in +X and 7.96 mm in -X. The first two belong to inputs that are not published. The stored record
# (`python -m benchmarks.ladder`) climbs the same steps, and those that follow, on `mcpt-1.9-3.3-3x35-specimen`. Its inputs were
# calibrated inside their ranges; they are the same on every rung.

# %%
about, rungs = read_ladder(Path("../benchmarks/ladder.json"))
for rung in rungs:
    show(rung)
ladder_plot(rungs, about)

# %%
by = {rung.name: rung for rung in rungs}
fine, few = by["traction on the end-section"], by["traction, coarse mesh"]
assert abs(few.E / fine.E - 1) < 0.06 and abs(few.u_plus_x / fine.u_plus_x - 1) < 0.06  # what the coarse section costs
misfit = [rung.misfit(PUBLISHED) for rung in rungs[:4]]
assert misfit == sorted(misfit, reverse=True) and misfit[-1] < 0.1 < 2.0 < misfit[0]  # the error falls rung by rung
assert by["elastic interface"].misfit(PUBLISHED) > misfit[-1]  # softer conductors lead away
odd = (PUBLISHED.u_plus_x + PUBLISHED.u_minus_x) / 2
even = (PUBLISHED.u_plus_x - PUBLISHED.u_minus_x) / 2
print(f"published along X: odd part {1e3 * odd:.3f} mm, even part {1e3 * even:+.3f} mm; every linear rung: even part 0")
assert all(r.u_plus_x == r.u_minus_x for r in rungs if r.name in ("twist released", "elastic interface"))
large = by["large displacements"]
print(f"large displacements: even part {1e3 * (large.u_plus_x - large.u_minus_x) / 2:+.3f} mm along X, "
      f"{1e3 * (large.u_plus_y - large.u_minus_y) / 2:+.3f} mm along Y")  # fmt: skip
assert abs(large.u_plus_x - large.u_minus_x) < 0.2 * abs(PUBLISHED.u_plus_x - PUBLISHED.u_minus_x)

# %% [markdown]
# ## Answer
#
# The end does it. Of the factor of 63 between the long cable's E and the published one (thirty on the constructed section once the twist is
# free) nearly all goes with one step, the load through the end-section: the misfit of the eight numbers falls from 2.15 to 0.06, where
# six of them had been fitted by the inputs. Twist is a third of E, the conductors' interface a twentieth, and a rigid plate in place
# of the traction would have measured gigapascals.
#
# What stays open: the ratio of the two G, and the difference between +X and -X: large displacements give a tenth of it. Opening contacts
# make parts of that size, on a specimen half as stiff; docs/specimen.md says what was tried.
#
# **What a designer should use.** The values of the cell: EA, GJ, EI and their coupling (`helicable homogenize`). 142, 53 and 45 MPa hold
# for that length and that end only. **The test that settles it:** two lengths, or an extensometer over the middle fifth of a specimen of
# at least 15 diameters. If E grows with the length, it is the end.
#
# **What would change this conclusion.** A specimen longer than 0.4 m, a loaded face that stayed flat, or an insulation of soft rubber.
