"""A run as the operator makes it: the head put down, the tool down, the line followed, the tool up.

Signals: a Drawing in; out a Trace, which is a stream of Motion (X, Y, Z in sheet mm at the motion rate) and says how the run ended.

    Z  clearance ──╮                           ╭── clearance
       0           │ X, Y stand     X, Y stand │
       -depth      ╰────── the line ───────────╯

The Z moves are the Z unit's (see `zunit`). A line of several passes is run at each depth: a closed one straight on from its end, another one from its start
again, with the tool up on the way. Of several lines each is cut so, and from one to the next the tool goes straight at clearance (see `tour`).

A line that turns out to be open is followed from end to end: the head that was put down on its middle runs to one end first, with nothing recorded, and
begins there. A line that does not come back one way round is tried the other way; one that runs into what has been followed already is tried with
other turns at its junctions, as an operator would.

Source: patent ES 361967, section on use, in its plainest form: down at the start of a line and up at its end.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from functools import partial
from itertools import combinations, pairwise, zip_longest

import numpy as np

from motion import ramp
from motion.faults import LineFault
from motion.motion import BLOCK_SAMPLES, MOTION_RATE_HZ, Motion
from tracer.drawing import Drawing
from tracer.follower import Followed, Follower
from tracer.lines import INK
from tracer.settings import Settings
from tracer.stance import Stance, put_down, turned_round
from tracer.view import Array
from tracer.zunit import ACCELERATION_MM_S2, Move, z_moves

SHORTER = 0.95  # the other way round is the line itself if it is shorter than this: straight on has led elsewhere
TURNS = 12  # junctions at which another turn is tried


ENDINGS = ("lost", "joined", "ended", "closed")  # the one that tells most first


@dataclass(frozen=True, slots=True)
class Work:
    """How deep the tool goes, where it stands above the work between lines, and how fast it goes down and up."""

    depth_mm: float = 5.0
    clearance_mm: float = 2.0
    feed_mm_s: float = 5.0
    acceleration_mm_s2: float = ACCELERATION_MM_S2
    rapid_mm_s: float = 50.0  # from line to line, half of what a tape of 6 kHz and 20 cycles per mm carries
    passes_mm: tuple[float, ...] = ()  # depths at which each line is run before it is run at its depth

    @property
    def depths_mm(self) -> tuple[float, ...]:
        """Depths at which each line is run, one after the other, mm."""
        return (*self.passes_mm, self.depth_mm)


@dataclass(frozen=True, slots=True)
class Line:
    """One line as it was followed: positions (n, 2) mm at the motion rate, how it ended ("closed", "ended", "joined", "lost"), its number on the drawing."""

    xy_mm: Array
    ending: str
    width_mm: float
    length_mm: float
    fault: LineFault | None = None
    number: int = 1

    @classmethod
    def of(cls, run: Followed, number: int = 1) -> Line:
        """What the head did, as a line of the drawing."""
        return cls(run.positions_mm, run.ending, run.view.width_mm, run.travel_mm, run.fault, number)

    @property
    def start_mm(self) -> tuple[float, float]:
        """Where the line was begun, mm."""
        return float(self.xy_mm[0, 0]), float(self.xy_mm[0, 1])


@dataclass(frozen=True, slots=True)
class Trace:
    """What the head did: a stream of Motion over its lines, in the order in which they are cut; `left_out` patches of ink were too short to be lines."""

    lines: tuple[Line, ...]
    work: Work = field(default_factory=Work)
    rate_hz: float = MOTION_RATE_HZ
    left_out: int = 0

    @property
    def xy_mm(self) -> Array:
        """Positions along the lines, one behind the other, (n, 2) mm."""
        return self.lines[0].xy_mm if len(self.lines) == 1 else np.vstack([line.xy_mm for line in self.lines])

    @property
    def ending(self) -> str:
        """How the line ended; of several the ending that tells most: "lost", "joined", "ended", "closed"."""
        return min((line.ending for line in self.lines), key=ENDINGS.index)

    @property
    def fault(self) -> LineFault | None:
        """The fault of the line that was lost; of several the first one's, with the numbers of all that are incomplete."""
        if len(self.lines) == 1:
            return self.lines[0].fault
        lost = [line for line in self.lines if line.fault is not None]
        return _incomplete(lost, len(self.lines)) if lost else None

    @property
    def start_mm(self) -> tuple[float, float]:
        """Where the first line was begun, mm."""
        return self.lines[0].start_mm

    @property
    def line_width_mm(self) -> float:
        """Width of the first line, mm."""
        return self.lines[0].width_mm

    @property
    def length_mm(self) -> float:
        """How far the head travelled along the lines, mm."""
        return sum(line.length_mm for line in self.lines)

    @property
    def idle_mm(self) -> float:
        """How far the tool goes from line to line, mm."""
        return float(sum(np.hypot(*(b.xy_mm[0] - a.xy_mm[-1])) for a, b in pairwise(self.lines)))

    @property
    def duration_s(self) -> float:
        """Length of the motion, Z moves and rapid moves included, s."""
        return sum(len(block) for block in self._blocks()) / self.rate_hz

    def __iter__(self) -> Iterator[Motion]:
        """Blocks of Motion: down, along the line, up, and over to the next."""
        first = 0
        for block in self._blocks():
            yield Motion(block, self.rate_hz, first / self.rate_hz)
            first += len(block)

    def _blocks(self) -> Iterator[Array]:
        """Positions of those blocks, (n, 3) mm."""
        for line, after in zip_longest(self.lines, self.lines[1:]):
            yield from self._cut(line)
            if after is not None:
                yield self._rapid(line, after)

    def _cut(self, line: Line) -> Iterator[Array]:
        """Down, along a line at each depth, and up, in blocks (n, 3) mm; nothing of a line that was never begun."""
        if len(line.xy_mm) < 2:
            return
        z_mm = self.work.clearance_mm
        for depth_mm in self.work.depths_mm:
            if z_mm < 0:
                for block in self._back(line, z_mm):
                    yield block
                    z_mm = float(block[-1, 2])
            yield _standing(line.xy_mm[0], self._z(z_mm, -depth_mm))
            z_mm = -depth_mm
            for first in range(0, len(line.xy_mm), BLOCK_SAMPLES):
                yield _at(line.xy_mm[first : first + BLOCK_SAMPLES], z_mm)
        yield _standing(line.xy_mm[-1], self._z(z_mm, self.work.clearance_mm))

    def _back(self, line: Line, z_mm: float) -> Iterator[Array]:
        """From the end of a line to its start for the next pass, (n, 3) mm: at depth where it closes, else up and over."""
        if line.ending == "closed":
            yield _at(self._over(line, line, self.work.feed_mm_s), z_mm)
        else:
            yield _standing(line.xy_mm[-1], self._z(z_mm, self.work.clearance_mm))
            yield self._rapid(line, line)

    def _rapid(self, line: Line, after: Line) -> Array:
        """Straight from the end of a line to the start of the next at clearance, (n, 3) mm."""
        return _at(self._over(line, after, self.work.rapid_mm_s), self.work.clearance_mm)

    def _over(self, line: Line, after: Line, feed_mm_s: float) -> Array:
        """Straight from the end of a line to the start of the next, (n, 2) mm."""
        return ramp.positions_mm(line.xy_mm[-1], after.xy_mm[0], feed_mm_s, rate_hz=self.rate_hz)

    def _z(self, from_mm: float, to_mm: float) -> Array:
        """Z of a move that the Z unit makes, (n,) mm at the motion rate."""
        return z_moves(from_mm, [Move(to_mm, self.work.feed_mm_s)], self.work.acceleration_mm_s2, self.rate_hz)


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
    run = followed(drawing, start_mm, settings or Settings(), progress)
    return Trace((Line.of(run),), work or Work())


def followed(
    drawing: Drawing,
    start_mm: tuple[float, float] | None,
    settings: Settings,
    progress: Callable[[float, float], None] | None,
) -> Followed:
    """The head's best run along the line at a place, or along the longest."""
    best: Followed | None = None
    stances = put_down(drawing, start_mm, settings.aperture_mm, settings.line_width_mm, settings.gap_mm)
    for stance, length_mm in stances:
        told = None if progress is None else partial(_tell, progress, length_mm)
        run = _all_of_it(stance, settings, _longest_mm(drawing, stance.view.width_mm), told)
        best = run if best is None or run.travel_mm > best.travel_mm else best
        if run.ending == "closed" or run.travel_mm > 0.5 * length_mm:
            break
    assert best is not None  # put_down gives a stance, or raises
    return best


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


def _incomplete(lost: list[Line], lines: int) -> LineFault:
    """The fault of the first of several lines that were lost, with the numbers of all."""
    numbers = ", ".join(str(line.number) for line in lost)
    first = lost[0].fault
    assert first is not None
    which = f"line {numbers} of {lines} is" if len(lost) == 1 else f"lines {numbers} of {lines} are"
    return LineFault(
        f"{which} incomplete, the others are cut; line {lost[0].number}: {first}",
        x_mm=first.x_mm,
        y_mm=first.y_mm,
        heading_rad=first.heading_rad,
    )


def _at(xy_mm: Array, z_mm: float) -> Array:
    """X and Y move while Z stands, (n, 3) mm."""
    return np.column_stack([xy_mm, np.full(len(xy_mm), z_mm)])


def _standing(xy_mm: Array, z_mm: Array) -> Array:
    """X and Y stand while Z moves, (n, 3) mm."""
    return np.column_stack([np.tile(xy_mm, (len(z_mm), 1)), z_mm])
