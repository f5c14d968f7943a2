"""Where the head ran from memory beside its ink, the way is bent onto it; everything else stays as it was."""

from __future__ import annotations

from contextlib import nullcontext
from typing import cast

import numpy as np
import pytest
import shapely

from morfax.motion.motion import MOTION_RATE_HZ
from morfax.tracer.drawing import coarse
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.following.line import Line
from morfax.tracer.head.leaders import REDRAWN
from morfax.tracer.head.settings import Settings
from morfax.tracer.operator.operator import Operator
from morfax.tracer.program.against_ink.boxed_lines import BoxedLines
from morfax.tracer.program.against_ink.off_ink import UsualPen
from morfax.tracer.program.laid import bent as bent_stretches
from morfax.tracer.program.laid.bent import bent
from morfax.tracer.program.laid.line_parts import LEGS
from morfax.tracer.program.lines.selection import Which
from morfax.tracer.program.setup import Setup
from morfax.tracer.program.trace_lines import found_lines
from morfax.tracer.sensing.view import STEP_WIDTHS
from morfax.tracer.tangles.seen_ink import SeenInk
from tests.tracer.inked import UM, Points, arc, inked, polyline
from tests.tracer.program.laid.ways import off_mm, run_along

WIDTH_MM, DPI = 0.35, 300.0
RELIEF_MM = 0.7  # the radius of a relief at an inner corner


def plate(*inner: tuple[float, float]) -> Points:
    """A plate of 30 x 16 mm with some places in its upper side."""
    return polyline((4, 4), (34, 4), (34, 20), *inner, (4, 20), (4, 4))


def with_reliefs() -> Points:
    """A plate, a little turned, with three slots in its upper side and a relief about each inner corner."""
    slots = shapely.Polygon()
    for left in (7, 16, 25):
        slots = slots.union(shapely.box(left, 16, left + 5, 21))
        for x in (left, left + 5):
            slots = slots.union(shapely.Point(x, 16).buffer(RELIEF_MM, quad_segs=32))
    drawn = shapely.affinity.rotate(shapely.box(4, 4, 34, 20).difference(slots), 7)
    return np.array(drawn.exterior.coords)


def before_and_after(
    *lines: Points, seed: int = 1, width_mm: float = WIDTH_MM
) -> tuple[list[Line], list[Line]]:
    """The lines of a sheet as the head ran along them, and as they are bent."""
    drawing = inked(*lines, width_mm=width_mm, dpi=DPI, seed=seed)
    return as_found_and_bent(drawing, (1,) if len(lines) == 1 else "contours")


def as_found_and_bent(drawing: Drawing, which: Which) -> tuple[list[Line], list[Line]]:
    """The lines of a drawing as the head ran along them, and as they are bent."""
    setup = Setup(drawing.sheet, Settings(), Operator())
    found = found_lines(setup, which).lines
    return found, bent(setup, found)


def with_knob() -> Points:
    """A plate with a puzzle piece's knob of 6.3 mm on its upper side, whose neck has two corners a side."""
    neck = np.degrees(np.arcsin(2.24 / 3.15))
    knob = arc((19, 22.91), 3.15, 270 + neck, 630 - neck)
    return plate((21.24, 20), *map(tuple, knob), (16.76, 20))


def stairs() -> Points:
    """A stroke of four steps down and four up, 1.2 widths high, whose corners have radii of half a width."""
    rise = 1.2 * WIDTH_MM * 1j
    corners = complex(4, 12) + np.cumsum([0, *(4 * [3, -rise]), *(4 * [3, rise]), 3])
    way, radius_mm = [corners[0]], 0.5 * WIDTH_MM
    for before, corner, after in zip(corners, corners[1:], corners[2:], strict=False):
        come, go = (
            (corner - before) / abs(corner - before),
            (after - corner) / abs(after - corner),
        )
        turns = np.linspace(0.0, np.pi / 2, 30)
        way.extend(corner + radius_mm * ((np.sin(turns) - 1) * come + (1 - np.cos(turns)) * go))
    places = np.array([*way, corners[-1]])
    return np.column_stack([places.real, places.imag])


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_steps_of_an_open_line_are_followed_as_they_are_drawn(seed: int) -> None:
    """Away from its ends within 50 um; the head's own way is twice as far off. Its ends stay."""
    (own,), (line,) = before_and_after(stairs(), seed=seed)
    inner = shapely.box(5.0, 0.0, stairs()[-1, 0] - 1.0, 30.0)
    true, *ways = (
        shapely.LineString(way).intersection(inner) for way in (stairs(), own.xy_mm, line.xy_mm)
    )
    away = [true.hausdorff_distance(way) for way in ways]
    assert own.ending == line.ending == "ended"
    assert away[1] < 50 * UM < away[0], away
    assert np.array_equal(line.xy_mm[[0, -1]], own.xy_mm[[0, -1]])


@pytest.mark.parametrize("hook_widths", [1.0, 1.5])
def test_hooks_at_the_ends_of_an_open_line_are_left_as_the_head_ran(hook_widths: float) -> None:
    """There is no clean line on their far side, from which a spline could go on."""
    hook_mm = hook_widths * WIDTH_MM
    truth = polyline((5, 12 + hook_mm), (5, 12), (30, 12), (30, 12 - hook_mm))
    (own,), (line,) = before_and_after(truth)
    assert own.ending == "ended" and line is own


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_reliefs_of_inner_corners_are_followed_as_they_are_drawn(seed: int) -> None:
    """Within 45 um, half a pixel; the head's own way is farther off. It jumps onto no stretch: no
    step is longer than 10 mm/s makes it by an increment of 1 um.
    """
    truth = with_reliefs()
    (own,), (line,) = before_and_after(truth, seed=seed)
    assert off_mm(line, truth) < min(45 * UM, off_mm(own, truth))
    assert REDRAWN in line.led.leaders
    assert np.hypot(*np.diff(line.xy_mm, axis=0).T).max() < 10.0 / MOTION_RATE_HZ + UM
    assert len(line.led.of(len(line.xy_mm))) == len(line.xy_mm)


def test_reliefs_are_followed_on_a_scan_whose_pixels_were_made_finer() -> None:
    """Lines of 2.4 pixels: within 60 um, half a pixel; the head's own way is 114 um off."""
    truth = with_reliefs()
    scan = inked(truth, width_mm=0.3, dpi=200.0, seed=1)
    finer, pitch_mm = coarse.finer(scan.darkness, coarse.TIMES), scan.pitch_mm / coarse.TIMES
    drawing = Drawing(finer, pitch_mm, finer=coarse.TIMES)
    (own,), (line,) = as_found_and_bent(drawing, (1,))
    assert off_mm(line, truth) < 60 * UM < 100 * UM < off_mm(own, truth)


def test_corners_with_a_bent_leg_are_followed_though_they_leave_little_ink() -> None:
    """A bulge of 47 um beside a line of 0.7 mm leaves hardly more ink than the spline takes figures."""
    truth = with_knob()
    (own,), (line,) = before_and_after(truth, width_mm=2 * WIDTH_MM)
    assert off_mm(line, truth) < 30 * UM < 40 * UM < off_mm(own, truth)


def test_a_line_on_its_ink_is_the_very_same() -> None:
    """A circle, which the cell leads along, and a plate with right corners."""
    for truth in (arc((19, 12), 7, 0, 360), plate()):
        (own,), (line,) = before_and_after(truth)
        assert line is own


@pytest.mark.parametrize("reach_widths", [0.5, 0.8, 1.2])
def test_no_line_goes_out_along_burrs_and_ticks(reach_widths: float) -> None:
    """Not farther from its side than the head did, by more than 20 um."""
    ticks = [
        polyline((x, 4), (x, 4 + side * reach_widths * WIDTH_MM))
        for x, side in ((8, 1), (14, -1), (20, 1), (26, -1))
    ]
    (own, *_), (line, *_) = before_and_after(plate(), *ticks)
    true = shapely.LineString(plate())
    away = [
        max(true.distance(shapely.Point(place)) for place in it.loop_mm[::4])
        for it in (own, line)
    ]
    assert away[1] < away[0] + 20 * UM


def test_a_bar_that_joins_the_line_is_left_alone() -> None:
    """The outline stays on its sides within 60 um where a bar that is left out joins them."""
    bar = polyline((4, 12), (34, 12))
    _, lines = before_and_after(plate(), bar)
    line = max(lines, key=lambda it: it.length_mm)
    true = shapely.LineString(plate())
    assert max(true.distance(shapely.Point(place)) for place in line.loop_mm[::4]) < 60 * UM


def test_lines_of_a_drawn_program_are_as_they_are() -> None:
    drawing = inked(with_reliefs(), width_mm=WIDTH_MM, dpi=DPI, seed=1)
    setup = Setup(drawing.sheet, Settings(), Operator(marks="on"))
    found = found_lines(setup, "contours").lines
    assert all(new is old for new, old in zip(bent(setup, found), found, strict=True))


def test_stretches_that_are_chosen_near_one_another_are_one_and_may_go_over_the_end() -> None:
    chosen = np.zeros(50, bool)
    chosen[[2, 5, 20, 47]] = True
    assert list(bent_stretches.runs_of(chosen, 4, True)) == [(47, 55), (70, 70)]
    assert list(bent_stretches.runs_of(chosen, 4, False)) == [(2, 5), (20, 20), (47, 47)]
    assert list(bent_stretches.runs_of(np.ones(50, bool), 4, True)) == [(0, 49)]
    assert not list(bent_stretches.runs_of(np.zeros(50, bool), 4, True))


def test_a_stretch_ends_away_from_corners() -> None:
    """By a leg of 15 places beyond one that is nearer than half of that."""
    assert bent_stretches._off_corners(40, [36, 90], -1) == 21
    assert bent_stretches._off_corners(40, [36, 90], 1) == 51
    assert bent_stretches._off_corners(60, [36, 90], 1) == 60


def test_nothing_is_laid_nearer_than_half_a_leg_to_an_end_of_an_open_line(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """There the way has no leg by which it could be laid: the ink is not even looked at."""
    drawn = polyline((4, 4), (24, 6))
    setup = Setup(inked(drawn, width_mm=WIDTH_MM).sheet)
    line = run_along(drawn, "ended")
    way = bent_stretches._Way(setup, line, BoxedLines.of([line]))
    looked_at = list[tuple[int, int]]()

    def seen(_: object, first: int, last: int, felt: object) -> tuple[SeenInk, Points]:
        looked_at.append((first, last))
        raise LookupError

    monkeypatch.setattr(bent_stretches._Way, "_seen", seen)
    leg, felt = round(LEGS[0] / STEP_WIDTHS), cast(UsualPen, None)
    last = len(way.way) - 1 - leg
    for off, is_laid in ((leg // 3, False), (leg - 2, True)):
        for first in (leg + off, last - off - 20):
            with nullcontext() if not is_laid else pytest.raises(LookupError):
                assert way._bay(first, first + 20, felt) is None
    assert len(looked_at) == 2
