"""The lookout: sees the head in the worker and tells of it without holding it up.

Signals in: what the head does (see `tracer.head.watched`), at the motion rate. Signals out: 30 times a
second at most the new places of its path (every `STEP_MM` of travel), where it stands, what its cells and
its drum hold, and what it does in words. Hold, step, stop and pace are obeyed between two of the head's
stretches, which last a second of motion or less.

    head    ──┬──┬──┬──┬──┬──►  moved                    places are gathered; the sender takes what there is
    sender    └─────┴─────┴──►  a frame every 33 ms      when the pipe is free: the head never waits

Source: our own. Questions: the path is told in steps of 0.1 mm: on a bend of 1 mm radius it cuts 1.3 um
inside.
"""

from __future__ import annotations

import threading
import time
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from morfax.motion.arrays import Array
    from morfax.tracer.head.carriage import Carriage

STEP_MM = 0.1  # of travel, from place to place of the path that is shown
EVERY = 12  # positions of the motion rate: the path is measured every 2 ms, 20 um at 10 mm/s
TAIL = 24  # places of the drum that are shown: the newest


class Lookout:
    """A watcher that gathers, and the controls by which the operator holds the head."""

    def __init__(self) -> None:
        self._lock, self._news = threading.Lock(), threading.Event()
        self._go = threading.Event()
        # times the head's own speed; None: as fast as the computer can
        self.pace: float | None = None
        self.begin()

    def begin(self) -> None:
        """Forget the last run."""
        with self._lock:
            self._runs, self._places = 0, list[list[float]]()
            self._fresh, self._over_mm = list[Any](), 0.0
            self._last: Array | None = None
            self._carriage: Carriage | None = None
            self.words, self._stops, self._steps = "", False, False
            self._ahead_s, self._since_s = 0.0, time.monotonic()
        self._go.set()

    # what the operator does
    def hold(self) -> None:
        """Hold the head where its stretch ends."""
        self._go.clear()

    def resume(self) -> None:
        """Let the head go on."""
        self._steps = False
        self._go.set()

    def step(self) -> None:
        """Let the head go on to the next junction, and hold it there."""
        self._steps = True
        self._go.set()

    def stop(self) -> None:
        """End the run."""
        self._stops = True
        self._go.set()

    def set_pace(self, pace: float | None) -> None:
        """Run at so many times the head's own speed; None: as fast as the computer can."""
        self.pace, self._ahead_s, self._since_s = pace, 0.0, time.monotonic()

    # what the head does
    def put_down(self, carriage: Carriage) -> None:
        """See the head put down: a new attempt."""
        with self._lock:
            self._runs += 1
            self._fresh.append("down")
            self._last, self._over_mm, self._carriage = None, 0.0, carriage
        self._news.set()

    def taken_up(self, carriage: Carriage) -> None:
        """See the head where an earlier run had come, with the way up to there; nobody waits for that."""
        self.put_down(carriage)
        self._gather(carriage.positions_mm[::EVERY] / carriage.enlarged)

    def moved(self, carriage: Carriage, positions: Array) -> None:
        """Gather the places of a stretch; wait if the operator holds the head."""
        if len(positions):
            self._gather(positions[::EVERY] / carriage.enlarged)
        self._wait(len(positions) / carriage.rate_hz)

    def says(self, what: str) -> None:
        """Take down what the head does; hold it at a junction if that is asked for."""
        self.words = what
        self._news.set()
        if self._steps and what == "at a junction":
            self._steps = False
            self._go.clear()
        self.check()

    def check(self) -> None:
        """End the run if the operator stopped it; wait while the operator holds it."""
        self._go.wait()
        if self._stops:
            raise KeyboardInterrupt("stopped at the panel")

    def news(self, timeout_s: float) -> dict[str, Any] | None:
        """What is new since the last call; None if nothing is within the time."""
        if not self._news.wait(timeout_s):
            return None
        with self._lock:
            self._news.clear()
            fresh, self._fresh = self._fresh, []
            return {
                "fresh": fresh,
                "head": self._head(),
                "words": self.words,
                "run": self._runs,
            }

    def _gather(self, places: Array) -> None:
        """Keep a place every `STEP_MM` of travel, and the last."""
        before = places[:1] if self._last is None else self._last[None]
        way = np.vstack([before, places])
        come_mm = self._over_mm + np.cumsum(np.hypot(*np.diff(way, axis=0).T))
        marks = np.floor(come_mm / STEP_MM)
        kept = places[
            np.flatnonzero(np.diff(marks, prepend=np.floor(self._over_mm / STEP_MM)) > 0)
        ]
        with self._lock:
            self._last = places[-1]
            self._over_mm = float(come_mm[-1] % STEP_MM)
            self._fresh += np.round(kept, 3).tolist()
        self._news.set()

    def _head(self) -> dict[str, Any]:
        """Where the head stands, and what its cells and its drum hold, when a frame is sent."""
        carriage = self._carriage
        if carriage is None:
            return {}
        s, tuning, by = carriage.state, carriage.tuning, 1.0 / carriage.enlarged
        newest = int(s.places)
        rows = np.arange(max(0, newest - TAIL), newest) % len(s.drum_mm)
        return {
            "x_mm": float(s.x_mm) * by,
            "y_mm": float(s.y_mm) * by,
            "heading_rad": float(s.heading_rad),
            "speed_mm_s": float(s.speed_mm_s) * by,
            "travel_mm": float(s.travel_mm) * by,
            "lead_mm": tuning.lead_mm * by,
            "amplitude_mm": tuning.amplitude_mm * by,
            "guard_mm": tuning.guard_mm * by,
            "guard_lead_mm": tuning.guard_lead_mm * by,
            "guards": [float(s.guard_left), float(s.guard_ahead), float(s.guard_right)],
            "middle_mm": float(s.middle_mm) * by,
            "drum_mm": np.round(s.drum_mm[rows] * by, 4).tolist(),
        }

    def _wait(self, motion_s: float) -> None:
        """Wait for the operator, and for the pace."""
        self.check()
        self._ahead_s += motion_s
        while self.pace is not None:
            early_s = self._ahead_s / self.pace - (time.monotonic() - self._since_s)
            if early_s <= 0:
                return
            time.sleep(min(early_s, 0.05))
            self.check()
