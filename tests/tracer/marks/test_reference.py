"""Reference points: crosses and rings, alone and with the lead line drawn from them, and what is none."""

from __future__ import annotations

import math

import numpy as np
import pytest

from morfax.tracer.drawing.strokes import Sheet
from morfax.tracer.following.line import Line
from morfax.tracer.following.open_ends import at_ends
from morfax.tracer.following.plain_places import view_of
from morfax.tracer.marks import reference
from morfax.tracer.marks.reference import Reference
from morfax.tracer.operator.operator import Operator
from morfax.tracer.program.lines import selection
from tests.tracer.inked import UM, arc, cross, inked, polyline, tick
from tests.tracer.marked import trace

WITHIN_MM = 50 * UM
CIRCLE = arc((36, 14), 9)
JOIN = (27.0, 14.0)
AT = (7.0, 14.0)
UP = np.array([0.0, 6.0])


def lead_line(*lines: np.ndarray, width_mm: float = 0.5) -> Line:
    """The line of a scanned drawing: a circle, and what leads to it."""
    return trace(inked(CIRCLE, *lines, width_mm=width_mm, seed=3)).lines[0]


def stands_at(line: Line, place_mm: tuple[float, float]) -> None:
    """The reference point is there, and the line begins near it and leads to the loop."""
    assert line.reference_mm is not None and math.dist(line.reference_mm, place_mm) < WITHIN_MM
    assert line.is_lead and line.loop_from is not None
    assert (
        math.dist(line.place(line.loop_from), JOIN) < 0.5
    )  # half a line's width from where the middle lines meet
    assert line.begin_mm == line.end_mm == line.reference_mm


@pytest.mark.parametrize("width_mm", [0.3, 0.5, 0.8])
@pytest.mark.parametrize("size_mm", [2.8, 5.0, 8.0])
@pytest.mark.parametrize("apart_mm", [0.8, 6.0])
def test_a_cross_apart_from_its_lead_line(
    size_mm: float, apart_mm: float, width_mm: float
) -> None:
    start = (AT[0] + size_mm / 2 + apart_mm + width_mm / 2, AT[1])
    stands_at(lead_line(polyline(start, JOIN), *cross(AT, size_mm), width_mm=width_mm), AT)


@pytest.mark.parametrize("width_mm", [0.3, 0.5, 0.8])
@pytest.mark.parametrize("turn_deg", [0.0, 4.0, 9.0, 15.0, 22.0, 30.0, 45.0, 52.0])
def test_a_cross_with_the_lead_line_from_its_middle_at_any_angle_to_its_arms(
    turn_deg: float, width_mm: float
) -> None:
    stands_at(lead_line(polyline(AT, JOIN), *cross(AT, 4.0, turn_deg), width_mm=width_mm), AT)


@pytest.mark.parametrize("width_mm", [0.3, 0.5, 0.8])
@pytest.mark.parametrize("slant_deg", [-12.0, 0.0, 12.0])
@pytest.mark.parametrize("beyond_mm", [0.4, 0.8, 1.2])
def test_a_lead_line_drawn_a_little_beyond_the_contour_ends_at_it(
    beyond_mm: float, slant_deg: float, width_mm: float
) -> None:
    """The axis stays out of the part; the tick on the lead line stays the only mark."""
    a = math.radians(slant_deg)
    way, join = np.array([math.cos(a), math.sin(a)]), np.array(JOIN)
    lead = np.array([join - 18 * way, join + beyond_mm * way])
    place = (float(lead[0][0]), float(lead[0][1]))
    mark = join - 8 * way
    line = lead_line(
        lead,
        *cross(place, 4.0),
        tick((float(mark[0]), float(mark[1])), slant_deg),
        width_mm=width_mm,
    )
    assert line.is_lead and line.loop_from is not None and len(line.marks) == 1
    assert np.hypot(*(line.xy_mm - (36, 14)).T).min() > 9 - WITHIN_MM


def test_a_speck_of_paper_on_an_arm_and_one_of_ink_in_a_ring_are_no_matter() -> None:
    speck = np.array([[7.8, 13.8], [7.9, 13.8], [7.9, 13.9]])
    drawing = inked(CIRCLE, polyline((9, 14), JOIN), arc(AT, 2), seed=3, specks=[speck])
    stands_at(trace(drawing).lines[0], AT)
    drawing = inked(CIRCLE, polyline((11, 14), JOIN), *cross(AT, 4.0), seed=3)
    row, column = (int(k / drawing.pitch_mm) for k in (drawing.height_mm - 15.0, 7.0))
    drawing.darkness[row : row + 2, column - 1 : column + 1] = 0.0
    stands_at(trace(drawing).lines[0], AT)


@pytest.mark.parametrize("size_mm", [3.0, 6.0])
def test_a_ring_alone_and_with_its_lead_line(size_mm: float) -> None:
    for start in (AT[0] + size_mm / 2, AT[0] + size_mm / 2 + 2.0):
        stands_at(lead_line(polyline((start, AT[1]), JOIN), arc(AT, size_mm / 2)), AT)


def test_a_thin_lead_line_from_a_large_ring_between_two_spokes() -> None:
    a = 0.044  # half way between spokes, 5 degrees apart: of a line of 0.3 mm they see nothing at 4 mm
    start = (AT[0] + 3.9 * np.cos(a), AT[1] + 3.9 * np.sin(a))
    line = lead_line(polyline(start, JOIN), arc(AT, 3.9), width_mm=0.3)
    stands_at(line, AT)


def test_specks_at_the_tips_of_a_cross_leave_it_a_cross() -> None:
    tips = [(AT[0] + 2.6, 14.2), (AT[0] - 0.3, 16.6)]
    specks = [
        np.array([[x - 0.04, y - 0.04], [x + 0.04, y - 0.04], [x, y + 0.04]]) for x, y in tips
    ]
    drawing = inked(CIRCLE, polyline((12, 14), JOIN), *cross(AT, 4.5), seed=3, specks=specks)
    stands_at(trace(drawing).lines[0], AT)


@pytest.mark.parametrize("named", [AT, (6.2, 14.6)])
def test_from_a_named_reference_point_the_lead_line_is_found_whatever_is_drawn_there(
    named: tuple[float, float],
) -> None:
    """Three strokes are no cross, and there is a guide line, at whose open end the head would begin
    otherwise.
    """
    strokes = [tick(AT, a, before_mm=2.0, beyond_mm=2.0) for a in (0, 50, 110)]
    guide = polyline((36, 5), (36, 12))
    run = trace(
        inked(CIRCLE, polyline(AT, JOIN), guide, *strokes, seed=3),
        operator=Operator(reference_mm=named),
    )
    assert run.lines[0].is_lead and run.lines[0].begin_mm == named
    assert run.lines[0].start_mm[0] < 12 and abs(run.lines[0].start_mm[1] - 14) < WITHIN_MM


NONE = {
    "a small square": polyline((5, 12), (9, 12), (9, 16), (5, 16), (5, 12)),
    "a letter T": np.array([[5.0, 16], [9, 16], [7, 16], [7, 12]]),
    "a stroke": polyline((5, 14), (8, 14)),
    "a cross with unequal arms": np.array([[4.0, 14], [10, 14], [6, 14], [6, 15.2], [6, 12.8]]),
    "an oblique cross": np.array([[5.0, 14], [9, 14], [7, 14], [8.7, 15], [5.3, 13]]),
}


@pytest.mark.parametrize("other", NONE.values(), ids=NONE)
def test_what_is_no_reference_point(other: np.ndarray) -> None:
    line = lead_line(polyline((14, 14), JOIN), tick((22, 14)), other)
    assert line.reference_mm is None and line.is_lead  # by its tick


def heart(radius_mm: float) -> np.ndarray:
    """A heart whose two bows touch each other at the cusp, at 36,14."""
    x, y = 36.0, 14.0
    return np.vstack(
        [
            arc((x - radius_mm, y), radius_mm, 180, 0),
            arc((x + radius_mm, y), radius_mm, 180, 0),
            [(x, y - 9), (x - 2 * radius_mm, y)],
        ]
    )


@pytest.mark.parametrize("width_mm", [0.3, 0.5])
@pytest.mark.parametrize(
    "outline",
    [
        heart(6.0),
        heart(12.0),
        polyline((36, 14), (30, 28), (42, 28), (36, 14)),
        polyline((36, 14), (34, 28), (38, 28), (36, 14)),
    ],
    ids=["bows of 6 mm", "bows of 12 mm", "46 degrees", "16 degrees"],
)
def test_a_hole_at_the_cusp_of_an_outline_is_no_reference_point(
    outline: np.ndarray, width_mm: float
) -> None:
    """Two lines part there, and a lead line is one: the outline closes, and begins nowhere else."""
    drawing = inked(outline + UP, arc((36, 17.5), 2.5), width_mm=width_mm, seed=3)
    line = trace(drawing, operator=Operator()).lines[0]
    assert line.ending == "closed" and line.reference_mm is None


@pytest.mark.parametrize("seed", [3, 9])
def test_a_circle_that_others_touch_is_no_reference_point(seed: int) -> None:
    """Both sides of the line that touches it are near to it, and neither leaves it."""
    first, second = arc((8.4, 8.4), 4.39, 0, 360), arc((12.91, 16.52), 4.41, 0, 360)
    third = arc((19.8, 22.6), 4.8, 0, 360)
    drawing = inked(first, second, third, width_mm=0.53, dpi=200, seed=seed)
    line = trace(drawing, operator=Operator()).lines[0]
    assert line.ending == "closed" and line.reference_mm is None


@pytest.mark.parametrize("across_mm", [7.0, 8.5])
def test_a_cross_in_a_circle_is_a_symbol_unless_a_program_is_drawn(across_mm: float) -> None:
    """A symbol whose arm points to the contour, and a line from there: a lead line only if that is said."""
    drawing = inked(
        CIRCLE, arc(AT, 2.0), *cross(AT, across_mm), polyline((AT[0] + 6, 14), JOIN), seed=3
    )
    found = trace(drawing, operator=Operator()).lines
    assert all(line.reference_mm is None for line in found)
    meant = trace(drawing).lines[0]
    assert meant.reference_mm is not None
    assert math.dist(meant.reference_mm, AT) < WITHIN_MM


@pytest.mark.parametrize(("apart_mm", "asked_of_each"), [(8.0, 6), (10.0, 0)])
def test_of_many_holes_each_line_asks_only_those_next_to_it(
    monkeypatch: pytest.MonkeyPatch, apart_mm: float, asked_of_each: int
) -> None:
    holes = [arc((8 + apart_mm * (k % 5), 8 + apart_mm * (k // 5)), 3.0) for k in range(25)]
    sheet, asked = Sheet.of(inked(*holes, seed=3)), list[Reference | None]()
    ring = reference._ring
    monkeypatch.setattr(
        reference, "_ring", lambda view, place: asked.append(ring(view, place)) or asked[-1]
    )
    patches = selection.lines_of(sheet)
    assert len(patches) == len(holes)
    for patch in patches:
        stroke = sheet.stroke(int(patch))
        view = view_of(sheet, None, stroke.width_mm)
        assert at_ends(view, sheet, stroke, 0.5, None) == []
    # its own hole, as ink and as a patch, and the four beside it; none if it stands alone
    assert len(asked) <= asked_of_each * len(holes)
    assert bool(asked) == bool(asked_of_each)
    assert all(found is not None and found.kind == "ring" for found in asked)


@pytest.mark.parametrize("size_mm", [3.2, 4.0])
def test_a_box_of_a_row_of_boxes_is_no_reference_point(size_mm: float) -> None:
    """Spokes meet the sides of a square box as a ring's, but lines leave it at more than one corner."""
    left, low, boxes = 5.0, 8.0, 8
    right, high = left + boxes * size_mm, low + size_mm
    row = polyline((left, low), (right, low), (right, high), (left, high), (left, low))
    bars = [
        polyline((left + k * size_mm, low), (left + k * size_mm, high)) for k in range(boxes)
    ]
    sheet = Sheet.of(inked(row, *bars, width_mm=0.3, dpi=200, seed=3))
    stroke = sheet.stroke(int(selection.lines_of(sheet)[0]))
    view = view_of(sheet, None, stroke.width_mm)
    ends = at_ends(view, sheet, stroke, 0.5, None)
    assert all(end.reference_mm is None for end in ends)


RING = arc((15, 15), 3.0)


@pytest.mark.parametrize(
    ("beside", "may"),
    [
        ([], False),
        ([arc((15, 15), 9.0)], False),  # round it, at 5.5 mm
        ([arc((15, 15), 5.5)], True),
        ([polyline((20, 10), (20, 20))], True),
        ([polyline((17.1, 17.1), (18.4, 18.4))], True),  # a tail, within the ring's own square
    ],
)
def test_a_ring_leads_somewhere_only_if_other_ink_is_near_or_a_line_leaves_it(
    beside: list[np.ndarray], may: bool
) -> None:
    sheet = Sheet.of(inked(RING, *beside, seed=3))
    ring = sheet.stroke(sheet.patch_at(RING[0]))
    assert reference.may_lead(sheet, ring) == may


def test_what_goes_round_no_ring_leads_nowhere() -> None:
    sheet = Sheet.of(inked(arc((15, 15), 7.0), seed=3))
    assert not reference.may_lead(sheet, sheet.stroke(0))


def test_a_frame_of_two_slots_leads_nowhere() -> None:
    """Neither hole is about as wide as high, so neither is a ring that the other could lead from."""
    frame = polyline((10, 10), (22, 10), (22, 13), (10, 13), (10, 10))
    bar = polyline((16, 10), (16, 13))
    sheet = Sheet.of(inked(frame, bar, seed=3))
    assert not reference.may_lead(sheet, sheet.stroke(0))


@pytest.mark.parametrize(
    ("besides", "sure"),
    [([], False), ([arc((22.5, 15), 2.5)], True), ([arc((29, 15), 9)], True)],
)
def test_a_ring_is_sure_if_its_ink_goes_round_a_contour_besides(
    besides: list[np.ndarray], sure: bool
) -> None:
    """A small contour, which lies elsewhere, or a large one."""
    sheet = Sheet.of(inked(RING, polyline((18, 15), (20, 15)), *besides, seed=3))
    ring = Reference((15.0, 15.0), "ring")
    assert not sheet.bare_rings
    assert ring.is_sure(sheet, sheet.patch_at(RING[0])) == sure
