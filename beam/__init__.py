"""The rod: statics and dynamics of a cable with contact and friction, and the towing run.

>>> from beam import read_scenario, tow
>>> run = tow(read_scenario("intelligent-horizontal"))         # doctest: +SKIP
>>> run.dataset["pull_force"]                                  # doctest: +SKIP
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from beam.scenario import Scenario, published_section
    from beam.scenario_file import builtin_scenarios, read_scenario
    from beam.status import Outcome, Status
    from beam.towing import accurate_settings, tow
    from beam.towing_run import TowingRun

__all__ = [
    "Outcome", "Scenario", "Status", "TowingRun", "accurate_settings", "builtin_scenarios", "published_section", "read_scenario", "tow",
]  # fmt: skip

_HOME = {
    "Outcome": "beam.status",
    "Scenario": "beam.scenario",
    "Status": "beam.status",
    "TowingRun": "beam.towing_run",
    "accurate_settings": "beam.towing",
    "builtin_scenarios": "beam.scenario_file",
    "published_section": "beam.scenario",
    "read_scenario": "beam.scenario_file",
    "tow": "beam.towing",
}


def __getattr__(name: str) -> Any:
    """Import a public name when it is first used, so that ``import beam`` stays fast."""
    if name not in _HOME:
        raise AttributeError(f"module 'beam' has no attribute {name!r}")
    return getattr(importlib.import_module(_HOME[name]), name)
