"""The rim: the outer edge of a closed line whose sides run together, and the way of the pen within it.

    ╭───────────────╮     slots, slits and kerfs of any shape: between the sides the cells see little paper or
    │ ╭───────────╮ │     none, but the outer edge of the ink is as clear as that of any line; the line lies
    ╰─┴───────────┴─╯     half a pen's width within it

Where the line turns away from the paper within, the rim's corner is round or sharp like the line's; where it
turns towards that, the rim is sharp in either case, and the line is taken to be.

Signals: the cells, and places (n, 2) mm about on the rim, in; the rim as it was felt, and the closed way
(n, 2) mm at a distance within it, out.

Source: our own; patent ES 361967 follows the middle of a line. Questions: whether it is one broad line or two
narrow ones the rim does not tell; the ink within does (see `program.laid.small_loops`).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.compiled import njit
from morfax.motion.median import median
from morfax.motion.neighbours import Neighbours
from morfax.motion.plane import cross, direction, left_of_headings, meeting
from morfax.motion.polyline import at_lengths, closed_up, length_mm
from morfax.tracer.ink.run import parabolas
from morfax.tracer.limits import NEARLY_PARALLEL
from morfax.tracer.sensing.ray import SPECK_MM, SPECK_PX, Ray, crossing_mm
from morfax.tracer.sensing.view import View

# In widths of the pen, by trial on slots of all shapes:
SMOOTH = 0.3  # to either side of a place the steps of pixels are smoothed by
REACH = 0.6  # to either side the edge is looked for
# to either side of a place: no longer, or it cuts the round corner of a square end
PARABOLA = 0.4
TIGHT = 1.0  # radius: where the rim turns so towards the ink, the line has a corner
BEYOND = 0.25  # before and after such a corner the parabolas are bent by it
LONGEST_MITRE = 3.0
# squared, over the root of the number of places that tell: so much less ink another corner must leave. A
# round one of half a width leaves 0.16 less than a sharp one; noise, at 66 places, less than 0.02
BETTER = 0.16
FEWEST = 20  # places of a rim
TIMES = 2  # it is felt: across the steps of pixels, and across what was felt

# what a pen along a way (n, 2) mm leaves unexplained at each of some places, (m,) squares of its width
LeftAt = Callable[[Array], Array]


class Rim(NamedTuple):
    """A rim as it was felt, counter-clockwise: places (n, 2) mm, headings rad, bends 1/mm to the left."""

    places_mm: Array
    headings_rad: Array
    bends_per_mm: Array

    def way(self, within_mm: float) -> Array:
        """The closed way (n, 2) mm, not closed up, that lies so far within the rim, as sharp as it may be."""
        return self.corners(within_mm).mitred()

    def corners(self, within_mm: float) -> RimCorners:
        """The way that lies so far within the rim, and where the line may have sharp corners."""
        way = self.places_mm + within_mm * left_of_headings(self.headings_rad)
        width_mm, none = 2 * within_mm, np.empty((0, 2), np.int64)
        longest_mm = LONGEST_MITRE * width_mm
        tight = self.bends_per_mm * TIGHT * width_mm < -1.0
        # of all its places: the first two may be felt at nearly one spot
        apart_mm = median(np.hypot(*np.diff(self.places_mm, axis=0).T))
        beyond = max(1, round(BEYOND * width_mm / apart_mm))
        # no corner of a way that is all within one
        if not tight.any() or tight.all() or beyond >= len(way):
            return RimCorners(way, self.headings_rad, none, longest_mm)
        first = _farthest(tight)
        way, headings = np.roll(way, -first, axis=0), np.roll(self.headings_rad, -first)
        changes = np.diff(np.roll(tight, -first).astype(np.int8), prepend=0, append=0)
        corners = np.flatnonzero(changes).reshape(-1, 2) + np.array([-beyond, beyond])
        return RimCorners(way, headings, np.clip(corners, 0, len(way) - 1), longest_mm)


class RimCorners(NamedTuple):
    """A closed way (n, 2) mm within a rim with its headings (n,) rad, and from which place to which the line
    may have a sharp corner (m, 2), whose mitre is no longer than so many mm.
    """

    way: Array
    headings_rad: Array
    at: NDArray[np.int64]
    longest_mm: float

    @property
    def middles_mm(self) -> Array:
        """The middles of its corners, (m, 2) mm."""
        return self.way[self.at.sum(axis=1) // 2 % len(self.way)]

    def mitred(self, at: NDArray[np.int64] | None = None) -> Array:
        """The way with all its corners sharp, or those from some of its places to others (m, 2)."""
        at = self.at if at is None else at
        if not len(at):
            return self.way
        return _mitred(self.way, self.headings_rad, at, self.longest_mm)

    def likest(self, places_mm: Array, left: LeftAt, near_mm: float) -> Array:
        """The way with all its corners sharp but for those where one corner in place of several into which
        noise broke it, or a round one, leaves less of the ink at places (n, 2) mm so near.
        """
        groups = self._groups()
        each: list[list[NDArray[np.int64]]] = [
            groups,
            [self._as_one(group) for group in groups],
            [group[:0] for group in groups],
        ]
        tried = [left(closed_up(self.mitred(np.vstack([*at, self.at[:0]])))) for at in each]
        chosen = [self.at[:0]]
        for k, group in enumerate(groups):
            middle = self.way[(group[0, 0] + group[-1, 1]) // 2 % len(self.way)]
            about = np.hypot(*(places_mm - middle).T) < near_mm
            sums, best = [float(wrong[about].sum()) for wrong in tried], 0
            least = BETTER / math.sqrt(max(int(about.sum()), 1))
            for other in (1, 2):
                best = other if sums[other] < sums[best] - least else best
            chosen.append(each[best][k])
        return self.mitred(np.vstack(chosen))

    def _as_one(self, group: NDArray[np.int64]) -> NDArray[np.int64]:
        """Corners (m, 2) as one if any of them turns to the left, which none does; else as they are."""
        before, after = self.headings_rad[group].T
        turns = np.sin(after - before)
        return np.array([[group[0, 0], group[-1, 1]]]) if (turns > 0).any() else group

    def _groups(self) -> list[NDArray[np.int64]]:
        """The corners, from which place to which (m, 2), those that come up to the next one together."""
        apart = np.flatnonzero(self.at[1:, 0] > self.at[:-1, 1]) + 1
        return np.split(self.at, apart) if len(self.at) else []

    def over_to(self, others: Sequence[Array], near_mm: float) -> Array:
        """The way with one of some others (n, 2) mm in place of each of its corners, which runs the other way
        along the same ink, and comes so near before and behind that; as it is where none does.
        """
        ends = self.way[self.at]
        found = [Neighbours(other).nearest(ends.reshape(-1, 2)) for other in others]
        parts, begin = list[Array](), 0
        for k, (before, after) in enumerate(self.at.tolist()):
            off_mm = [away_mm[2 * k : 2 * k + 2].max() for away_mm, _ in found]
            if before < begin or min(off_mm, default=math.inf) > near_mm:
                continue
            best = int(np.argmin(off_mm))
            first, last = found[best][1][2 * k : 2 * k + 2].tolist()
            count = len(others[best])
            back = (first - np.arange((first - last) % count + 1)) % count
            parts += [self.way[begin : before + 1], others[best][back]]
            begin = after
        return np.vstack([*parts, self.way[begin:]])


def felt_rim(view: View, outline: Array) -> Rim | None:
    """The rim that the cells feel about an outline (n, 2) mm, counter-clockwise, not closed up; None for ink
    that is too small.
    """
    width_mm, step_mm = view.width_mm, view.step_mm
    places = _evenly(outline, step_mm)
    if len(places) < FEWEST:
        return None
    places = _averaged(places, max(1, round(SMOOTH * width_mm / step_mm)))
    half_mm = PARABOLA * width_mm
    about = 2 * int(half_mm / step_mm) + 2  # places that go round again
    for _ in range(TIMES):
        places = _evenly(places, step_mm)
        ahead = np.roll(places, -2, axis=0) - np.roll(places, 2, axis=0)
        headings = np.arctan2(ahead[:, 1], ahead[:, 0])
        off_mm = np.empty(len(places))
        _feel(view.cells, places, headings, REACH * width_mm, off_mm)
        is_felt = np.isfinite(off_mm)
        places = (places + off_mm[:, None] * left_of_headings(headings))[is_felt]
        if len(places) < FEWEST:
            return None
        felt = parabolas(_round_again(places, about), half_mm, step_mm)
        places, headings, bends = (each[about:-about] for each in felt)
    return Rim(places, headings, bends)


@njit(cache=True)
def _feel(cells, places, headings, reach_mm, out):  # type: ignore[no-untyped-def]
    """Fill `out` with how far to the left of each place (n, 2) the ink begins, mm; NaN where it does not."""
    speck_mm = min(SPECK_PX * cells.pitch_mm, SPECK_MM)
    for k in range(len(places)):
        c, s = -np.sin(headings[k]), np.cos(headings[k])
        x, y = places[k, 0] - reach_mm * c, places[k, 1] - reach_mm * s
        ray = Ray(x, y, c, s, 0.0)
        # an edge is told from a speck by what lies as far beyond it as a speck is long
        out[k] = crossing_mm(cells, ray, 0.0, 2.0 * reach_mm + speck_mm, speck_mm) - reach_mm


def _mitred(way: Array, headings: Array, corners: NDArray[np.int64], most_mm: float) -> Array:
    """A closed way (n, 2) with a sharp corner in place of its places from a first one to a last one, each
    (n, 2), no longer than that.
    """
    parts, at = list[Array](), 0
    for first, after in corners.tolist():
        before = max(first, at)  # where two corners are near they share their leg
        into, out_of = direction(headings[before]), direction(headings[after])
        if before >= after or abs(cross(into, out_of)) < NEARLY_PARALLEL:
            continue
        corner = meeting(way[before], into, way[after], out_of)
        if 0 < (corner - way[before]) @ into < most_mm and (way[after] - corner) @ out_of > 0:
            parts += [way[at : before + 1], corner[None]]
            at = after
    return np.vstack([*parts, way[at:]])


def _evenly(places: Array, step_mm: float) -> Array:
    """Places of a closed way a step apart, (n, 2) mm."""
    closed = np.vstack([places, places[:1]])
    round_mm = length_mm(closed)
    return at_lengths(closed, np.linspace(0.0, round_mm, 1 + round(round_mm / step_mm))[:-1])


def _farthest(chosen: NDArray[np.bool_]) -> int:
    """The place of a closed way (n,) that is farthest from all chosen ones."""
    at = np.flatnonzero(chosen)
    gaps = np.diff(at, append=at[0] + len(chosen))
    widest = int(np.argmax(gaps))
    return int(at[widest] + gaps[widest] // 2) % len(chosen)


def _averaged(places: Array, half: int) -> Array:
    """Places of a closed way, each in the middle of so many to either side, (n, 2) mm."""
    weights = np.full(2 * half + 1, 1 / (2 * half + 1))
    about = _round_again(places, half)
    return np.column_stack([np.convolve(column, weights, "valid") for column in about.T])


def _round_again(places: Array, count: int) -> Array:
    """Places of a closed way, with so many of its last ones before and of its first ones after, (m, 2) mm."""
    at = np.arange(-count, len(places) + count)
    return np.ascontiguousarray(np.take(places, at, axis=0, mode="wrap"))
