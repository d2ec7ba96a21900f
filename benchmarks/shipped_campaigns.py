"""Make the campaigns that ship in data/campaigns, and what is true of them: truth.json for the score, truth.md for readers.

`helicable` reads neither. The SHA-256 of truth.json stands in the README of every campaign, so that a truth that was changed
afterwards shows. Fixed seeds: running this again gives the same files (to the last digit written, where the processor rounds alike).

Run: python -m benchmarks.shipped_campaigns [NAME ...]; the towing campaigns need Exudyn (`pip install exudyn`).
"""

from __future__ import annotations

import hashlib
import json
import sys
from pathlib import Path
from typing import Any

from benchmarks import hidden_effect_campaign
from benchmarks.blind import generator
from benchmarks.hidden_effect_towing import SITES, make_site, truth_section

PARENT = Path(__file__).resolve().parents[1] / "data" / "campaigns"
TORSION = "torsion-1"
TORSION_SEED = 4711
TORSION_CASE: dict[str, Any] = {
    "effects": ("viscoelasticity",), "variants": ("fractional",), "group": "single", "kind": "torsion", "design": "rich", "noise": "ar",
    "size": 0.01, "strength": 0.06, "two_kinds": False,
}  # fmt: skip
HASH = "SHA-256 of [truth.json](../truth.json): `{}`\n"

TORSION_README = """# Torsion tests

**Synthetic.** A cable is twisted to and fro under axial tension, at several amplitudes, frequencies, tensions and temperatures,
every condition twice: some to calibrate, some to validate, some sealed.

Whether an effect beyond a linear stiffness is hidden here stands in [../truth.md](../truth.md), outside this folder. Made by
`python -m benchmarks.shipped_campaigns`, with no code of the model that explains.
"""


def make_torsion(parent: Path) -> None:
    """Write the torsion campaign and its README."""
    folder = generator.make(TORSION_SEED, parent / TORSION, **TORSION_CASE)
    (folder / "README.md").write_text(TORSION_README, encoding="utf-8")


def truths() -> dict[str, Any]:
    """What is true of every shipped campaign."""
    found: dict[str, Any] = {
        "example-hidden-effect": {"effects": ["interlayer-friction"], "kind": "bending"},
        "example-tension": {"effects": [], "kind": "tension"},
        TORSION: {"effects": list(TORSION_CASE["effects"]), "kind": "torsion"},
    }
    return found | {site.name: site.truth() for site in SITES}


def truth_json() -> str:
    """Text of truth.json."""
    return json.dumps(truths(), indent=1, sort_keys=True) + "\n"


def truth_page() -> str:
    """Text of truth.md."""
    label = generator.label(TORSION_SEED, **TORSION_CASE)
    torsion = (
        f"## {TORSION}\n\nMissing in the linear model: **viscoelasticity**, and nothing else: a fractional element, whose relaxation is a "
        f"power of time. Its part that no stiffness absorbs is {100 * label['achieved']:.1f} % of the torque (rms).\n"
        f"Noise: autoregressive (0.7), {100 * TORSION_CASE['size']:g} % of the rms.\n"
    )
    return "\n".join([hidden_effect_campaign.truth_text(), torsion, *(truth_section(site) for site in SITES)])


def write_truth(parent: Path) -> str:
    """Write truth.json and truth.md, put the hash into every README, and return it."""
    text = truth_json()
    digest = hashlib.sha256(text.encode()).hexdigest()
    (parent / "truth.json").write_text(text, encoding="utf-8")
    (parent / "truth.md").write_text(truth_page(), encoding="utf-8")
    for name in truths():
        readme = parent / name / "README.md"
        if readme.is_file():
            body = "\n".join(
                x for x in readme.read_text(encoding="utf-8").splitlines() if not x.startswith("SHA-256 of")
            )
            readme.write_text(f"{body.rstrip()}\n\n{HASH.format(digest)}", encoding="utf-8")
    return digest


def main(names: list[str]) -> None:
    """Make those campaigns, or all, and the truth."""
    if not names or "example-hidden-effect" in names:
        hidden_effect_campaign.main()
    if not names or TORSION in names:
        make_torsion(PARENT)
    for site in SITES:
        if not names or site.name in names:
            make_site(site, PARENT)
    print("sha256 of truth.json:", write_truth(PARENT))


if __name__ == "__main__":
    main(sys.argv[1:])
