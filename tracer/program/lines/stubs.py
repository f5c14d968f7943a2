"""Stubs: places where a way goes out along a short stroke and comes back beside itself, to go on as before.

    ────╮╭────      a tick, a burr or a drop of ink that is shorter than a line is wide reads like a spike of
        ││          the line itself: ink does not tell the two apart
        ╰╯

Signals: a line as it was followed in; where it turns back, and how far it goes out, mm, out.

Source: our own; the operator of patent ES 361967 knows a tick by sight. Questions: a tip where two sides meet
goes on the way that it came; a spike that is drawn so, and whose sides are no line apart, does not.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.polyline import evenly, steps_mm
from morfax.tracer.following.line import Line
from morfax.tracer.limits import LONGER_WIDTHS, NEAR
from morfax.tracer.sensing.view import STEP_WIDTHS

# All limits below were chosen by trial on lines with ticks, and on outlines with tips. In widths of the line:
CLOSE = 0.75  # out and back are no further apart
LEAST_OUT = 0.8  # a way that goes out less is a bump; for more than `LONGER_WIDTHS`, a line
APPROACH = 1.5  # before and after it show whether the line goes straight on, ...
STRAIGHT_ON = math.radians(50)  # ... within this, ...
CORNER = math.radians(125)  # ... or turns a corner that is no tip


class Stub(NamedTuple):
    """A stub: the place at which the way turns back, and how far out that is, mm."""

    place_mm: tuple[float, float]
    out_mm: float


def stubs(line: Line) -> list[Stub]:
    """The stubs on a line's way; of an open line but for those at its ends."""
    reach = round(2 * (LONGER_WIDTHS + APPROACH) / STEP_WIDTHS)
    way = evenly(line.loop_mm, STEP_WIDTHS * line.width_mm)
    if len(way) < reach:
        return []
    if line.ending == "closed":
        way = np.vstack([way, way[:reach]])
    return list(_apart(_found(way, line.width_mm), line.width_mm))


def _found(way: Array, width_mm: float) -> Iterator[Stub]:
    """The stubs of a way at even steps; the same one more than once."""
    near, next_out = round(APPROACH / STEP_WIDTHS), 0
    step = steps_mm(way).max() / width_mm
    for out in range(round(LEAST_OUT / STEP_WIDTHS), round(LONGER_WIDTHS / STEP_WIDTHS) + 1):
        if out < next_out:
            continue
        feet = len(way) - 2 * out
        # 1. where it comes back to where it was, and goes straight on; two steps bring it no nearer than that
        away = np.hypot(*(way[2 * out :] - way[:feet]).T) / width_mm
        next_out = out + int((away.min() - CLOSE) / (2 * step))
        back = away < CLOSE
        back[:near] = back[feet - near :] = False
        first = np.flatnonzero(back)
        if not len(first):
            continue
        before = _headings(way[first] - way[first - near])
        after = _headings(way[first + 2 * out + near] - way[first + 2 * out])
        turned = np.abs(np.angle(np.exp(1j * (after - before))))
        # 2. out and back beside itself; at a corner of the line in its own track
        close = np.select([turned < STRAIGHT_ON, turned < CORNER], [CLOSE, NEAR], 0.0)
        for foot, most in zip(first[close > 0].tolist(), close[close > 0], strict=True):
            stroke = way[foot : foot + 2 * out + 1]
            apart_mm = np.hypot(*(stroke - stroke[::-1]).T)
            away_mm = np.hypot(*(stroke - 0.5 * (stroke[0] + stroke[-1])).T)
            if apart_mm.max() < most * width_mm and away_mm.max() > LEAST_OUT * width_mm:
                x, y = stroke[np.argmax(away_mm)].tolist()
                yield Stub((x, y), float(away_mm.max()))


def _headings(ways: Array) -> Array:
    """The headings of some ways, rad."""
    return np.asarray(np.arctan2(ways[:, 1], ways[:, 0]))


def _apart(found: Iterator[Stub], width_mm: float) -> Iterator[Stub]:
    """Each stub once, as far out as it was found."""
    kept = list[Stub]()
    for stub in sorted(found, key=lambda stub: -stub.out_mm):
        if all(
            math.dist(stub.place_mm, other.place_mm) > LONGER_WIDTHS * width_mm
            for other in kept
        ):
            kept.append(stub)
            yield stub
