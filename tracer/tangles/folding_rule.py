"""The folding rule: a stretch of line as straight pieces between two places on it, sharp or rounded where
they meet.

    ───╮   ╭───     a notch or a tongue that is hardly wider than two lines: four corners, of which two may be
       │   │        rounded; one that comes to a point has three
       ╰───╯

Between the corners of such a bay the head finds no clean line that is as long as its legs. So the rule is
laid along the head's own way, or round a bar of ink beside the line, and its corners, their rounding and the
pen's width are moved until the pen's ink along it differs least from the ink that is there. Of all rules that
one is taken which explains the ink with the fewest figures.

Signals: the ink about a stretch, the places between which it lies, and rules to begin with, in; the best rule
out, with its way (n, 2) mm and how much ink it leaves unexplained (see `seen_ink`).

Source: our own; a draughtsman draws a notch by straightedge and compass. Questions: a bay with bent sides is
explained by no rule.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.crossings import crossings_of
from morfax.motion.polyline import area_mm2, evenly, length_mm, nearest_mm
from morfax.tracer.sensing.leg import TURNS_BACK
from morfax.tracer.sensing.view import STEP_WIDTHS
from morfax.tracer.tangles import bent_rule, beside_itself, distances
from morfax.tracer.tangles.figured import Figured
from morfax.tracer.tangles.least_squares import fitted
from morfax.tracer.tangles.seen_ink import LIKE, PRICE, STEPS, SeenInk, best_of

# which of so many corners are rounded: the patterns that are tried
ROUNDED = {
    1: ((False,), (True,)),
    2: ((False, False), (True, True)),
    3: ((False, False, False), (False, True, False)),
    4: ((False, False, False, False), (False, True, True, False)),
}
ROUNDING = 0.8  # of half a width, as a rounded rule begins
LIKE_PEN = 0.7, 1.4  # times as wide as was felt: another pen explains nothing
MOST_SETTLED = 8  # of the rules, those that explain most to begin with
# times what a bay may leave: a rule about a bar of ink that leaves more to begin with comes to no bay; those
# of parts and of handwriting that did left up to 7.4
FAR = 10.0
BESIDE = 1.2  # half widths from the line: darker ink further away is a bar's
FEWEST = 20  # places that a bar of ink has, at the least
APART = 0.8  # widths: the sides of a bay begin, at the least
DEEP = 1.2  # widths: a bay is so deep at the least; a flatter one is hidden in the line
WITHIN = 0.4  # of mouth times depth lies within a bay: half in one that comes to a point
OF_TIP = 3  # corners: a tip, and where it begins on either side
FURTHEST = 4.0  # times as far as a bar is long, from its tip, the line is looked for


class Rule(NamedTuple):
    """A rule between two places (x, y) mm, with its corners (m, 2) mm, which of them (m,) are rounded, by
    what radius, and half the pen's width, mm.
    """

    first_mm: Array
    last_mm: Array
    corners_mm: Array
    rounded: NDArray[np.bool_]
    radius_mm: float
    half_mm: float
    misfit: float = math.inf

    @property
    def figures(self) -> int:
        """How many figures it takes."""
        return self.corners_mm.size + bool(self.rounded.any())

    @property
    def cost(self) -> float:
        """The misfit, and the price of the figures."""
        return self.misfit + PRICE * self.figures

    @property
    def way(self) -> Array:
        """The way (n, 2) mm."""
        return self._places()[:, :2]

    @property
    def length_mm(self) -> float:
        """The length of the way."""
        return length_mm(self.way)

    @property
    def ahead(self) -> Array:
        """From its first place to its first corner, (x, y) mm."""
        return np.asarray(self.corners_mm[0] - self.first_mm)

    def stretches(self) -> list[Array]:
        """The way as stretches (n, 2) mm between sharp corners."""
        places = self._places()
        sharp = np.flatnonzero(places[:, 2]).tolist()
        ends = zip([0, *sharp], [*sharp, len(places) - 1], strict=True)
        return [places[first : last + 1, :2] for first, last in ends]

    def _places(self) -> Array:
        """Places along it (n, 3): x and y in mm, and 1 where it turns sharply."""
        out = np.empty((bent_rule.most_places(len(self.rounded)), 3))
        ends = np.array([self.first_mm, self.last_mm])
        corners, radius_mm = np.ascontiguousarray(self.corners_mm), float(self.radius_mm)
        rule, counts = (ends, self.rounded), np.zeros(len(corners), np.int64)
        return out[: bent_rule.bent(rule, corners, radius_mm, counts, out)]


def along(way: Array, half_mm: float) -> Iterator[Rule]:
    """Rules along a way (n, 2) mm, with the corners of it that matter most."""
    kept = list[Array]()
    for count in sorted(ROUNDED, reverse=True):
        if len(way) >= count + 2:
            way = _reduced(way, count + 2)
            kept.append(way)
    for each in reversed(kept):
        yield from _of_corners(each[0], each[-1], each[1:-1], half_mm)


def by_tip(way: Array, tip_mm: Array | None, half_mm: float) -> Iterator[Rule]:
    """Sharp rules along a way (n, 2) mm, and, with a tip (x, y) mm beside it, those that turn there in place
    of the piece that is nearest to it or of the next: of no more corners than a tip has.
    """
    for count in range(2, min(OF_TIP + 2, len(way)) + 1):
        kept = _reduced(way, count)
        if count > 2:
            yield sharp(kept[0], kept[-1], kept[1:-1], half_mm)
        if tip_mm is None or count > OF_TIP + 1:
            continue
        pieces = [kept[k : k + 2] for k in range(len(kept) - 1)]
        away_mm = [
            nearest_mm(tip_mm[None], evenly(piece, 0.1 * half_mm))[0] for piece in pieces
        ]
        for k in np.argsort(away_mm)[:2].tolist():
            corners_mm = np.vstack([kept[1 : k + 1], tip_mm[None], kept[k + 1 : -1]])
            yield sharp(kept[0], kept[-1], corners_mm, half_mm)


def sharp(first_mm: Array, last_mm: Array, corners_mm: Array, half_mm: float) -> Rule:
    """The rule of some corners (m, 2) mm, all sharp."""
    rounded = np.zeros(len(corners_mm), np.bool_)
    return Rule(first_mm, last_mm, corners_mm, rounded, 0.0, half_mm)


def round_bar(ink: SeenInk, legs: Array) -> Iterator[Rule]:
    """Rules round the bar of ink beside a line, of which the legs (n, 2) mm on either side are known."""
    half_mm = ink.half_mm
    away_mm = np.minimum(distances.away_from(ink.places_mm, legs), ink.known_mm)
    bar = ink.without_specks((away_mm > BESIDE * half_mm) & (ink.darkness > 0.5))
    if len(bar) < FEWEST:
        return
    # 1. the bar as a rectangle, and which side of that is its tip
    middle = bar.mean(axis=0)
    around = cv2.minAreaRect((bar - middle).astype(np.float32))
    box = middle + cv2.boxPoints(around).astype(float)
    beyond_mm = distances.away_from(box, legs)
    tip = int(np.argmax(beyond_mm + np.roll(beyond_mm, -1)))
    left, right, foot = box[tip], box[(tip + 1) % 4], box[tip - 1]
    across, out = right - left, left - foot
    if min(np.hypot(*across), np.hypot(*out)) < half_mm:
        return
    across, out = across / np.hypot(*across), out / np.hypot(*out)
    # 2. corners half a width within the tip, and where the sides come to the line
    tips = np.array([left + half_mm * (across - out), right - half_mm * (across + out)])
    feet = np.array([_foot(place, out, legs, FURTHEST * beyond_mm.max()) for place in tips])
    if np.hypot(*(feet - legs[0]).T).argmin() == 1:
        tips, feet = tips[::-1], feet[::-1]
    point = tips.mean(axis=0) + ROUNDING * half_mm * out
    for corners in (np.vstack([feet[0], tips, feet[1]]), np.vstack([feet[0], point, feet[1]])):
        yield from _of_corners(legs[0], legs[-1], corners, half_mm)


def not_far(ink: SeenInk, rules: Iterable[Rule]) -> list[Rule]:
    """Those of some rules about a bar of ink that may come to a bay: they leave not far more than one may."""
    most = FAR * LIKE / ink.width_mm
    return [rule for rule in rules if _drawn(ink, rule).misfit < most * rule.length_mm]


def explained(ink: SeenInk, rules: Iterable[Rule], of_bay: bool = True) -> Rule | None:
    """The rule that explains the ink best with few figures, of some to begin with; None if none does.

    That of a bay has sides that stay apart, or begin apart and meet in a point.
    """
    drawn = [_drawn(ink, rule) for rule in rules]
    likely = sorted(drawn, key=lambda rule: rule.cost)[:MOST_SETTLED]
    return best_of(ink, likely, _settled_bay if of_bay else _settled)


def _of_corners(
    first_mm: Array, last_mm: Array, corners_mm: Array, half_mm: float
) -> Iterator[Rule]:
    """Rules with the same corners, sharp and rounded."""
    for pattern in ROUNDED[len(corners_mm)]:
        radius_mm = ROUNDING * half_mm if any(pattern) else 0.0
        yield Rule(first_mm, last_mm, corners_mm, np.array(pattern), radius_mm, half_mm)


def _reduced(way: Array, count: int) -> Array:
    """A way with so many places: of those within it the one is left out that matters least."""
    while len(way) > count:
        before, after = way[:-2] - way[1:-1], way[2:] - way[1:-1]
        matters = np.abs(before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0])
        way = np.delete(way, 1 + int(np.argmin(matters)), axis=0)
    return way


def _foot(place: Array, out: Array, legs: Array, furthest_mm: float) -> Array:
    """Where a side that comes from a place against a direction is nearest to the legs."""
    side = place - np.linspace(0.0, furthest_mm, 200)[:, None] * out
    return np.asarray(side[int(np.argmin(distances.away_from(side, legs)))])


def _drawn(ink: SeenInk, rule: Rule) -> Rule:
    """A rule with its misfit."""
    return rule._replace(misfit=ink.misfit(ink.drawn_along(rule.way, rule.half_mm)))


def _settled_bay(ink: SeenInk, start: Rule) -> Rule | None:
    """The same of a bay; None also if the pen runs out and back along one line."""
    rule = _settled(ink, start)
    if rule is not None and _changes_over(rule):
        rule = _settled(ink, _turned_back(rule))
    return rule if rule is not None and _is_apart(rule, ink.width_mm) else None


def _changes_over(rule: Rule) -> bool:
    """Whether a rule's way is shorter by its corners in the other order: within the ink of both sides of a
    slender bay it changes over from one to the other, which no ink shows.
    """
    return _sides_mm(_turned_back(rule)) < _sides_mm(rule)


def _turned_back(rule: Rule) -> Rule:
    """A rule by its corners in the other order."""
    return rule._replace(corners_mm=rule.corners_mm[::-1], rounded=rule.rounded[::-1])


def _sides_mm(rule: Rule) -> float:
    """How long the sides of a rule are from corner to corner."""
    return length_mm(np.vstack([rule.first_mm, rule.corners_mm, rule.last_mm]))


def _settled(ink: SeenInk, start: Rule) -> Rule | None:
    """A rule moved to where the pen leaves the ink that is there; None if the pen becomes another, or comes
    off the ink.
    """
    size, radius = start.corners_mm.size, [start.radius_mm] if start.rounded.any() else []
    figures = np.r_[start.corners_mm.ravel(), radius, start.half_mm]
    shape = Figured.rule(np.array([start.first_mm, start.last_mm]), start.rounded)
    found = fitted(shape, ink.for_kernel(), figures, STEPS * len(figures))
    corners_mm, radius_mm = found[:size].reshape(-1, 2), float(found[size]) if radius else 0.0
    rule = start._replace(corners_mm=corners_mm, radius_mm=radius_mm, half_mm=float(found[-1]))
    least, most = LIKE_PEN
    is_pen = least * ink.half_mm < rule.half_mm < most * ink.half_mm
    return _drawn(ink, rule) if is_pen and ink.holds(rule.way) else None


def turned_rad(before: Array, place: Array, after: Array) -> float:
    """By how much a way turns at a place (x, y) mm between two others."""
    (x, y), (u, v) = place - before, after - place
    return abs(math.atan2(x * v - y * u, x * u + y * v))


def _is_apart(rule: Rule, width_mm: float) -> bool:
    """Whether a rule does not cross itself, and its sides stay apart, or begin apart and meet in a point;
    those of one corner may run together all the way.
    """
    corners, step_mm = rule.corners_mm, STEP_WIDTHS * width_mm
    way = evenly(rule.way, step_mm)
    if len(crossings_of(way, np.arange(len(way) - 1))):
        return False
    if len(corners) == 1:
        return True  # a tip, as narrow as it may be: a pen that runs out along a tick turns twice more
    if len(corners) > 2:
        at_first = turned_rad(rule.first_mm, corners[0], corners[1])
        at_last = turned_rad(corners[-2], corners[-1], rule.last_mm)
        if max(at_first, at_last) > TURNS_BACK:
            return False
        mouth = corners[[0, -1]]
        deep_mm = float(distances.away_from(corners, mouth).max())
        is_open = float(np.hypot(*(mouth[1] - mouth[0]))) > APART * width_mm
        is_open &= deep_mm > DEEP * width_mm
        return is_open and abs(area_mm2(corners)) > WITHIN * APART * width_mm * deep_mm
    # as if the way were closed far out
    beyond = way[-1] + np.arange(1, len(way) + 1)[:, None] * (way[-1] - way[-2])
    return not beside_itself.stretches(np.vstack([way, beyond]), step_mm, width_mm)
