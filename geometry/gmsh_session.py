"""The one door to gmsh: a session that is closed again, and a sentence where gmsh cannot be loaded.

gmsh is a binary that opens a few system libraries when it is imported, although nothing is drawn.
"""

from __future__ import annotations

import contextlib
import re
from collections.abc import Iterator
from types import ModuleType
from typing import Any

from geometry.errors import MeshError

DEBIAN_PACKAGES = {
    "libGLU.so.1": "libglu1-mesa",
    "libGL.so.1": "libgl1",
    "libOpenGL.so.0": "libopengl0",
    "libX11.so.6": "libx11-6",
    "libXrender.so.1": "libxrender1",
    "libXcursor.so.1": "libxcursor1",
    "libXft.so.2": "libxft2",
    "libXinerama.so.1": "libxinerama1",
    "libXext.so.6": "libxext6",
    "libXfixes.so.3": "libxfixes3",
    "libXi.so.6": "libxi6",
    "libXxf86vm.so.1": "libxxf86vm1",
    "libSM.so.6": "libsm6",
    "libICE.so.6": "libice6",
    "libfontconfig.so.1": "libfontconfig1",
    "libfreetype.so.6": "libfreetype6",
    "libgomp.so.1": "libgomp1",
}


def missing_library_sentence(error: BaseException) -> str:
    """What to install when gmsh could not be loaded.

    >>> missing_library_sentence(OSError("libGLU.so.1: cannot open shared object file: No such file or directory"))
    'gmsh cannot be loaded because the system library libGLU.so.1 is missing; on Debian or Ubuntu: apt-get install libglu1-mesa.'
    """
    found = re.search(r"(lib[\w+.-]*?\.so[\w.]*)", str(error))
    if found is None:
        return f"gmsh cannot be loaded ({error}); install it again with: pip install --force-reinstall gmsh."
    library = found.group(1)
    package = DEBIAN_PACKAGES.get(library)
    remedy = (
        f"on Debian or Ubuntu: apt-get install {package}"
        if package
        else f"install the system package that holds {library}"
    )
    return f"gmsh cannot be loaded because the system library {library} is missing; {remedy}."


def load_gmsh() -> ModuleType:
    """The module gmsh.

    Raises
    ------
    MeshError
        If gmsh or a system library that it needs is missing.
    """
    try:
        import gmsh
    except (OSError, ImportError) as error:
        raise MeshError(missing_library_sentence(error)) from None
    return gmsh


def check_installation() -> None:
    """End the program with one sentence if gmsh cannot be loaded; called by make before long work."""
    try:
        load_gmsh()
    except MeshError as missing:
        raise SystemExit(f"helicable: {missing}") from None


@contextlib.contextmanager
def gmsh_session(name: str) -> Iterator[Any]:
    """A fresh gmsh model, silent and on one thread; what gmsh had open before is left as it was.

    Raises
    ------
    MeshError
        If gmsh cannot be loaded, or reports an error inside the block.
    """
    gmsh = load_gmsh()
    fresh = not gmsh.isInitialized()
    before = None if fresh else gmsh.model.getCurrent()
    if fresh:
        gmsh.initialize(interruptible=False)
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("General.NumThreads", 1)
    gmsh.model.add(name)
    try:
        yield gmsh
    except MeshError:
        raise
    except Exception as error:  # gmsh raises plain Exception for everything
        raise MeshError(f"gmsh could not mesh {name}: {error}") from error
    finally:
        gmsh.model.remove()
        if before is not None:
            gmsh.model.setCurrent(before)
        if fresh:
            gmsh.finalize()
