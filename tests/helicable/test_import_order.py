"""The import order is the path of the data; the heavy libraries stay behind their doors."""

import ast
import functools
import pathlib
import subprocess
import sys

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PACKAGES = ("geometry", "homogenize", "beam", "effects", "compare", "helicable")


def test_import_linter_contracts_hold():
    """geometry <- homogenize <- beam <- compare <- helicable, checked by import-linter."""
    tool = pathlib.Path(sys.executable).parent / "lint-imports"
    done = subprocess.run([str(tool), "--no-cache"], cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.parametrize("library", ["gmsh", "meshio", "pyvista", "pint", "pyamg", "jinja2", "distributed", "tomllib"])
def test_one_file_imports_each_heavy_library(library):
    """One door each (reading TOML: one door per kind of file)."""
    doors = [
        path.relative_to(ROOT).as_posix()
        for package in PACKAGES
        for path in (ROOT / package).rglob("*.py")
        if library in imported(path)
    ]
    assert len(doors) == 1 if library != "tomllib" else len(doors) <= 4, doors


@functools.cache
def imported(path):
    names = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names |= {alias.name.split(".")[0] for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.level == 0 and node.module:
            names.add(node.module.split(".")[0])
    return names


@pytest.mark.parametrize("package", PACKAGES)
def test_importing_a_package_does_not_load_gmsh_or_a_plot_library(package):
    """beam and compare work on a machine where gmsh cannot be loaded."""
    code = f"import sys; sys.modules['gmsh'] = None; import {package}; print('pyvista' in sys.modules, 'matplotlib' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, cwd=ROOT)
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == ["False", "False"]
