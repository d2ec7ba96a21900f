"""Interactive page of a towing run: one HTML file with the data in it, that any browser opens without a network.

Play, drag the time, zoom with the wheel, pull the picture, and point at the cable or a link to read its number and tension. Positions are
rounded to a millimetre and tensions to a newton.
"""

from __future__ import annotations

import json
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from geometry.errors import InputError

if TYPE_CHECKING:
    import xarray

    from beam.scenario import Scenario

MOST_FRAMES, MOST_NODES = 120, 201

PAGE = Path(__file__).with_suffix(".html")
"""The page with places for title and data."""


def page_data(data: xarray.Dataset, scenario: Scenario) -> dict[str, Any]:
    """What the page draws: times, cable, tensions, links, roller; lengths in m, forces in N."""
    from beam.towing_animation import bend_centre, chain_tension, instants, link_ends

    k = instants(data.sizes["time"], MOST_FRAMES)
    n = instants(data.sizes["node"], MOST_NODES)
    time = data["time"].values[k]
    out: dict[str, Any] = {
        "title": scenario.title,
        "time": _rounded(time, 3),
        "node": data["node"].values[n].tolist(),
        "cable": _rounded(data["position"].values[np.ix_(k, n, np.arange(2))], 3),
        "tension": _rounded(data["force_local"].values[np.ix_(k, n, np.arange(1))][:, :, 0], 0),
        "pull": _rounded(data["pull_force"].values[k, 0], 0),
        "radius": _rounded(data["bend_radius"].values[k], 4),
        "centre": _rounded(bend_centre(scenario, time), 4),
        "R": scenario.layout.bend_radius.value,
        "deck": scenario.deck_height,
        "wheel": scenario.towing != "conventional",
        "links": None,
    }
    if scenario.clamps is not None and "clamp" in data.dims:
        out["links"] = _rounded(link_ends(data, scenario.clamps.pitch.value)[k], 3)
        out["chain"] = _rounded(chain_tension(data)[k], 0)
        out["clamp"] = data["clamp"].values.tolist()
    return out


def write_page(data: xarray.Dataset, scenario: Scenario, path: str | Path) -> Path:
    """Write the page of a run's dataset to `path`.

    Raises
    ------
    InputError
        If the file cannot be written.
    """
    path = Path(path)
    embedded = json.dumps(page_data(data, scenario), separators=(",", ":")).replace("</", "<\\/")
    text = PAGE.read_text(encoding="utf-8").replace("@TITLE@", escape(scenario.title)).replace("@DATA@", embedded)
    try:
        path.write_text(text, encoding="utf-8")
    except OSError as error:
        raise InputError(f"{path}: the page cannot be written there: {error}.") from None
    return path


def _rounded(values: ArrayLike, digits: int) -> list[Any]:
    rounded = np.round(np.asarray(values, dtype=float), digits) + 0.0
    return (rounded.astype(int) if digits == 0 else rounded).tolist()
