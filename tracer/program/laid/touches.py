"""Touches: where two sides of closed lines run together for a while, each is laid as its legs go on, or
within its own rim.

    ──╲_______╱──      touching lines bend away from one another: the rims of their ink go on from either line
    ──╱‾‾‾‾‾‾‾╲──      into itself, smoothly. The head may have gone over from one to the other between them

If ways that bend evenly from leg to leg explain the ink better than the head's, the lines are those; or, if
the head's do not explain it, or cross within it, the ways within the rims. Each line is run along its own
way; or, where the head went over, two lines out of one, or the same line round one of its lobes the other
way.

Signals: the set-up and the closed lines of a patch of ink in; the lines out.

Source: our own (see `ink.rim`). Questions: lines that cross at less than about 7 degrees, where one has a
corner in that ink, are taken to touch.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import combinations_with_replacement, product
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array, bounds
from morfax.motion.crossings import crossings
from morfax.motion.neighbours import Neighbours
from morfax.motion.polyline import at_lengths, evenly, lengths_mm
from morfax.tracer.effort import MANY
from morfax.tracer.following.line import Line
from morfax.tracer.limits import LONGER_WIDTHS, TIP_RAD
from morfax.tracer.program.against_ink.boxed_lines import reaches
from morfax.tracer.program.against_ink.off_ink import ink_about
from morfax.tracer.program.against_ink.own_ink import STATION_WIDTHS
from morfax.tracer.program.laid.bay_run import Bay, laid
from morfax.tracer.program.laid.laid_way import LaidWay
from morfax.tracer.program.laid.line_parts import (
    OF_LOOP,
    REACH,
    back_along,
    is_clear,
    is_plain,
    part_of,
    run_on,
)
from morfax.tracer.program.laid.rim_bays import ways_within_rims
from morfax.tracer.program.laid.smooth_ways import BothWays, Left, smooth_ways
from morfax.tracer.program.laid.turned_back import LEG, LONG, NEAR, Touch, tip_to_tip
from morfax.tracer.program.setup import Setup
from morfax.tracer.sensing.view import STEP_WIDTHS
from morfax.tracer.tangles.beside_itself import partners, shortest
from morfax.tracer.tangles.distances import away_from
from morfax.tracer.tangles.seen_ink import GAIN, SeenInk

# In widths of the line; chosen by trial on circles that touch lines and each other:
ON = 8.0  # of way between two sides of one line
SHORT = 5.0  # a shorter one is a crossing
HALF_LEG = 1.0  # of that is run from memory, where lines exchange their ways
LEAVES = 0.01  # for each width of the ways: head's ways that leave less explain the ink
# lines that cross by more do not touch: at a corner of one, both went past the other
CROSSES = TIP_RAD / 2


def touching(setup: Setup, lines: Sequence[Line]) -> list[Line]:
    """The lines of a patch, each along its own rim where closed lines touch."""
    lines = list(lines)
    if not is_clear(setup.sheet.drawing):
        return lines
    for _ in range(MANY):
        closed = [n for n, line in enumerate(lines) if is_plain(line)]
        for touch in _touches(lines, closed):
            mended = _mended(setup, lines, touch)
            if mended is not None:
                kept = [line for n, line in enumerate(lines) if n not in touch.lines]
                lines = sorted([*kept, *mended], key=lambda each: each.ending != "closed")
                break
        else:
            break
    return lines


def _touches(lines: Sequence[Line], closed: Sequence[int]) -> Iterator[Touch]:
    """The touches of closed lines, given by their numbers."""
    ways = {n: evenly(lines[n].loop_mm, STATION_WIDTHS * lines[n].width_mm) for n in closed}
    for one, other in combinations_with_replacement(closed, 2):
        width_mm = lines[one].width_mm
        low, high = bounds(ways[one])
        near_mm = NEAR * width_mm
        if one == other:
            partner = partners(ways[one], near_mm, round(ON / STATION_WIDTHS))
        elif reaches(ways[other], low - near_mm, high + near_mm):
            away_mm, nearest = Neighbours(ways[other]).nearest(ways[one], near_mm)
            partner = np.where(np.isfinite(away_mm), nearest, -1)
        else:
            continue
        yield from _grouped((one, other), (ways[one], ways[other]), partner, width_mm)
    for n, way in ways.items():
        yield from tip_to_tip(n, way, STATION_WIDTHS, lines[n].width_mm)


def _grouped(
    pair: tuple[int, int],
    ways: tuple[Array, Array],
    partner: NDArray[np.int64],
    width_mm: float,
) -> Iterator[Touch]:
    """The touches of two ways by the places of the second that lie near to those of the first."""
    near = np.flatnonzero(partner >= 0)
    if not len(near):
        return
    first, last = shortest(near, len(ways[0]))
    if last >= len(ways[0]):  # over its beginning: in order from behind the widest gap
        near = np.concatenate([near[near >= first], near[near < first] + len(ways[0])])
    for group in np.split(
        near, np.flatnonzero(np.diff(near) > LONGER_WIDTHS / STATION_WIDTHS) + 1
    ):
        others = partner[group % len(ways[0])]
        begin, end = shortest(np.unique(others), len(ways[1]))
        long = max(group[-1] - group[0], end - begin) * STATION_WIDTHS
        is_once = pair[0] != pair[1] or group[0] % len(ways[0]) < begin
        if not is_once or not SHORT < long < LONG:
            continue
        apart = np.diff(others) if len(others) > 1 else np.zeros(1)
        leg, step_mm = LEG / STATION_WIDTHS, STATION_WIDTHS * width_mm
        firsts = (group[0] - leg) * step_mm, (begin - leg) * step_mm
        lasts = (group[-1] + leg) * step_mm, (end + leg) * step_mm
        yield Touch(pair, firsts, lasts, bool(np.median(np.sign(apart[apart != 0])) > 0))


class _Ways(NamedTuple):
    """The stretches of a touch as the head ran, both in the first one's direction."""

    one: Array
    other: Array


def _ways(pair: tuple[Line, Line], touch: Touch, more_mm: float, step_mm: float) -> _Ways:
    """The stretches of a touch as the head ran, with so much more of either line before and after."""
    first, second = (
        _stretch(line, begin - more_mm, end + more_mm, step_mm)
        for line, begin, end in zip(pair, touch.first_mm, touch.last_mm, strict=True)
    )
    return _Ways(first, second if touch.is_parallel else second[::-1])


def _stretch(line: Line, first_mm: float, last_mm: float, step_mm: float) -> Array:
    """Places of a closed line from a length along it to another, (n, 2) mm."""
    places = line.loop_mm
    round_mm = float(lengths_mm(places)[-1])
    count = max(2, round((last_mm - first_mm) / step_mm))
    return at_lengths(places, np.linspace(first_mm, last_mm, count + 1) % round_mm)


def _mended(setup: Setup, lines: Sequence[Line], touch: Touch) -> list[Line] | None:
    """The lines of a touch, or those that they are, each along its rim; None if they explain the ink as they
    are, or rims do not.
    """
    one, other = (lines[n] for n in touch.lines)
    width_mm, step_mm = one.width_mm, STEP_WIDTHS * one.width_mm
    whole = [float(lengths_mm(line.loop_mm)[-1]) for line in (one, other)]
    long = [last - first for first, last in zip(touch.first_mm, touch.last_mm, strict=True)]
    if sum(long) > OF_LOOP * min(whole):
        return None
    # 1. the ways as they are, held against the ink
    ways, longer = (_ways((one, other), touch, more * width_mm, step_mm) for more in (0.0, LEG))
    if one is not other and _steepest_rad(ways) > CROSSES:
        return None
    across = evenly(np.array([way[len(way) // 2] for way in ways]), step_mm)
    ink = ink_about(setup.sheet.drawing, np.vstack([*ways, across]), width_mm, REACH)
    rest_mm = _rest_mm(ink, lines, touch, whole)
    widths = sum(long) / width_mm

    def left(*along: Array) -> float:
        away_mm = np.min([rest_mm, *(away_from(ink.places_mm, way) for way in along)], axis=0)
        return ink.misfit(ink.best_drawn(away_mm)) / widths

    own = left(*ways)
    # 2. the ways as their legs go on, or within the rims
    both = smooth_ways(*longer, LEG, width_mm, left, may_exchange=one is other)
    # legs that bend smoothly cut no corner: half of that gain is still more than noise
    if both.left > LEAVES or not (both.is_exchanged or both.left < own - 0.5 * GAIN):
        goes_over = one is other and len(crossings(*ways)) % 2 == 1
        rims = None
        if goes_over or own > LEAVES:
            rims = _rims(setup, width_mm, ways, left, goes_over if one is other else None)
        if rims is None or _most_left(own, touch, rims) < rims.left:
            return None
        both = rims
    if not both.is_exchanged:
        return _laid_each(setup, (one, other), touch, both, whole)
    return _exchanged(setup, one, touch, both) if one is other else None


def _most_left(own: float, touch: Touch, rims: BothWays) -> float:
    """What ways within the rims of a touch may leave for each width, where the head's leave so much.

    The ink of a line that went over to its other side leaves more than both rims do; that of one that was
    drawn across itself leaves as much.
    """
    if own < LEAVES:
        return own - GAIN if rims.is_exchanged else -math.inf
    return LEAVES if touch.turns_back else own - GAIN


def _steepest_rad(ways: _Ways) -> float:
    """The largest angle by which two ways cross, rad, over a width to either side; 0 if they do not."""
    found = np.round(crossings(*ways)).astype(np.int64)
    about = round(1 / STEP_WIDTHS)

    def headings_rad(way: Array, at: NDArray[np.int64]) -> Array:
        along = way[np.minimum(at + about, len(way) - 1)] - way[np.maximum(at - about, 0)]
        return np.arctan2(along[:, 1], along[:, 0])

    one, other = (headings_rad(way, found[:, k]) for k, way in enumerate(ways))
    return float(
        np.max(np.abs(np.arctan2(np.sin(one - other), np.cos(one - other))), initial=0)
    )


def _rest_mm(
    ink: SeenInk, lines: Sequence[Line], touch: Touch, whole: Sequence[float]
) -> Array:
    """How far the ink is from all lines but the stretches of a touch, mm."""
    ways = [line.places_mm for n, line in enumerate(lines) if n not in touch.lines]
    step_mm = STEP_WIDTHS * lines[touch.lines[0]].width_mm
    if touch.lines[0] != touch.lines[1]:
        ways += [
            _stretch(lines[n], last, first + round_mm, step_mm)
            for n, first, last, round_mm in zip(
                touch.lines, touch.first_mm, touch.last_mm, whole, strict=True
            )
        ]
    else:
        (first, begin), (last, end) = touch.first_mm, touch.last_mm
        line, round_mm = lines[touch.lines[0]], whole[0]
        ways.append(_stretch(line, last, last + (begin - last) % round_mm, step_mm))
        ways.append(_stretch(line, end, end + (first - end) % round_mm, step_mm))
    return np.min([away_from(ink.places_mm, way) for way in ways], axis=0)


def _rims(
    setup: Setup, width_mm: float, ways: _Ways, left: Left, goes_over: bool | None
) -> BothWays | None:
    """The ways within the rims that leave least, from either way's beginning to either's end.

    Rims do not cross: of one line that goes over to its other side the ends are exchanged.
    """
    about = np.vstack(ways)
    best: BothWays | None = None
    for is_exchanged in (False, True) if goes_over is None else (goes_over,):
        onto = ways[::-1] if is_exchanged else ways
        found = list[list[LaidWay]]()
        for into, out_of in zip(ways, onto, strict=True):
            own = np.vstack([into[:2], out_of[-2:]])
            found.append(list(ways_within_rims(setup, width_mm, own, about)))
        for one, other in product(*found):
            rims = BothWays(one, other, is_exchanged, left(one.way, other.way))
            if best is None or rims.left < best.left:
                best = rims
    return best


def _laid_each(
    setup: Setup,
    pair: tuple[Line, Line],
    touch: Touch,
    both: BothWays,
    whole: Sequence[float],
) -> list[Line]:
    """The lines of a touch, or the one line, each along its way."""
    other = both.other if touch.is_parallel else both.other.turned_round()
    (first, begin), (last, end) = touch.first_mm, touch.last_mm
    bays = Bay(first, last, both.one, 0.0), Bay(begin, end, other, 0.0)
    if pair[0] is pair[1]:
        return [laid(setup, pair[0], bays, whole[0])]
    return [
        laid(setup, line, [bay], round_mm)
        for line, bay, round_mm in zip(pair, bays, whole, strict=True)
    ]


def _exchanged(setup: Setup, line: Line, touch: Touch, both: BothWays) -> list[Line]:
    """What one line is that goes over to itself at a touch: two lines, or one round a lobe the other way."""
    come_mm, more_mm = lengths_mm(line.places_mm), HALF_LEG * line.width_mm
    (first, begin), (last, end) = touch.first_mm, touch.last_mm

    def part(first_mm: float, last_mm: float) -> Line:
        at = (first_mm % come_mm[-1], last_mm % come_mm[-1])
        return part_of(line, *np.searchsorted(come_mm, at).tolist())

    if touch.is_parallel:
        own, other = part(last - more_mm, begin), part(end - more_mm, first)
        return [run_on(setup, [own], [both.other]), run_on(setup, [other], [both.one])]
    lobe = back_along(part(last, begin + more_mm))
    sides = [both.one, both.other.turned_round()]
    return [run_on(setup, [part(end - more_mm, first), lobe], sides)]
