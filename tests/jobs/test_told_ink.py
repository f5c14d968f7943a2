"""What a job says of its ink: a pen that skips, pale lines."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Literal

import numpy as np
import pytest

from morfax.jobs.listener import Silent
from morfax.jobs.remarks.on_ink import of_ink
from morfax.jobs.remarks.on_unexplained import of_unexplained
from morfax.jobs.remarks.remarks import remarks
from morfax.jobs.settings.line_settings import LineSettings
from morfax.jobs.settings.settings import TraceSettings
from morfax.jobs.tracing.tracing import Tracing
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.operator.operator import Operator
from morfax.tracer.program.against_ink.unexplained import Unexplained
from morfax.tracer.program.lines.selection import Others
from morfax.tracer.program.setup import Setup
from morfax.tracer.program.survey import survey
from morfax.tracer.program.trace import trace
from morfax.tracer.program.trace_ink import trace_ink
from tests.tracer.drawing.test_skips import ring
from tests.tracer.ink.test_pale import with_pale_bar
from tests.tracer.inked import Points, arc, cross, inked, polyline


class Heard(Silent):
    """A listener that keeps what it hears."""

    def __init__(self) -> None:
        self.said = list[str]()

    def note(self, text: str) -> None:
        self.said.append(text)

    def warning(self, text: str) -> None:
        self.said.append(text)


def said_of(drawing: Drawing, line: LineSettings) -> tuple[list[str], list[str]]:
    """What is said of a drawing, and how its lines end."""
    heard = Heard()
    traced = Tracing.prepared(TraceSettings(line)).trace(drawing, heard)
    return heard.said, [line.ending for line in traced.trace.lines]


def test_skips_are_crossed_and_told_unless_a_gap_is_set() -> None:
    drawing = inked(*ring(0.7, 0.7, 0.7, 0.7), seed=1)
    said, endings = said_of(drawing, LineSettings())
    assert endings == ["closed"] and any("the pen has skipped" in text for text in said)
    said, endings = said_of(drawing, LineSettings(gap_mm=0.5))
    assert endings == ["ended"] and not any("skipped" in text for text in said)


@pytest.mark.parametrize(
    ("ending", "share", "is_told"),
    [("ended", 0.8, True), ("ended", 0.95, False), ("closed", 0.8, False)],
)
def test_the_ink_beyond_the_end_of_a_line_is_told(
    ending: Literal["ended", "closed"], share: float, is_told: bool
) -> None:
    """A line that comes round may cross others; one that ends should end where its ink does."""
    drawn = trace(inked(polyline((4, 5), (24, 5), (24, 15)), seed=1))
    (line,) = drawn.lines
    line = replace(line, ending=ending, ink_mm=line.length_mm / share)
    said = of_ink(replace(drawn, lines=(line,)), several=False)
    assert any("joined to the line was not followed" in text for text in said) == is_told


@pytest.mark.parametrize(("stem_mm", "is_told"), [(0.1, False), (5.0, True)])
def test_a_line_that_leads_to_a_contour_is_told_and_a_touch_is_none(
    stem_mm: float, is_told: bool
) -> None:
    """On a sewing pattern "the line from 188.3,48.3 to the contour at 188.3,48.3 mm" was told."""
    drawn = trace(inked(arc((20.0, 20.0), 10.0), seed=1))
    (line,) = drawn.lines
    away_mm = np.hypot(*(line.xy_mm - line.xy_mm[0]).T)
    line = replace(line, loop_from=int(np.argmax(away_mm > stem_mm)))
    said = remarks(replace(drawn, lines=(line,)), TraceSettings(LineSettings()), 0.5, 1.0)
    assert any("is cut too" in text for text in said) == is_told


def test_a_hole_in_pieces_is_told_and_the_advice_follows_it() -> None:
    """A hole of 2.5 mm radius in five pieces of 2.4 mm, in a ring in which the pen has skipped."""
    hole = [arc((20.0, 20.0), 2.5, 72.0 * k, 72.0 * k + 45) for k in range(5)]
    drawing = inked(*ring(0.7, 0.7, 0.7, 0.7), *hole, seed=1)
    said, endings = said_of(drawing, LineSettings(lines="contours"))
    assert (
        endings == ["closed"] and len([text for text in said if "5 pieces of ink" in text]) == 1
    )
    said, endings = said_of(drawing, LineSettings(lines="all"))
    assert len(endings) > 1 and not any("pieces of ink" in text for text in said)
    said, _ = said_of(inked(*ring(0.7, 0.7, 0.7, 0.7), seed=1), LineSettings(lines="contours"))
    assert not any("pieces of ink" in text for text in said)


def test_pale_lines_are_told_where_all_ink_is_asked_for() -> None:
    said, _ = said_of(with_pale_bar(0.3), LineSettings(lines="all"))
    assert any("mm of line (17 %) are left out" in text for text in said)
    said, _ = said_of(with_pale_bar(0.0), LineSettings(lines="all"))
    assert not any("left out" in text for text in said)


def test_ink_that_was_left_is_told_with_the_place_of_its_longest_stretch() -> None:
    found = trace_ink(inked(polyline((10, 10), (50, 10)), seed=1))
    assert found.ink is not None

    def said(lost: tuple[tuple[float, float, float], ...]) -> str:
        ink = found.ink._replace(left_mm=5.0, lost=lost) if found.ink else None
        (text,) = (t for t in of_ink(replace(found, ink=ink), several=True) if "could not" in t)
        return text

    assert "5 mm of ink (11 %)" in said(()) and "too short to list" in said(())
    told = said(((30.0, 20.0, 3.5), (12.0, 13.0, 1.5)))
    assert "3.5 mm, at 30.0,20.0 mm" in told and "the figures list" in told


def open_where(line: LineSettings, places_mm: Points) -> tuple[list[str], list[str]]:
    """What is said of a line that is perhaps closed, and how its lines end."""
    said, endings = said_of(inked(places_mm, width_mm=0.6, seed=1), line)
    return [text for text in said if "if you mean a closed line" in text], endings


def test_a_line_that_runs_past_its_own_end_is_told_and_the_advice_closes_it() -> None:
    """A tip of two lines in one, narrower than they are: the head is put down in it."""
    turns = np.linspace(0, 2 * np.pi, 600)
    radii = 18 + 3 * np.cos(3 * turns)
    round_mm = 30 + radii[:, None] * np.column_stack([np.cos(turns), np.sin(turns)])
    tip_mm = round_mm[100] + [[4.0, 6.0]]
    tufted = np.vstack([round_mm[:101], tip_mm, round_mm[103:]])
    (said,), endings = open_where(LineSettings(), tufted)
    assert endings == ["ended"] and "--lines contours takes it" in said
    assert open_where(LineSettings(lines="contours"), tufted) == ([], ["closed"])


def test_a_line_without_one_of_its_corners_is_told() -> None:
    cornerless = polyline((8.0, 8.8), (10, 40), (40, 42), (42, 10), (8.8, 8.2))
    (said,), endings = open_where(LineSettings(), cornerless)
    assert endings == ["ended"] and "morfax correct --bridge" in said
    assert open_where(LineSettings(), cornerless[:-1]) == ([], ["ended"])


@pytest.mark.parametrize(
    ("others", "said"),
    [
        (Others(1, 0, 30.4), "the sheet has 1 other line of about 30 mm: --lines"),
        (Others(1, 0, 50.4), "1 other line of about 50 mm: --lines"),
        (Others(1, 0, 277.0), "1 other line of about 277 mm, longer than this one: --lines"),
        (
            Others(3, 2, 277.0),
            "3 other lines, the longest of about 277 mm, longer than this one, 2 of them",
        ),
    ],
)
def test_a_plain_trace_tells_how_long_the_longest_other_line_is(
    others: Others, said: str
) -> None:
    """A signature's underline was taken, 98 mm, and its strokes of 277 mm, which cross, were not."""
    traced = trace(inked(polyline((5, 5), (55, 9)), seed=1))
    (told,) = of_ink(replace(traced, others=others), several=False)
    assert told.startswith("one line of 50 mm is traced; ") and said in told


PLATE = polyline((5, 5), (70, 5), (70, 45), (5, 45), (5, 5))
HOLE_AND_SLIT = (arc((25.0, 25.0), 4.0), polyline((32, 25), (60, 25)))


CONTOURS = TraceSettings(LineSettings(lines="contours"))


def marked(marks: Literal["auto", "on", "off"]) -> TraceSettings:
    """Contours, where the operator says what marks are."""
    return replace(CONTOURS, program=replace(CONTOURS.program, marks=marks))


@pytest.mark.parametrize("times", [0.5, 1.0, 2.0])
def test_a_hole_near_an_open_line_is_cut_at_any_size_and_told_with_what_makes_it_a_reference_point(
    times: float,
) -> None:
    """A hole of 4 to 16 mm with a slit beside it: of these, 4 and 8 mm are a reference point's size."""
    lines = [times * line for line in (PLATE, *HOLE_AND_SLIT)]
    drawing, heard = inked(*lines, width_mm=0.5 * times, seed=1), Heard()
    traced = Tracing.prepared(CONTOURS).trace(drawing, heard)
    by_number = sorted(traced.trace.lines, key=lambda line: line.number)
    assert [line.ending for line in by_number] == ["closed", "ended", "closed"]
    assert traced.trace.reference_mm is None
    told = [text for text in heard.said if "give --marks on" in text]
    assert len(told) == (times < 2)
    if told:
        assert (
            f"the ring at {25 * times:.1f},{25 * times:.1f} mm is cut as a hole, line 3"
            in told[0]
        )
        program = Tracing.prepared(marked("on")).trace(drawing, Heard())
        assert program.trace.reference_mm == pytest.approx((25 * times, 25 * times), abs=0.05)


def test_a_ring_whose_line_leads_to_a_contour_is_told_as_reference_point_and_marks_off_cuts_it() -> (
    None
):
    drawing = inked(
        arc((25.0, 25.0), 4.0), polyline((32, 25), (50, 25)), PLATE + np.array([45, 0]), seed=1
    )
    heard = Heard()
    traced = Tracing.prepared(CONTOURS).trace(drawing, heard)
    assert traced.trace.reference_mm == pytest.approx((25, 25), abs=0.05)
    (told,) = [text for text in heard.said if "the ring at 25.0,25.0 mm" in text]
    assert "give --marks off" in told
    heard = Heard()
    traced = Tracing.prepared(marked("off")).trace(drawing, heard)
    assert len(traced.trace.lines) == 2 and not any("the ring" in text for text in heard.said)


def test_a_ring_near_a_stroke_of_a_part_is_a_hole_of_it_where_the_stroke_leads_to_no_contour() -> (
    None
):
    """A colouring page's freckle near the tip of a fin's line: taken for the reference point, it was not cut,
    nor was the outline of what it is drawn on.
    """
    fin = polyline((34, 34), (42, 24), (47, 13.4)), polyline((42, 24), (72, 30))
    drawing = inked(arc((42.0, 32.0), 30.0), *fin, arc((27.0, 40.0), 1.6), seed=1)
    heard = Heard()
    trace = Tracing.prepared(CONTOURS).trace(drawing, heard).trace
    assert trace.reference_mm is None and not any("tool up" in text for text in heard.said)
    endings = {round(line.length_mm): line.ending for line in trace.lines}
    assert endings[round(math.tau * 1.6)] == endings[round(math.tau * 30)] == "closed"
    assert not any(entry.is_reference for entry in survey(Setup(drawing.sheet)).entries)
    program = Tracing.prepared(marked("on")).trace(drawing, Heard()).trace
    assert program.reference_mm == pytest.approx((27, 40), abs=0.05)
    means_program = Setup(drawing.sheet, operator=Operator(marks="on"))
    assert any(entry.is_reference for entry in survey(means_program).entries)


def test_a_cross_that_a_program_begins_with_is_not_told() -> None:
    """Nobody would cut it."""
    heard = Heard()
    drawing = inked(PLATE, *cross((25.0, 25.0)), HOLE_AND_SLIT[1], seed=1)
    contours = TraceSettings(LineSettings(lines="contours"))
    traced = Tracing.prepared(contours).trace(drawing, heard)
    assert traced.trace.reference_mm == pytest.approx((25, 25), abs=0.05)
    assert not any("reference point" in text for text in heard.said)


def test_a_line_close_to_a_contour_is_a_contour_too() -> None:
    """Two rings 1.4 widths apart, joined by four short strokes: ink so near counted as the other's way."""
    radii_mm = 20.0, 19.3
    bars = [
        polyline(*[(24 + r * math.cos(a), 24 + r * math.sin(a)) for r in radii_mm])
        for a in (0.3, 1.9, 3.6, 5.0)
    ]
    drawing = inked(*[arc((24, 24), r) for r in radii_mm], *bars, seed=1)
    for lines in ("contours", "all"):
        said, endings = said_of(drawing, LineSettings(lines=lines))
        assert endings == ["closed", "closed"] and said == []


def test_a_bar_across_a_contour_is_told_and_the_advice_follows_it() -> None:
    """A ring of 20 mm with a line from side to side."""
    drawing = inked(arc((24, 24), 20.0), polyline((4, 24), (44, 24)), seed=1)
    said, endings = said_of(drawing, LineSettings(lines="contours"))
    (told,) = [text for text in said if "joined to the contours was not followed" in text]
    assert endings == ["closed"] and "--lines all follows all of it" in told
    assert float(told.split()[1]) == pytest.approx(40.0, rel=0.1)
    said, endings = said_of(drawing, LineSettings(lines="all"))
    assert sorted(endings) == ["closed", "ended"] and said == []


@pytest.mark.parametrize(
    ("count", "named"),
    [(1, "at 1.0,5.0 mm:"), (4, "at 1.0,5.0 mm (then 2.0,5.0 and 3.0,5.0 mm):")],
)
def test_of_many_places_the_worst_three_are_named(count: int, named: str) -> None:
    found = trace_ink(inked(polyline((4, 14), (24, 14)), seed=1))
    places = tuple(Unexplained((k, 5.0), 9.0 - k, "beside") for k in range(1, count + 1))
    (said,) = of_unexplained(replace(found, unexplained=places))
    assert f"{count} place" in said and "the longest 8.0 mm" in said and named in said
