"""The four-conductor section of the benchmarks, under the name that the tests of this folder use."""

import pathlib

from geometry import CrossSectionMesh
from homogenize import benchmark_cables


def four_conductor_section(_folder: pathlib.Path, pitch: float = 0.388, size: float = 2e-3) -> CrossSectionMesh:
    """Meshed with straight cores (circles in the plane), then turned along the axis, as the reference was."""
    return benchmark_cables.four_conductor_section(pitch, size)
