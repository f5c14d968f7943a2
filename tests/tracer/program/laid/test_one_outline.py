"""A patch of ink that is one outline, with bays and stalks whose necks are narrower than two lines."""

from __future__ import annotations

import numpy as np
import pytest
import shapely

from morfax.motion.arrays import Array
from morfax.motion.polyline import length_mm, nearest_mm, with_places
from morfax.tracer.following.line import Line
from morfax.tracer.head.settings import Settings
from morfax.tracer.operator.operator import Operator
from morfax.tracer.program.laid.explained import explained
from morfax.tracer.program.laid.joined_ways import crossings_mm, uncrossed
from morfax.tracer.program.laid.one_outline import as_one_outline
from morfax.tracer.program.setup import Setup
from morfax.tracer.program.trace_lines import trace_lines
from tests.tracer.inked import UM, Points, arc, inked, polyline
from tests.tracer.program.laid.ways import run_along

WIDTH_MM = 0.5
NECK_MM = 0.35  # between the middles of its sides: their ink is 0.85 mm broad


def land() -> Points:
    """A plate with a bay within it, and a stalk with a head below it."""
    bay = shapely.Polygon([(18, 27), (24, 27.5), (25, 22), (17, 21)])
    head = shapely.Polygon([(34, 2), (42, 3), (40, 7), (35, 7)])
    mouth = shapely.box(21 - NECK_MM / 2, 27, 21 + NECK_MM / 2, 36)
    neck = shapely.box(37 - NECK_MM / 2, 6.5, 37 + NECK_MM / 2, 11)
    plate = shapely.box(10, 10, 50, 35).difference(bay.union(mouth)).union(head.union(neck))
    return polyline(*plate.exterior.coords)


def plate_alone() -> Points:
    """The same without bay and stalk, as the head may take it."""
    return polyline((10, 10), (50, 10), (50, 35), (10, 35), (10, 10))


def setup_of(*drawn: Points) -> Setup:
    """A scan of some lines."""
    return Setup(inked(*drawn, width_mm=WIDTH_MM, seed=1).sheet, Settings(), Operator())


def off_mm(line: Line, truth: Points) -> float:
    """How far a closed line is from the truth, or that from it, at most, mm."""
    way, true = with_places(line.loop_mm, 0.02), with_places(np.asarray(truth), 0.02)
    return max(nearest_mm(way, true).max(), nearest_mm(true, way).max())


def as_one(*drawn: Points, found: list[Points]) -> Line | None:
    """The one line that the longest patch of a scan is, where some lines were found."""
    setup = setup_of(*drawn)
    lines = [run_along(way) for way in found]
    outline = as_one_outline(setup, setup.sheet.longest().patch, lines)
    return None if outline is None else outline.line


def test_where_the_head_passed_a_bay_and_a_stalk_by_the_line_goes_round_both() -> None:
    """Each rim passes one of them by: they are joined. Corners in the necks show within 60 um."""
    line = as_one(land(), found=[plate_alone()])
    assert line is not None and line.ending == "closed"
    assert off_mm(line, land()) < 60 * UM


def test_what_the_head_took_for_several_lines_becomes_one() -> None:
    """A plate, its bay and its stalk, as a head takes them that goes straight on at each neck."""
    bay = polyline((18, 27), (24, 27.5), (25, 22), (17, 21), (18, 27))
    head = polyline((34, 2), (42, 3), (40, 7), (35, 7), (34, 2))
    setup = setup_of(land())
    told = explained(setup, [run_along(way) for way in (plate_alone(), bay, head)])
    assert [line.ending for line in told.lines] == ["closed"] and not told.left
    assert told.one == {setup.sheet.longest().patch}
    assert off_mm(told.lines[0], land()) < 60 * UM


def test_a_patch_without_a_line_leaves_more_of_its_ink_than_any_line() -> None:
    setup = setup_of(land())
    outline = as_one_outline(setup, setup.sheet.longest().patch, [run_along(plate_alone())])
    assert outline is not None
    assert outline.left([]) > outline.left(outline.found) > outline.left([outline.line])


def test_lines_that_explain_their_ink_stay() -> None:
    assert as_one(land(), found=[land()]) is None


def test_a_line_that_ends_on_an_outline_is_no_part_of_it() -> None:
    """It would be cut twice, out and back."""
    tick = polyline((30, 35), (30, 45))
    room = polyline((20, 35), (20, 41), (24, 41), (24, 35))
    assert as_one(plate_alone(), tick, room, found=[plate_alone()]) is None


def test_plates_that_share_a_side_are_not_one_outline_about_both() -> None:
    """The side between them would be left bare, which the line that was found goes along."""
    first = polyline((10, 10), (30, 10), (30, 25), (10, 25), (10, 10))
    second = polyline((30, 10), (45, 12), (44, 25), (30, 25), (30, 10))
    assert as_one(first, second, found=[first]) is None


def test_circles_that_cross_are_not_one_line_that_turns_off_at_each_crossing() -> None:
    small, large = arc((22, 24), 9, 0, 360), arc((32, 22), 11, 0, 360)
    assert as_one(small, large, found=[large]) is None


def test_ink_as_broad_as_another_line_of_the_sheet_is_that_and_no_neck() -> None:
    """The head of the stalk hangs on a line of 0.85 mm, and so does nothing else on the sheet."""
    broad = [
        polyline((60 + side * NECK_MM / 2, 10), (60 + side * NECK_MM / 2, 35))
        for side in (-1, 1)
    ]
    assert as_one(land(), *broad, found=[plate_alone()]) is None


def test_rooms_behind_one_another_are_traced_from_the_sheet() -> None:
    """From end to end, each with a neck of 0.35 mm."""
    inner = shapely.Polygon([(20, 15), (27, 15), (26, 19), (21, 19)])
    mouth = shapely.box(23.5 - NECK_MM / 2, 18, 23.5 + NECK_MM / 2, 22)
    plate = shapely.Polygon(np.asarray(land())).difference(inner.union(mouth))
    truth = polyline(*plate.exterior.coords)
    told = trace_lines(inked(truth, width_mm=WIDTH_MM, seed=2))
    assert [line.ending for line in told.lines] == ["closed"] and not told.unexplained
    assert off_mm(told.lines[0], truth) < 80 * UM


def eight(crossed_mm: float) -> Array:
    """Two rings that are run as one eight, so long each, without the first place again."""
    t = np.linspace(0, 2 * np.pi, 400, endpoint=False) + 0.01
    size_mm = crossed_mm / 6.1
    return np.column_stack([size_mm * np.sin(t), size_mm * np.sin(t) * np.cos(t)])


@pytest.mark.parametrize("long_mm", [60.0, 1.0])
def test_a_way_that_crosses_itself_touches_itself_there_or_loses_a_short_loop(
    long_mm: float,
) -> None:
    """As long as before, but for the place of the crossing; of loops below 2 mm one goes."""
    way = eight(long_mm)
    assert len(crossings_mm(way)) == 1
    clear = uncrossed(way, WIDTH_MM)
    assert not len(crossings_mm(clear))
    short = 1.0 if long_mm > 10 else 0.5
    assert length_mm(clear) == pytest.approx(short * length_mm(way), rel=0.02)
