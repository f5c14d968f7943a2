"""Joined ways: closed ways along one patch of ink, joined to one that goes round all of it.

    ───╮╭─────   ─────╮╭───    where the sides of a bay's mouth, or of a stalk's neck, run together, no rim
    ╭──╯╰──╮      ╭───╯╰───╮   goes all along the line: that towards the land passes the stalk by, that
    ╰──────╯      ╰────────╯   towards the sea the bay. Elsewhere both run along the same line

Where two ways part, and come together again, the stretch of either is taken that leaves less of the ink; a
way that meets another at one place only is put into it there.

Signals: closed ways (n, 2) mm, and the ink, in; one closed way, with stretches of them, out.

Source: our own (see `ink.rim`).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array, bounds
from morfax.motion.crossings import crossings_of
from morfax.motion.neighbours import Neighbours
from morfax.motion.plane import unit
from morfax.motion.polyline import closed_up, evenly, length_mm, nearest_mm
from morfax.tracer.drawing.components import INK
from morfax.tracer.effort import MANY
from morfax.tracer.limits import ABOUT_WIDTHS, CLEAR_WIDTHS
from morfax.tracer.program.laid.patch_ink import PatchInk
from morfax.tracer.program.laid.rim_bays import with_corners_for_loops
from morfax.tracer.sensing.view import STEP_WIDTHS

# In widths of the pen:
ASIDE = 0.2  # ways that are further apart part, ...
ON = 0.05  # ... from where they are so near to each other on, ...
WITHIN = 3.0  # ... if that is no further back
MEETS = 0.3  # a way that runs along no other meets it at a place so near
LESS = 0.05  # squared: a stretch leaves less of the ink; noise about it does not
TICK = 2.0  # from the middle of the line to the end of a tick, ...
LONGER = 1.0  # ... which makes the way longer by more than this
BARE = 1.0  # squared: of ink that its own stretch explained; what is left at a neck's corners is less
SAME_WAY = 0.5  # cosine between their headings, where two run along each other
# of the places nearest to another, how many are looked through for one of its direction: the sides of a neck
# lie at least a tenth of a width apart
LOOKED_AT = 6
LOOP = 4.0  # a longer loop at a crossing is none of a narrow mouth
ALONG = 0.2  # of a way: one that runs along another for less meets it at a place


class Excursion(NamedTuple):
    """What goes in place of a closed way's own places: from one of them on, so many more, (n, 2) mm."""

    first: int
    more: int
    places: Array

    def own(self, count: int) -> NDArray[np.int64]:
        """The places of a way of so many in place of which it goes."""
        return np.arange(self.first, self.first + self.more + 1) % count

    def is_tick(self, way: Array, width_mm: float) -> bool:
        """Whether it goes out from a way no further than a tick is long, and back."""
        own = way[self.own(len(way))]
        longer_mm = length_mm(self.places) - length_mm(own)
        is_short = nearest_mm(self.places, own).max() < TICK * width_mm
        return longer_mm > LONGER * width_mm and bool(is_short)


def joined(ways: Sequence[Array], lines: Sequence[Array], ink: PatchInk) -> Array:
    """The first of some closed lines that were found, or else of closed ways within rims, with those
    stretches of all others that leave less of the ink; out along a tick only where a line goes there.
    """
    width_mm = ink.seen.width_mm
    each = [evenly(closed_up(way), STEP_WIDTHS * width_mm)[:-1] for way in [*lines, *ways]]
    best = each[0]
    for _ in range(MANY):
        before = best
        for n, other in enumerate(each):
            stretches = _stretches(best, other, width_mm)
            if n >= len(lines):
                stretches = [one for one in stretches if not one.is_tick(best, width_mm)]
            less = [one for one in stretches if _gain(best, one, ink) > LESS]
            best = _put(best, less) if less else best
        if best is before:
            break
    return best


def uncrossed(way: Array, width_mm: float) -> Array:
    """A closed way (n, 2) mm that crosses itself no more: with a corner in place of short loops, as the rims
    of a narrow mouth make them; and back along the others, which turns a crossing into a touch.
    """
    at = np.sort(crossings_of(closed_up(way), np.arange(len(way))).ravel())
    if not len(at):
        return way
    # 1. begun far from any crossing
    gaps = np.diff(at, append=at[0] + len(way))
    first = int(at[np.argmax(gaps)] + 0.5 * gaps.max()) % len(way)
    begun = closed_up(np.roll(way, -first, axis=0))
    # 2. short loops, then the others
    way = with_corners_for_loops(begun, LOOP * width_mm)
    for _ in range(MANY):
        if not len(at := crossings_of(way, np.arange(len(way) - 1))):
            break
        first, last = sorted(at[0].astype(int).tolist())
        way = np.vstack([way[: first + 1], way[last:first:-1], way[last + 1 :]])
    return way[:-1]


def crossings_mm(way: Array) -> Array:
    """Where a closed way crosses itself, (n, 2) mm: the place before that."""
    at = crossings_of(closed_up(way), np.arange(len(way)))
    return np.asarray(way[at[:, 0].astype(np.int64)])


def _stretches(way: Array, other: Array, width_mm: float) -> list[Excursion]:
    """The stretches of another closed way that may go in place of a way's own."""
    for along in (other, other[::-1]):
        at, away_mm = _on(way, along)
        is_on = away_mm < ASIDE * width_mm
        if is_on.all():
            return []
        if np.mean(is_on) > ALONG:
            return list(_parted(len(way), along, at, away_mm / width_mm))
    return _round_it(way, other, width_mm)


def _on(way: Array, other: Array) -> tuple[NDArray[np.int64], Array]:
    """For each place of another closed way (m, 2) the nearest of a way's that goes in its direction, and how
    far that is, mm; infinitely far where none does.
    """
    near = Neighbours(way).several(other, min(LOOKED_AT, len(way)))
    along = np.einsum("mkj,mj->mk", _headings(way)[near], _headings(other)) > SAME_WAY
    away_mm = np.hypot(*(way[near] - other[:, None]).transpose(2, 0, 1))
    away_mm = np.where(along, away_mm, np.inf)
    best, each = np.argmin(away_mm, axis=1), np.arange(len(other))
    return near[each, best], away_mm[each, best]


def _headings(way: Array) -> Array:
    """The directions (n, 2) in which a closed way goes at its places."""
    return unit(np.roll(way, -1, axis=0) - np.roll(way, 1, axis=0))


def _parted(
    count: int, other: Array, at: NDArray[np.int64], widths: Array
) -> Iterator[Excursion]:
    """The stretches of another closed way between places at which it parts from a way of so many places, and
    comes to it again; of each of its places that of the way that is nearest, and by how many widths.
    """
    # 1. begun where both run along each other
    begin = int(np.argmin(widths))
    other = np.roll(other, -begin, axis=0)
    at, widths = np.roll(at, -begin), np.roll(widths, -begin)
    changes = np.flatnonzero(np.diff((widths < ASIDE).astype(np.int8), append=1))
    # 2. where both part, and where they come together
    for before, behind in changes.reshape(-1, 2).tolist():
        first, last = _met(widths, before, -1), _met(widths, behind + 1, 1)
        more = int(at[last % len(at)] - at[first % len(at)]) % count
        if more < count // 2:
            places = other[np.arange(first, last + 1) % len(other)]
            yield Excursion(int(at[first % len(at)]), more, places)


def _met(widths: Array, place: int, step: int) -> int:
    """The first place, from one on in steps, at which two ways are near to each other; that one else."""
    for k in range(round(WITHIN / STEP_WIDTHS)):
        if widths[(place + step * k) % len(widths)] < ON:
            return place + step * k
    return place


def _round_it(way: Array, other: Array, width_mm: float) -> list[Excursion]:
    """All of another closed way from the place at which both meet to there again, in the direction in which
    the way crosses itself less; none if they meet nowhere.
    """
    away_mm, at = Neighbours(way).nearest(other)
    first = int(np.argmin(away_mm))
    if away_mm[first] > MEETS * width_mm:
        return []
    begun = closed_up(np.roll(other, -first, axis=0))
    own = int(at[first])
    both = [Excursion(own, 0, np.vstack([way[own], each])) for each in (begun, begun[::-1])]
    return [min(both, key=lambda one: len(crossings_mm(_put(way, [one]))))]


def _gain(way: Array, stretch: Excursion, ink: PatchInk) -> float:
    """How much less of the ink a closed way leaves with a stretch in place of its own; none if it leaves bare
    what its own explained, as that of a line beside it.
    """
    width_mm, own = ink.seen.width_mm, stretch.own(len(way))
    low, high = bounds(np.vstack([way[own], stretch.places]))
    # what is further off leaves no ink there
    near = np.flatnonzero(_are_within(way, low, high, ABOUT_WIDTHS * width_mm))
    rest = way[np.setdiff1d(near, own)]
    at = np.flatnonzero(_are_within(ink.places_mm, low, high, CLEAR_WIDTHS * width_mm))
    before, behind = (
        ink.left_by(np.vstack([rest, part]), at) for part in (way[own], stretch.places)
    )
    newly_left = np.maximum(behind - before, 0.0)[ink.seen.darkness[at] > INK].sum()
    return 0.0 if newly_left > BARE else float((before - behind).sum())


def _are_within(places: Array, low: Array, high: Array, around_mm: float) -> NDArray[np.bool_]:
    """Which places (n, 2) mm lie in a box, or so near to it."""
    return np.all((places > low - around_mm) & (places < high + around_mm), axis=1)


def _put(way: Array, stretches: list[Excursion]) -> Array:
    """A closed way with some stretches in place of its own; of those that overlap the longest."""
    count, taken, kept = len(way), np.zeros(len(way), bool), list[Excursion]()
    for stretch in sorted(stretches, key=lambda each: -len(each.places)):
        if not taken[own := stretch.own(count)].any():
            taken[own] = True
            kept.append(stretch)
    kept.sort(key=lambda each: each.first)
    parts = list[Array]()
    for stretch, behind in zip(kept, [*kept[1:], kept[0]], strict=True):
        last = stretch.first + stretch.more + 1
        parts += [
            stretch.places,
            way[np.arange(last, last + (behind.first - last) % count) % count],
        ]
    return np.vstack(parts)
