"""A calibrated stiffness that the cable's own section cannot have is said, with what could make it seem so."""

from dataclasses import replace

import pytest
from made_bench import MODEL, RICH, made, one_sided

import homogenize
from compare import compare
from compare.section_finding import section_findings
from homogenize.stiffness_bounds import StiffnessRange

RANGES = {
    "EI": StiffnessRange("EI", "N m^2", 20.0, 150.0, "all interfaces sliding", "all bonded"),
    "EA": StiffnessRange("EA", "N", 3.0e5, 6.0e5, "twist free", "twist blocked"),
}


@pytest.fixture
def cable(monkeypatch):
    """A cable whose section allows these ranges, so that no cell has to be solved."""
    monkeypatch.setattr(homogenize, "allowed_stiffness", lambda _cable: RANGES)
    return "example-three-core"


def found(kind, ratio, cable):
    campaign = made([], kind, one_sided(RICH) if kind == "tension" else RICH, n=40, ratio=ratio)
    campaign = replace(campaign, cable=cable)
    return section_findings(campaign, compare(MODEL, campaign))


@pytest.mark.parametrize(("kind", "ratio"), [("bending", 1.0), ("bending", 0.3), ("bending", 1.5), ("tension", 1.0)])
def test_inside_nothing_is_said(kind, ratio, cable):
    """From all interfaces sliding to all bonded every stiffness is one that the cable can have."""
    assert found(kind, ratio, cable) == ()


@pytest.mark.parametrize(
    ("kind", "ratio", "name", "word", "could"),
    [
        ("bending", 2.0, "EI", "above", "stiffening"),
        ("bending", 0.1, "EI", "below", "slack"),
        ("tension", 0.5, "EA", "below", "end-load-introduction"),
        ("tension", 2.0, "EA", "above", "gain of the sensor"),
    ],
)
def test_outside_it_is_a_finding(kind, ratio, name, word, could, cable):
    """Too stiff or too soft: the sentence names the stiffness, the side, and the effects that could cause it."""
    (sentence,) = found(kind, ratio, cable)
    assert sentence.startswith(f"{name}: ") and f"lies {word} what the section" in sentence and could in sentence


def test_no_cable_no_claim(cable):
    """Without a cable nothing is known of what its section allows."""
    assert found("bending", 2.0, None) == ()
