"""Outlines: the closed contours of a net of lines; asked for one line, the head follows the longest of them.

Signals: the junctions of a net in; a closed chain of its lines out.

    ╭───┬───╮      round about, straight on over the junctions: a closed chain, as a pen draws it
    │   │   │
    ╰───┴───╯      else round the net's outside, by lines that turn at its junctions; bars and spurs are no
                   part of that

Source: our own. Questions: of two circles that overlap, is the outline one of them or round both? One of
them, as the pen drew it; round the outside is the outline where straight on leads round little of it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence, Set
from typing import NamedTuple

import cv2
import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.median import median
from morfax.motion.polyline import broad_mm
from morfax.tracer.drawing.numbering import InkSpread, longest_first
from morfax.tracer.ink.areas import Edge, ways_round
from morfax.tracer.ink.chains import Chain, Junctions, Link, Side
from morfax.tracer.sensing.leg import FACING, Leg, half_turn_rad, turn
from morfax.tracer.tangles.beside_itself import NEAR_WIDTHS

# of the way round the net's outside: two lines that overlap each make half of it or more, and a closed chain
# that is shorter is a detail of the drawing
MOST_OF_IT = 0.5
NEARLY_ALL = 0.9  # of a net: a way round so much is its silhouette


class Outline(NamedTuple):
    """A chain of lines, closed but for `one_stroke`, and its length by their ink, mm."""

    chain: Chain
    length_mm: float


def outlines(junctions: Junctions) -> list[Outline]:
    """The closed contours of a net, the longest first: closed chains, or the way round its outside."""
    lines = junctions.net.lines
    found = straight_chains(junctions)
    outside = _outside(junctions)
    longest_mm = max((each.length_mm for each in found), default=0.0)
    if outside is not None and longest_mm < MOST_OF_IT * outside.length_mm:
        found.append(outside)
    found = [each for each in found if goes_round_paper(each.chain, junctions)]
    if len(found) < 2:
        return found
    places = [
        np.vstack([lines[link.line].places_mm for link in each.chain.links]) for each in found
    ]
    every = np.vstack(places)
    order = longest_first(
        np.array([each.length_mm for each in found]),
        np.array([some.mean(axis=0) for some in places]),
        InkSpread.of(every, np.ones(len(every))),
    )
    return [found[k] for k in order]


def as_outline(chain: Chain, junctions: Junctions) -> Outline:
    """A chain as an outline."""
    return Outline(chain, sum(junctions.net.lines[link.line].length_mm for link in chain.links))


def straight_chains(junctions: Junctions) -> list[Outline]:
    """The closed chains that go straight on over their junctions, the longest first."""
    found = [
        as_outline(chain, junctions)
        for chain in junctions.chains()
        if chain.closed and _is_straight_on(chain, junctions)
    ]
    return sorted(found, key=lambda outline: -outline.length_mm)


def is_free(chain: Chain, junctions: Junctions) -> bool:
    """Whether both ends of a chain are ends of the ink."""
    return not chain.closed and all(_are_free(chain, junctions))


def ends_freely(chain: Chain, junctions: Junctions) -> bool:
    """Whether an end of a chain is one of the ink."""
    return not chain.closed and any(_are_free(chain, junctions))


def _are_free(chain: Chain, junctions: Junctions) -> tuple[bool, bool]:
    """Whether the first and the last end of a chain are ends of the ink."""
    lines, (first, last) = junctions.net.lines, (chain.links[0], chain.links[-1])
    ends = lines[first.line].junctions[first.back], lines[last.line].junctions[not last.back]
    return ends[0] in junctions.net.free_ends, ends[1] in junctions.net.free_ends


def goes_round(chain: Chain, junctions: Junctions, aside: Set[int]) -> bool:
    """Whether nearly all lines of a net, but those aside, lie on or inside a closed chain: its silhouette."""
    lengths_mm, on_it = junctions.lengths_mm, [link.line for link in chain.links]
    is_counted = np.ones(len(lengths_mm), bool)
    is_counted[list(aside)] = False
    least_mm = NEARLY_ALL * float(lengths_mm[is_counted].sum())
    # 1. what lies in its box
    low, high = (
        junctions.boxes_mm[on_it, 0].min(axis=0),
        junctions.boxes_mm[on_it, 1].max(axis=0),
    )
    middles = junctions.middles_mm
    is_near = np.all((middles >= low) & (middles <= high), axis=1)
    is_near[on_it] = True
    if lengths_mm[is_counted & is_near].sum() <= least_mm:
        return False
    # 2. what lies on it or inside
    around = junctions.places_along(chain).astype(np.float32).reshape(-1, 1, 2)
    is_in = np.zeros(len(lengths_mm), bool)
    is_in[on_it] = True
    for n in np.flatnonzero(is_counted & is_near & ~is_in):
        is_in[n] = cv2.pointPolygonTest(around, middles[n].tolist(), False) > 0
    return bool(lengths_mm[is_counted & is_in].sum() > least_mm)


def goes_round_paper(chain: Chain, junctions: Junctions) -> bool:
    """Whether the sides of a closed chain are further apart, in the mean, than the rims of one line's ink.

    Of 588 closed lines of 40 drawings 7 are not, all of them arms of crosses, arrowheads and strokes of
    letters, and no other is below 0.8 widths.
    """
    widths_mm = [junctions.net.lines[link.line].width_mm for link in chain.links]
    return broad_mm(junctions.places_along(chain)) > NEAR_WIDTHS * median(widths_mm)


def one_stroke(junctions: Junctions) -> Outline | None:
    """The one stroke from a free end that all the lines of a net are; None if they are several, or closed."""
    chains, lines = junctions.chains(), junctions.net.lines
    if len(chains) != 1 or chains[0].closed:
        return None
    first, last = chains[0].links[0], chains[0].links[-1]
    ends = lines[first.line].junctions[first.back], lines[last.line].junctions[not last.back]
    if not junctions.net.free_ends.intersection(ends):
        return None
    return Outline(chains[0], sum(line.length_mm for line in lines))


def _is_straight_on(chain: Chain, junctions: Junctions) -> bool:
    """Whether a closed chain goes straight on over its junctions, and does not turn off at any."""
    onward = [*chain.links[1:], chain.links[0]]
    for link, onto in zip(chain.links, onward, strict=True):
        far, near = Side(link.line, not link.back), Side(onto.line, onto.back)
        there = junctions.at(far)
        if len(there.sides) == 2:
            continue
        if turned_by(there.leg(far), there.leg(near).turned_round()) > FACING:
            return False
    return True


def turned_by(one: Leg, other: Leg) -> float:
    """By how much a way turns from an incoming leg onto an outgoing one, rad, or by how much more than their
    bends let expect, whichever is less: a bend felt beside other ink is none.
    """
    chord = other.end_mm - one.end_mm
    long_mm = float(np.hypot(*chord))
    if long_mm < one.width_mm:
        return abs(turn(one.heading_rad, other.heading_rad))
    along = math.atan2(chord[1], chord[0])
    before, after = turn(one.heading_rad, along), turn(along, other.heading_rad)
    half = half_turn_rad(one, other, long_mm)
    most = (
        max(abs(before + after - 2 * bend), abs(before - bend), abs(after - bend))
        for bend in (0.0, half)
    )
    return min(most)


def parts(junctions: Junctions, taken: Set[int] = frozenset()) -> list[Outline]:
    """The ways round the outside of the parts of a net that bars join, without bars and spurs, the longest
    first; of what is left without some lines that are taken.
    """
    lines = junctions.net.lines
    left = {n for n, line in enumerate(lines) if line.junctions[0] != line.junctions[1]} - taken
    while True:
        off = spurs(left, junctions) or _bars(left, junctions)
        if not off:
            break
        left -= off
    ways = [way for face in ways_round(left, junctions) for way in _simple(face, junctions)]
    # the outside is gone round clockwise
    round_about = [way for way in ways if _area_mm2(way, junctions) < 0]
    found = [
        as_outline(Chain([Link(*edge) for edge in way], True), junctions) for way in round_about
    ]
    return sorted(found, key=lambda outline: -outline.length_mm)


def _outside(junctions: Junctions) -> Outline | None:
    """The way round the outside of the largest part of a net; None if nothing goes round."""
    every = parts(junctions)
    return min(
        every, key=lambda outline: _area_mm2(outline.chain.links, junctions), default=None
    )


def spurs(left: set[int], junctions: Junctions) -> set[int]:
    """The lines that lead nowhere."""
    count = dict[int, int]()
    for n in left:
        for node in junctions.net.lines[n].junctions:
            count[node] = count.get(node, 0) + 1
    return {n for n in left if min(count[j] for j in junctions.net.lines[n].junctions) < 2}


def _bars(left: set[int], junctions: Junctions) -> set[int]:
    """The lines with the same area on both sides: they only lead from one part of a net to another."""
    faces = enumerate(ways_round(left, junctions))
    area_of = {edge: area for area, face in faces for edge in face}
    return {n for n in left if area_of[n, False] == area_of[n, True]}


def _simple(face: list[Edge], junctions: Junctions) -> list[list[Edge]]:
    """A way round in pieces that pass each junction once: where a net hangs together in one place."""
    ways, trail, nodes = list[list[Edge]](), list[Edge](), list[int]()
    for line, back in face:
        nodes.append(junctions.net.lines[line].junctions[back])
        trail.append((line, back))
        far = junctions.net.lines[line].junctions[not back]
        if far in nodes:
            k = nodes.index(far)
            ways.append(trail[k:])
            del trail[k:], nodes[k:]
    return ways


def _area_mm2(way: Sequence[Edge], junctions: Junctions) -> float:
    """The area that a way goes round, mm²; anticlockwise is more than 0."""
    x, y = _places(way, junctions).T
    return 0.5 * float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))


def _places(way: Sequence[Edge], junctions: Junctions) -> Array:
    """Places along a way, (n, 2) mm."""
    pieces = list[Array]()
    for line, back in way:
        places = junctions.net.lines[line].places_mm
        pieces.append(places[::-1] if back else places)
    return np.vstack(pieces)


def junctions_on(chain: Chain, junctions: Junctions) -> list[tuple[float, float]]:
    """The places of the junctions along a chain, mm, in the order in which it comes to them."""
    found = list[tuple[float, float]]()
    for link in chain.links:
        there = junctions.at(Side(link.line, not link.back))
        if len(there.sides) > 2:
            x, y = np.mean([leg.end_mm for leg in there.legs], axis=0)
            found.append((float(x), float(y)))
    return found
