"""Each heavy library is imported behind one door, and `import geometry` needs none of them."""

import builtins
import subprocess
import sys
from pathlib import Path

import pytest

import geometry
from geometry import MeshError
from geometry.gmsh_session import load_gmsh, missing_library_sentence

DOORS = {"gmsh": "gmsh_session.py", "meshio": "mesh_file.py", "pyvista": "rendered_scene.py", "pint": "units.py"}


@pytest.mark.parametrize("library", DOORS)
def test_one_door(library):
    folder = Path(geometry.__file__).parent
    users = [
        p.name
        for p in folder.glob("*.py")
        if any(line.strip().startswith((f"import {library}", f"from {library}")) for line in p.read_text().splitlines())
    ]
    assert users == [DOORS[library]]


def test_import_stays_light():
    code = "import sys, geometry; print([m for m in ('gmsh', 'meshio', 'pyvista', 'matplotlib', 'vtkmodules') if m in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


@pytest.mark.parametrize(
    ("error", "words"),
    [
        (
            OSError("libGLU.so.1: cannot open shared object file: No such file or directory"),
            ["libGLU.so.1", "libglu1-mesa"],
        ),
        (OSError("libXft.so.2: cannot open shared object file"), ["libXft.so.2", "libxft2"]),
        (OSError("libodd.so.7: cannot open shared object file"), ["libodd.so.7", "system package"]),
        (ImportError("No module named 'gmsh'"), ["pip install"]),
    ],
)
def test_missing_system_library_is_one_sentence(error, words, monkeypatch):
    true_import = builtins.__import__

    def broken(name, *args, **kwargs):
        if name == "gmsh":
            raise error
        return true_import(name, *args, **kwargs)

    monkeypatch.setattr(builtins, "__import__", broken)
    with pytest.raises(MeshError) as caught:
        load_gmsh()
    sentence = str(caught.value)
    assert sentence == missing_library_sentence(error)
    assert all(word in sentence for word in words) and "\n" not in sentence
