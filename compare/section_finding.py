"""A calibrated stiffness that the cable's own section cannot have is a finding, however well the model then fits.

Where the campaign names a cable, its EA, GJ and EI must lie between all interfaces sliding and all bonded, twist free and
blocked (:mod:`homogenize.stiffness_bounds`). Outside, something between the rig and the section is missing from the model.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from compare.calibration import ParameterValue
from compare.campaign import Campaign
from compare.comparison import Comparison
from compare.search import Stage
from geometry import Cable

_BELOW = (
    "end-load-introduction, rig-compliance, grip-slip, backlash, slack or thermal-softening could make it seem softer"
)
_ABOVE = "stiffening, tension-stiffening, interlayer-friction that sticks, or a wrong gain of the sensor could make it seem stiffer"


def section_findings(campaign: Campaign, comparison: Comparison) -> tuple[str, ...]:
    """Sentences on calibrated stiffnesses outside what the cable's section allows; none without a cable."""
    if campaign.cable is None or not comparison.calibration.values:
        return ()
    from homogenize import allowed_stiffness

    ranges = allowed_stiffness(_cable(campaign))
    sentences = []
    for name, value in comparison.calibration.values.items():
        allowed = ranges.get(name)
        sentence = allowed.finding(value.value) if allowed is not None else None
        if sentence is not None and allowed is not None:
            could = _BELOW if value.value < allowed.low else _ABOVE
            sentences.append(f"{name}: {sentence} The effects {could}.")
    return tuple(sentences)


def with_expectations(
    parameters: Mapping[str, ParameterValue], campaign: Campaign, final: Stage
) -> dict[str, ParameterValue]:
    """The parameters of friction in bending, with what the lay-up of the campaign's cable lets expect beside them."""
    block = next((b for b in final.blocks if b.kind == "bending"), None)
    if campaign.cable is None or block is None or not any(k.startswith("interlayer-friction:") for k in parameters):
        return dict(parameters)
    from effects.layer_slip import expected

    tension = block.paths[0].typical_tension
    ranges = expected(_cable(campaign), tension) if tension > 0 else {}
    found = dict(parameters)
    for name, (low, high) in ranges.items():
        key = f"interlayer-friction: {name}"
        if key in found:
            grip = ", gripped by tension alone" if name == "slip strain" else ""
            found[key] = replace(found[key], expected=f"{low:.2g} to {high:.2g} from the lay-up{grip}")
    return found


def _cable(campaign: Campaign) -> Cable:
    from geometry import read_cable

    assert campaign.cable is not None
    path = campaign.folder / campaign.cable
    return read_cable(path if path.is_file() else campaign.cable)
