"""Agreement: whether the swinging cell and the line that was felt ahead say the same.

Signals: the carriage and the felt stations (n, 3) mm in; out how far the cell may go on by itself, mm, and
whether cell and stations contradict each other.

A guard cell stops the head where grain, a speck or a tight bend crosses it. Where the line is then felt clean
and the cell stands on it, the cell goes on. Where the cell has steered away from the felt line, stations
overrule it; but a cell that is overruled again and again, and does not lead in between, is not to be trusted:
it points the wrong way, is blind, or hears noise. Stations must not take its place unsaid.

Source: our own.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.plane import heading_of
from morfax.tracer.head.carriage import Carriage
from morfax.tracer.junctions.rings import corner_in
from morfax.tracer.sensing.leg import turn
from morfax.tracer.sensing.view import View

AGREES = 0.12  # of the width: on the test drawings 99 % of the clean lines are seen within 0.06
AGREES_PX = 0.6  # on an edge, which has no width; by trial on filled shapes
# of a leg's length: so far before the felt line's end the guard cells look out again; for less the cell does
# not go on; by trial
LEFT_LEGS = 0.25
# a line that turns by more up to the cell is too tight for it, which looks ahead along the heading: that it
# stands beside the line there is no fault of its own; by trial on holes of 0.6 to 1.8 mm radius
TIGHT_RAD = 0.6
MOST_OVERRULED = 3  # times in a row; by trial on engravings


@dataclass(slots=True)
class Agreement:
    """What the head knows of its cell: how often in a row stations have overruled it.

    `by_stations` the slow cell does not lead, and stations do not wait for the cell past a corner.
    """

    overruled: int = 0
    by_stations: bool = False
    _led_mm: float = 0.0  # how far the cell had led when it was last overruled

    def goes_on_mm(self, carriage: Carriage, view: View, seen: Array) -> float:
        """How far the cell may go on along stations ahead, mm; 0 if stations have to lead."""
        off_mm, ahead_mm = cell_off_mm(carriage, seen)
        if off_mm is None:
            return 0.0
        if off_mm > AGREES * view.width_mm or not carriage.sees_line:
            if turned_rad(carriage, seen) < TIGHT_RAD:
                self._overrule(carriage)
            return 0.0
        # past a corner the stations go, though its ink does not show how sharp it is; and where the cell
        # stopped though it was trusted, the line bends too much for it; one that has not led since a corner
        # may have the other side of its tip in view
        here = int(np.argmin(np.hypot(*(seen[:, :2] - carriage.stands()[0]).T)))
        by_memory = carriage.travel_mm < carriage.memory_to_mm
        doubtful = carriage.is_trusted or (by_memory and not self.by_stations)
        if doubtful or corner_in(seen, here) is not None:
            return 0.0
        return _clear_mm(carriage, view, ahead_mm)

    def goes_on_along(self, carriage: Carriage, view: View, seen: Array) -> bool:
        """The same along the stations of an edge on which nothing is tight."""
        off_mm, ahead_mm = cell_off_mm(carriage, seen)
        if off_mm is None or off_mm > AGREES_PX * view.pitch_mm or not carriage.sees_line:
            self._overrule(carriage)
            return False
        clear_mm = 0.0 if carriage.is_trusted else _clear_mm(carriage, view, ahead_mm)
        if clear_mm:
            carriage.trust(clear_mm)
        return clear_mm > 0

    def goes_on(self, carriage: Carriage, view: View, seen: Array) -> bool:
        """Whether the cell goes on by itself along stations ahead; the carriage trusts it then."""
        on_mm = self.goes_on_mm(carriage, view, seen)
        if on_mm:
            carriage.trust(on_mm)
        return on_mm > 0

    @property
    def contradict(self) -> bool:
        """Whether cell and stations contradict each other."""
        return self.overruled >= MOST_OVERRULED

    def _overrule(self, carriage: Carriage) -> None:
        """Count that stations overrule the cell; anew if it has led for a lead since the last time."""
        if carriage.cell_led_mm - self._led_mm > carriage.tuning.lead_mm:
            self.overruled = 0
        self.overruled += 1
        self._led_mm = carriage.cell_led_mm


def _clear_mm(carriage: Carriage, view: View, ahead_mm: float) -> float:
    """How far the cell may go on where a felt line goes on so far beyond it, mm; 0 if that is too little."""
    guards_mm = carriage.tuning.guard_lead_mm - carriage.tuning.lead_mm
    clear_mm = ahead_mm - guards_mm - LEFT_LEGS * view.leg_mm
    return clear_mm if clear_mm > LEFT_LEGS * view.leg_mm else 0.0


def turned_rad(carriage: Carriage, seen: Array) -> float:
    """By how much the felt line turns from where the head stands up to its cell."""
    places = seen[:, :2]
    ends = carriage.stands()[0], carriage.cell_mm
    near = [int(np.argmin(np.hypot(*(places - end).T))) for end in ends]
    from_rad, to_rad = (heading_of(_way_at(places, k)) for k in near)
    return abs(turn(from_rad, to_rad))


def _way_at(places: Array, k: int) -> Array:
    """The step of a line (n, 2) about one of its places."""
    return np.asarray(places[min(k + 1, len(places) - 1)] - places[max(k - 1, 0)])


def cell_off_mm(carriage: Carriage, seen: Array) -> tuple[float | None, float]:
    """How far the cell is off the felt line, and how far that goes on beyond the cell, mm.

    None if the line was not felt as far as the cell.
    """
    cell_mm, places = carriage.cell_mm, seen[:, :2]
    near = int(np.argmin(np.hypot(*(places - cell_mm).T)))
    if not 0 < near < len(places) - 1:
        return None, 0.0
    way = places[near + 1] - places[near - 1]
    dx, dy = cell_mm - places[near]
    off_mm = abs(way[0] * dy - way[1] * dx) / float(np.hypot(*way))
    ahead_mm = float(np.hypot(*np.diff(places[near:], axis=0).T).sum())
    return float(off_mm), ahead_mm
