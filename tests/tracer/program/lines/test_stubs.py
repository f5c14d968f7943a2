"""Stubs: ways that go out along a tick and come back, against tips and bays of the line itself.

Broken on purpose, with `STRAIGHT_ON` or `CLOSE` three times as large, or `LEAST_OUT` four times as large,
tests here fail.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from morfax.jobs.settings.line_settings import LineSettings
from morfax.jobs.settings.settings import TraceSettings
from morfax.jobs.tracing.tracing import Tracing
from morfax.motion.polyline import evenly, nearest_mm
from morfax.tracer.following.line import Line
from morfax.tracer.program.lines.stubs import stubs
from tests.jobs.test_told_ink import Heard
from tests.tracer.inked import WIDTH_MM, Points, arc, inked

MIDDLE_MM, RADIUS_MM = np.array([16.0, 16.0]), 12.0


def line(*places: tuple[float, float], ending: str = "closed") -> Line:
    """A line along places, as the head gives it: 600 positions a mm."""
    way = evenly(np.array(places), 1 / 600)
    return Line(way, ending, WIDTH_MM, float(len(way)) / 600)


STRAIGHT = (0.0, 0.0), (10.0, 0.0)
ROUND = (30.0, 0.0), (30.0, 10.0), (0.0, 10.0), (0.0, 0.0)


def test_a_way_out_and_back_is_told_with_its_place_and_how_far_out_it_goes() -> None:
    (found,) = stubs(line(*STRAIGHT, (10.05, 0.9), (10.1, 0.0), *ROUND))
    assert found.place_mm == pytest.approx((10.05, 0.9), abs=0.06)
    assert found.out_mm == pytest.approx(0.9, abs=0.06)


@pytest.mark.parametrize("turns_deg", [60.0, 90.0, 110.0])
def test_a_way_out_and_back_at_a_corner_is_told(turns_deg: float) -> None:
    """A tick in line with one leg of a corner, run out and back in its own track."""
    on = math.radians(turns_deg)
    leg = 20 + 10 * math.cos(on), 10 * math.sin(on)
    (found,) = stubs(line((0.0, 0.0), (20.0, 0.0), (20.9, 0.0), (20.0, 0.05), leg, (0.0, 10.0)))
    assert found.place_mm == pytest.approx((20.9, 0.0), abs=0.06)


@pytest.mark.parametrize("tip_deg", [4.0, 10.0, 20.0, 40.0, 58.0])
def test_a_tip_where_two_sides_meet_is_none(tip_deg: float) -> None:
    back = math.radians(180 - tip_deg)
    leg = 20 + 15 * math.cos(back), 15 * math.sin(back)
    assert stubs(line((0.0, 0.0), (20.0, 0.0), leg, (0.0, 10.0))) == []


def test_a_finger_at_a_corner_whose_sides_are_half_a_line_apart_is_none() -> None:
    finger = (20.9, 0.0), (20.9, 0.25), (20.0, 0.25)
    assert stubs(line((0.0, 0.0), (20.0, 0.0), *finger, (20.0, 10.0), (0.0, 10.0))) == []


def test_one_on_the_seam_of_a_closed_line_is_told_too() -> None:
    stub = (0.0, 5.0), (-0.9, 5.0), (0.0, 5.0)
    begun_on_it = (
        (-0.9, 5.0),
        (0.0, 5.0),
        (0.0, 0.0),
        (30.0, 0.0),
        (30.0, 10.0),
        (0.0, 10.0),
        *stub[:2],
    )
    assert len(stubs(line(*begun_on_it))) == 1


@pytest.mark.parametrize(
    "way",
    [
        ((10.0, 0.3), (10.1, 0.0)),  # a bump
        ((10.6, 1.0), (11.2, 0.0)),  # a tooth, whose sides are further apart
        ((10.0, 3.0), (13.0, 3.0), (13.0, 0.0)),  # a tab
    ],
    ids=["bump", "tooth", "tab"],
)
def test_what_is_no_stub(way: tuple[tuple[float, float], ...]) -> None:
    assert not stubs(line(*STRAIGHT, *way, *ROUND))


@pytest.mark.parametrize("side_mm", [1.0, 7.0])
def test_a_tip_where_two_sides_meet_does_not_go_straight_on(side_mm: float) -> None:
    """Tips of 6 and of 39 degrees."""
    tip = (0.0, -side_mm), (20.0, 0.0), (0.0, side_mm), (-5.0, 0.0), (0.0, -side_mm)
    assert not stubs(line(*tip))


def ticked(dpi: float, seed: int) -> tuple[list[str], Points]:
    """What is said of a circle with short ticks, and the way along it."""
    rng, ticks = np.random.default_rng(seed), list[Points]()
    for turn in rng.uniform(0, math.tau, 6):
        way = np.array([math.cos(turn), math.sin(turn)])
        ticks.append(
            MIDDLE_MM + np.array([[RADIUS_MM], [RADIUS_MM + rng.choice([-1, 1]) * 0.65]]) * way
        )
    heard = Heard()
    circle = arc((16.0, 16.0), RADIUS_MM)
    drawing = inked(circle, *ticks, dpi=dpi, seed=seed)
    traced = Tracing.prepared(TraceSettings(LineSettings())).trace(drawing, heard)
    return [text for text in heard.said if "along a short stub" in text], traced.trace.lines[
        0
    ].xy_mm


def test_ticks_along_which_the_head_goes_out_are_told_and_others_are_not() -> None:
    told_of = [0, 0]
    # just not out at 90 dpi; twice out, and not out, at 150
    for dpi, seed in ((90.0, 2), (150.0, 0), (150.0, 7), (150.0, 2)):
        told, way = ticked(dpi, seed)
        goes_out = bool(nearest_mm(way[::20], arc((16.0, 16.0), RADIUS_MM)).max() > 0.4)
        assert bool(told) == goes_out
        told_of[goes_out] += 1
    assert told_of == [2, 2]
