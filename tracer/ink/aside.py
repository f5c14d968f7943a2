"""Lines of a net that are no contour's: dimension lines, hatching, and what leads nowhere without these.

Signals: the junctions of a net in; the numbers of its lines that stand aside from its contours out.

    ├◀──────────▶┤     a dimension line: the ink grows from an end of it, and is at once a line's again
    │            │     its extension lines lead nowhere then, ...
    ╭──╱──╱──╱───╮     ... nor do leaders and the ends of centre lines
    │ ╱  ╱  ╱  ╱ │     hatching: a family of strokes (see `hatching`) that end on lines that go on
    ╰────────────╯

A side of a contour may go straight on into a line that stands aside: then it ends there all the same.

Source: our own; ISO 128 and 129 say how a drawing is dimensioned and hatched.
"""

from __future__ import annotations

import math

import numpy as np

from morfax.motion.arrays import NOT_ZERO, Array
from morfax.motion.plane import direction
from morfax.motion.polyline import length_mm
from morfax.tracer.ink.chains import Chain, Junctions, Link, Side
from morfax.tracer.ink.hatching import ALIKE, EVEN, STRAIGHT, Hatching, hatching
from morfax.tracer.ink.onward import Onward
from morfax.tracer.ink.outlines import spurs
from morfax.tracer.ink.partners import meeting_place
from morfax.tracer.limits import ABOUT_WIDTHS, CLEAR_WIDTHS

# An arrowhead, by trial on drawings of parts; ISO 129 draws it 15 to 30 degrees wide.
LEAST_WIDTHS, MOST_WIDTHS = 2.5, 45.0  # of its line: how long it is
BASE = 1.6  # widths: as broad it is at the least where it is broadest
LINE = 1.25  # times as wide as its line, and as far as that: line
GROWN = 1.3  # times as broad as its tip is its foot, where it is broadest, ...
FOOT, AT_FOOT = 2.1, 0.85  # widths: two lines are less broad; and of its greatest breadth
BROADEST = 3.0  # ... and so many widths broad at the most, as far as cells feel
PIECES = 3  # of a stroke: a centre line and a leader may cross it
FEWEST = 4  # strokes of hatching that end on lines


def lines_aside(junctions: Junctions) -> set[int]:
    """The lines of a net, by their numbers, that are no contour's."""
    onward = Onward(junctions)
    aside = _with_spurs(_dimension_lines(onward), junctions)
    aside |= _hatching(aside, onward)
    return _with_spurs(aside, junctions)


def has_arrowhead(widths_mm: Array, step_mm: float, width_mm: float) -> bool:
    """Whether the ink of a line has an arrowhead at its first end, by the widths felt along it."""
    one = width_mm / step_mm  # stations to a width
    some = min(math.ceil(MOST_WIDTHS * one), len(widths_mm) // 2)
    widths = np.nan_to_num(widths_mm[:some], nan=math.inf) / width_mm
    broad = np.flatnonzero(widths[math.ceil(CLEAR_WIDTHS * one) :] > BASE) + math.ceil(
        CLEAR_WIDTHS * one
    )
    if not len(broad):
        return False
    base = int(broad[-1])
    drop = math.ceil(CLEAR_WIDTHS * one)
    behind = widths[base + drop : base + 3 * drop]
    if len(behind) < 2 * drop or not (behind < LINE).all():
        return False
    narrow = np.flatnonzero(widths[: max(base - drop // 2, 0)] < LINE)
    tip = int(narrow[-1]) + 1 if len(narrow) else 0
    head = np.minimum(widths[tip : base + 1], BROADEST)
    if tip > ABOUT_WIDTHS * one or len(head) < LEAST_WIDTHS * one:
        return False
    quarter = len(head) // 4
    foot = float(np.median(head[-quarter:]))
    is_broadest = foot > max(AT_FOOT * float(head.max()), FOOT)
    return bool(is_broadest and foot > GROWN * head[:quarter].min())


def _dimension_lines(onward: Onward) -> set[int]:
    """The lines with an arrowhead, and those into which they go straight on by the same pen."""
    found = set[int]()
    for n in range(len(onward.junctions.net.lines)):
        sides = Side(n, False), Side(n, True)
        if any(_ends_in_arrowhead(side, onward.junctions) for side in sides):
            found |= {n, *(link.line for side in sides for link in _straight_on(side, onward))}
    return found


def _ends_in_arrowhead(side: Side, junctions: Junctions) -> bool:
    """Whether a line has an arrowhead at a side."""
    line = junctions.net.lines[side.line]
    felt_mm = line.felt_mm[::-1] if side.last else line.felt_mm
    return has_arrowhead(felt_mm, line.runs[0].view.step_mm, line.width_mm)


def _straight_on(side: Side, onward: Onward) -> list[Link]:
    """The lines into which a line goes straight on from one of its sides, in order."""
    found, seen = list[Link](), {side.line}
    while onward.goes_on(side):
        onto = onward.junctions.at(side).partner(side)
        assert onto is not None
        if onto.line in seen:
            break
        seen.add(onto.line)
        found.append(Link(onto.line, onto.last))
        side = Side(onto.line, not onto.last)
    return found


def _strokes(onward: Onward) -> list[Chain]:
    """The lines of a net as far as they go straight on into each other."""
    done, found = set[int](), list[Chain]()
    for n in range(len(onward.junctions.net.lines)):
        if n in done:
            continue
        after = _straight_on(Side(n, True), onward)
        before = [Link(k, not back) for k, back in _straight_on(Side(n, False), onward)[::-1]]
        links = [*before, Link(n, False), *after]
        if before and after and before[0].line == after[-1].line:
            links = links[1:]
        done |= {link.line for link in links}
        found.append(Chain(links, False))
    return found


def _hatching(aside: set[int], straight: Onward) -> set[int]:
    """The lines of strokes of hatching: not both ends of one at the rim are at corners."""
    junctions = straight.junctions
    onward = Onward(junctions, aside)
    strokes = [stroke for stroke in _strokes(straight) if _may_be_hatching(stroke, onward)]
    ways = [_way(stroke, junctions) for stroke in strokes]
    families = hatching(ways, FEWEST) if ways else []
    if not families:
        return set()
    widths_mm = np.array(
        [junctions.net.lines[stroke.links[0].line].width_mm for stroke in strokes]
    )
    within, beside = _beside_families(families, ways, widths_mm)
    at_rim = (
        n for n in beside - within if any(_ends_on_line(it, onward) for it in _ends(strokes[n]))
    )
    return {link.line for n in within.union(at_rim) for link in strokes[n].links}


def _may_be_hatching(stroke: Chain, onward: Onward) -> bool:
    """Whether a stroke is crossed a few times at the most, and no line ends on it: a row of a table is no
    hatching.
    """
    links = stroke.links
    inside = (onward.junctions.at(Side(n, not back)) for n, back in links[:-1])
    is_crossed = all(len(there.sides) > 3 for there in inside)
    is_aside = all(link.line in onward.aside for link in links)
    return len(links) <= PIECES and is_crossed and not is_aside


def _beside_families(
    families: list[Hatching], ways: list[Array], widths_mm: Array
) -> tuple[set[int], set[int]]:
    """The numbers of the strokes that run between two of a family, like them; and beside one."""
    within, beside = set[int](), set[int]()
    begins, ends = np.array([way[0] for way in ways]), np.array([way[-1] for way in ways])
    middles, chords = 0.5 * (begins + ends), ends - begins
    long_mm = np.maximum(np.hypot(chords[:, 0], chords[:, 1]), NOT_ZERO)
    straight = long_mm + widths_mm > STRAIGHT * np.array([length_mm(way) for way in ways])
    for family in families:
        # 1. strokes along its heading, and which of them lie beside each other, as far apart as its own
        ahead = direction(family.heading_rad)
        right = np.array([ahead[1], -ahead[0]])
        turns_mm = math.sin(ALIKE) * long_mm + 0.5 * widths_mm
        like = np.flatnonzero(straight & (np.abs(chords @ right) < turns_mm))
        away = middles[like][:, None] - middles[like][None]
        aside_mm, along_mm = away @ right, np.abs(away @ ahead)
        is_next = 0.5 * (long_mm[like][:, None] + long_mm[like][None]) > along_mm
        is_next &= np.abs(np.abs(aside_mm) / family.apart_mm - 1) < EVEN
        # 2. those beside the family, and those beside them
        found, count = np.isin(like, family.strokes), 0
        while found.sum() > count:
            count = int(found.sum())
            found |= (is_next & found[None]).any(axis=1)
        # 3. between two of them
        sides = (aside_mm > 0, aside_mm < 0)
        one, other = ((is_next & found[None] & side).any(axis=1) for side in sides)
        within.update(like[found & one & other].tolist())
        beside.update(like[found].tolist())
    return within, beside


def _ends(chain: Chain) -> tuple[Side, Side]:
    """The sides at which a chain begins and ends."""
    first, last = chain.links[0], chain.links[-1]
    return Side(first.line, first.back), Side(last.line, not last.back)


def _ends_on_line(side: Side, onward: Onward) -> bool:
    """Whether a line ends free, or on others that go on there."""
    others = [other for other in onward.junctions.at(side).sides if other != side]
    return not others or any(onward.goes_on(it) for it in others if it.line not in onward.aside)


def _way(chain: Chain, junctions: Junctions) -> Array:
    """Places along an open chain, (n, 2) mm, from the junction where it begins to that where it ends."""
    first, last = _ends(chain)
    along = junctions.places_along(chain)
    return np.vstack([_end_mm(first, junctions), along, _end_mm(last, junctions)])


def _end_mm(side: Side, junctions: Junctions) -> Array:
    """Where a line ends, straight on from its clean end: beside the place where lines meet, (x, y) mm."""
    there = junctions.at(side)
    leg = there.leg(side)
    way = direction(leg.heading_rad)
    return np.asarray(
        leg.end_mm + max(0.0, float((meeting_place(there.legs) - leg.end_mm) @ way)) * way
    )


def _with_spurs(aside: set[int], junctions: Junctions) -> set[int]:
    """Lines that stand aside, with those that lead nowhere without them."""
    left = set(range(len(junctions.net.lines))) - aside
    while found := spurs(left, junctions):
        left -= found
    return set(range(len(junctions.net.lines))) - left
