"""Two tips of a closed line that face each other are told, with legs; no other sharp corners are."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.motion.polyline import evenly
from morfax.tracer.program.laid.turned_back import Touch, tip_to_tip
from tests.tracer.inked import WIDTH_MM, Points, polyline

STEP = 0.25  # widths

# in from the left along a flat tip at (18, 10), round below, and in from the right along one at (22, 10)
BOW_TIE = polyline(
    (8, 9),
    (18, 10),
    (8, 11),
    (8, 20),
    (32, 20),
    (32, 11),
    (22, 10),
    (32, 9),
    (32, 1),
    (8, 1),
    (8, 9),
)
SPEARS = polyline((8, 9), (18, 10), (8, 11), (2, 10), (8, 9))
ASIDE = polyline(
    (8, 9),
    (18, 10),
    (8, 11),
    (8, 20),
    (32, 20),
    (32, 15),
    (22, 14),
    (32, 13),
    (32, 1),
    (8, 1),
    (8, 9),
)
# the bow tie pulled out until its tips are 34 mm apart: of a line of 0.5 mm 68 widths
FAR = BOW_TIE + np.where(BOW_TIE > (20.0, 100.0), (30.0, 0.0), 0.0)


def found(truth: Points) -> list[Touch]:
    """What is told of a closed line."""
    way = evenly(truth, STEP * WIDTH_MM)
    return list(tip_to_tip(3, way, STEP, WIDTH_MM))


def test_tips_that_face_each_other_are_told_with_legs_beyond_their_common_ink() -> None:
    """A tip's sides are 1.3 widths apart 3.25 mm from it; the legs are 1 mm more. Both run the same way."""
    (touch,) = found(BOW_TIE)
    assert touch.lines == (3, 3) and touch.is_parallel and touch.turns_back
    round_mm = 10.05
    second_mm = 2 * round_mm + 9 + 24 + 9 + round_mm
    for first_mm, last_mm, tip_mm in zip(
        touch.first_mm, touch.last_mm, (round_mm, second_mm), strict=True
    ):
        assert 0.5 * (first_mm + last_mm) == pytest.approx(tip_mm, abs=0.3)
        assert last_mm - first_mm == pytest.approx(2 * (3.25 + 1.0), abs=0.5)


@pytest.mark.parametrize("truth", [SPEARS, ASIDE, FAR])
def test_a_lone_tip_one_that_points_past_another_and_one_far_away_are_not(
    truth: Points,
) -> None:
    assert found(truth) == []
