"""Very long records are thinned evenly, and it is said; shorter ones are left as they are."""

from dataclasses import replace

import numpy as np
import pytest
from made_bench import MODEL, RICH, blank, made, measured, switched, white

from compare import explain
from compare.thinning import thinned


@pytest.mark.parametrize(("n", "most", "left"), [(1000, 300, 250), (1000, 999, 500), (999, 333, 333), (301, 300, 151)])
def test_every_kth_sample(n, most, left):
    """k is the smallest step that leaves at most the limit; samples stay in step over all channels and the clock."""
    campaign = measured(MODEL, blank("bending", RICH[:2], n), white(0.01), 0)
    short, notes = thinned(campaign, most)
    step = -(-n // most)
    for before, after in zip(campaign.experiments, short.experiments):
        assert len(after.record) == left <= most
        np.testing.assert_array_equal(after.record.time, before.record.time[::step])
        for name in ("curvature", "moment"):
            np.testing.assert_array_equal(after.record[name], before.record[name][::step])
        assert len(before.record) == n  # what was read is not changed
    assert len(notes) == 1 and str(most) in notes[0]


def test_short_records_are_left_alone():
    """Up to the limit nothing is touched and nothing said; a mixed campaign keeps its short records to the last sample."""
    campaign = measured(MODEL, blank("bending", RICH[:2], 300), white(0.01), 0)
    assert thinned(campaign, 300) == (campaign, ())
    mixed = replace(campaign, experiments=(*campaign.experiments, *blank("tension", RICH[:1], 700)))
    short, notes = thinned(mixed, 300)
    assert [len(e.record) for e in short.experiments] == [300] * 4 + [234] * 2
    assert notes[0].startswith("2 record(s)")


def test_a_table_without_clock():
    """A loop without a clock is thinned along its samples."""
    campaign = measured(MODEL, blank("bending", RICH[:1], 400), white(0.01), 0)
    loops = replace(
        campaign, experiments=tuple(replace(e, table=replace(e.record, time=None)) for e in campaign.experiments)
    )
    short, _ = thinned(loops, 100)
    assert all(e.record.time is None and len(e.record) == 100 for e in short.experiments)


def test_the_answer_survives():
    """A campaign of long records has the name that it has when it is thinned, and the note says so."""
    campaign = made([switched("stiffening", "bending", (), (0.2,))], "bending", RICH[:5], n=6001)
    findings = explain(MODEL, campaign)
    assert findings.effects == ("stiffening",)
    assert any("every k-th sample" in note for note in findings.notes)
    assert all(len(f.measured) <= 3000 for f in findings.comparison.fits)
