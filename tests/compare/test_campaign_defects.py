"""Strict reading: every defect of a campaign gives one sentence that names file, row and column; nothing is guessed."""

from __future__ import annotations

import pytest
from sound_campaign import LIST, LOOP, TOML

from compare import Campaign
from geometry.errors import InputError

HEAD = "id,kind,file,specimen,repeat_of,set\n"
CURVE = "time [s],curvature [1/m],moment [N m]\n"


def listed(rows: str, head: str = HEAD) -> dict[str, str]:
    return {"experiments.csv": head + rows}


DEFECTS = {
    # --- experiments.csv
    "no list": ({"experiments.csv": None}, ["experiments.csv", "no such file"]),
    "empty list": ({"experiments.csv": ""}, ["experiments.csv", "empty"]),
    "list without rows": (listed(""), ["experiments.csv", "no experiment"]),
    "missing column": ({"experiments.csv": LIST.replace(",set,", ",")}, ["experiments.csv, row 1", '"set"']),
    "unknown column": (
        {"experiments.csv": LIST.replace("specimen,", "specimem,", 1)},
        ["experiments.csv, row 1", '"specimen" is missing', '"specimem" meant'],
    ),
    "condition without unit": (
        {"experiments.csv": LIST.replace("length [m]", "length")},
        ["row 1", '"specimen length"', "unit"],
    ),
    "doubled column": ({"experiments.csv": LIST.replace("specimen length [m]", "set")}, ["row 1", '"set"', "twice"]),
    "doubled condition": (
        listed("a,bending,a.csv,S,,calibrate,1,2\n", HEAD.strip() + ",speed [m/s],speed [mm/s]\n"),
        ["row 1", "speed"],
    ),
    "semicolons": ({"experiments.csv": LIST.replace(",", ";")}, ["experiments.csv, row 1", "semicolons"]),
    "ragged row": (listed("a,bending,a.csv,S,,calibrate,7\n"), ["experiments.csv, row 2", "7 cell(s)", "6 columns"]),
    "blank row": (listed("a,bending,a.csv,S,,calibrate\n\nb,bending,b.csv,S,,calibrate\n"), ["experiments.csv, row 3"]),
    "doubled id": (
        listed("a,bending,a.csv,S,,calibrate\na,bending,b.csv,S,,calibrate\n"),
        ["row 3", '"id"', '"a"', "row 2"],
    ),
    "empty id": (listed(",bending,a.csv,S,,calibrate\n"), ["row 2", '"id"', "empty"]),
    "unknown kind": (
        listed("a,bendin,a.csv,S,,calibrate\n"),
        ["row 2", '"kind"', '"bendin"', 'did you mean "bending"'],
    ),
    "unknown set": (listed("a,bending,a.csv,S,,train\n"), ["row 2", '"set"', '"train"', "calibrate, validate, sealed"]),
    "repeat of nothing": (listed("a,bending,a.csv,S,zz,calibrate\n"), ["row 2", '"repeat_of"', '"zz"']),
    "repeat of another kind": (
        listed("a,bending,a.csv,S,,calibrate\nc,tension,c.csv,S,a,validate\n"),
        ["row 3", "bending", "tension"],
    ),
    "repeat of itself": (listed("a,bending,a.csv,S,a,calibrate\n"), ["row 2", '"repeat_of"', "leads back"]),
    "repeats in a ring": (
        listed("a,bending,a.csv,S,b,calibrate\nb,bending,b.csv,S,a,calibrate\n"),
        ["row 2", "leads back"],
    ),
    "continues nothing": (
        listed("a,bending,a.csv,S,,calibrate,q\n", HEAD.strip() + ",continues\n"),
        ["row 2", '"continues"', '"q"'],
    ),
    "continues a sealed one": (
        listed("a,bending,a.csv,S,,sealed,\nb,bending,b.csv,S,,calibrate,a\n", HEAD.strip() + ",continues\n"),
        ["row 3", '"continues"', "sealed"],
    ),
    "unknown control": (
        listed("a,bending,a.csv,S,,calibrate,force\n", HEAD.strip() + ",control\n"),
        ["row 2", '"control"', '"force"'],
    ),
    "control of the other path": (
        listed("c,tension,c.csv,S,,calibrate,strain,2\n", HEAD.strip() + ",control,specimen length [m]\n"),
        ["c.csv, row 1", '"strain"', "extension or force"],
    ),
    "shear without direction": (listed("a,shear,a.csv,S,,calibrate\n"), ["row 2", '"direction"', "x+"]),
    "unknown direction": (
        listed("a,shear,a.csv,S,,calibrate,z+\n", HEAD.strip() + ",direction\n"),
        ["row 2", '"direction"', '"z+"'],
    ),
    "direction of a pull": (
        listed("c,tension,c.csv,S,,calibrate,x+\n", HEAD.strip() + ",direction\n"),
        ["row 2", '"direction"'],
    ),
    "text in a condition": (
        {"experiments.csv": LIST.replace("calibrate,1\n", "calibrate,long\n", 1)},
        ["row 2", "specimen length [m]", '"long"'],
    ),
    "NaN condition": (
        {"experiments.csv": LIST.replace("calibrate,1\n", "calibrate,nan\n", 1)},
        ["row 2", "specimen length [m]", '"nan"'],
    ),
    "length of zero": (
        {"experiments.csv": LIST.replace("calibrate,1\n", "calibrate,0\n", 1)},
        ["row 2", "must be positive"],
    ),
    "colder than cold": (
        listed("a,bending,a.csv,S,,calibrate,-300\n", HEAD.strip() + ",temperature [degC]\n"),
        ["row 2", "absolute zero"],
    ),
    "length missing": (listed("c,tension,c.csv,S,,calibrate\n"), ["c.csv", '"extension"', "specimen length"]),
    "file missing": (
        listed("a,bending,nowhere.csv,S,,calibrate\n"),
        ["experiments.csv, row 2", '"file"', "nowhere.csv"],
    ),
    "file outside": (listed("a,bending,../../a.csv,S,,calibrate\n"), ["experiments.csv, row 2", "outside"]),
    "file absolute": (listed("a,bending,/etc/hostname,S,,calibrate\n"), ["experiments.csv, row 2", "outside"]),
    "file twice": (
        listed("a,bending,a.csv,S,,calibrate\nb,bending,./a.csv,S,a,calibrate\n"),
        ["row 3", '"file"', "already the table of a"],
    ),
    "file is the list": (listed("a,bending,experiments.csv,S,,calibrate\n"), ["row 2", "not a table"]),
    "file is a folder": (listed("a,bending,.,S,,calibrate\n"), ["experiments.csv, row 2", "not a file"]),
    "list not UTF-8": (
        {"experiments.csv": LIST.replace("S1", "Stück").encode("latin-1")},
        ["experiments.csv, row 2", "UTF-8"],
    ),
    # --- tables
    "empty table": ({"a.csv": ""}, ["a.csv", "empty"]),
    "header only": ({"a.csv": CURVE}, ["a.csv", "no row"]),
    "two rows": ({"a.csv": CURVE + "0,0,0\n1,1,1\n"}, ["a.csv", "2 row(s)"]),
    "no load": ({"a.csv": "time [s],curvature [1/m]\n0,0\n1,1\n2,2\n"}, ["a.csv, row 1", '"moment [N m]"', "missing"]),
    "no path": ({"a.csv": "time [s],moment [N m]\n0,0\n1,1\n2,2\n"}, ["a.csv, row 1", '"curvature [1/m]"', "missing"]),
    "two paths": (
        {"c.csv": "extension [mm],strain [-],force [N]\n0,0,0\n1,1,1\n2,2,2\n"},
        ["c.csv, row 1", "extension and strain"],
    ),
    "unknown channel": (
        {"a.csv": LOOP.replace("moment", "momentum")},
        ["a.csv, row 1", "momentum", 'did you mean "moment"'],
    ),
    "channel of another kind": (
        {"a.csv": LOOP.replace("moment", "force")},
        ["a.csv, row 1", '"force [N m]"', "bending"],
    ),
    "doubled channel": ({"a.csv": "curvature [1/m],moment [N m],moment [kN m]\n0,0,0\n"}, ["a.csv, row 1", "moment"]),
    "header with a gap": ({"a.csv": "curvature [1/m],,moment [N m]\n0,0,0\n"}, ["a.csv, row 1, column 2"]),
    "text in a number": ({"a.csv": LOOP + "12,0.2,n/a\n"}, ["a.csv, row 14", "moment [N m]", '"n/a"']),
    "number with underscore": ({"a.csv": LOOP + "12,0.2,1_0\n"}, ["a.csv, row 14", '"1_0"']),
    "quoted number": ({"a.csv": LOOP + '12,0.2,"1"\n'}, ["a.csv, row 14", "moment"]),
    "empty cell": ({"a.csv": LOOP + "12,,1\n"}, ["a.csv, row 14", "curvature [1/m]", "empty"]),
    "NaN": ({"a.csv": LOOP + "12,0.2,NaN\n13,0.1,1\n"}, ["a.csv, row 14", "moment [N m]", '"NaN"']),
    "infinite": ({"a.csv": LOOP + "12,-inf,1\n"}, ["a.csv, row 14", "curvature [1/m]", '"-inf"']),
    "too large": ({"a.csv": LOOP + "12,1e999,1\n"}, ["a.csv, row 14", "curvature [1/m]", "too large"]),
    "square overflows": ({"a.csv": LOOP + "12,0.2,1e150\n"}, ["a.csv, row 14", "moment [N m]", "1e+150 N m"]),
    "stiffness overflows": ({"campaign.toml": TOML.replace("95 N", "1e150 N")}, ["[section] EI", "beyond"]),
    "short row": ({"a.csv": LOOP + "12,0.2\n"}, ["a.csv, row 14", "2 cell(s)", "3 columns"]),
    "long row": ({"a.csv": LOOP + "12,0.2,1,\n"}, ["a.csv, row 14", "4 cell(s)", "3 columns"]),
    "every row too long": ({"a.csv": CURVE + "0,0,0,5\n1,0.1,9,5\n2,0.2,19,5\n"}, ["a.csv, row 2", "4 cell(s)"]),
    "long and short row": ({"a.csv": LOOP + "12,0.2,1,5\n13,0.2\n"}, ["a.csv, row 14", "4 cell(s)"]),
    "blank row in a table": ({"a.csv": LOOP + "\n12,0.2,1\n"}, ["a.csv, row 14", "blank"]),
    "decimal commas": ({"a.csv": LOOP.replace(",", ";")}, ["a.csv, row 1"]),
    "backwards": ({"a.csv": LOOP + "10.5,0.2,1\n"}, ["a.csv, row 14", '"time [s]"', "runs backwards", "11", "10.5"]),
    "standing still": ({"a.csv": LOOP + "11,0.2,1\n"}, ["a.csv, row 14", '"time [s]"', "stands still"]),
    "table not UTF-8": ({"a.csv": LOOP.encode("utf-16")}, ["a.csv, row 1", "UTF-8"]),
    "zero byte": ({"a.csv": LOOP + "12,\0,1\n"}, ["a.csv, row 14", "zero byte"]),
    # --- campaign.toml
    "no campaign.toml": ({"campaign.toml": None}, ["campaign.toml", "no such file"]),
    "empty campaign.toml": ({"campaign.toml": "\n"}, ["campaign.toml", "empty"]),
    "not TOML": ({"campaign.toml": "title = \n[section]\n"}, ["campaign.toml", "line 1"]),
    "no section, no cable": ({"campaign.toml": 'title = "t"\n'}, ["campaign.toml", "cable", "[section]"]),
    "unknown key": ({"campaign.toml": "colour = 1\n" + TOML}, ["campaign.toml", '"colour"']),
    "unknown section key": ({"campaign.toml": TOML.replace("GJ", "JG")}, ["campaign.toml, [section]", '"JG"', "EA"]),
    "no unit": ({"campaign.toml": TOML.replace('"95 N m^2"', "95")}, ["campaign.toml, [section] EI", "unit"]),
    "wrong unit": ({"campaign.toml": TOML.replace("95 N m^2", "95 N m")}, ["campaign.toml, [section] EI", "95 N m"]),
    "negative stiffness": (
        {"campaign.toml": TOML.replace("95 N", "-95 N")},
        ["campaign.toml, [section] EI", "positive"],
    ),
    "unknown sensor": (
        {"campaign.toml": TOML + '[sensors]\nforse = "4 N"\n'},
        ["[sensors] forse", 'did you mean "force"'],
    ),
    "sensor of zero": ({"campaign.toml": TOML + '[sensors]\nforce = "0 N"\n'}, ["[sensors] force", "positive"]),
    "section is no table": ({"campaign.toml": 'section = "EA"\n'}, ["campaign.toml, section", "[section]"]),
    "empty section": ({"campaign.toml": "[section]\n"}, ["campaign.toml, [section]", "empty"]),
    "title is a number": ({"campaign.toml": "title = 3\n" + TOML.split("\n", 1)[1]}, ["campaign.toml, title"]),
    "towing without table": (
        listed("t,towing,a.csv,S,,calibrate\n"),
        ["[towing]", "friction_coefficient", "t needs it"],
    ),
    "towing without tail tension": (
        listed("t,towing,a.csv,S,,calibrate\n")
        | {
            "campaign.toml": TOML
            + '[towing]\nfriction_coefficient = 0.3\ncable_length = "40 m"\ninclination = "6 deg"\n'
        },
        ["experiments.csv, row 2", "tail tension"],
    ),
}


@pytest.mark.parametrize("defect", DEFECTS)
def test_defect_is_a_sentence_with_its_place(folder, defect):
    changes, words = DEFECTS[defect]
    path = folder(changes)
    with pytest.raises(InputError) as caught:
        Campaign.read(path)
    sentence = str(caught.value)
    for word in words:
        assert word in sentence
    assert sentence.rstrip().endswith((".", "?"))
    assert "\n" not in sentence
    assert str(path) not in sentence or "no such file" in sentence


def test_folder_that_is_not_there(tmp_path):
    with pytest.raises(InputError, match="no such folder"):
        Campaign.read(tmp_path / "nowhere")


def test_file_instead_of_the_folder(folder):
    with pytest.raises(InputError, match="not a folder"):
        Campaign.read(folder() / "campaign.toml")


def test_link_out_of_the_folder_is_refused(folder, tmp_path_factory):
    outside = tmp_path_factory.mktemp("elsewhere") / "secret.csv"
    outside.write_text(LOOP)
    path = folder({"a.csv": None})
    (path / "a.csv").symlink_to(outside)
    with pytest.raises(InputError, match="outside the campaign folder"):
        Campaign.read(path)


def test_sound_campaign_has_no_defect(folder):
    assert len(Campaign.read(folder()).experiments) == 3
