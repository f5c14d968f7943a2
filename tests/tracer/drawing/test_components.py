"""Patches of ink: the runs of some rows."""

from __future__ import annotations

import numpy as np

from morfax.tracer.drawing.blocks import runs_in
from morfax.tracer.drawing.components import Patches


def test_the_runs_of_some_rows_however_far_off_the_sheet_these_are() -> None:
    sheet = np.zeros((6, 9), np.float32)
    sheet[1, 2:4] = sheet[1, 6:8] = sheet[3, 1:5] = sheet[4, 1:2] = 1.0
    patches = Patches.of([runs_in(sheet, 0.5)])
    assert patches.row.tolist() == [1, 1, 3, 4]
    asked = [(0, 1), (1, 2), (2, 5), (-7, 4), (4, 10**12), (10**11, 10**12)]
    found = [patches.runs_between(*rows) for rows in asked]
    expected = [(0, 0), (0, 2), (2, 4), (0, 3), (3, 4), (4, 4)]
    assert [(runs.start, runs.stop) for runs in found] == expected
