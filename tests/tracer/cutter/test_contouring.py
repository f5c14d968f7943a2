"""Contouring: the way round by nesting and side, leads in the scrap, the start of a cut, and what is drawn on
the lines, on lines of exact shape.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from shapely import LineString, Point, Polygon

from morfax.motion.arrays import Array
from morfax.motion.motion import join
from morfax.motion.polyline import Nearest, area_mm2, plain
from morfax.tracer.cutter.contouring import Contouring, Lead
from morfax.tracer.cutter.cutter import Cutter
from morfax.tracer.following.line import Line
from morfax.tracer.program.program import Trace
from tests.tracer.cutter.contours import (
    LEVELS,
    ON_LINE_MM,
    circle,
    closed,
    cut,
    loop,
    square,
)

GOUGE_MM = 0.005  # what the cutter allows itself: smoothing of the feed, and the offset's own precision


def star(seed: int, tips: int = 9) -> list[tuple[float, float]]:
    """A shape with tips and hollows of chance sizes, 20 to 40 mm from its middle."""
    chance = np.random.default_rng(seed)
    radii, angles = chance.uniform(20, 40, tips), np.arange(tips) * 2 * math.pi / tips
    return [
        (float(r * math.cos(a)), float(r * math.sin(a)))
        for r, a in zip(radii, angles, strict=True)
    ]


def outline(xy_mm: Array) -> LineString:
    """The same line by few places, 0.1 um true."""
    return LineString(plain(np.ascontiguousarray(xy_mm), 1e-4))


def leads(line: Line) -> list[Array]:
    """The leads of a line, from the cut outwards, (n, 2) mm."""
    into, out = line.xy_mm[: line.first + 1][::-1], line.xy_mm[line.last :]
    return [lead for lead in (into, out) if len(lead) > 1]


@pytest.mark.parametrize(
    ("side", "climbs"),
    [
        (None, (-1, 1, -1)),
        ("outside", (-1, 1, -1)),
        ("inside", (1, -1, 1)),
        # by the head's travel: the tool is inside of lines 1 and 2 on their left, outside of 3
        ("left", (-1, 1, 1)),
        ("right", (1, -1, -1)),
    ],
)
@pytest.mark.parametrize("milling", ["climb", "conventional"])
@pytest.mark.parametrize("lead_in", [None, Lead(2.0)])
def test_of_three_nested_lines_each_turns_by_its_depth_and_the_side_of_the_tool(
    side: Any, climbs: tuple[int, int, int], milling: Any, lead_in: Lead | None
) -> None:
    """In climb milling the tool is on the left of its travel: the signed areas of lines 3, 2, 1."""
    cutter = None if side is None else Cutter(3.0, side)
    made = cut(LEVELS, Contouring(milling, lead_in), cutter)
    ways = [int(np.sign(area_mm2(loop(line)))) for line in made.lines]
    assert ways == [way if milling == "climb" else -way for way in climbs]


def test_a_line_that_turns_the_right_way_already_keeps_the_head_s_own_motion() -> None:
    made = cut(LEVELS, Contouring("climb"), None)
    kept = [
        np.array_equal(a.xy_mm, b.xy_mm) for a, b in zip(made.lines, LEVELS.lines, strict=True)
    ]
    assert kept == [True, True, False]  # only line 1 turns


def test_lines_turned_round_and_begun_elsewhere_stay_where_they_were() -> None:
    made = cut(LEVELS, Contouring("conventional", start_at="corner"), None)
    for before, after in zip(LEVELS.lines, made.lines, strict=True):
        away = outline(before.xy_mm).hausdorff_distance(outline(loop(after)))
        assert away < ON_LINE_MM
        corner = np.abs(np.abs(after.xy_mm[0]) - np.abs(before.xy_mm).max()).max()
        assert corner < ON_LINE_MM


PART = Trace(
    (
        closed(circle(5, 0, 8), 4),
        closed(square(4, 0, -8), 3),
        closed(circle(2, 9, -4), 2),
        closed(star(5), 1),
    )
)
SOLID = Polygon(star(5), [circle(5, 0, 8), square(4, 0, -8), circle(2, 9, -4)])


@pytest.mark.parametrize("kind", ["arc", "line"])
@pytest.mark.parametrize("start_at", [None, "corner", "nearest"])
@pytest.mark.parametrize(
    ("milling", "diameter_mm"), [("climb", 0.0), ("climb", 2.0), ("conventional", 2.0)]
)
def test_leads_lie_in_the_scrap_and_cross_nothing(
    kind: Any, start_at: Any, milling: Any, diameter_mm: float
) -> None:
    cutter = Cutter(diameter_mm) if diameter_mm else None
    asked = Contouring(milling, Lead(3.0, kind), Lead(2.0, kind), start_at)
    made = cut(PART, asked, cutter)
    edges = SOLID.boundary
    assert len(made.lines) == len(PART.lines)
    for line in made.lines:
        assert line.leads is not None and line.leads.in_mm > 0
        path = outline(loop(line))
        for lead in leads(line):
            # 1. outside of the part, and the tool no nearer to it than its radius
            assert not SOLID.contains(Point(lead[-1]))
            assert outline(lead).distance(edges) >= 0.5 * diameter_mm - GOUGE_MM
            # 2. where it has left the line it does not come back to it, nor to another one
            away = np.hypot(*(lead - lead[0]).T)
            beyond = outline(lead[away > 0.5 * away[-1]])
            size_mm = min(line.leads.in_mm, line.leads.out_mm)
            assert beyond.distance(path) > 0.08 * size_mm
            assert beyond.distance(edges) > 0.08 * size_mm
    if cutter is not None:
        motion = join(made).positions_mm
        in_work = motion[motion[:, 2] < 0, :2]
        near = Nearest([line.xy_mm for line in PART.lines], cutter.radius_mm)
        assert near.distances_mm(in_work).min() >= cutter.radius_mm - GOUGE_MM
