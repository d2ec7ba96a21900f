"""The wheel works outside the repository: cables, scenarios, templates of the reports and the JSON schema come along."""

import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = """
import geometry, beam, helicable.report, importlib.resources
print(geometry.__file__)
print(sorted(geometry.cable_files()), beam.builtin_scenarios())
for name in ("report.html", "explain.html", "parts.html", "page.css", "explain.css"):
    assert importlib.resources.files("helicable.templates").joinpath(name).is_file(), name
from compare.findings_record import explain_schema
print(len(explain_schema()["required"]))
"""


def test_the_wheel_carries_its_data(tmp_path):
    build = [sys.executable, "-m", "build", "--wheel", "--outdir", str(tmp_path), str(ROOT)]
    done = subprocess.run(build, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-2000:]
    (wheel,) = tmp_path.glob("*.whl")
    place = tmp_path / "installed"
    install = [sys.executable, "-m", "pip", "install", "--quiet", "--no-deps", "--target", str(place), str(wheel)]
    assert subprocess.run(install, capture_output=True).returncode == 0
    run = subprocess.run(
        [sys.executable, "-c", PROGRAM],
        cwd=tmp_path,
        env={"PYTHONPATH": str(place), "PATH": ""},
        capture_output=True,
        text=True,
    )
    assert run.returncode == 0, run.stderr
    file, data, keys = run.stdout.splitlines()
    assert file.startswith(str(place))
    assert "mcpt-1.9-3.3-3x35" in data
    assert "intelligent-horizontal" in data
    assert int(keys) == 10
