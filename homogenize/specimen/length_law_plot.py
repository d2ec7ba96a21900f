"""Picture of the length law: apparent modulus over length, the fitted law, and the long cable's value as its asymptote."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from homogenize.specimen.length_law import LengthLaw
from homogenize.specimen.shear_lag_plot import INK, SOFT, saved


def draw_length_law(law: LengthLaw, E_cell: float, path: str | Path, dpi: int = 150) -> Path:
    """Draw specimens, law and asymptote; `E_cell` [Pa] is the long cable's modulus, ends free to twist.

    Raises
    ------
    InputError
        If the file cannot be written.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.2, 4.1), layout="constrained")
    axes = figure.add_subplot()
    L = np.geomspace(law.lengths.min() / 2, max(20 * law.half_length, 2 * law.lengths.max()), 200)
    axes.loglog(L, law.modulus(L) / 1e6, color="#0072b2", lw=1.8)
    axes.loglog(law.lengths, law.moduli / 1e6, "o", color="#d55e00", ms=6)
    axes.axhline(E_cell / 1e6, color=SOFT, lw=1.2, ls="--")
    at = float(np.sqrt(L[0] * L[-1]))
    axes.annotate(
        "long cable by its cell, ends free to twist",
        (L[0], E_cell / 1e6),
        xytext=(4, 4),
        textcoords="offset points",
        color=SOFT,
    )
    axes.annotate(
        f"L/E = c + L/E_inf\nc = {1e9 * law.c:.3g} mm/MPa\nE_inf = {law.E_infinite / 1e9:.3g} GPa",
        (at, float(law.modulus(at)) / 1e6), xytext=(14, -34), textcoords="offset points", color="#0072b2",
    )  # fmt: skip
    axes.annotate(
        "specimens",
        (law.lengths[-1], law.moduli[-1] / 1e6),
        xytext=(8, -12),
        textcoords="offset points",
        color="#d55e00",
    )
    axes.set_ylim(top=3 * E_cell / 1e6)
    axes.set_xlabel("length of the specimen [m]", color=INK)
    axes.set_ylabel("apparent E [MPa]", color=INK)
    axes.set_title("A short specimen measures its end, a long one the cable", color=INK, fontsize=10, loc="left")
    axes.spines[["top", "right"]].set_visible(False)
    axes.grid(color="#e6e8eb", lw=0.6, which="major")
    return saved(figure, path, dpi)
