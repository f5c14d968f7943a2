"""Where a pen was lifted in the ink of other lines."""

from __future__ import annotations

import math

import numpy as np
import pytest

from morfax.motion.neighbours import Neighbours
from morfax.tracer.effort import EVERY_MM
from morfax.tracer.ink import lifted
from morfax.tracer.sensing import photocell
from morfax.tracer.sensing.leg import leg_of
from morfax.tracer.sensing.view import View
from tests.tracer.inked import UM, WIDTH_MM, inked, polyline

ACROSS = np.column_stack([np.arange(5.0, 45.0, EVERY_MM), np.full(800, 20.0)])
MEETS = np.array([25.0, 20.0])


def loose_line() -> lifted.Loose:
    """A line that comes to another at 45 degrees and ends on its middle."""
    drawing = inked(ACROSS, polyline((10, 5), (25, 20)), seed=1)
    view = View(photocell.behind_aperture(drawing, 0.1), WIDTH_MM)
    seen = view.feel(np.array([12.0, 7.0]), math.pi / 4, 10.0)
    return lifted.Loose(view, leg_of(seen, True, view.leg_mm), seen[:, :2])


def test_a_line_ends_on_the_middle_of_the_other_however_many_ends_are_looked_at_first(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    line = loose_line()
    (end_mm,) = lifted.ends_in_ink_mm([line], ACROSS)
    assert end_mm is not None
    assert math.dist(line.leg.at(end_mm), MEETS) < 50 * UM  # as a felt leg tells a crossing
    for widths in (0.3, 1000.0):
        monkeypatch.setattr(lifted, "FIRST_WIDTHS", widths)
        assert lifted.ends_in_ink_mm([line], ACROSS) == [end_mm]


def test_a_leg_of_a_millimetre_tells_where_its_line_ends_seven_further_on() -> None:
    drawing = inked(ACROSS, polyline((10, 5), (25, 20)), seed=1)
    view = View(photocell.behind_aperture(drawing, 0.1), WIDTH_MM)
    begin = MEETS - 8.0 * np.array([math.sqrt(0.5), math.sqrt(0.5)])
    seen = view.feel(begin, math.pi / 4, 1.0)
    leg = leg_of(seen, True, view.leg_mm)
    (end_mm,) = lifted.ends_in_ink_mm([lifted.Loose(view, leg, seen[:, :2])], ACROSS)
    assert end_mm is not None
    assert math.dist(leg.at(end_mm), MEETS) < 100 * UM  # 0.7 degrees


def test_the_nearest_of_the_others_is_that_of_all_their_places() -> None:
    rng = np.random.default_rng(1)
    lines, places = rng.uniform(0, 10, (40, 2)), rng.uniform(3, 7, (200, 2))
    ways = [rng.uniform(low, low + 3, (9, 2)) for low in range(38, -2, -2)]
    rows = np.vstack([lines, (np.nan, np.nan)])
    away_mm, nearest_mm = lifted._Others(rows, Neighbours(lines), ways).nearest(places)
    every = np.vstack([lines, *ways])
    off_mm = np.hypot(*(places[:, None] - every).transpose(2, 0, 1))
    assert away_mm == pytest.approx(off_mm.min(axis=1), abs=1e-12)  # rounding, mm
    assert np.array_equal(nearest_mm, every[off_mm.argmin(axis=1)])


@pytest.mark.parametrize(("way_mm", "nearest"), [(0.99, (0.0, 0.99)), (1.01, (1.0, 0.0))])
def test_a_way_counts_where_it_is_just_nearer_than_the_others(
    way_mm: float, nearest: tuple[float, float]
) -> None:
    line, way = np.array([[1.0, 0.0]]), np.array([[0.0, way_mm], [0.0, 2.0]])
    rows = np.vstack([line, (np.nan, np.nan)])
    away_mm, nearest_mm = lifted._Others(rows, Neighbours(line), [way]).nearest(
        np.zeros((1, 2))
    )
    assert away_mm[0] == pytest.approx(math.hypot(*nearest))
    assert tuple(nearest_mm[0]) == nearest
