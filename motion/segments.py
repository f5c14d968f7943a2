"""Segments: a motion cut at its stops, and how fast each segment may be run.

Signals: a motion in mm at any rate, or a path, in; segments out: places at equal distances along the path
with the speed (mm/s) that the machine may have there, zero at both ends. A program whose medium bounds the
acceleration is made of segments, and not of the motion's own times:

    speed        __________________              ______
              __/  the motion's own \\____    ___/      \\
             /  or less, in a bend       \\__/           \\
            stop                       corner            stop

The segments part where the motion stands, and at corners: places where the direction turns by more than
`corner_rad` within `window_mm` to either side. Within a segment, with v the speed, t the tangent and k the
curvature, axis by axis:

    v |t| <= speed        v² |k| <= acceleration        |v dv/ds| <= acceleration

Source: patents ES 443122 (the motor's change of speed is limited, and so the smallest radius at a speed) and
US 3062995, column 2 (the curve may at no point be angular). Questions: neither says how its programmer slowed
down; here by the two passes that are usual in controls (see `speed_limits`). The times of the motion count
only as an upper bound of the speed, and as rests where it stands. Acceleration along the path and across it
have a share each (0.7, so that both together stay within the whole).
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import NOT_ZERO, Array
from morfax.motion.faults import MotionFault
from morfax.motion.motion import Motion, Path, thin
from morfax.motion.plane import SAME_MM
from morfax.motion.speed_limits import reachable

Source = Iterable[Motion] | Motion | Path

SHARE = 0.7  # of the acceleration, along the path and across it
STANDING_MM_S = 0.05  # slower is standing: 0.2 um of thinning in 4 ms
REST_S = 0.02  # a shorter stand is the turn of a corner, and no rest
FASTEST_MM_S = 1e6  # stands for no limit: its square is still a number


@dataclass(frozen=True, slots=True)
class Limits:
    """What an axis can do, and how finely a segment is looked at: distance of places, reach of corners."""

    speed_mm_s: float
    acceleration_mm_s2: float
    spacing_mm: float = 0.0025
    window_mm: float = 0.05
    corner_rad: float = 0.5


@dataclass(frozen=True, slots=True)
class Segment:
    """Places (m, 3) at equal distances, the speed allowed at each, and the rest before the segment, s."""

    places_mm: Array
    speed_mm_s: Array
    spacing_mm: float
    rest_s: float = 0.0

    @property
    def times_s(self) -> Array:
        """When each place is reached, s from the start of the segment."""
        mean_mm_s = (self.speed_mm_s[1:] + self.speed_mm_s[:-1]) / 2
        return np.r_[0.0, np.cumsum(self.spacing_mm / mean_mm_s)]

    @property
    def length_mm(self) -> float:
        """Length of the segment, mm."""
        return (len(self.places_mm) - 1) * self.spacing_mm


def segments(source: Source, limits: Limits) -> list[Segment]:
    """The segments of a motion, none of one that stands; raises MotionFault if it is empty or not finite."""
    path = as_path(source)
    points_mm, speeds_mm_s, rests_s = _moving(path)
    if len(points_mm) < 2:
        return []
    along_mm = np.r_[0.0, np.cumsum(np.sqrt((np.diff(points_mm, axis=0) ** 2).sum(axis=1)))]
    cuts = np.union1d(np.flatnonzero(rests_s > 0), corners(points_mm, limits))
    cuts = np.union1d(cuts, [0, len(points_mm) - 1]).astype(np.int64)
    found = []
    for a, b in pairwise(cuts.tolist()):
        part = slice(a, b + 1)
        found.append(
            _segment(
                points_mm[part], along_mm[part], speeds_mm_s[a:b], float(rests_s[a]), limits
            )
        )
    return found


def as_path(source: Source) -> Path:
    """A motion as a path of X, Y, Z; raises MotionFault if it is empty, or a place is no number."""
    try:
        path = (
            source
            if isinstance(source, Path)
            else thin([source] if isinstance(source, Motion) else source)
        )
    except ValueError:
        raise MotionFault(
            "the motion is empty; a program needs at least one position"
        ) from None
    bad = np.flatnonzero(~np.isfinite(path.positions_mm).all(axis=1))
    if len(bad):
        time_s = float(path.t_s[bad[0]])
        raise MotionFault(
            f"the position at {time_s:.3f} s is not a finite number; trace again", time_s=time_s
        )
    moving = [
        axis.upper()
        for axis, mm in zip(
            path.axes[3:], np.ptp(path.positions_mm[:, 3:], axis=0), strict=False
        )
        if mm
    ]
    if moving:
        raise MotionFault(
            f"the motion has {', '.join(moving)} beside X, Y, Z, which only a tape takes; give a .wav"
        )
    positions_mm = np.zeros((len(path.t_s), 3))
    columns = min(3, path.positions_mm.shape[1])
    positions_mm[:, :columns] = path.positions_mm[:, :columns]
    return Path(path.t_s, positions_mm)


def _moving(path: Path) -> tuple[Array, Array, Array]:
    """Different points, the speed from each to the next (infinite: no bound), and the rest at each, s."""
    length_mm = np.sqrt((np.diff(path.positions_mm, axis=0) ** 2).sum(axis=1))
    took_s = np.diff(path.t_s)
    stands = length_mm <= STANDING_MM_S * took_s
    keep = np.r_[True, length_mm > SAME_MM]
    group = np.cumsum(keep) - 1  # which kept point each point falls to
    rests_s = np.bincount(group[:-1], np.where(stands, took_s, 0.0), minlength=int(keep.sum()))
    moves = keep[1:]
    speeds = np.divide(
        length_mm, took_s, out=np.full(len(took_s), np.inf), where=~stands & (took_s > 0)
    )
    return path.positions_mm[keep], speeds[moves], np.where(rests_s >= REST_S, rests_s, 0.0)


def corners(points_mm: Array, limits: Limits) -> NDArray[np.int64]:
    """Points at which a path of different points turns sharply: the sharpest of each neighbourhood."""
    along_mm = np.r_[0.0, np.cumsum(np.sqrt((np.diff(points_mm, axis=0) ** 2).sum(axis=1)))]
    before = _at(points_mm, along_mm, along_mm - limits.window_mm)
    after = _at(points_mm, along_mm, along_mm + limits.window_mm)
    turn = _angle_rad(points_mm - before, after - points_mm)
    turn[(along_mm <= along_mm[0]) | (along_mm >= along_mm[-1])] = 0.0
    sharp = np.flatnonzero(turn > limits.corner_rad)
    if not len(sharp):
        return sharp
    groups = np.split(
        sharp, np.flatnonzero(np.diff(along_mm[sharp]) > 2 * limits.window_mm) + 1
    )
    return np.array([group[np.argmax(turn[group])] for group in groups])


def _segment(
    points_mm: Array, along_mm: Array, speeds_mm_s: Array, rest_s: float, limits: Limits
) -> Segment:
    """A segment: its places, and its speeds by one pass forwards and one back."""
    length_mm = along_mm[-1] - along_mm[0]
    pieces = max(2, int(np.ceil(length_mm / limits.spacing_mm)))
    at_mm = along_mm[0] + length_mm * np.arange(pieces + 1) / pieces
    places = _at(points_mm, along_mm, at_mm)
    own = speeds_mm_s[
        np.clip(np.searchsorted(along_mm, at_mm, "right") - 1, 0, len(speeds_mm_s) - 1)
    ]
    allowed = np.minimum(own, _allowed_mm_s(places, length_mm / pieces, limits))
    allowed = np.minimum(allowed, FASTEST_MM_S)
    allowed[[0, -1]] = 0.0
    gain = 2 * SHARE * limits.acceleration_mm_s2 * length_mm / pieces
    return Segment(places, reachable(allowed, gain), length_mm / pieces, rest_s)


def _allowed_mm_s(places: Array, spacing_mm: float, limits: Limits) -> Array:
    """The speed at which no axis is asked for more than it can do, at each place."""
    reach = max(1, min(round(limits.window_mm / spacing_mm), (len(places) - 1) // 2))
    around = np.pad(places, ((reach, reach), (0, 0)), "reflect", reflect_type="odd")
    before = around[: -2 * reach]
    after = around[2 * reach :]
    chord = np.abs(after - before).max(axis=1)
    way = np.maximum(np.sqrt(((after - before) ** 2).sum(axis=1)), NOT_ZERO)
    bend = np.abs(before - 2 * places + after).max(axis=1) / (reach * spacing_mm) ** 2
    by_axis = limits.speed_mm_s * way / np.maximum(chord, NOT_ZERO)
    return np.minimum(
        by_axis, np.sqrt(SHARE * limits.acceleration_mm_s2 / np.maximum(bend, NOT_ZERO))
    )


def _at(points_mm: Array, along_mm: Array, at_mm: Array) -> Array:
    """Places so far along the path."""
    return np.column_stack([np.interp(at_mm, along_mm, column) for column in points_mm.T])


def _angle_rad(a: Array, b: Array) -> Array:
    """Angle between two directions, row by row."""
    lengths = np.sqrt((a**2).sum(axis=1) * (b**2).sum(axis=1))
    cosine = np.einsum("ij,ij->i", a, b) / np.maximum(lengths, NOT_ZERO)
    return np.arccos(np.clip(cosine, -1.0, 1.0))
