"""Runs: a path with its leads and guide lines, and which of its positions stand for which of its places."""

from __future__ import annotations

import math

import numpy as np
import pytest

from morfax.motion.arrays import Array
from morfax.motion.polyline import at_places, length_mm
from morfax.tracer.cutter.contour import PathPlace
from morfax.tracer.cutter.runs import Detour, FeedRate, LeadRun, PathRun, position_at
from morfax.tracer.cutter.start_places import Begin
from morfax.tracer.junctions.guides import GuideLine
from tests.tracer.inked import UM

FEED = FeedRate(10.0, 6000.0)
RADIUS_MM = 5.0
# a chord of 1 degree is 0.2 um off the circle, and the feed's smoothing less than 1 um inside of it
ON_IT_MM = 2 * UM
SAMPLE_MM = FEED.mm_s / FEED.rate_hz

ANGLES = np.radians(np.arange(361.0))
CIRCLE = RADIUS_MM * np.column_stack([np.cos(ANGLES), np.sin(ANGLES)])


def at_degrees(degrees: float) -> Array:
    """A place of the circle."""
    return RADIUS_MM * np.array(
        [math.cos(math.radians(degrees)), math.sin(math.radians(degrees))]
    )


def place_of(run: PathRun, position: float) -> Array:
    """Where a run is at one of its positions, fractions included."""
    return at_places(run.xy_mm, np.array([position]))[0]


def leads_of(begin: float) -> Begin:
    """A straight lead of 3 mm from outside, and one of 2 mm outwards, at a place of the circle."""
    here = at_degrees(begin)
    out = here / RADIUS_MM
    return Begin(
        begin, np.array([here + 3 * out, here]), np.array([here, here + 2 * out]), 3.0, 2.0
    )


@pytest.mark.parametrize(
    "begin", [Begin(0.0), Begin(90.5), Begin(359.25), leads_of(0.0), leads_of(200.3)]
)
def test_a_closed_path_is_run_once_round_from_where_it_begins(begin: Begin) -> None:
    run = PathRun.along(CIRCLE, begin, FEED)
    on_path = run.xy_mm[run.first : run.last + 1]
    assert np.hypot(*on_path.T) == pytest.approx(RADIUS_MM, abs=ON_IT_MM)
    assert length_mm(on_path) == pytest.approx(length_mm(CIRCLE), abs=2 * SAMPLE_MM)
    for end in (on_path[0], on_path[-1]):
        assert end == pytest.approx(at_degrees(begin.at), abs=SAMPLE_MM)
    turned = np.diff(np.unwrap(np.arctan2(*on_path.T[::-1])))
    assert turned.sum() > 0 and turned.min() > -1e-9  # counter-clockwise, as the path


@pytest.mark.parametrize("begin", [Begin(0.0), Begin(90.5), leads_of(200.3)])
@pytest.mark.parametrize("degrees", [0.0, 45.25, 90.25, 91.0, 200.0, 201.0, 359.5])
def test_a_place_of_the_path_has_its_position_in_the_run(begin: Begin, degrees: float) -> None:
    run = PathRun.along(CIRCLE, begin, FEED)
    position = run.position(PathPlace(0, degrees))
    assert run.first <= position <= run.last
    assert place_of(run, position) == pytest.approx(at_degrees(degrees), abs=ON_IT_MM)


def test_leads_stand_before_and_after_the_path() -> None:
    begin = leads_of(30.0)
    run = PathRun.along(CIRCLE, begin, FEED)
    assert run.leads is not None
    assert (run.leads.first, run.leads.last) == (run.first, run.last)
    assert (run.leads.in_mm, run.leads.out_mm) == (3.0, 2.0)
    assert run.xy_mm[0] == pytest.approx(1.6 * at_degrees(30.0))
    assert run.xy_mm[-1] == pytest.approx(1.4 * at_degrees(30.0))
    assert length_mm(run.xy_mm[: run.first + 1]) == pytest.approx(3.0, abs=SAMPLE_MM)
    assert length_mm(run.xy_mm[run.last :]) == pytest.approx(2.0, abs=SAMPLE_MM)
    bare = PathRun.along(CIRCLE, Begin(30.0), FEED)
    assert bare.leads is None and (bare.first, bare.last) == (0, len(bare.xy_mm) - 1)


@pytest.mark.parametrize("lead", ["in", "out"])
def test_one_lead_alone_stands_on_its_side(lead: str) -> None:
    both = leads_of(30.0)
    into = (
        Begin(30.0, both.lead_in, None, 3.0)
        if lead == "in"
        else Begin(30.0, None, both.lead_out, 0.0, 2.0)
    )
    run = PathRun.along(CIRCLE, into, FEED)
    assert run.leads is not None
    assert (run.first > 0) == (lead == "in") and (run.last < len(run.xy_mm) - 1) == (
        lead == "out"
    )


def detour(run: PathRun, degrees: float, out_mm: float) -> Detour:
    """A guide line from a place of the path outwards and back, with a mark at its tip."""
    leave = round(run.position(PathPlace(0, degrees)))
    here = run.xy_mm[leave]
    share = 1 + out_mm / RADIUS_MM * np.r_[np.linspace(0, 1, 50), np.linspace(1, 0, 50)[1:]]
    return Detour(leave, share[:, None] * here, degrees, {degrees: 49.0})


def test_guide_lines_put_in_shift_what_comes_after_them_and_nothing_before() -> None:
    """Two guide lines, put in together in the wrong order; four marks about them stay where they are."""
    run = PathRun.along(CIRCLE, leads_of(0.0), FEED)
    marks = {
        float(mark): run.position(PathPlace(0, float(mark))) for mark in (40, 90, 150, 300)
    }
    run.at |= marks
    was = {mark: place_of(run, at) for mark, at in marks.items()}
    last_mm = run.xy_mm[run.last].copy()
    run.put_in([detour(run, 200.0, 2.0), detour(run, 100.0, 1.0)])
    for mark, place in was.items():
        assert place_of(run, run.at[mark]) == pytest.approx(place, abs=1e-9)
    assert run.at[40.0] == marks[40.0] and run.at[150.0] == marks[150.0] + 100
    assert run.at[300.0] == marks[300.0] + 200
    assert run.xy_mm[run.last] == pytest.approx(last_mm)
    # where they leave, their tips, and where they come back
    first, second = run.guides
    for guide, degrees, out_mm in ((first, 100.0, 1.0), (second, 200.0, 2.0)):
        here = run.xy_mm[guide.leave]
        assert here == pytest.approx(at_degrees(degrees), abs=SAMPLE_MM)
        assert run.xy_mm[guide.back] == pytest.approx(here)
        assert run.xy_mm[guide.tip] == pytest.approx((1 + out_mm / RADIUS_MM) * here)
        assert place_of(run, run.at[degrees]) == pytest.approx(run.xy_mm[guide.tip])
    steps_mm = np.hypot(*np.diff(run.xy_mm, axis=0).T)
    assert steps_mm.max() < 2.0 / 49 + SAMPLE_MM  # nowhere a jump


def test_a_lead_line_put_before_a_run_shifts_all_of_it() -> None:
    run = PathRun.along(CIRCLE, leads_of(0.0), FEED)
    run.at[1.0], run.guides = 100.0, [GuideLine(10, 20, 30)]
    first, last, began = run.first, run.last, run.xy_mm[0].copy()
    lead_mm = np.column_stack([np.linspace(20, began[0], 700), np.linspace(0, began[1], 700)])
    run.put_after(LeadRun(lead_mm, PathPlace(0, 0.0), {0.5: 3.0}, []))
    assert run.at == {0.5: 3.0, 1.0: 800.0} and run.guides == [GuideLine(710, 720, 730)]
    assert (run.first, run.last) == (first + 700, last + 700)
    assert run.xy_mm[700] == pytest.approx(began) and run.xy_mm[0] == pytest.approx([20, 0])


def test_a_position_is_told_by_the_way_that_was_gone_and_standing_counts_as_one_place() -> None:
    x_mm = np.r_[0.0, 1.0, 1.0, 1.0, 2.0, 4.0]
    way = np.column_stack([x_mm, 0 * x_mm])
    assert [position_at(way, mm) for mm in (0.0, 0.5, 1.0, 1.5, 3.0, 4.0)] == pytest.approx(
        [0.0, 0.5, 1.0, 2.5, 4.5, 5.0]
    )


def test_a_way_of_no_length_is_its_place() -> None:
    place = np.array([[3.0, 4.0]])
    assert np.array_equal(FEED.run(np.vstack([place, place])), place)
    long = FEED.run(np.array([[0.0, 0.0], [1.0, 0.0]]))
    assert long[0] == pytest.approx([0, 0]) and long[-1] == pytest.approx([1, 0])
    assert np.diff(long[:, 0]).max() <= 1.001 * SAMPLE_MM


def test_a_lead_line_comes_to_rest_where_it_is_to_and_ends_at_the_last_of_these() -> None:
    """At rest on two places: at them the steps are those of a brake that stands."""
    x_mm = np.arange(0, 30, SAMPLE_MM)
    rows = np.column_stack([x_mm, 0 * x_mm])
    first, last = 10.0 / SAMPLE_MM, 20.5 / SAMPLE_MM
    rested, moved = FEED.resting(rows, [first, last])
    assert rested[-1] == pytest.approx([20.5, 0], abs=1e-9)
    stop = round(moved(first))
    assert rested[stop] == pytest.approx([10.0, 0], abs=1e-9)
    steps = np.diff(rested[:, 0])
    for at in (stop, len(steps) - 1):
        assert steps[at - 1] < 0.1 * SAMPLE_MM
    assert steps[stop // 2] == pytest.approx(SAMPLE_MM)
    for old_mm in (0.0, 4.0, 9.9, 10.0, 10.1, 15.0, 20.5):
        new = moved(old_mm / SAMPLE_MM)
        assert at_places(rested, np.array([new]))[0] == pytest.approx([old_mm, 0], abs=1 * UM)
