"""The carriage: the head on its two screws, moved by its kernels, and what it remembers of its way.

Signals: a leg to follow from, or a course (mm, mm/s) in; positions (n, 2) mm at the motion rate out.
It keeps all positions of its screws (`positions_mm`; beyond some metres in a file), and a trail of them.

Source: patent ES 361967, figure 1: lead screws 111 with their motors 17 and 12, and the head that they carry.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from morfax.motion import curves
from morfax.motion.arrays import Array
from morfax.motion.long_array import LongArray
from morfax.motion.plane import direction, heading_of
from morfax.motion.polyline import come_to, lengths_mm
from morfax.motion.usual import MOTION_RATE_HZ
from morfax.tracer.head import kernel, mount, screws, slow_cell, swinging, watched
from morfax.tracer.head.leaders import CELL, MEMORY, STATIONS, Led, Log
from morfax.tracer.head.settings import Settings
from morfax.tracer.head.slow_cell import FeltStretch
from morfax.tracer.head.stance import Stance
from morfax.tracer.head.state import (
    Home,
    Moment,
    at_rest,
    field_of,
    put_on_drum,
    set_fields,
    two_of,
)
from morfax.tracer.head.trail import Marks, Trail
from morfax.tracer.head.tuning import CALIBRATED_ASIDE, tune, tuned_along
from morfax.tracer.sensing.leg import Leg, turn
from morfax.tracer.sensing.view import View

CHUNK = round(MOTION_RATE_HZ)  # samples that the kernel follows before it reports: a second
SETTLE_LAGS = 7  # a stop lasts this many lags of the drives: 1/1000 of the last speed is left
HEARD = 0.1  # of what the sweep was set off; grain takes away less than the rest
_STANDS = "x_mm", "y_mm", "vx_mm_s", "vy_mm_s", "heading_rad"
_NO_INK = dict.fromkeys(("trusted_mm", "guard_left", "guard_right"), 0.0)
_ON_CLEAN_LINE = _NO_INK | dict.fromkeys(("guard_ahead", "ink", "swept_ink"), 1.0)
SPARE = 1000  # samples beside those that a course takes at the slowest


class Carriage:
    """A head on two screws."""

    def __init__(self, stance: Stance, settings: Settings, rate_hz: float) -> None:
        self.settings, self.rate_hz = settings, rate_hz
        self.tuning = tune(stance, settings, rate_hz)
        self.trail = Trail(stance.place_mm, stance.view.step_mm)
        self.state = at_rest(stance.place_mm, self.tuning.lead_mm)
        self._positions = LongArray()
        self._positions.add(stance.place_mm[None])
        self.enlarged = stance.view.enlarged  # of the positions: so many times the drawing's mm
        self._watcher = watched.watcher()
        if self._watcher is not None:
            self._watcher.put_down(self)
        # who leads, from which position on, and up to which travel the drum holds what was felt
        self._log, self._leads, self._cell_from_mm = Log(), STATIONS, 0.0
        self._log.add(0, STATIONS)
        self.cell_led_mm = 0.0  # how far the swinging cell has led so far

    @property
    def count(self) -> int:
        """How many positions there are so far."""
        return len(self._positions)

    @property
    def travel_mm(self) -> float:
        """How far the head has come, mm."""
        return field_of(self.state, "travel_mm")

    @property
    def heading_rad(self) -> float:
        """The head's heading, rad."""
        return field_of(self.state, "heading_rad")

    @property
    def ink_beside(self) -> bool:
        """Whether a guard cell sees ink beside the line."""
        return bool(max(self.state.guard_left, self.state.guard_right) > kernel.BESIDE)

    def shared(self) -> list[Any]:
        """What a copy of the carriage may share with it: it is never changed."""
        return [self._watcher]

    def taken_up(self) -> None:
        """Go on as a copy of a carriage: whoever watches now sees it as it stands."""
        self._watcher = watched.watcher()
        if self._watcher is not None:
            self._watcher.taken_up(self)

    @property
    def positions_mm(self) -> Array:
        """Every position of the screws so far, (n, 2) mm."""
        return self._positions.whole()

    @property
    def led(self) -> Led:
        """Who led the head to each of its positions."""
        return self._log.led()

    @property
    def cell_mm(self) -> Array:
        """The place on the sheet where the swinging cell takes the line to be."""
        place, lead, aside = self.stands()[0], self.state.lead_mm, self.state.middle_mm
        c, s = math.cos(self.heading_rad), math.sin(self.heading_rad)
        return place + np.array([lead * c - aside * s, lead * s + aside * c])

    def hears(self, view: View) -> bool:
        """Whether the standing head's sweep, set a little to either side of the line, goes back to it.

        Over a few places ahead, as the tuning was measured. The cell swings under the axis: where its lead
        would stand, a small circle has turned away from the heading.
        """
        if self.count > 1:  # a run that is taken up again
            return True
        stations, tuning = tuned_along(view), self.tuning._replace(lead_mm=0.0, square=False)
        states = two_of(self.state)
        states[0].lead_mm = states[0].middle_mm = 0.0
        off_mm = CALIBRATED_ASIDE * view.width_mm
        how = stations, float(view.step_mm), float(off_mm)
        back_mm = swinging.goes_back(view.cells, states, tuning, how)
        return bool(back_mm > HEARD * 2 * stations * off_mm)

    @property
    def sees_line(self) -> bool:
        """Whether the swinging cell sees a line at all."""
        return bool(self.state.swept_ink > kernel.LOST)

    @property
    def is_trusted(self) -> bool:
        """Whether the cell is on its way past what the guard cells say."""
        return bool(self.state.travel_mm < self.state.trusted_mm)

    @property
    def memory_to_mm(self) -> float:
        """The travel up to which the drum leads by what was felt after a corner, not by what the cell saw."""
        return self._cell_from_mm if self._leads == MEMORY else -math.inf

    def trust(self, length_mm: float) -> None:
        """Go on by the swinging cell for a length, mm, past what the guard cells say: it was felt clean."""
        self.state.trusted_mm = self.state.travel_mm + length_mm

    def stands(self) -> tuple[Array, float]:
        """Where the drives' demand stands, and the heading."""
        owed = screws.owed_s(self.tuning.drive_gain, self.tuning.period_s)
        x, y, vx, vy, heading_rad = (field_of(self.state, name) for name in _STANDS)
        return np.array([x + owed * vx, y + owed * vy]), heading_rad

    def ahead(self, place: Array) -> float:
        """How far ahead of the axis a place is, mm along the heading."""
        stands, heading = self.stands()
        return float((place - stands) @ direction(heading))

    def follow(self, view: View, home: Home, samples: int = CHUNK) -> int:
        """Follow the line until something happens, or for so many samples; why it stopped (see `state`)."""
        out, from_mm = np.empty((samples, 2)), self.travel_mm
        self.says("following")
        n, why = kernel.follow(view.cells, self.state, self.tuning, home, out)
        self._led(out[:n], from_mm)
        self._keep(out[:n])
        return int(why)

    def took(self, positions: Array, from_mm: float, marks: Marks) -> None:
        """Keep positions (n, 2) along which a kernel has followed from a travel on, and marked the trail."""
        self._led(positions, from_mm)
        self._positions.add(positions)
        self.trail.took(marks)

    def follow_slowly(self, view: View, home: Home, stretch: FeltStretch) -> int | None:
        """Follow a stretch that was felt by the slow cell, if it keeps to that; why it stopped."""
        tried = slow_cell.follow(view, self.state, self.tuning, home, stretch)
        if tried is None:
            return None
        own_from_mm = self.travel_mm + tried.own_mm
        if tried.felt_mm > 0:
            self._log.add(self.count, STATIONS)
        else:  # the drum may still hold what was felt before
            own_from_mm = min(self._cell_from_mm, own_from_mm)
        self._cell_from_mm = own_from_mm
        from_mm, self.state = self.travel_mm, tried.state
        self._led(tried.positions, from_mm)
        self._keep(tried.positions)
        return tried.why

    def _led(self, positions: Array, from_mm: float) -> None:
        """Log who led to positions, by the drum: the cell to those after what it held of stations."""
        first, felt_mm = 0, self._cell_from_mm - from_mm
        if felt_mm > 0:
            first = int(come_to(self._positions.last, positions, felt_mm))
        if first < len(positions):
            self._log.add(self.count + first, CELL)
        self.cell_led_mm += max(self.travel_mm - max(from_mm, self._cell_from_mm), 0.0)

    def mark(self) -> Moment:
        """What the carriage is known by now, so that it can be brought back here."""
        return Moment(
            self.state.copy(),
            self.tuning,
            self.count,
            self._leads,
            self._cell_from_mm,
        )

    def back_to(self, mark: Moment) -> None:
        """Bring the carriage back to a mark, as if it had gone no further."""
        self.state, self.tuning = mark.state.copy(), mark.tuning
        self._positions.cut(mark.positions)
        self._leads, self._cell_from_mm = mark.leads, mark.cell_from_mm
        self._log.back_to(self.count)

    def since(self, mark: Moment) -> Array:
        """The positions since a mark, (n, 2) mm."""
        return self._positions.since(mark.positions)

    def run(self, stretches: list[Array], end_mm_s: float = 0.0, leader: int = MEMORY) -> None:
        """Run along stretches, swivelling between them, and end at a speed; `leader` laid them."""
        self._leads = leader
        self._log.add(self.count, leader)
        speed, acceleration = self.settings.speed_mm_s, self.settings.acceleration_mm_s2
        for k, stretch in enumerate(stretches):
            way = curves.distinct(stretch)
            if len(way) < 2:
                continue
            if k > 0:
                self.swivel(heading_of(way[1] - way[0]))
            last = k == len(stretches) - 1
            limits = curves.speeds(way, speed, acceleration, end_mm_s if last else 0.0)
            self._run(way, limits)
            self.state.heading_rad = heading_of(way[-1] - way[-2])
            if limits[-1] == 0.0:
                self._stand(SETTLE_LAGS * self.settings.drive.lag_s)

    def _run(self, way: Array, limits: Array) -> None:
        """Run along one stretch, however long it takes."""
        slowest = screws.SLOWEST * self.settings.speed_mm_s
        samples = int(lengths_mm(way)[-1] / slowest * self.rate_hz) + SPARE
        out = np.empty((samples, 2))
        n = screws.run(self.state, self.tuning, way, limits, out)
        self._keep(out[:n])

    def swivel(self, heading: float) -> None:
        """Turn the standing head to a heading."""
        self.says("turning at a corner")
        angle = abs(turn(self.heading_rad, heading))
        self._stand(angle / self.settings.swivel_rad_s)
        self.state.heading_rad = heading

    def _stand(self, time_s: float) -> None:
        """Stand for a time."""
        out = np.empty((math.ceil(time_s * self.rate_hz), 2))
        screws.stand(self.state, self.tuning, out)
        self._keep(out)

    def aim(self, view: View, leg: Leg) -> None:
        """Set the head to follow from the clean end of a leg, tuned to the line there.

        The drum takes what was felt of the leg up to where the swinging cell takes over.
        """
        stance = Stance(leg.end_mm, leg.heading_rad, view)
        self.tuning = tune(stance, self.settings, self.rate_hz)
        self._log.add(self.count, self._leads)
        self._cell_from_mm = self.travel_mm + self.tuning.lead_mm - self.tuning.point_mm
        felt = leg.seen[np.hypot(*(leg.seen[:, :2] - leg.end_mm).T) < self.tuning.lead_mm, :2]
        state, lead_mm, bend_per_mm = self.state, self.tuning.lead_mm, float(leg.bend_per_mm)
        turn_rad_s = field_of(state, "speed_mm_s") * bend_per_mm
        set_fields(state, heading_rad=leg.heading_rad, turn_rad_s=turn_rad_s)
        set_fields(state, lead_mm=lead_mm, middle_mm=mount.middle_on(leg, felt, lead_mm))
        x, y = leg.at(self.tuning.point_mm)
        set_fields(state, point_x_mm=x, point_y_mm=y, bend_per_mm=bend_per_mm, **_ON_CLEAN_LINE)
        mount.begin_sweep(state)
        put_on_drum(state, felt)

    def retune(self, view: View) -> None:
        """Tune the moving head to the line as it is seen now."""
        self.tuning = tune(Stance(*self.stands(), view), self.settings, self.rate_hz)
        mount.set_to(self.state, self.tuning.lead_mm)
        self.state.ink = 1.0

    def _keep(self, positions: Array) -> None:
        """Keep positions of the screws, and mark the trail with them."""
        if not len(positions):
            return
        self._positions.add(positions)
        self.trail.add(positions)
        if self._watcher is not None:
            self._watcher.moved(self, positions)

    def says(self, what: str) -> None:
        """Tell whoever watches what the head does, in words."""
        if self._watcher is not None:
            self._watcher.says(what)
