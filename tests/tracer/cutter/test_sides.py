"""Edges: which lines cross, what lies in what, and how wide the room beside a line is."""

from __future__ import annotations

import math

import numpy as np
import pytest

from morfax.motion.offset import DriveCurve, offset
from morfax.tracer.cutter import sides
from tests.tracer.inked import UM, arc, polyline

STAR = [
    (12 + r * math.cos(k * math.pi / 5), 12 + r * math.sin(k * math.pi / 5))
    for k, r in enumerate([10, 4] * 5)
]
GUIDES = {
    "hole": ([DriveCurve(arc((9, 9), 2), True, True)], 4.0),
    "square": ([DriveCurve(polyline((0, 0), (3, 0), (3, 3), (0, 3)), True, True)], 3.0),
    "slot": ([DriveCurve(polyline((0, 0), (30, 0), (30, 1.2), (0, 1.2)), True, True)], 1.2),
    "star": ([DriveCurve(np.array(STAR), True, True)], 8.0),  # touches its inner corners
    "island": (
        [DriveCurve(arc((20, 20), 15), True, True), DriveCurve(arc((20, 20), 12), True, False)],
        3.0,
    ),
    "island aside": (
        [DriveCurve(arc((20, 20), 15), True, True), DriveCurve(arc((25, 20), 8), True, False)],
        12.0,
    ),
}


@pytest.mark.parametrize("name", GUIDES)
def test_a_cutter_goes_into_a_room_that_is_wider_and_into_no_narrower_one(name: str) -> None:
    guides, wide_mm = GUIDES[name]
    for number in range(len(guides)):
        room = sides.room(guides, number)
        assert room is not None and room.wide_mm == pytest.approx(wide_mm, abs=2 * UM)
        assert 0 < room.wide_mm - room.passes_mm < 1.5 * sides.PASSES_MM + UM
    assert offset(guides, room.passes_mm / 2) and not offset(guides, wide_mm / 2 + 1 * UM)


def test_outside_of_the_outermost_line_there_is_room_for_any_cutter() -> None:
    assert sides.room([DriveCurve(arc((9, 9), 5), True, False)], 0) is None
    assert (
        sides.room(
            [DriveCurve(arc((9, 9), 5), True, False), DriveCurve(arc((30, 9), 5), True, False)],
            1,
        )
        is None
    )


def test_lines_that_cross_lie_in_none_of_each_other() -> None:
    lines = [
        sides.thinned(line) for line in (arc((30, 30), 25), arc((47, 30), 12), arc((20, 30), 5))
    ]
    crossed = sides.crossing(lines)
    assert crossed.tolist() == [
        [False, True, False],
        [True, False, False],
        [False, False, False],
    ]
    assert sides.depths(lines, crossed) == [0, 0, 1]


@pytest.mark.parametrize(("over_deg", "crosses"), [(4.0, False), (20.0, True)])
def test_an_end_that_runs_a_little_past_the_beginning_is_no_crossing(
    over_deg: float, crosses: bool
) -> None:
    """The head closes 0.35 mm beyond where it began, or 1.7 mm: the other way round is the whole line."""
    places = arc((9, 9), 5, 0, 360 + over_deg)
    share = np.linspace(0, 1, len(places))[:, None]
    outward = (places - 9) / 5
    # across its own beginning in the middle of the overrun
    places = places + 0.02 * outward * (share - 1 + 0.5 * over_deg / 360) * 360 / over_deg * (
        share > 0.9
    )
    assert bool(sides.crossing([places])[0, 0]) == crosses


def test_a_curl_where_the_head_swivelled_is_no_crossing() -> None:
    curl = np.vstack(
        [arc((9, 9), 5, 0, 180), arc((4, 9.0), 0.1, 0, 360), arc((9, 9), 5, 180, 360)]
    )
    assert not sides.crossing([curl[:-1]]).any()


@pytest.mark.parametrize(
    ("wide_mm", "passes_mm"),
    [(4.0, 3.95), (3.98, 3.95), (3.97, 3.9), (0.08, 0.05), (0.07, 0.0), (0.01, 0.0)],
)
def test_a_cutter_of_whole_twentieths_has_a_fortieth_to_spare(
    wide_mm: float, passes_mm: float
) -> None:
    assert sides.Clearance((0.0, 0.0), wide_mm).passes_mm == pytest.approx(passes_mm)
