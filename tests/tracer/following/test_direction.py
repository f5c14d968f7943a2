"""Directions: the head comes to a line from where it was put down, and turns to the side asked for."""

from __future__ import annotations

import math

import numpy as np
import pytest

from morfax.motion.faults import LineFault
from morfax.tracer.following.agreement import _way_at
from morfax.tracer.following.attempts import LONGEST, LONGEST_MM, longest_mm
from morfax.tracer.following.direction import turned_to
from morfax.tracer.head.stance import Stance
from morfax.tracer.sensing.photocell import Cells
from morfax.tracer.sensing.side import Side
from morfax.tracer.sensing.view import View
from tests.tracer.inked import WIDTH_MM, inked, polyline

DRAWING = inked(polyline((4, 4), (24, 4)))
VIEW = View(Cells(DRAWING.darkness, DRAWING.pitch_mm, 0.5), WIDTH_MM)
TO_THE_RIGHT = Stance(np.array([9.0, 4.0]), 0.0, VIEW)


@pytest.mark.parametrize(
    ("from_mm", "side", "is_turned"),
    [
        ((9.0, 2.0), "left", True),  # upward, and to the left of the sheet
        ((9.0, 2.0), "right", False),
        ((9.0, 6.0), "left", False),  # downward, and to the right of the sheet
        ((9.0, 6.0), "right", True),
    ],
)
def test_the_head_turns_to_the_side_as_it_is_seen_from_the_way_to_the_line(
    from_mm: tuple[float, float], side: Side, is_turned: bool
) -> None:
    turned = turned_to(TO_THE_RIGHT, from_mm, side)
    assert math.cos(turned.heading_rad) == pytest.approx(-1.0 if is_turned else 1.0)


@pytest.mark.parametrize("from_mm", [None, (9.0, 4.2)])
def test_a_head_that_is_put_down_on_the_line_comes_to_it_from_no_side(
    from_mm: tuple[float, float] | None,
) -> None:
    with pytest.raises(LineFault, match="put down on the line"):
        turned_to(TO_THE_RIGHT, from_mm, "left")


def test_a_run_may_be_some_times_as_long_as_all_the_ink_of_its_width() -> None:
    """The line has 20 mm, and the round of its pen at both ends."""
    assert longest_mm(DRAWING, WIDTH_MM) == pytest.approx(LONGEST * 20.3 + LONGEST_MM, rel=0.02)
    assert longest_mm(DRAWING, 2 * WIDTH_MM) == pytest.approx(
        LONGEST * 20.3 / 2 + LONGEST_MM, rel=0.02
    )


def test_the_way_at_a_place_is_from_the_one_before_to_the_one_behind() -> None:
    """At an end of a line there is but one of them."""
    places = np.array([[0.0, 0.0], [1.0, 0.0], [3.0, 1.0], [3.0, 4.0]])
    ways = [_way_at(places, k).tolist() for k in range(len(places))]
    assert ways == [[1.0, 0.0], [3.0, 1.0], [2.0, 4.0], [0.0, 3.0]]
