"""Pictures: one overview, one panel for every experiment with its repeats, and no matplotlib before a picture is asked for."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
from made_campaign import NOMINAL, made_campaign, made_experiment

from compare import BenchModel, NominalSection, compare, plot_comparison

X = np.sin(np.linspace(0, 12, 120))


def comparison_of(groups: int):
    rng = np.random.default_rng(0)
    loops = []
    for g in range(groups):
        for r in (0, 1):
            moment = 50 * X + 3 * np.cos(np.linspace(0, 12, 120)) + rng.normal(size=X.size)
            of = f"g{g}r0" if r else None
            loops.append(
                made_experiment(f"g{g}r{r}", "bending", "curvature", {"curvature": X, "moment": moment}, repeat_of=of)
            )
    return compare(BenchModel(NominalSection(NOMINAL)), made_campaign(loops))


def test_pages_hold_every_experiment(tmp_path):
    written = plot_comparison(comparison_of(9), tmp_path / "new" / "folder")
    assert [p.name for p in written] == ["overview.png", "bending-moment-1.png", "bending-moment-2.png"]
    from matplotlib.image import imread

    for path in written:
        image = imread(path)
        assert image.shape[0] > 200 and np.ptp(image) > 0.5, "something is drawn"


def test_nothing_to_compare_draws_nothing(tmp_path):
    assert plot_comparison(compare(BenchModel(NominalSection(NOMINAL)), made_campaign([])), tmp_path) == []


def test_panel_shows_the_residual_with_its_noise_band():
    from compare.comparison_plot import loops_figure

    comparison = comparison_of(1)
    figure = loops_figure([list(comparison.fits)], "title", [], set())
    loop, residual = figure.axes
    assert len(loop.lines) == 3  # the measurement, its repeat, the model
    np.testing.assert_array_equal(loop.lines[0].get_ydata(), comparison.fits[0].measured)
    np.testing.assert_array_equal(loop.lines[2].get_ydata(), comparison.fits[0].model)
    np.testing.assert_array_equal(residual.lines[1].get_ydata(), comparison.fits[0].measured - comparison.fits[0].model)
    box = residual.patches[0].get_window_extent().transformed(residual.transData.inverted())
    np.testing.assert_allclose([box.y0, box.y1], np.array([-2, 2]) * comparison.fits[0].noise_floor, rtol=0.05)


def test_import_stays_light():
    code = "import sys, compare; print([m for m in ('gmsh', 'pyvista', 'matplotlib', 'pandas', 'skfem') if m in sys.modules])"
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert found.stdout.strip() == "[]"
