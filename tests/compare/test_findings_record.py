"""What explain returns: the contract's keys for each of the five verdicts, finite numbers only, and sentences."""

from __future__ import annotations

import json
import math
from dataclasses import replace

import numpy as np
import pytest
from made_findings import VERDICTS, made_check, made_findings

from compare.findings import SetError, Untestable
from compare.findings_record import check_record, explain_schema, findings_record
from compare.findings_sentences import first_screen, uncalibrated, uncertain, with_units

KEYS = (
    "schema",
    "verdict",
    "effects",
    "confusable",
    "closest",
    "ranking",
    "untestable",
    "error",
    "where",
    "next_experiment",
)


def numbers(value):
    """Every number in a nested structure."""
    if isinstance(value, dict):
        return [n for v in value.values() for n in numbers(v)]
    if isinstance(value, list):
        return [n for v in value for n in numbers(v)]
    return [value] if isinstance(value, float) else []


@pytest.mark.parametrize("verdict", VERDICTS)
def test_the_contracts_keys_come_first_and_in_order(verdict):
    record = findings_record(made_findings(verdict))
    assert tuple(record)[: len(KEYS)] == KEYS
    assert record["schema"] == 1 and record["verdict"] == verdict
    assert record["error"]["unit"] == "relative to the noise floor"
    assert record["error"]["sealed"] is None
    assert {"before", "after", "floor"} <= set(record["error"]["validate"])
    assert {"effect", "kind", "log_e", "share", "parameters", "note"} <= set(record["ranking"][0])
    assert {"value", "std", "unit"} <= set(next(iter(record["ranking"][0]["parameters"].values())))
    assert json.loads(json.dumps(record, allow_nan=False)) == record
    assert all(math.isfinite(n) for n in numbers(record))


@pytest.mark.parametrize("verdict", VERDICTS)
def test_it_is_valid_by_the_schema_that_ships(verdict):
    jsonschema = pytest.importorskip("jsonschema")
    schema = explain_schema()
    jsonschema.Draft202012Validator.check_schema(schema)
    jsonschema.Draft202012Validator(schema).validate(findings_record(made_findings(verdict)))


BROKEN = {
    "a sixth verdict": {"verdict": "maybe"},
    "no name for identified": {"effects": []},
    "closest but not unknown": {"closest": {"effect": "slack", "share": 0.3}},
    "an error in newtons": {"error": {"unit": "N", "calibrate": None, "validate": None, "sealed": None}},
    "a chance above one": {
        "next_experiment": {
            "kind": "bending",
            "conditions": {},
            "separates": [],
            "p_wrong_before": 1.2,
            "p_wrong_after": 0.0,
        }
    },
    "an effect twice": {"effects": ["slack", "slack"]},
    "no schema": {"schema": 2},
}


@pytest.mark.parametrize("name", BROKEN)
def test_the_schema_refuses(name):
    jsonschema = pytest.importorskip("jsonschema")
    validator = jsonschema.Draft202012Validator(explain_schema())
    record = findings_record(made_findings("identified"))
    assert validator.is_valid(record)
    assert not validator.is_valid({**record, **BROKEN[name]})


def test_the_set_is_named_for_confusable_only_and_effects_stay_empty():
    record = findings_record(made_findings("confusable"))
    assert record["effects"] == [] and set(record["confusable"]) == {"interlayer-friction", "plasticity"}
    assert record["next_experiment"]["conditions"] == {"axial tension [N]": 4000.0, "amplitude [1/m]": 1.6}
    for verdict in ("none", "identified", "unknown"):
        assert findings_record(made_findings(verdict))["confusable"] == []


def test_closest_stands_for_unknown_only():
    assert findings_record(made_findings("unknown"))["closest"] == {"effect": "viscous-damping", "share": 0.42}
    assert findings_record(made_findings("none"))["closest"] is None


def test_what_is_not_finite_is_null_and_said_so():
    findings = made_findings("identified")
    record = findings_record(replace(findings, errors={"calibrate": SetError(np.inf, 1.0)}))
    assert record["error"]["calibrate"]["before"] is None
    assert record["error"]["validate"] is None
    assert any("error.calibrate.before is null" in note for note in record["notes"])
    assert record["ranking"][3]["parameters"]["c3"]["std"] is None  # the made std is infinite
    assert not any("plausible" in note for note in record["notes"]), "an open range is not a lost number"


def test_every_verdict_has_its_five_sentences():
    for verdict in VERDICTS:
        findings = made_findings(verdict)
        screen = dict(first_screen(findings))
        assert list(screen) == ["Model vs data", "Missing effect", "Why not", "Held out", "Next"]
        assert screen["Missing effect"].startswith(verdict)
        assert screen["Missing effect"].startswith(findings.headline())
        assert "thermal-softening" in screen["Why not"] and "20 degC" in screen["Why not"]
        assert "nan" not in " ".join(screen.values()).lower()


def test_sentences_carry_the_numbers():
    screen = dict(first_screen(made_findings("identified")))
    assert "log e 214 (needs 7.5)" in screen["Missing effect"] and "97 %" in screen["Missing effect"]
    assert "3.4 -> 1.05 x floor, excess ratio 0.15 [0.11, 0.2], confirmed" in screen["Held out"]
    assert "Gaussian process patch 2.7" in screen["Held out"]
    assert "50 % -> 1e-04" in dict(first_screen(made_findings("confusable")))["Next"]
    assert "a slip limit of 0.2 N m" in dict(first_screen(made_findings("none")))["Missing effect"]


def test_an_error_that_did_not_fall_is_not_confirmed():
    errors = {"validate": SetError(3.4, 3.3, 1.0, 0.97, 0.9, 1.02, {}, False)}
    assert "NOT CONFIRMED" in dict(first_screen(replace(made_findings("identified"), errors=errors)))["Held out"]


def test_the_uncalibrated_model_stands_first_with_its_ratio():
    sentence = uncalibrated(made_findings("identified"))
    assert sentence.startswith("27 x the noise floor as predicted, 9.18 x calibrated")
    assert "EI 0.842 of the predicted (79.98" in sentence  # 80 of 95 N m^2


def test_uncertainty_rounds_to_two_digits():
    assert uncertain(0.0000123, 0.0000002, "1/s") == "(1.230 ± 0.020)e-5 1/s"
    assert uncertain(5.213e6, 2.3e4, "N") == "(5.213 ± 0.023)e6 N"
    assert uncertain(2.0, 0.0, "s") == "2 s"


def test_check_has_a_row_per_experiment_and_a_full_confusion_matrix():
    record = check_record(made_check())
    assert len(record["experiments"]) == 12
    assert record["experiments"][0] | {"id": "b01a", "kind": "bending", "set": "calibrate"} == record["experiments"][0]
    confusion = np.array(record["separation"]["confusion"])
    assert confusion.shape == (4, 4) and np.all(np.diag(confusion) == 0.5)
    json.dumps(record, allow_nan=False)


def test_conditions_get_their_unit_once():
    assert with_units({"temperature": 293.15, "frequency [Hz]": 1.0}) == {
        "temperature [K]": 293.15,
        "frequency [Hz]": 1.0,
    }


def test_untestable_without_rivals_is_said():
    findings = replace(made_findings("none"), ranking=(), untestable=(Untestable("slack", "no compression"),))
    assert dict(first_screen(findings))["Why not"] == "Not testable: slack (no compression)."
