"""Corners that lie in the ink of other lines: how lines go on there is told by the ink."""

from __future__ import annotations

import numpy as np
import pytest
import shapely

from morfax.tracer.following.line import Line
from morfax.tracer.head.settings import Settings
from morfax.tracer.ink import crossing
from morfax.tracer.ink.crossing import Crossing
from morfax.tracer.ink.crossing_ink import WaysOn
from morfax.tracer.ink.lifted import Loose
from morfax.tracer.program.trace_ink import trace_ink
from morfax.tracer.sensing import photocell
from morfax.tracer.sensing.leg import leg_of
from morfax.tracer.sensing.view import View
from tests.tracer.inked import UM, WIDTH_MM, Points, inked, polyline

# a stroke from its line, at most: corners in others' ink are three times as far off as alone
OFF_MM = 60 * UM
LEG_MM = 4.0  # legs of a wide junction are as long: they tell how a line bends


def each_by_a_stroke(lines: list[Points], seed: int) -> list[float]:
    """How far each line is from that stroke which is nearest to all of it, mm."""
    strokes = [shapely.LineString(line.xy_mm[::5]) for line in _strokes(lines, seed)]
    return [
        min(shapely.hausdorff_distance(shapely.LineString(line), each) for each in strokes)
        for line in lines
    ]


def _strokes(lines: list[Points], seed: int) -> list[Line]:
    return list(trace_ink(inked(*lines, seed=seed)).lines)


ACROSS = polyline((4, 20), (36, 20))
# a corner beside that line or in it, and of some a third line that passes there
TIPS = {
    "beyond": [
        polyline((21.5, 6.8), (20, 20.7), (32.9, 15.2)),
        polyline((29.9, 7.4), (10.1, 32.6)),
    ],
    "above": [
        polyline((32.9, 15.5), (19.9, 20.7), (29.1, 31.3)),
        polyline((31.3, 8.7), (8.7, 31.3)),
    ],
    "below": [
        polyline((28.7, 8.6), (19.5, 19.2), (32.8, 23.5)),
        polyline((21.4, 4.1), (18.6, 35.9)),
    ],
    "within": [polyline((33.2, 14.8), (20, 19.6), (31.5, 27.6))],
    # the ink tells of two ends, or of two lines that bend, as well as of a corner
    "beside": [
        polyline((15.7, 33.7), (20, 20.36), (32.4, 26.9)),
        polyline((18.6, 7.6), (23.6, 33)),
    ],
    "below the middle": [
        polyline((14.5, 32.8), (20, 19.89), (25.4, 32.8)),
        polyline((20.6, 7.3), (21.4, 33.3)),
    ],
}


@pytest.mark.parametrize("seed", [1, 2])
@pytest.mark.parametrize("tip", TIPS)
def test_a_corner_in_the_ink_of_another_line_is_its_lines(tip: str, seed: int) -> None:
    assert max(each_by_a_stroke([ACROSS, *TIPS[tip]], seed)) < OFF_MM


# a side in the ink of another line; three corners where four lines meet
CROWDS = {
    "side": [
        polyline((20, 4), (20, 36)),
        polyline((5, 30), (19.77, 30), (19.77, 12), (5, 12)),
    ],
    "corners": [
        polyline((15.67, 31.2), (18.04, 18.59), (32, 21.21)),
        polyline((18.27, 8), (18.27, 19.2), (32, 19.2)),
        polyline((8, 32.4), (21.95, 18.78), (12, 8.7)),
        polyline((23.4, 28), (23.7, 19), (24.9, 10)),
    ],
}


@pytest.mark.parametrize("seed", [1, 2])
@pytest.mark.parametrize("crowd", CROWDS)
def test_lines_exchange_their_partners_until_they_explain_their_ink(
    crowd: str, seed: int
) -> None:
    """None of the five likeliest ways to go on was right: a side was run as the line beside it, 0.23 mm off,
    and two corners ended in each other's ink.
    """
    assert max(each_by_a_stroke(CROWDS[crowd], seed)) < OFF_MM


# a corner that the ink tells badly: in that of another corner, and at the side of a line
DEEP = {
    "corners": [
        polyline((14.2, 27.34), (19.74, 19.87), (12.92, 14.82)),
        polyline((5, 20.3), (20.29, 20.3), (20.29, 7.7)),
    ],
    "beside": [
        polyline((30.26, 3.58), (15.7, 27.74)),
        polyline((21.68, 3.31), (19.85, 19.93), (3.64, 18.14)),
    ],
}


@pytest.mark.parametrize("seed", [0, 2, 3])
@pytest.mark.parametrize("crowd", DEEP)
def test_a_corner_deep_in_others_ink_lies_where_its_legs_lead(crowd: str, seed: int) -> None:
    """Its place is the legs' to tell: two corners exchanged a side each, and one lay 0.2 mm aside of its leg,
    where the ink was explained as well.
    """
    one, other = DEEP[crowd]
    shift = np.random.default_rng(seed).uniform(-0.05, 0.05, 2)
    assert max(each_by_a_stroke([one, other + shift], seed)) < OFF_MM


ENDED = {"one": ([ACROSS, polyline((14, 4), (20, 20))], 1), "side": (CROWDS["side"], 21)}


@pytest.mark.parametrize("ended", ENDED)
def test_where_lines_end_in_ink_is_asked_once_of_each_way_to_go_on(
    ended: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A third of all that was asked on a page of gears had been asked before; of the side 6 of 27."""
    asked, ends_in_ink_mm = list[bytes](), crossing.ends_in_ink_mm

    def counted(loose: list[Loose], lines_mm: Points, **rest: bool) -> list[float | None]:
        legs = [line.leg.end_mm.tobytes() for line in loose]
        asked.extend([b"".join([*legs, lines_mm.tobytes()])] if loose else [])
        return ends_in_ink_mm(loose, lines_mm, **rest)

    monkeypatch.setattr(crossing, "ends_in_ink_mm", counted)
    lines, count = ENDED[ended]
    _strokes(lines, 1)
    counts = len(asked), len(set(asked))
    assert counts == (count, count)


def test_two_corners_across_each_other_are_told_though_no_line_passes() -> None:
    """All legs turn, and what lies between them is too short to be felt: their corners tell where ink is."""
    corners = np.array([(21.0, 21.1), (20.0, 20.0)])
    drawing = inked(
        polyline((5, 21.1), corners[0], (21, 5)), polyline((36, 20), corners[1], (20, 5))
    )
    view = View(photocell.behind_aperture(drawing, 0.1), WIDTH_MM)
    # each begins so far from where it ends, that is before it comes into another's ink
    begun = [((10, 21.1), 0.0), ((31, 20), np.pi), ((21, 10), np.pi / 2), ((20, 10), np.pi / 2)]
    felt = [
        view.feel(np.array(place, float), heading, long_mm)
        for (place, heading), long_mm in zip(begun, (10.6, 9.5, 9.5, 10.0), strict=True)
    ]
    legs = [leg_of(seen, True, view.leg_mm) for seen in felt]
    views, near = [view] * len(legs), [seen[:, :2] for seen in felt]
    told = Crossing(legs, views, Settings(), near).solution
    assert told.pairs == ((0, 2), (1, 3))
    vertices = np.vstack([told.corners[pair] for pair in told.pairs])
    assert np.hypot(*(vertices - corners).T).max() < OFF_MM


@pytest.mark.parametrize(("radius_mm", "before_rad"), [(10, 0.5), (2.6, 1.4)])
def test_a_line_goes_on_through_a_wide_junction_on_the_arc_on_which_it_comes_in(
    radius_mm: float, before_rad: float
) -> None:
    """Nothing was felt between its legs; over a quarter turn its way was 0.43 mm within the circle, and a
    small circle's turned at a corner, 0.13 mm off.
    """
    turns = np.linspace(-before_rad, 0.5 * np.pi + before_rad, 600)
    arc = 20 + radius_mm * np.column_stack([np.cos(turns), np.sin(turns)])
    view = View(photocell.behind_aperture(inked(arc), 0.1), WIDTH_MM)
    ends = [(arc[0], 0.5 * np.pi - before_rad), (arc[-1], before_rad)]
    legs = [leg_of(view.feel(*end, LEG_MM), True, LEG_MM) for end in ends]
    ways = Crossing(legs, [view] * 2, Settings()).as_drawn(WaysOn(((0, 1),), {})).ways_mm
    off_mm = np.abs(np.hypot(*(ways[0] - 20).T) - radius_mm).max()
    assert off_mm < OFF_MM


@pytest.mark.parametrize("phase", [0.3618, 0.3621])
def test_a_line_that_turns_back_within_its_own_ink_is_one_line(phase: float) -> None:
    """Its legs are as those of two lines that end beside each other, which do not explain the ink: a doubled
    Lissajous figure fell into three strokes, 0.18 mm off.
    """
    turns = np.linspace(0, 2 * np.pi, 1200)
    figure = 40 * np.column_stack([np.sin(3 * turns + phase), np.sin(4 * turns)])
    tip = figure[np.hypot(*(figure - 40).T) < 17]
    tip += 4 - tip.min(axis=0)
    (stroke,) = trace_ink(inked(tip, width_mm=0.4, seed=3)).lines
    true = shapely.LineString(tip)
    assert shapely.hausdorff_distance(true, shapely.LineString(stroke.xy_mm[::5])) < OFF_MM
