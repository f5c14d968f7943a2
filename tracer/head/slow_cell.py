"""The slow cell: along a stretch that was felt, the cell goes on by itself where it had stopped.

    cell      slow, with a short lead and a narrow window: its places alone are on the drum and steer
    stations  the way that was felt, (n, 2) mm: the cell has to keep to it, and that is all

Signals: the head's state and tuning, and the way that was felt (sheet mm), in; where the cell would go, at
the motion rate, out. If it leaves the way, the head has not moved, and stations lead instead (see `leaders`).

In a tight bend a long lead swings the cell across a line that has turned away from it, and a wide window cuts
the bend. A head that goes slowly needs neither: more sweeps fall on each mm. But a parabola over few pixels
bends by what the pixels do to the line's edges, by h^-2.5 for half a window of h. Where that stops the cell,
it tries once more, with the widest window over which the way that was felt hardly bends.

Source: our own. Optical tracers slow down at tight bends, and so does the patent's relay RL.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.compiled import njit
from morfax.motion.contour import distances_mm
from morfax.motion.median import median
from morfax.motion.polyline import at_lengths, length_mm, lengths_mm
from morfax.tracer.head import kernel, mount
from morfax.tracer.head.settings import LEAD_SWEEPS, TIGHTEST_RAD
from morfax.tracer.head.state import HOME, MORE, Home, Tuning, put_on_drum
from morfax.tracer.sensing.leg import turn
from morfax.tracer.sensing.parabola import ROBUST
from morfax.tracer.sensing.photocell import Cells
from morfax.tracer.sensing.view import View

# Chosen by trial on the test drawings.
# so far beside what was felt the cell has kept to the way: the largest of these, ...
KEEPS_WIDTHS, KEEPS_PX = 0.02, 0.2
# ... but a line of few pixels, whose pixels were parted, may be seen so far off: the smaller of these
KEEPS_FINE_WIDTHS, KEEPS_FINE_MM = 0.12, 0.017
KEEPS_ROUGH = 3.0  # standard deviations of a rough line's middle, as its width shows them
CHECKED = 8  # one position in 8 is held against the way: every 4 um at 3 mm/s
LEAST_MM = 0.3  # for less the cell does not go on, ...
# ... nor along a shorter stretch: a corner follows, and stations lead up to that
SHORTEST_MM = 0.75
FELT_EVERY_MM = 0.04  # as fast sweeps lie on the drum, at 10 mm/s
# of the narrowest half window of a fast cell: in an arc, and where the bend changes
WINDOW_STEADY, WINDOW = 1.3, 0.75
STEADY = 0.2  # of the bend: an arc's changes by less from one half of a stretch to the other
WINDOWS = 5  # that are tried, from the fast cell's half window to the narrowest
CHORDS = 4  # places of a way to half a window, between which its headings are taken
BENT_WIDTHS = 0.7  # by more than this over its width the line may not bend: the cell, which cuts it aslant,
# would see its middle w²/8·l²·k³ further inside: 8 um at a lead l of 0.36 mm and a radius of 0.9 mm


class Tried(NamedTuple):
    """Where the cell went along a way: positions (n, 2) mm, the head's state there, why it stopped.

    `felt_mm`: for so far stations led, with whose places the drum was filled.
    """

    positions: Array
    state: Any
    why: int
    felt_mm: float = 0.0


class Stretch(NamedTuple):
    """What was felt: a way (n, 2) mm from where the head stands, and how far beside it the cell may go, mm.

    `room_mm`: so far before the place where the cell stops the head stays, if it stops on the way.
    `straight_mm`: how far beside it the cell may go with a window over which the way hardly bends: it cannot
    cut a bend there, and sees the edges of hard pixels otherwise than stations do.
    """

    way: Array
    within_mm: float
    room_mm: float = 0.0
    straight_mm: float = 0.0


def keeps_mm(view: View, seen: Array) -> float:
    """How far beside stations (n, 3) the cell may go, mm: by the line's width, the pixels, its roughness.

    Both edges are as rough as each other, so that the middle is half as rough as the width.
    """
    widths = seen[:, 2]
    rough_mm = 0.5 * ROBUST * median(np.abs(widths - median(widths)))
    fine_mm = min(KEEPS_FINE_WIDTHS * view.width_mm, KEEPS_FINE_MM)
    by_view_mm = max(KEEPS_WIDTHS * view.width_mm, KEEPS_PX * view.pitch_mm, fine_mm)
    return max(by_view_mm, KEEPS_ROUGH * rough_mm)


def keeps_straight_mm(view: View) -> float:
    """The same where the way hardly bends, mm: by the scan's own pixels, though they were parted."""
    return KEEPS_PX * view.parted * view.pitch_mm


def is_steady(way: Array) -> bool:
    """Whether a way (n, 2) mm is an arc: it bends as much in its second half as in its first."""
    thirds = at_lengths(way, np.linspace(0.0, length_mm(way), 4))
    dx, dy = np.diff(thirds, axis=0).T
    first, second = (turn(*pair) for pair in pairwise(np.arctan2(dy, dx)))
    return abs(second - first) < STEADY * max(abs(first), abs(second))


def narrow_mm(t: Tuning, way: Array) -> float:
    """Half of the window for a tight bend, mm."""
    return (WINDOW_STEADY if is_steady(way) else WINDOW) * t.narrow_mm


def wide_mm(t: Tuning, way: Array) -> float | None:
    """Half of the widest window over which a way (n, 2) mm hardly bends, mm; None if it bends over all."""
    for half_mm in np.geomspace(t.half_window_mm, t.narrow_mm, WINDOWS + 1)[:-1].tolist():
        if largest_bend_rad(way, half_mm) < TIGHTEST_RAD:
            return float(half_mm)
    return None


def largest_bend_rad(way: Array, half_mm: float) -> float:
    """By how much a way (n, 2) mm turns at most from one half of a window to the other, rad; infinite if it
    is shorter than a window.
    """
    places = at_lengths(way, np.arange(0.0, length_mm(way), half_mm / CHORDS))
    if len(places) <= 2 * CHORDS:
        return math.inf
    dx, dy = (places[CHORDS:] - places[:-CHORDS]).T
    headings = np.unwrap(np.arctan2(dy, dx))
    return float(np.abs(headings[CHORDS:] - headings[:-CHORDS]).max())


def slowly(t: Tuning, width_mm: float, half_mm: float) -> Tuning:
    """The tuning for a low speed, half of a window, mm, and the lead that suffices for them."""
    speed_mm_s = t.slowed * t.speed_mm_s
    sweeps_mm = LEAD_SWEEPS * speed_mm_s * t.sweep_periods * t.period_s
    return t._replace(
        speed_mm_s=speed_mm_s,
        lead_mm=min(t.lead_mm, half_mm + t.point_mm + sweeps_mm),
        half_window_mm=half_mm,
        narrow_mm=half_mm,
        aslant_mm2=width_mm * width_mm,
        narrowest_per_mm=max(t.narrowest_per_mm, BENT_WIDTHS / width_mm),
    )


def follow(view: View, state: Any, t: Tuning, home: Home, stretch: Stretch) -> Tried | None:
    """Follow from a state, which is not changed, along a stretch: as through a tight bend, or else with a
    wide window; None if the cell keeps to it with neither. `t` is the fast cell's tuning.
    """
    tight = slowly(t, view.width_mm, narrow_mm(t, stretch.way))
    tried = along(view.cells, state, tight, home, stretch)
    half_mm = wide_mm(t, stretch.way) if tried is None else None
    if half_mm is None:
        return tried
    within_mm = max(stretch.within_mm, stretch.straight_mm)
    straight = stretch._replace(within_mm=within_mm)
    return along(view.cells, state, slowly(t, view.width_mm, half_mm), home, straight)


def along(cells: Cells, state: Any, t: Tuning, home: Home, stretch: Stretch) -> Tried | None:
    """Follow from a state, which is not changed, along a stretch; None if the cell does not keep to it.

    First with what the cell has seen itself. If it has lost the line, it begins on what was felt.
    """
    way_mm = length_mm(stretch.way)
    if way_mm < SHORTEST_MM:
        return None
    for start, felt_mm in ((_drawn_in, 0.0), (_on_felt, t.lead_mm - t.point_mm)):
        begun = start(state, t, stretch.way)
        tried = _for(cells, begun, t, home, way_mm)
        if tried.why not in (MORE, HOME):
            come_mm = tried.state.travel_mm - state.travel_mm - stretch.room_mm
            if come_mm < felt_mm + LEAST_MM:
                continue
            tried = _for(cells, begun, t, home, come_mm)
        if keeps_to(tried.positions, stretch):
            return tried._replace(felt_mm=felt_mm)
    return None


def _drawn_in(state: Any, t: Tuning, _: Array) -> Any:
    """The state with the mount drawn in."""
    state = state.copy()
    mount.set_to(state, t.lead_mm)
    return state


def _on_felt(state: Any, t: Tuning, way: Array) -> Any:
    """The state with the mount drawn in, and the drum filled with a way ahead (n, 2) mm."""
    state = state.copy()
    come_mm = lengths_mm(way)
    at_mm = np.arange(0.0, min(t.lead_mm, float(come_mm[-1])), FELT_EVERY_MM)
    felt = np.column_stack([np.interp(at_mm, come_mm, column) for column in way.T])
    c, s = math.cos(state.heading_rad), math.sin(state.heading_rad)
    x, y = felt[-1] - (state.x_mm, state.y_mm)
    state.lead_mm, state.middle_mm = t.lead_mm, y * c - x * s
    put_on_drum(state, felt)
    mount.begin_sweep(state)
    return state


def _for(cells: Cells, begun: Any, t: Tuning, home: Home, length_mm: float) -> Tried:
    """Follow for a length, mm, past what the guard cells say."""
    state = begun.copy()
    end_mm = state.trusted_mm = state.travel_mm + length_mm
    parts, why = [np.empty((0, 2))], MORE
    while why == MORE and state.travel_mm < end_mm:
        left_s = (end_mm - state.travel_mm) / max(state.speed_mm_s, t.speed_mm_s)
        out = np.empty((max(1, math.ceil(left_s / t.period_s)), 2))
        n, why = kernel.follow(cells, state, t, home, out)
        parts.append(out[:n])
    return Tried(np.vstack(parts), state, int(why))


def keeps_to(positions: Array, stretch: Stretch) -> bool:
    """Whether positions (n, 2) mm stay nearer to the way of a stretch than it allows."""
    if not len(positions):
        return False
    if _is_beside(positions, np.ascontiguousarray(stretch.way), float(stretch.within_mm)):
        return True
    return float(distances_mm(positions[::CHECKED], [stretch.way]).max()) < stretch.within_mm


@njit(cache=True, _nrt=False)
def _is_beside(positions, way, within_mm):  # type: ignore[no-untyped-def]
    """Whether positions, which go along a way, are nearer than this to a piece of it that they come to.

    The nearest piece of all may be another one, nearer still.
    """
    piece = 0
    for k in range(0, len(positions), CHECKED):
        away_mm = _from_piece(positions[k], way, piece)
        while piece + 2 < len(way):
            next_mm = _from_piece(positions[k], way, piece + 1)
            if next_mm > away_mm:
                break
            away_mm, piece = next_mm, piece + 1
        if not away_mm < within_mm:
            return False
    return True


@njit(cache=True, _nrt=False)
def _from_piece(place, way, piece):  # type: ignore[no-untyped-def]
    """The distance of a place from a straight piece of a way, mm."""
    x, y = place[0] - way[piece, 0], place[1] - way[piece, 1]
    along_x, along_y = way[piece + 1, 0] - way[piece, 0], way[piece + 1, 1] - way[piece, 1]
    squared = along_x * along_x + along_y * along_y
    share = (x * along_x + y * along_y) / squared if squared > 0.0 else 0.0
    share = min(max(share, 0.0), 1.0)
    return math.hypot(x - share * along_x, y - share * along_y)
