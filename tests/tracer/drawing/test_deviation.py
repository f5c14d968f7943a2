"""The measure of a path against the ink itself: it must find what is wrong, to the micrometre and with its
sign.
"""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from morfax.motion.arrays import Array
from morfax.motion.faults import MotionFault
from morfax.motion.motion import Path
from morfax.tracer.drawing.deviation import AVERAGED_MM, deviation
from morfax.tracer.program.trace import trace
from tests.tracer.inked import UM, WIDTH_MM, arc, inked, polyline

MIDDLE = 14.0
RADIUS_MM = 10.0
CIRCLE = arc((MIDDLE, MIDDLE), RADIUS_MM)
PIXELS_MM = 4 * UM  # at a place, averaged over 0.5 mm: six pixels of 85 um


def off(by_mm: float, turns: int = 1) -> Array:
    """The circle too wide by so much; run anticlockwise, that is to the right of the line."""
    return arc((MIDDLE, MIDDLE), RADIUS_MM + by_mm)[::turns]


@pytest.fixture(scope="module")
def drawing():  # type: ignore[no-untyped-def]
    return inked(CIRCLE)


@pytest.mark.parametrize("seed", [None, 4])
def test_the_line_itself_does_not_deviate(seed: int | None) -> None:
    found = deviation(inked(CIRCLE, seed=seed), [CIRCLE])
    assert found.rms_mm < (
        1.5 * UM if seed is None else 4 * UM
    )  # 4 % noise, averaged over 0.5 mm
    assert abs(np.nanmean(found.error_mm)) < 0.7 * UM
    assert found.measured_share == 1
    assert found.missed_share == 0
    assert found.line_width_mm == pytest.approx(WIDTH_MM, abs=40 * UM)
    assert found.ink_mm == pytest.approx(2 * np.pi * RADIUS_MM, rel=0.05)


@settings(max_examples=12)
@given(by_mm=st.floats(-0.1, 0.1))
def test_an_offset_is_found_with_its_sign(by_mm: float) -> None:
    """Wider, run anticlockwise, is right of the ink: negative. The other way round it is left."""
    drawing = inked(CIRCLE)
    there, back = deviation(drawing, [off(by_mm)]), deviation(drawing, [off(by_mm, -1)])
    assert np.nanmean(there.error_mm) == pytest.approx(-by_mm, abs=0.7 * UM)
    assert np.nanmean(back.error_mm) == pytest.approx(by_mm, abs=0.7 * UM)
    assert there.max_mm == pytest.approx(abs(by_mm), abs=PIXELS_MM)


def test_20_um_is_20_um(drawing) -> None:  # type: ignore[no-untyped-def]
    found = deviation(drawing, [off(20 * UM)])
    assert found.rms_mm == pytest.approx(20 * UM, abs=0.7 * UM)
    assert np.nanmean(found.error_mm) == pytest.approx(-20 * UM, abs=0.7 * UM)
    assert found.p95_mm == pytest.approx(20 * UM, abs=PIXELS_MM)


def test_a_bump_is_found_where_it_is(drawing) -> None:  # type: ignore[no-untyped-def]
    """100 um over 3 mm of a contour of 63 mm: no mean may hide it."""
    angle = np.arctan2(*(CIRCLE - MIDDLE).T[::-1])
    bump = 0.1 * np.exp(-((angle * RADIUS_MM / 1.5) ** 2))
    path = MIDDLE + (CIRCLE - MIDDLE) * (1 + bump / RADIUS_MM)[:, None]
    found = deviation(drawing, [path])
    assert found.max_mm == pytest.approx(
        0.1, abs=0.1 * (AVERAGED_MM / 1.5) ** 2 / 6 + PIXELS_MM
    )
    worst = found.points_mm[np.nanargmax(np.abs(found.error_mm))]
    assert worst == pytest.approx([MIDDLE + RADIUS_MM + 0.1, MIDDLE], abs=0.3)
    assert found.rms_mm < 0.025


def test_missed_ink_is_counted(drawing) -> None:  # type: ignore[no-untyped-def]
    """A path that stops after three quarters; a second line that no path covers; ink beside the line's own
    width.
    """
    quarter = 2 * np.pi * RADIUS_MM / 4
    most = deviation(drawing, [arc((MIDDLE, MIDDLE), RADIUS_MM, 0, 270)])
    assert most.missed_mm == pytest.approx(
        quarter, abs=2 * WIDTH_MM
    )  # the cover is broader than the path is long
    assert most.missed_share == pytest.approx(0.25, abs=0.02)
    other = polyline((4, 27), (24, 27))
    both = deviation(inked(CIRCLE, other), [CIRCLE])
    assert both.missed_mm == pytest.approx(20.5, rel=0.05)
    assert deviation(inked(CIRCLE, other), [CIRCLE, other]).missed_share == 0


def test_specks_are_not_missed_ink() -> None:
    specks = [arc((x, 26.0), 0.15) for x in np.arange(5, 25)]
    assert deviation(inked(CIRCLE, specks=specks), [CIRCLE]).missed_share == 0


def test_a_crossing_is_not_measured_but_the_rest_is() -> None:
    """In the ink of both lines there is no middle of one."""
    line, other = polyline((4, 10), (24, 10)), polyline((14, 4), (14, 16))
    found = deviation(inked(line, other), [line])
    unsure = ~np.isfinite(found.error_mm)
    assert 0 < unsure.mean() < 0.06
    assert np.abs(found.points_mm[unsure, 0] - 14).max() < 0.5
    assert found.max_mm < 10 * UM


def test_a_path_off_the_drawing_is_a_fault(drawing) -> None:  # type: ignore[no-untyped-def]
    for path in (CIRCLE + 200, CIRCLE - 200, polyline((100, 100), (101, 101))):
        with pytest.raises(
            MotionFault, match=r"lies nowhere on the drawing's ink; .* same scale and origin"
        ):
            deviation(drawing, [path])


def test_a_path_beside_the_lines_is_a_fault_that_names_the_cutter() -> None:
    """A cutter's path round a triangle crosses only the line that leaves its lower side, and that square."""
    triangle = polyline((6, 8), (30, 8), (18, 26), (6, 8))
    beside = polyline((2.4, 6), (33.6, 6), (18, 29.6), (2.4, 6))
    drawing = inked(triangle, polyline((18, 8), (18, 3)))
    with pytest.raises(MotionFault, match=r"runs beside it; .* give the --cutter"):
        deviation(drawing, [beside])


def test_a_path_that_never_has_its_tool_down_is_a_fault(drawing) -> None:  # type: ignore[no-untyped-def]
    up = Path(
        np.arange(len(CIRCLE)) * 0.1, np.column_stack([CIRCLE, np.full(len(CIRCLE), 2.0)])
    )
    with pytest.raises(MotionFault, match="no run with the tool in the work"):
        deviation(drawing, up)


def test_only_what_is_run_with_the_tool_down_counts(drawing) -> None:  # type: ignore[no-untyped-def]
    lead = polyline((0, 0), (MIDDLE + RADIUS_MM, MIDDLE))
    xy = np.vstack([lead, CIRCLE])
    z = np.r_[np.full(len(lead), 2.0), np.full(len(CIRCLE), -5.0)]
    path = Path(np.arange(len(xy)) * 0.1, np.column_stack([xy, z]))
    assert deviation(drawing, path).max_mm < PIXELS_MM


def test_a_point_repeated_or_a_stop_changes_nothing(drawing) -> None:  # type: ignore[no-untyped-def]
    stopping = np.repeat(CIRCLE, 2, axis=0)
    assert deviation(drawing, [stopping]).rms_mm == pytest.approx(
        deviation(drawing, [CIRCLE]).rms_mm, abs=0.01 * UM
    )


def test_what_the_head_follows_the_measure_finds_good(drawing) -> None:  # type: ignore[no-untyped-def]
    """Two ways to the same ink: cells and steering there, edges and the image's own interpolation here."""
    found = deviation(drawing, [trace(drawing).xy_mm])
    assert found.rms_mm < 4 * UM and found.max_mm < 25 * UM and found.missed_share == 0


TIPS_MM, DENTS_MM = 10.0, 5.0
SHARP_MM = (
    12 * UM
)  # places near a corner that are measured on one edge's pixels, of which some are blurred


@pytest.mark.parametrize("seed", [None, 1])
def test_right_corners_do_not_deviate(seed: int | None) -> None:
    """The middle between the edges lies up to a tenth of a width inside a corner; the pen ran round it."""
    angles = np.pi * np.arange(11) / 5 + 0.3
    radii = np.where(np.arange(11) % 2, DENTS_MM, TIPS_MM)
    star = MIDDLE + radii[:, None] * np.column_stack([np.cos(angles), np.sin(angles)])
    line = polyline(*(tuple(place) for place in star))
    assert deviation(inked(line, seed=seed), [line]).max_mm < SHARP_MM
