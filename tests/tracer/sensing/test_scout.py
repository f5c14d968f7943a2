"""What the scout takes for a clean line: lines of pixels whose middle and width leap at one column.

A pixel is as dark as the line covers of it, and each station stands on a column, so that the edges are seen
exactly where they are.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from morfax.motion.arrays import Array
from morfax.tracer.sensing.photocell import Cells
from morfax.tracer.sensing.scout import FEWEST, felt, leg_mm, onward, scout

PITCH_MM, WIDTH_MM = 0.1, 0.5
ROWS, COLUMNS = 60, 60
MIDDLE_MM = 3.0
FROM = 20  # the column from which something is other


def seen_on(aside_mm: Array, width_mm: Array, stations: int = 35) -> Array:
    """What is felt along a line whose middle is so far aside, and so wide, at each column."""
    low = (MIDDLE_MM + aside_mm - width_mm / 2) / PITCH_MM
    high = (MIDDLE_MM + aside_mm + width_mm / 2) / PITCH_MM
    row = np.arange(ROWS)[::-1, None]  # Y of a row's lower side, px
    covered = np.minimum(row + 1, high) - np.maximum(row, low)
    cells = Cells(np.clip(covered, 0, 1).astype(np.float32), PITCH_MM, 0.5)
    pose = 5.5 * PITCH_MM, MIDDLE_MM, 0.0
    return np.asarray(scout(cells, pose, WIDTH_MM, PITCH_MM, stations))


def columns(plain: float, other: float, count: int = COLUMNS) -> Array:
    """A value at each column, which is another one for some columns."""
    values = np.full(COLUMNS, plain)
    values[FROM : FROM + count] = other
    return values


def ends_there(seen: Array) -> bool:
    """Whether the line was felt up to the change, and not beyond; else it was felt to its end."""
    assert len(seen) in (FROM - 5, 35)
    return len(seen) < 35


# a sixth of 0.5 mm and 0.4 px are 0.123 mm
@pytest.mark.parametrize(
    ("leap_mm", "ends"), [(0.10, False), (0.115, False), (0.135, True), (-0.135, True)]
)
def test_a_clean_line_leaps_aside_by_a_sixth_of_its_width_and_0_4_px(
    leap_mm: float, ends: bool
) -> None:
    seen = seen_on(columns(0.0, leap_mm), columns(WIDTH_MM, WIDTH_MM))
    assert ends_there(seen) == ends


# a fifth of 0.5 mm and half a pixel are 0.15 mm
@pytest.mark.parametrize(
    ("width_mm", "ends"), [(0.64, False), (0.36, False), (0.67, True), (0.33, True)]
)
def test_a_clean_line_s_width_differs_by_a_fifth_and_half_a_pixel(
    width_mm: float, ends: bool
) -> None:
    assert ends_there(seen_on(columns(0.0, 0.0), columns(WIDTH_MM, width_mm))) == ends


@pytest.mark.parametrize(("count", "ends"), [(1, False), (2, False), (3, True)])
def test_a_speck_is_two_pixels_and_a_half_long(count: int, ends: bool) -> None:
    seen = seen_on(columns(0.0, 0.0), columns(WIDTH_MM, 0.9, count))
    if ends:
        assert len(seen) == FROM - 5
    else:
        assert len(seen) == 35 - count  # spoilt stations are passed over, and do not count
    assert seen[:, 2] == pytest.approx(WIDTH_MM, abs=1e-6)


def test_the_expected_width_follows_a_line_that_swells() -> None:
    """A twentieth wider for each mm is 0.2 mm over 4 mm; with less following that is more than a fifth."""
    come_mm = np.maximum(0, np.arange(COLUMNS) - 10) * PITCH_MM
    assert len(seen_on(np.zeros(COLUMNS), WIDTH_MM + 0.05 * come_mm, 50)) == 50
    seen = seen_on(np.zeros(COLUMNS), WIDTH_MM + 0.15 * come_mm, 50)
    assert len(seen) < 25


def test_a_leg_is_1_2_mm_or_12_pixels_or_one_width_and_a_half() -> None:
    assert leg_mm(0.5, 0.05) == 1.2
    assert leg_mm(0.5, 0.2) == pytest.approx(2.4)
    assert leg_mm(2.0, 0.05) == 3.0


@pytest.mark.parametrize(("length_mm", "count"), [(2.0, 21), (2.04, 21), (0.1, FEWEST)])
def test_so_many_stations_reach_so_far(length_mm: float, count: int) -> None:
    """From the place itself to the length, ends included; four at the least."""
    dark = np.zeros((ROWS, COLUMNS), np.float32)
    dark[28:33] = 1.0
    seen = felt(Cells(dark, PITCH_MM, 0.5), (0.55, 2.95, 0.0), WIDTH_MM, (PITCH_MM, length_mm))
    assert len(seen) == count
    assert seen[-1, 0] - seen[0, 0] == pytest.approx((count - 1) * PITCH_MM)


@pytest.mark.parametrize("bend_per_mm", [0.0, 0.2, -0.3])
def test_the_way_onward_is_the_circle_s_chord(bend_per_mm: float) -> None:
    """After nine stations of a circle the next chord is foretold; after few, the last four chords' mean."""
    step_mm = 0.05
    turns = bend_per_mm * step_mm * np.arange(30)
    places = np.cumsum(np.column_stack([np.cos(turns), np.sin(turns)]), axis=0) * step_mm
    seen = np.column_stack([places, np.full(30, WIDTH_MM)])
    for count in (9, 15):
        assert onward(seen, count) == pytest.approx(turns[count], abs=1e-9 + abs(turns[1]) ** 3)
    assert onward(seen, 6) == pytest.approx(turns[2:6].mean(), abs=1e-9 + abs(turns[1]) ** 3)
    assert onward(seen, 3) == pytest.approx(turns[1:3].mean(), abs=1e-9)
    assert math.isfinite(onward(seen, 2))
