"""The survey of a junction, gaps, and edge following past ink beside the line: which way the head goes on."""

from __future__ import annotations

import math

import numpy as np
import pytest

from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.head.trail import Trail
from morfax.tracer.junctions.choice import Asked, WayIn, survey
from morfax.tracer.junctions.edge_following import follow_edge
from morfax.tracer.junctions.line_ahead import straight_on
from morfax.tracer.sensing import photocell
from morfax.tracer.sensing.leg import Leg, goes_straight, leg_of
from morfax.tracer.sensing.view import View
from tests.tracer.inked import UM, WIDTH_MM, inked, polyline

# to which straight legs, 5 um aside on clean ink, meet at 45 degrees and more
VERTEX_MM = 10 * UM
X_MM = 14.0
WAY_IN = polyline((4, 10), (X_MM, 10))
Seen = tuple[View, Leg, Trail]


def come_along(drawing: Drawing, to_mm: float = X_MM) -> Seen:
    """A head that has come along y = 10 mm, and feels the line ahead up to a junction or to x = `to_mm`."""
    eyes = View(photocell.behind_aperture(drawing, 0.15), WIDTH_MM + 25 * UM)
    start = np.array([to_mm - 3.0, 10.0])
    trail = Trail(np.array([4.0, 10.0]), eyes.step_mm)
    trail.add(
        np.column_stack(
            [np.arange(4, to_mm - 2, 0.01), np.full(round((to_mm - 6) * 100), 10.0)]
        )
    )
    return eyes, leg_of(eyes.feel(start, 0.0, 3.0 + 1.0), True, eyes.leg_mm), trail


def degrees(leg: Leg | None) -> float:
    assert leg is not None
    return math.degrees(leg.heading_rad)


@pytest.mark.parametrize("out_deg", [90.0, -90.0, 120.0, 144.0])
def test_a_corner_has_one_way_on_and_a_vertex(out_deg: float) -> None:
    a = math.radians(out_deg)
    line = np.vstack([WAY_IN, [X_MM + 6 * math.cos(a), 10 + 6 * math.sin(a)]])
    eyes, incoming, trail = come_along(inked(line))
    outgoing, corner, choices = survey(WayIn(eyes, incoming, trail))
    assert choices == 1 and degrees(outgoing) == pytest.approx(out_deg, abs=1)
    assert corner is not None
    within_mm = (
        VERTEX_MM / math.sin(a) ** 2
    )  # legs that meet at a smaller angle say less of where
    assert corner.vertex_mm == pytest.approx(np.array([X_MM, 10]), abs=abs(within_mm))


@pytest.mark.parametrize("other_deg", [45.0, 60.0, 90.0, 120.0])
def test_a_crossing_is_gone_straight_over(other_deg: float) -> None:
    a = math.radians(other_deg)
    way = 6 * np.array([math.cos(a), math.sin(a)])
    other = np.array([X_MM, 10]) + np.array([-way, way])
    eyes, incoming, trail = come_along(inked(polyline((4, 10), (24, 10)), other))
    outgoing, _, choices = survey(WayIn(eyes, incoming, trail))
    assert choices == 3 and goes_straight(incoming, outgoing)
    assert degrees(outgoing) == pytest.approx(0, abs=0.5)


def test_at_a_fork_without_a_straight_leg_the_straightest_is_taken_and_the_next_can_be() -> (
    None
):
    drawing = inked(
        WAY_IN, polyline((X_MM, 10), (X_MM + 4, 16)), polyline((X_MM, 10), (X_MM, 4))
    )
    eyes, incoming, trail = come_along(drawing)
    first, _, choices = survey(WayIn(eyes, incoming, trail))
    second, _, _ = survey(WayIn(eyes, incoming, trail), Asked(rank=1))
    assert choices == 2
    assert degrees(first) == pytest.approx(56.3, abs=1) and degrees(second) == pytest.approx(
        -90, abs=1
    )


def test_what_has_been_followed_already_is_not_taken_again() -> None:
    eyes, incoming, _ = come_along(inked(WAY_IN, polyline((X_MM, 10), (X_MM, 18))))
    up = Trail(np.array([X_MM, 18.0]), eyes.step_mm)
    up.add(
        np.column_stack([np.full(800, X_MM), np.arange(18, 10, -0.01)])
    )  # came down here first, then round again
    up.add(np.column_stack([np.arange(4, X_MM - 2, 0.01), np.full(800, 10.0)]))
    outgoing, _, choices = survey(WayIn(eyes, incoming, up))
    assert outgoing is None and choices == 1  # counted, as the line is joined and not ended


def test_at_an_end_there_is_no_way_on() -> None:
    eyes, incoming, trail = come_along(inked(WAY_IN))
    assert survey(WayIn(eyes, incoming, trail)) == (None, None, 0)
    assert straight_on(eyes, incoming, 0.5) is None


@pytest.mark.parametrize(
    ("paper_mm", "carried"), [(0.2, True), (0.4, True), (0.7, False), (1.5, False)]
)
def test_a_gap_is_carried_if_it_is_no_wider_than_allowed(
    paper_mm: float, carried: bool
) -> None:
    eyes, incoming, _ = come_along(
        inked(WAY_IN, polyline((X_MM + WIDTH_MM + paper_mm, 10), (24, 10)))
    )
    leg = straight_on(eyes, incoming, 0.5)
    assert (leg is not None) == carried
    if leg is not None:
        assert leg.end_mm[1] == pytest.approx(10, abs=6 * UM) and degrees(leg) == pytest.approx(
            0, abs=0.5
        )


def test_a_gap_is_not_carried_to_a_line_aside() -> None:
    eyes, incoming, _ = come_along(inked(WAY_IN, polyline((X_MM + 0.8, 10.6), (24, 10.6))))
    assert straight_on(eyes, incoming, 0.5) is None


# following one edge


def test_two_lines_that_run_into_a_tip_are_one_that_turned_back() -> None:
    tip = (26.0, 10.0)
    eyes, incoming, _ = come_along(inked(polyline((4, 10), tip, (4, 12))), 19.0)
    run = follow_edge(eyes, incoming)
    assert run is not None and run.back is not None
    assert np.hypot(*(run.back[0, :2] - tip)) < 0.7  # the bound for sharp tips
    back = polyline(tip, (4, 12))
    aside = (
        (run.back[:, :2] - tip)
        @ np.array([back[1, 1] - 10, tip[0] - back[1, 0]])
        / np.hypot(*(back[1] - tip))
    )
    assert (
        np.abs(aside[run.back[:, 0] < 24]).max() < 25 * UM
    )  # on the way back, where the ink is broader than the pen


def test_a_clean_line_is_not_ridden() -> None:
    eyes, incoming, _ = come_along(inked(polyline((4, 10), (30, 10))))
    assert follow_edge(eyes, incoming) is None
