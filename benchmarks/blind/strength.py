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


def of_share(bench: Bench, truth: Truth, share: float, close: float = _CLOSE) -> Truth:
    """The truth with the size at which its share is `share` (within `close`), or its largest size if that is less."""
    size = truth.size
    for _ in range(_ROUNDS):
        truth = truth.of_size(size)
        found = share_not_linear(bench, [truth])
        if abs(found / share - 1) < close:
            return truth
        if found <= 0 or not np.isfinite(found):
            size *= 0.5
            continue
        new = min(size * np.clip(share / found, 0.1, 10), truth.largest)
        if new == size:
            return truth
        size = float(new)
    return truth


def main_change(
    bench: Bench,
    noise: Noise,
    truths: Sequence[Truth],
    without: Sequence[Truth] = (),
    like: Sequence[Truth] | None = None,
) -> Array:
    """What the truths change in the main channel of the fitted records beyond a linear stiffness, in units of the noise.

    The noise is that of the signal with the truths, or with those of `like`; each condition stands for one record.
    """
    full, part = respond(bench, truths)["main"], respond(bench, without)["main"]
    signal = full if like is None else respond(bench, like)["main"]
    x, rms = base_signal(bench), channel_rms(bench, signal)
    pairs = []
    for c in np.flatnonzero(bench.fitted_rows):
        n = bench.count[c]
        columns = np.column_stack([x[c, :n], full[c, :n] - part[c, :n]])
        pairs.append(noise.whiten(columns, signal[c, :n], rms))
    a, e = np.vstack(pairs).T
    return e - a * (a @ e) / (a @ a)


def distance(
    bench: Bench, noise: Noise, cross_noise: Noise | None, truths: Sequence[Truth], without: Sequence[Truth] = ()
) -> float:
    """Distance of the truth from the best linear model (plus the truths `without`), fitted records and their repeats."""
    left = main_change(bench, noise, truths, without)
    total = float(left @ left)
    if cross_noise is not None:
        full, part = respond(bench, truths)["cross"], respond(bench, without)["cross"]
        for c in np.flatnonzero(bench.fitted_rows):
            n = bench.count[c]
            away = (full - part)[c, :n, None]
            total += float(np.sum(cross_noise.whiten(away, full[c, :n], cross_unit(bench)) ** 2))
    return float(np.sqrt(2 * total))
