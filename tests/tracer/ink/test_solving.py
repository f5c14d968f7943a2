"""What is heard while the junctions of a net are solved."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from morfax.jobs.listener import never_back
from morfax.motion.polyline import evenly, nearest_mm
from morfax.tracer.head.settings import Settings
from morfax.tracer.ink.left_out import ink_left
from morfax.tracer.ink.net import shows_two_lines
from morfax.tracer.ink.stretches import FeltSheet
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


def test_circles_in_one_ink_keep_their_partners_where_others_cross_them() -> None:
    """Two run together for 20 mm and cross twice there; they were taken for one, or changed partners."""
    placed = {(47, 42.5): 21.6, (33.8, 31.5): 13, (43, 33.1): 13.7, (45.5, 34.4): 16.1}
    circles = [arc(*one) for one in (placed | {(23.7, 45.3): 10, (24.9, 24.9): 20.9}).items()]
    found = trace_ink(inked(*circles, width_mm=0.4, seed=2)).lines
    assert len(found) == len(circles)
    for true in circles:
        off_mm = [nearest_mm(evenly(true, 0.1), line.places_mm).max() for line in found]
        assert min(off_mm) < 60 * UM


@pytest.mark.parametrize(
    ("larger", "smaller", "width_mm", "dpi"),
    [
        (((10.8, 12.5), 6.7), ((18.8, 7.1), 3.03), 0.54, 300),
        (((10.4, 10.3), 6.29), ((6.9, 9.1), 2.72), 0.61, 400),
        (((7.8, 7.8), 3.71), ((8.3, 8.1), 3.29), 0.63, 300),
    ],
)
def test_circles_that_cross_at_a_small_angle_go_on_in_the_ink_that_they_share(
    larger: tuple[tuple[float, float], float],
    smaller: tuple[tuple[float, float], float],
    width_mm: float,
    dpi: float,
) -> None:
    """That ink is hardly broader than a line, and bends away from both at its ends by more than a corner: it
    was one line, onto which one circle went on, and they came out 79 and 77 um off, or as one line.
    """
    circles = [arc(*larger), arc(*smaller)]
    found = trace_lines(inked(*circles, width_mm=width_mm, dpi=dpi, seed=7)).lines
    assert [line.ending for line in found] == ["closed", "closed"]
    for true in circles:
        off_mm = [nearest_mm(evenly(true, 0.1), line.places_mm).max() for line in found]
        assert min(off_mm) < 40 * UM


def test_even_ink_of_a_broader_pen_is_not_two_lines() -> None:
    left = ink_left(inked(polyline((5, 10), (45, 10)), width_mm=0.63, seed=4).sheet)
    felt = FeltSheet.of(left.drawing, Settings(), left.ink)
    pen_of_others = felt.doubled._replace(pen_mm=0.45)
    assert not shows_two_lines(replace(felt, doubled=pen_of_others), 0)
