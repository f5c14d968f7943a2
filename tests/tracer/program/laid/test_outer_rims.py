"""Outer rims: rows of teeth that the head rounds come to lie where they were drawn, and right ways stay."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from morfax.motion.polyline import closed_up, evenly, nearest_mm, with_places
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.ink.rim import RimCorners
from morfax.tracer.program.against_ink.boxed_lines import BoxedLines
from morfax.tracer.program.against_ink.own_ink import OwnInk
from morfax.tracer.program.laid.corner_chains import with_chains
from morfax.tracer.program.laid.laid_way import LaidWay
from morfax.tracer.program.laid.outer_rims import (
    _gain,
    _is_along,
    _OuterRims,
    with_outer_rims,
)
from morfax.tracer.program.laid.rim_bays import within_outer_rims
from morfax.tracer.program.setup import Setup
from morfax.tracer.program.trace import trace
from tests.tracer.inked import UM, Points, arc, inked, polyline
from tests.tracer.program.laid.ways import run_along, turned

PEN_MM, DPI = 0.341, 200.0  # 2.7 pixels
FELT_MM = 0.37  # its width, as cells feel it


def rack() -> Points:
    """A bar with eight teeth one and a half lines high along one side, turned, on a sheet."""
    pitch, high, top, root = 2.05, 0.53, 0.31, 0.29
    tooth = (-root / 2, 0), (root / 2, 0), (0.5 - top / 2, high), (0.5 + top / 2, high)
    teeth = [(pitch * (n + 1 + at), 7.34 + up) for n in range(8) for at, up in tooth]
    end = 9 * pitch
    back = (end, 7.34), (end + 2, 7.34), (end + 2, 0), (0, 0)
    return turned(polyline((0, 0), (0, 7.34), *teeth, *back), math.radians(30.14))


def furthest_mm(drawn: Points, way: Points) -> float:
    """How far a way and the drawn one lie apart, at most."""
    truth, way = with_places(drawn, 0.01), with_places(way, 0.01)
    return float(max(nearest_mm(truth, way).max(), nearest_mm(way, truth).max()))


@pytest.mark.parametrize("seed", [3, 4])
def test_a_rack_at_a_coarse_scan_has_all_its_teeth(seed: int) -> None:
    """Within half a pixel; the head rounds pairs of corners, and is 110 um off in silence."""
    drawn = rack()
    (line,) = trace(inked(drawn, width_mm=PEN_MM, dpi=DPI, seed=seed)).lines
    assert line.ending == "closed"
    assert furthest_mm(drawn, line.loop_mm) < 60 * UM


def test_the_way_within_the_outer_rims_goes_round_all_corners_of_teeth() -> None:
    """Within a third of a pixel along one of them; mitred where it turns towards the ink it is 51 um off."""
    drawn = rack()
    sheet = inked(drawn, width_mm=PEN_MM, dpi=DPI, seed=3).sheet
    ways = list(within_outer_rims(Setup(sheet), FELT_MM, evenly(drawn, 0.1)))
    assert len(ways) == 2
    assert min(furthest_mm(drawn, closed_up(way)) for way in ways) < 42 * UM


def test_a_corner_goes_over_to_the_way_that_comes_near_on_both_sides_of_it() -> None:
    """Round a square of 10 mm: of two others, that which runs the other way 0.1 mm beside it for a while."""
    round_ = np.array(
        [(0, 0), (5, 0), (10, 0), (10, 5), (10, 10), (5, 10), (0, 10), (0, 5)], float
    )
    corners = RimCorners(round_, np.zeros(8), np.array([[1, 3]]), 1.0)
    near = np.array([(10.1, 5), (10.3, 3), (7, -0.3), (5, -0.1), (0, -9.0)])
    further = near + np.array([0.3, -0.3])
    over = np.vstack([round_[:2], near[3::-1], round_[3:]])
    assert corners.over_to([further, near], 0.2) == pytest.approx(over)
    assert corners.over_to([further], 0.2) == pytest.approx(round_)
    assert corners.over_to([], 0.2) == pytest.approx(round_)


def test_a_line_on_its_ink_stays_as_the_head_ran() -> None:
    drawn = polyline((5, 5), (25, 5), (25, 15), (20, 15), (18, 12), (16, 15), (5, 15), (5, 5))
    drawing = inked(drawn, seed=3)
    own = OwnInk(drawing, trace(drawing).lines)
    along = with_outer_rims(Setup(drawing.sheet), own, np.ones(1, bool))
    assert along.own is own
    assert not along.laid.any()
    assert not len(along.places_mm)


def test_what_noise_may_gain_is_no_gain() -> None:
    """A way 20 um beside 2 mm of its ink, and one on it: the difference tells on a scan, and on paper with
    four times its noise it does not.
    """
    drawn = polyline((5, 5), (25, 5), (25, 15), (5, 15), (5, 5))
    quiet, line = inked(drawn, seed=3), run_along(drawn)
    noise = np.random.default_rng(4).normal(0, 0.16, quiet.darkness.shape)
    loud = Drawing((quiet.darkness + noise).astype(np.float32), quiet.pitch_mm)
    for drawing, is_gain in ((quiet, True), (loud, False)):
        way = _OuterRims(Setup(drawing.sheet), line, BoxedLines.of([line]), 0.0)
        seen = way.about(110, 210, np.empty((0, 2)))
        assert seen is not None
        is_aside = (seen.own[:, 0] > 12) & (seen.own[:, 0] < 14)
        aside = seen.own + np.column_stack([0 * is_aside, 20 * UM * is_aside])
        assert (_gain(seen._replace(own=aside), LaidWay((seen.own,), 0.25)) > 0) == is_gain
        assert _gain(seen, LaidWay((aside,), 0.25)) == 0


def test_chains_are_asked_where_a_line_was_laid_anew() -> None:
    """A rack's tooth is laid 50 um aside: too little to be told as beside its ink, if that is told at all."""
    drawn = rack()
    drawing = inked(drawn, width_mm=PEN_MM, dpi=DPI, seed=3)
    aside = drawn.copy()
    aside[8:10] += 0.05 * (drawn[9] - drawn[10]) / np.hypot(*(drawn[9] - drawn[10]))
    own = OwnInk(drawing, [replace(run_along(aside), width_mm=FELT_MM)])
    own.__dict__["doubtful"] = np.zeros(1, bool)
    assert with_chains(Setup(drawing.sheet), own) is own
    (line,) = with_chains(Setup(drawing.sheet), own, drawn[8:10]).lines
    assert furthest_mm(drawn, line.loop_mm) < 30 * UM < furthest_mm(drawn, aside)


def test_a_way_out_along_a_burr_and_back_is_none() -> None:
    """A tick of 0.6 mm aside of a straight line, which a way out and back explains."""
    drawn = polyline((5, 5), (25, 5), (25, 15), (5, 15), (5, 5))
    drawing, line = inked(drawn, polyline((13, 5), (13, 5.6)), seed=3), run_along(drawn)
    way = _OuterRims(Setup(drawing.sheet), line, BoxedLines.of([line]), 0.0)
    seen = way.about(110, 210, np.empty((0, 2)))
    assert seen is not None
    out = polyline(tuple(seen.own[0]), (13, 5), (13, 5.6), (13, 5), tuple(seen.own[-1]))
    assert seen.ink.misfit_along(out) < 0.2 * seen.ink.misfit_along(seen.own)
    assert _gain(seen, LaidWay((out,), 0.25)) == 0


def test_a_lobe_is_not_gone_round_the_other_way() -> None:
    """Where a line crosses itself the way within the rims goes round a lobe in either direction: of a drawn
    eight the crossing became a touch, 63 um off.
    """
    lobe = arc((0.0, 0.0), 5.0)
    assert _is_along(lobe * 1.01, lobe, 1.5)
    assert not _is_along(lobe[::-1], lobe, 1.5)
