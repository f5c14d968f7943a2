"""Within the rim of its ink a way goes round a bay from end to end of a stretch, and never crosses itself."""

from __future__ import annotations

import math

import numpy as np
import pytest
import shapely

from morfax.motion.crossings import crossings_of
from morfax.motion.polyline import evenly, length_mm, nearest_mm, with_places
from morfax.tracer.program.laid import rim_bays as rims
from morfax.tracer.program.laid.laid_way import LaidWay
from morfax.tracer.program.laid.rim_bays import is_a_pen, rim_bays, ways_within_rims
from morfax.tracer.program.setup import Setup
from morfax.tracer.program.trace_lines import trace_lines
from morfax.tracer.sensing import photocell
from tests.tracer.inked import UM, WIDTH_MM, Points, arc, inked, polyline, together

NOWHERE = np.empty((0, 2))


def plate(*inner: tuple[float, float]) -> Points:
    """The outline of a plate with some places in its upper side."""
    return polyline((4, 4), (34, 4), (34, 20), *inner, (4, 20), (4, 4))


SLIT = plate(
    (18.5, 20), (18.5, 14), (18, 14), (18, 20)
)  # as wide as the pen: its sides run together
OVER = with_places(
    polyline((19.6, 20), (16.9, 20)), 0.05
)  # the head went straight over its mouth


def ways(drawn: Points, own: Points, *others: Points) -> tuple[list[LaidWay], list[LaidWay]]:
    """The ways within the rims from the first place of a stretch to its last, and which of them are bays."""
    setup = Setup(inked(drawn, *others, seed=1).sheet)
    beyond = with_places(polyline((18.25, 19.5), (18.25, 14.2)), 0.05)
    every = ways_within_rims(setup, WIDTH_MM, own, beyond)
    return list(every), list(rim_bays(setup, WIDTH_MM, own, beyond))


def test_a_slit_that_the_head_passed_by_has_its_way_within_the_rim() -> None:
    """Down one side and up the other, within 60 um, 0.7 of a pixel, in that direction."""
    every, bays = ways(SLIT, OVER)
    (bay,) = bays
    assert bay.way[0] == pytest.approx(OVER[0]) and bay.way[-1] == pytest.approx(OVER[-1])
    truth = polyline((19.6, 20), (18.5, 20), (18.5, 14), (18, 14), (18, 20), (16.9, 20))
    apart_mm = shapely.LineString(bay.way).hausdorff_distance(shapely.LineString(truth))
    assert apart_mm < 60 * UM
    assert bay.half_mm == 0.5 * WIDTH_MM
    assert all(not len(crossings_of(each.way, np.arange(len(each.way) - 1))) for each in every)


def test_the_cells_for_it_see_no_more_than_what_is_about_the_stretch(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """All of the sheet was made for each bay; what they see is the same."""
    (bay,) = ways(SLIT, OVER)[1]
    monkeypatch.setattr(photocell, "near_ink", None)  # nobody asks for the whole sheet
    (again,) = ways(SLIT, OVER)[1]
    assert np.array_equal(bay.way, again.way)


def test_a_bay_is_left_over_a_width_and_a_half_where_the_head_ran_aside() -> None:
    """It ran 0.08 mm below its line; half of a leg from its ends the way is half as far off, within 20 um."""
    _, (bay,) = ways(SLIT, OVER - np.array((0.0, 0.08)))
    for x in (19.6 - 0.375, 16.9 + 0.375):
        beside = bay.way[np.abs(bay.way[:, 0] - x) < 0.03]
        assert beside[:, 1] == pytest.approx(19.96, abs=0.02)


def test_a_stretch_that_is_not_on_the_rims_way_has_none() -> None:
    """Half a millimetre below the line, as wide as the line is; both its ends, or one of them."""
    off = np.array((0.0, 1.5 * WIDTH_MM))
    assert ways(SLIT, OVER - off) == ([], [])
    for end in (0, -1):
        own = OVER.copy()
        own[end] -= off
        assert ways(SLIT, own) == ([], [])


@pytest.mark.parametrize("out_mm", [1.0, 3.0])
def test_a_tick_of_one_line_is_no_bay(out_mm: float) -> None:
    """Within its rim the way goes out along the one line and back: between there and back is nothing."""
    own = with_places(polyline((19.6, 20), (16.9, 20)), 0.05)
    tick = polyline((18.25, 20), (18.25, 20 - out_mm))
    every, bays = ways(plate(), own, tick)
    assert every and not bays


def test_a_stretch_beside_which_the_rim_is_no_longer_than_itself_is_no_bay() -> None:
    own = with_places(polyline((26, 20), (22, 20)), 0.05)
    every, bays = ways(plate(), own)
    assert every and not bays
    assert min(abs(length_mm(each.way) - 4.0) for each in every) < 20 * UM


def test_a_way_comes_to_the_ends_of_its_stretch_over_a_leg() -> None:
    """Its middle stays where it is; of a short way at least a fifth does."""
    way = with_places(polyline((0, 0), (10, 0)), 0.1)
    ends = np.array([[0.0, 0.2], [10.0, -0.1]])
    moved = rims.to_ends(way, ends, 1.5)
    assert moved[[0, -1]] == pytest.approx(ends)
    off_mm = moved[:, 1] - way[:, 1]
    assert np.all(off_mm[(way[:, 0] > 1.5) & (way[:, 0] < 8.5)] == 0)
    assert off_mm[way[:, 0] < 1.5] == pytest.approx(0.2 * (1 - way[way[:, 0] < 1.5, 0] / 1.5))
    assert off_mm[way[:, 0] > 8.5] == pytest.approx(
        -0.1 * (way[way[:, 0] > 8.5, 0] - 8.5) / 1.5
    )
    short = rims.to_ends(way[:11], ends - [[0, 0], [9, 0]], 1.5)
    assert np.all(short[5] == way[5]) and short[[0, -1]] == pytest.approx(
        ends - [[0, 0], [9, 0]]
    )


def test_small_loops_of_a_way_become_corners_and_large_ones_stay() -> None:
    """Two round ends as narrow as the pen, where the way crosses itself: at (9.67, 0.5) and (0.33, 2.5)."""
    first = polyline((0, 0.4), (9, 0.4), (10, 0.55), (10.2, 0.5), (10, 0.45), (9, 0.6))
    second = polyline((9, 2.4), (1, 2.4), (0, 2.55), (-0.2, 2.5), (0, 2.45), (1, 2.6), (9, 2.6))
    way = np.vstack([first, second])
    cut = rims.with_corners_for_loops(way, 2.0)
    assert not len(crossings_of(cut, np.arange(len(cut) - 1)))
    assert nearest_mm(np.array([[29 / 3, 0.5], [1 / 3, 2.5]]), cut).max() < 1e-9
    assert len(cut) == len(way) - 4
    assert cut[:2] == pytest.approx(way[:2]) and cut[-2:] == pytest.approx(way[-2:])
    assert np.array_equal(rims.with_corners_for_loops(way, 0.5), way)


def test_a_bar_is_a_pens_if_a_line_of_the_sheet_is_as_broad() -> None:
    """Within 15 % of it."""
    lines = (polyline((5, 5), (35, 5)), 0.5), (polyline((5, 10), (35, 10)), 1.0)
    sheet = together(*lines).sheet
    broad = [0.4, 0.5, 0.75, 0.9, 1.0, 1.1, 1.3]
    assert [is_a_pen(sheet, each) for each in broad] == [
        False,
        True,
        False,
        True,
        True,
        True,
        False,
    ]


def foot(long_mm: float, gap: float, radius: float, lean_deg: float) -> Points:
    """A plate on a foot to the left: its upper side so many widths above the lower, and its leg joined to it
    by a bend of so many widths.
    """
    gap_mm, radius_mm, lean = gap * WIDTH_MM, radius * WIDTH_MM, math.radians(lean_deg)
    bend = arc((10, 5 + gap_mm + radius_mm), radius_mm, lean_deg, -90)
    top = bend[0] + 9 * np.array([-math.sin(lean), math.cos(lean)])
    end = 10 - long_mm
    return np.vstack([top, bend, [(end, 5 + gap_mm), (end, 5), (24, 5), (24, top[1]), top]])


@pytest.mark.parametrize(
    ("long_mm", "gap", "radius"), [(0.8, 1.0, 0.9), (1.2, 1.0, 0.9), (1.6, 0.8, 0.5)]
)
def test_a_foot_whose_sides_run_together_is_no_loop(
    long_mm: float, gap: float, radius: float
) -> None:
    """The way that came by over its ink and back was 0.2 mm off, and told; that within the rim turns less."""
    drawn = foot(long_mm, gap, radius, 10)
    trace = trace_lines(inked(drawn, width_mm=WIDTH_MM, seed=3), "contours")
    (line,) = trace.lines
    way, true = with_places(line.loop_mm, 0.02), with_places(drawn, 0.02)
    assert max(nearest_mm(way, true).max(), nearest_mm(true, way).max()) < 60 * UM
    assert not trace.unexplained


def test_a_stretch_whose_ends_lie_at_one_place_of_a_way_has_no_part_of_it() -> None:
    """It comes round to where it began: of a part of no length the ends were not numbers."""
    way = evenly(polyline((0, 0), (4, 0), (4, 4), (0, 4), (0, 0)), 0.1)[:-1]
    own = polyline((2, 0.05), (2.5, 0.05), (2.5, 1), (1.5, 1), (1.5, 0.05), (2, 0.05))
    parts = list(rims._between(way, own, 2.0))
    assert all(len(part) > 1 and np.isfinite(part).all() for part in parts)
