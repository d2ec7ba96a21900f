"""A calibrated stiffness that the cable's own section cannot have is a finding, however well the model then fits.

Where the campaign names a cable, its EA, GJ and EI must lie between all interfaces sliding and all bonded, twist free and
blocked (:mod:`homogenize.stiffness_bounds`). Outside, something between the rig and the section is missing from the model.
"""

from __future__ import annotations

from compare.campaign import Campaign
from compare.comparison import Comparison

_BELOW = "end-load-introduction, rig-compliance, grip-slip, backlash, slack or thermal-softening could make it seem softer"
_ABOVE = "stiffening, tension-stiffening, interlayer-friction that sticks, or a wrong gain of the sensor could make it seem stiffer"


def section_findings(campaign: Campaign, comparison: Comparison) -> tuple[str, ...]:
    """Sentences on calibrated stiffnesses outside what the cable's section allows; none without a cable."""
    if campaign.cable is None or not comparison.calibration.values:
        return ()
    from geometry import read_cable
    from homogenize import allowed_stiffness

    path = campaign.folder / campaign.cable
    ranges = allowed_stiffness(read_cable(path if path.is_file() else campaign.cable))
    sentences = []
    for name, value in comparison.calibration.values.items():
        allowed = ranges.get(name)
        sentence = allowed.finding(value.value) if allowed is not None else None
        if sentence is not None and allowed is not None:
            could = _BELOW if value.value < allowed.low else _ABOVE
            sentences.append(f"{name}: {sentence} The effects {could}.")
    return tuple(sentences)
