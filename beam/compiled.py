"""The one door to numba: ``@kernel`` compiles a function of numbers and arrays, and keeps the machine code on disk.

Every kernel is plain Python as well: without numba, or with ``NUMBA_DISABLE_JIT=1``, the same lines run uncompiled and
give the same numbers, some hundred times slower. Kernels run on one core; parallel work is done over whole runs.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar, cast

Function = TypeVar("Function", bound=Callable[..., object])

try:
    import numba as _numba
except ImportError:  # the uncompiled path
    _numba = None


def kernel(function: Function) -> Function:
    """`function`, compiled for the machine at its first call, or unchanged where numba is absent.

    Sums may be contracted into fused multiply-adds but are not reordered, and NaN stays NaN, so that it can be found.
    """
    if _numba is None:
        return function
    compiled = _numba.njit(cache=True, error_model="numpy", fastmath={"contract"})(function)
    return cast(Function, compiled)
