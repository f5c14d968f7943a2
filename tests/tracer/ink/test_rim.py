"""The rim of a line whose sides run together is felt where its ink ends, and the way lies within it."""

from __future__ import annotations

import math

import numpy as np
import pytest

from morfax.motion.polyline import area_mm2, closed_up, length_mm, nearest_mm, with_places
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.following.plain_places import view_of
from morfax.tracer.ink import rim as rim_module
from morfax.tracer.ink.rim import Rim, felt_rim
from tests.tracer.inked import UM, Points, arc, inked, polyline

HALF_MM = 0.25


def felt(outline: Points, *lines: Points) -> Rim:
    """The rim felt about an outline on a quiet scan of lines of 0.5 mm."""
    view = view_of(inked(*lines).sheet, None, 2 * HALF_MM)
    found = felt_rim(view, outline)
    assert found is not None
    return found


def test_the_rim_of_a_disc_is_a_circle() -> None:
    """Of a disc of 1 mm, from an outline that is 0.1 mm off: half as far beyond the circle of 0.75 mm as the
    pen's line is wide, within a tenth of a pixel, and bent by 1/mm to the left.
    """
    line = polyline((12, 2), (20, 2))
    disc = line, arc((6, 6), 0.75), arc((6, 6), 0.4), arc((6, 6), 0.1)
    found = felt(arc((6.05, 5.95), 1.05)[:-1], *disc)
    view = view_of(inked(line).sheet, None, 2 * HALF_MM)
    right_mm, left_mm = view.edges(np.array([16.0, 2.0]), 0.0, 1.0)
    away_mm = np.hypot(*(found.places_mm - (6, 6)).T) - 0.5 * (left_mm - right_mm)
    assert away_mm == pytest.approx(np.full(len(away_mm), 0.75), abs=8 * UM)
    assert np.mean(found.bends_per_mm) == pytest.approx(1.0, abs=0.02)
    assert area_mm2(found.places_mm) > 0


def test_a_speck_beside_the_rim_moves_nothing() -> None:
    """One pixel of a scan, with one of paper between it and a bar: within a tenth of a pixel."""
    clean = inked(polyline((4, 6), (16, 6)), polyline((4, 6.3), (16, 6.3)))
    darkness, pitch_mm = np.array(clean.darkness), clean.pitch_mm
    # the bar begins at 5.75 mm, in the middle of a pixel
    darkness[len(darkness) - 1 - int(5.75 / pitch_mm) + 2, int(10 / pitch_mm)] = 0.9
    outline = polyline((3.75, 5.75), (16.25, 5.75), (16.25, 6.55), (3.75, 6.55))
    low_mm = []
    for drawing in (clean, Drawing(darkness, pitch_mm)):
        found = felt_rim(view_of(drawing.sheet, None, 2 * HALF_MM), outline)
        assert found is not None
        near = np.abs(found.places_mm - (10, 5.75)).max(axis=1) < 0.4
        low_mm.append(found.places_mm[near, 1].min())
    assert low_mm[1] == pytest.approx(low_mm[0], abs=8 * UM)


def test_the_way_within_a_circle_is_a_smaller_circle() -> None:
    turned = np.linspace(0, math.tau, 400)[:-1]
    places = 2.0 * np.column_stack([np.cos(turned), np.sin(turned)])
    way = Rim(places, turned + 0.5 * math.pi, np.full(len(turned), 0.5)).way(0.25)
    assert np.hypot(*way.T) == pytest.approx(np.full(len(way), 1.75))


def test_a_corner_towards_the_ink_is_sharp() -> None:
    """A rim that turns right at (0, 0), from the heading of X to that of -Y: the way 0.25 mm to its left
    turns at (0.25, 0.25), and does not run round the corner in an arc.
    """
    s, none = 0.05 * np.arange(1, 60), np.zeros(59)
    places = np.vstack([np.column_stack([-s[::-1], none]), np.column_stack([none, -s])])
    headings, bends = np.r_[none, none - 0.5 * math.pi], np.zeros(118)
    # parabolas turn it over four places
    headings[57:61], bends[57:61] = (-0.2, -0.6, -1.0, -1.4), -8.0
    way = Rim(places, headings, bends).way(0.25)
    off_mm = np.hypot(*(way - (0.25, 0.25)).T)
    assert off_mm.min() == pytest.approx(0.0, abs=1 * UM)
    beside = np.minimum(np.abs(way[:, 0] - 0.25), np.abs(way[:, 1] - 0.25))
    assert beside.max() < 1 * UM


def square_rim(begin: int) -> Rim:
    """The rim of a hole of 4 mm in ink, felt every 0.05 mm from some place on: its corners turn right."""
    side = np.arange(0.025, 4.0, 0.05)
    low, high = np.zeros(len(side)), np.full(len(side), 4.0)
    places = np.vstack(
        [
            np.column_stack(each)
            for each in ((low, side), (side, high), (high, side[::-1]), (side[::-1], low))
        ]
    )
    headings = np.repeat(np.array([0.5, 0.0, -0.5, -1.0]) * math.pi, len(side))
    bends = np.zeros(len(places))
    for k in range(4):
        at = k * len(side) + np.arange(-2, 2)  # parabolas turn it over four places
        headings[at] += np.array([-0.1, -0.2, 0.2, 0.1]) * math.pi
        bends[at] = -8.0
    return Rim(*(np.roll(each, -begin, axis=0) for each in (places, headings, bends)))


@pytest.mark.parametrize("begin", [0, 1, 2, 5, 40, 79])
def test_a_corner_at_which_the_rim_begins_is_as_sharp_as_any(begin: int) -> None:
    """All four corners of the way half a pen's width beyond a hole; one was left round by 0.1 mm."""
    way = square_rim(begin).way(HALF_MM)
    for corner in ((-0.25, -0.25), (4.25, -0.25), (4.25, 4.25), (-0.25, 4.25)):
        assert np.hypot(*(way - corner).T).min() < 1 * UM


def test_places_at_one_spot_make_no_corner_wider() -> None:
    """Two places felt 1 um apart, at which the rim begins: its corners lie 0.125 mm before and behind the
    tight places; they were 125 places wide, more than the rim has: no index of it.
    """
    rim = square_rim(40)
    rim.places_mm[1] = rim.places_mm[0] + (0.0, 1 * UM)
    corners = rim.corners(HALF_MM)
    assert np.ptp(corners.at, axis=1).max() <= 10
    other = closed_up(corners.way)[::-1]
    assert len(corners.over_to([other], HALF_MM)) > 0


def test_a_corner_lies_on_the_rim() -> None:
    """Hardly longer than what bends the parabolas at its corner: no place before its first, or after its
    last.
    """
    turned = np.linspace(0, math.tau, 21)[:-1]
    places = 0.03 * np.column_stack([np.cos(turned), np.sin(turned)])
    bends = np.where(np.arange(20) == 7, -8.0, 0.0)
    at = Rim(places, turned + 0.5 * math.pi, bends).corners(HALF_MM).at
    assert (at.min(), at.max()) == (0, 19)


def test_a_corner_beyond_the_place_behind_it_is_none() -> None:
    """A speck beside a straight rim turned it to the left, and then further: the lines through both meet
    further on.
    """
    way = np.column_stack([np.arange(8.0), np.zeros(8)])
    headings = np.zeros(8)
    headings[2], headings[4] = math.radians(45), math.radians(60)
    assert np.array_equal(rim_module._mitred(way, headings, np.array([[2, 4]]), 99.0), way)


def test_a_rim_that_is_all_within_one_corner_of_its_pen_has_none() -> None:
    """A quarter of a broad pen's width beyond its corner is further than all round the rim."""
    assert not len(square_rim(0).corners(200.0).at)


def test_corners_that_are_nearer_than_a_mitre_are_both_sharp() -> None:
    """A slot in the ink of 0.3 mm: what bends the parabolas at one of its corners comes up to the other."""
    at = np.arange(0.025, 6.0, 0.05)
    end = np.arange(0.025, 0.3, 0.05)
    places = np.vstack(
        [
            np.column_stack([np.zeros(len(at)), at]),
            np.column_stack([end, np.full(len(end), 6.0)]),
            np.column_stack([np.full(len(at), 0.3), at[::-1]]),
            np.column_stack([end[::-1], np.zeros(len(end))]),
        ]
    )
    counts = (len(at), len(end), len(at), len(end))
    headings = np.repeat(np.array([0.5, 0.0, -0.5, -1.0]) * math.pi, counts)
    bends = np.zeros(len(places))
    for first in np.cumsum((0, *counts[:3])):
        bends[[first - 2, first - 1, first, first + 1]] = -8.0
    way = Rim(places, headings, bends).way(HALF_MM)
    for corner in ((-0.25, -0.25), (0.55, -0.25), (0.55, 6.25), (-0.25, 6.25)):
        assert np.hypot(*(way - corner).T).min() < 1 * UM


@pytest.mark.parametrize("is_sharp", [True, False])
def test_a_corner_is_as_its_ink_has_it(is_sharp: bool) -> None:
    """The ink of a pen that drew it sharp, or round the rim's own corner."""
    corners = square_rim(0).corners(HALF_MM)
    drawn = corners.mitred() if is_sharp else corners.way
    about = np.stack(np.meshgrid(np.arange(-1, 5.01, 0.05), np.arange(-1, 5.01, 0.05)), axis=-1)
    places = about.reshape(-1, 2)

    def is_dark(way: Points) -> Points:
        return nearest_mm(places, with_places(way, 0.02)) < HALF_MM

    def left(way: Points) -> Points:
        return np.asarray(
            (is_dark(way) != is_dark(closed_up(drawn))) * 0.05**2 / (2 * HALF_MM) ** 2
        )

    assert np.array_equal(corners.likest(places, left, 0.75), drawn)


def test_corners_into_which_noise_broke_one_are_that_one_where_the_ink_has_it() -> None:
    """An acute corner whose parabolas turn back between: three mitres are none of it; one is."""
    whole = square_rim(40).corners(HALF_MM)
    first, last = whole.at[0].tolist()
    middle, headings = (first + last) // 2, whole.headings_rad.copy()
    headings[middle - 1 : middle + 1] += 1.2
    broken = whole._replace(
        headings_rad=headings,
        at=np.vstack([[(first, middle), (middle - 1, last)], whole.at[1:]]),
    )
    places = np.stack(np.meshgrid(*2 * [np.arange(-1, 5.01, 0.05)]), axis=-1).reshape(-1, 2)

    def left(way: Points) -> Points:
        away_mm = (nearest_mm(places, with_places(each, 0.02)) for each in (way, truth))
        drawn, seen = (each < HALF_MM for each in away_mm)
        return np.asarray((drawn != seen) * 0.05**2 / (2 * HALF_MM) ** 2)

    truth = closed_up(whole.mitred())
    off_mm = nearest_mm(broken.likest(places, left, 0.75), with_places(truth, 0.005))
    assert off_mm.max() < 5 * UM
    assert nearest_mm(broken.mitred(), with_places(truth, 0.005)).max() > 20 * UM


def test_the_rim_of_a_thin_line_is_felt_on_a_coarse_scan() -> None:
    """A circle of 0.34 mm line at 200 dpi, where a speck may be as long as the rays reach beyond the rim."""
    line = arc((8, 8), 4.0)
    view = view_of(inked(line, width_mm=0.34, dpi=200).sheet, None, 0.36)
    found = felt_rim(view, arc((8, 8), 4.17)[:-1])
    assert found is not None
    away_mm = np.hypot(*(found.places_mm - (8, 8)).T)
    assert away_mm == pytest.approx(np.full(len(away_mm), 4.185), abs=25 * UM)


def test_ink_that_is_hardly_there_has_no_rim() -> None:
    view = view_of(inked(polyline((4, 4), (12, 4))).sheet, None, 2 * HALF_MM)
    assert felt_rim(view, arc((6, 4), 0.1)[:-1]) is None
    assert felt_rim(view, arc((8, 30), 2.0)[:-1]) is None


def test_the_kernel_feels_what_its_plain_python_feels(monkeypatch: pytest.MonkeyPatch) -> None:
    line = polyline((4, 4), (10, 4))
    outline = polyline((3.8, 3.8), (10.2, 3.8), (10.2, 4.2), (3.8, 4.2))
    compiled = felt(outline, line)
    monkeypatch.setattr(rim_module, "_feel", rim_module._feel.py_func)
    assert np.array_equal(felt(outline, line).places_mm, compiled.places_mm)
    assert length_mm(compiled.places_mm) == pytest.approx(12 + math.tau * HALF_MM, rel=0.02)
