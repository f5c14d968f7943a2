"""Lines that swell, fade, or go on with another pen are followed whole, along their middle.

Bounds: 2.2 um RMS and 10 um are what the smooth closed lines of one width are held to; a step in the width is
an end of one line's ink and the beginning of the other's, 25 um; at a corner of two widths the vertex is
where the middles meet, 50 um as for any right-angled corner.
"""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise

import cv2
import numpy as np
import pytest

from morfax.motion.arrays import Array
from morfax.motion.contour import distance, length_mm
from morfax.motion.units import MM_PER_INCH
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.junctions.width_change import _straight_ahead, another_pen
from morfax.tracer.program.trace import trace
from morfax.tracer.sensing.leg import leg_of
from morfax.tracer.sensing.photocell import Cells, behind_aperture
from morfax.tracer.sensing.view import View
from tests.tracer.inked import DPI, UM, arc, inked, polyline, together

SEEDS = pytest.mark.parametrize("seed", [1, 2, 3])
PIXEL_MM = MM_PER_INCH / DPI
CENTRE, RADIUS_MM = (26.0, 26.0), 20.0


def held_to(drawing: Drawing, line: Array, rms_um: float, most_um: float) -> None:
    """The drawing's line is followed as one closed path, on it and all of it."""
    run = trace(drawing).lines[0]
    apart = distance(run.xy_mm[::4], line)
    assert run.ending == "closed"
    assert apart.path_to_reference.rms_mm < rms_um * UM
    assert apart.path_to_reference.max_mm < most_um * UM
    assert apart.reference_to_path.max_mm < most_um * UM
    assert run.length_mm == pytest.approx(length_mm(line), rel=2e-3)


def parts(widths_mm: list[float]) -> list[tuple[Array, float]]:
    """A circle in as many arcs, each with its width."""
    ends = np.linspace(0, 360, len(widths_mm) + 1)
    return [
        (arc(CENTRE, RADIUS_MM, a, b), w)
        for a, b, w in zip(ends, ends[1:], widths_mm, strict=False)
    ]


@SEEDS
def test_a_line_that_swells_to_three_times_its_width_and_back(seed: int) -> None:
    angle = np.linspace(0, math.tau, 721)[:-1]
    drawing = together(*parts(list(0.6 + 0.3 * np.cos(2 * angle + seed))), seed=seed)
    held_to(drawing, arc(CENTRE, RADIUS_MM), rms_um=2.5, most_um=12)


@SEEDS
@pytest.mark.parametrize("wider_mm", [0.55, 0.7, 1.0])
def test_a_line_that_goes_on_with_a_wider_pen(wider_mm: float, seed: int) -> None:
    drawing = together(*parts([0.4, 0.4, wider_mm, 0.4, 0.4]), seed=seed)
    held_to(drawing, arc(CENTRE, RADIUS_MM), rms_um=4, most_um=25)


@SEEDS
@pytest.mark.parametrize("thin_mm", [0.3, 0.5])
def test_shade_lines_meet_thin_ones_at_the_vertex(thin_mm: float, seed: int) -> None:
    places = [(6.0, 6.0), (40.0, 9.0), (36.0, 30.0), (20.0, 38.0), (8.0, 28.0), (6.0, 6.0)]
    sides = [polyline(a, b) for a, b in pairwise(places)]
    widths_mm = [0.9, 0.9, thin_mm, thin_mm, thin_mm]
    drawing = together(*zip(sides, widths_mm, strict=True), seed=seed)
    held_to(drawing, polyline(*places), rms_um=8, most_um=50)


@SEEDS
def test_a_line_beside_it_is_no_wider_pen(seed: int) -> None:
    """A second line runs along the first for 12 mm, half a width aside: the head stays on its own."""
    own, beside = polyline((4, 10), (50, 10)), polyline((20, 10.3), (32, 10.3))
    run = trace(inked(own, beside, seed=seed), start_mm=(4, 10)).lines[0]
    assert run.ending == "ended"
    assert distance(run.xy_mm[::4], own).path_to_reference.max_mm < 60 * UM


@SEEDS
def test_the_grain_of_faint_pencil_is_no_end(seed: int) -> None:
    """A third as dark as ink, so that noise is thrice as strong, and a grain of 25 % a quarter of a
    millimetre wide.

    The ink's own middle wanders with its grain: 30 um RMS.
    """
    line = arc(CENTRE, RADIUS_MM)
    inky = inked(line, width_mm=0.4).darkness
    random = np.random.default_rng(seed)
    grain = cv2.GaussianBlur(random.normal(size=inky.shape).astype(np.float32), (0, 0), 1.2)
    faint = inky * np.clip(1 + 0.25 * grain / grain.std(), 0, 2) + random.normal(
        0, 0.04 / 0.35, inky.shape
    )
    run = trace(Drawing(np.asarray(faint, np.float32), MM_PER_INCH / DPI)).lines[0]
    apart = distance(run.xy_mm[::4], line)
    assert run.ending == "closed"
    assert apart.path_to_reference.rms_mm < 30 * UM
    assert apart.reference_to_path.max_mm < 0.4


def test_a_gap_wider_than_allowed_ends_a_line_for_the_larger_cell_too() -> None:
    """0.7 mm of paper between two clean pieces, where 0.5 mm is crossed: the fine cell and the larger one
    agree.
    """
    run = trace(
        inked(polyline((4, 10), (30, 10)), polyline((31.2, 10), (50, 10)), seed=1),
        start_mm=(6, 10),
    ).lines[0]
    assert run.ending == "ended"
    assert run.xy_mm[:, 0].max() == pytest.approx(30, abs=0.05)


def test_a_larger_cell_that_sees_no_edges_changes_nothing() -> None:
    """On solid ink no station has an edge: the view is as it was."""
    solid = inked(polyline((4, 10), (30, 10)), width_mm=8.0)
    view = View(Cells(solid.darkness, solid.pitch_mm, 0.5), 0.5)
    stations = np.column_stack([np.linspace(10, 12, 30), np.full(30, 10.0), np.full(30, 0.5)])
    assert view.through_larger(stations, 0.0, lambda seen: 5.0) is view


def test_larger_cells_see_within_their_reach_what_they_see_of_the_whole_sheet() -> None:
    drawing, reach_mm = inked(polyline((4, 10), (40, 10)), seed=1), 5.0
    view = View(Cells(drawing.darkness, drawing.pitch_mm, 0.5), 0.5)
    stations = np.column_stack([np.linspace(10, 12, 30), np.full(30, 10.0), np.full(30, 0.5)])
    some = view.through_larger(stations, 0.0, lambda seen: reach_mm)
    all_of_it = view.through_larger(stations, 0.0, lambda seen: 100.0)
    places = stations[-1, :2] + np.random.default_rng(1).uniform(-0.7, 0.7, (500, 2)) * reach_mm
    assert np.array_equal(some.darkness_along(places), all_of_it.darkness_along(places))
    assert some.width_mm == all_of_it.width_mm
    beyond = np.array([30.0, 10.0])
    assert some.darkness_at(beyond) == 0.0 != all_of_it.darkness_at(beyond)


@pytest.mark.parametrize(("widths", "is_one"), [(5.0, False), (11.0, True)])
def test_another_pen_s_line_is_as_wide_for_eight_widths(widths: float, is_one: bool) -> None:
    """Two lines that run together are as wide for less."""
    wide_mm, begin_mm = 0.8, 8.0
    drawn = together(
        (polyline((4, 10), (begin_mm + widths * wide_mm, 10)), wide_mm),
        (polyline((begin_mm + widths * wide_mm, 10), (26, 10)), 0.5),
        seed=1,
    )
    view = View(behind_aperture(drawn, 0.15), 0.5)
    leg = leg_of(
        replace(view, width_mm=wide_mm).feel(np.array([begin_mm - 2, 10.0]), 0.0, 2.0),
        True,
        view.leg_mm,
    )
    assert another_pen(view, leg) is is_one


@pytest.mark.parametrize(("times", "is_line"), [(3.0, True), (4.2, False)])
def test_what_is_more_than_three_and_a_half_times_as_wide_ahead_is_no_line(
    times: float, is_line: bool
) -> None:
    drawn = together(
        (polyline((4, 12), (14, 12)), 0.5), (polyline((14, 12), (30, 12)), 0.5 * times), seed=1
    )
    view = View(behind_aperture(drawn, 0.15), 0.5)
    incoming = leg_of(view.feel(np.array([8.0, 12.0]), 0.0, 4.0), True, view.leg_mm)
    assert bool(list(_straight_ahead(view, incoming))) is is_line


@pytest.mark.parametrize("width_mm", [0.3, 0.5, 1.2])
def test_a_pen_twice_as_broad_straight_ahead_is_a_line_however_broad_the_first_is(
    width_mm: float,
) -> None:
    drawn = together(
        (polyline((4, 12), (16, 12)), width_mm), (polyline((16, 12), (40, 12)), 2 * width_mm)
    )
    view = View(behind_aperture(drawn, 0.06), width_mm)
    incoming = leg_of(view.feel(np.array([10.0, 12.0]), 0.0, 8.0), True, view.leg_mm)
    onward = next(_straight_ahead(view, incoming))
    assert onward.leg.width_mm == pytest.approx(2 * width_mm, abs=0.5 * PIXEL_MM)
