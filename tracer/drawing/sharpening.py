"""Vertices: corners of an edge that the scanner's lens has rounded, brought back to where their legs meet.

Signals: an outline (n, 2) in pixels where a picture has half of its contrast, and the softness of the edge
(standard deviation, pixels) in; out the outline with its sharp corners. A lens as soft as s puts the outline
of a sharp corner whose legs are an angle a apart a way w · s inside the vertex, where

    ∫ φ(x - w) · erf(x · tan(a/2) / √2) dx  (x > 0) = 1/2          right angle 0.77    36 degrees 2.5

and leaves the legs where they are from 3 s / sin(a) on. There they are felt, as parabolas where they are
bent. A corner whose outline is further inside than that by more than noise does it is a round one: its radius
is that with which the same integral, over the width of a rounded corner, is a half. A corner that does not
fit its outline beside the vertex stays as it is: the lens does not explain it.

Source: the half-plane and the wedge seen through a normal distribution; our own. Questions: a round that
moves the outline by less than noise does (`FURTHER`, `NOISE`) is taken for a sharp corner: at a right angle
one of 0.12 mm at 300 dpi, which is 0.05 mm out.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import uniform_filter1d
from scipy.spatial import cKDTree

from morfax.motion.arrays import Array
from morfax.motion.polyline import lengths_mm as lengths_px
from morfax.motion.polyline import with_places

APART_PX = 0.25  # between the places of an outline
CLEAR = 3.0  # standard deviations: a leg is where it is when the other is as far away as this
LEG = 20.0  # standard deviations: length of a leg that is felt, at most
SHORTEST_LEG = 2.5
LEAST_TURN = math.radians(15)
NARROWEST = math.radians(12)  # between the legs
CLEAR_OF_ROUND = 2.0  # standard deviations from where the round touches the leg
# standard deviations: noise, beside the vertex; the lens moves an outline there by no more than at it
ASIDE = 0.25
TRIES = 5  # each with the legs felt where the angle and the round of the one before leave them clear
BENT = 0.7  # of what is left by a straight leg: a parabola has to leave less than this share
FURTHER, NOISE = (
    0.18,
    0.05,
)  # of the way, and standard deviations: by noise the outline of a sharp corner is further inside (98 %)
SHORT, LEGS = 0.1, 0.35  # and by the legs' bend less far


@dataclass(frozen=True, slots=True)
class Edge:
    """A closed outline (n, 2), its last place its first, and which of its places are the middles of corners
    that were put back.
    """

    outline: Array
    corners: NDArray[np.int64]


def sharpened(outline: Array, softness_px: float) -> Edge:
    """A closed outline (its last place its first) with its sharp corners put back, pixels."""
    places = _evenly(outline)
    turns = _corners(places, softness_px)
    parts, middles, come = list[Array](), list[int](), 0
    for first, last, corner in [
        found for k in range(len(turns)) if (found := _corner(places, turns, k, softness_px))
    ]:
        if last > first >= come:
            parts += [places[come : first + 1], corner]
            middles.append(sum(map(len, parts)) - len(corner) + len(corner) // 2)
            come = last
    return Edge(np.vstack([*parts, places[come:], places[:1]]), np.array(middles, int))


def _evenly(outline: Array) -> Array:
    """Places at equal distances, the first not once more at the end, begun furthest from where the outline
    turns.
    """
    s = lengths_px(outline)
    at = np.linspace(0, s[-1], max(8, round(s[-1] / APART_PX)), endpoint=False)
    places = np.column_stack([np.interp(at, s, column) for column in outline.T])
    reach = min(len(places) // 4, 40)
    return np.roll(places, -int(np.argmin(_turned(places, reach))), axis=0)


def _turned(places: Array, reach: int) -> Array:
    """By how much the outline turns within so many places of each, rad, without sign."""
    back, on = places - np.roll(places, reach, axis=0), np.roll(places, -reach, axis=0) - places
    return np.asarray(
        np.abs(
            np.arctan2(
                back[:, 0] * on[:, 1] - back[:, 1] * on[:, 0], np.einsum("ij,ij->i", back, on)
            )
        )
    )


def _corners(places: Array, softness_px: float) -> list[int]:
    """Places about which the outline turns most, in order."""
    reach = max(2, min(round(CLEAR * softness_px / APART_PX), len(places) // 4))
    turned = uniform_filter1d(_turned(places, reach), reach, mode="wrap")
    found = list[int]()
    for k in np.argsort(-turned):
        if turned[k] < LEAST_TURN:
            break
        if all(
            min(abs(k - other), len(places) - abs(k - other)) > 2 * reach for other in found
        ):
            found.append(int(k))
    return sorted(found)


def _corner(
    places: Array, corners: list[int], k: int, softness_px: float
) -> tuple[int, int, Array] | None:
    """What stands in the place of a corner, and the places between which; None if the corner is none, or the
    lens does not explain it.
    """
    at, dense = corners[k], softness_px / APART_PX
    before = at - corners[k - 1] if k else at + len(places) - corners[-1]
    after = (corners[k + 1] if k + 1 < len(corners) else corners[0] + len(places)) - at
    angle, radius, taken_off, found = math.pi / 2, 0.0, 0.0, None
    for _ in range(TRIES):
        away = (
            max(
                CLEAR / max(math.sin(min(angle, math.pi / 2)), 0.2),
                _touch(angle, radius) + CLEAR_OF_ROUND,
            )
            * dense
        )
        spans = [
            min(away + LEG * dense, gap - CLEAR * dense, len(places) / 2)
            for gap in (before, after)
        ]
        if min(spans) - away < SHORTEST_LEG * dense:
            break
        legs = [
            _felt(places, at, sign * away, sign * span)
            for sign, span in zip((-1, 1), spans, strict=True)
        ]
        met = _met(*legs)
        if met is None:
            return None
        vertex, t, w = met
        angle = _between(t, w)
        if not NARROWEST < angle < math.pi - LEAST_TURN:
            return None
        first, last = max(0, round(at - away)), min(len(places) - 1, round(at + away))
        way = float(np.hypot(*(places[first : last + 1] - vertex).T).min()) / softness_px
        sharp = _way(round(angle, 3))
        radius = (
            _radius(round(angle, 3), round(way, 3))
            if way > (1 + FURTHER) * sharp + NOISE
            else 0.0
        )
        found = first, last, _rounded(vertex, (t, w), radius * softness_px)
        taken_off = way - radius * (1 / math.sin(angle / 2) - 1)
    if (
        found is None
        or _touch(angle, radius) * dense > away
        or way < (1 - SHORT) * sharp - LEGS
    ):
        return None
    first, last, corner = found
    if (corner[0] - places[first]) @ t < 0 or (corner[-1] - places[last]) @ w < 0:
        return None  # it would lie behind the ends of its legs
    return found if _off(places, *found) < (taken_off + ASIDE) * softness_px else None


def _off(places: Array, first: int, last: int, corner: Array) -> float:
    """How far the outline that a corner stands for is from it at most, pixels."""
    instead = with_places(np.vstack([places[first], corner, places[last]]), APART_PX)
    return float(cKDTree(instead).query(places[first : last + 1])[0].max())


def _touch(angle: float, radius: float) -> float:
    """From the vertex to where a round touches the legs."""
    return radius / math.tan(angle / 2)


def _rounded(vertex: Array, towards: tuple[Array, Array], radius_px: float) -> Array:
    """A corner with a round as places (n, 2), from the leg with the first direction towards it to the other;
    the vertex alone if there is none.
    """
    if radius_px < APART_PX:
        return vertex[None]
    t, w = towards
    angle, inward = _between(t, w), -(t + w) / np.hypot(*(t + w))
    turns = math.copysign(math.pi - angle, t[1] * w[0] - t[0] * w[1])
    outward = math.atan2(-inward[1], -inward[0]) + turns * np.linspace(
        -0.5, 0.5, 3 + math.ceil(abs(turns) * radius_px)
    )
    middle = vertex + inward * radius_px / math.sin(angle / 2)
    return np.asarray(middle + radius_px * np.column_stack([np.cos(outward), np.sin(outward)]))


def _between(t: Array, w: Array) -> float:
    """The angle between two directions, rad."""
    return math.acos(float(np.clip(t @ w, -1, 1)))


def _felt(places: Array, at: int, near: float, far: float) -> tuple[Array, Array, Array]:
    """A leg as a parabola seen from its near end: that place, the direction towards the corner, and the
    coefficients across it.
    """
    rows = np.arange(round(min(near, far)), round(max(near, far)) + 1) + at
    leg = places[rows % len(places)]
    origin = leg[-1] if near < 0 else leg[0]
    chord = origin - (leg[0] if near < 0 else leg[-1])
    along = chord / np.hypot(*chord)
    u, v = (leg - origin) @ along, (leg - origin) @ np.array([-along[1], along[0]])
    straight, bent = (np.polynomial.polynomial.polyfit(u, v, degree) for degree in (1, 2))
    off = [
        float(np.std(v - np.polynomial.polynomial.polyval(u, each)))
        for each in (straight, bent)
    ]
    return origin, along, bent if off[1] < BENT * off[0] else straight


def _met(
    a: tuple[Array, Array, Array], b: tuple[Array, Array, Array]
) -> tuple[Array, Array, Array] | None:
    """Where two legs meet, and their directions there, towards the corner."""
    place = 0.5 * (a[0] + b[0])
    for _ in range(6):
        (p, t), (q, w) = _at(a, place), _at(b, place)
        cross = t[0] * w[1] - t[1] * w[0]
        if abs(cross) < 0.1:
            return None
        gap = q - p
        place = p + t * (gap[0] * w[1] - gap[1] * w[0]) / cross
    reach = 4 * float(np.hypot(*(a[0] - b[0])))
    if (
        max(np.hypot(*(place - a[0])), np.hypot(*(place - b[0]))) > reach
        or (place - a[0]) @ a[1] < 0
        or (place - b[0]) @ b[1] < 0
    ):
        return None
    return place, t, w


def _at(leg: tuple[Array, Array, Array], place: Array) -> tuple[Array, Array]:
    """The leg beside a place, and its direction there."""
    origin, along, across = leg
    u = float((place - origin) @ along)
    left = np.array([-along[1], along[0]])
    powers = np.arange(len(across))
    slope = float(np.sum(powers[1:] * across[1:] * u ** powers[:-1]))
    direction = along + slope * left
    return origin + u * along + float(np.sum(across * u**powers)) * left, direction / np.hypot(
        *direction
    )


@lru_cache(maxsize=4096)
def _way(angle: float) -> float:
    """How far inside a sharp corner its outline is, in standard deviations of the lens."""
    from scipy.optimize import brentq

    return float(brentq(lambda way: _seen(angle, 0.0, way) - 0.5, 0, 30))


@lru_cache(maxsize=4096)
def _radius(angle: float, way: float) -> float:
    """Radius of the round with which the outline is so far inside the vertex, in standard deviations; 0 if a
    sharp corner's is.
    """
    from scipy.optimize import brentq

    if way <= _way(angle):
        return 0.0
    alone = way / (1 / math.sin(angle / 2) - 1)  # with a perfect lens
    return float(brentq(lambda radius: _seen(angle, radius, way) - 0.5, 0, alone, xtol=1e-3))


def _seen(angle: float, radius: float, way: float) -> float:
    """Share of the shape that a lens sees so far inside the vertex of a rounded corner, in standard
    deviations.
    """
    from scipy.special import erf

    half = angle / 2
    x = np.linspace(way - 5, way + 5, 1001)
    arc = np.sqrt(np.maximum(radius**2 - (x - radius / math.sin(half)) ** 2, 0))
    across = np.where(
        x < radius * math.cos(half) ** 2 / math.sin(half),
        np.where(x < radius / math.sin(half) - radius, 0, arc),
        np.maximum(x, 0) * math.tan(half),
    )
    return float(
        np.trapezoid(erf(across / math.sqrt(2)) * np.exp(-0.5 * (x - way) ** 2), x)
    ) / math.sqrt(2 * math.pi)
