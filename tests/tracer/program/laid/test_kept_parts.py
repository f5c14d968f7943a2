"""Where a way within a rim runs along a line that the head ran, it is that line to the position."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.motion.motion import MOTION_RATE_HZ
from morfax.motion.polyline import nearest_mm, with_places
from morfax.motion.usual import FEED_MM_S
from morfax.tracer.program.laid.kept_parts import KeptWay
from morfax.tracer.program.setup import Setup
from tests.tracer.inked import UM, WIDTH_MM, Points, arc, inked, polyline
from tests.tracer.program.laid.ways import run_along

SQUARE = polyline((5, 5), (25, 5), (25, 25), (5, 25), (5, 5))
# the same with a tooth in its upper side
TOOTHED = polyline(
    (5, 5), (25, 5), (25, 25), (17, 25), (17, 22), (13, 22), (13, 25), (5, 25), (5, 5)
)


def rounded(way: Points, radius_mm: float) -> Points:
    """A closed square of 20 mm about (15, 15) with round corners."""
    about = [(25, 25), (5, 25), (5, 5), (25, 5)]
    arcs = [
        arc(
            (x - np.sign(x - 15) * radius_mm, y - np.sign(y - 15) * radius_mm),
            radius_mm,
            a,
            a + 90,
        )
        for (x, y), a in zip(about, (0, 90, 180, 270), strict=True)
    ]
    return np.vstack([*arcs, arcs[0][:1]])


def off_mm(way: Points, truth: Points) -> float:
    """How far a closed way is from the truth, or that from it, at most, mm."""
    closed = with_places(np.vstack([way, way[:1]]), 0.02)
    true = with_places(truth, 0.02)
    return float(max(nearest_mm(closed, true).max(), nearest_mm(true, closed).max()))


@pytest.mark.parametrize("way", [SQUARE, SQUARE[::-1]])
def test_a_way_that_runs_along_all_of_a_line_is_that_line(way: Points) -> None:
    """Begun elsewhere, and in either direction."""
    line = run_along(SQUARE)
    kept = KeptWay.of(np.roll(way[:-1], 2, axis=0), [line], WIDTH_MM)
    assert kept.whole is line
    assert kept.line(Setup(inked(SQUARE).sheet)) is line
    assert not len(kept.laid_mm)


def test_corners_that_a_rim_rounds_are_the_lines_own() -> None:
    """At each the way is 0.12 mm beside the line, over less than three widths."""
    line = run_along(SQUARE)
    kept = KeptWay.of(rounded(SQUARE, 0.4)[:-1], [line], WIDTH_MM)
    assert kept.whole is line


def test_a_bend_that_is_no_corner_is_laid() -> None:
    """The same in a straight side, where the line leaves its ink by 0.1 mm over a millimetre."""
    bulged = polyline(
        (5, 5), (25, 5), (25, 25), (15.5, 25), (15, 25.1), (14.5, 25), (5, 25), (5, 5)
    )
    kept = KeptWay.of(SQUARE[:-1], [run_along(bulged)], WIDTH_MM)
    assert kept.whole is None
    assert (
        off_mm(kept.places_mm, SQUARE) < 25 * UM
    )  # 10 um is on it, and a place of 50 um on 0.2 up


@pytest.mark.parametrize("way", [TOOTHED, TOOTHED[::-1]])
def test_what_a_line_passed_by_is_laid_and_the_rest_is_the_lines_own(way: Points) -> None:
    """Of a tooth that the head passed by over its mouth: its two sides and its end are run from memory."""
    line = run_along(SQUARE)
    kept = KeptWay.of(way[:-1], [line], WIDTH_MM)
    (part,) = kept.kept
    assert part.length_mm == pytest.approx(80 - 4, abs=0.2)
    laid_mm = kept.laid_mm
    assert laid_mm[:, 0].min() > 13 - 1.1 and laid_mm[:, 0].max() < 17 + 1.1
    assert off_mm(kept.places_mm, TOOTHED) < 0.05
    anew = kept.line(Setup(inked(TOOTHED).sheet))
    assert anew is not None
    assert off_mm(anew.loop_mm, TOOTHED) < 0.06
    own = set(map(tuple, line.xy_mm.tolist()))
    count = sum(place in own for place in map(tuple, anew.xy_mm.tolist()))
    assert count * FEED_MM_S / MOTION_RATE_HZ == pytest.approx(80 - 4 - 2 * 0.75, abs=1.0)


def test_a_way_that_goes_round_a_line_and_on_is_no_part_of_it() -> None:
    """All of the square and half of its lower side again, and home below that."""
    way = polyline(*SQUARE.tolist(), (15, 5), (15, 2), (2, 2), (2, 5), (5, 5))
    kept = KeptWay.of(way[:-1], [run_along(SQUARE)], WIDTH_MM)
    assert not kept.kept
    assert off_mm(kept.places_mm, way) < 0.05
