"""Bending of the Cardinal ACSR conductor at 40 kN as a campaign: moment over curvature, monotonic.

The curve comes from a repository that calls it experimental, while its file name suggests the model of Foti & Martinelli
(J. Wind Eng. Ind. Aerodyn. 2018, doi 10.1016/j.jweia.2018.09.005): it is not called measured here. One axial tension only,
so that a slip limit that grows with tension cannot be told from a yield limit that does not.
"""

from __future__ import annotations

from pathlib import Path

from benchmarks.measured.campaign_folder import monotonic_campaign, read_table
from benchmarks.measured.reading_error import scatter_of_neighbours

NAME = "cardinal-acsr-bending"
_PIECES = 6  # of 18 points
_TOML = """title = "Cardinal ACSR conductor, bending at 40 kN (curve of Foti & Martinelli 2018)"

[section]   # a scale only
EI = "500 N m^2"

[sensors]
moment = "{moment:.4g} N m"
"""


def write(data: Path, folder: Path) -> Path:
    """Write the campaign from the folder of the data sets into `folder`."""
    table = read_table(data / NAME / "moment_curvature_40kN.csv", ("curvature [1/m]", "moment [N m]"))
    curvature, moment = table.T
    row = {"kind": "bending", "specimen": "conductor", "axial tension [N]": "40000"}
    return monotonic_campaign(
        folder,
        _TOML.format(moment=scatter_of_neighbours(curvature, moment)),
        row,
        {"curvature [1/m]": curvature, "moment [N m]": moment},
        _PIECES,
    )
