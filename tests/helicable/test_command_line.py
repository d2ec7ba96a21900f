"""The verbs: exit codes 0 / 1 / 2, sentences on stderr, JSON keys as in the contract, help with an example."""

import json

import numpy as np
import pytest

from helicable.main import main

CABLE = "mcpt-1.9-3.3-3x35"
VERBS = (
    "cables", "show", "mesh", "homogenize", "loop", "stress", "tow", "sweep", "check", "compare", "explain", "add", "next", "effects",
    "demo", "verify",
)  # fmt: skip


@pytest.fixture(scope="module")
def homogenized(tmp_path_factory):
    """One coarse run of `helicable homogenize`, shared."""
    file = tmp_path_factory.mktemp("homogenize") / "section.json"
    assert main(["homogenize", CABLE, "--size", "4 mm", "--json", str(file)]) == 0
    return file


@pytest.mark.parametrize("verb", VERBS)
def test_every_verb_has_help_with_an_example(verb, capsys):
    assert main([verb, "--help"]) == 0
    assert f"Example: helicable {verb}" in " ".join(capsys.readouterr().out.split())


def test_no_verb_shows_the_help(capsys):
    main([])
    assert "homogenize" in capsys.readouterr().out


def test_cables_lists_the_reference_cable(tmp_path, capsys):
    assert main(["cables", "--json", str(tmp_path / "c.json")]) == 0
    cables = json.loads((tmp_path / "c.json").read_text())
    entry = next(c for c in cables["cables"] if c["name"] == CABLE)
    assert cables["schema"] == 1
    assert entry["outer_diameter"] == pytest.approx(0.0516)
    assert entry["mass_per_length"] == pytest.approx(4.05, abs=0.01)
    assert CABLE in capsys.readouterr().out


def test_show_names_what_is_assumed(tmp_path, capsys):
    assert main(["show", CABLE, "--json", str(tmp_path / "s.json")]) == 0
    out = capsys.readouterr().out
    assert "Assumed, with the range to sweep" in out
    assert "6343" in out
    record = json.loads((tmp_path / "s.json").read_text())
    assert {"published", "deduced", "assumed"} <= {n["status"] for n in record["numbers"]}


def test_homogenize_writes_the_contracts_keys(homogenized):
    record = json.loads(homogenized.read_text())
    assert record["schema"] == 1
    assert record["section"]["order"] == ["gamma_x", "gamma_y", "epsilon", "kappa_x", "kappa_y", "tau"]
    assert len(record["section"]["C"]) == 6
    assert all(isinstance(v, float) for row in record["section"]["C"] for v in row)
    keys = {"EA_blocked_twist", "EA_free_twist", "GJ", "coupling", "EI_x", "EI_y", "GA_x", "GA_y"}
    assert keys <= set(record["section"])
    assert {"E_blocked_twist", "E_free_twist", "G_yoz", "G_xoz", "bounds", "mesh", "seconds", "notes"} <= set(record)
    assert record["bounds"]["EA_lower"] <= record["section"]["EA_free_twist"] <= record["section"]["EA_blocked_twist"]
    assert record["section"]["EA_blocked_twist"] <= record["bounds"]["EA_upper"]
    assert all(check["holds"] for check in record["checks"])


def test_the_long_cable_is_far_stiffer_than_the_published_specimen(homogenized):
    """142 MPa lies below the bound of the straight earth conductor; the cell value is one to two orders above it."""
    record = json.loads(homogenized.read_text())
    assert record["bounds"]["EA_lower"] / record["area"] > 5 * 142e6
    assert 10 * 142e6 < record["E_free_twist"] < record["E_blocked_twist"] < 100 * 142e6


def test_sliding_conductors_are_a_choice(homogenized, tmp_path):
    """Sliding lowers EA, GJ and EI, and the file says which interface it is."""
    file = tmp_path / "sliding.json"
    assert main(["homogenize", CABLE, "--size", "4 mm", "--interface", "frictionless", "--json", str(file)]) == 0
    bonded, sliding = json.loads(homogenized.read_text()), json.loads(file.read_text())
    assert (bonded["interface"], sliding["interface"]) == ("bonded", "frictionless")
    for key in ("EA_blocked_twist", "EA_free_twist", "GJ", "EI_x", "EI_y"):
        assert sliding["section"][key] < bonded["section"][key], key
    assert all(check["holds"] for check in sliding["checks"])


def test_the_slice_gives_the_6x6_and_null_where_it_does_not_compute(tmp_path, capsys):
    file = tmp_path / "cell.json"
    assert main(["homogenize", CABLE, "--method", "cell", "--size", "8 mm", "--json", str(file)]) == 0
    record = json.loads(file.read_text())
    assert np.linalg.eigvalsh(record["section"]["C"]).min() > 0
    assert record["section"]["EI_x"] == pytest.approx(70.4, rel=0.05)  # the 2D cell
    assert record["section"]["C"][2][5] == pytest.approx(record["section"]["coupling"], rel=1e-9)
    assert record["section"]["C"][2][5] == record["section"]["C"][5][2]
    assert record["G_yoz"] is None
    record["section"]["C"][0][0] = None
    file.write_text(json.dumps(record))
    assert main(["tow", "intelligent-horizontal", "--constants", str(file)]) == 2
    assert "complete 6x6" in capsys.readouterr().err


def test_mesh_writes_the_file_and_the_contracts_keys(tmp_path):
    file, record = tmp_path / "cell.vtu", tmp_path / "mesh.json"
    assert main(["mesh", CABLE, "--elements", "4000", "--out", str(file), "--json", str(record)]) == 0
    found = json.loads(record.read_text())
    keys = {
        "schema",
        "cable",
        "elements",
        "hexes",
        "prisms",
        "tets",
        "nodes",
        "min_scaled_jacobian",
        "height",
        "matched_faces",
    }
    assert keys | {"regions", "seconds", "peak_memory"} <= set(found)
    assert found["elements"] >= 4000
    assert found["matched_faces"] is True
    assert found["min_scaled_jacobian"] > 0
    for region in found["regions"].values():
        assert region["volume"] == pytest.approx(region["closed_form"], rel=5e-3)
    assert file.stat().st_size > 10_000


def test_mesh_parts_interfaces_and_draws(tmp_path, capsys):
    """Doubled nodes along a chosen interface are told on the screen and in the record, and the pictures are written."""
    record = tmp_path / "mesh.json"
    arguments = ["mesh", "example-three-core", "--elements", "100", "--out", str(tmp_path / "cell.msh")]
    arguments += ["--separate", "conductor-insulation", "--pictures", str(tmp_path), "--json", str(record)]
    assert main(arguments) == 0
    found = json.loads(record.read_text())
    assert list(found["separated"]) == ["conductor-insulation"]
    assert found["separated"]["conductor-insulation"] == pytest.approx(found["interfaces"]["conductor-insulation"])
    assert (tmp_path / "cell.png").stat().st_size > 10_000 and (tmp_path / "quality.png").stat().st_size > 10_000
    assert "Quality" in capsys.readouterr().out


def test_mesh_writes_solids_for_cad(tmp_path):
    """A name that ends in .brep asks for swept solids; their volumes are those of Pappus."""
    file, record = tmp_path / "cable.brep", tmp_path / "solids.json"
    assert main(["mesh", "example-three-core", "--out", str(file), "--json", str(record)]) == 0
    solids = json.loads(record.read_text())["solids"]
    assert file.stat().st_size > 10_000
    assert all(s["volume"] == pytest.approx(s["closed_form"], rel=1e-4) for s in solids.values())
    assert "sheath" in solids


BAD = [
    (["homogenize", "no-such-cable"], "no-such-cable"),
    (["homogenize", CABLE, "--size", "1.5"], "--size"),
    (["homogenize", CABLE, "--size", "-1 mm"], "size"),
    (["homogenize", CABLE, "--size", "1 kg"], "--size"),
    (["homogenize", CABLE, "--method", "magic"], "magic"),
    (["homogenize", CABLE, "--interface", "glued"], "frictionless"),
    (["homogenize", CABLE, "--method", "cell", "--interface", "frictionless"], "helical"),
    (["homogenize", CABLE, "--method", "cell", "--level", "wire"], "section or strand"),
    (["homogenize", CABLE, "--level", "strand"], "--method cell"),
    (["mesh", CABLE, "--elements", "0"], "element"),
    (["mesh", CABLE, "--elements", "1000000000"], "700 GB of memory; at most 2e+07 are made: try fewer"),
    (["tow"], "--list"),
    (["tow", "no-such-scenario"], "no-such-scenario"),
    (["tow", "intelligent-horizontal", "--constants", "nothing.json"], "nothing.json"),
    (["tow", "intelligent-horizontal", "--resume"], "--out"),
    (["sweep", "intelligent-horizontal"], "What can be swept: constants, E,"),
    (["sweep", "intelligent-horizontal", "--over", "frction=0.2"], "did you mean friction"),
    (["compare", "no-such-folder"], "no-such-folder"),
    (["no-such-verb"], "no-such-verb"),
    (["homogenize"], "CABLE"),
]


@pytest.mark.parametrize(("arguments", "word"), BAD, ids=[" ".join(a) for a, _ in BAD])
def test_bad_input_is_one_sentence_and_exit_code_2(arguments, word, capsys):
    assert main(arguments) == 2
    err = capsys.readouterr().err
    assert word in err
    assert "Traceback" not in err


def test_an_output_place_that_cannot_be_written_is_a_sentence(tmp_path, capsys):
    blocker = tmp_path / "file"
    blocker.write_text("")
    assert main(["cables", "--json", str(blocker / "c.json")]) == 2
    assert "cannot be written" in capsys.readouterr().err


def test_compare_reports_each_experiment(tmp_path, capsys):
    """A linear cable with noise: the true stiffness comes back, the residual is noise."""
    campaign = write_campaign(tmp_path / "campaign")
    out = tmp_path / "out"
    assert main(["compare", str(campaign), "--json", str(tmp_path / "c.json"), "--out", str(out)]) == 0
    record = json.loads((tmp_path / "c.json").read_text())
    assert {e["id"] for e in record["experiments"]} == {"b1", "b2"}
    assert {"id", "kind", "channel", "set", "rmse", "bias", "noise_floor", "excess"} <= set(record["experiments"][0])
    EI = record["calibrated"]["EI"]
    assert EI["value"] == pytest.approx(60.0, abs=max(5 * EI["std"], 0.3))
    assert list(out.glob("*.png"))
    assert "EI" in capsys.readouterr().out


def write_campaign(folder):

    folder.mkdir()
    (folder / "campaign.toml").write_text('title = "test"\n[section]\nEI = "90 N m^2"\n[sensors]\nmoment = "0.2 N m"\n')
    rng = np.random.default_rng(5)
    rows = ["id,kind,file,specimen,repeat_of,set,temperature [degC]"]
    for name, repeat in (("b1", ""), ("b2", "b1")):
        rows.append(f"{name},bending,{name}.csv,A,{repeat},calibrate,20")
        curvature = np.sin(np.linspace(0, 2 * np.pi, 200))
        moment = 60.0 * curvature + 0.2 * rng.standard_normal(200)
        lines = ["curvature [1/m],moment [N m]", *(f"{k:.6f},{m:.5f}" for k, m in zip(curvature, moment))]
        (folder / f"{name}.csv").write_text("\n".join(lines) + "\n")
    (folder / "experiments.csv").write_text("\n".join(rows) + "\n")
    return folder


def test_a_result_that_fails_a_check_is_exit_code_1(monkeypatch, capsys):
    """It ran, but the result is not to be used."""
    import homogenize.homogenization as module
    from homogenize import Check

    monkeypatch.setattr(module, "check_cell", lambda mesh, cell: (Check("equilibrium", "made to fail", False),))
    assert main(["homogenize", "example-three-core", "--size", "1.5 mm"]) == 1
    assert "equilibrium" in capsys.readouterr().err


def test_demo_leaves_the_report_and_everything_it_shows(tmp_path, monkeypatch, capsys):
    """The chain on a short coarse run: one self-contained page, pictures, tables, the run."""
    import helicable.commands.tow as module

    read = module.read_scenario
    short = {"cable__elements": 100, "time__duration": "2 s", "drive__ramp_end": "1.5 s"}
    monkeypatch.setattr(module, "read_scenario", lambda name: read(name).changed(**short))
    out, file = tmp_path / "demo", tmp_path / "demo.json"
    assert main(["demo", "--out", str(out), "--json", str(file)]) == 0
    files = set(json.loads(file.read_text())["files"])
    assert {
        "cross-section.png",
        "constants.csv",
        "mesh.png",
        "towing-cable.png",
        "towing-pull-force.png",
        "run.nc",
        "explain.json",
    } <= files
    page = (out / "report.html").read_text(encoding="utf-8")
    assert "http" not in page.replace("http-equiv", "").replace("https://doi.org", "")
    assert page.count("data:image/png;base64,") >= 9
    assert json.loads((out / "explain.json").read_text())["effects"] == ["interlayer-friction"]
    titles = [
        page.index(t)
        for t in (
            "The cable</h2>",
            "From the mesh to the section</h2>",
            "The towing run</h2>",
            "The missing effect</h2>",
        )
    ]
    assert titles == sorted(titles)
    assert "142 MPa" in page
