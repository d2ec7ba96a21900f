"""Options that several verbs share."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

CableArgument = Annotated[
    str, typer.Argument(metavar="CABLE", help="A built-in cable (see `helicable cables`) or a TOML file.")
]
CampaignArgument = Annotated[
    Path, typer.Argument(metavar="CAMPAIGN", help="Folder with campaign.toml and experiments.csv.")
]
JsonOption = Annotated[Path | None, typer.Option("--json", metavar="FILE", help="Write the result for machines.")]
OutOption = Annotated[
    Path | None, typer.Option("--out", metavar="DIR", help="Write pictures and tables into this folder.")
]
SizeOption = Annotated[
    str | None, typer.Option("--size", metavar="LENGTH", help='Element size in the cross-section, such as "1.5 mm".')
]
