"""Struck off: a stroke ends where it comes to another's ink; ink of two lines is left to both."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.motion.arrays import Array
from morfax.motion.polyline import evenly, length_mm
from morfax.tracer.ink.struck_off import _Struck, struck_off
from morfax.tracer.ink.track import InkStroke
from tests.tracer.inked import UM, WIDTH_MM, Points, inked, polyline

LINE = polyline((5, 10), (45, 10))
NOWHERE = np.empty((0, 2))
EVERY_MM = 0.2 * WIDTH_MM  # places that are voted on


def stroke_along(way: Points, *, closed: bool = False) -> InkStroke:
    """A stroke as the head leaves it: positions about a micrometre apart."""
    return InkStroke(evenly(way, 2 * UM), length_mm(way), closed, WIDTH_MM)


def leads_into(aside_mm: float, along_mm: float) -> Points:
    """A line that comes down to `LINE` at 45 degrees and runs along it, so far beside it, to its end."""
    return polyline((15, 20), (25, 10 + aside_mm), (25 + along_mm, 10 + aside_mm))


@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize("aside_mm", [20 * UM, 150 * UM])
def test_the_end_along_which_another_runs_is_cut_off(aside_mm: float, turned: bool) -> None:
    way = leads_into(aside_mm, 6.0)
    drawn = inked(LINE, polyline((15, 20), (25, 10)))
    other = stroke_along(way[::-1] if turned else way)
    line, cut = struck_off(drawn, [stroke_along(LINE), other], NOWHERE)
    assert line.length_mm == length_mm(LINE)
    end = cut.way_mm[0 if turned else -1]
    # from there on its pen is within the other's ink, and it keeps what leads there
    assert end == pytest.approx([25, 10 + aside_mm], abs=WIDTH_MM)
    assert cut.length_mm == pytest.approx(other.length_mm - 6, abs=WIDTH_MM)


def test_an_end_of_less_than_half_a_width_is_not_cut_off(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def votes(_: _Struck, some: Array) -> Array:
        return np.where(some < 2, 1, -1)  # 0.4 widths

    monkeypatch.setattr(_Struck, "_votes", votes)
    stroke = stroke_along(LINE)
    assert struck_off(inked(LINE), [stroke], NOWHERE) == [stroke]


@pytest.mark.parametrize("count", [1, 2])
def test_few_places_of_a_hairline_in_others_ink_are_left_it(
    count: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its widths are less than a place, since most strokes are broad: nothing is between two of them."""

    asked = iter(range(100))

    def votes(_: _Struck, some: Array) -> Array:
        assert next(asked, None) is not None, "it comes to no end"
        return np.where((some >= 5) & (some < 5 + count), 1, -1)

    monkeypatch.setattr(_Struck, "_votes", votes)
    hairline = stroke_along(LINE)._replace(width_mm=0.01 * WIDTH_MM)
    broad = stroke_along(polyline((5, 20), (45, 20))), stroke_along(polyline((5, 30), (45, 30)))
    strokes = [hairline, *broad]
    assert struck_off(inked(LINE), strokes, NOWHERE) == strokes


@pytest.mark.parametrize("share", [0.25, 0.45])
def test_where_the_ink_is_that_of_two_lines_both_go_on(share: float) -> None:
    way = leads_into(share * WIDTH_MM, 6.0)
    strokes = [stroke_along(LINE), stroke_along(way)]
    kept = struck_off(inked(LINE, way), strokes, NOWHERE)
    assert [stroke.length_mm for stroke in kept] == [stroke.length_mm for stroke in strokes]


def test_a_stroke_within_anothers_ink_is_none() -> None:
    within = polyline((20, 10.02), (24, 10.02))
    kept = struck_off(inked(LINE), [stroke_along(within), stroke_along(LINE)], NOWHERE)
    assert [stroke.length_mm for stroke in kept] == [length_mm(LINE)]


def test_of_two_that_end_in_each_other_one_goes_on() -> None:
    one, other = polyline((5, 10), (30, 10)), polyline((24, 10), (45, 10))
    kept = struck_off(inked(LINE), [stroke_along(one), stroke_along(other)], NOWHERE)
    assert kept[0].length_mm == length_mm(one)
    assert kept[1].way_mm[0] == pytest.approx([30, 10], abs=1.5 * EVERY_MM)


def test_what_crosses_or_pokes_out_is_left() -> None:
    across = polyline((20, 5), (20, 15))
    poking = polyline((30, 20), (30, 9))  # half a width beyond the line's ink
    strokes = [stroke_along(LINE), stroke_along(across), stroke_along(poking)]
    kept = struck_off(inked(LINE, across, poking), strokes, NOWHERE)
    assert [stroke.length_mm for stroke in kept] == [stroke.length_mm for stroke in strokes]


def test_a_ring_stays_closed_and_the_line_along_it_is_parted() -> None:
    ring = polyline((36, 10), (39, 10), (39, 14), (33, 14), (33, 10), (36, 10))
    strokes = [stroke_along(LINE), stroke_along(ring, closed=True)]
    before, behind, whole = struck_off(inked(LINE, ring), strokes, NOWHERE)
    assert whole == strokes[1]
    assert before.way_mm[-1] == pytest.approx([33, 10], abs=2 * EVERY_MM)
    assert behind.way_mm[0] == pytest.approx([39, 10], abs=2 * EVERY_MM)


@pytest.mark.parametrize(("along_mm", "pieces"), [(1.5, 1), (8.0, 2)])
def test_what_goes_along_another_and_leaves_it_again_is_parted(
    along_mm: float, pieces: int
) -> None:
    """Lines that cross at a small angle run together for a few widths, and both go on."""
    passing = polyline((10, 15), (15, 10), (15 + along_mm, 10), (20 + along_mm, 15))
    line, *parts = struck_off(
        inked(LINE, passing), [stroke_along(LINE), stroke_along(passing)], NOWHERE
    )
    assert line.length_mm == length_mm(LINE)
    assert len(parts) == pieces
    ends = [part.way_mm[at] for part in parts for at in (0, -1)]
    for end in ends[1:-1]:  # on the middle of the line
        assert end[1] == pytest.approx(10, abs=EVERY_MM)
    assert ends[0] == pytest.approx(passing[0])
    assert ends[-1] == pytest.approx(passing[-1], abs=2 * UM)


def test_ink_that_is_known_to_be_two_lines_is_left_to_both() -> None:
    """As where two lines touch, whose ink swells slowly on both sides of that place."""
    passing = polyline((10, 15), (15, 10), (23, 10), (28, 15))
    strokes = [stroke_along(LINE), stroke_along(passing)]
    kept = struck_off(inked(LINE, passing), strokes, evenly(LINE, EVERY_MM))
    assert [stroke.length_mm for stroke in kept] == [stroke.length_mm for stroke in strokes]


@pytest.mark.parametrize("dpi", [300.0, 100.0])
def test_one_lines_ink_has_one_stroke_on_whichever_sides_two_lie(dpi: float) -> None:
    """At 100 dpi the line is two and a half pixels wide."""
    drawn = inked(LINE, dpi=dpi)
    aside = np.array([0.0, 0.17 * WIDTH_MM])
    kept = struck_off(
        drawn,
        [stroke_along(LINE + aside), stroke_along(LINE[:1] - aside + [[0, 0], [38, 0]])],
        NOWHERE,
    )
    assert [stroke.length_mm for stroke in kept] == [length_mm(LINE)]


def test_lines_of_few_pixels_tell_no_two() -> None:
    """Half-way between pixels a line of two and a half is as broad as two of them a pixel apart."""
    way = leads_into(0.4 * WIDTH_MM, 6.0)
    _, cut = struck_off(
        inked(LINE, way, dpi=100.0), [stroke_along(LINE), stroke_along(way)], NOWHERE
    )
    assert cut.length_mm == pytest.approx(length_mm(way) - 6, abs=WIDTH_MM)


def test_of_a_way_out_and_back_one_pass_is_left() -> None:
    """Along a staff's line, round a note, and back: both passes were struck off."""
    round_note = [(30, 10), (31, 12), (32, 10.02)]
    way = polyline((10, 15), (10, 10), *round_note, (12, 10.02), (12, 5))
    drawn = inked(polyline((10, 10), (32, 10)), way)
    pieces = struck_off(drawn, [stroke_along(way)], NOWHERE)
    left_mm = sum(piece.length_mm for piece in pieces)
    assert left_mm == pytest.approx(length_mm(way) - 18, abs=2 * WIDTH_MM)


def test_a_stroke_that_comes_back_along_itself_ends_there() -> None:
    """A bar between two lines of a ring, which the way goes down and up again."""
    way = polyline((10, 10), (10, 20), (20, 20), (20, 10.02), (10, 10.02), (10, 16))
    (cut,) = struck_off(inked(way), [stroke_along(way)], NOWHERE)
    assert cut.length_mm == pytest.approx(length_mm(way) - 6, abs=WIDTH_MM)


def test_who_led_is_known_of_what_is_left() -> None:
    stroke = stroke_along(LINE)
    count = len(stroke.way_mm)
    led = stroke.led.along(np.repeat([0, 1], (count // 2, count - count // 2)))
    part = stroke._replace(led=led).part(10.0, 5.0)
    assert part.length_mm == pytest.approx(25, abs=5 * UM)
    assert part.led.of(len(part.way_mm)).mean() == pytest.approx(15 / 25, abs=0.001)
