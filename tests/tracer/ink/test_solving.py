"""What is heard while the junctions of a net are solved."""

from __future__ import annotations

import numpy as np
import shapely

from morfax.jobs.listener import never_back
from morfax.tracer.program.trace_ink import SOLVED, trace_ink
from morfax.tracer.program.trace_lines import trace_lines
from tests.tracer.inked import UM, arc, inked, polyline

GRID = [
    line
    for at in np.arange(10.0, 41.0, 10.0)
    for line in (polyline((5, at), (45, at)), polyline((at, 5), (at, 45)))
]
JUNCTIONS = 16


def test_progress_moves_while_junctions_are_solved() -> None:
    """It stood at 0 for half of the time of a heavy sheet."""
    heard = list[float]()
    trace_ink(inked(*GRID, seed=4), progress=lambda come, of: heard.append(come / of))
    solved = [share for share in heard if share < SOLVED]
    assert len(solved) > JUNCTIONS
    assert heard == sorted(heard)
    assert heard[0] < 0.01 and heard[-1] > 0.99


def test_progress_of_contours_moves_while_junctions_are_solved() -> None:
    """The bar shows what was solved until the head has come as far, and never goes back."""
    frame, heard, shown = polyline((5, 5), (45, 5), (45, 45), (5, 45), (5, 5)), [0.0], [0.0]
    tell = never_back(shown.append)

    def progress(come_mm: float, of_mm: float) -> None:
        heard.append(come_mm / of_mm)
        tell(come_mm, of_mm)

    trace_lines(inked(frame, *GRID, seed=4), progress=progress)
    before = heard[: int(np.argmax(np.diff(heard) < 0)) + 1]  # the head runs then, from 0
    assert len(before) > JUNCTIONS
    assert shown == sorted(shown)


def test_circles_in_one_ink_keep_their_partners_where_a_third_crosses_them() -> None:
    """Their rims tell how they cross there: cubics from where they part were 168 um off, in one stroke."""
    circles = [arc((24, 27), 13.7), arc((26.5, 28.3), 16.1), arc((28, 36.5), 21.6)]
    found = trace_ink(inked(*circles, width_mm=0.4, seed=1)).lines
    strokes = [shapely.LineString(line.xy_mm[::5]) for line in found]
    assert len(strokes) == len(circles)
    for true in circles:
        off_mm = [
            shapely.hausdorff_distance(shapely.LineString(true), each) for each in strokes
        ]
        assert min(off_mm) < 60 * UM
