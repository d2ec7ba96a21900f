"""The one door to numba: ``@kernel`` compiles a function of numbers and arrays, and keeps the machine code on disk.

Every kernel is plain Python as well: without numba, or with ``NUMBA_DISABLE_JIT=1``, the same lines run uncompiled and
give the same numbers, some hundred times slower. Kernels run on one core and release the interpreter's lock; parallel work
is done over whole runs.

numba renews the code on disk when the kernel's own file changes, but a kernel also contains the code of kernels in other
files. Here it is renewed whenever any file that holds a kernel has changed in this package or in the kernel's own.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from functools import lru_cache
from pathlib import Path
from typing import Any, TypeVar, cast

Function = TypeVar("Function", bound=Callable[..., object])

try:
    import numba as _numba
except ImportError:  # the uncompiled path
    _numba = None


_HERE = Path(__file__).parent


@lru_cache(maxsize=8)
def source_stamp(folder: Path = _HERE) -> str:
    """Digest of the files of this package, and of `folder`, that hold kernels."""
    digest = hashlib.sha256()
    for path in sorted({*_HERE.glob("*.py"), *folder.glob("*.py")}):
        text = path.read_bytes()
        if b"@kernel" in text or b"@inlined" in text or b"@embedded" in text:
            digest.update(text)
    return digest.hexdigest()


def kernel(function: Function) -> Function:
    """`function`, compiled for the machine at its first call, or unchanged where numba is absent.

    Sums may be contracted into fused multiply-adds but are not reordered, and NaN stays NaN, so that it can be found.
    """
    return _compiled(function)


def inlined(function: Function) -> Function:
    """A :func:`kernel` whose lines are copied into the kernels that call it, so that they are compiled there only.

    For the long ones with one caller: compiling them once more by themselves costs seconds and is never used.
    """
    return _compiled(function, inline="always")


def embedded(function: Function) -> Function:
    """A short :func:`kernel` that is never called from Python: it has no entry of its own and dissolves in its callers.

    Loops that the processor is to do several turns of at a time must hold no calls.
    """
    return _compiled(function, cache=False, forceinline=True, no_cpython_wrapper=True, no_cfunc_wrapper=True)


def _compiled(function: Function, **options: Any) -> Function:
    if _numba is None:
        return function
    options = {"cache": True, "error_model": "numpy", "fastmath": {"contract"}, "nogil": True} | options
    compiled: Any = _numba.njit(**options)(function)
    stored: Any = getattr(getattr(compiled, "_cache", None), "_cache_file", None)
    if hasattr(stored, "_source_stamp"):
        stored._source_stamp = source_stamp(Path(function.__code__.co_filename).parent)  # type: ignore[attr-defined]
    return cast(Function, compiled)
