"""A run as the operator makes it: the head put down, the tool down, the line followed, the tool up.

Signals: a Drawing in; out a Trace, which is a stream of Motion (X, Y, Z in sheet mm at the motion rate) and says how the run ended.

    Z  clearance ──╮                           ╭── clearance
       0           │ X, Y stand     X, Y stand │
       -depth      ╰────── the line ───────────╯

A line that turns out to be open is followed from end to end: the head that was put down on its middle runs to one end first, with nothing recorded, and
begins there. A line that does not come back one way round is tried the other way; one that runs into what has been followed already is tried with
other turns at its junctions, as an operator would.

Source: patent ES 361967, section on use, in its plainest form: one line, down at its start and up at its end.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from functools import partial
from itertools import combinations

import numpy as np

from motion.faults import LineFault
from motion.motion import BLOCK_SAMPLES, MOTION_RATE_HZ, Motion
from tracer.drawing import Drawing
from tracer.follower import Followed, Follower
from tracer.lines import INK
from tracer.settings import Settings
from tracer.stance import Stance, put_down, turned_round
from tracer.view import Array

SHORTER = 0.95  # the other way round is the line itself if it is shorter than this: straight on has led elsewhere
TURNS = 12  # junctions at which another turn is tried


@dataclass(frozen=True, slots=True)
class Work:
    """How deep the tool goes, where it stands above the work between lines, and how fast it goes down and up."""

    depth_mm: float = 5.0
    clearance_mm: float = 2.0
    feed_mm_s: float = 5.0
    acceleration_mm_s2: float = 200.0


@dataclass(frozen=True, slots=True)
class Trace:
    """What the head did: a stream of Motion, and how it ended ("closed", "ended", "joined" or "lost", with the fault)."""

    xy_mm: Array
    ending: str
    line_width_mm: float
    travel_mm: float
    fault: LineFault | None = None
    work: Work = field(default_factory=Work)
    rate_hz: float = MOTION_RATE_HZ

    @property
    def start_mm(self) -> tuple[float, float]:
        """Where the line was begun, mm."""
        return float(self.xy_mm[0, 0]), float(self.xy_mm[0, 1])

    @property
    def length_mm(self) -> float:
        """How far the head travelled along the line, mm."""
        return self.travel_mm

    @property
    def duration_s(self) -> float:
        """Length of the motion, Z moves included, s."""
        return (len(self.xy_mm) + 2 * len(self._plunge())) / self.rate_hz

    def __iter__(self) -> Iterator[Motion]:
        """Blocks of Motion: down, along the line, up."""
        down = self._plunge()
        first = 0
        for block in (
            _standing(self.xy_mm[0], down),
            *self._along_the_line(),
            _standing(self.xy_mm[-1], down[::-1]),
        ):
            yield Motion(block, self.rate_hz, first / self.rate_hz)
            first += len(block)

    def _along_the_line(self) -> Iterator[Array]:
        """The line at depth, in blocks (n, 3) mm."""
        for first in range(0, len(self.xy_mm), BLOCK_SAMPLES):
            part = self.xy_mm[first : first + BLOCK_SAMPLES]
            yield np.column_stack([part, np.full(len(part), -self.work.depth_mm)])

    def _plunge(self) -> Array:
        """Z of the move from clearance to depth: up to the feed at constant acceleration, and down again; mm at the motion rate."""
        w = self.work
        way = w.clearance_mm + w.depth_mm
        feed = min(w.feed_mm_s, math.sqrt(w.acceleration_mm_s2 * way))
        rise_s = feed / w.acceleration_mm_s2
        total_s = way / feed + rise_s
        t = np.arange(math.ceil(total_s * self.rate_hz) + 1) / self.rate_hz
        up = np.minimum(t, rise_s)
        down = np.clip(t - (total_s - rise_s), 0.0, rise_s)
        gone = (
            0.5 * w.acceleration_mm_s2 * up**2 + feed * np.maximum(t - rise_s, 0) - 0.5 * w.acceleration_mm_s2 * down**2
        )
        late = t >= total_s
        gone[late] = way
        return w.clearance_mm - gone


def trace(
    drawing: Drawing,
    start_mm: tuple[float, float] | None = None,
    settings: Settings | None = None,
    work: Work | None = None,
    progress: Callable[[float, float], None] | None = None,
) -> Trace:
    """Follow a line of the drawing: the one at `start_mm` (sheet mm), or the longest.

    `progress` hears how far the head has come and the length of the line, mm. Raises LineFault if there is no line to start on; a line that is lost on
    the way is no exception, but the trace's `fault`.
    """
    settings, work = settings or Settings(), work or Work()
    best: Followed | None = None
    stances = put_down(drawing, start_mm, settings.aperture_mm, settings.line_width_mm, settings.gap_mm)
    for stance, length_mm in stances:
        told = None if progress is None else partial(_tell, progress, length_mm)
        run = _all_of_it(stance, settings, _longest_mm(drawing, stance.view.width_mm), told)
        best = run if best is None or run.travel_mm > best.travel_mm else best
        if run.ending == "closed" or run.travel_mm > 0.5 * length_mm:
            break
    assert best is not None  # put_down gives a stance, or raises
    return Trace(best.positions_mm, best.ending, best.view.width_mm, best.travel_mm, best.fault, work)


def _longest_mm(drawing: Drawing, width_mm: float) -> float:
    """How far a run may go before it is going round in circles: four times all the ink."""
    return 4 * float(np.count_nonzero(drawing.darkness > INK)) * drawing.pitch_mm**2 / width_mm + 20


def _tell(progress: Callable[[float, float], None], length_mm: float, come_mm: float) -> None:
    progress(min(come_mm, length_mm), length_mm)


def _all_of_it(stance: Stance, settings: Settings, longest_mm: float, told: Callable[[float], None] | None) -> Followed:
    """Follow a line from a stance: either way round, an open one from end to end, and one that does not come back with other turns."""
    run = Follower(stance, settings, MOTION_RATE_HZ).follow(longest_mm, told)
    if stance.at_end or (run.ending == "closed" and run.junctions == 0):
        return run
    round_about = replace(stance, heading_rad=math.remainder(stance.heading_rad + math.pi, math.tau))
    other = Follower(round_about, settings, MOTION_RATE_HZ).follow(longest_mm)
    if run.ending == "closed":
        return other if other.ending == "closed" and other.travel_mm < SHORTER * run.travel_mm else run
    if other.ending == "closed":
        return other
    if run.ending == "ended":
        back = turned_round(run.positions_mm[-1], run.heading_rad, run.view)
        return max(run, Follower(back, settings, MOTION_RATE_HZ).follow(longest_mm, told), key=lambda r: r.travel_mm)
    if run.ending == "joined":
        return _with_other_turns(stance, settings, longest_mm, run)
    return run


def _with_other_turns(stance: Stance, settings: Settings, longest_mm: float, run: Followed) -> Followed:
    """The shortest run that closes because it takes another turn at one junction, or else at two; else the run as it was."""
    places = range(min(run.junctions, TURNS))
    for turns in ([(k,) for k in places], list(combinations(places, 2))):
        others = [Follower(stance, settings, MOTION_RATE_HZ, t).follow(longest_mm) for t in turns]
        closed = [other for other in others if other.ending == "closed"]
        if closed:
            return min(closed, key=lambda other: other.travel_mm)
    return run


def _standing(xy_mm: Array, z_mm: Array) -> Array:
    """X and Y stand while Z moves, (n, 3) mm."""
    return np.column_stack([np.tile(xy_mm, (len(z_mm), 1)), z_mm])
