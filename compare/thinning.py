"""Very long records are thinned before anything is learnt from them: every k-th sample, so that at most a limit is left.

The evidence of an effect grows with the conditions and cycles of a campaign, hardly with the samples of one cycle, which are
correlated. The comparison itself (`helicable compare`) uses every sample.
"""

from __future__ import annotations

import logging
from dataclasses import replace

from compare.campaign import Campaign
from compare.experiment import Experiment, Record

MOST_SAMPLES = 3000
log = logging.getLogger(__name__)


def thinned(campaign: Campaign, most: int = MOST_SAMPLES) -> tuple[Campaign, tuple[str, ...]]:
    """The campaign with at most `most` samples in every open record, and a sentence for the records that were longer."""
    long = [e for e in campaign.experiments if e.is_open and len(e.record) > most]
    if not long:
        return campaign, ()
    experiments = tuple(_thin(e, most) if e in long else e for e in campaign.experiments)
    names = ", ".join(e.id for e in long[:5]) + (" ..." if len(long) > 5 else "")
    note = (
        f"{len(long)} record(s) have more than {most} samples ({names}): explain uses every k-th sample of them, so that "
        f"at most {most} are left. Whatever is faster than that is not seen."
    )
    return replace(campaign, experiments=experiments), (note,)


def _thin(experiment: Experiment, most: int) -> Experiment:
    record = experiment.record
    step = -(-len(record) // most)
    channels = {name: replace(c, values=c.values[::step]) for name, c in record.channels.items()}
    time = None if record.time is None else record.time[::step]
    return replace(experiment, table=Record(time, record.prescribed, record.measured, channels))
