"""Start places: which places of a closed path are tried, and which leads are taken there."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import islice
from typing import Literal

import numpy as np
import pytest

from morfax.motion.arrays import Array
from morfax.motion.offset import DriveCurve, OffsetPath
from morfax.motion.polyline import APART_MM, at_lengths, at_places, lengths_mm, with_places
from morfax.tracer.cutter.contour import Beside, Cut
from morfax.tracer.cutter.contouring import Contouring, Lead
from morfax.tracer.cutter.leads import Scrap
from morfax.tracer.cutter.start_places import StartPlaces, _Path
from morfax.tracer.following.line import Line
from morfax.tracer.operator.operator import Operator

STEP_MM = 10.0 / 6000  # of a head at 10 mm/s

# a house of 20 mm whose roof has a tip of 60 degrees
HOUSE = [(0.0, 0.0), (20.0, 0.0), (20.0, 12.0), (10.0, 12.0 + math.sqrt(300.0)), (0.0, 12.0)]
# an L: five corners go out, and one in, at (10, 10)
ANGLE = [(0.0, 0.0), (30.0, 0.0), (30.0, 10.0), (10.0, 10.0), (10.0, 25.0), (0.0, 25.0)]


def beside(
    corners: list[tuple[float, float]],
    left: bool = False,
    radius_mm: float = 0.0,
    as_told: bool = False,
) -> Beside:
    """The contour of a shape as its own path, counter-clockwise, begun in the middle of its first side."""
    places = np.array(corners)
    begin = 0.5 * (places[0] + places[1])
    way = np.vstack([begin, places[1:], places[:1], begin])
    long_mm = lengths_mm(way)[-1]
    xy_mm = at_lengths(way, np.linspace(0, long_mm, round(long_mm / STEP_MM) + 1))
    line = Line(xy_mm, "closed", 0.5, long_mm, as_told=as_told)
    cut = Cut.of(line, Operator(), 1)
    assert cut is not None
    return Beside(cut, left, radius_mm, [OffsetPath(with_places(way, APART_MM), True, 0)])


def tried(path: _Path, start_at: str | None, tool_mm: Array | None = None) -> Array:
    """The places that are tried on a path, the first first, (n, 2) mm."""
    at = np.array(list(islice(path.places(start_at, tool_mm), 24)))
    return at_places(path.points_mm, at)


def test_the_middles_of_straight_stretches_come_first_the_longest_before_the_others() -> None:
    roof = math.dist(HOUSE[2], HOUSE[3])
    assert roof == pytest.approx(20.0)
    found = tried(_Path(beside([*HOUSE[:1], (22.0, 0.0), (22.0, 12.0), *HOUSE[3:]]), 0), None)
    # 22 mm of floor; two slopes, of 21.1 and 20 mm; two walls of 12 mm
    assert found[0] == pytest.approx([11, 0], abs=0.05)
    assert found[1] == pytest.approx([16, 20.66], abs=0.05)
    assert found[2] == pytest.approx([5, 20.66], abs=0.05)
    assert sorted(found[3:5, 0]) == pytest.approx([0, 22], abs=0.05)
    assert found[3:5, 1] == pytest.approx([6, 6], abs=0.05)


def test_after_the_straight_stretches_come_places_all_round_at_equal_distances() -> None:
    angles = np.linspace(0, math.tau, 2000, endpoint=False)
    ring = [(10 * math.cos(a), 10 * math.sin(a)) for a in angles.tolist()]
    path = _Path(beside(ring), 0)
    found = np.array(list(path._all_round(0.0)))
    places = at_places(path.points_mm, found)
    turned = np.unwrap(np.arctan2(*places.T[::-1]))
    assert len(found) == 12
    assert np.diff(turned) == pytest.approx(math.tau / 12, abs=1e-3)


@pytest.mark.parametrize(("left", "outside"), [(False, True), (True, False)])
def test_corners_that_the_tool_goes_round_come_first_the_sharpest_before_the_others(
    left: bool, outside: bool
) -> None:
    """Outside of a house its tip of 60 degrees is the sharpest, then the floor, then the eaves."""
    corners = tried(_Path(beside(HOUSE, left), 0), "corner")[:5]
    assert corners[0] == pytest.approx(HOUSE[3], abs=0.05)
    assert sorted(corners[1:3, 0]) == pytest.approx([0, 20], abs=0.05)
    assert corners[1:3, 1] == pytest.approx([0, 0], abs=0.05)
    assert corners[3:5, 1] == pytest.approx([12, 12], abs=0.05)
    # of the angle the corner that goes in is the last outside, and inside the first
    places = tried(_Path(beside(ANGLE, left), 0), "corner")[:6]
    inner = np.hypot(*(places - (10, 10)).T)
    assert int(inner.argmin()) == (5 if outside else 0) and inner.min() < 0.05


def test_a_corner_s_place_is_at_the_foot_of_the_arm_between_its_two_sides() -> None:
    """Beside the corner (20, 0) of the house a tool of 2 mm radius is 2 mm off it, at 45 degrees."""
    turn = np.linspace(0, math.pi / 2, 99)
    rolled = np.column_stack([20 + 2 * np.sin(turn), -2 * np.cos(turn)])
    way = np.vstack(
        [(0.0, -2.0), rolled, (22.0, 12.0), (10.0, 33.4), (-2.0, 12.0), (0.0, -2.0)]
    )
    paths = [OffsetPath(with_places(way, APART_MM), True, 0)]
    places = tried(_Path(replace(beside(HOUSE, False, 2.0), paths=paths), 0), "corner")
    foot = 20 + 2 * math.sqrt(0.5), -2 * math.sqrt(0.5)
    assert np.hypot(*(places - foot).T).min() < 0.05


def test_nearest_begins_where_the_tool_comes_from_and_goes_on_with_the_nearer_places() -> None:
    path, tool_mm = _Path(beside(ANGLE), 0), np.array([40.0, 4.0])
    places = tried(path, "nearest", tool_mm)
    assert places[0] == pytest.approx([30, 4], abs=APART_MM)
    away_mm = np.hypot(*(places - tool_mm).T)
    assert np.all(np.diff(away_mm) >= -1e-9) and len(places) == 13
    # without a tool it is where the path begins
    assert tried(path, "nearest")[0] == pytest.approx(path.points_mm[0])


def begun(
    own: Beside, asked: Contouring, *others: Array
) -> tuple[StartPlaces, Array, tuple[float, float]]:
    """Start places with what they were asked, where a path begins, mm, and the sizes of its leads."""
    curves = [DriveCurve(own.cut.places_mm, True, own.left)]
    curves += [DriveCurve(other, True, False) for other in others]
    starts = StartPlaces(asked, Scrap(curves))
    begin = starts.begin(own, 0)
    return (
        starts,
        at_places(own.paths[0].points_mm, np.array([begin.at]))[0],
        (begin.in_mm, begin.out_mm),
    )


def block(left: float, low: float, right: float, high: float) -> Array:
    """A part beside, counter-clockwise."""
    return np.array([(left, low), (right, low), (right, high), (left, high)])


def test_the_first_place_with_room_for_whole_leads_is_taken() -> None:
    """Below the floor of the angle another part leaves 1 mm: the next longest stretch has room."""
    asked = Contouring(lead_in=Lead(3.0), lead_out=Lead(2.0))
    starts, place, sizes = begun(beside(ANGLE), asked)
    assert place == pytest.approx([15, 0], abs=0.05) and sizes == (3.0, 2.0)
    assert starts.tool_mm == pytest.approx(place)
    _, place, sizes = begun(beside(ANGLE), asked, block(-5, -9, 35, -1))
    assert place == pytest.approx([0, 12.5], abs=0.05) and sizes == (3.0, 2.0)


def test_where_no_place_has_room_for_whole_leads_the_longest_are_taken() -> None:
    """All round 2 mm are left, but above the upper end 4 mm: an arc of r goes down 1.5 r off."""
    frame = [
        block(-9, -9, 40, -2),
        block(32, -9, 40, 40),
        block(-9, -9, -2, 40),
        block(12, 12, 32, 40),
        block(-9, 29, 40, 40),
    ]
    asked = Contouring(lead_in=Lead(6.0))
    _, place, (in_mm, _) = begun(beside(ANGLE), asked, *frame)
    assert place[1] == pytest.approx(25, abs=0.05)
    # the sizes tried are 0.85 of each other: the largest that leaves half its depth is 4 / 1.5 or less
    assert 0.85 * 4 / 1.5 < in_mm <= 4 / 1.5


@pytest.mark.parametrize(("wide_mm", "has_lead"), [(0.14, False), (0.4, True)])
def test_a_lead_below_a_tenth_of_a_millimetre_is_none(wide_mm: float, has_lead: bool) -> None:
    """In a slot an arc of r wants r and half of it."""
    slot = [(0.0, 0.0), (20.0, 0.0), (20.0, wide_mm), (0.0, wide_mm)]
    _, _, (in_mm, _) = begun(beside(slot, left=True), Contouring(lead_in=Lead(1.0)))
    assert (in_mm > 0) == has_lead and (in_mm == 0 or in_mm >= 0.1)


def test_the_operator_s_arrow_says_where_a_line_with_leads_begins() -> None:
    told = beside(ANGLE, as_told=True)
    _, place, (in_mm, _) = begun(told, Contouring(lead_in=Lead(2.0), start_at="corner"))
    assert place == pytest.approx(told.cut.line.start_mm, abs=1e-6) and in_mm == 2.0


def test_where_a_lead_line_joins_there_is_no_lead_in() -> None:
    own = beside(ANGLE)
    starts = StartPlaces(
        Contouring(lead_in=Lead(2.0), lead_out=Lead(2.0)),
        Scrap([DriveCurve(own.cut.places_mm, True, False)]),
    )
    begin = starts.begin(own, 0, joins_at=100.0)
    assert (
        begin.at == 100.0
        and begin.lead_in is None
        and begin.in_mm == 0.0
        and begin.out_mm == 2.0
    )


@pytest.mark.parametrize("kind", ["arc", "line"])
@pytest.mark.parametrize("left", [False, True])
def test_leads_lie_on_the_scrap_s_side_before_and_after_the_place(
    kind: Literal["arc", "line"], left: bool
) -> None:
    """On the floor of the house, travelled to the right: the scrap is below, or above if it is a hole."""
    own = beside([(0.0, 0.0), (40.0, 0.0), (40.0, 30.0), (0.0, 30.0)], left)
    starts = StartPlaces(
        Contouring(lead_in=Lead(3.0, kind), lead_out=Lead(2.0, kind)),
        Scrap([DriveCurve(own.cut.places_mm, True, left)]),
    )
    begin = starts.begin(own, 0)
    assert begin.lead_in is not None and begin.lead_out is not None
    here = begin.lead_out[0]
    up = 1.0 if left else -1.0
    reach = 1.0 if kind == "arc" else math.sqrt(0.5)
    assert begin.lead_in[-1] == pytest.approx(here)
    along = -1.0 if here[1] > 15 else 1.0  # on the upper side the travel is to the left
    assert begin.lead_in[0] - here == pytest.approx(
        [-3 * reach * along, 3 * reach * up * along], abs=0.01
    )
    assert begin.lead_out[-1] - here == pytest.approx(
        [2 * reach * along, 2 * reach * up * along], abs=0.01
    )
