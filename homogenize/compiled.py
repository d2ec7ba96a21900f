"""The one door to numba in this package: ``@kernel`` compiles a function of numbers and arrays, and keeps the machine code on disk.

Without numba, or with ``NUMBA_DISABLE_JIT=1``, the same lines run uncompiled and give the same numbers, some hundred times
slower. Kernels do not hold Python's lock, so that :func:`share` runs two of them at once.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import lru_cache
from typing import Any, TypeVar, cast

Function = TypeVar("Function", bound=Callable[..., object])

try:
    import numba as _numba
except ImportError:  # the uncompiled path
    _numba = None

THREADS = min(2, os.cpu_count() or 1)
"""Kernels that run at once."""


def kernel(function: Function) -> Function:
    """`function`, compiled for the machine at its first call, or unchanged where numba is absent."""
    if _numba is None:
        return function
    compiled: Any = _numba.njit(cache=True, nogil=True, error_model="numpy", fastmath={"contract", "reassoc", "nsz"})
    return cast(Function, compiled(function))


@lru_cache(maxsize=1)
def _pool() -> ThreadPoolExecutor:
    return ThreadPoolExecutor(THREADS - 1)


def share(function: Callable[..., object], ranges: Sequence[tuple[int, int]], *arguments: object) -> None:
    """Call ``function(first, last, *arguments)`` for every range, the last one here and the others in threads beside it."""
    if THREADS == 1 or len(ranges) == 1:
        for first, last in ranges:
            function(first, last, *arguments)
        return
    others = [_pool().submit(function, first, last, *arguments) for first, last in ranges[:-1]]
    function(*ranges[-1], *arguments)
    for other in others:
        other.result()
