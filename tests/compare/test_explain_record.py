"""The record of what was found: by the shipped schema, finite, and the same each time the same campaign is explained."""

import json

import pytest
from made_bench import MODEL, RICH, made, one_sided, switched

from compare import explain
from compare.findings_record import explain_schema

CASES = {
    "none": ("bending", [], RICH),
    "identified": ("bending", [switched("viscoelasticity", "bending", (3.0,), (0.3,))], RICH),
    "confusable": ("tension", [switched("rig-compliance", "tension", (0.15,))], one_sided(RICH)),
}


@pytest.fixture(scope="module", params=CASES)
def twice(request):
    """Verdict that is expected, and two records of the same campaign."""
    kind, effects, plan = CASES[request.param]
    campaign = made(effects, kind, plan, n=50, seed=5)
    return request.param, [json.dumps(explain(MODEL, campaign).record(), allow_nan=False) for _ in range(2)]


def test_deterministic(twice):
    """Two runs give the same text but for the seconds that they took: nothing hangs on chance or on the order of a set."""
    verdict, texts = twice
    records = [json.loads(text) for text in texts]
    for record in records:
        seconds = [key for key in record if "second" in key]
        for key in seconds:
            del record[key]
    assert records[0] == records[1]
    assert records[0]["verdict"] == verdict


def test_follows_the_schema(twice):
    """What real campaigns give is valid by the schema that ships."""
    jsonschema = pytest.importorskip("jsonschema")
    validator = jsonschema.Draft202012Validator(explain_schema())
    assert list(validator.iter_errors(json.loads(twice[1][0]))) == []


def test_names_agree(twice):
    """Every name in the record is one of the ranking or of what is untestable; the verdict says which list is filled."""
    record = json.loads(twice[1][0])
    known = {c["effect"] for c in record["ranking"]} | {u["effect"] for u in record["untestable"]}
    assert {*record["effects"], *record["confusable"]} <= known
    assert bool(record["effects"]) == (record["verdict"] == "identified")
    assert bool(record["confusable"]) == (record["verdict"] == "confusable")
    assert bool(record["next_experiment"]) == (record["verdict"] == "confusable")
