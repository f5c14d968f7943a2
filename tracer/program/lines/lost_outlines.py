"""Lost outlines: edges of a sheet on which the head was lost, left out so that the others make a program.

Signals: an edge drawing and the lines followed on it in; out the outlines that are whole, and what was left
out: where the head was lost, and how long the edge is that the picture shows there (mm).

    ▟█▙   ▟▙       an outline that the head has followed round is kept;
    ▜█▛   ▜▛?      one on which it is lost is left out whole: half an outline is no edge

Where the lost edges are the larger part of a sheet, the sheet is lost, and its lines stay as they are.

Source: our own. Questions: whether a part may do without a small edge, only the operator knows.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from morfax.motion.polyline import length_mm, nearest_mm
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.following.line import Line

MOST = 0.5  # of the length of all edges: where more is lost, the program is of no use


class LostOutline(NamedTuple):
    """An outline that was left out: where the head was lost, and how long its edge is, mm."""

    place_mm: tuple[float, float]
    length_mm: float


def without_lost(
    edges: Drawing, lines: Sequence[Line]
) -> tuple[tuple[Line, ...], tuple[LostOutline, ...]]:
    """The whole outlines and the lost ones, the longest first; all, and none, if too much is lost."""
    whole = tuple(line for line in lines if line.ending == "closed")
    lost = [_lost(edges, line) for line in lines if line.ending != "closed"]
    lost_mm = sum(outline.length_mm for outline in lost)
    if lost_mm > MOST * (lost_mm + sum(line.length_mm for line in whole)):
        return tuple(lines), ()
    return whole, tuple(sorted(lost, key=lambda outline: -outline.length_mm))


def _lost(edges: Drawing, line: Line) -> LostOutline:
    """Where the head was lost on an outline, and the length of the edge there."""
    at = np.array([line.xy_mm[-1]])
    edge = min(edges.edges_mm, key=lambda edge: float(nearest_mm(at, edge)[0]))
    x, y = at[0]
    return LostOutline((float(x), float(y)), length_mm(edge))
