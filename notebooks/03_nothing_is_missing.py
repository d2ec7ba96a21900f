# ---
# jupyter:
#   jupytext:
#     formats: ipynb,py:percent
#   kernelspec:
#     display_name: Python 3
#     name: python3
# ---

# %% [markdown]
# # Nothing is missing
#
# **Question.** A residual is never zero. When is it only noise, and what may then be said? And what if two causes explain the same data?
#
# The first campaign is synthetic: F = EA ε, with noise and with a gain that changes by 1 % from mounting to mounting. The right
# answer is *none*. The second is that of the notebook before this one, cut down to what a less careful plan would have measured.

# %%
from dataclasses import replace
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from compare import BenchModel, Campaign, compare, explain

data = (Path.cwd() if (Path.cwd() / "data").is_dir() else Path.cwd().parent) / "data"
campaign = Campaign.read(data / "campaigns" / "example-tension")
model = BenchModel(campaign.section)

# %% [markdown]
# ## 1 What a regression on all samples finds
#
# The textbook way: pool the samples, add a term to the straight line, keep it if AIC falls by more than two.

# %%
bench = campaign.of_set("calibrate")
strain = np.concatenate([e.record["extension"] / e.length for e in bench])
force = np.concatenate([e.record["force"] for e in bench])
rate = np.concatenate([np.gradient(e.record["extension"] / e.length, e.record.time) for e in bench])
warm = np.concatenate([np.full(len(e.record), e.conditions["temperature"] - 293.15) for e in bench])
clock = np.concatenate([e.record.time for e in bench])
x, v = strain / strain.max(), rate / rate.max()
terms = {
    "offset": np.ones_like(x),
    "drift": clock / clock.max(),
    "stiffening, x³": x**3,
    "asymmetry, x²": x**2,
    "viscous damping": v,
    "friction, sign of the rate": np.sign(v),
    "thermal softening": x * warm / 20,
    "softening with the peak": x * np.concatenate([np.full(len(e.record), e.record["extension"].max()) for e in bench]),
}


def aic(columns):
    """Akaike's criterion of a least-squares fit to all samples as if they were independent."""
    A = np.column_stack(columns)
    left = force - A @ np.linalg.lstsq(A, force, rcond=None)[0]
    return len(force) * np.log(np.mean(left**2)) + 2 * A.shape[1]


falls = {name: aic([x]) - aic([x, column]) for name, column in terms.items()}
for name, fall in sorted(falls.items(), key=lambda item: -item[1]):
    print(f"{name:28s} AIC falls by {fall:6.1f}" + ("   'found'" if fall > 2 else ""))
assert max(falls.values()) > 2

# %% [markdown]
# Nothing of this is there. The samples of a record share its gain and its neighbours' noise: there are not 1288 of them but four
# conditions, mounted twice.
#
# ## 2 What the repeats say
#
# Two mountings under the same condition differ by noise alone. That difference, and not the residual of a model, is the measure.

# %%
comparison = compare(model, campaign)
noise = comparison.noise.by_channel["tension", "force"]
print(f"a sample {noise.s:.1f} N, correlation {noise.phi:.2f}, gain of a mounting {100 * noise.gain:.2f} %")
print(comparison.headline())
groups = [
    (a, next(b for b in campaign.experiments if b.repeat_of == a.id))
    for a in campaign.experiments
    if a.repeat_of is None
]
fits = {f.experiment.id: f for f in comparison.fits}
fig, axes = plt.subplots(1, len(groups), figsize=(12, 2.8), sharey=True)
for ax, pair in zip(axes, groups, strict=True):
    for e, colour in zip(pair, ("#0072b2", "#56b4e9"), strict=True):
        ax.plot(e.record["extension"] * 1e3, fits[e.id].measured - fits[e.id].model, ".", ms=3, color=colour)
    ax.axhspan(-2 * fits[e.id].noise_floor, 2 * fits[e.id].noise_floor, color="0.9", zorder=0)
    ax.set(xlabel="extension [mm]", title=f"{e.set}, {e.conditions['temperature'] - 273.15:.0f} °C")
axes[0].set_ylabel("measured - model [N]")
fig.suptitle(
    "Residuals of the first mounting (dark) and the second (light); band: twice the noise floor", x=0.01, ha="left"
)
fig.tight_layout()
plt.show()
assert not comparison.where_it_fails()

# %% [markdown]
# ## 3 Explain

# %%
findings = explain(model, campaign)
print(findings.headline())
for candidate in findings.ranking:
    print(f"{candidate.effect:20s} log e {candidate.log_e:6.1f}   needed {candidate.needed:.1f}")
assert findings.verdict == "none" and not findings.effects

# %% [markdown]
# "None" alone would be cheap. What would these tests have shown, and what not?

# %%
seen = {name: float(text.split()[0]) for name, text in findings.smallest_seen.items()}
order = sorted(seen, key=seen.get, reverse=True)
fig, ax = plt.subplots(figsize=(8, 3.6))
ax.barh(order, [seen[name] for name in order], color="#0072b2", height=0.6)
ax.set(xlabel="smallest size that would have been seen [% of the load, rms]", title="What 'none' means here")
ax.spines[["top", "right"]].set_visible(False)
plt.show()
for hidden in findings.untestable:
    print(f"not testable: {hidden.effect}: {hidden.why}")
assert seen["interlayer-friction"] < 1
assert any(hidden.effect == "direction-asymmetry" for hidden in findings.untestable)

# %% [markdown]
# ## 4 Two causes, one data set
#
# The bending tests of the notebook before, but only those at 3 kN: amplitude and frequency vary, tension does not.

# %%
whole = Campaign.read(data / "campaigns" / "example-hidden-effect")
at_3_kN = tuple(
    replace(e, set="calibrate") for e in whole.experiments if e.is_open and e.conditions["axial tension"] == 3000
)
tied = explain(BenchModel(whole.section), replace(whole, experiments=at_3_kN))
print(tied.headline())
print(tied.next_experiment.sentence)
assert tied.verdict == "confusable"
assert set(tied.confusable) >= {"interlayer-friction", "plasticity"} and not tied.effects

# %% [markdown]
# A slipping layer and a yielding wire make the same loop, as long as the tension is the same. To name the first of the two would be
# a guess, so that nothing is named. The proposed experiment is at another tension; repeating what exists would not help at all.

# %%
following = tied.next_experiment
assert following.conditions["axial tension [N]"] != 3000
assert following.p_wrong_after < 0.01 < following.p_wrong_repeat
with_it = tuple(replace(e, set="calibrate") for e in whole.experiments if e.id in ("b02a", "b02b", "b06a", "b06b"))
resolved = explain(BenchModel(whole.section), replace(whole, experiments=at_3_kN + with_it))
print(f"with the tests at 6 kN: {resolved.headline()}")
assert resolved.effects == ("interlayer-friction",)

# %% [markdown]
# ## Answer
#
# A residual is noise if the differences of repeats are as large, and if no effect predicts left-out experiments better than more scatter
# would. Then the answer is *none*, with the size that would have been seen. Where two effects predict equally well the answer is both,
# with the experiment that parts them.
#
# **What would change this conclusion.** Without repeats the gain of a mounting is invisible; the report then says *noise assumed*. And
# "not testable" is not "not there": for a direction, a temperature or a length that was not varied nothing is claimed.
