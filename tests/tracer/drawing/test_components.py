"""Patches of ink: the runs of some rows, and the run that is nearest to a place."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.tracer.drawing.blocks import runs_in
from morfax.tracer.drawing.components import Patches
from morfax.tracer.drawing.nearest_ink import nearest_run
from tests.tracer.sensing.kernels import COMPILED_AND_PLAIN, kernel


def test_the_runs_of_some_rows_however_far_off_the_sheet_these_are() -> None:
    sheet = np.zeros((6, 9), np.float32)
    sheet[1, 2:4] = sheet[1, 6:8] = sheet[3, 1:5] = sheet[4, 1:2] = 1.0
    patches = Patches.of([runs_in(sheet, 0.5)])
    assert patches.row.tolist() == [1, 1, 3, 4]
    asked = [(0, 1), (1, 2), (2, 5), (-7, 4), (4, 10**12), (10**11, 10**12)]
    found = [patches.runs_between(*rows) for rows in asked]
    expected = [(0, 0), (0, 2), (2, 4), (0, 3), (3, 4), (4, 4)]
    assert [(runs.start, runs.stop) for runs in found] == expected


PITCH_MM = 0.1
SHEET = (40, 60)  # rows, columns


def blots(seed: int) -> Patches:
    """Blots all over a small sheet."""
    ink = np.random.default_rng(seed).random(SHEET, np.float32)
    ink[10:20, 5:40] = 0.0
    return Patches.of([runs_in(np.where(ink > 0.9, ink, 0.0).astype(np.float32), 0.5)])


@COMPILED_AND_PLAIN
@pytest.mark.parametrize("seed", range(3))
def test_the_nearest_run_of_some_patches_is_that_of_the_nearest_pixel(
    seed: int, plain: bool
) -> None:
    patches, rng = blots(seed), np.random.default_rng(seed)
    find, runs = kernel(nearest_run, plain), (patches.begin, patches.end)
    number = np.repeat(np.arange(len(patches.row)), patches.end - patches.begin)
    columns = np.concatenate([np.arange(a, b) for a, b in zip(*runs, strict=True)])
    x_mm, y_mm = (columns + 0.5) * PITCH_MM, (SHEET[0] - patches.row[number] - 0.5) * PITCH_MM
    for among in (np.ones(patches.count, bool), rng.random(patches.count) > 0.7):
        for place in rng.uniform(-1.0, 7.0, (20, 2)):
            away_mm = np.hypot(x_mm - place[0], y_mm - place[1])
            away_mm[~among[patches.patch[number]]] = np.inf
            own = (*runs, patches.patch), patches.firsts, (float(place[0]), float(place[1]))
            found_mm, x, y, run = find(*own, (SHEET[0], PITCH_MM), among)
            nearest = int(np.argmin(away_mm))
            assert found_mm == pytest.approx(away_mm[nearest], abs=1e-12)  # rounding
            assert among[patches.patch[run]]
            assert np.hypot(x - place[0], y - place[1]) == pytest.approx(found_mm, abs=1e-12)
    none = find(*own, (SHEET[0], PITCH_MM), np.zeros(patches.count, bool))
    assert none[0] == np.inf and none[3] == 0
