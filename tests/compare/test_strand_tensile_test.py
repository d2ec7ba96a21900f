"""Tensile test of a strand: frame and grips in series with it, and the modulus found again from the record alone."""

import numpy as np
import pytest

from compare.strand_modulus import strand_modulus
from compare.strand_tensile_test import TensileRecord, slip_forms, synthetic_record
from geometry.errors import InputError, SpecError

E, AREA, FRAME = 80e9, 7.143e-6, 50e6
SLIPS = {"comes to an end": (3e-4, 5e-4, 1e-3), "one sudden slip": (2e-4, 2e-3), "bites as it slides": (0.05, 1e-3)}


def made(**options):
    return synthetic_record(E, AREA, **options)


def test_sampling_of_the_published_test():
    """100 mm/min on 100 mm, each 0.032 s: a step of strain of 5.33e-4 a sample."""
    record = made(unload=False)
    assert np.diff(record.travel / record.length) == pytest.approx(1 / 60 * 0.032, rel=1e-9)
    assert record.force == pytest.approx(E * AREA * record.travel / 0.1, rel=1e-12)


@pytest.mark.parametrize("form", SLIPS)
def test_force_is_in_balance_along_the_series(form):
    """u = F L/(E A) + F/k + s(F), with s of the grips alone: the three parts add up to the travel of the crosshead."""
    record = made(slip=SLIPS[form], form=form, machine_stiffness=FRAME, unload=False)
    elastic = record.force * (record.length / (E * AREA) + 1 / FRAME)
    lost = record.travel - elastic
    assert np.all(np.diff(lost) > -1e-15) and lost[0] == 0
    whole = {"comes to an end": SLIPS[form][0], "one sudden slip": SLIPS[form][0], "bites as it slides": None}[form]
    if whole is None:
        whole = SLIPS[form][0] * (record.force[-1] / (E * AREA) - SLIPS[form][1])
        assert lost[-1] == pytest.approx(whole, rel=1e-9)
    else:
        assert 0.8 * whole < lost[-1] <= whole * (1 + 1e-9)
    assert form in slip_forms()


def test_frame_alone_is_taken_out_exactly():
    """Springs in series: 1/slope = L/(E A) + 1/k, without noise to round-off of the fit."""
    record = made(machine_stiffness=FRAME)
    found = strand_modulus(record, AREA, machine_stiffness=FRAME)
    assert found.slip_form == "none"
    assert pytest.approx(E, rel=1e-6) == found.E
    assert found.slope_modulus == pytest.approx(E / (1 + E * AREA / (FRAME * 0.1)), rel=1e-6)
    assert found.machine_modulus == pytest.approx(E, rel=1e-6)


@pytest.mark.parametrize("form", SLIPS)
def test_modulus_is_found_again_under_noise(form):
    """Within three standard errors of the fit, which is below 2 %; the straight line is more than 20 % low."""
    record = made(slip=SLIPS[form], form=form, machine_stiffness=FRAME, noise=4.0, seed=3, start=2e-5)
    found = strand_modulus(record, AREA, machine_stiffness=FRAME)
    assert found.slip_form == form
    assert abs(found.E - E) < 3 * found.standard_error < 0.02 * E
    assert found.slope_modulus < 0.8 * E
    assert found.noise == pytest.approx(4.0, rel=0.5)  # 31 samples, 4 to 5 unknowns


def test_doubt_of_the_frame_goes_into_the_modulus():
    """dE/E = E A/(k L) dk/k, seen by evaluating the same record with another k."""
    record = made(machine_stiffness=FRAME)
    found = strand_modulus(record, AREA, machine_stiffness=FRAME, machine_error=0.01)
    other = strand_modulus(record, AREA, machine_stiffness=1.01 * FRAME)
    assert found.parts["machine"] == pytest.approx(abs(other.E / E - 1), rel=0.03)  # first order in 1 %
    longer = TensileRecord(record.travel, record.force, 0.101)
    moved = strand_modulus(longer, AREA, machine_stiffness=FRAME).E / E - 1
    assert moved == pytest.approx(0.01, rel=0.01)  # E = L / (A (u/F - 1/k)): the length enters once
    assert strand_modulus(record, AREA, machine_stiffness=FRAME, length_error=0.01).parts["length"] == pytest.approx(
        moved, rel=0.01
    )


def test_record_without_unloading_says_so():
    assert not strand_modulus(made(unload=False), AREA).unloaded
    assert strand_modulus(made(), AREA).unloaded


@pytest.mark.parametrize(
    ("record", "options", "sentence"),
    [
        (made().until(100.0), {}, "samples"),
        (made(), {"machine_stiffness": 1e6}, "stated too low"),
        (TensileRecord(-made().travel, made().force, 0.1), {}, "signs"),
        (TensileRecord(made().travel, 0 * made().force, 0.1), {}, "never changes"),
        (TensileRecord(made().travel * np.nan, made().force, 0.1), {}, "not finite"),
    ],
)
def test_unusable_records_are_sentences(record, options, sentence):
    with pytest.raises(InputError, match=sentence):
        strand_modulus(record, AREA, **options)


def test_impossible_arguments_are_sentences():
    with pytest.raises(SpecError, match="area is -1"):
        strand_modulus(made(), -1.0)
    with pytest.raises(SpecError, match="doubts"):
        strand_modulus(made(), AREA, area_error=2.0)
