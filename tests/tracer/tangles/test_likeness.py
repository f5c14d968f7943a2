"""The ink about a place, and how well a pen on a way explains it."""

from __future__ import annotations

import math

import numpy as np
import pytest

from morfax.tracer.sensing.photocell import Cells
from morfax.tracer.sensing.view import View
from morfax.tracer.tangles.likeness import Patch, Pen

PITCH_MM, LEVEL = 0.1, 0.4
PEN = Pen(0.25, 0.06)


def sheet() -> View:
    """Random darkness on 5 x 4 mm."""
    darkness = np.random.default_rng(4).uniform(0, 1, (40, 50)).astype(np.float32)
    return View(Cells(darkness, PITCH_MM, LEVEL), 0.5)


@pytest.mark.parametrize("place", [(2.5, 2.0), (0.1, 0.1), (4.9, 3.9), (0.1, 3.95)])
def test_a_patch_is_every_pixel_within_reach(place: tuple[float, float]) -> None:
    """Those at the sheet's own edges too; ink is 1, and nothing is darker than twice that."""
    view = sheet()
    patch = Patch.about(view, np.array(place), 0.93, PEN)
    x, y = np.meshgrid(np.arange(50) + 0.5, 40 - np.arange(40) - 0.5)
    near = np.hypot(x * PITCH_MM - place[0], y * PITCH_MM - place[1]) < 0.93
    told = np.column_stack([x[near], y[near]]) * PITCH_MM
    assert patch.places_mm == pytest.approx(told, abs=1e-9)
    darkness = view.cells.darkness[near] / (2 * LEVEL)
    assert patch.darkness == pytest.approx(np.minimum(darkness, patch.darkness.max()), abs=1e-6)
    assert patch.darkness.max() <= 1.25


def test_the_misfit_is_the_mean_square_that_a_pen_leaves() -> None:
    """Of a pen on its own ink nothing; of a pen that is nowhere the ink's own mean square."""
    view = sheet()
    patch = Patch.about(view, np.array([2.5, 2.0]), 1.5, PEN)
    away = np.abs(patch.places_mm[:, 1] - 2.0)
    soft = np.array([0.5 * math.erfc((a - 0.25) / (0.06 * math.sqrt(2))) for a in away])
    drawn = Patch(patch.places_mm, soft, *PEN)
    line = np.array([[0.0, 2.0], [5.0, 2.0]])
    # an edge of the pen is no error function, but as soft
    assert drawn.misfit(line) < 1e-3
    assert drawn.misfit(line + 100.0) == pytest.approx(np.mean(soft**2))
    assert drawn.misfit(line + np.array([0.0, 0.25])) > 0.05
