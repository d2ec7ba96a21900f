"""The ladder: published numbers, rungs that follow from each other, the record."""

import numpy as np
import pytest
from section_meshes import rings

from geometry.errors import InputError
from homogenize.specimen import AxialGrading, Specimen
from homogenize.specimen.ladder import PUBLISHED, Step, ladder, ladder_steps, long_cable_rungs
from homogenize.specimen.ladder_record import inputs_key, kept_rungs, part_of, read_ladder, write_ladder


@pytest.fixture(scope="module")
def rungs():
    """A stiff core in rubber; no contact and no large displacements."""
    mesh = rings((0.006, 0.025), (60e9, 0.3), (4e6, 0.45), around=8, per_ring=1, twist_rate=16.0)
    specimen = Specimen(0.1, grading=AxialGrading(end_size=0.1, largest=0.5, growth=2.0, degree=3))
    return mesh, ladder(ladder_steps(mesh, specimen, large=False))


def test_what_is_released_gets_softer(rungs):
    """Twist, then the plate, then the interface. A coaxial section does not twist under tension; held ends only stiffen."""
    blocked, released, plate, traction, elastic = (rung.E for rung in rungs[1])
    assert released == pytest.approx(blocked, rel=1e-9)  # rounding of two inverses
    assert plate > released
    assert plate > traction > elastic


def test_the_long_cable_is_a_rod(rungs):
    """u_z = F L / (E A)."""
    blocked, released = long_cable_rungs(rungs[0], 0.1)
    for rung in (blocked, released):
        assert rung.u_z == pytest.approx(
            2000.0 * 0.1 / (rung.E * np.pi * 0.025**2), rel=1e-2
        )  # area of curved elements


def test_a_linear_rung_does_not_know_the_sign(rungs):
    """Only contacts and large displacements part +X and -X."""
    traction = rungs[1][3]
    assert traction.u_plus_x == traction.u_minus_x
    assert PUBLISHED.u_minus_x - PUBLISHED.u_plus_x == pytest.approx(1.01e-3)
    assert PUBLISHED.misfit(PUBLISHED) == 0.0


def test_a_record_comes_back_as_it_was(rungs, tmp_path):
    """Written and read; what is not a record is refused."""
    path = tmp_path / "ladder.json"
    write_ladder(rungs[1], path, "rings")
    assert read_ladder(path) == ("rings", rungs[1])
    path.write_text("{}")
    with pytest.raises(InputError, match="not a record of a ladder"):
        read_ladder(path)


def test_a_ladder_that_was_stopped_goes_on(rungs, tmp_path):
    """Each rung is kept as it is done; only those that are missing are climbed again, and only for the same inputs."""
    path, climbed = tmp_path / "ladder.json", []
    key = inputs_key("cable", 1.0)

    def step(rung, stops=False):
        def climb(tell):
            climbed.append(rung.name)
            if stops:
                raise KeyboardInterrupt
            return rung

        return Step(rung.name, climb)

    def keep(so_far):
        write_ladder(so_far, part_of(path), key)

    with pytest.raises(KeyboardInterrupt):
        ladder([step(rung, k == 3) for k, rung in enumerate(rungs[1])], done=keep)
    assert kept_rungs(path, key) == rungs[1][:3]
    assert kept_rungs(path, inputs_key("cable", 1.1)) == ()
    climbed.clear()
    assert ladder([step(rung) for rung in rungs[1]], kept=kept_rungs(path, key), done=keep) == rungs[1]
    assert climbed == [rung.name for rung in rungs[1][3:]]
    assert kept_rungs(path, key) == rungs[1]
