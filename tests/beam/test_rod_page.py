"""The example of docs/rod.md runs as printed: a cable between a wall and a trolley on rails."""

from pathlib import Path

import numpy as np
import pytest

PAGE = Path(__file__).resolve().parents[2] / "docs" / "rod.md"


def test_a_trolley_on_rails_gives_way_only_along_them():
    """The sagging cable draws the trolley to the wall; the rails keep it level and carry its weight and half the cable's."""
    names = {}
    code = PAGE.read_text(encoding="utf-8").split("```python\n", 1)[1].split("```", 1)[0]
    exec(compile(code, str(PAGE), "exec"), names)
    run, model = names["run"], names["model"]
    assert run.outcome.completed and abs(run.ledger.balance_error) < 1e-4
    place = run.q[model.row("trolley"), 0:3]
    assert 1.9 < place[0] < 2.0 - 1e-4 and np.abs(place[1:]).max() < 1e-9
    reaction = names["joint_reactions"](model, run.t, run.q)[0]
    half = 0.5 * 2.0 * names["rod"].mass_per_length
    assert reaction[1] == pytest.approx((25.0 + half) * 9.81, rel=0.05)  # the moments at the ends shift a little
