"""The confusion matrix as a picture: rows are what is true, columns what was said, cells count campaigns."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from benchmarks.blind_towing.score import Row, said
from benchmarks.blind_towing.truths import LIBRARY, OUTSIDE

_OTHERS = ("set with the truth", "set without it", "several", "unknown", "none", "crash")


def truth_of(row: Row) -> str:
    """Row of the matrix."""
    names = row["label"]["effects"]
    return "(none)" if not names else names[0] if len(names) == 1 else "two effects"


def confusion(rows: Sequence[Row]) -> tuple[list[str], list[str], np.ndarray]:
    """Truths, answers, and how often they met (truths, answers)."""
    truths = [t for t in ("(none)", *LIBRARY, "two effects", *OUTSIDE) if any(truth_of(r) == t for r in rows)]
    answers = [n for n in (*LIBRARY, *_OTHERS) if n in LIBRARY or any(said(r) == n for r in rows)]
    counts = np.zeros((len(truths), len(answers)), int)
    for row in rows:
        counts[truths.index(truth_of(row)), answers.index(said(row))] += 1
    return truths, answers, counts


def right_answers(truth: str) -> tuple[str, ...]:
    """Columns that are right for a truth (for the frame)."""
    if truth == "(none)":
        return ("none",)
    if truth in OUTSIDE:
        return ("unknown",)
    return ("several",) if truth == "two effects" else (truth,)


def draw_confusion(rows: Sequence[Row], file: Path, title: str) -> None:
    """Save the matrix as a PNG; frames mark the cells where an answer is exactly right."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    from matplotlib.patches import Rectangle

    truths, answers, counts = confusion(rows)
    figure, axes = plt.subplots(figsize=(9.0, 0.36 * len(truths) + 2.6), layout="constrained")
    share = counts / np.maximum(counts.sum(axis=1, keepdims=True), 1)
    axes.imshow(share, cmap="Blues", vmin=0, vmax=1.25, aspect="auto")
    for i, j in zip(*np.nonzero(counts), strict=True):
        axes.text(j, i, str(counts[i, j]), ha="center", va="center", color="white" if share[i, j] > 0.6 else "black")
    for i, truth in enumerate(truths):
        for j, name in enumerate(answers):
            if name in right_answers(truth):
                axes.add_patch(Rectangle((j - 0.5, i - 0.5), 1, 1, fill=False, edgecolor="tab:green", linewidth=1.6))
    axes.set_xticks(range(len(answers)), answers, rotation=45, ha="right", fontsize=8)
    axes.set_yticks(
        range(len(truths)), [f"{t} ({n})" for t, n in zip(truths, counts.sum(axis=1), strict=True)], fontsize=8
    )
    axes.set_xlabel("what was said")
    axes.set_ylabel("what is true (campaigns)")
    axes.set_title(title, fontsize=10)
    figure.savefig(file, dpi=110)
    plt.close(figure)
