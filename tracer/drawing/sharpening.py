"""Vertices: corners of an edge that the scanner's lens has rounded, brought back to where their legs meet.

Signals: an outline (n, 2) in pixels where a picture has half of its contrast, and the softness of the edge
(standard deviation, pixels) in; out the outline with its sharp corners.

The lens leaves the legs of a corner where they are from 3 s / sin(a) on, for a softness s and an angle a
between the legs. There they are felt (see `edge_leg`). How far inside the vertex the outline is, gives the
corner's round (see `lens`). A corner that does not fit its outline beside the vertex stays as it is: the lens
does not explain it.

Source: our own. Questions: a round that moves the outline by less than noise does (`FURTHER`, `NOISE`) is
taken for a sharp corner: at a right angle a round of 0.12 mm at 300 dpi, which moves it by 0.05 mm.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.plane import unit
from morfax.motion.polyline import lengths_mm as lengths_px
from morfax.motion.polyline import with_places
from morfax.tracer.drawing.edge_leg import EdgeLeg
from morfax.tracer.drawing.lens import radius_of, way_inside
from morfax.tracer.effort import FINE_PX
from morfax.tracer.limits import FADES

LEG = 20.0  # standard deviations: length of a leg that is felt, at most
SHORTEST_LEG = 2.5
LEAST_TURN = math.radians(15)
NARROWEST = math.radians(12)  # between the legs
CLEAR_OF_ROUND = 2.0  # standard deviations from where the round touches the leg
# standard deviations: noise, beside the vertex; the lens moves an outline there by no more than at it
ASIDE = 0.25
TRIES = 5  # each with the legs felt where the angle and the round of the one before leave them clear
# of the way, and standard deviations: by noise the outline of a sharp corner is further inside (98 %)
FURTHER, NOISE = 0.18, 0.05
SHORT, LEGS = 0.1, 0.35  # and by the legs' bend less far


@dataclass(frozen=True, slots=True)
class Edge:
    """A closed outline (n, 2), its last place its first, and which places are corners that were put back."""

    outline: Array
    corners: NDArray[np.int64]


def sharpened(outline: Array, softness_px: float) -> Edge:
    """A closed outline (its last place its first) with its sharp corners put back, pixels."""
    places = _evenly(outline)
    parts, middles, come = list[Array](), list[int](), 0
    for corner in corners_of(places, softness_px):
        parts += [places[come : corner.first + 1], corner.places]
        middles.append(sum(map(len, parts)) - len(corner.places) + len(corner.places) // 2)
        come = corner.last
    return Edge(np.vstack([*parts, places[come:], places[:1]]), np.array(middles, int))


def corners_of(
    places: Array, softness_px: float, *, is_closed: bool = True, step_px: float = 0.0
) -> list[PutBack]:
    """The corners that the lens has rounded on an outline, or a piece of one, a place every `FINE_PX`.

    An outline that was felt step by step may go on beyond a tip by a step.
    """
    turns = _corners(places, softness_px, is_closed)
    corners, come = list[PutBack](), 0
    for k in range(len(turns)):
        room = _room(places, turns, k, softness_px, is_closed)
        found = _corner(places, room, softness_px, step_px / softness_px)
        if found is not None and found.last > found.first >= come:
            corners.append(found)
            come = found.last
    return corners


def _evenly(outline: Array) -> Array:
    """Places at equal distances, the first not repeated, begun where the outline turns least."""
    s = lengths_px(outline)
    at = np.linspace(0, s[-1], max(8, round(s[-1] / FINE_PX)), endpoint=False)
    places = np.column_stack([np.interp(at, s, column) for column in outline.T])
    reach = min(len(places) // 4, 40)
    return np.roll(places, -int(np.argmin(turned_at(places, reach))), axis=0)


def turned_at(places: Array, reach: int) -> Array:
    """By how much the outline turns within so many places of each, rad, without sign."""
    back, on = places - np.roll(places, reach, axis=0), np.roll(places, -reach, axis=0) - places
    cross = back[:, 0] * on[:, 1] - back[:, 1] * on[:, 0]
    return np.asarray(np.abs(np.arctan2(cross, np.einsum("ij,ij->i", back, on))))


def _corners(places: Array, softness_px: float, is_closed: bool) -> list[int]:
    """Places about which the outline turns most, in order."""
    from scipy.ndimage import uniform_filter1d

    reach = max(2, min(round(FADES * softness_px / FINE_PX), len(places) // 4))
    turned = uniform_filter1d(turned_at(places, reach), reach, mode="wrap")
    if not is_closed:  # about the ends it turns from one to the other
        turned[: 2 * reach] = turned[-2 * reach :] = 0.0
    return sorted(most_turned(turned, LEAST_TURN, 2 * reach))


def most_turned(turned: Array, least: float, apart: int) -> list[int]:
    """Numbers of the places about which a closed outline turns most, rad, further than so many apart."""
    found, is_near = list[int](), np.zeros(len(turned), bool)
    about = np.arange(-apart, apart + 1)
    for k in np.argsort(-turned):
        if turned[k] < least:
            break
        if not is_near[k]:
            found.append(int(k))
            is_near[(k + about) % len(turned)] = True
    return found


class PutBack(NamedTuple):
    """A corner as places (n, 2) that stand in an outline instead of those from the first to the last number.

    One place is a sharp corner. Unit vectors tell the way into it and out of it.
    """

    first: int
    last: int
    places: Array
    into: Array
    out: Array


class _Room(NamedTuple):
    """Where an outline turns, and how many of its places the legs before and after that may have."""

    at: int
    before: float
    after: float


def _room(places: Array, turns: list[int], k: int, blur_px: float, is_closed: bool) -> _Room:
    """The room for the legs of a corner: up to its neighbours, or to the ends of a piece of an outline."""
    at, count = turns[k], len(places)
    before = (at - turns[k - 1] - 1) % count + 1.0
    after = (turns[(k + 1) % len(turns)] - at - 1) % count + 1.0
    clear = FADES * blur_px / FINE_PX
    if not is_closed:
        before = at + clear if k == 0 else before
        after = count - 1 - at + clear if k == len(turns) - 1 else after
    return _Room(at, before - clear, after - clear)


class _Fit(NamedTuple):
    """A corner as the lens explains it: vertex, directions of the legs towards it, angle between them (rad).

    How far inside the vertex the outline is, and that of a sharp corner would be, and the radius of its
    round; all three in standard deviations of the lens.
    """

    vertex: Array
    t: Array
    w: Array
    angle: float
    way: float
    sharp: float
    radius: float

    @property
    def touch(self) -> float:
        """From the vertex to where the round touches the legs."""
        return _touch(self.angle, self.radius)

    @property
    def taken_off(self) -> float:
        """What the lens has taken off the corner's own outline."""
        return self.way - self.radius * (1 / math.sin(self.angle / 2) - 1)

    def is_explained(self, away: float, step: float) -> bool:
        """Whether the lens explains it, with legs that are felt from so far away on, and by such steps."""
        beyond = step * max(
            0.0, math.cos(self.angle)
        )  # along a tip, not along the leg of a right angle
        return self.touch <= away and self.way >= (1 - SHORT) * self.sharp - LEGS - beyond


def _corner(
    places: Array, room: _Room, softness_px: float, step: float = 0.0
) -> PutBack | None:
    """What stands in the place of a corner; None if it is no corner, or if the lens does not explain it.

    The outline was felt by steps of so many standard deviations.
    """
    at, dense = room.at, softness_px / FINE_PX
    # 1. feel the legs, from further away where the corner that they make is narrow or round
    fit, angle, touch, felt = None, math.pi / 2, 0.0, None
    for _ in range(TRIES):
        clear = FADES / max(math.sin(min(angle, math.pi / 2)), 0.2)
        away = max(clear, touch + CLEAR_OF_ROUND) * dense
        ends = [
            min(away + LEG * dense, left, len(places) / 2) for left in (room.before, room.after)
        ]
        if min(ends) - away < SHORTEST_LEG * dense:
            break
        before, after = (round(-away), round(-ends[0])), (round(away), round(ends[1]))
        if (before, after) == felt:  # the legs of the try before, and so of all to come
            break
        felt = before, after
        legs = EdgeLeg.felt(places, at, *before), EdgeLeg.felt(places, at, *after)
        first, last = max(0, round(at - away)), min(len(places) - 1, round(at + away))
        fit = _fit(places[first : last + 1], legs, softness_px)
        # legs that do not meet stand on the round of a narrow tip
        angle, touch = (fit.angle, fit.touch) if fit is not None else (0.0, 0.0)
    # 2. put the corner back if the lens explains the outline
    if fit is None or not fit.is_explained(away / dense, step):
        return None
    corner = _rounded(fit, softness_px)
    if (corner[0] - places[first]) @ fit.t < 0 or (corner[-1] - places[last]) @ fit.w < 0:
        return None  # it would lie behind the ends of its legs
    found = PutBack(first, last, corner, fit.t, -fit.w)
    return found if _off(places, found) < (fit.taken_off + ASIDE) * softness_px else None


def _fit(outline: Array, legs: tuple[EdgeLeg, EdgeLeg], softness_px: float) -> _Fit | None:
    """The corner that two legs make beside a piece of outline; None if they make none."""
    met = legs[0].met(legs[1])
    if met is None:
        return None
    vertex, t, w = met
    angle = _between(t, w)
    if not NARROWEST < angle < math.pi - LEAST_TURN:
        return None
    way = float(np.hypot(*(outline - vertex).T).min()) / softness_px
    sharp, radius = way_inside(round(angle, 3)), 0.0
    if way > (1 + FURTHER) * sharp + NOISE:
        radius = radius_of(round(angle, 3), round(way, 3))
    return _Fit(vertex, t, w, angle, way, sharp, radius)


def _off(places: Array, found: PutBack) -> float:
    """How far the outline that a corner stands for is from the corner at most, pixels."""
    from scipy.spatial import cKDTree

    first, last, corner = found.first, found.last, found.places
    instead = with_places(np.vstack([places[first], corner, places[last]]), FINE_PX)
    return float(cKDTree(instead).query(places[first : last + 1])[0].max())


def _touch(angle: float, radius: float) -> float:
    """From the vertex to where a round touches the legs."""
    return radius / math.tan(angle / 2)


def _rounded(fit: _Fit, softness_px: float) -> Array:
    """A corner with its round as places (n, 2), from leg to leg; the vertex alone without a round."""
    radius_px = fit.radius * softness_px
    if radius_px < FINE_PX:
        return fit.vertex[None]
    t, w = fit.t, fit.w
    between = t + w
    inward = -unit(between)
    turns = math.copysign(math.pi - fit.angle, t[1] * w[0] - t[0] * w[1])
    shares = np.linspace(-0.5, 0.5, 3 + math.ceil(abs(turns) * radius_px))
    outward = math.atan2(-inward[1], -inward[0]) + turns * shares
    middle = fit.vertex + inward * radius_px / math.sin(fit.angle / 2)
    return np.asarray(middle + radius_px * np.column_stack([np.cos(outward), np.sin(outward)]))


def _between(t: Array, w: Array) -> float:
    """The angle between two directions, rad."""
    return math.acos(float(np.clip(t @ w, -1, 1)))
