"""Marks on drawings of known geometry: where the axis stands, and what is no mark.

The issue asks for 50 um from the tick's centre; on scans of 300 dpi it is 3 um as a rule, 28 um at most over
130 random drawings.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from morfax.motion import long_array
from morfax.tracer.drawing.strokes import Sheet
from morfax.tracer.following.line import Line
from morfax.tracer.following.plain_places import view_of
from morfax.tracer.marks import marks as marks_along_path
from morfax.tracer.marks import ticks
from morfax.tracer.marks.head_path import HeadPath
from tests.tracer.inked import UM, arc, cross, dot, inked, polyline, tick
from tests.tracer.marked import trace, trace_lines

STANDS_WITHIN_MM = 50 * UM  # the issue's
LINE = polyline((4, 12), (34, 12))
CIRCLE = arc((16, 16), 10)


def marks(
    *lines: np.ndarray,
    width_mm: float = 0.5,
    dpi: float = 300.0,
    specks: tuple[np.ndarray, ...] = (),
) -> Line:
    """The line of a scanned drawing, with its marks."""
    return trace(inked(*lines, width_mm=width_mm, dpi=dpi, seed=7, specks=specks)).lines[0]


def off_mm(line: Line, *places: tuple[float, float]) -> list[float]:
    """How far each mark is from its place; there must be as many, in order along the line."""
    found = sorted(mark.place_mm for mark in line.marks)
    assert len(found) == len(places), found
    return [math.dist(a, b) for a, b in zip(found, sorted(places), strict=True)]


def test_the_paper_beside_a_stroke_is_looked_at_for_one_row_of_cells_only(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Six rows see a tick of 4 mm on either side; a stroke aslant is no tick, whatever is beside it."""
    looked_at = list[float]()
    soiled = ticks.soiled_beside
    monkeypatch.setattr(
        ticks, "soiled_beside", lambda *seen: looked_at.append(soiled(*seen)) or looked_at[-1]
    )
    aslant = tick((14, 12), before_mm=0.0, beyond_mm=4.0, slant_deg=52)
    across = tick((24, 12), before_mm=4.0, beyond_mm=4.0)
    sheet = Sheet.of(inked(LINE, aslant, across, seed=7))
    along = np.column_stack([np.linspace(4, 34, 6000), np.full(6000, 12.0)])
    (found,) = marks_along_path.marks_along(view_of(sheet, None, 0.5), along)
    assert math.dist(found.place_mm, (24, 12)) < STANDS_WITHIN_MM
    assert len(looked_at) == 1  # of the stroke to the left of the line, which is the tick


LEAST_WIDTHS = 4.0  # a tick is at least so long; a slanted one of three stands 0.14 mm off


@settings(max_examples=12, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(
    x_mm=st.floats(12, 26),
    slant_deg=st.floats(-30, 30),
    length_mm=st.floats(2.5, 8),
    width_mm=st.sampled_from([0.3, 0.5, 0.8]),
)
def test_the_axis_stands_where_a_tick_crosses(
    x_mm: float, slant_deg: float, length_mm: float, width_mm: float
) -> None:
    half_mm = max(length_mm / 2, LEAST_WIDTHS * width_mm / 2)
    stroke = tick((x_mm, 12), before_mm=half_mm, beyond_mm=half_mm, slant_deg=slant_deg)
    assert off_mm(marks(LINE, stroke, width_mm=width_mm), (x_mm, 12))[0] < STANDS_WITHIN_MM


@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize("from_mm", [0.0, 1.0, 1.5])
def test_a_tick_beside_the_line_stops_it_too(from_mm: float, side: int) -> None:
    stroke = np.array([[20, 12 + side * from_mm], [20, 12 + side * (from_mm + 2.5)]])
    assert off_mm(marks(LINE, stroke), (20, 12))[0] < STANDS_WITHIN_MM


@pytest.mark.parametrize("slant_deg", [-20, -12, 12, 20])
def test_a_short_slanting_tick_of_a_wide_pen_is_felt_square_to_itself(slant_deg: float) -> None:
    stroke = tick((20, 12), before_mm=0.0, beyond_mm=1.5, slant_deg=slant_deg)
    assert (
        off_mm(marks(LINE, stroke, width_mm=0.8), (20, 12))[0] < 25 * UM
    )  # 85 um by slices along the line


def test_a_long_tick_apart_from_the_line_is_no_line_that_begins_there() -> None:
    assert off_mm(marks(LINE, polyline((20, 13.2), (20, 16.4))), (20, 12))[0] < STANDS_WITHIN_MM


def test_ticks_on_a_circle_are_found_in_the_order_of_the_run() -> None:
    places = [(16 + 10 * math.cos(a), 16 + 10 * math.sin(a)) for a in (0.4, 2.0, 4.1)]
    strokes = [
        tick(p, math.degrees(a) + 90) for p, a in zip(places, (0.4, 2.0, 4.1), strict=True)
    ]
    line = marks(CIRCLE, *strokes)
    assert max(off_mm(line, *places)) < STANDS_WITHIN_MM
    assert [mark.at for mark in line.marks] == sorted(mark.at for mark in line.marks)
    for mark in line.marks:
        assert math.dist(line.place(mark.at), mark.place_mm) < 1 * UM  # the place is on the way


@pytest.mark.parametrize(
    ("dpi", "within_mm"), [(150.0, 50 * UM), (300.0, 30 * UM), (600.0, 15 * UM)]
)
def test_other_resolutions(dpi: float, within_mm: float) -> None:
    assert off_mm(marks(LINE, tick((20, 12), slant_deg=15), dpi=dpi), (20, 12))[0] < within_mm


def test_a_dot_on_the_line_is_a_mark_at_its_middle() -> None:
    line = marks(LINE, specks=(dot((20, 12), 1.6),))
    assert [mark.kind for mark in line.marks] == ["dot"]
    assert off_mm(line, (20, 12))[0] < STANDS_WITHIN_MM


NO_MARKS = {
    "a crossing line goes on": [CIRCLE, polyline((16, 16), (37, 16))],
    "a line that crosses the lead goes on on one side": [LINE, polyline((20, 10), (20, 27))],
    "a line that begins there": [CIRCLE, polyline((26, 16), (34, 16))],
    "corners": [polyline((5, 5), (25, 5), (25, 20), (5, 20), (5, 5))],
    "a sharp tip": [polyline((5, 5), (30, 9), (5, 13), (5, 5))],
    "a line beside the line": [LINE, polyline((4, 13.5), (34, 13.5))],
    "a reference point": [polyline((10, 12), (34, 12)), *cross((8, 12))],
    "a crossing line in dashes": [
        LINE,
        *(polyline((20, y), (20, y + 2.6)) for y in (2.5, 6.6, 10.7, 14.8, 18.9)),
    ],
    "lettering": [LINE, *(polyline((x, 13.5), (x, 16.5)) for x in (17, 18.6, 20.2, 21.8))],
    "a stub": [LINE, polyline((20, 12), (20, 12.5))],
}


@pytest.mark.parametrize("lines", NO_MARKS.values(), ids=NO_MARKS)
@pytest.mark.parametrize("width_mm", [0.3, 0.5, 0.8])
def test_what_is_no_mark(lines: list[np.ndarray], width_mm: float) -> None:
    assert marks(*lines, width_mm=width_mm).marks == ()


def test_what_another_pen_drew_is_no_mark() -> None:
    drawing = inked(LINE, tick((20, 12)), width_mm=0.5, seed=7)
    x_mm, y_mm = ((np.arange(n) + 0.5) * drawing.pitch_mm for n in drawing.darkness.shape[::-1])
    on_tick = (np.abs(x_mm - 20) < 0.5)[None, :] & (np.abs(y_mm[::-1] - 12) > 0.3)[:, None]
    pencil = replace(
        drawing, darkness=np.where(on_tick, 1.0, 0.6).astype(np.float32) * drawing.darkness
    )
    assert len(trace(drawing).lines[0].marks) == 1 and trace(pencil).lines[0].marks == ()


@pytest.mark.parametrize("seed", range(4))
def test_a_dash_half_as_wide_that_crosses_the_line_is_no_mark(seed: int) -> None:
    """Noise may have the one end of it as wide as a mark, and the other, longer one not."""
    for out_mm in (6.0, 8.0):
        dash = np.array(
            [(24, 15.875), (26 + out_mm, 15.875), (26 + out_mm, 16.125), (24, 16.125)]
        )
        assert not trace(inked(CIRCLE, specks=[dash], seed=seed), (16, 6)).lines[0].marks


@pytest.mark.parametrize("y_mm", [13.0, 13.1, 13.2])
def test_a_tick_with_a_speck_of_paper_in_its_tip_is_no_junction(y_mm: float) -> None:
    drawing = inked(polyline((4, 12), (18, 12)), arc((27, 12), 9), tick((12, 12)))
    drawing.darkness[-1 - int(y_mm / drawing.pitch_mm), int(12 / drawing.pitch_mm)] = 0
    (line,) = trace(drawing).lines
    assert line.is_lead and [mark.kind for mark in line.marks] == ["tick"]
    assert (
        len(line.junctions_mm) == 1
        and math.dist(line.junctions_mm[0], (18, 12)) < STANDS_WITHIN_MM
    )


@pytest.mark.parametrize("seed", [6, 27, 33, 47, 68, 106, 115, 168])
def test_a_speck_of_paper_anywhere_on_a_tick_hides_neither_its_tip_nor_the_way_straight_on(
    seed: int,
) -> None:
    """Of 240 such drawings the head went up the tick on six, and the tick was no mark on eighteen, before it
    knew better; these are eight of them.
    """
    rng = np.random.default_rng(seed)
    width_mm, pixels, angle = (
        rng.choice([0.3, 0.5]),
        int(rng.integers(1, 3)),
        rng.uniform(0, math.pi),
    )
    slant_deg, half_mm = rng.uniform(-20, 20), rng.uniform(1.2, 2.2)
    way = np.array([math.cos(angle), math.sin(angle)])
    stroke = tick(
        (18, 18), math.degrees(angle), before_mm=half_mm, beyond_mm=half_mm, slant_deg=slant_deg
    )
    ends = polyline((18 - 13 * way[0], 18 - 13 * way[1]), (18 + 13 * way[0], 18 + 13 * way[1]))
    drawing = inked(ends, stroke, width_mm=float(width_mm), seed=seed)
    x, y = (
        stroke[0]
        + (stroke[1] - stroke[0]) * rng.uniform(0.05, 0.95)
        + rng.normal(0, 0.1, 2) * width_mm
    )
    row, column = (
        len(drawing.darkness) - 1 - int(y / drawing.pitch_mm),
        int(x / drawing.pitch_mm),
    )
    if rng.random() < 0.5:
        drawing.darkness[row, column : column + pixels] = 0
    else:
        drawing.darkness[row : row + pixels, column] = 0
    line = trace(drawing).lines[0]
    assert np.abs((line.xy_mm - [18, 18]) @ [-way[1], way[0]]).max() < STANDS_WITHIN_MM
    assert off_mm(line, (18, 18))[0] < STANDS_WITHIN_MM and not line.junctions_mm


@pytest.mark.parametrize("seed", [29, 62, 65, 83, 112, 116])
def test_a_tick_with_a_speck_of_paper_is_no_line_of_its_own(seed: int) -> None:
    """Of 120 such drawings 33 had the tick cut as a line; on these the way over the line is told by the
    tick's other half.
    """
    rng = np.random.default_rng(seed)
    width_mm, pixels = rng.choice([0.3, 0.5]), int(rng.integers(1, 3))
    a, half_mm = rng.uniform(0, math.tau), rng.uniform(1.2, 2.4)
    foot = (18 + 9 * math.cos(a), 18 + 9 * math.sin(a))
    slant_deg = rng.uniform(-20, 20)
    stroke = tick(
        foot, math.degrees(a) + 90, before_mm=half_mm, beyond_mm=half_mm, slant_deg=slant_deg
    )
    drawing = inked(
        arc((18, 18), 9), arc((38, 18), 7), stroke, width_mm=float(width_mm), seed=seed
    )
    x, y = (
        stroke[0]
        + (stroke[1] - stroke[0]) * rng.uniform(0.05, 0.95)
        + rng.normal(0, 0.1, 2) * width_mm
    )
    row, column = (
        len(drawing.darkness) - 1 - int(y / drawing.pitch_mm),
        int(x / drawing.pitch_mm),
    )
    drawing.darkness[row, column : column + pixels] = 0
    lines = trace_lines(drawing).lines
    assert [line.ending for line in lines] == ["closed", "closed"]
    assert sum(len(line.marks) for line in lines) == 1


def test_on_a_line_of_two_pixels_no_mark_is_read() -> None:
    assert marks(LINE, tick((20, 12)), width_mm=0.3, dpi=150).marks == ()


def test_a_tick_that_nearly_touches_another_line_ends_all_the_same() -> None:
    for width_mm in (0.3, 0.5, 0.8):
        other = polyline((4, 14.2 + width_mm), (34, 14.2 + width_mm))  # 0.2 mm of paper between
        line = trace(
            inked(
                LINE, tick((20, 12), before_mm=2, beyond_mm=2), other, width_mm=width_mm, seed=7
            ),
            (5, 12),
        )
        assert off_mm(line.lines[0], (20, 12))[0] < STANDS_WITHIN_MM


def test_a_tick_near_a_corner_is_a_mark_of_its_own_side_only() -> None:
    sides = polyline((4, 4), (14, 20), (24, 4))
    stroke = tick((16.2, 16.5), math.degrees(math.atan2(-16, 10)))
    assert off_mm(marks(sides, stroke, width_mm=0.8), (16.1875, 16.5))[0] < STANDS_WITHIN_MM


def test_of_a_long_path_the_cells_beside_it_hold_a_block_at_a_time(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    angles = np.linspace(0, 6, 5000)
    positions = 16 + 10 * np.column_stack([np.cos(angles), np.sin(angles)])
    drawing = inked(CIRCLE, tick((26, 16), before_mm=2, beyond_mm=2), seed=7)
    view = view_of(Sheet.of(drawing), None, 0.5)
    away_mm = np.array([-1.0, 0.0, 1.0])
    path = HeadPath(positions, 0.02)
    whole = marks_along_path._are_dark(view, path, away_mm)
    monkeypatch.setattr(long_array, "IN_MEMORY_BYTES", 16 * 500)
    monkeypatch.setattr(long_array, "BLOCK_ROWS", 301)
    given_back = list[int]()
    monkeypatch.setattr(marks_along_path, "released", lambda rows: given_back.append(len(rows)))
    path = HeadPath(positions, 0.02)
    assert (marks_along_path._are_dark(view, path, away_mm) == whole).all()
    assert sum(given_back) == len(path.places) and max(given_back) <= 301
    assert whole.nbytes < len(away_mm) * (len(path.places) / 8 + 1)
