"""Ends of strokes that go on into each other are joined; others are not."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.motion.polyline import length_mm
from morfax.tracer.drawing.strokes import Sheet
from morfax.tracer.ink.ledger import Ledger
from morfax.tracer.ink.meeting import InkStroke, joined
from tests.tracer.inked import WIDTH_MM, Points, arc, inked, polyline

LINE = polyline((5, 10), (35, 10))
SPEED_MM_S = 10.0


def stroke(*places: tuple[float, float]) -> InkStroke:
    """A stroke along places, as the head runs it: a place every 50 um."""
    line = polyline(*places)
    along = np.linspace(0, 1, 400)[:, None]
    return InkStroke(line[:1] + along * (line[-1:] - line[:1]), False, WIDTH_MM)


def join(line: Points, *strokes: InkStroke) -> list[InkStroke]:
    return joined(list(strokes), Ledger(Sheet.of(inked(line))), SPEED_MM_S)


@pytest.mark.parametrize("turned", [(), (0,), (1,), (0, 2)])
def test_pieces_of_one_line_become_one_stroke(turned: tuple[int, ...]) -> None:
    pieces = [
        stroke((5, 10), (14, 10)),
        stroke((14.3, 10), (22, 10)),
        stroke((22, 10), (35, 10)),
    ]
    for k in turned:
        pieces[k] = pieces[k]._replace(way_mm=pieces[k].way_mm[::-1])
    (one,) = join(LINE, *pieces)
    assert length_mm(one.way_mm) == pytest.approx(30, abs=1e-6)
    assert not one.closed and sorted(one.way_mm[[0, -1], 0]) == [5, 35]


def test_over_white_paper_nothing_is_joined() -> None:
    gap = inked(polyline((5, 10), (14, 10)), polyline((16, 10), (35, 10)))
    ends = [stroke((5, 10), (14.2, 10)), stroke((15.8, 10), (35, 10))]
    assert len(joined(ends, Ledger(Sheet.of(gap)), SPEED_MM_S)) == 2


def test_a_corner_is_not_gone_round() -> None:
    corner = polyline((5, 10), (20, 10), (20, 30))
    assert len(join(corner, stroke((5, 10), (20, 10)), stroke((20, 10), (20, 30)))) == 2


def test_halves_of_a_circle_close() -> None:
    circle = arc((20, 20), 10)
    half = len(circle) // 2
    halves = [InkStroke(way, False, WIDTH_MM) for way in (circle[: half + 1], circle[half:])]
    (one,) = join(circle, *halves)
    assert one.closed and np.allclose(one.way_mm[0], one.way_mm[-1])
