"""Runs an explainer over many hidden campaigns in worker processes, one line of JSON per campaign.

The explainer sees the campaign folder and nothing else. Labels are made first, hashed, and written beside the log; the
log can be taken up again after an interruption. An exception or a campaign that takes too long is logged as ``crash``.
"""

from __future__ import annotations

import hashlib
import json
import os
import signal
import tempfile
import time
import traceback
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from multiprocessing import get_context
from pathlib import Path
from typing import Any

from benchmarks.blind.methods import BASELINE_NAMES

THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")
LIMIT = 300
"""Seconds that one campaign may take."""


@dataclass(frozen=True)
class Job:
    """One campaign to explain: which seed, by which method, and where the folder may stay."""

    seed: int
    method: str
    keep: str | None = None


def _label(seed: int) -> dict[str, Any]:
    from benchmarks.blind.generator import label

    return label(seed)


def _expired(_signal: int, _frame: object) -> None:
    raise TimeoutError(f"more than {LIMIT} s")


def _answer(job: Job) -> list[dict[str, Any]]:
    """Make the folder, let the method explain it, and say what it said: one row, or one per baseline."""
    from benchmarks.blind.generator import make
    from benchmarks.blind.methods import METHODS

    signal.signal(signal.SIGALRM, _expired)
    with tempfile.TemporaryDirectory(prefix="blind-") as scratch:
        folder = Path(job.keep) / f"{job.seed}" if job.keep else Path(scratch) / "campaign"
        start = time.perf_counter()
        try:
            make(job.seed, folder)
            start = time.perf_counter()
            signal.alarm(LIMIT)
            said = METHODS[job.method](folder)
        except Exception as error:
            last = traceback.extract_tb(error.__traceback__)[-1]
            where = f"{Path(last.filename).name}:{last.lineno}"
            said = {
                "verdict": "crash",
                "effects": [],
                "confusable": [],
                "why": f"{type(error).__name__} at {where}: {error}",
            }
        finally:
            signal.alarm(0)
        seconds = round(time.perf_counter() - start, 3)
        several: dict[str, Any] = said.get("several", {job.method: said})
        return [{"seed": job.seed, "method": name, **one, "seconds": seconds} for name, one in several.items()]


def _pool_map(function: Any, items: Sequence[Any], workers: int) -> Iterator[Any]:
    """Results as they come; in this process when there is one worker."""
    if workers <= 1:
        yield from map(function, items)
        return
    for name in THREADS:
        os.environ[name] = "1"
    with get_context("spawn").Pool(workers, maxtasksperchild=100) as pool:
        yield from pool.imap_unordered(function, items)


def labels_of(seeds: Sequence[int], workers: int, cache: Path | None = None) -> tuple[dict[int, dict[str, Any]], str]:
    """Labels by seed, and the SHA-256 of all of them; `cache` is a folder that keeps them for the same generator."""
    kept = cache / f"blind-labels-{_generator_digest()}.jsonl" if cache else None
    found = {row["seed"]: row for row in _lines(kept)} if kept else {}
    new = list(_pool_map(_label, [seed for seed in seeds if seed not in found], workers))
    if kept and new:
        kept.parent.mkdir(parents=True, exist_ok=True)
        with kept.open("a", encoding="utf-8") as file:
            file.write("".join(json.dumps(row) + "\n" for row in new))
    found |= {row["seed"]: row for row in new}
    chosen = {seed: found[seed] for seed in seeds}
    text = "\n".join(json.dumps(chosen[seed], sort_keys=True) for seed in sorted(chosen))
    return chosen, hashlib.sha256(text.encode()).hexdigest()


def _generator_digest() -> str:
    """Short hash of the generator's own files, so that labels of an older one are not taken for its."""
    others = ("runner", "judge", "scorecard", "methods", "baselines", "dictionary", "__main__", "__init__")
    files = sorted(p for p in Path(__file__).parent.glob("*.py") if p.stem not in others)
    return hashlib.sha256(b"".join(p.read_bytes() for p in files)).hexdigest()[:12]


def _lines(path: Path) -> list[dict[str, Any]]:
    """Objects of a file of JSON lines; a line that was cut off by a crash is left out."""
    rows = []
    for line in path.read_text(encoding="utf-8").splitlines() if path.exists() else []:
        try:
            rows.append(json.loads(line))
        except json.JSONDecodeError:
            continue
    return rows


def read_log(path: Path) -> dict[tuple[str, int], dict[str, Any]]:
    """Answers by method and seed."""
    return {(row["method"], row["seed"]): row for row in _lines(path)}


def run(jobs: Sequence[Job], labels: dict[int, dict[str, Any]], log: Path, workers: int) -> Iterator[dict[str, Any]]:
    """Answer every job that the log does not have yet, append it with its label, and hand it out."""
    done = {(method if method not in BASELINE_NAMES else "baselines", seed) for method, seed in read_log(log)}
    log.parent.mkdir(parents=True, exist_ok=True)
    left = [job for job in jobs if (job.method, job.seed) not in done]
    with log.open("a", encoding="utf-8") as file:
        for answers in _pool_map(_answer, left, workers):
            rows = [{**answer, "label": labels[answer["seed"]]} for answer in answers]
            file.write("".join(json.dumps(row) + "\n" for row in rows))
            file.flush()
            yield rows[0]
