"""Parts of closed lines, and lines made of such parts; the ink about where they meet.

Signals: lines as the head ran along them in; lines of the same positions, mm at the motion rate, out.

Source: our own.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.motion import MOTION_RATE_HZ
from morfax.motion.polyline import (
    area_mm2,
    between_corners,
    closed_up,
    length_mm,
    lengths_mm,
    nearest_mm,
)
from morfax.motion.usual import THINNED
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.following.line import Line
from morfax.tracer.head.carriage import Carriage
from morfax.tracer.head.leaders import REDRAWN, Led
from morfax.tracer.head.stance import Stance
from morfax.tracer.limits import ABOUT_WIDTHS
from morfax.tracer.program.against_ink.boxed_lines import BoxedLines
from morfax.tracer.program.against_ink.window import view_about
from morfax.tracer.program.laid.bay_run import Bay, laid
from morfax.tracer.program.laid.laid_way import LaidWay
from morfax.tracer.program.setup import Setup

# In widths of the line; chosen by trial on plates with notches, tongues, keyholes and necks:
# of the way before and after a bay or a bar show where the line comes from and goes on: the rim of one aslant
# is its own further off, and the head may have run into it
LEGS = 1.5, 4.0
MOUTH = 1.0  # from a bar of ink to the way that it is joined to
OF_LOOP = 0.8  # of a line: a stretch that is more of it is no bay and no touch
# of what a way leaves unexplained: what is laid in its place and leaves more is none, unless that is noise
STILL_LEFT = 0.35
BESIDE = 2.0  # from the middle of one line to another's: their ink may be joined
REACH = 2.2  # of the ink about a place that is looked at


def is_plain(line: Line) -> bool:
    """Whether a line came round, and bears no mark."""
    return line.ending == "closed" and is_bare(line)


def is_whole(line: Line) -> bool:
    """Whether a line came round, or ended where its ink does, and bears no mark."""
    return line.ending in ("closed", "ended") and is_bare(line)


def is_bare(line: Line) -> bool:
    """Whether a line bears no mark, and is no edge of a shape."""
    is_marked = line.is_lead or line.reference_mm is not None or line.marks or line.guides
    return not is_marked and not line.loop_from and not line.on_edge


def is_clear(drawing: Drawing) -> bool:
    """Whether a drawing is of lines that show where a pen was: of pixels that no lens has softened each step
    looks like a corner.
    """
    is_soft = drawing.noise.softness_px > 0 and not drawing.is_hard
    return is_soft and not drawing.grainy and not drawing.edges_mm


def is_beside(own: Array, line: Line, lines: BoxedLines) -> bool:
    """Whether another of some lines comes so near to a stretch (n, 2) mm of one that they share ink."""
    near_mm = BESIDE * line.width_mm
    low, high = own.min(axis=0) - near_mm, own.max(axis=0) + near_mm
    others = lines.parts(low, high, line)
    return any(nearest_mm(own, part).min() < near_mm for _, part in others)


def part_of(line: Line, first: int, last: int) -> Line:
    """The part of a closed line from one of its thinned places to another, perhaps over its beginning."""
    begin, end = first * THINNED, last * THINNED + 1
    led, xy_mm = line.led.of(len(line.xy_mm)), line.xy_mm
    if begin < end:
        led, xy_mm = led[begin:end], xy_mm[begin:end]
    else:
        led, xy_mm = np.r_[led[begin:], led[:end]], np.vstack([xy_mm[begin:], xy_mm[:end]])
    whole = len(led) // THINNED * THINNED  # steps of the thinned places
    return replace(line, xy_mm=xy_mm[:whole], led=Led.along(led[:whole]))


def back_along(line: Line) -> Line:
    """A line from its end to its beginning."""
    return replace(line, xy_mm=line.xy_mm[::-1], led=line.led.turned_round(len(line.xy_mm)))


def in_direction(line: Line, direction: str | None) -> Line:
    """A line; one that came round in the direction that is asked for, whichever way its rim was felt."""
    if direction not in ("cw", "ccw") or not is_plain(line) or line.as_told:
        return line
    if (area_mm2(line.loop_mm) > 0) == (direction == "ccw"):
        return line
    return replace(back_along(line), junctions_mm=line.junctions_mm[::-1])


def run_on(setup: Setup, parts: Sequence[Line], sides: Sequence[LaidWay]) -> Line:
    """Parts of lines as one closed line, with the head run along a side from the end of each part onto the
    next, or the first.
    """
    line = _one_after_the_other(parts)
    come_mm = lengths_mm(line.places_mm)
    round_mm = float(come_mm[-1])
    counts = np.cumsum([0, *(len(part.places_mm) for part in parts)])
    bays = list[Bay]()
    for k, side in enumerate(sides):
        onto = (k + 1) % len(parts)
        away_mm = np.hypot(*(parts[onto].places_mm - side.way[-1]).T)
        last_mm = float(come_mm[counts[onto] + int(np.argmin(away_mm))])
        over_mm = round_mm if onto == 0 else 0.0
        bays.append(Bay(float(come_mm[counts[k + 1] - 1]), over_mm + last_mm, side, 0.0))
    return laid(setup, line, bays, round_mm)


def _one_after_the_other(parts: Sequence[Line]) -> Line:
    """Parts of lines as one closed line, straight from each to the next."""
    first = parts[0]
    leaders = [line.led.of(len(line.xy_mm)) for line in parts]
    xy_mm = np.vstack([*(line.xy_mm for line in parts), first.xy_mm[:1]])
    return replace(
        first,
        xy_mm=xy_mm,
        led=Led.along(np.concatenate([*leaders, leaders[0][:1]])),
        number=min(line.number for line in parts),
        ink_mm=max(line.ink_mm for line in parts),
        length_mm=length_mm(xy_mm),
        junctions_mm=tuple(
            dict.fromkeys(place for line in parts for place in line.junctions_mm)
        ),
    )


def run_anew(setup: Setup, line: Line, way: Array, width_mm: float) -> Line:
    """A line as the head runs along a closed way (n, 2) mm, not closed up, from memory."""
    sheet, settings = setup.sheet, setup.settings
    stretches = between_corners(closed_up(way))
    ahead = stretches[0][1] - stretches[0][0]
    view = view_about(sheet, settings.aperture_mm, width_mm, way, ABOUT_WIDTHS * width_mm)
    stance = Stance(way[0], math.atan2(ahead[1], ahead[0]), view)
    carriage = Carriage(stance, settings, MOTION_RATE_HZ)
    carriage.run(stretches, leader=REDRAWN)
    xy_mm = carriage.positions_mm
    return closed_anew(line, xy_mm, carriage.led, width_mm, length_mm(xy_mm))


def closed_anew(line: Line, xy_mm: Array, led: Led, width_mm: float, long_mm: float) -> Line:
    """A line as the closed one that the head ran anew along (n, 2) mm: nothing of its first run stays."""
    return replace(
        line,
        xy_mm=xy_mm,
        ending="closed",
        width_mm=width_mm,
        length_mm=long_mm,
        fault=None,
        loop_from=None,
        junctions_mm=(),
        breaks=(),
        led=led,
        roughness_mm=None,
    )
