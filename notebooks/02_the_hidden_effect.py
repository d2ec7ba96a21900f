# ---
# jupyter:
#   jupytext:
#     formats: ipynb,py:percent
#   kernelspec:
#     display_name: Python 3
#     name: python3
# ---

# %% [markdown]
# # The hidden effect
#
# **Question.** A cable was bent to and fro under axial tension. A linear section does not describe what was measured. Which physics is
# missing, how sure is that, and does the error fall on tests that nothing was fitted to?
#
# The campaign is synthetic, so that the answer can be checked. What is true stands in a page beside its folder, which no cell
# reads; it is looked at in the end.

# %%
import tempfile
from dataclasses import replace
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from compare import BenchModel, Campaign, check, compare, explain, open_and_validate
from compare.comparison_plot import plot_comparison
from compare.findings_plot import plot_findings
from compare.findings_sentences import uncertain
from effects import Parameter, find, of_strain, register, section_effect, unregister
from effects.interlayer_friction import SLIP_STRAINS
from effects.layer_slip import expected, layer_slip
from geometry import read_cable

pictures = Path(tempfile.mkdtemp())
data = (Path.cwd() if (Path.cwd() / "data").is_dir() else Path.cwd().parent) / "data"
testing = __name__ == "testing"  # pictures have tests of their own


def show(draw, width=11):
    """Draw a picture file and show it in the notebook."""
    if testing:
        return
    picture = plt.imread(draw())
    _, axes = plt.subplots(figsize=(width, width * picture.shape[0] / picture.shape[1]))
    axes.imshow(picture)
    axes.axis("off")
    plt.show()


# %% [markdown]
# ## 1 Read
#
# Ten conditions, each done twice on newly mounted specimens. Six are for calibration, two for validation. Two are sealed: their tables
# are not read, only their checksum is taken.

# %%
campaign = Campaign.read(data / "campaigns" / "example-hidden-effect")
for e in campaign.experiments[::2]:
    largest = f"{np.abs(e.record['curvature']).max():.2f} 1/m" if e.is_open else "not read"
    print(
        f"{e.id}  {e.set:9s} {e.conditions['axial tension'] / 1e3:2.0f} kN {e.conditions['frequency']:5.2f} Hz  {largest}"
    )

# %% [markdown]
# ## 2 Compare, and see where it fails
#
# The start is the cell of the cable with everything bonded. Its bending stiffness is calibrated first: a wrong number is not yet
# a wrong model. The noise is taken from the repeats, before any model is believed.

# %%
model = BenchModel(campaign.section)
comparison = compare(model, campaign)
EI = comparison.calibration.values["EI"]
print(comparison.headline())
print(f"EI: {model.stiffness('EI'):.1f} N m2 nominal, {uncertain(EI.value, EI.std, 'N m2')} calibrated")
assert comparison.relative_error("calibrate") > 10

# %%
show(lambda: plot_comparison(comparison, pictures)[1], 13)

# %% [markdown]
# The straight line misses a loop. The loop is there at every frequency, and it is fatter under more tension. That already smells of
# friction, but smelling is not knowing: a yielding metal, a sliding grip and a slow sensor make loops too.
#
# ## 3 What can these experiments tell?
#
# Asked before any verdict, from the design and the noise alone.

# %%
asked = check(model, campaign)
print(
    "seen from:",
    ", ".join(f"{k} {v.split(' of')[0]}" for k, v in list(asked.smallest_seen.items())[:4]),
    "... of the load",
)
for hidden in asked.untestable:
    print(f"not testable: {hidden.effect}: {hidden.why}")

# %% [markdown]
# Nothing will be said about temperature: all tests were done at 20 °C.
#
# ## 4 Explain

# %%
findings = explain(model, campaign)
print(findings.headline())
for place in ("calibrate", "validate"):
    e = findings.errors[place]
    print(f"{place:9s} error over the noise floor {e.before:5.1f} -> {e.after:.2f}")
assert findings.verdict == "identified"
assert findings.effects == ("interlayer-friction",)
show(lambda: plot_findings(findings, pictures)["ranking"])

# %% [markdown]
# Every effect is judged by how well it predicts conditions that were left out of its fit. Plasticity is the nearest: it has
# the same loops, but its limit does not know the tension.

# %%
for candidate in findings.ranking[:6]:
    print(f"{candidate.effect:20s} {candidate.note}")

# %% [markdown]
# ## 5 By hand
#
# `model.add` switches on any effect; `compare` calibrates it with everything else. The proof is the set *validate*.

# %%
tried = {"linear": comparison} | {
    name: compare(model.add(name), campaign) for name in ("viscous-damping", "plasticity", "interlayer-friction")
}
for name, result in tried.items():
    print(f"{name:20s} " + ", ".join(f"{s} {result.relative_error(s):5.2f}" for s in ("calibrate", "validate")))
errors = {name: result.relative_error("validate") for name, result in tried.items()}
assert errors["interlayer-friction"] < 0.2 * errors["plasticity"] < 0.2 * errors["linear"]

# %%
fig, axes = plt.subplots(1, 2, figsize=(11, 4), sharey=True)
for ax, id in zip(axes, ("b07a", "b08a"), strict=True):
    e = next(e for e in campaign.experiments if e.id == id)
    kappa = e.record["curvature"]
    ax.plot(kappa, e.record["moment"], ".", color="0.6", label="measured, not fitted")
    ax.plot(kappa, comparison.model.predict(e)["moment"], color="#d55e00", label="linear, calibrated")
    ax.plot(kappa, tried["plasticity"].model.predict(e)["moment"], ":", color="#0072b2", label="plasticity")
    ax.plot(kappa, findings.model.predict(e)["moment"], color="#009e73", label="interlayer friction")
    ax.set(xlabel="curvature [1/m]", title=f"{id}: {e.conditions['axial tension'] / 1e3:.0f} kN")
axes[0].set_ylabel("moment [N m]")
axes[0].legend(frameon=False)
plt.show()

# %% [markdown]
# ## 6 Open the sealed experiments, once
#
# One goes to a larger curvature, the other to a higher tension than anything seen so far. The model is fixed; nothing is fitted
# again. Beside it two repairs that name nothing: a Gaussian process on the residual, and the linear model fitted to the very data
# that it is judged on.

# %%
opened = open_and_validate(findings, campaign)
sealed = opened.errors["sealed"]
print(f"sealed    error over the noise floor {sealed.before:.1f} -> {sealed.after:.2f}")
print(f"excess after / before {sealed.ratio:.3f}, interval [{sealed.ratio_low:.3f}, {sealed.ratio_high:.3f}]")
print(", ".join(f"{name} {value:.1f}" for name, value in sealed.baselines.items()))
assert sealed.confirmed
assert min(sealed.baselines.values()) > 3 * sealed.after
show(lambda: plot_findings(opened, pictures)["errors"])

# %% [markdown]
# ## 7 Are the found numbers those of this cable?
#
# The campaign was made for the reference cable. Its lay-up says what friction between layers should look like: how much bending
# stiffness the layers add while they stick, and at which curvature they let go. Tension is the only grip that this theory counts.

# %%
cable = read_cable("mcpt-1.9-3.3-3x35")
linear = opened.after.calibration.values["EI"]
friction = findings.model.effects[0]
strength = np.array(friction.strength)  # of sixteen elements with given slip curvatures; most are zero
slip = (SLIP_STRAINS * friction.reference.largest)[strength > 0]
stick = linear.value * strength.sum()
theory = layer_slip(cable, 0.3, 3000.0)
low, high = expected(cable, 3000.0)["slip strain"]
print(f"all layers slipping  {uncertain(linear.value, linear.std, 'N m2'):>20s}   theory at least {theory.EI_slip:.1f}")
print(f"layers, sticking     {stick:15.1f} N m2   theory at most {theory.EI_stick - theory.EI_slip:.1f}")
print(f"slip between         {slip.min():.3f} and {slip.max():.2f} 1/m   theory {low:.3f} to {high:.2f}")
assert theory.EI_slip < linear.value < linear.value + stick < theory.EI_stick
assert low < slip.min() < slip.max() < high

# %% [markdown]
# Possible, then: between a cable whose wires all slide and one that is bonded. The share of the grip that tension makes was found as well.
# The rest is the sheath, which the theory leaves out.

# %%
for name, p in opened.after.calibration.parameters.items():
    if not name.split(": ")[-1].startswith("stick stiffness "):
        print(f"{name:45s} {uncertain(p.value, p.std, p.unit)}   {p.meaning}")

# %% [markdown]
# ## 8 Use the model
#
# `findings.model` is a forward model. How much energy does one bending cycle cost, at a tension of your choice?

# %%
start = next(e for e in campaign.experiments if e.id == "b04a")
kappa = start.record["curvature"]
last = slice(len(kappa) // 2, None)
tensions = np.linspace(500, 6000, 12)
lost = []
for N in tensions:
    asked_for = replace(start, id="new", conditions={**start.conditions, "axial tension": N})
    lost.append(np.trapezoid(findings.model.predict(asked_for)["moment"][last], kappa[last]))
fig, ax = plt.subplots(figsize=(6.5, 3.4))
ax.plot(tensions / 1e3, lost, "o-", color="#009e73")
ax.set(
    xlabel="axial tension [kN]",
    ylabel="loss [J/m per cycle]",
    title="Bending to 1/R = 0.6 1/m and back",
    ylim=(0, None),
)
plt.show()
assert np.all(np.diff(lost) > 0)

# %% [markdown]
# ## 9 An idea of your own
#
# Ten lines make a law of yours an effect, and `explain` ranks it with the others. Here: layers that stick only by the sheath and
# wear on the way. The list of effects is short to be quick; without `library` all of them are tried.


# %%
@section_effect(
    "wearing-grip",
    shape=[Parameter("way", "strain", "rubbed way after which half is lost", starts=of_strain(0.5, 20, 8))],
    strength=[Parameter("gain", "1", "stiffness of the unworn layers over the linear one")],
    memoryless=False,
)
def wearing_grip(path, way):
    """Layers lose their hold with the way that they have rubbed."""
    rubbed = np.cumsum(np.abs(np.diff(path.strain, prepend=path.strain[0])))
    return path.strain * way / (way + rubbed)


register(wearing_grip, replace=True)
names = ("interlayer-friction", "plasticity", "viscoelasticity", "wearing-grip")
ranked = explain(model, campaign, library=[find(name) for name in names]).ranking
for candidate in ranked:
    print(
        f"{candidate.effect:20s} {candidate.behind:8.0f} nats behind, explains {100 * candidate.share:3.0f} %: {candidate.note}"
    )
assert ranked[0].effect == "interlayer-friction" and "wearing-grip" in [c.effect for c in ranked]
unregister("wearing-grip")

# %% [markdown]
# ## Answer
#
# Interlayer friction is missing, and nothing else that these tests can show. The error falls to about the noise floor where it was
# fitted, nearly so on tests that were not, also beyond the curvature and tension that the model had seen.
#
# **What was true?** [truth.md](../data/campaigns/truth.md): two layers, 22 stick-slip elements, 9.0 + 8.5 = 17.5 N m² of stick
# stiffness on EI = 4.2 N m², a grip that grows with tension to the power 0.85. Found: the sum to a few percent, with a form that
# has other slip curvatures and a linear law of the grip. That is why a little more than noise is left.
#
# **What would change this conclusion.** Tests at one tension only: friction and plasticity would come back as a set that these
# data cannot split, with the experiment that does. No repeats: then the verdict is at best *family-identified*.

# %%
truth_EI, truth_stick = 4.2, 17.5
print(f"EI {linear.value:.2f} (true {truth_EI}), stick stiffness {stick:.1f} (true {truth_stick}) N m2")
assert abs(linear.value - truth_EI) < 0.1 * truth_EI
assert abs(stick - truth_stick) < 0.1 * truth_stick
