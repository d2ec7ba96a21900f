"""A comparison as plain numbers: rows for a table, and the JSON object of ``helicable compare``.

The keys ``id, kind, channel, set, rmse, bias, noise_floor, excess`` and ``calibrated`` are fixed by the contract of the
commands. JSON knows no NaN: what is not finite becomes null, with its place in the notes.
"""

from __future__ import annotations

import math
from typing import Any

from compare.comparison import ChannelFit, Comparison, NotCompared
from compare.noise_floor import NoiseModel


def comparison_rows(comparison: Comparison) -> list[dict[str, Any]]:
    """One dictionary per experiment and channel; rmse, bias and excess are None where no model could be run."""
    return [_row(fit) for fit in comparison.fits] + [_empty_row(gap) for gap in comparison.not_compared]


def comparison_record(comparison: Comparison) -> dict[str, Any]:
    """JSON object of ``helicable compare``, SI units; relative errors are in noise floors."""
    error = {name: _set_error(comparison, name) for name in ("calibrate", "validate", "sealed")}
    content = {
        "schema": 1,
        "campaign": comparison.campaign.title,
        "experiments": comparison_rows(comparison),
        "calibrated": {
            name: {"value": v.value, "std": v.std, "unit": v.unit, "nominal": v.nominal, "ratio": v.ratio}
            for name, v in comparison.calibration.values.items()
        },
        "noise": noise_rows(comparison.noise),
        "lack_of_fit": [
            {
                "kind": kind,
                "channel": channel,
                "F": f.F,
                "p": f.p,
                "dof_model": f.dof_model,
                "dof_noise": f.dof_noise,
            }
            for (kind, channel), f in comparison.lack_of_fit.items()
        ],
        "error": {"unit": "relative to the noise floor", **error},
        "where": [
            {"experiment": f.experiment.id, "channel": f.channel, "excess": f.relative_excess}
            for f in comparison.where_it_fails()
        ],
    }
    lost: list[str] = []
    content = finite_content(content, "", lost)
    reasons = [f"{path} is null: the data leave no finite number for it." for path in lost]
    return {**content, "notes": [*comparison.notes, *reasons]}


def noise_rows(noise: NoiseModel) -> list[dict[str, Any]]:
    """One dictionary per kind and channel: scatter of a sample (correlated and white), of gain and of offset, SI."""
    return [
        {"kind": kind, "channel": channel, "s": c.s, "phi": c.phi, "white": c.white, "gain": c.gain, "offset": c.offset}
        | {"assumed": c.assumed, "source": c.source}
        for (kind, channel), c in noise.by_channel.items()
    ]


def _set_error(comparison: Comparison, name: str) -> dict[str, float | None] | None:
    after = comparison.relative_error(name)
    if after is None:
        return None
    return {"before": comparison.relative_error(name, before=True), "after": after, "floor": 1.0}


def _row(fit: ChannelFit) -> dict[str, Any]:
    return {
        "id": fit.experiment.id,
        "kind": fit.experiment.kind,
        "channel": fit.channel,
        "set": fit.experiment.set,
        "unit": fit.unit,
        "rmse": fit.after.rmse,
        "bias": fit.after.bias,
        "noise_floor": fit.noise_floor,
        "excess": fit.after.excess,
        "chance": fit.after.chance,
        "bias_uncertainty": fit.bias_uncertainty,
        "before": {"rmse": fit.before.rmse, "bias": fit.before.bias, "excess": fit.before.excess},
    }


def _empty_row(gap: NotCompared) -> dict[str, Any]:
    experiment = gap.experiment
    unit = experiment.record.channels[gap.channel].unit
    nothing = {
        "rmse": None,
        "bias": None,
        "noise_floor": gap.noise_floor,
        "excess": None,
        "chance": None,
        "bias_uncertainty": None,
    }
    return {
        "id": experiment.id,
        "kind": experiment.kind,
        "channel": gap.channel,
        "set": experiment.set,
        "unit": unit,
        **nothing,
        "before": None,
    }


def finite_content(value: Any, path: str, lost: list[str]) -> Any:
    """The same content with every number that is not finite replaced by None, its place appended to `lost`."""
    if isinstance(value, dict):
        return {k: finite_content(v, f"{path}.{k}" if path else k, lost) for k, v in value.items()}
    if isinstance(value, list):
        return [finite_content(v, f"{path}[{i}]", lost) for i, v in enumerate(value)]
    if isinstance(value, float) and not math.isfinite(value):
        lost.append(path)
        return None
    return value
