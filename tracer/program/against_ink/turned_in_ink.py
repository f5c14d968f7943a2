"""Turned in ink: where strokes turn to and fro within ink that is explained without them.

    ════╗╔══════        a corner deep in others' ink: the way found for its line is told by no ink, and turns
     ╱╲ ║║  ╱           by more than one corner does within a few widths
    ╱  ╲╝╚═╱

A pen that draws one line turns by no more than half a turn at one place. Of a stroke that the head ran from
memory and that turns by more within some widths, the stretch is left out: where the ink is explained all the
same it told nothing of the way. Letters and teeth turn as much, and leave ink.

Signals: the ways of strokes, and to which of their places the head ran from memory, in; stretches of places
that turn so, and the ways without one of them, out (see `strokes_off_ink`, which holds these against ink).

Source: our own.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.plane import CORNER_RAD
from morfax.tracer.limits import ABOUT_WIDTHS
from morfax.tracer.program.against_ink.own_ink import PLACES_PX
from morfax.tracer.program.against_ink.pen_on_ink import Ways


def stretches_that_turn(
    ways: Ways, from_memory: NDArray[np.bool_], half_px: float
) -> list[tuple[int, int]]:
    """The first place, and the one after the last, of each stretch of some widths in which a stroke turns by
    more than half a turn, as far as it was run from memory; `half_px` is half the usual width.
    """
    count = round(ABOUT_WIDTHS * 2 * half_px / PLACES_PX)
    if len(ways.line) <= count:
        return []
    come_rad = np.r_[0.0, np.cumsum(_turns_rad(ways) * from_memory)]
    turned_rad = come_rad[count:] - come_rad[:-count]
    # both ends of a stretch are of one line
    turned_rad = np.where(ways.line[count - 1 :] == ways.line[: 1 - count], turned_rad, 0.0)
    found = list[tuple[int, int]]()
    while turned_rad[first := int(np.argmax(turned_rad))] > math.pi + CORNER_RAD:
        found.append((first, first + count))
        turned_rad[max(0, first - count) : first + count] = 0.0
    return found


def _turns_rad(ways: Ways) -> Array:
    """By how much the ways turn at each of their places, rad."""
    steps = np.diff(ways.places_px.astype(float), axis=0)
    headings = np.arctan2(steps[:, 1], steps[:, 0])
    turns = np.zeros(len(ways.line))
    turns[1:-1] = np.abs(np.remainder(np.diff(headings) + math.pi, math.tau) - math.pi)
    is_inner = ways.line[2:] == ways.line[:-2]
    turns[1:-1] *= is_inner
    return turns


def without(ways: Ways, first: int, last: int, reach_px: float) -> Ways:
    """The ways without the ink of a stretch of their places, which are kept: a pen too thin to reach any."""
    line, nothing = ways.line.copy(), len(ways.half_px)
    line[first:last] = nothing
    half_px, judged = np.r_[ways.half_px, -reach_px], np.r_[ways.judged, True]
    return ways._replace(line=line, half_px=half_px, judged=judged)
