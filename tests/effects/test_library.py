"""The library: the contract's effects in its order, each keeping its promises; plug-ins that work and plug-ins that do not."""

import importlib
import logging
import re
import sys
from dataclasses import replace

import pytest

from effects import Effect, Form, Parameter, find, library, library_notes, register, unregister
from effects.effect_check import defect, probe
from geometry.errors import SpecError

CONTRACT = {
    "physics": """interlayer-friction plasticity viscous-damping viscoelasticity stiffening slack cyclic-softening
        thermal-softening tension-stiffening tension-torsion-coupling direction-asymmetry end-load-introduction""",
    "rig": "backlash grip-slip rig-compliance",
    "sensor": "sensor-offset sensor-drift sensor-lag",
}
TOWING = {
    "physics": "trough-friction-stribeck viscous-drag added-load roller-resistance clamp-backlash polygon-effect",
    "rig": "trolley-ratio-error",
}


@pytest.fixture
def fresh_plug_ins():
    importlib.import_module("effects.library")._load_plug_ins.cache_clear()
    yield
    importlib.import_module("effects.library")._load_plug_ins.cache_clear()


def test_names_kinds_and_order_are_the_contracts():
    expected = [(name, kind) for part in (CONTRACT, TOWING) for kind, names in part.items() for name in names.split()]
    assert [(e.name, e.kind) for e in library()] == expected


@pytest.mark.parametrize("effect", library(), ids=lambda e: e.name)
def test_every_effect_keeps_the_promises_of_its_stage(effect):
    assert defect(effect) is None
    assert len({f.name for f in effect.forms}) == len(effect.forms)


@pytest.mark.parametrize("effect", library(), ids=lambda e: e.name)
def test_every_effect_says_what_it_is(effect):
    """One line each; the title has no full stop; every parameter has bounds around its plausible range and a source."""
    for text in (effect.title, effect.equation, effect.source, effect.needs, effect.signature):
        assert text.strip() and "\n" not in text
    for form in effect.forms:
        for p in (*form.shape, *form.strength):
            assert p.meaning
            assert p.low <= p.plausible[0] <= p.plausible[1] <= p.high, (form.name, p.name)
            assert p.source, (form.name, p.name)
            assert not re.search(r"strain|arm|play", p.unit_for("torsion"))


@pytest.mark.parametrize("effect", library(), ids=lambda e: e.name)
def test_starting_values_lie_inside_the_bounds_and_increase(effect):
    for form in effect.forms:
        for p in form.shape:
            assert p.starts is not None
            values = list(p.starts([probe(effect.kinds[0])]))
            assert values == sorted(set(values))
            assert p.low <= values[0] and values[-1] <= p.high


def test_find_names_the_nearest():
    assert find("grip-slip").kind == "rig"
    with pytest.raises(SpecError, match=r"did you mean viscoelasticity"):
        find("viscoelastic")
    with pytest.raises(SpecError, match=r"lists all 25"):
        find("qqq")


def other(name, **changes):
    return replace(find("backlash"), name=name, **changes)


def test_register_adds_and_refuses_a_taken_name():
    mine = register(other("my-play"))
    try:
        assert find("my-play") is mine and library()[-1] is mine
        with pytest.raises(SpecError, match=r"registered already.*replace=True"):
            register(other("my-play"))
        again = register(other("my-play", title="again"), replace=True)
        assert find("my-play") is again and len(library()) == 26
    finally:
        unregister("my-play")
    assert len(library()) == 25
    with pytest.raises(SpecError, match="belongs to an effect of the library"):
        register(other("backlash"), replace=True)


def bad_form(stage, respond, strength=(), shape=()):
    return (Form("mine", stage, respond, shape, strength),)


ONE = (Parameter("gain", "1", "gain"),)
SCALE = (Parameter("size", "1", "size", starts=lambda _paths: [0.5]),)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"name": "My Play"}, "small letters"),
        ({"kind": "magic"}, "none of physics, rig, sensor"),
        ({"kinds": ("weaving",)}, "kinds must be some of"),
        ({"kinds": ("towing",)}, "cannot act in towing"),
        ({"forms": ()}, "has no form"),
        ({"forms": bad_form("somewhere", lambda p: p.strain)}, "stage"),
        ({"forms": bad_form("section", lambda p: p.strain[:, None])}, "no strength"),
        ({"forms": bad_form("section", lambda p: p.strain, ONE)}, r"shape \(241, 1\); it gives \(241,\)"),
        ({"forms": bad_form("bias", lambda p: p.strain[:, None] / 0.0 * 0.0, ONE)}, "not finite"),
        ({"forms": bad_form("fixture", lambda p, s: p.strain * (1 - s) + 1e-9, shape=SCALE)}, "unchanged"),
        ({"forms": bad_form("fixture", lambda p, s: p.strain[1:], shape=SCALE)}, "must give an array"),
        ({"forms": bad_form("filter", lambda x, t, s: x[:, 0], shape=SCALE)}, r"shape \(241, 2\)"),
        ({"forms": bad_form("section", lambda p: p.colour, ONE)}, "fails with AttributeError"),
        ({"forms": bad_form("section", lambda p, a: p.strain, ONE, shape=ONE)}, "gain has no starts"),
    ],
)  # fmt: skip
@pytest.mark.filterwarnings("ignore::RuntimeWarning")
def test_an_effect_that_breaks_its_promises_is_refused_with_a_sentence(changes, words):
    with pytest.raises(SpecError, match=words):
        register(replace(other("mine"), **changes))
    assert len(library()) == 25


def test_only_effects_can_be_registered():
    with pytest.raises(SpecError, match="not int"):
        register(3)


PLUG_IN = """
from dataclasses import replace
from effects import find
ONE = replace(find("backlash"), name="yard-play")
def several():
    return [replace(ONE, name="yard-slip"), replace(ONE, name="yard-sag")]
TAKEN = replace(ONE, name="plasticity")
WRONG = replace(ONE, name="Yard Play")
NUMBER = 3
def broken():
    raise RuntimeError("no licence")
"""
POINTS = {
    "a": "yard_effects:ONE",
    "b": "yard_effects:several",
    "c": "yard_effects:TAKEN",
    "d": "yard_effects:WRONG",
    "e": "yard_effects:NUMBER",
    "f": "yard_effects:broken",
    "g": "no_such_module_here:EFFECT",
    "h": "yard_effects:ONE",
}


def install(folder, name, points):
    """A package as an installer would leave it: its name, its version, its entry points."""
    info = folder / f"{name}-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text("[helicable.effects]\n" + "\n".join(points) + "\n")


def test_plug_ins_of_installed_packages(tmp_path, monkeypatch, fresh_plug_ins, caplog):
    """A package with entry points: what works is in the library, what does not is left out with a note, and nothing stops."""
    (tmp_path / "yard_effects.py").write_text(PLUG_IN)
    install(tmp_path, "yard_effects", [f"{name} = {value}" for name, value in POINTS.items()])
    monkeypatch.syspath_prepend(str(tmp_path))
    with caplog.at_level(logging.WARNING, logger="effects.library"):
        names = [e.name for e in library()]
    assert names[25:] == ["yard-play", "yard-slip", "yard-sag"]
    assert find("yard-sag").kind == "rig"
    told = dict(zip("cdefgh", library_notes(), strict=True))
    for point, words in {
        "c": '"plasticity" is taken', "d": "small letters", "e": "found int", "f": "RuntimeError: no licence",
        "g": "ModuleNotFoundError", "h": '"yard-play" is taken',
    }.items():  # fmt: skip
        assert told[point].startswith(f"plug-in {point} ({POINTS[point]}) is left out") and words in told[point]
    assert [r.getMessage() for r in caplog.records] == list(library_notes())
    with pytest.raises(SpecError, match="belongs to an effect of the library"):
        register(other("yard-play"))
    sys.modules.pop("yard_effects", None)


def test_without_plug_ins_there_are_no_notes(fresh_plug_ins):
    assert library_notes() == ()
    assert all(isinstance(e, Effect) for e in library())


def test_a_package_with_unreadable_entry_points_does_not_take_the_others_with_it(tmp_path, monkeypatch, fresh_plug_ins):
    (tmp_path / "deck_effects.py").write_text(PLUG_IN)
    (tmp_path / "quitting_effects.py").write_text("import sys; sys.exit(3)")
    install(tmp_path, "torn", ["a line without a sign"])
    install(tmp_path, "deck_effects", ["deck = deck_effects:ONE", "quit = quitting_effects:ONE"])
    monkeypatch.syspath_prepend(str(tmp_path))
    assert [e.name for e in library()][25:] == ["yard-play"]
    torn, quits = library_notes()
    assert torn.startswith("package torn is left out") and "quit" in quits and "SystemExit" in quits
    sys.modules.pop("deck_effects", None)
