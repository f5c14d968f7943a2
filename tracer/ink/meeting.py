"""Where strokes meet: a stroke ends on the middle of the line that it comes to, or goes on as a pen would.

Signals: ways of the head in, (n, 2) sheet mm at the motion rate, and the ledger; out the same ways led on to
the lines that they meet, and strokes whose ends go on into each other joined to one.

    ──────────────         ──────────────        ─────  ─────         ────────────
          ╷          →           │                                →
          │                      │               one ends, one begins

The head stops where the ink that it follows ends: that is the edge of what has been struck off. From there it
runs on, by its heading, over the ink that was there.

Source: our own.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from morfax.motion import ramp
from morfax.motion.arrays import Array
from morfax.motion.motion import MOTION_RATE_HZ
from morfax.tracer.ink.ledger import FRINGE_PX, Ledger
from morfax.tracer.sensing.leg import turn

# All limits below were chosen by trial on drawings of nets.
MEETS_WIDTHS = 2.0  # beyond the fringe, a stroke that ends so near to a line ends on it
ON_IT = 0.35  # of the width: the way ahead has come to the line
HEADING_WIDTHS = 1.5  # of the end of a way show its heading
STEPS_PER_WIDTH = 10
NOTHING_MM = 1e-6  # a shorter way is rounding
INKED = 0.8  # of the places between: the ink goes on
GOES_ON = math.radians(35)  # two ends within this of one line are one line


class InkStroke(NamedTuple):
    """A stroke: its way (n, 2) mm at the motion rate, whether it comes round, and the line's width, mm."""

    way_mm: Array
    closed: bool
    width_mm: float


class End(NamedTuple):
    """An end of a stroke: which stroke, whether its last place, the place (2,) mm, the heading outward."""

    stroke: int
    last: bool
    place_mm: Array
    heading_rad: float


def led_on(way_mm: Array, ledger: Ledger, speed_mm_s: float) -> Array:
    """A way led on, at both its ends, to the middle of the line that was followed before and is met there."""
    for _ in range(2):
        way_mm = _led_on_from_end(way_mm, ledger, speed_mm_s)[::-1]
    return way_mm


def reach_mm(ledger: Ledger) -> float:
    """How far from its end a stroke may meet another: both are struck off a little beyond their edges."""
    return MEETS_WIDTHS * ledger.usual_mm + 2 * FRINGE_PX * ledger.drawing.pitch_mm


def _led_on_from_end(way_mm: Array, ledger: Ledger, speed_mm_s: float) -> Array:
    """A way led on, at its end, straight to the middle of the line that it meets."""
    heading = _heading_at_end(way_mm, HEADING_WIDTHS * ledger.usual_mm)
    if heading is None:
        return way_mm
    # 1. straight ahead to a line
    end, usual_mm = way_mm[-1], ledger.usual_mm
    steps = np.arange(0.0, reach_mm(ledger), usual_mm / STEPS_PER_WIDTH)
    ahead = end + steps[:, None] * np.array([math.cos(heading), math.sin(heading)])
    away_mm, met = ledger.nearest_way(ahead)
    come = np.flatnonzero(away_mm < ON_IT * usual_mm)
    if not len(come):
        return way_mm
    near = come[0] + int(np.argmin(away_mm[come[0] : come[0] + STEPS_PER_WIDTH]))
    # 2. over ink
    if not is_inked(ledger, end, met[near]):
        return way_mm
    return np.vstack([way_mm, straight(end, met[near], speed_mm_s)])


def straight(start_mm: Array, end_mm: Array, speed_mm_s: float) -> Array:
    """Positions from a place, which is left out, straight to another, from rest to rest, (n, 2) mm."""
    if math.dist(start_mm, end_mm) < NOTHING_MM:
        return np.empty((0, 2))
    return ramp.positions_mm(start_mm, end_mm, speed_mm_s, rate_hz=MOTION_RATE_HZ)[1:]


def is_inked(ledger: Ledger, start_mm: Array, end_mm: Array) -> bool:
    """Whether there was ink from a place to another."""
    places = start_mm + np.linspace(0.0, 1.0, STEPS_PER_WIDTH)[:, None] * (end_mm - start_mm)
    return bool(np.mean(ledger.was_ink(places)) >= INKED)


def joined(strokes: list[InkStroke], ledger: Ledger, speed_mm_s: float) -> list[InkStroke]:
    """The strokes, those whose ends go on into each other joined to one."""
    ends = [
        end for k, stroke in enumerate(strokes) for end in _ends(k, stroke, ledger.usual_mm)
    ]
    goes_on = dict[tuple[int, bool], End]()
    for one, other in _going_on(ends, ledger):
        goes_on[one.stroke, one.last] = other
        goes_on[other.stroke, other.last] = one
    done, made = set[int](), list[InkStroke]()
    # chains from their free ends first; what is left then are rings
    free_first = sorted(
        range(len(strokes)), key=lambda k: ((k, False) in goes_on) + ((k, True) in goes_on)
    )
    for first in free_first:
        if first in done:
            continue
        chain, closed = _chain(first, goes_on)
        done |= {k for k, _ in chain}
        made.append(_as_one(strokes, chain, closed, speed_mm_s))
    return made


def _chain(
    first: int, goes_on: dict[tuple[int, bool], End]
) -> tuple[list[tuple[int, bool]], bool]:
    """Strokes one after the other from a first one, each with whether it is run backwards; if they close."""
    chain = [(first, (first, True) not in goes_on)]
    while True:
        stroke, is_back = chain[-1]
        following = goes_on.get((stroke, not is_back))
        if following is None:
            return chain, False
        if following.stroke == first:
            return chain, True
        chain.append((following.stroke, following.last))


def _as_one(
    strokes: list[InkStroke], chain: list[tuple[int, bool]], closed: bool, speed_mm_s: float
) -> InkStroke:
    """Strokes of a chain as one."""
    if len(chain) == 1 and not closed:
        return strokes[chain[0][0]]
    ways = [strokes[k].way_mm[::-1] if back else strokes[k].way_mm for k, back in chain]
    parts = [ways[0]]
    for way in [*ways[1:], *([ways[0][:1]] if closed else [])]:
        parts += [straight(parts[-1][-1], way[0], speed_mm_s), way[1:]]
        parts = [part for part in parts if len(part)]
    longest = max((strokes[k] for k, _ in chain), key=lambda stroke: len(stroke.way_mm))
    return InkStroke(np.vstack(parts), closed, longest.width_mm)


def _going_on(ends: list[End], ledger: Ledger) -> list[tuple[End, End]]:
    """Pairs of ends at which one stroke goes on into another, or closes: the straightest first."""
    if len(ends) < 2:
        return []
    near = cKDTree([end.place_mm for end in ends]).query_pairs(reach_mm(ledger))
    found = list[tuple[float, int, int]]()
    for a, b in sorted(near):
        bent = _bent(ends[a], ends[b], ledger.usual_mm)
        if bent < GOES_ON and is_inked(ledger, ends[a].place_mm, ends[b].place_mm):
            found.append((bent, a, b))
    taken, pairs = set[int](), list[tuple[End, End]]()
    for _, a, b in sorted(found):
        if a not in taken and b not in taken:
            taken |= {a, b}
            pairs.append((ends[a], ends[b]))
    return pairs


def _ends(number: int, stroke: InkStroke, width_mm: float) -> Iterator[End]:
    """The ends of an open stroke that is long enough to have a heading there."""
    if stroke.closed:
        return
    for last in (False, True):
        outward = stroke.way_mm if last else stroke.way_mm[::-1]
        heading = _heading_at_end(outward, HEADING_WIDTHS * width_mm)
        if heading is not None:
            yield End(number, last, outward[-1], heading)


def _heading_at_end(way_mm: Array, along_mm: float) -> float | None:
    """The heading at the end of a way, by a chord of a length; None if the way is shorter."""
    away = np.hypot(*(way_mm - way_mm[-1]).T)
    far = np.flatnonzero(away > along_mm)
    if not len(far):
        return None
    dx, dy = way_mm[-1] - way_mm[far[-1]]
    return math.atan2(dy, dx)


def _bent(one: End, other: End, width_mm: float) -> float:
    """By how much two ends are off one line, rad: by their headings, and by the way between if it is long."""
    bent = abs(turn(one.heading_rad + math.pi, other.heading_rad))
    dx, dy = other.place_mm - one.place_mm
    if math.hypot(dx, dy) > width_mm:
        bent = max(bent, abs(turn(one.heading_rad, math.atan2(dy, dx))))
    return bent
