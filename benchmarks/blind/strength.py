"""How large a truth is: the part of the signal that no linear stiffness can absorb, and the distance in noise units."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from benchmarks.blind.bench import Array, Bench
from benchmarks.blind.noise import Noise
from benchmarks.blind.truth import Truth, respond

_ROUNDS = 14
_CLOSE = 0.01


def base_signal(bench: Bench) -> Array:
    """Main channel of the linear model, (C, n)."""
    return bench.strain if bench.load_control else bench.stiffness * bench.strain


def channel_rms(bench: Bench, signal: Array) -> float:
    """Over the records that are open."""
    return float(np.sqrt(np.mean(signal[bench.open_rows][bench.mask[bench.open_rows]] ** 2)))


def cross_unit(bench: Bench) -> float:
    """Rms that the second channel would have at a coupling of 1 (over stiffness)."""
    return channel_rms(bench, bench.strain)


def share_not_linear(bench: Bench, truths: Sequence[Truth]) -> float:
    """Rms of what the best linear model leaves over the rms of the signal, open records."""
    y, rows = respond(bench, truths), bench.open_rows
    inside = bench.mask[rows]
    main, x = y["main"][rows][inside], base_signal(bench)[rows][inside]
    left = main - x * (x @ main) / (x @ x)
    cross = y["cross"][rows][inside] / cross_unit(bench)
    return float(np.sqrt(np.mean(left**2) / np.mean(main**2) + np.mean(cross**2)))


def of_share(bench: Bench, truth: Truth, share: float) -> Truth:
    """The truth with the size at which its share is `share`, or its largest size if that is less."""
    size = truth.size
    for _ in range(_ROUNDS):
        truth = truth.of_size(size)
        found = share_not_linear(bench, [truth])
        if abs(found / share - 1) < _CLOSE:
            return truth
        if found <= 0 or not np.isfinite(found):
            size *= 0.5
            continue
        new = min(size * np.clip(share / found, 0.1, 10), truth.largest)
        if new == size:
            return truth
        size = float(new)
    return truth


def distance(
    bench: Bench, noise: Noise, cross_noise: Noise | None, truths: Sequence[Truth], without: Sequence[Truth] = ()
) -> float:
    """Distance of the truth from the best linear model (plus the truths `without`), fitted records and their repeats."""
    full, part = respond(bench, truths), respond(bench, without)
    x = base_signal(bench)
    rms = channel_rms(bench, full["main"])
    A, d = [], []
    total = 0.0
    for c in np.flatnonzero(bench.fitted_rows):
        n = bench.count[c]
        clean = full["main"][c, :n]
        pair = noise.whiten(np.column_stack([x[c, :n], clean - part["main"][c, :n]]), clean, rms)
        A.append(pair[:, 0])
        d.append(pair[:, 1])
        if cross_noise is not None:
            away = (full["cross"] - part["cross"])[c, :n, None]
            total += float(np.sum(cross_noise.whiten(away, full["cross"][c, :n], cross_unit(bench)) ** 2))
    a, e = np.concatenate(A), np.concatenate(d)
    total += float(e @ e - (a @ e) ** 2 / (a @ a))
    return float(np.sqrt(2 * max(total, 0.0)))
