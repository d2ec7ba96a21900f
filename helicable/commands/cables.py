"""`helicable cables`: the built-in cables."""

from __future__ import annotations

from geometry import builtin_cables
from helicable.options import JsonOption, OutOption
from helicable.screen import folder, table, write_json


def cables(json: JsonOption = None, out: OutOption = None) -> None:
    """List the built-in cables.

    Example: `helicable cables`
    """
    found = builtin_cables()
    rows = [(c.name, c.title, f"{1e3 * c.outer_diameter:.1f}", f"{c.mass_per_length:.2f}") for c in found]
    table("Built-in cables", ("name", "title", "diameter mm", "kg/m"), rows, right=(2, 3))
    record = {
        "schema": 1,
        "cables": [
            {
                "name": c.name,
                "title": c.title,
                "outer_diameter": c.outer_diameter,
                "mass_per_length": c.mass_per_length,
            }
            for c in found
        ],
    }
    write_json(json, record)
    if out is not None:
        write_json(folder(out) / "cables.json", record)
