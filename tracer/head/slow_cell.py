"""The slow cell: along a stretch that was felt, the cell goes on by itself where it had stopped.

    cell      slow, with a short lead and a narrow window: its places alone are on the drum and steer
    stations  the way that was felt, (n, 2) mm: the cell has to keep to it, and that is all

Signals: the head's state and tuning, and the way that was felt (sheet mm), in; where the cell would go, at
the motion rate, out. If it leaves the way, the head has not moved, and stations lead instead (see `leaders`).

In a tight bend a long lead swings the cell across a line that has turned away from it, and a wide window cuts
the bend. A head that goes slowly needs neither: more sweeps fall on each mm. Its sweep stands square to the
bend. Where a narrow window does not keep to the way, the cell tries once more with windows as wide as the
way's own bend allows (see `windows`).

Source: our own. Optical tracers slow down at tight bends, and so does the patent's relay RL.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.compiled import njit
from morfax.motion.median import OUTLIERS, ROBUST, median
from morfax.motion.plane import heading_of
from morfax.motion.polyline import length_mm, lengths_mm
from morfax.tracer.head import kernel, mount
from morfax.tracer.head.state import HOME, MORE, Home, Tuning, field_of, put_on_drum, set_fields
from morfax.tracer.head.windows import (
    Ahead,
    CellWindow,
    most_bend_per_mm,
    narrowest,
    slowly,
    widest,
)
from morfax.tracer.sensing.leg import turn
from morfax.tracer.sensing.photocell import Cells
from morfax.tracer.sensing.view import View

# Chosen by trial on the test drawings.
# so far beside what was felt the cell has kept to the way: the largest of these, ...
KEEPS_WIDTHS, KEEPS_PX = 0.02, 0.2
# ... or this: so far off a line of few pixels may be seen, whose pixels were parted
KEEPS_FINE_MM = 0.017
# grain moves the middle of a pencil's or dry pen's ink by 3 to 5 % of its width (standard deviation), over
# more of the line than its stations show: twice that
KEEPS_GRAINY_WIDTHS = 0.08
# at its end it has to head as the way does: ink beside the line turns it before it is off the way. Few pixels
# turn it by 0.2 at the most, the ticks that led it astray by 0.4 to 0.6 (664 stretches, 90 to 300 dpi)
HEADS_RAD = 0.25
CHECKED = 8  # one position in 8 is held against the way: every 4 um at 3 mm/s
LEAST_MM = 0.3  # for less the cell does not go on, ...
# ... nor along a shorter stretch: a corner follows, and stations lead up to that
SHORTEST_MM = 0.75
CHORD = 2  # places of a way to either side of one, between which its heading is taken
FELT_EVERY_MM = 0.04  # as fast sweeps lie on the drum, at 10 mm/s


class Tried(NamedTuple):
    """Where the cell went along a way: positions (n, 2) mm, the head's state there, why it stopped.

    `felt_mm`: for so far stations led, with whose places the drum was filled. `own_mm`: after so far the
    cell's own places fill half of its window.
    """

    positions: Array
    state: Any
    why: int
    felt_mm: float = 0.0
    own_mm: float = 0.0


class TunedPiece(NamedTuple):
    """A piece of a way, mm, and the tuning along it."""

    length_mm: float
    tuning: Tuning


class FeltStretch(NamedTuple):
    """What was felt: a way (n, 2) mm from where the head stands, and how far beside it the cell may go, mm.

    `room_mm`: so far before the place where the cell stops the head stays, if it stops on the way.
    `straight_mm`: how far beside it the cell may go with windows over which the way hardly bends: it cannot
    cut a bend there, and sees the edges of hard pixels otherwise than stations do. `clear_mm`: how far beyond
    the way's end the cell may look before something leaves the line.
    """

    way: Array
    within_mm: float
    room_mm: float = 0.0
    straight_mm: float = 0.0
    clear_mm: float = math.inf


def rough_mm(seen: Array) -> float:
    """The roughness of the middle of stations (n, 3), as their widths show it: a standard deviation, mm."""
    widths = seen[:, 2]
    return 0.5 * ROBUST * median(np.abs(widths - median(widths)))


def keeps_mm(view: View, seen: Array) -> float:
    """How far beside stations (n, 3) the cell may go, mm: by the line's width, the pixels, its roughness.

    Both edges are as rough as each other, so that the middle is half as rough as the width.
    """
    widths = KEEPS_GRAINY_WIDTHS if view.grainy else KEEPS_WIDTHS
    by_view_mm = max(widths * view.width_mm, KEEPS_PX * view.pitch_mm, KEEPS_FINE_MM)
    return max(by_view_mm, OUTLIERS * rough_mm(seen))


def keeps_straight_mm(view: View) -> float:
    """The same where the way hardly bends, mm: by the scan's own pixels, though they were parted."""
    return KEEPS_PX * view.parted * view.pitch_mm


def follow(view: View, state: Any, t: Tuning, home: Home, stretch: FeltStretch) -> Tried | None:
    """Follow from a state, which is not changed, along a stretch: as through a tight bend, or else with
    windows as wide as its bends allow; None if the cell keeps to it with neither. `t` is the fast cell's
    tuning.
    """
    if length_mm(stretch.way) < SHORTEST_MM:
        return None
    ahead = Ahead(stretch.way, view.width_mm, stretch.clear_mm)
    narrow = narrowest(t, ahead)
    tried = along(view.cells, state, pieces(t, ahead, narrow), home, stretch)
    wide = widest(t, ahead) if tried is None else narrow
    if wide == narrow:
        return tried
    straight = stretch._replace(within_mm=max(stretch.within_mm, stretch.straight_mm))
    return along(view.cells, state, pieces(t, ahead, wide), home, straight)


def pieces(t: Tuning, ahead: Ahead, windows: list[CellWindow]) -> list[TunedPiece]:
    """The slow cell's tuning for each window of a way."""
    most_per_mm = most_bend_per_mm(t, ahead)
    return [
        TunedPiece(long_mm, slowly(t, half_mm, most_per_mm)) for long_mm, half_mm in windows
    ]


def along(
    cells: Cells, state: Any, course: list[TunedPiece], home: Home, stretch: FeltStretch
) -> Tried | None:
    """Follow from a state, which is not changed, along a stretch; None if the cell does not keep to it.

    First with what the cell has seen itself. If it has lost the line, it begins on what was felt.
    """
    t = course[0].tuning
    own_mm = t.lead_mm - t.point_mm
    for start, felt_mm in ((_drawn_in, 0.0), (_on_felt, own_mm)):
        begun = start(state, t, stretch.way)
        tried = _through(cells, begun, course, home)
        if tried.why not in (MORE, HOME):
            come_mm = tried.state.travel_mm - state.travel_mm - stretch.room_mm
            if come_mm < felt_mm + LEAST_MM:
                continue
            tried = _through(cells, begun, course, home, come_mm)
        if keeps_to(tried.positions, stretch) and heads_along(tried, stretch.way):
            return tried._replace(felt_mm=felt_mm, own_mm=own_mm)
    return None


def _through(
    cells: Cells, begun: Any, course: list[TunedPiece], home: Home, longest_mm: float = math.inf
) -> Tried:
    """Follow through the pieces of a way one after the other, for so many mm at the most."""
    state, why, parts, end_mm = begun, MORE, list[Array](), 0.0
    for long_mm, t in course:
        end_mm = min(end_mm + long_mm, longest_mm)
        left_mm = end_mm - (field_of(state, "travel_mm") - field_of(begun, "travel_mm"))
        if why != MORE or left_mm <= 0.0:
            break
        # the mount is drawn in at once; out it slides by itself
        state = _drawn_in(state, t) if t.lead_mm < field_of(state, "lead_mm") else state
        tried = _for(cells, state, t, home, left_mm)
        state, why = tried.state, tried.why
        parts.append(tried.positions)
    return Tried(_joined(parts), state, why)


def _joined(parts: list[Array]) -> Array:
    """Positions (n, 2) one after the other; one part as it is."""
    return parts[0] if len(parts) == 1 else np.vstack([np.empty((0, 2)), *parts])


def _drawn_in(state: Any, t: Tuning, _: Array | None = None) -> Any:
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
    end_mm = field_of(state, "travel_mm") + length_mm
    set_fields(state, trusted_mm=end_mm)
    parts, why = list[Array](), MORE
    while why == MORE and (left_mm := end_mm - field_of(state, "travel_mm")) > 0.0:
        left_s = left_mm / max(field_of(state, "speed_mm_s"), t.speed_mm_s)
        out = np.empty((max(1, math.ceil(left_s / t.period_s)), 2))
        n, why = kernel.follow(cells, state, t, home, out)
        parts.append(out[:n])
    return Tried(_joined(parts), state, int(why))


def heads_along(tried: Tried, way: Array) -> bool:
    """Whether the head goes on as a way (n, 2) mm does where the head has come to."""
    last = int(np.argmin(np.hypot(*(way - tried.positions[-1]).T)))
    before, after = way[max(0, last - CHORD)], way[min(last + CHORD, len(way) - 1)]
    return abs(turn(heading_of(after - before), tried.state.heading_rad)) < HEADS_RAD


def keeps_to(positions: Array, stretch: FeltStretch) -> bool:
    """Whether positions (n, 2) mm, which go along a way, stay nearer to it than its stretch allows."""
    way = np.ascontiguousarray(stretch.way)
    return len(positions) > 0 and bool(_is_beside(positions, way, float(stretch.within_mm)))


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
