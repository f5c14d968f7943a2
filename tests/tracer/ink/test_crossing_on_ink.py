"""Corners that lie in the ink of other lines: how lines go on there is told by the ink."""

from __future__ import annotations

import numpy as np
import pytest
import shapely

from morfax.tracer.following.line import Line
from morfax.tracer.ink import crossing
from morfax.tracer.ink.lifted import Loose
from morfax.tracer.program.trace_ink import trace_ink
from tests.tracer.inked import UM, Points, inked, polyline

# a stroke from its line, at most: corners in others' ink are three times as far off as alone
OFF_MM = 60 * UM


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
}


@pytest.mark.parametrize("seed", [1, 2])
@pytest.mark.parametrize("tip", TIPS)
def test_a_corner_in_the_ink_of_another_line_is_its_lines(tip: str, seed: int) -> None:
    assert max(each_by_a_stroke([ACROSS, *TIPS[tip]], seed)) < OFF_MM


def test_where_lines_end_in_ink_is_asked_once_of_each_way_to_go_on(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A third of all that was asked on a page of gears had been asked before."""
    asked, ends_in_ink_mm = list[bytes](), crossing.ends_in_ink_mm

    def counted(loose: list[Loose], lines_mm: Points, **rest: bool) -> list[float | None]:
        legs = [line.leg.end_mm.tobytes() for line in loose]
        asked.extend([b"".join([*legs, lines_mm.tobytes()])] if loose else [])
        return ends_in_ink_mm(loose, lines_mm, **rest)

    monkeypatch.setattr(crossing, "ends_in_ink_mm", counted)
    _strokes([ACROSS, polyline((14, 4), (20, 20))], 1)
    counts = len(asked), len(set(asked))
    assert counts == (1, 1)


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
