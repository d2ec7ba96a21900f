"""Output space mapping: theta = argmin |y - c(theta) - d|, d = full - chain; the chain on what the full model says, and its rod."""

import json
from dataclasses import replace

import numpy as np
import pytest
from made_towing import CONDITIONS, ELEMENTS, TOML, motion, tow_campaign, towing_model

from beam.axial_chain import AxialChain
from compare import Campaign, compare
from compare.output_space_mapping import corrected_by_rod
from compare.towed_rod import Section, carried, rod_tensions
from effects import find
from effects.towed_cable import TowedCable
from geometry.errors import ConvergenceError, InputError

COARSE = 3
AT_REST = 3e-3
"""Standard deviations: both fits end where a step is below a thousandth."""


def itself(cable, stations, _tell):
    return cable.tensions(stations)


def finer(cable, stations, _tell):
    return cable.with_chain(elements=ELEMENTS).tensions(stations)


@pytest.fixture(scope="module")
def campaign(tmp_path_factory):
    """Three conditions with a drag on a chain of 8 elements."""
    folder = tmp_path_factory.mktemp("towed")
    drag = find("viscous-drag").forms[0]
    return Campaign.read(tow_campaign(folder, lambda c: drag.respond(c, (6.0,)), conditions=CONDITIONS[:3], noise=1.0))


@pytest.fixture(scope="module")
def fine(campaign):
    return compare(towing_model(campaign).add("viscous-drag"), campaign)


@pytest.fixture(scope="module")
def coarse(campaign):
    model = towing_model(campaign).add("viscous-drag")
    return compare(replace(model, towing=replace(model.towing, elements=COARSE)), campaign)


def parameters(comparison):
    return np.array(
        [
            comparison.calibration.values["friction coefficient"].value,
            comparison.calibration.parameters["viscous-drag: drag"].value,
        ]
    )


def test_a_full_model_that_is_the_chain_corrects_nothing(fine):
    """d = 0 to the last digit: no parameter moves, one round, no error changes."""
    found = corrected_by_rod(fine, full=itself)
    assert all(r.largest == 0.0 for r in found.records) and found.rounds == 1
    assert max(abs(p.sigmas) for p in found.parameters) < AT_REST
    assert found.errors["calibrate"][0] == pytest.approx(found.errors["calibrate"][1], rel=1e-6)
    assert "no parameter moves" in found.sentence


def test_every_distinctly_led_record_is_run_once(fine):
    """Three conditions, each done twice: three runs in a round."""
    runs = []

    def counted(cable, stations, tell):
        runs.append(cable.chain.tail_tension)
        return itself(cable, stations, tell)

    found = corrected_by_rod(fine, full=counted)
    assert len(runs) == 3
    assert {r.experiments for r in found.records} == {("e0a", "e0b"), ("e1a", "e1b"), ("e2a", "e2b")}


def test_the_correction_brings_a_coarse_chain_to_the_parameters_of_the_fine_one(coarse, fine):
    """Full model: the chain of 8 elements. What a chain of 3 is off by falls to less than a tenth, and the error to the floor."""
    found = corrected_by_rod(coarse, full=finer)
    truth, before = parameters(fine), parameters(coarse)
    after = np.array([p.after for p in found.parameters])
    std = np.array([p.std for p in found.parameters])
    assert np.abs((before - truth) / std).max() > 1.0  # the coarse chain is off by more than its standard deviation
    assert (np.abs(after - truth) < 0.1 * np.abs(before - truth) + 0.1 * std).all()
    chain, corrected = found.errors["calibrate"]
    assert corrected == pytest.approx(fine.relative_error("calibrate"), rel=0.01) and corrected < chain


def test_a_round_is_repeated_where_a_parameter_moved(coarse):
    """By more than a tenth of its standard deviation."""
    assert corrected_by_rod(coarse, full=finer).rounds == 2


def test_a_record_that_cannot_be_run_stays_out_and_is_named(fine):
    def stops(cable, stations, tell):
        if cable.chain.tail_tension > 1000.0:
            raise ConvergenceError("the full rod stopped at t = 1 s.")
        return itself(cable, stations, tell)

    found = corrected_by_rod(fine, full=stops)
    assert not any("e2a" in r.experiments for r in found.records)
    assert any("e2a, e2b could not be run" in note for note in found.notes)
    assert max(abs(p.sigmas) for p in found.parameters) < AT_REST  # out of both fits

    def never(*_given):
        raise ConvergenceError("the full rod stopped at t = 1 s.")

    with pytest.raises(ConvergenceError, match="no record to calibrate"):
        corrected_by_rod(fine, full=never)


def test_a_campaign_without_towing_is_refused(fine):
    bench = replace(fine, campaign=replace(fine.campaign, experiments=()))
    with pytest.raises(InputError, match="no open towing experiment"):
        corrected_by_rod(bench)


def test_progress_and_record_are_told(fine):
    told = []
    record = corrected_by_rod(fine, progress=lambda f, s: told.append((f, s)), full=itself).record()
    assert told[-1][0] == 1.0 and any("e1a" in s for _, s in told)
    assert record["parameters"][0]["name"] == "friction coefficient" and len(record["records"]) == 6
    assert set(record["error"]) == {"calibrate"}


def towed(**changes):
    t, p = motion(0.35, 3.0)
    chain = AxialChain(30.0, 4e5, 4.6, 0.35, 800.0, 0.1, elements=64)
    return TowedCable(replace(chain, **changes), t, p)


CARRIED = {
    "drag and load": {"drag": 4.0, "added": ((0.6, 0.0, 30.0),)},
    "exponential fall": {"fall": 0.15, "fall_speed": 0.1},
    "rational fall and drag": {"fall": 0.15, "fall_speed": 0.1, "fall_power": 0.0, "drag": 4.0},
}


@pytest.mark.parametrize("name", CARRIED)
def test_the_rod_is_the_chain_on_a_straight_trough(name):
    """Incline, tail tension, forth and back: within 0.15 % of the friction rms, at the end and inside.

    That is what elements of 1.5 m and the contact's own compliance leave at breaking away; sliding, both are the same.
    """
    cable, notes = carried(towed(**CARRIED[name]))
    chain = cable.tensions([12.0])
    rod = rod_tensions(cable, Section(2e5, 95.0, 95.0), [12.0])
    friction = 0.35 * 5.2 * 9.81 * 30.0
    assert notes == ()
    for a, b in zip(rod, chain, strict=True):
        assert np.sqrt(np.mean((a - b) ** 2)) < 0.0015 * friction
        assert np.ptp(b) > friction


def test_what_the_rod_cannot_carry_is_named_and_left_out_of_both():
    """A load on a part of the cable goes; friction that falls with speed stays."""
    cable, notes = carried(towed(fall=0.1, fall_speed=0.2, added=((0.6, 0.0, 30.0), (1.0, 5.0, 9.0))))
    assert cable.chain.fall == 0.1 and cable.chain.friction == 0.35
    assert cable.chain.added == ((0.6, 0.0, 30.0),)
    assert len(notes) == 1 and "part of the cable" in notes[0]


def test_a_section_says_what_was_taken(campaign):
    section = Section.of(towing_model(campaign).section, 4e5)
    assert section.EI == 95.0 and "GA" in section.note and "EI" not in section.note
    assert 'EI = "95 N m^2"' in TOML


def test_the_command_writes_the_correction_beside_the_comparison(campaign, tmp_path, capsys):
    """`compare --full-rod --json`: the key `full_rod`, and the sentence on the screen."""
    from helicable.main import main

    file = tmp_path / "found.json"
    assert main(["compare", str(campaign.folder), "--full-rod", "--json", str(file)]) == 0
    found = json.loads(file.read_text())["full_rod"]
    assert found["parameters"][0]["name"] == "friction coefficient" and len(found["records"]) == 6
    assert "Corrected by the full rod" in capsys.readouterr().out
    assert 0 < max(r["rms_over_floor"] for r in found["records"]) < 1.0  # noise of 1 N


def test_the_report_has_the_correction_as_its_last_panel(fine, tmp_path):
    from helicable.rod_correction import correction_panel

    panel = correction_panel(corrected_by_rod(fine, full=itself), tmp_path)
    assert panel.title == "Corrected by the full rod" and (tmp_path / "full-rod.png").stat().st_size > 5000
    assert panel.light.level == "good" and len(panel.tables) == 2
