"""A closed way that leaves its ink is found, with its place; what else lies beside a line is not."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from morfax.jobs.remarks.on_ink import of_ink
from morfax.motion.arrays import Array
from morfax.motion.polyline import at_lengths, length_mm
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.following.line import Line
from morfax.tracer.operator.operator import Operator
from morfax.tracer.program.against_ink import own_ink
from morfax.tracer.program.against_ink.own_ink import NEARLY, SURE, OwnInk, parts
from morfax.tracer.program.against_ink.pen_on_ink import (
    Band,
    PenOnInk,
    Room,
    Ways,
    _nearest,
    in_boxes,
    most_about,
    over_at,
)
from morfax.tracer.program.program import Trace
from morfax.tracer.program.setup import Setup
from tests.tracer.inked import Points, arc, inked, polyline, together
from tests.tracer.program.left_by import left_by

WIDTH_MM, STEP_MM = 0.5, 0.0017
# a notch 1.8 widths wide, and as deep as five
NOTCH_MM, DEEP_MM = 0.9, 2.5


def notched(deep_mm: float) -> Points:
    """A plate of 40 x 20 mm with a notch in its upper side."""
    left, right, bottom = 24.0, 24.0 + NOTCH_MM, 24.0 - deep_mm
    notch = (right, 24), (right, bottom), (left, bottom), (left, 24)
    return polyline((4, 4), (44, 4), (44, 24), *notch, (4, 24), (4, 4))


def open_notch(first_mm: float, deep_mm: float) -> Points:
    """A line along y = 24 mm with a notch, that ends at 44 mm."""
    left, right, bottom = 24.0, 24.0 + NOTCH_MM, 24.0 - deep_mm
    return polyline(
        (first_mm, 24), (left, 24), (left, bottom), (right, bottom), (right, 24), (44, 24)
    )


def closed(places_mm: Points, ending: str = "closed") -> Line:
    """A line as if the head had come along some places."""
    whole_mm = length_mm(places_mm)
    positions_mm = at_lengths(places_mm, np.arange(0.0, whole_mm, STEP_MM))
    return Line(positions_mm, ending, WIDTH_MM, whole_mm)


def found(drawing: Drawing, *lines: Line) -> list[tuple[float, float]]:
    """The places at which lines run beside their ink."""
    return [place.place_mm for place in OwnInk(drawing, lines).beside(SURE)]


@pytest.mark.parametrize("seed", [None, 1])
@pytest.mark.parametrize("short_mm", [0.4, 0.7])
def test_a_notch_whose_end_is_cut_off_is_found(seed: int | None, short_mm: float) -> None:
    drawing = inked(notched(DEEP_MM), seed=seed)
    (place,) = found(drawing, closed(notched(DEEP_MM - short_mm)))
    bottom_mm = 24.0 - DEEP_MM + short_mm
    assert math.dist(place, (24.45, bottom_mm)) < 1.5 * WIDTH_MM


@pytest.mark.parametrize("seed", [None, 1, 2])
def test_the_way_that_was_drawn_is_not(seed: int | None) -> None:
    assert found(inked(notched(DEEP_MM), seed=seed), closed(notched(DEEP_MM))) == []


def test_other_lines_ticks_and_blots_on_the_line_are_not() -> None:
    """They are ink that the pen does not draw, and the way is right."""
    tick, bar = polyline((10, 24), (10, 25)), polyline((30, 4), (30, 24))
    blot = arc((16, 4.2), 0.5)
    drawing = inked(notched(DEEP_MM), tick, bar, specks=[blot], seed=1)
    assert found(drawing, closed(notched(DEEP_MM))) == []


def test_a_line_that_swells_is_not_found() -> None:
    """A pen of 0.5 mm that was pressed harder along one side."""
    broad = polyline((4, 4.02), (44, 4.02)), polyline((4, 3.98), (44, 3.98))
    assert found(inked(notched(DEEP_MM), *broad, seed=1), closed(notched(DEEP_MM))) == []


def test_a_broad_line_that_thin_ones_cross_is_not_found() -> None:
    """Each line is as broad as it was felt: an outline of 1.1 mm, and centre lines of 0.5 mm."""
    edge, cross = polyline((4, 14), (44, 14)), polyline((24, 4), (24, 24))
    drawing = together((edge, 1.1), (cross, WIDTH_MM), seed=1)
    lines = replace(closed(edge, "ended"), width_mm=1.1), closed(cross, "ended")
    assert list(OwnInk(drawing, lines).beside(NEARLY)) == []


def test_a_way_beside_its_line_is_found_where_it_leaves_and_not_beyond() -> None:
    """It goes 0.4 mm aside for 6 mm; boxes about its ends reach one and a half widths further."""
    drawing = inked(notched(DEEP_MM), seed=1)
    aside = polyline((10, 4), (11, 4.4), (16, 4.4), (17, 4))
    way = np.vstack([notched(DEEP_MM)[:1], aside, notched(DEEP_MM)[1:]])
    (stretch,) = OwnInk(drawing, [closed(way)]).beside(SURE)
    assert 10 < stretch.place_mm[0] < 17
    assert 6.0 < stretch.length_mm < 6.0 + 3 * WIDTH_MM


def test_tiles_in_which_no_line_was_mended_are_not_held_against_their_ink_again(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Two plates, each with its notch cut short, of which one is mended; it tells what it would afresh."""
    down = np.array([0.0, 24.0])
    drawing = inked(notched(DEEP_MM), notched(DEEP_MM) + down, seed=1)
    cut, upper = closed(notched(DEEP_MM - 0.5)), closed(notched(DEEP_MM - 0.5) + down)
    tiles, over = list[bytes](), own_ink.over_at

    def counted(seen: Array, *rest: object) -> Array:
        tiles.append(seen.tobytes())
        return np.asarray(over(seen, *rest))

    monkeypatch.setattr(own_ink, "over_at", counted)
    own = OwnInk(drawing, [cut, upper])
    before = list(own.beside(SURE))
    of_both, _ = len(tiles), tiles.clear()
    assert list(own.mended([cut, upper]).beside(SURE)) == before and not tiles
    mended = own.mended([closed(notched(DEEP_MM)), upper])
    (left,) = mended.beside(SURE)
    assert left == before[1] and 0 < len(tiles) < 0.6 * of_both
    assert list(OwnInk(drawing, mended.lines).beside(NEARLY)) == list(mended.beside(NEARLY))


def test_tiles_of_wider_lines_or_of_lines_that_are_not_judged_have_keys_of_their_own() -> None:
    drawing = inked(notched(DEEP_MM), seed=1)
    ways = own_ink._ways(drawing, [closed(notched(DEEP_MM))])
    part = next(
        parts(drawing, ways, np.ones(len(ways.line), bool), 64, own_ink.pen_of(drawing, ways))
    )
    wider = part.ways._replace(half_px=1.1 * part.ways.half_px)
    others = part.ways._replace(judged=~part.ways.judged)
    assert (
        len({part.key(), part._replace(ways=wider).key(), part._replace(ways=others).key()})
        == 3
    )
    assert part.key() != part.key(part.at)


def test_an_open_line_that_cuts_a_notch_short_is_found_and_its_ends_are_not() -> None:
    """It ends on another line's ink, on paper, and where its own ink goes on."""
    bar = polyline((9, 20), (9, 28))
    drawing = inked(open_notch(9.0, DEEP_MM), bar, seed=1)
    short = closed(open_notch(9.0, DEEP_MM - 0.7), "ended")
    (place,) = found(drawing, short, closed(bar, "ended"))
    assert math.dist(place, (24.45, 24.0 - DEEP_MM + 0.7)) < 1.5 * WIDTH_MM
    for first_mm in (9.0, 12.0):
        right = closed(open_notch(first_mm, DEEP_MM), "ended")
        assert found(drawing, right, closed(bar, "ended")) == []
    others = [short, closed(bar, "ended")]
    assert [each.kind for each in left_by(Setup(drawing.sheet), others)] == ["beside"]


def test_lines_that_ran_into_others_and_drawn_programs_are_not_judged() -> None:
    drawing, short = inked(notched(DEEP_MM), seed=1), notched(DEEP_MM - 0.7)
    assert found(drawing, closed(short, "joined")) == []
    setup = Setup(drawing.sheet, operator=Operator(marks="on"))
    assert left_by(setup, [closed(short)]) == ()


def test_what_is_found_is_told_once_with_its_place() -> None:
    drawing, short = inked(notched(DEEP_MM), seed=1), closed(notched(DEEP_MM - 0.7))
    places = left_by(Setup(drawing.sheet), [short])
    assert any(place.kind == "beside" for place in places)
    said = " ".join(of_ink(Trace((short,), Operator(), unexplained=places), several=False))
    assert "runs beside its ink at 1 place" in said and "at 24." in said


def test_the_nearest_edge_within_reach() -> None:
    """One line of 2 px, and one of 3 px, whose edge is nearer to the pixel between them."""
    beyond, number = np.full((3, 5), 0.6, np.float32), np.zeros((3, 5), np.int32)
    # the last three lie beside this part of the sheet
    some = [(0.0, 1.0), (4.0, 1.0), (-4.0, 1.0), (60.0, 1.0), (1.0, -40.0)]
    lines, half_px = np.array([0, 1, 0, 0, 0], np.int32), np.array([1.0, 1.5])
    ways = Ways(np.array(some, np.float32), lines, half_px, np.empty(0, bool))
    count, reached = _nearest.py_func(ways, 0.6, beyond, number)
    assert number[1].tolist() == [1, 1, 2, 2, 2]
    assert beyond[1].tolist() == [-1, 0, 0.5, -0.5, -1.5]
    assert number[0, 2] == 0 and count == np.count_nonzero(number)
    # each pixel that has a number, once, though the second line takes one of the first over
    assert reached.tolist() == [[0, 5], [0, 5], [0, 5]]


def test_sums_over_boxes_and_the_most_of_them_about_a_pixel() -> None:
    """Of values at some pixels of 4 x 6, over boxes of 3 x 3; the room is as empty as before."""
    spread, sums = np.zeros((4, 6)), np.empty((4, 6))
    values = {(0, 0): 1.0, (1, 1): 2.0, (3, 5): -4.0, (2, 5): 8.0}
    at = np.array(list(values))
    band = Band(at[:, 0], at[:, 1], np.empty(4), np.empty(4), np.empty(4))
    most = in_boxes.py_func(band, np.array(list(values.values())), 3, spread, sums)
    expected = [
        sum(v for (i, j), v in values.items() if abs(i - row) <= 1 and abs(j - column) <= 1)
        for row in range(4)
        for column in range(6)
    ]
    assert sums.ravel().tolist() == expected and not spread.any()
    assert most == 8.0
    assert [most_about.py_func(sums, place, 3) for place in ((0, 3), (2, 2), (5, 0))] == [
        2,
        3,
        8,
    ]


def test_a_pen_of_its_own_width_explains_its_line_and_a_bare_way_is_over() -> None:
    """The kernel's plain Python; a line of 4 px along row 10 up to column 20, its way goes on to 39."""
    rows, columns = np.mgrid[0:21, 0:40].astype(np.float32)
    seen = np.clip(2.5 - np.abs(rows - 10), 0, 1) * (columns <= 20)
    places = np.column_stack([np.arange(40.0), np.full(40, 10.0)]).astype(np.float32)
    ways = Ways(places, np.zeros(40, np.int32), np.array([2.0]), np.array([True]))
    pen = PenOnInk(2.0, 0.3, 5.0, 0.0, (0.8, 1.0), 0.05)
    stations, room = np.array([(8, 10), (33, 10)]), Room.of(seen.size, pen)
    over = over_at.py_func(seen.astype(np.float32), ways, stations, pen, room)
    assert over[0] < 0.05
    # beyond its end the pen draws all of the box, but leaves no ink: a gap
    assert over[1] <= 0.0


def test_a_line_that_comes_to_a_point_at_its_end_is_not_found() -> None:
    """A broad pen's: there its round end is drawn on paper, and the point is left."""
    point = np.array([(29, 10.25), (31, 10), (29, 9.75)])
    drawing = inked(polyline((6, 10), (28.8, 10)), specks=[point], seed=1)
    for end_mm in (29.6, 30.2):
        assert found(drawing, closed(polyline((6, 10), (end_mm, 10)), "ended")) == []


def test_a_line_that_was_lost_at_once_is_passed_over() -> None:
    """It has one place, and no way; where it came last the command ended with an error."""
    plate, cut = notched(DEEP_MM), closed(notched(0.0))
    lost = Line(np.full((1, 2), 10.0), "lost", WIDTH_MM, 0.0)
    alone = found(inked(plate, width_mm=WIDTH_MM, seed=1), cut)
    assert alone and found(inked(plate, width_mm=WIDTH_MM, seed=1), cut, lost) == alone
