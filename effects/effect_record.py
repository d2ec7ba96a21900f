"""Effects that were found, as plain numbers: written into the JSON of ``helicable explain``, read where they shall act again.

>>> from effects import find
>>> form = find("plasticity").forms[0]
>>> one = ActiveEffect(find("plasticity"), form, "bending", shape=(0.1,), strength=(2.0,))
>>> effect_record(active_effect(effect_record(one))) == effect_record(one)
True
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from effects.effect import ActiveEffect, BenchPath
from effects.library import find
from geometry.errors import SpecError

_SCALES = ("largest", "typical_tension", "typical_temperature", "direction")


def effect_record(active: ActiveEffect) -> dict[str, Any]:
    """Name, form, place, parameters (SI) and the scales on which they rest."""
    return {
        "effect": active.effect.name,
        "form": active.form.name,
        "kind": active.kind,
        "channel": active.channel,
        "shape": list(active.shape),
        "strength": list(active.strength),
        "reference": {key: getattr(active.reference, key) for key in _SCALES},
    }


def active_effect(record: Mapping[str, Any], where: str = "record") -> ActiveEffect:
    """The effect of a record.

    Raises
    ------
    SpecError
        If it is not one of this library, or its numbers do not fit its form.
    """
    try:
        effect = find(str(record["effect"]))
        form = next((f for f in effect.forms if f.name == record["form"]), None)
        shape, strength = (tuple(float(v) for v in record[key]) for key in ("shape", "strength"))
        scales = {key: record["reference"][key] for key in _SCALES}
        kind, channel = str(record["kind"]), record["channel"]
    except (KeyError, TypeError, ValueError) as error:
        raise SpecError(f"{where}: this is no record of an effect ({type(error).__name__}: {error}).") from None
    if form is None or len(form.shape) != len(shape) or len(form.strength) != len(strength):
        raise SpecError(f'{where}: {effect.name} has no form "{record["form"]}" with these parameters; explain again.')
    return ActiveEffect(effect, form, kind, channel, shape, strength, BenchPath(kind, np.zeros(0), **scales))


def read_effects(file: str | Path) -> tuple[ActiveEffect, ...]:
    """The effects in the JSON that ``helicable explain`` has written.

    Raises
    ------
    SpecError
        If the file is not such a JSON.
    """
    try:
        content = json.loads(Path(file).read_text(encoding="utf-8"))
        records = content["found"]
    except OSError as error:
        raise SpecError(f"{file}: cannot be read ({error.strerror or error}).") from None
    except (ValueError, KeyError, TypeError):
        raise SpecError(
            f"{file}: this is not the JSON of `helicable explain`, whose key `found` lists effects."
        ) from None
    return tuple(active_effect(r, f"{file}, found {i + 1}") for i, r in enumerate(records))
