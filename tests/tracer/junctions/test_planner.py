"""The planner: ways on from where the head stands."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from morfax.motion.plane import direction
from morfax.tracer.head.settings import Settings
from morfax.tracer.head.trail import Trail
from morfax.tracer.junctions.edge_following import EdgeRun, _turned_back
from morfax.tracer.junctions.planner import Planner
from morfax.tracer.sensing.leg import leg_of
from morfax.tracer.sensing.photocell import behind_aperture
from morfax.tracer.sensing.view import View
from tests.tracer.inked import inked, polyline


def test_an_edge_that_ends_where_the_head_stands_is_no_way_on() -> None:
    """An engraved cam, 250 pixels for 120 mm, with all its lines: no node was left to lay a way through."""
    view = View(behind_aperture(inked(polyline((4, 10), (24, 10))), 0.15), 0.5)
    incoming = leg_of(view.feel(np.array([6.0, 10.0]), 0.0, 4.0), True, view.leg_mm)
    stands = incoming.end_mm, incoming.heading_rad
    planner = Planner(view, stands, Trail(incoming.end_mm, view.step_mm), Settings())
    assert planner._along_edge(incoming, EdgeRun(incoming.seen[-1:], None)) is None
    further = view.feel(incoming.end_mm, 0.0, 8.0)
    assert planner._along_edge(incoming, EdgeRun(further, None)) is not None


def test_between_legs_close_together_the_way_leaves_the_first_before_half_way() -> None:
    """So the cubic has as much room for the turn as the head had for coming onto the leg."""
    view = View(behind_aperture(inked(polyline((4, 10), (24, 10))), 0.15), 0.5)
    incoming = leg_of(view.feel(np.array([6.0, 10.0]), 0.0, 4.0), True, view.leg_mm)
    stands = incoming.end_mm, incoming.heading_rad
    planner = Planner(view, stands, Trail(incoming.end_mm, view.step_mm), Settings())
    apart_mm = 0.2
    beyond = incoming.at(apart_mm) + np.array([0.0, 0.02])
    outgoing = replace(incoming, end_mm=beyond, heading_rad=incoming.heading_rad + 0.1)
    (way,) = planner.through(incoming, outgoing, None).stretches
    along_mm = (way - incoming.end_mm) @ direction(incoming.heading_rad)
    off_mm = np.abs(way[:, 1] - incoming.end_mm[1])
    assert (
        off_mm[along_mm < 0.2 * apart_mm].max() < 1e-3 < off_mm[along_mm < 0.5 * apart_mm].max()
    )
    assert along_mm[-1] == pytest.approx(apart_mm, abs=1e-3) and np.all(np.diff(along_mm) >= 0)


def test_ink_beside_a_line_that_ends_in_a_tip_is_come_back_along_from_there() -> None:
    """Ink 0.3 mm wide beside the stations from the tenth on narrows to nothing at the fortieth."""
    x = 0.05 * np.arange(60)
    seen = np.column_stack([x, np.zeros(60), np.full(60, 0.5)])
    excess = np.full(60, -0.01)
    excess[10:41] = np.linspace(0.3, 0.0, 31)
    run = _turned_back(excess, seen, (10, 39), 1.0)
    assert run is not None and run.back is not None
    assert len(run.seen) == 41 and run.back[:, 0] == pytest.approx(x[40:9:-1])
    assert run.back[:, 1] == pytest.approx(-excess[40:9:-1], abs=1e-12)
    # the third is the line's width, as of any stations
    assert run.back.shape == (31, 3) and set(run.back[:, 2]) == {0.5}
