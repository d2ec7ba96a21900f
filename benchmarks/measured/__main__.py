"""`python -m benchmarks.measured DATA`: what the search says about published measurements, as in docs/measured-data.md.

DATA is the folder that holds the data sets; they are read where they lie and not copied into the repository.
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

from benchmarks.measured import conductor, damper, rubber, strand
from benchmarks.measured.drive_fit import drive_fits, drive_outcome
from compare import BenchModel, Campaign
from compare.explain import explain
from compare.findings import Findings
from compare.verdict import decide


def findings_of(folder: Path) -> Findings:
    """`helicable explain` of a campaign folder, with the model of its own section."""
    campaign = Campaign.read(folder)
    assert campaign.section is not None
    return explain(BenchModel(campaign.section), campaign)


def main(data: Path) -> None:
    """Print all tables."""
    say = sys.stdout.write
    with tempfile.TemporaryDirectory() as scratch:
        for module in (damper, conductor, strand):
            found = findings_of(module.write(data, Path(scratch) / module.NAME))
            say(f"{module.NAME}: {found.verdict} {found.effects or found.confusable}\n")
            for name, error in found.errors.items():
                say(f"  {name}: {error.before:.3g} -> {error.after:.3g} floors, {error.baselines}\n")
            for c in found.ranking[:5]:
                say(f"  {c.effect}: log e {c.log_e:.4g}, share {c.share:.3f}; {c.note}\n")
        decoy = findings_of(damper.write(data, Path(scratch) / "decoy", shuffle=1))
        say(f"{damper.NAME}, residual shuffled: {decoy.verdict}\n")
    outcome = drive_outcome(data)
    say(f"emps-drive: {outcome.verdict} {outcome.effects} {outcome.confusable}, share {outcome.share:.3f}\n")
    for fit in drive_fits(data):
        strengths = ", ".join(f"{v:.4g}" for v in fit.strengths)
        say(f"  {fit.model}: {fit.fitted:.2f} / {fit.held_out:.2f} N; M {fit.M:.2f}, Fv {fit.Fv:.1f}; {strengths}\n")
    outcome = decide((rubber.rubber_block(data, rubber.shear_modulus(data)),), rubber.LIBRARY)
    say(f"treloar-1944: {outcome.verdict} {outcome.effects}, share {outcome.share:.3f}\n")
    for model, chosen in rubber.CANDIDATES.items():
        folds = rubber.leave_one_mode_out(data, chosen)
        cells = ", ".join(f"{f.mode} {f.fitted / 1e6:.3f} -> {f.held_out / 1e6:.3f}" for f in folds)
        say(f"  {model}: {cells}; mean {sum(f.held_out for f in folds) / 3e6:.2f} MPa\n")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("give the folder that holds the data sets: python -m benchmarks.measured DATA")
    main(Path(sys.argv[1]))
