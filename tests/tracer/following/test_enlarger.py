"""A drawing followed enlarged: the same path as on one drawn so large, and every place in the measure of the
drawing itself.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from morfax.motion.motion import MOTION_RATE_HZ
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.strokes import Sheet
from morfax.tracer.following.enlarger import enlarged, reduced
from morfax.tracer.following.followed import Followed
from morfax.tracer.following.follower import Follower
from morfax.tracer.following.start import put_down
from morfax.tracer.head.settings import Settings
from morfax.tracer.head.stance import Stance
from tests.tracer.inked import arc, inked, polyline

TIMES = 4


def stance_on(drawing: Drawing) -> Stance:
    return next(
        iter(put_down(Sheet.of(drawing), (8.0, 10.0), Settings(line_width_mm=0.5, gap_mm=0.0)))
    )[0]


def small(stance: Stance) -> Stance:
    """The same drawing so many times smaller."""
    view = replace(
        stance.view,
        cells=stance.view.cells._replace(pitch_mm=stance.view.pitch_mm / TIMES),
        width_mm=stance.view.width_mm / TIMES,
        usual_mm=None,
    )
    return replace(stance, place_mm=stance.place_mm / TIMES, view=view)


def follow(stance: Stance) -> Followed:
    return Follower(stance, Settings(), MOTION_RATE_HZ).follow(1000)


def test_a_small_drawing_enlarged_is_followed_as_the_large_one() -> None:
    stance = stance_on(inked(arc((18, 10), 10)))
    large, run = follow(stance), reduced(follow(enlarged(small(stance), TIMES)))
    assert run.ending == "closed" and run.view.enlarged == 1
    assert np.allclose(
        run.positions_mm, large.positions_mm / TIMES, atol=1e-6
    )  # mm: nothing but how numbers are rounded
    assert abs(run.travel_mm - large.travel_mm / TIMES) < 1e-6
    assert abs(run.view.width_mm - large.view.width_mm / TIMES) < 1e-6


def test_a_line_lost_on_the_enlarged_drawing_says_the_place_on_the_drawing() -> None:
    """A line along y = 10 mm runs into 6 mm of ink from x = 24 mm on, all of it four times smaller."""
    patch = np.array([[24.0, 5], [30, 5], [30, 15], [24, 15]])
    stance = stance_on(inked(polyline((4, 10), (36, 10)), specks=[patch]))
    stance = small(stance if abs(stance.heading_rad) < 1 else replace(stance, heading_rad=0.0))
    run = reduced(follow(enlarged(stance, TIMES)))
    assert run.ending == "lost" and run.fault is not None
    assert (run.fault.x_mm, run.fault.y_mm) == pytest.approx(
        (23.0 / TIMES, 10.0 / TIMES), abs=0.7 / TIMES
    )
    assert f"line lost at {run.fault.x_mm:.2f},{run.fault.y_mm:.2f} mm" in str(run.fault)
    assert f"after {run.travel_mm:.1f} mm" in str(run.fault)
