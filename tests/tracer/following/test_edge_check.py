"""A run along edges that are known: right all along, or a fault with its place."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.known_edges import KnownEdges
from morfax.tracer.following.edge_check import OFF_MM, kept_to
from morfax.tracer.following.followed import Followed
from morfax.tracer.following.line import Line
from morfax.tracer.program.against_ink.unexplained import Unexplained, _off_edges, _once
from morfax.tracer.sensing.photocell import Cells
from morfax.tracer.sensing.view import View
from tests.tracer.inked import Points, arc, polyline

SQUARE = polyline((10, 10), (30, 10), (30, 30), (10, 30), (10, 10))
HOLE = arc((20, 20), 4)
EDGES = (SQUARE, HOLE)
VIEW = View(Cells(np.zeros((4, 4), np.float32), 0.1, 0.5), 0.4)


def along(line: Points, ending: str = "closed") -> Followed:
    """A run along a polyline, a position every hundredth."""
    s = np.r_[0.0, np.cumsum(np.hypot(*np.diff(line, axis=0).T))]
    at = np.arange(0, s[-1], 0.01)
    positions = np.column_stack([np.interp(at, s, column) for column in line.T])
    return Followed(positions, ending, 0.0, float(s[-1]), VIEW, ())


@pytest.mark.parametrize("line", [SQUARE, HOLE, SQUARE + np.array([0.0, 0.8 * OFF_MM])])
def test_a_run_on_its_edge_stays_as_it_is(line: Points) -> None:
    run = along(line)
    assert kept_to(KnownEdges(EDGES), run) is run


def test_lines_have_no_edges_to_keep_to() -> None:
    run = along(HOLE + 5.0)
    assert kept_to(KnownEdges(()), run) is run


def test_a_run_that_leaves_the_edge_is_lost_where_it_does() -> None:
    run = along(
        polyline(
            (10, 10), (20, 10), (20.5, 10.9), (21, 10), (30, 10), (30, 30), (10, 30), (10, 10)
        )
    )
    kept = kept_to(KnownEdges(EDGES), run)
    assert kept.ending == "lost" and kept.fault is not None
    assert abs(kept.travel_mm - 10) < 0.3 and np.allclose(
        kept.positions_mm[-1], [20, 10], atol=0.3
    )
    assert (
        kept.fault.x_mm == pytest.approx(kept.positions_mm[-1, 0]) and kept.fault.exit_code == 4
    )
    assert "edge lost at 20" in str(kept.fault) and "it goes 0.89 mm away" in str(kept.fault)


def toothed(high_mm: float) -> Points:
    """The square with a tooth 0.3 mm wide on its lower side, inwards."""
    tooth = [(20, 10), (20, 10 + high_mm), (20.3, 10 + high_mm), (20.3, 10)]
    return polyline((10, 10), *tooth, (30, 10), (30, 30), (10, 30), (10, 10))


def test_a_closed_run_that_leaves_some_of_its_edge_out_is_lost() -> None:
    """A tooth 0.3 mm wide and 2 mm high is cut across: no place of the run is off the edge, but the tooth is
    missed.
    """
    kept = kept_to(KnownEdges((toothed(2.0), HOLE)), along(SQUARE))
    assert kept.ending == "lost" and "it passes some of the edge 2.0" in str(kept.fault)
    assert 9.5 < kept.travel_mm < 10.8


def test_what_an_open_run_has_not_come_to_is_no_fault() -> None:
    run = along(SQUARE[:3], "ended")
    assert kept_to(KnownEdges(EDGES), run) is run
    assert kept_to(KnownEdges(EDGES), replace(run, ending="closed")).ending == "lost"


@pytest.mark.parametrize("high_mm", [0.4, 1.2, 3.5])
def test_where_pixels_are_large_a_tooth_that_is_passed_by_is_told_and_not_lost(
    high_mm: float,
) -> None:
    """At 50 dpi six pixels are 3 mm: a lens that is as soft as a pixel may show that little of a tip."""
    coarse = replace(VIEW, cells=VIEW.cells._replace(pitch_mm=0.5))
    for edge, way in ((toothed(high_mm), SQUARE), (SQUARE, toothed(high_mm))):
        run = replace(along(way), view=coarse)
        kept = kept_to(KnownEdges((edge,)), run)
        assert (kept is run) == (high_mm < 3)
        drawing = Drawing(np.zeros((8, 8), np.float32), 0.5, edges_mm=(edge,))
        told = list(_off_edges(drawing, [Line(run.positions_mm, "closed", 0.4, 80.0)]))
        if high_mm < 0.5:
            assert told == []
        else:
            (place,) = told
            assert place.kind == "tip" and place.length_mm == pytest.approx(high_mm, abs=0.05)
            assert place.place_mm == pytest.approx((20.15, 10 + high_mm), abs=0.2)


def test_a_tip_at_which_edge_and_way_are_off_is_told_once() -> None:
    places = [((5.0, 5.0), 0.6), ((0.5, 0.0), 0.9), ((0.0, 0.0), 1.0)]
    told = _once([Unexplained(place_mm, off_mm, "tip") for place_mm, off_mm in places])
    assert [place.length_mm for place in told] == [1.0, 0.6]


def test_where_no_line_closed_nothing_is_off_its_edge() -> None:
    """A line that ran into itself has come round, and is no edge."""
    drawing = Drawing(np.zeros((8, 8), np.float32), 0.5, edges_mm=(SQUARE,))
    assert list(_off_edges(drawing, [])) == []
