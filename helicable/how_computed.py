"""How every number on the page of `helicable explain` is computed, panel by panel: (name, sentence)."""

from __future__ import annotations

DATA = (
    (
        "noise",
        "Maximum likelihood on differences of repeats: correlated (s, phi) and white scatter of samples, "
        "scatter of the gain and of the offset between records. Without repeats: the stated sensor "
        "uncertainty, marked as assumed.",
    ),
    (
        "D",
        "Length of the whitened effect at its smallest size of interest after the base model was refitted to "
        "it, in units of the noise. Below 3 it is not testable; from 6 on it is safely seen.",
    ),
    ("chance of confusion", "Phi(-D/2) of the distance D between two effects, the rival refitted."),
    (
        "confounded",
        "Correlation above 0.8 or variance inflation above 5 among log amplitude, log rate, tension, temperature.",
    ),
)

MODEL = (
    (
        "calibrated stiffness",
        "Generalised least squares over the set calibrate with the noise covariance; the standard deviation "
        "is the larger one of noise and of a bootstrap over experiments.",
    ),
    (
        "ratio",
        "Calibrated over predicted stiffness. A ratio far from one is a finding about the prediction, not an effect.",
    ),
    (
        "noise floor, band",
        "Root mean square that the noise of this record alone is expected to have; the band is +- 2 of it.",
    ),
    ("units of its noise", "K r with K^T K = C^-1: independent and of variance one if the model is true."),
    (
        "autocorrelation",
        "Of the whitened residual at lag 1, beside 2/sqrt(n), which white noise stays below 19 times in 20.",
    ),
)

WHERE = (
    ("excess", "sqrt(max(0, mean square of the residual - floor^2)) over the floor: 0 is as good as the data allow."),
    ("fails", "The chance that noise alone gives such a residual is below 1 % shared among all channels."),
    ("loop energy", "Integral of load over path divided by the number of cycles, of records whose path closes."),
    ("marks", "Each with its own line in the table; they explain a verdict and never decide it."),
)

WHICH = (
    (
        "log e",
        "Logarithm of the split likelihood ratio on experiments left out of the fit, the base model refitted "
        "on these same experiments. Under 'no effect' e is at most 1 on average, so that log e above the gate "
        "is rarer than the level alpha.",
    ),
    ("needed", "ln(K / alpha): K effects were tried in their kinds of experiment, alpha = 0.01."),
    (
        "share",
        "1 - (F after - 1) / (F before - 1), F the lack of fit on experiments left out of the fit; 100 % is "
        "down to the noise.",
    ),
    ("behind", "Held-out score behind the best candidate, in nats. Closer than a few nats they cannot be told apart."),
    ("folds", "Left-out conditions in which the effect did better than the base model."),
    ("value ± standard deviation", "From a refit of everything, over experiments, never over samples."),
)

PATH = (
    (
        "a step",
        "The best effect is added, everything is calibrated again, and the search repeats until no effect "
        "passes the gate.",
    ),
    ("log e", "Of this effect beside everything that was accepted before it."),
    ("error", "rms residual over the noise floor of the calibration set, after the step."),
)

HELD_OUT = (
    (
        "before, after",
        "rms residual over the noise floor of the same records, of the calibrated base model and of the model "
        "with effects. Neither was fitted to validate or sealed.",
    ),
    (
        "ratio of excess",
        "Excess after over excess before; the interval is a bootstrap over experiments. Confirmed if its "
        "upper end is below 1.",
    ),
    ("GP patch", "A Gaussian process of the residual instead of physics: it predicts near the data and names nothing."),
    ("refit", "The old model with its stiffness fitted again on these data."),
)

NEXT = (
    (
        "the experiment",
        "The condition within reach that separates the two nearest rivals most (T-optimal, the rival refitted).",
    ),
    (
        "P(wrong)",
        "Phi(-D/2) of the distance D between the rivals, before and after; beside it what repeating would give.",
    ),
)
