"""Pull of a 120-wire spiral strand to its break as a campaign: force over strain, monotonic.

Test of Bridon (2007) as published by Judge, Yang, Jones & Beattie, Constr. Build. Mater. (2012), doi
10.1016/j.conbuildmat.2011.12.073. The strand was not pre-stretched: its first slope is less than half of the sum of the
wires, it stiffens while the layers bed in, and above a strain of 1 % the wires yield.
"""

from __future__ import annotations

from pathlib import Path

from benchmarks.measured.campaign_folder import monotonic_campaign, read_table
from benchmarks.measured.reading_error import scatter_of_neighbours

NAME = "judge-2012-spiral-strand"
_PIECES = 4  # of 13 points
_TOML = """title = "Spiral strand of 120 wires, pull to the break (Judge et al. 2012)"

[section]   # sum of E A of the wires
EA = "407 MN"

[sensors]
force = "{force:.4g} MN"
"""


def write(data: Path, folder: Path) -> Path:
    """Write the campaign from the folder of the data sets into `folder`."""
    strain, force = read_table(data / NAME / "test.csv", ("strain [-]", "force [MN]")).T
    return monotonic_campaign(
        folder,
        _TOML.format(force=scatter_of_neighbours(strain, force)),
        {"kind": "tension", "specimen": "strand"},
        {"strain [-]": strain, "force [MN]": force},
        _PIECES,
    )
