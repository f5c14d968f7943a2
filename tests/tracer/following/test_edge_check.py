"""A run along edges that are known: right all along, or a fault with its place."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from morfax.tracer.following.edge_check import OFF_MM, kept_to
from morfax.tracer.following.followed import Followed
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
    assert kept_to(EDGES, run) is run


def test_lines_have_no_edges_to_keep_to() -> None:
    run = along(HOLE + 5.0)
    assert kept_to((), run) is run


def test_a_run_that_leaves_the_edge_is_lost_where_it_does() -> None:
    run = along(
        polyline(
            (10, 10), (20, 10), (20.5, 10.9), (21, 10), (30, 10), (30, 30), (10, 30), (10, 10)
        )
    )
    kept = kept_to(EDGES, run)
    assert kept.ending == "lost" and kept.fault is not None
    assert abs(kept.travel_mm - 10) < 0.3 and np.allclose(
        kept.positions_mm[-1], [20, 10], atol=0.3
    )
    assert (
        kept.fault.x_mm == pytest.approx(kept.positions_mm[-1, 0]) and kept.fault.exit_code == 4
    )
    assert "edge lost at 20" in str(kept.fault) and "it goes 0.89 mm away" in str(kept.fault)


def test_a_closed_run_that_leaves_some_of_its_edge_out_is_lost() -> None:
    """A tooth 0.3 mm wide and 2 mm high is cut across: no place of the run is off the edge, but the tooth is
    missed.
    """
    tooth = polyline(
        (10, 10),
        (20, 10),
        (20, 12),
        (20.3, 12),
        (20.3, 10),
        (30, 10),
        (30, 30),
        (10, 30),
        (10, 10),
    )
    kept = kept_to((tooth, HOLE), along(SQUARE))
    assert kept.ending == "lost" and "it passes some of the edge 2.0" in str(kept.fault)
    assert 9.5 < kept.travel_mm < 10.8


def test_what_an_open_run_has_not_come_to_is_no_fault() -> None:
    run = along(SQUARE[:3], "ended")
    assert kept_to(EDGES, run) is run
    assert kept_to(EDGES, replace(run, ending="closed")).ending == "lost"
