"""The section mesh of a specimen: as coarse as its displacements allow, since every node stands at every station.

The long cable's section is cheap and its necks are resolved; in a specimen the elements in a thin layer or neck may be flat.
Size and floor are shares of the outer diameter. Where the wanted floor folds a curved element it is lowered step by step.
"""

from __future__ import annotations

from geometry import Cable, CrossSectionMesh, cross_section_mesh
from geometry.errors import MeshError
from homogenize.section_field import section_field

SIZE = 0.09
FLOOR = 0.024
"""Of the outer diameter: 4.5 mm and 1.2 mm on a cable of 50 mm."""
_STEPS = 5


def specimen_mesh(cable: Cable, size: float | None = None, floor: float | None = None) -> CrossSectionMesh:
    """Quadratic triangles on the section of a cable, for :func:`solve_specimen`.

    Parameters
    ----------
    cable : Cable
    size : edge length in the bulk [m]; 0.09 of the outer diameter if not given
    floor : edge length [m] below which no thin layer or neck drives the size; 0.024 / 0.09 of `size` if not given

    Raises
    ------
    MeshError
        If a size is not usable.
    """
    size = SIZE * cable.outer_diameter if size is None else size
    floor = FLOOR / SIZE * size if floor is None else floor
    for step in range(_STEPS + 1):
        try:
            mesh = cross_section_mesh(cable, size=size, smallest=floor * 0.8**step)
            section_field(mesh)
            return mesh
        except MeshError:
            if step == _STEPS or not 0 < size < cable.outer_radius:
                raise
    raise AssertionError
