"""Crossed ink: where a closed way crosses itself and goes round nothing but ink.

    ──╮  ╭──       the outline of a part does not cross itself. Where spikes or tufts are narrower than two
      ╲╲╱          lines, their ink tells little of what lies within it: a way that crosses itself there may
       ╳╲          leave no ink, and be far from the line all the same
       V V

A loop of a line that was drawn so, as of a written l, goes round paper.

Signals: the sheet and closed lines in; where each crosses itself so, and how long the way round is, mm, out.

Source: our own. Questions: of a written loop whose eye is full of ink nothing tells whether it was meant.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import cv2
import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.crossings import crossings_of
from morfax.motion.polyline import area_mm2, evenly, length_mm
from morfax.tracer.drawing.components import INK
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.effort import EVERY_MM
from morfax.tracer.following.line import Line
from morfax.tracer.limits import LONGER_WIDTHS, NEAR


def crossed_in_ink(
    drawing: Drawing, lines: Sequence[Line]
) -> Iterator[tuple[tuple[float, float], float]]:
    """Places (mm) at which those of some lines that are closed cross themselves within their ink, and how far
    round, mm; the longest first of each line.
    """
    for line in lines:
        if line.ending != "closed":
            continue
        loops = [loop for loop in _loops(line) if _is_inked(drawing, loop)]
        for loop in sorted(loops, key=length_mm, reverse=True):
            x, y = loop[0]
            yield (float(x), float(y)), length_mm(loop)


def _loops(line: Line) -> Iterator[Array]:
    """What a closed line goes round from where it crosses itself to there again, (n, 2) mm, the shorter way,
    if that is more than a speck and no more than the ink of crowded lines.
    """
    way = evenly(line.loop_mm, EVERY_MM)
    least_mm2, most_mm2 = (np.square([NEAR, LONGER_WIDTHS]) * line.width_mm**2).tolist()
    for one, other in crossings_of(way, np.arange(len(way) - 1)):
        i, j = int(one), int(other)
        place = way[i] + (one - i) * (way[i + 1] - way[i])
        round_mm = [way[i + 1 : j + 1]]
        round_mm.append(np.vstack([way[j + 1 :], way[: i + 1]]))
        loop = np.vstack([place, min(round_mm, key=len), place])
        if least_mm2 < abs(area_mm2(loop)) < most_mm2:
            yield loop


def _is_inked(drawing: Drawing, loop: Array) -> bool:
    """Whether there is ink all over a loop, (n, 2) mm."""
    pitch_mm, rows = drawing.pitch_mm, drawing.darkness.shape[0]
    pixels = np.column_stack([loop[:, 0], rows * pitch_mm - loop[:, 1]]) / pitch_mm
    left, top = np.maximum(np.floor(pixels.min(axis=0)).astype(int), 0).tolist()
    right, bottom = np.ceil(pixels.max(axis=0)).astype(int).tolist()
    seen = np.asarray(drawing.darkness[top:bottom, left:right])
    within = np.zeros(seen.shape, np.uint8)
    cv2.fillPoly(within, [np.floor(pixels - [left, top]).astype(np.int32)], 1)
    return bool((seen[within > 0] > INK).all())
