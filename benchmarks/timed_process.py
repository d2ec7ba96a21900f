"""A program run as a process of its own, on one thread: what it printed, wall and CPU seconds, largest memory."""

from __future__ import annotations

import os
import subprocess
import tempfile
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

ONE_THREAD = {name: "1" for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")}


@dataclass(frozen=True)
class Process:
    """How a program ended (`code` 0: well), its output, seconds by clock and by processor, peak memory [GB]."""

    code: int
    output: str
    wall: float
    cpu: float
    memory: float


def run_timed(command: Sequence[str], folder: str | Path | None = None) -> Process:
    """Run it to its end; standard output and errors are kept together."""
    with tempfile.TemporaryFile("w+", encoding="utf-8", errors="replace") as words:
        start = time.perf_counter()
        child = subprocess.Popen(
            list(command), cwd=folder, stdout=words, stderr=subprocess.STDOUT, env=os.environ | ONE_THREAD
        )
        _, status, used = os.wait4(child.pid, 0)
        wall = time.perf_counter() - start
        child.returncode = os.waitstatus_to_exitcode(status)
        words.seek(0)
        return Process(child.returncode, words.read(), wall, used.ru_utime + used.ru_stime, used.ru_maxrss / 1e6)
