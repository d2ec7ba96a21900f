"""A scenario file says where every number comes from, and every fault in it becomes one sentence."""

import tomllib

import pytest

from beam import builtin_scenarios, published_section, read_scenario
from geometry.errors import SpecError

NAME = "intelligent-horizontal"


@pytest.fixture(scope="module")
def scenario():
    return read_scenario(NAME)


def written(tmp_path, text: str) -> str:
    path = tmp_path / "mine.toml"
    path.write_text(text)
    return str(path)


def source_text(name: str = NAME) -> str:
    from beam import scenario_file

    return (scenario_file._folder() / f"{name}.toml").read_text()


def test_built_in_scenario_is_found(scenario):
    """The published case: 400 elements, the speed limit 6.86 m/min, the trolley at half speed."""
    assert NAME in builtin_scenarios()
    assert scenario.elements == 400
    assert scenario.drive.speed.value == pytest.approx(6.86 / 60)
    assert scenario.drive.trolley_ratio.value == 0.5
    assert scenario.constants == "published"


@pytest.mark.parametrize("name", builtin_scenarios())
def test_every_number_has_status_and_source(name):
    """Status published, deduced or assumed; assumed entries have the range to sweep, which holds the value."""
    entries = read_scenario(name).entries()
    assert len(entries) > 20
    for key, entry in entries.items():
        assert entry.status in ("published", "deduced", "assumed"), key
        assert entry.source.strip(), key
        if entry.status == "assumed":
            assert entry.range is not None and entry.range[0] <= entry.value <= entry.range[1], key


@pytest.mark.parametrize("name", builtin_scenarios())
def test_no_number_outside_an_entry(name):
    """Besides the schema, the file holds no bare number."""
    raw = tomllib.loads(source_text(name))
    bare = [key for key, value in raw.items() if isinstance(value, (int, float)) and key != "schema"]
    assert bare == []


def test_published_section_is_the_solid_circle(scenario):
    """EA = E pi d^2/4 with E = 142 MPa and d = 51.6 mm; GA with the factor 0.9."""
    area = 3.141592653589793 * 0.0516**2 / 4
    section = published_section(scenario)
    assert section.EA_blocked_twist == pytest.approx(142e6 * area, rel=1e-12)
    assert section.GA_x == pytest.approx(0.9 * 53e6 * area, rel=1e-12)
    assert section.GA_y == pytest.approx(0.9 * 45e6 * area, rel=1e-12)


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ('speed = { value = "6.86 m/min"', 'speed = { value = "6.86"', "drive.speed: value"),
        ('speed = { value = "6.86 m/min"', 'speed = { value = "6.86 kg"', "cannot be read in m/s"),
        ('"16 m", status = "assumed", range', '"16 m", status = "guessed", range', "status 'guessed' is not one of"),
        ('range = ["12 m", "40 m"], ', "", "needs the range to sweep"),
        ('range = ["12 m", "40 m"]', 'range = ["40 m", "12 m"]', "upside down"),
        ('length = { value = "16 m"', 'length = { value = "50 m"', "outside its own range"),
        ("bend_radius =", "bend_radus =", "unknown key layout.bend_radus; did you mean bend_radius"),
        ("[layout]", "[layuot]", "unknown key layuot; did you mean layout"),
        ("schema = 1", "schema = 2", "schema"),
        ('constants = "published"', "", "constants is missing"),
        ("elements = { value = 400", "elements = { value = 400.5", "whole number"),
        ("elements = { value = 400", "elements = { value = 20", "too few to bend"),
        ('source = "output"', 'source = ""', "the source is empty"),
        ('source = "output"', 'origin = "output"', "unknown key 'origin'"),
        ("[time]", "[time", "not valid TOML"),
    ],
)
def test_fault_becomes_a_sentence(tmp_path, old, new, expected):
    """Each fault names the file and the key, and says what to do."""
    text = source_text()
    assert old in text
    with pytest.raises(SpecError, match=r"mine\.toml") as caught:
        read_scenario(written(tmp_path, text.replace(old, new, 1)))
    assert expected in str(caught.value)


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        ({"time__duration": "130 s"}, "the roller travels"),
        ({"time__duration": "150 s"}, "longer than the cable"),
        ({"layout__upper_strand": "15.5 m"}, "for the lower strand"),
        ({"layout__inclination": "80 deg"}, "outside what can be computed"),
        ({"drive__ramp_end": "0.1 s"}, "ramp_end must be later"),
        ({"time__frame": "1 ms"}, "largest_step must not exceed"),
        ({"cable__lenght": "1 m"}, "did you mean length"),
    ],
)
def test_what_cannot_be_true_is_refused(scenario, changes, expected):
    """A roller that runs off, a stroke longer than the cable, a shape without lower strand."""
    if "130" in str(changes):
        changes = {**changes, "layout__upper_strand": "8.5 m"}
    with pytest.raises(SpecError) as caught:
        scenario.changed(**changes)
    assert expected in str(caught.value)
    assert "\n" not in str(caught.value)


def test_unknown_name_lists_the_known_ones():
    """Whoever mistypes a name sees the names."""
    with pytest.raises(SpecError, match=f"there is no scenario 'intelligent'.*{NAME}"):
        read_scenario("intelligent")


def test_slack_brings_the_roller_nearer(scenario):
    """A cable that is 20 mm longer than the taut path lets the roller stand 10 mm nearer to the supply."""
    loose = scenario.changed(layout__slack="20 mm")
    assert loose.roller_start - scenario.roller_start == pytest.approx(0.010)


def test_changed_entry_is_marked(scenario):
    """A value that was set for one run is no longer called published."""
    assert scenario.changed(cable__elements=100).cable.elements.status == "chosen"
