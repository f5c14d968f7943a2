"""The slow cell's windows: as wide as the way's own bend allows, place by place.

Broken on purpose, with the same window for all of a way: the wave's crest gets as wide a one as its flanks.
"""

from __future__ import annotations

import numpy as np
import pytest

from morfax.motion.arrays import Array
from morfax.motion.motion import MOTION_RATE_HZ
from morfax.tracer.following.start import put_down
from morfax.tracer.head.settings import Settings
from morfax.tracer.head.state import Tuning
from morfax.tracer.head.tuning import tune
from morfax.tracer.head.windows import (
    BENT_WIDTHS,
    TOUCHING_WIDTHS,
    WINDOW,
    Ahead,
    is_steady,
    lead_mm,
    most_bend_per_mm,
    narrow_mm,
    slowly,
    widest,
)
from tests.tracer.inked import UM, WIDTH_MM, arc, inked


@pytest.fixture(scope="module")
def tuning() -> Tuning:
    """That of a fast cell on a line of 0.5 mm at 300 dpi."""
    stance, _ = next(iter(put_down(inked(arc((14, 14), 10.0), seed=1))))
    return tune(stance, Settings(), MOTION_RATE_HZ)


def straight(length_mm: float = 6.0) -> Array:
    """A straight way."""
    return np.column_stack([np.linspace(0, length_mm, 300), np.zeros(300)])


def test_an_arc_is_told_from_a_bend_that_changes() -> None:
    """With stations 2 um off at random, as a scan's are."""
    angles = np.linspace(0, 0.75, 60)
    spiral = np.cumsum(np.column_stack([np.cos(angles**2), np.sin(angles**2)]), axis=0) / 40
    noise = 2 * UM * np.random.default_rng(1).normal(size=(60, 2))
    assert is_steady(2.0 * np.column_stack([np.cos(angles), np.sin(angles)]) + noise)
    assert not is_steady(spiral + noise)


def test_stairs_of_hard_pixels_do_not_narrow_the_window(tuning: Tuning) -> None:
    """Stairs of 20 um every half a mm: one window as wide as the fast cell's for all of the way."""
    stairs = straight()
    stairs[:, 1] = 20 * UM * np.sign(np.sin(2 * np.pi * stairs[:, 0] / 0.5))
    (window,) = widest(tuning, Ahead(stairs, WIDTH_MM))
    assert window.half_mm == pytest.approx(tuning.half_window_mm)


def test_each_place_has_the_window_that_its_bend_allows(tuning: Tuning) -> None:
    """Straight for 3 mm, then round an arc of 0.9 mm: wide, and narrow where it bends."""
    angles = np.linspace(0, 2, 200)
    bend = (3.0, 0.0) + 0.9 * np.column_stack([np.sin(angles), 1 - np.cos(angles)])
    way = np.vstack([straight(3.0), bend[1:]])
    windows = widest(tuning, Ahead(way, WIDTH_MM))
    assert windows[0].half_mm == pytest.approx(tuning.half_window_mm)
    assert 2.0 < windows[0].length_mm < 3.0
    assert windows[-1].half_mm < 0.7 * tuning.half_window_mm
    assert sum(window.length_mm for window in windows) == pytest.approx(
        np.hypot(*np.diff(way, axis=0).T).sum()
    )


def test_the_cell_does_not_look_beyond_what_is_clear(tuning: Tuning) -> None:
    """Before a stub the last windows are so narrow that their lead ends at it."""
    clear_mm = lead_mm(tuning, WINDOW * tuning.narrow_mm) + 10 * UM
    windows = widest(tuning, Ahead(straight(), WIDTH_MM, clear_mm))
    left_mm = clear_mm
    for window in windows[::-1]:
        assert lead_mm(tuning, window.half_mm) < left_mm
        left_mm += window.length_mm
    assert windows[0].half_mm == pytest.approx(tuning.half_window_mm)
    assert windows[-1].half_mm == narrow_mm(tuning, straight())


def test_a_felt_corner_is_no_bend_for_a_wide_window(tuning: Tuning) -> None:
    """A corner of 30 degrees, rounded by 0.3 mm as stations feel it: the widest window would cut it."""
    angles = np.linspace(0, np.pi / 6, 30)
    bend = (2.0, 0.0) + 0.6 * np.column_stack([np.sin(angles), 1 - np.cos(angles)])
    on = bend[-1] + np.linspace(0.02, 2, 100)[:, None] * (np.cos(np.pi / 6), 0.5)
    halves_mm = [
        window.half_mm
        for window in widest(tuning, Ahead(np.vstack([straight(2.0), bend[1:], on]), WIDTH_MM))
    ]
    assert halves_mm[0] == halves_mm[-1] == pytest.approx(tuning.half_window_mm)
    assert min(halves_mm) < 0.75 * tuning.half_window_mm


@pytest.mark.parametrize(
    ("radius_widths", "most_widths"), [(20.0, 0.7), (1.8, 0.83), (1.2, 1.0)]
)
def test_it_stops_at_bends_that_were_not_felt(
    tuning: Tuning, radius_widths: float, most_widths: float
) -> None:
    """At 0.7 over the width where the way hardly bends, at half as much again where it does, and nowhere
    beyond 1 over the width, where the inks of a bend's two sides touch.
    """
    assert tuning.narrowest_per_mm < BENT_WIDTHS / WIDTH_MM < TOUCHING_WIDTHS / WIDTH_MM
    way = arc((0, 0), radius_widths * WIDTH_MM)
    most_per_mm = most_bend_per_mm(tuning, Ahead(way[: len(way) // 3], WIDTH_MM))
    assert most_per_mm * WIDTH_MM == pytest.approx(most_widths, rel=0.08)
    assert slowly(tuning, 0.3, most_per_mm).narrowest_per_mm == most_per_mm
