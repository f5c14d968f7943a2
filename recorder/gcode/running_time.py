"""The running time of a program on its machine: trapezoids of speed between corners.

Signals in: blocks (places in mm, feeds in mm/s) as the machine runs them, and the Machine with the speed and
acceleration of its axes. Signals out: the time in s.

    speed      ____________               1. each block at its feed, or as fast as the axes allow
              /            \\      ____     2. corners at the speed at which corner_mm rounds them off
             /              \\____/    \\    3. from the last block back, and then on from the first: no
            /                          \\      block begins faster than it can brake

At a corner that turns by t a circle that stays `corner_mm` from it has the radius r, and the speed v there is

    r = corner sin(b) / (1 - sin(b)),  b = (pi - t) / 2,        v^2 = a r

Source: LinuxCNC's trajectory planner (blend arcs within the P of G64), and Grbl's junction deviation, which
is the same formula. Held against LinuxCNC 2.9's simulation, see CHANGELOG. Questions: controls look some
blocks ahead, and here all are known.
"""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

from morfax.motion.arrays import ROUNDED, Array
from morfax.recorder.gcode.arc_places import Place, length_mm, step_at, turned_rad
from morfax.recorder.gcode.machine import Axes, Machine
from morfax.recorder.gcode.program_text import ARCS, DWELL, RAPID, WORDS, Block

# of the acceleration, towards the centre of an arc; the rest, half of it, is for the feed (LinuxCNC, tp.c)
ACROSS = math.sqrt(3) / 2

_DWELL = re.compile(r"^G4 P([\d.]+)$")
_PASSING = re.compile(r"^(M62|M63|M67|S)")  # obeyed on the way: the axes do not stop for it
_SLOWER = re.compile(r"^M67 E3 Q(\d+)$")  # QtPlasmaC: percent of the feed, 0 is all of it


@dataclass(slots=True)
class _Leg:
    """A block that moves: length, highest speed, acceleration, directions; speed at its beginning."""

    length_mm: float
    speed_mm_s: float
    acceleration_mm_s2: float
    leaves: Place
    arrives: Place
    begin_mm_s: float = 0.0


def running_time_s(start_mm: Array, blocks: Sequence[Block], machine: Machine) -> float:
    """How long a program runs from its start, the machine's own words at begin and end included."""
    x, y, z = (float(mm) for mm in start_mm)
    place: Place = (x, y, z if machine.z else 0.0)
    seconds = sum(_words_s(words, machine) for words in (machine.begin, machine.end))
    legs, share = list[_Leg](), 1.0
    for block in blocks:
        if block.code in (DWELL, WORDS):
            share = _share(block.words, share)
            if block.words and all(map(_PASSING.match, block.words)):
                continue
            seconds += _run_s(legs, machine) + block.dwell_s + _words_s(block.words, machine)
            legs = []
        elif block.code and (leg := _leg(place, block, machine, share)):
            legs.append(leg)
        place = block.place_mm
    return seconds + _run_s(legs, machine)


def _words_s(words: Sequence[str], machine: Machine) -> float:
    """The dwells among words of the machine's own, s."""
    found = (_DWELL.match(word) for word in words)
    return sum(float(dwell[1]) * machine.dwell_unit_s for dwell in found if dwell)


def _share(words: Sequence[str], share: float) -> float:
    """The share of the feed after some words."""
    for word in words:
        if slower := _SLOWER.match(word):
            share = (float(slower[1]) or 100.0) / 100
    return share


def _leg(place: Place, block: Block, machine: Machine, share: float) -> _Leg | None:
    """A block as a leg; None for one that goes nowhere."""
    way_mm = length_mm(place, block)
    if way_mm <= 0:
        return None
    leaves = _direction(place, block, 0)
    arrives = _direction(place, block, 1)
    if block.code == RAPID:
        speed_mm_s = _along(leaves, machine.rapid_mm_s)
    else:
        feed_mm_s = block.feed_mm_s if machine.feeds else machine.panel_feed_mm_s
        speed_mm_s = min(feed_mm_s * share, _along(leaves, machine.rapid_mm_s))
    most_mm_s2 = _along(leaves, machine.acceleration_mm_s2)
    if block.code in ARCS:
        most_mm_s2 = min(machine.acceleration_mm_s2[:2])
        radius_mm = math.hypot(*block.centre_mm)
        speed_mm_s = min(speed_mm_s, math.sqrt(ACROSS * most_mm_s2 * radius_mm))
        is_all = speed_mm_s**2 / radius_mm > most_mm_s2 / 2
        most_mm_s2 *= 0.5 if is_all else ACROSS
    return _Leg(way_mm, speed_mm_s, most_mm_s2, leaves, arrives)


def _direction(place: Place, block: Block, at: int) -> Place:
    """The direction of a block at its begin (0) or end (1), of length 1."""
    if not turned_rad(place, block):
        way = [end - begin for begin, end in zip(place, block.place_mm, strict=True)]
    else:
        way = [*step_at(place, block, at), 0.0]
    whole = math.hypot(*way)
    return way[0] / whole, way[1] / whole, way[2] / whole


def _along(direction: Place, limits: Axes) -> float:
    """What the limits of the axes leave along a direction."""
    shares = zip(direction, limits, strict=True)
    return min(limit / abs(share) for share, limit in shares if share)


def _run_s(legs: list[_Leg], machine: Machine) -> float:
    """The time of some legs from standstill to standstill."""
    if not legs:
        return 0.0
    # 1. corners
    for before, leg in pairwise(legs):
        corner_mm_s = _corner_mm_s(before, leg, machine.corner_mm)
        leg.begin_mm_s = min(corner_mm_s, before.speed_mm_s, leg.speed_mm_s)
    # 2. braking, from the last leg back
    after_mm_s = 0.0
    for leg in reversed(legs):
        fastest = math.sqrt(after_mm_s**2 + 2 * leg.acceleration_mm_s2 * leg.length_mm)
        leg.begin_mm_s = after_mm_s = min(leg.begin_mm_s, fastest)
    # 3. speeding up, from the first on
    seconds, now_mm_s = 0.0, 0.0
    ends = [*(leg.begin_mm_s for leg in legs[1:]), 0.0]
    for leg, end_mm_s in zip(legs, ends, strict=True):
        reached = math.sqrt(now_mm_s**2 + 2 * leg.acceleration_mm_s2 * leg.length_mm)
        end_mm_s = min(end_mm_s, reached)
        seconds += _leg_s(leg, now_mm_s, end_mm_s)
        now_mm_s = end_mm_s
    return seconds


def _corner_mm_s(before: _Leg, after: _Leg, corner_mm: float) -> float:
    """The speed at which the corner between two legs is rounded off."""
    cos_turn = sum(a * b for a, b in zip(before.arrives, after.leaves, strict=True))
    sin_half = math.sqrt(
        max(0.0, (1 + cos_turn) / 2)
    )  # of the angle between the two legs, halved
    if sin_half >= 1 - ROUNDED:
        return math.inf
    radius_mm = corner_mm * sin_half / (1 - sin_half)
    most_mm_s2 = min(before.acceleration_mm_s2, after.acceleration_mm_s2)
    return math.sqrt(most_mm_s2 * radius_mm)


def _leg_s(leg: _Leg, begin_mm_s: float, end_mm_s: float) -> float:
    """The time of one leg: speeding up, running, braking."""
    most = leg.acceleration_mm_s2
    peak_mm_s = math.sqrt((2 * most * leg.length_mm + begin_mm_s**2 + end_mm_s**2) / 2)
    top_mm_s = min(leg.speed_mm_s, peak_mm_s)
    ramps_mm = (2 * top_mm_s**2 - begin_mm_s**2 - end_mm_s**2) / (2 * most)
    even_mm = max(0.0, leg.length_mm - ramps_mm)
    return (2 * top_mm_s - begin_mm_s - end_mm_s) / most + even_mm / top_mm_s
