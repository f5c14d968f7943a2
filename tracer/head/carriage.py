"""The carriage: the head on its two screws, moved by its kernels, and what it remembers of its way.

Signals: a leg to follow from, or a course to run (sheet mm, mm/s) in; positions of the screws (n, 2) mm at
the motion rate out.

The carriage keeps every position that its screws took (`positions_mm`), and the trail of them by which the
head knows where it has been.

Source: patent ES 361967, figure 1: lead screws 111 with their motors 17 and 12, and the head that they carry.
"""

from __future__ import annotations

import math

import numpy as np

from morfax.motion import curves
from morfax.motion.arrays import Array
from morfax.tracer.head import kernel as head
from morfax.tracer.head.settings import Settings, tune
from morfax.tracer.head.stance import Stance
from morfax.tracer.head.trail import Trail
from morfax.tracer.sensing.leg import Leg, turn
from morfax.tracer.sensing.view import View

CHUNK = 6000  # samples that the kernel follows before it reports
SETTLE_LAGS = 7  # a stop lasts this many lags of the drives: 1/1000 of the last speed is left


class Carriage:
    """A head on two screws."""

    def __init__(self, stance: Stance, settings: Settings, rate_hz: float) -> None:
        self.settings, self.rate_hz = settings, rate_hz
        self.tuning = tune(stance, settings, rate_hz)
        self.trail = Trail(stance.place_mm, stance.view.step_mm)
        self.state = np.zeros(head.STATES)
        self.state[[head.X, head.Y]] = stance.place_mm
        self.state[head.INK] = 1.0
        self._drum = np.zeros((head.DRUM, 2))
        self._parts: list[Array] = [stance.place_mm[None].copy()]
        self.count = 1  # positions so far

    @property
    def travel_mm(self) -> float:
        """How far the head has come, mm."""
        return float(self.state[head.TRAVEL])

    @property
    def heading_rad(self) -> float:
        """The head's heading, rad."""
        return float(self.state[head.HEADING])

    @property
    def ink_beside(self) -> bool:
        """Whether a guard cell sees ink beside the line."""
        return bool(max(self.state[head.LEFT], self.state[head.RIGHT]) > head.BESIDE)

    @property
    def positions_mm(self) -> Array:
        """Every position of the screws so far, (n, 2) mm."""
        return np.vstack(self._parts)

    def stands(self) -> tuple[Array, float]:
        """Where the drives' demand stands, and the heading."""
        owed = head.owed_s(self.tuning.drive_gain, self.tuning.period_s)
        s = self.state
        return np.array(
            [s[head.X] + owed * s[head.VX], s[head.Y] + owed * s[head.VY]]
        ), self.heading_rad

    def ahead(self, place: Array) -> float:
        """How far ahead of the axis a place is, mm along the heading."""
        stands, heading = self.stands()
        return float((place - stands) @ np.array([math.cos(heading), math.sin(heading)]))

    def follow(self, view: View, home: tuple[float, float, float, float]) -> int:
        """Follow the line until something happens, or for a while; why it stopped (see `head`)."""
        out = np.empty((CHUNK, 2))
        n, why = head.follow(
            view.cells, view.pitch_mm, self.state, self._drum, self.tuning, home, out
        )
        self._keep(out[:n])
        return int(why)

    def run(self, stretches: list[Array], end_mm_s: float = 0.0) -> None:
        """Run along stretches, swivelling between them, and end at a speed."""
        for k, stretch in enumerate(stretches):
            way = curves.distinct(stretch)
            if len(way) < 2:
                continue
            step = way[1] - way[0]
            if k > 0:
                self.swivel(math.atan2(step[1], step[0]))
            last = k == len(stretches) - 1
            limits = curves.speeds(
                way,
                self.settings.speed_mm_s,
                self.settings.acceleration_mm_s2,
                end_mm_s if last else 0.0,
            )
            self._run(way, limits)
            step = way[-1] - way[-2]
            self.state[head.HEADING] = math.atan2(step[1], step[0])
            if limits[-1] == 0.0:
                self._stand(SETTLE_LAGS * self.settings.drive.lag_s)

    def _run(self, way: Array, limits: Array) -> None:
        """Run along one stretch, however long it takes."""
        length = float(np.hypot(*np.diff(way, axis=0).T).sum())
        slowest = 0.02 * self.settings.speed_mm_s
        out = np.empty((int(length / slowest * self.rate_hz) + 1000, 2))
        n = head.run(self.state, self.tuning, way, limits, out)
        self._keep(out[:n])

    def swivel(self, heading: float) -> None:
        """Turn the standing head to a heading."""
        self._stand(
            abs(turn(float(self.state[head.HEADING]), heading)) / self.settings.swivel_rad_s
        )
        self.state[head.HEADING] = heading

    def _stand(self, time_s: float) -> None:
        """Stand for a time."""
        out = np.empty((math.ceil(time_s * self.rate_hz), 2))
        head.stand(self.state, self.tuning, out)
        self._keep(out)

    def aim(self, view: View, leg: Leg) -> None:
        """Set the head to follow from the clean end of a leg, tuned to the line there.

        The drum takes what was felt of the leg up to where the swinging cell takes over.
        """
        self.tuning = tune(
            Stance(leg.end_mm, leg.heading_rad, view), self.settings, self.rate_hz
        )
        s, lead = self.state, self.tuning.lead_mm
        felt = leg.seen[np.hypot(*(leg.seen[:, :2] - leg.end_mm).T) < lead, :2]
        c, n = math.cos(leg.heading_rad), math.sin(leg.heading_rad)
        along, aside = (
            (felt[-1] - leg.end_mm) @ np.array([[c, -n], [n, c]]) if len(felt) else (0.0, 0.0)
        )
        s[head.HEADING], s[head.BEND], s[head.TURN] = (
            leg.heading_rad,
            leg.bend_per_mm,
            s[head.SPEED] * leg.bend_per_mm,
        )
        s[head.MIDDLE] = (
            aside * (lead / along) ** 2
            if along > 0.5 * lead
            else 0.5 * leg.bend_per_mm * lead * lead
        )
        s[head.POINT_X], s[head.POINT_Y] = leg.at(self.tuning.point_mm)
        s[head.SWEEP] = s[head.FIRST] = s[head.MEAN] = s[head.LEFT] = s[head.RIGHT] = 0.0
        s[head.AHEAD] = s[head.INK] = 1.0
        self._drum[: len(felt)] = felt
        s[head.PLACES] = len(felt)

    def retune(self, view: View) -> None:
        """Tune the moving head to the line as it is seen now."""
        old = self.tuning.lead_mm
        self.tuning = tune(Stance(*self.stands(), view), self.settings, self.rate_hz)
        self.state[head.MIDDLE] *= (self.tuning.lead_mm / old) ** 2
        self.state[head.INK] = 1.0
        self.state[[head.SWEEP, head.FIRST, head.MEAN]] = 0.0

    def _keep(self, positions: Array) -> None:
        self._parts.append(positions.copy())
        self.count += len(positions)
        self.trail.add(positions)
