"""Shared ink: the way of a line through a junction is kept within the ink that it shares with others there.

Signals: a way (n, 2) mm, what was felt along the stretches within the junction, and the line's width in; the
way, moved aside where half the line's width would lie on paper, out.

    ════════════════      two lines run together for a while: the rims say where their ink is, W wide; a line
      ╲__________╱        of width w has its middle no further from the ink's middle than

        limit = (W - w) / 2, and a little more

Where two ways lie in the same ink, one has the one rim and the other the other. The move is averaged along
the way over two widths, and fades towards its ends, where the line is known.

Source: our own.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import NOT_ZERO, Array
from morfax.motion.neighbours import Neighbours, those_near
from morfax.motion.plane import CORNER_RAD, left_of, left_of_headings, unit
from morfax.motion.polyline import at_lengths, lengths_mm
from morfax.tracer.effort import EVERY_MM, ROUNDS
from morfax.tracer.ink.beside import LONG
from morfax.tracer.ink.run import Run
from morfax.tracer.sensing.parabola import FEWEST

NO_STATIONS = np.empty((0, 4))

# All limits below were chosen by trial on drawings of nets.
BESIDE = 0.75  # of the ink's width: a way further from its middle is not in it
ABREAST = 0.25  # widths: a station further before or behind a place tells nothing of it
APART = 1.3  # widths: ink as broad, and `LONG`, is that of two lines beside each other
AVERAGED, FADES = 2.0, 1.0  # widths of the line
SLACK = 0.12  # of the line's width: where two lines cross, the rims of their ink are felt so much too near
# widths: nearer to the middle of its ink a line crosses another, and its rim is none
NOTCH = 0.1
EXACT_MM = 0.03  # a rim, felt every `EVERY_MM`: neighbours err alike
# deviations: of the heading of a leg at its end, rad; 16 times of how far a way bulges
TURNED, HUMP_MM = 0.01, 1.0
FITS = 0.8  # of the places are as near to their rims as these are exact


@dataclass(frozen=True)
class SharedInk:
    """What was felt along the stretches within a junction, and about how lines go through it, (n, 2) mm; of
    each way, where it turns, (m, 2) mm, if the ink has told that.
    """

    runs: Sequence[Run] = ()
    ways: Sequence[Array] = ()
    vertices: Sequence[Array | None] = ()

    @cached_property
    def stations(self) -> Array:
        """The stations whose width is known: X, Y, heading, width; (n, 4)."""
        felt = [
            np.column_stack([run.places_mm, run.headings_rad, run.widths_mm])
            for run in self.runs
        ]
        every = np.vstack([NO_STATIONS, *felt])
        return np.asarray(every[np.isfinite(every[:, 3])])

    @cached_property
    def nearest(self) -> Neighbours:
        """Finds the stations nearest to places."""
        return Neighbours(self.stations[:, :2])

    @cached_property
    def _ends(self) -> Array:
        """The first and the last place of each way, (n, 2, 2) mm."""
        return np.array([way[[0, -1]] for way in self.ways]).reshape(-1, 2, 2)

    def besides(self, way: Array) -> list[Array]:
        """The ways of the other lines: those that begin and end elsewhere. Where a closed line is cut open
        its leg is felt anew, and may end 0.05 um off.
        """
        others = np.flatnonzero(np.minimum(*self._off_ends_mm(way)) > EVERY_MM)
        return [self.ways[k] for k in others.tolist()]

    def turns_at(self, ends: Array) -> Array | None:
        """Where the way between two ends (2, 2) mm turns, (m, 2) mm; None if the ink has not told that."""
        there, back = self._off_ends_mm(ends)
        for vertices, on_mm, round_mm in zip(self.vertices, there, back, strict=False):
            if vertices is not None and min(on_mm, round_mm) < EVERY_MM:
                return vertices if on_mm < round_mm else vertices[::-1]
        return None

    def _off_ends_mm(self, way: Array) -> tuple[Array, Array]:
        """How far the ends of each way are from those of another, and from those of that way back, mm."""
        there = np.abs(self._ends - way[[0, -1]]).max(axis=(1, 2))
        return there, np.abs(self._ends - way[[-1, 0]]).max(axis=(1, 2))


def kept_in_ink(
    way: Array, ink: SharedInk, width_mm: float, others: Sequence[Array] = ()
) -> Array:
    """A way through a junction, bent and moved to where a line of a width lies within the ink; (n, 2) mm.

    Where one of the `others` lies in the same ink each has its own rim.
    """
    come_mm = lengths_mm(way)
    if not len(ink.stations) or come_mm[-1] < FADES * width_mm:
        return way
    at_mm = np.linspace(0.0, come_mm[-1], 2 + math.ceil(come_mm[-1] / EVERY_MM))
    some = at_lengths(way, at_mm)
    # 1. bent smoothly along the rims
    bent = some + _bent(some, at_mm / at_mm[-1], _off(some, ink, width_mm, others))
    # 2. where it is out of the ink still, moved, smoothly and not at the ends
    off = _off(bent, ink, width_mm, others)
    far = np.sign(off.aside) * np.maximum(np.abs(off.aside) - SLACK * width_mm, 0.0)
    moves = _averaged(far[:, None] * off.normals, AVERAGED * width_mm / (at_mm[1] - at_mm[0]))
    fade = np.minimum(at_mm, at_mm[-1] - at_mm) / (FADES * width_mm)
    moves = bent - some + moves * np.clip(fade, 0.0, 1.0)[:, None]
    return np.asarray(way + np.column_stack([np.interp(come_mm, at_mm, m) for m in moves.T]))


def off_rims_mm(way: Array, ink: SharedInk, width_mm: float, others: Sequence[Array]) -> float:
    """How far a way (n, 2) mm is, in the mean, from where its own rims tell a line of a width to be, mm; 0
    where none tell.
    """
    come_mm = lengths_mm(way)
    if not len(ink.stations) or come_mm[-1] < max(FADES * width_mm, 2 * EVERY_MM):
        return 0.0
    some = at_lengths(way, np.arange(0.0, come_mm[-1], EVERY_MM))
    off = _off(some, ink, width_mm, others)
    return float(np.sum(np.abs(off.aside) * off.sure) / max(off.sure.sum(), 1.0))


def are_apart_where_they_cross(
    one: Array, other: Array, ink: SharedInk, width_mm: float
) -> bool:
    """Whether two ways cross in a long stretch of ink too broad for that all along: its lines only touch."""
    away, near = Neighbours(other).nearest(one)
    at = int(np.argmin(away))
    if away[at] > EVERY_MM:
        return False
    for run in ink.runs:
        known = np.isfinite(run.widths_mm)
        low_mm = run.widths_mm[known].min() if known.any() else 0.0
        if run.length_mm < LONG * width_mm or low_mm < APART * width_mm:
            continue
        far, station = Neighbours(run.places_mm).nearest(one[at : at + 1])
        normal = left_of_headings(run.headings_rad[station])
        if (
            far[0] < ABREAST * width_mm
            and _goes_along(one, np.array([at]), normal)[0]
            and _goes_along(other, near[at : at + 1], normal)[0]
        ):
            return True
    return False


class _Off(NamedTuple):
    """How far each of some places is from where its line lies, to the left of the ink, mm; that direction,
    (n, 2); and how sure that is, 0 to 1.
    """

    aside: Array
    normals: Array
    sure: Array


def _off(some: Array, ink: SharedInk, width_mm: float, others: Sequence[Array]) -> _Off:
    """How far places of a way are from where the line would lie; 0 in ink that goes another way."""
    stations, (away, near) = ink.stations, ink.nearest.nearest(some)
    middles, headings, widths = stations[near, :2], stations[near, 2], stations[near, 3]
    normals = left_of_headings(headings)
    is_its_own = _goes_along(some, np.arange(len(some)), normals) & (away < BESIDE * widths)
    aside = np.sum((some - middles) * normals, axis=1)
    # beyond the ends of what was felt no rim is known
    is_its_own &= np.sqrt(np.maximum(away**2 - aside**2, 0.0)) < ABREAST * width_mm
    limit = 0.5 * np.maximum(widths - width_mm, 0.0)
    within = wanted = np.clip(aside, -limit, limit)
    beside, is_crossed = np.zeros(len(some), int), np.zeros(len(some), bool)
    for other in those_near(others, middles, BESIDE * float(widths.max())):
        apart, nearest = Neighbours(other).nearest(middles)
        is_beside = apart < BESIDE * widths
        beside += is_beside
        # a line that only crosses makes the ink broad for a moment: the rims are neither's
        is_crossed |= is_beside & ~_goes_along(other, nearest, normals)
        further = np.sum((other[nearest] - middles) * normals, axis=1)
        wanted = np.where(is_beside, np.where(aside > further, limit, -limit), wanted)
    has_a_rim = (beside <= 1) & ~is_crossed
    off = np.where(has_a_rim, wanted, within) - aside
    is_sure = is_its_own & has_a_rim & (beside == 1) & (limit > NOTCH * width_mm)
    return _Off(np.where(is_its_own, off, 0.0), normals, is_sure.astype(float))


def _goes_along(way: Array, at: NDArray[np.int64], normals: Array) -> NDArray[np.bool_]:
    """Whether a way goes along the ink at some of its places, whose normals are given."""
    ways = np.gradient(way, axis=0)[at]
    across = np.abs(np.sum(ways * normals, axis=1)) / np.maximum(np.hypot(*ways.T), NOT_ZERO)
    return np.asarray(across < math.sin(CORNER_RAD))


def _bent(some: Array, share: Array, off: _Off) -> Array:
    """How far places of a way are to be moved so that it goes along its rim as a whole, (n, 2) mm.

    Least squares, to which the headings at its ends belong; a place that is far off counts less.
    """
    ways = np.gradient(some, axis=0)
    to_left = unit(left_of(ways))
    wanted = off.aside * np.sum(off.normals * to_left, axis=1)
    if off.sure.sum() < FEWEST:
        return np.zeros_like(some)
    u, long_mm = share, float(np.hypot(*np.diff(some, axis=0).T).sum())
    hump = u * u * (1 - u) * (1 - u)
    shapes = np.column_stack(
        [u * (1 - u) ** 2 * long_mm, u * u * (u - 1) * long_mm, hump, hump * (2 * u - 1)]
    )
    held = np.diag(1 / np.array([TURNED, TURNED, HUMP_MM, HUMP_MM]))
    weights = off.sure / EXACT_MM
    for _ in range(ROUNDS):
        rows = np.vstack([shapes * weights[:, None], held])
        shape = np.linalg.lstsq(rows, np.r_[wanted * weights, np.zeros(4)])[0]
        misfit = np.abs(wanted - shapes @ shape)
        weights = off.sure / EXACT_MM / np.sqrt(1 + (misfit / EXACT_MM) ** 2)
    if np.mean(misfit[off.sure > 0] < EXACT_MM) < FITS:  # the rims of more lines than two
        return np.zeros_like(some)
    return np.asarray((shapes @ shape)[:, None] * to_left)


def _averaged(moves: Array, places: float) -> Array:
    """Moves (n, 2) averaged over so many places, as many before as behind; they go on beyond the ends.

    As scipy's `uniform_filter1d` has it, to the bit: to load `scipy.ndimage` takes 22 MB.
    """
    size = max(1, round(places))
    held = np.pad(moves, ((size // 2, (size - 1) // 2), (0, 0)), mode="edge")
    first = np.cumsum(held[:size], axis=0)[-1]
    return np.asarray(np.cumsum(np.vstack([first, held[size:] - held[:-size]]), axis=0) / size)
