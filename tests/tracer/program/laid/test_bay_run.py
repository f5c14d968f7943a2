"""A bay where a closed line begins: the line is begun elsewhere, and the bay moves along it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import shapely

from morfax.motion.motion import MOTION_RATE_HZ
from morfax.motion.polyline import evenly, nearest_mm
from morfax.motion.usual import THINNED
from morfax.tracer.effort import EVERY_MM
from morfax.tracer.following.line import Line
from morfax.tracer.head.leaders import CELL, REDRAWN, Led
from morfax.tracer.program.laid import bay_run
from morfax.tracer.program.laid.bay_run import Bay, apart, laid
from morfax.tracer.program.laid.laid_way import LaidWay
from morfax.tracer.program.setup import Setup
from morfax.tracer.sensing import photocell
from morfax.tracer.tangles.folding_rule import Rule
from tests.tracer.inked import UM, WIDTH_MM, inked, polyline
from tests.tracer.program.laid.ways import STEP_MM, run_along, steps_mm

RULE = Rule(np.zeros(2), np.ones(2), np.ones((1, 2)), np.zeros(1, bool), 0.0, 0.25)


@pytest.mark.parametrize("by_mm", [-95.0, -3.0, 0.0, 40.0, 250.0])
def test_a_bay_that_is_moved_along_a_closed_way_stays_as_long(by_mm: float) -> None:
    """It begins on the way, once round at the most, and ends as far on as before."""
    moved = Bay(90.0, 108.0, RULE, 1.0).moved(by_mm, 100.0)
    assert 0.0 <= moved.first_mm < 100.0
    assert (moved.first_mm - 90.0 - by_mm) / 100.0 == pytest.approx(
        round((moved.first_mm - 90.0 - by_mm) / 100.0), abs=1e-9
    )
    assert moved.last_mm - moved.first_mm == pytest.approx(18.0)


def bay(first_mm: float, last_mm: float, gain: float = 1.0) -> Bay:
    """A bay between two places along a way."""
    return Bay(first_mm, last_mm, RULE, gain)


def test_of_bays_that_lie_on_one_another_the_one_that_gains_most_is_kept() -> None:
    """Also over the beginning of the closed way of 100 mm: 95 to 105 lies on 3 to 8."""
    some = [bay(10, 20, 1.0), bay(18, 30, 3.0), bay(29, 40, 2.0), bay(60, 70), bay(70.5, 80)]
    assert apart(some, 100.0) == [some[1], some[3], some[4]]
    assert apart([bay(95, 105, 2.0), bay(3, 8)], 100.0) == [bay(95, 105, 2.0)]
    assert apart([bay(95, 105), bay(3, 8, 2.0)], 100.0) == [bay(3, 8, 2.0)]
    assert len(apart([bay(95, 102), bay(3, 8)], 100.0)) == 2


WAY = polyline((5, 5), (25, 5), (25, 25), (5, 25), (5, 5))  # 80 mm round
NOTCH = polyline((12, 5), (12, 8), (13.5, 8), (13.5, 5))


def with_notch(begin_mm: float, first_mm: float, last_mm: float) -> tuple[Line, Line]:
    """A closed line that begins so far round the square, and the same with the notch laid in it."""
    twice = np.vstack([WAY, WAY[1:]])
    own = evenly(twice, STEP_MM)[round(begin_mm / STEP_MM) :][: round(80 / STEP_MM)]
    line = run_along(own)
    legs = np.vstack([[first_mm + 5, 5], NOTCH, [last_mm + 5, 5]])
    pieces = tuple(legs[k : k + 2] for k in range(len(legs) - 1))
    rule = LaidWay(pieces, 0.5 * WIDTH_MM)
    some = [
        Bay(
            (first_mm - begin_mm) % 80,
            (first_mm - begin_mm) % 80 + last_mm - first_mm,
            rule,
            1.0,
        )
    ]
    return line, laid(Setup(inked(WAY).sheet), line, some, 80.0)


def test_the_cells_that_a_bay_is_run_with_see_no_more_than_what_is_about_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The head runs it from memory: a whole sheet was made for each bay of a page."""
    monkeypatch.setattr(photocell, "near_ink", None)  # nobody asks for the whole sheet
    line, mended = with_notch(0.0, 6.0, 9.5)
    assert mended.length_mm > line.length_mm + 5.0


@pytest.mark.parametrize("begin_mm", [0.0, 40.0, 5.53, 7.5, 9.98, 79.9])
def test_a_bay_is_run_where_it_lies_wherever_the_line_begins(begin_mm: float) -> None:
    """Before it, within it, just behind it: the line goes round once, along the notch, without a jump; a
    millisecond at 10 mm/s is 10 um. Its corners are run round by 30 um at the most.
    """
    line, mended = with_notch(begin_mm, 5.5, 10.0)
    truth = shapely.Polygon(WAY).difference(shapely.Polygon(NOTCH)).exterior
    way = shapely.LinearRing(mended.places_mm)
    assert way.hausdorff_distance(truth) < 30 * UM
    assert mended.length_mm == pytest.approx(line.length_mm + 6.0, abs=0.1)
    assert steps_mm(mended).max() < 1.05 * STEP_MM
    assert np.hypot(*(mended.xy_mm[0] - mended.xy_mm[-1])) < 1.05 * STEP_MM + EVERY_MM
    laid_mm = mended.led.lengths_mm(mended.xy_mm)[REDRAWN]
    assert laid_mm == pytest.approx(4.5 + 6.0, abs=0.1)
    # who led is told for each position: those of the cell are the line's own, the others are not
    own = set(map(tuple, line.xy_mm.tolist()))
    are_own = np.array([tuple(place) in own for place in mended.xy_mm.tolist()])
    by_cell = mended.led.of(len(mended.xy_mm)) == CELL
    assert are_own[by_cell].all() and are_own[~by_cell].mean() < 0.01
    away_mm = nearest_mm(mended.xy_mm[mended.led.of(len(mended.xy_mm)) == CELL], NOTCH)
    assert away_mm.min() > 1.4


def test_the_head_does_not_stop_where_it_comes_to_a_bay_and_leaves_it() -> None:
    """Within 0.1 mm of there it is never slower than 7 mm/s of its 10."""
    _, mended = with_notch(40.0, 5.5, 10.0)
    speed_mm_s = steps_mm(mended) * MOTION_RATE_HZ
    leaders = mended.led.of(len(mended.xy_mm))
    for at in np.flatnonzero(leaders == REDRAWN)[[0, -1]]:
        assert speed_mm_s[at - 60 : at + 60].min() > 7.0


def test_the_head_leaves_a_bay_as_slowly_as_the_line_goes_on() -> None:
    """The line was run at 5 mm/s: so slow is the head at the end of the bay, within a quarter of that."""
    line, _ = with_notch(40.0, 5.5, 10.0)
    own = evenly(line.xy_mm, 0.5 * STEP_MM)
    own = own[: len(own) // THINNED * THINNED]
    half = replace(line, xy_mm=own, led=Led.along(np.full(len(own), CELL, np.int8)))
    rule = LaidWay((polyline((10.5, 5), (15, 5)),), 0.5 * WIDTH_MM)
    mended = laid(Setup(inked(WAY).sheet), half, [Bay(45.5, 50.0, rule, 1.0)], 80.0)
    last = np.flatnonzero(mended.led.of(len(mended.xy_mm)) == REDRAWN)[-1]
    assert steps_mm(mended)[last - 2 : last + 30] == pytest.approx(0.5 * STEP_MM, rel=0.25)


def test_a_closed_line_that_is_begun_elsewhere_is_led_by_the_same() -> None:
    leaders = np.repeat(np.array([CELL, REDRAWN, CELL], np.int8), 16000)
    line = run_along(WAY, led=Led.along(leaders))
    moved = bay_run._begun_at(line, 30.0)
    assert moved.xy_mm[0] == pytest.approx([25, 15], abs=EVERY_MM)
    led_mm = moved.led.lengths_mm(moved.xy_mm)
    assert led_mm == pytest.approx(line.led.lengths_mm(line.xy_mm), abs=0.01)
    at = int(np.argmin(np.hypot(*(moved.xy_mm - [25, 20]).T)))
    assert moved.led.of(len(moved.xy_mm))[at] == REDRAWN
