"""The page on effects says what the code does: its table is the library, its examples run."""

import re
from pathlib import Path

from effects import find, library, unregister
from effects.effect_check import defect

PAGE = Path(__file__).resolve().parents[2] / "docs" / "effects.md"


def table():
    lines = [line for line in PAGE.read_text(encoding="utf-8").splitlines() if line.startswith("| `")]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]


def test_table_is_the_library():
    """Name, kind, title, kinds of experiment and needs of every effect, in order."""
    expected = [
        [
            f"`{e.name}`",
            e.kind,
            e.title[:1].upper() + e.title[1:],
            {4: "all bench kinds", 5: "all kinds"}.get(len(e.kinds)) or ", ".join(e.kinds),
            e.needs,
        ]
        for e in library()
    ]
    assert table() == expected


def test_examples_run_and_are_found():
    blocks = re.findall(r"```python\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)
    assert len(blocks) == 2
    try:
        space: dict = {}
        for block in blocks:
            assert len([line for line in block.splitlines() if line.strip()]) <= 12
            exec(block, space)
        assert find("armour-locking") is space["armour_locking"] and find("wear") is space["wear"]
        assert [e.name for e in library()[-2:]] == ["armour-locking", "wear"]
        assert defect(space["wear"]) is None and space["wear"].forms[0].advance is None
        assert space["armour_locking"].forms[0].advance is not None
    finally:
        unregister("armour-locking")
        unregister("wear")
