"""From knot to knot in one call: the way is the same to the last bit as with a stop at every millimetre."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from morfax.motion.arrays import Array
from morfax.motion.motion import MOTION_RATE_HZ
from morfax.motion.polyline import lengths_mm
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.following import clean_line
from morfax.tracer.following.clean_line import Knows
from morfax.tracer.following.follower import Follower
from morfax.tracer.following.start import put_down
from morfax.tracer.following.ways_out import STRAIGHT_ON, Turns
from morfax.tracer.head.carriage import Carriage
from morfax.tracer.head.settings import Settings
from morfax.tracer.head.state import Home
from morfax.tracer.head.trail import Trail, mark_along
from morfax.tracer.head.tuning import tune
from morfax.tracer.program.trace import trace
from morfax.tracer.sensing.scout import scout
from tests.tracer.inked import UM, arc, inked, polyline

CIRCLE = arc((8.0, 8.0), 3.0)
LONGEST_MM = 200.0


def wavy() -> Array:
    """A sine with bends of 2.5 mm of radius, at which the head's kernel stops."""
    x = np.linspace(0.0, 30.0, 3000)
    return np.column_stack([x + 4.0, 8.0 + np.sin(2 * np.pi * x / 10.0)])


def follower_on(drawing: Drawing) -> Follower:
    """A head that was put down on a drawing's line."""
    stance, _ = next(iter(put_down(drawing)))
    return Follower(stance, Settings(), MOTION_RATE_HZ)


LINES = {
    "circle": [CIRCLE],
    "wave": [wavy()],
    "corners": [polyline((4, 4), (14, 4), (14, 12), (9, 9), (4, 12), (4, 4))],
    "crossing": [polyline((4, 4), (20, 14)), polyline((4, 14), (20, 4))],
}


@pytest.mark.parametrize("name", LINES)
@pytest.mark.parametrize("seed", [1, 2])
def test_the_way_is_the_same_to_the_last_bit(name: str, seed: int) -> None:
    drawing = inked(*LINES[name], seed=seed)
    # whoever keeps knots has every stop reported
    stopped = follower_on(drawing).follow(LONGEST_MM, keep=lambda head: None)
    run = follower_on(drawing).follow(LONGEST_MM)
    np.testing.assert_array_equal(run.positions_mm, stopped.positions_mm)
    assert (run.ending, run.led, run.view.width_mm) == (
        stopped.ending,
        stopped.led,
        stopped.view.width_mm,
    )


def test_a_smooth_circle_of_6_mm_is_one_call_of_the_kernel(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    calls, every = list[int](), clean_line._follow

    def counted(*args: object) -> object:
        calls.append(1)
        return every(*args)

    monkeypatch.setattr(clean_line, "_follow", counted)
    run = follower_on(inked(CIRCLE, seed=1)).follow(LONGEST_MM)
    assert run.ending == "closed"
    assert len(calls) == 1  # 18.8 mm take 1.9 s, and a call has room for 4 s


def test_whoever_is_told_a_turn_or_keeps_knots_hears_of_every_stop() -> None:
    head = follower_on(inked(CIRCLE))
    home, anchor = Home(0.0, 0.0, 0.0, 1e9), (np.zeros(2), 0.0, 0.0)
    turn = object()  # any told turn
    allowed = {
        "as it is": (Knows(home, anchor, STRAIGHT_ON, LONGEST_MM), True),
        "knots": (Knows(home, anchor, STRAIGHT_ON, 0.0), False),
        "a turn": (Knows(home, anchor, Turns(at=(turn,)), LONGEST_MM), False),  # type: ignore[arg-type]
    }
    for knows, may in allowed.values():
        assert knows.may_go_on(head.view, head.carriage) == may


def test_the_trail_is_marked_as_plain_python_marks_it() -> None:
    places = np.cumsum(np.random.default_rng(1).normal(0.002, 0.001, (3000, 2)), axis=0)
    trail, step_mm = Trail(np.zeros(2), 0.05), 0.05
    trail.add(places)
    plain = Trail(np.zeros(2), step_mm)
    marks = plain.marks(len(places))
    mark_along.py_func(marks, places)
    plain.took(marks)
    np.testing.assert_array_equal(trail.places(), plain.places())
    # a place at each whole step of travel
    come_mm = lengths_mm(np.vstack([np.zeros(2), places]))
    steps = np.flatnonzero(np.diff(np.floor(come_mm / step_mm)) > 0)
    np.testing.assert_array_equal(trail.places()[1:], places[steps])
    assert len(steps) == math.floor(come_mm[-1] / step_mm)


def test_stops_were_there(monkeypatch: pytest.MonkeyPatch) -> None:
    """The circle does stop the head's own kernel: else the tests above would say nothing."""
    stops, follow = list[int](), Carriage.follow

    def counted(self: Carriage, *args: object) -> int:
        stops.append(1)
        return follow(self, *args)  # type: ignore[arg-type]

    monkeypatch.setattr(Carriage, "follow", counted)
    follower_on(inked(CIRCLE, seed=1)).follow(LONGEST_MM, keep=lambda head: None)
    assert len(stops) > 15


@pytest.mark.parametrize(("line", "times"), [(CIRCLE, 1), (polyline((4, 4), (6.5, 4)), 3)])
def test_a_line_is_felt_once_for_its_corners_too_unless_a_station_is_spoilt(
    monkeypatch: pytest.MonkeyPatch, line: Array, times: int
) -> None:
    """The same stations as without those further on; the second line ends before them."""
    stance, _ = next(iter(put_down(inked(line, seed=1))))
    view, own_mm = stance.view, stance.view.leg_mm
    pose = float(stance.place_mm[0]), float(stance.place_mm[1]), float(stance.heading_rad)
    asked = list[int]()

    def counted(*given: Any) -> Array:
        asked.append(int(given[-1]))
        return np.asarray(scout(*given))

    monkeypatch.setattr(clean_line, "scout", counted)
    sizes_mm = float(view.width_mm), own_mm, view.step_mm
    seen, more = clean_line._felt_ahead.py_func(view.cells, pose, sizes_mm, 2 * own_mm)
    assert len(asked) == times
    np.testing.assert_array_equal(seen, view.feel(pose[:2], pose[2], 2 * own_mm))
    assert (len(more) > len(seen)) == (times == 1)


@pytest.mark.parametrize(("radius_mm", "within_um"), [(2.4, 4.0), (3.0, 3.5)])
def test_a_cell_sweeps_square_to_a_bend_that_was_felt_clean(
    radius_mm: float, within_um: float
) -> None:
    """Aslant to a line of 0.8 mm it saw a middle that was 9.3 and 5.4 um within the circle."""
    (line,) = trace(inked(arc((8.0, 8.0), radius_mm), width_mm=0.8)).lines
    off_mm = np.hypot(*(line.xy_mm - (8.0, 8.0)).T) - radius_mm
    assert abs(float(np.mean(off_mm))) < within_um * UM


def test_a_line_whose_edges_no_cell_parts_is_swept_as_it_was() -> None:
    """Steps of pixels bend it more than it is bent: two grey levels went from 0.08 to 0.14 mm off."""
    stances = (next(put_down(inked(CIRCLE, width_mm=width_mm)))[0] for width_mm in (0.45, 0.55))
    thin, wide = (tune(stance, Settings(), MOTION_RATE_HZ) for stance in stances)
    assert not thin.square_on_clean  # 5.3 pixels
    assert wide.square_on_clean  # 6.5
