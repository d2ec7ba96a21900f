r"""Offset of a sensor: a constant bias of a channel, the same in all records.

.. math::  y = y_\text{true} + b

An offset that differs from record to record at random is scatter of the mounting and belongs to the noise, and one that
grows in a record is ``sensor-drift``. Source: JCGM 200:2012 (VIM), instrumental bias.
"""

from __future__ import annotations

import numpy as np

from effects.effect import Array, BenchPath, Effect, Form, Parameter


def _ones(path: BenchPath) -> Array:
    return np.ones((len(path.strain), 1))


EFFECT = Effect(
    name="sensor-offset",
    kind="sensor",
    title="constant bias of a channel",
    equation="y = y_true + offset",
    source="JCGM 200:2012 (VIM), instrumental bias",
    needs="several records, so that a common bias stands out of offsets that differ from mounting to mounting",
    signature="the whole loop is moved up or down by the same amount in every record, the first sample included",
    kinds=("tension", "torsion", "bending", "shear", "towing"),
    forms=(
        Form(
            "constant",
            "bias",
            _ones,
            strength=(
                Parameter(
                    "offset", "channel", "bias of every sample", low=-np.inf, plausible=(-np.inf, np.inf),
                    source="depends on the sensor: compare it with the range in its data sheet",
                ),
            ),
        ),
    ),
)  # fmt: skip
