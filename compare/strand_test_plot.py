"""Picture of a strand's tensile test: force over travel with the fit, and what is left when slip and frame are taken out.

matplotlib is imported when a picture is asked for.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from compare.plot_style import BLUE, GREEN, GREY, INK, PAGE_WIDTH, STYLE, VERMILLION
from compare.strand_modulus import StrandModulus
from compare.strand_tensile_test import TensileRecord


def draw_strand_test(record: TensileRecord, found: StrandModulus, area: float, path: Path, title: str) -> Path:
    """Write the picture.

    Parameters
    ----------
    record, found : TensileRecord, StrandModulus
    area : float
        Of the strand [m^2].
    path : Path
        Of the picture file.
    title : str
    """
    import matplotlib as mpl
    from matplotlib.figure import Figure

    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(PAGE_WIDTH, 3.7))
        left, right = figure.subplots(1, 2)
        figure.suptitle(title, x=0.01, ha="left", fontsize=11, fontweight="bold", color=INK)
        left.plot(1e3 * record.travel, 1e-3 * found.fitted, color=VERMILLION, lw=1.6, label="fit")
        left.plot(1e3 * record.travel, 1e-3 * record.force, "o", ms=3, color=BLUE, label="record")
        left.set(xlabel="travel of the crosshead [mm]", ylabel="force [kN]", title="Record and fit")
        left.legend(frameon=False, loc="upper left", bbox_to_anchor=(0.0, -0.2), fontsize=8)
        top = int(np.argmax(record.force)) + 1
        stress = record.force / area
        strain = np.linspace(0.0, stress.max() / found.E, 2)
        right.plot(
            1e2 * record.travel / record.length, 1e-6 * stress, "o-", ms=3, lw=0.7, color=GREY, label="as recorded"
        )
        right.plot(
            1e2 * strain, 1e-6 * found.E * strain, color=GREEN, lw=2, label=f"strand alone, {1e-9 * found.E:.1f} GPa"
        )
        line = np.polyfit(record.travel[:top] / record.length, stress[:top], 1)
        ends = np.array([max(-line[1] / line[0], 0.0), record.travel.max() / record.length])
        label = f"straight line, {1e-9 * found.slope_modulus:.1f} GPa"
        right.plot(1e2 * ends, 1e-6 * np.polyval(line, ends), "--", color=INK, lw=1, label=label)
        right.set(xlabel="travel over length, strain [%]", ylabel="stress [MPa]", title="What slip and frame take")
        right.legend(frameon=False, loc="upper left", bbox_to_anchor=(0.0, -0.2), fontsize=8)
        path.parent.mkdir(parents=True, exist_ok=True)
        figure.savefig(path)
    return path
