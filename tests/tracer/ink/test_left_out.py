"""What is no line is known as such: solid areas, letters, hatching; and where lines meet is no solid area."""

from __future__ import annotations

import math

import numpy as np
import pytest

from morfax.tracer.drawing.components import Mask
from morfax.tracer.drawing.solids import Solids
from morfax.tracer.ink.hatching import hatching
from morfax.tracer.ink.left_out import ink_left
from morfax.tracer.operator.operator import Operator
from morfax.tracer.program.trace_ink import trace_ink
from tests.tracer.inked import MM_PER_INCH, WIDTH_MM, Points, arc, inked, polyline

FRAME = polyline((6, 6), (36, 6), (36, 36), (6, 36), (6, 6))
WALL = polyline((6, 46), (40, 46), (40, 49), (6, 49), (6, 46))
TO_WALL = polyline((20, 36), (20, 47))
DOT = arc((44, 20), 1.2)
TO_DOT = polyline((36, 20), (44, 20))
AREA_MM2 = 34 * 3.0


def star(lines: int, middle: tuple[float, float]) -> list[Points]:
    """Lines through one place."""
    turns = np.arange(lines) * math.pi / lines
    way = 9 * np.column_stack([np.cos(turns), np.sin(turns)])
    return [np.vstack([np.array(middle) - w, np.array(middle) + w]) for w in way]


def ink_of(*lines: Points, specks: tuple[Points, ...] = ()) -> Mask:
    return (inked(*lines, specks=specks, seed=2).darkness > 0.5).astype(np.uint8)


def test_a_wall_and_a_dot_are_left_out_and_the_lines_end_at_them() -> None:
    run = trace_ink(inked(FRAME, TO_WALL, TO_DOT, specks=(WALL, DOT), seed=1))
    assert run.ink is not None
    found = run.ink.solids
    # the rim of a wall is half a pixel off, and where a line enters it is a little more
    assert [area.area_mm2 for area in found] == pytest.approx(
        [AREA_MM2, 1.44 * math.pi], rel=0.06
    )
    assert found[0].place_mm == pytest.approx((23, 47.5), abs=0.1)
    assert run.ink.followed_share > 0.99
    ends = np.vstack([line.xy_mm[[0, -1]] for line in run.lines])
    ways = np.vstack([line.xy_mm for line in run.lines])
    assert ways[:, 1].max() < 46.3 and ways[:, 0].max() < 43.1  # not into the wall, nor the dot
    # a pen's end is round: half its width before the wall, and two pixels of the wall's soft rim
    assert np.hypot(*(ends - (20, 46)).T).min() < 0.5 * WIDTH_MM + 2 * MM_PER_INCH / 300


@pytest.mark.parametrize("lines", [2, 3, 4, 5])
def test_a_place_where_lines_meet_is_no_solid_area(lines: int) -> None:
    assert not Solids.of(ink_of(*star(lines, (20, 20)))).each


def test_lines_side_by_side_and_at_a_flat_angle_are_no_solid_area() -> None:
    flat = polyline((5, 20), (45, 22)), polyline((5, 22), (45, 20))
    beside = polyline((5, 30), (45, 30)), polyline((5, 30.45), (45, 30.45))
    assert not Solids.of(ink_of(*flat, *beside)).each


def test_a_sheet_drawn_with_a_broad_pen_has_no_solid_areas() -> None:
    ink = (inked(FRAME, TO_DOT, width_mm=2.0, seed=2).darkness > 0.5).astype(np.uint8)
    assert not Solids.of(ink).each


def test_one_broad_place_makes_no_wall_of_a_bold_outline_that_hangs_together_with_it() -> None:
    """A pen of 1 mm beside one of 0.25 mm, with a blot as broad as six of the thin lines at its corner."""
    thin = [polyline((8, y), (34, y)) for y in np.arange(8.0, 34.0, 2.0)]
    blot = arc((36, 36), 1.2)
    bold = inked(FRAME, width_mm=1.0, specks=(blot,), seed=2).darkness
    rows, columns = bold.shape
    ink = inked(*thin, width_mm=0.25, specks=(blot, arc((42, 42), 1.0)), seed=2).darkness
    ink = np.maximum(bold, ink[-rows:, :columns])
    found = Solids.of((ink > 0.5).astype(np.uint8)).each
    assert len(found) == 1
    pixel_mm = MM_PER_INCH / 300
    # the round and, up to where its disc goes in, the two bold lines beside it
    assert found[0].pixels * pixel_mm**2 == pytest.approx(1.44 * math.pi, rel=0.15)


def test_black_that_grows_broad_is_solid_and_no_line_of_a_broad_pen() -> None:
    thin = [polyline((8, y), (34, y)) for y in np.arange(8.0, 34.0, 2.0)]
    horn = polyline((6, 40), (46, 40), (46, 44))  # as a triangle 40 mm long
    ink = (inked(*thin, width_mm=0.25, specks=(horn,), seed=2).darkness > 0.5).astype(np.uint8)
    found = Solids.of(ink).each
    assert len(found) == 1
    # all but the tip, where it is as narrow as the lines
    assert found[0].pixels * (MM_PER_INCH / 300) ** 2 == pytest.approx(80, rel=0.06)


def test_black_with_specks_of_paper_is_solid() -> None:
    ink = ink_of(FRAME, TO_DOT, specks=(polyline((8, 8), (20, 8), (20, 20), (8, 20)),))
    rows, columns = np.nonzero(ink)
    whole = Solids.of(ink).mask
    chance = np.random.default_rng(4)
    some = np.flatnonzero(chance.random(len(rows)) < 0.02)
    for row, column in zip(rows[some].tolist(), columns[some].tolist(), strict=True):
        ink[row : row + 2, column : column + 2] = 0  # of a line's five pixels
    found = Solids.of(ink)
    assert len(found.each) == 1
    # specks at the rim of the square are paper beside it
    within = whole[3:-3, 3:-3] > 0
    for down, aside in ((0, 3), (6, 3), (3, 0), (3, 6)):
        within &= whole[down : down + len(within), aside : aside + within.shape[1]] > 0
    assert np.mean(found.mask[3:-3, 3:-3][within]) > 0.99


def test_hatching_on_a_broader_frame_is_known_and_the_frame_goes_straight_on() -> None:
    """Short pieces of the frame between the hatching are as wide as the frame, and not as the hatching."""
    tops = np.arange(8.0, 44.0, 1.7)
    lines = list[Points]()
    for c in tops:  # x + y = c + 6, within the frame
        begin, end = (max(6.0, c - 30.0), min(36.0, c)), (min(36.0, c), max(6.0, c - 30.0))
        if math.dist(begin, end) > 3:
            lines.append(polyline(begin, end))
    run = trace_ink(inked(FRAME, *lines, width_mm=0.35, seed=1))
    assert run.ink is not None and len(run.ink.hatching) == 1
    family = run.ink.hatching[0]
    assert len(family.strokes) >= len(lines) - 2
    assert math.degrees(family.heading_rad) == pytest.approx(135, abs=1)
    assert family.apart_mm == pytest.approx(1.7 / math.sqrt(2), rel=0.05)
    assert len(run.lines) <= len(lines) + 4


def test_strokes_at_uneven_distances_are_no_hatching() -> None:
    at = np.cumsum([2.0, 0.8, 3.1, 1.1, 2.6, 0.7, 3.3, 1.2, 2.9])
    assert not hatching([polyline((x, 0), (x, 20)) for x in at])
    assert hatching([polyline((x, 0), (x, 20)) for x in 1.5 * np.arange(9)])


def test_letters_are_followed_or_left_out_by_their_height() -> None:
    def word(x: float, y: float, high: float) -> list[Points]:
        wide = 0.6 * high
        letter_l = polyline((x, y + high), (x, y), (x + wide, y))
        letter_v = polyline(
            (x + 1.6 * wide, y + high), (x + 2.1 * wide, y), (x + 2.6 * wide, y + high)
        )
        letter_i = polyline((x + 3.3 * wide, y), (x + 3.3 * wide, y + high))
        return [letter_l, letter_v, letter_i]

    drawing = inked(FRAME, *word(10, 14, 3.0), *word(10, 24, 6.0), width_mm=0.3, seed=1)
    lengths_mm = []
    for letters_from_mm in (0.0, 4.5, math.inf):
        run = trace_ink(drawing, operator=Operator(letters_from_mm=letters_from_mm))
        assert run.ink is not None
        lengths_mm.append((len(run.lines), run.ink.lettering_mm, run.ink.letters_mm))
        assert run.ink.followed_share > 0.99
    assert [lines for lines, _, _ in lengths_mm] == [7, 4, 1]
    small_mm, large_mm = (
        3.0 * (1 + 0.6 + 2 * math.hypot(1, 0.3) + 1),
        6.0 * (2.6 + 2 * math.hypot(1, 0.3)),
    )
    assert lengths_mm[0][1] == pytest.approx(small_mm + large_mm, rel=0.08)
    assert lengths_mm[1][2] == pytest.approx(small_mm, rel=0.08)
    assert lengths_mm[2][2] == pytest.approx(small_mm + large_mm, rel=0.08)


def test_the_outline_of_a_solid_area_goes_round_its_holes_too() -> None:
    outer, hole = [(5, 5), (45, 5), (45, 35), (5, 35), (5, 5)], [(11, 11), (11, 29), (39, 29)]
    frame = polyline(*outer, *hole, (39, 11), (11, 11))
    blot = polyline((20, 15), (26, 15), (26, 21), (20, 21))  # within the frame, and none of it
    lines = [polyline((60, y), (100, y + 2)) for y in np.arange(5.0, 36.0, 3.0)]
    areas = ink_left(inked(*lines, specks=(frame, blot), seed=1).sheet).areas
    assert [area.what for area in areas] == ["solid area"] * 2
    for area in areas:
        x, y = np.array(area.outline_mm).T
        within_mm2 = 0.5 * abs(float(np.dot(x, np.roll(y, 1)) - np.dot(y, np.roll(x, 1))))
        # an outline goes through the middles of pixels: half of one within the rim
        assert within_mm2 == pytest.approx(area.area_mm2, rel=0.05)
