"""Partners: which legs of a junction are one line, all chosen at once, and the way from one to the other.

Signals: the legs of a junction, each as it comes in, in; pairs of legs out, and the stretches (n, 2) mm from
one leg's clean end to the other's.

    smooth    the way bends little between two legs, what they bend themselves apart
    vertex    two legs meet where the junction's lines meet: a corner

Every pairing of the legs is weighed as a whole; the one that joins the most legs with the least turning
holds. So three lines through one place keep their partners: a leg takes another's partner only if both are
the better for it. The turning of a way is the bending of the cubic over it, less what its legs bend:

    turning² = a² - a·b + b²       a, b: the turns at either end of the chord, each less half of bend · chord

Source: our own; a cubic's energy of bending over a chord c is 4/c · (a² - a·b + b²).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cache
from heapq import nsmallest
from itertools import combinations

import numpy as np

from morfax.motion.arrays import ROUNDED, Array
from morfax.motion.curves import bow, hermite
from morfax.motion.plane import left_of_headings
from morfax.tracer.head.course import ON_INK, SMOOTH, on_ink, through_nodes
from morfax.tracer.ink.shared_ink import SharedInk, kept_in_ink, off_rims_mm
from morfax.tracer.junctions.corner import Corner, sharp_corner
from morfax.tracer.junctions.planner import BEYOND_MM, Planner
from morfax.tracer.sensing.leg import Leg, half_turn_rad, turn
from morfax.tracer.sensing.view import View
from morfax.tracer.tangles.strands import stretches_over

# All limits below were chosen by trial on drawings of nets.
SMOOTHLY = math.radians(22)  # a way that turns by no more between two legs is smooth
TIP = math.radians(60)  # between two legs that come in side by side: they may make a tip
# widths from where all legs meet, or of how far apart their ends are: two that meet there may be a corner
AT_VERTEX, OF_WIDE = 0.6, 0.07
# a corner counts as turning so much: a smooth way is likelier. How far it turns tells next to nothing of
# whether it is one, against by how much another line bends: a rad of it adds so many rad²
CORNERED, SHARPER = math.radians(120), 0.05
HIDDEN_WIDTHS = 6.0  # a vertex further beyond both clean ends is told by neither leg
STRETCHED = math.radians(0.3)  # a way that is a width longer counts as turning so much more
NOT_JOINED = 10.0  # rad: leaving two legs that may be joined costs more than any way
NEARER = 0.05  # widths: a way that is so much nearer to its rims, in the mean, is the line's
FELT_NODES = 6  # places felt between two legs that a way goes through, where nothing else fits
# of more legs the straightest are paired first, and partners exchanged: all ways would take seconds, as would
# each trial of such a crossing on its ink, and hardly any explains that
MOST_LEGS = 20
INKED = 12  # places of a leg on to a corner, of which a share is ink, as of a course
NOBODY = -1

Pair = tuple[int, int]


def turnings(legs: Sequence[Leg], width_mm: float, view: View | None = None) -> Array:
    """By how much a way turns from each leg to each other, rad; infinite if they are no line.

    With a view two legs are a line wherever ink leads from both to where they meet.
    """
    count = len(legs)
    costs = np.full((count, count), math.inf)
    middle = meeting_place(legs)
    wide_mm = float(np.hypot(*np.ptp([leg.end_mm for leg in legs], axis=0)))
    about = middle, max(AT_VERTEX * width_mm, OF_WIDE * wide_mm)
    for a in range(count):
        for b in range(a + 1, count):
            costs[a, b] = costs[b, a] = _turning(legs[a], legs[b], about, width_mm, view)
    return costs


def likeliest(costs: Array, count: int) -> list[tuple[Pair, ...]]:
    """So many ways to pair some legs, those that turn least first; of very many legs one."""
    legs = len(costs)
    if legs > MOST_LEGS:
        return [tuple(_exchanged(_straightest_first(costs), costs))]

    @cache
    def of(left: int) -> list[tuple[float, tuple[Pair, ...]]]:
        """The cheapest ways to pair those legs whose bits are set, with what each costs."""
        if not left:
            return [(0.0, ())]
        first = (left & -left).bit_length() - 1
        rest = left ^ 1 << first
        ways = [(cost + 0.5 * NOT_JOINED, pairs) for cost, pairs in of(rest)]
        for other in range(first + 1, legs):
            pair, own = (first, other), float(costs[first, other]) ** 2
            if rest >> other & 1 and own < NOT_JOINED:
                ways += [(cost + own, (pair, *pairs)) for cost, pairs in of(rest ^ 1 << other)]
        return nsmallest(count, ways)

    return [pairs for _, pairs in of((1 << legs) - 1)]


def partners(costs: Array) -> list[Pair]:
    """The pairs of legs that are one line, by their turnings; of an odd number one is left."""
    return list(likeliest(costs, 1)[0])


def without_partner(pairs: Sequence[Pair], legs: int) -> list[int]:
    """Those of so many legs that are in no pair."""
    paired = {leg for pair in pairs for leg in pair}
    return [leg for leg in range(legs) if leg not in paired]


def are_side_by_side(one: Leg, other: Leg) -> bool:
    """Whether two legs come in side by side, so that they may make a tip."""
    return abs(turn(one.heading_rad, other.heading_rad)) < TIP


def pairs_cost(pairs: Sequence[Pair], costs: Array) -> float:
    """What it costs to pair some legs so, and to leave the others without partners, rad²."""
    alone = len(costs) - 2 * len(pairs)
    return _cost(tuple(pairs), costs) + 0.5 * NOT_JOINED * alone


def meeting_place(legs: Sequence[Leg]) -> Array:
    """The place nearest to the lines of all legs, (x, y) mm; the mean of their ends if they are one line."""
    ends = np.array([leg.end_mm for leg in legs])
    headings = np.array([leg.heading_rad for leg in legs])
    normals = left_of_headings(headings)
    sums = normals.T @ normals
    middle = ends.mean(axis=0)
    if np.linalg.eigvalsh(sums)[0] < SMOOTH**2:
        return np.asarray(middle)
    return np.asarray(np.linalg.solve(sums, normals.T @ np.sum(normals * ends, axis=1)))


def way_through(
    planner: Planner, legs: tuple[Leg, Leg], between: Array | None, ink: SharedInk | None = None
) -> list[Array]:
    """Stretches (n, 2) mm from where the planner's head stands to the outgoing leg's clean end, or beyond.

    `legs` are the incoming and the outgoing one, and `ink` is what was felt of the junction's own ink.
    `between` holds places that were felt between two legs that are alone there, if they are: then their ink
    shows whether their corner is round.
    """
    incoming, outgoing = legs
    onto = outgoing.end_mm, outgoing.heading_rad
    straight = bow(*planner.stands, *onto)
    smooth, others = [straight], list[Array]()
    if ink is not None:
        ends = np.vstack([incoming.end_mm, outgoing.end_mm])
        others, vertices = ink.besides(ends), ink.turns_at(ends)
        if vertices is not None and len(vertices):
            return stretches_over(planner.stands, incoming, vertices, outgoing)
        if vertices is not None:  # as it was held against the ink
            straight = hermite(*planner.stands, *onto)
        smooth = [kept_in_ink(straight, ink, planner.view.width_mm, others)]
        if vertices is not None:
            return smooth
    corner = Corner.of(incoming, outgoing)
    ways = list[list[Array]]()
    if between is not None:
        ways.append(planner.through(incoming, outgoing, corner).stretches)
    elif (
        corner is not None
        and not _bends_on(incoming, outgoing)
        and is_corner(corner, planner.view.width_mm, is_felt=ink is not None)
    ):
        end_mm = max(0.0, BEYOND_MM - corner.before_mm)
        ways.append(sharp_corner(planner.stands, corner, end_mm))
    ways.append(smooth)
    if ink is not None and len(ways) > 1:
        # a circle that touches another line turns as much as a corner: the rims tell
        off_mm = [
            off_rims_mm(np.vstack(way), ink, planner.view.width_mm, others) for way in ways
        ]
        if off_mm[1] < off_mm[0] - NEARER * planner.view.width_mm:
            ways = [smooth]
    if between is not None and len(between) > 2:
        some = between[:: max(1, len(between) // FELT_NODES)]
        ways.append([_through_places(planner.stands, some, onto)])
    return next((way for way in ways if on_ink(planner.view, way)), smooth)


def is_corner(corner: Corner, width_mm: float, *, is_felt: bool = True) -> bool:
    """Whether two legs of a junction turn at a vertex, and do not go on smoothly.

    Far from both their legs can not tell a vertex; if the ink there was felt its rims tell the way.
    """
    is_hidden = is_felt and corner.nearest_mm > HIDDEN_WIDTHS * width_mm
    return corner.deflection_rad > SMOOTH and corner.nearest_mm > -width_mm and not is_hidden


def _through_places(
    begin: tuple[Array, float], places: Array, end: tuple[Array, float]
) -> Array:
    """Cubics from a place and heading through places to another place and heading, (n, 2) mm."""
    every = np.vstack([begin[0], places, end[0]])
    chords = every[2:] - every[:-2]
    headings = np.arctan2(chords[:, 1], chords[:, 0])
    return through_nodes([begin, *zip(places, headings.tolist(), strict=True), end])


def _turning(
    one: Leg, other: Leg, about: tuple[Array, float], width_mm: float, view: View | None
) -> float:
    """By how much a way turns from one incoming leg onto another, rad; infinite if they are no line.

    `about` is where all legs meet, and how near to that a corner is, mm; with a view ink leads there.
    """
    out = other.turned_round()
    chord = out.end_mm - one.end_mm
    long = float(np.hypot(*chord))
    if long < 1e-6:
        return abs(turn(one.heading_rad, out.heading_rad))
    # a bend felt along a short leg beside other ink is none: over a long chord it tells nothing
    turning = min(_turned(one, out, chord, share) for share in (0.0, 1.0))
    longer = STRETCHED * long / width_mm
    if turning < SMOOTHLY:
        return turning + longer
    corner = Corner.of(one, out)
    if corner is None:
        return math.inf
    if math.dist(corner.vertex_mm, about[0]) > about[1] and not _is_inked(corner, view):
        return math.inf
    return math.sqrt(CORNERED**2 + SHARPER * corner.deflection_rad + longer**2)


def _bends_on(one: Leg, out: Leg) -> bool:
    """Whether a way that bends as two legs do, and by more than a smooth one, leads from one to the other."""
    chord = out.end_mm - one.end_mm
    return _turned(one, out, chord, 1.0) < SMOOTH < _turned(one, out, chord, 0.0)


def _turned(one: Leg, out: Leg, chord: Array, share: float) -> float:
    """By how much a way turns from leg to leg over a chord, besides a share of what both bend, rad."""
    along = math.atan2(chord[1], chord[0])
    bend = share * half_turn_rad(one, out, math.hypot(*chord))
    before, after = turn(one.heading_rad, along), turn(along, out.heading_rad)
    return _bending(before - bend, after - bend)


def _is_inked(corner: Corner, view: View | None) -> bool:
    """Whether ink leads from both legs of a corner to where they meet."""
    if view is None or corner.nearest_mm < -corner.width_mm:
        return False
    share = np.linspace(0.0, 1.0, INKED)
    ways = [
        corner.incoming.at(share * corner.beyond_mm),
        corner.outgoing.at(-share * corner.before_mm),
    ]
    return bool(np.mean(view.darkness_along(np.vstack(ways)) > view.level) > ON_INK)


def _bending(a: float, b: float) -> float:
    """The turning of the cubic that turns by `a` onto its chord and by `b` off it, rad: a + b is the whole
    turn, and a - b tells by how far the legs miss each other.
    """
    return math.sqrt(max(a * a + b * b - a * b, 0.0))


def _straightest_first(costs: Array) -> list[Pair]:
    """Pairs taken one after the other, the straightest first."""
    left, pairs = costs.copy(), list[Pair]()
    while np.isfinite(left).any():
        a, b = np.unravel_index(int(np.argmin(left)), left.shape)
        pairs.append((int(a), int(b)))
        left[[a, b]] = left[:, [a, b]] = math.inf
    return pairs


def _exchanged(pairs: list[Pair], costs: Array) -> list[Pair]:
    """Pairs whose partners were exchanged as long as two of them are the better for it."""
    # a leg without a partner is a pair with nobody
    now = [*pairs, *((leg, NOBODY) for leg in without_partner(pairs, len(costs)))]
    is_better = True
    while is_better:
        is_better = False
        for one, other in combinations(range(len(now)), 2):
            (a, b), (c, d) = now[one], now[other]
            for tried in (((a, c), (b, d)), ((a, d), (b, c))):
                if _cost(tried, costs) < _cost((now[one], now[other]), costs) - ROUNDED:
                    now[one], now[other] = tried
                    is_better = True
    return [(min(pair), max(pair)) for pair in now if _is_joined(pair, costs)]


def _is_joined(pair: Pair, costs: Array) -> bool:
    """Whether a pair is two legs that are one line."""
    return NOBODY not in pair and math.isfinite(costs[pair])


def _cost(pairs: tuple[Pair, ...], costs: Array) -> float:
    """What some pairs cost, rad²; half as much as two legs that are not joined if there is but one."""
    return sum(
        min(costs[pair] ** 2, NOT_JOINED)
        if NOBODY not in pair
        else 0.5 * NOT_JOINED * sum(leg != NOBODY for leg in pair)
        for pair in pairs
    )
