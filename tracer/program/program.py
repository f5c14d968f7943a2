"""The program: the lines that the head followed, cut one after the other, with the Z moves of the operator.

Signals: lines and what the operator does along them in; out a Trace, which is a stream of Motion (X, Y, Z in
sheet mm at the motion rate).

    Z  clearance ──╮                           ╭── clearance
       0           │ X, Y stand     X, Y stand │
       -depth      ╰────── the line ───────────╯

A line of several passes is run at each depth: a closed one straight on from its end, another one from its
start again, with the tool up on the way; its marks stop the head on the first pass. From one line to the next
the tool goes straight at clearance; from a lead line's loop it goes back along the lead line, and so to the
reference point, as it came.

Source: patent ES 361967, section on use; the Z moves are the Z unit's (see `zunit`), and when they are made
is the operator's (see `operator`).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property
from itertools import pairwise, zip_longest

import numpy as np

from morfax.motion import ramp
from morfax.motion.arrays import Array
from morfax.motion.faults import LineFault
from morfax.motion.motion import BLOCK_SAMPLES, MOTION_RATE_HZ, Motion
from morfax.motion.polyline import lengths_mm
from morfax.tracer.following.line import Line
from morfax.tracer.operator.operator import Operator
from morfax.tracer.operator.work import Action, Entry, Work
from morfax.tracer.operator.zunit import Move, z_moves
from morfax.tracer.program import braking as stops

ENDINGS = ("lost", "joined", "ended", "closed")  # the one that tells most first
BRAKE_MM_S2 = 500.0  # of X and Y, as the head's own


@dataclass(frozen=True)
class Trace:
    """What the head did: a stream of Motion over its lines, in the order in which they are cut.

    `left_out` patches of ink were too short to be lines, and `left_out_mm` of ink is joined to the lines and
    is none.
    """

    lines: tuple[Line, ...]
    operator: Operator = field(default_factory=Operator)
    rate_hz: float = MOTION_RATE_HZ
    left_out: int = 0
    left_out_mm: float = 0.0

    @property
    def work(self) -> Work:
        """How deep the tool goes, and how fast."""
        return self.operator.work

    @property
    def xy_mm(self) -> Array:
        """Positions along the lines, one behind the other, (n, 2) mm."""
        return (
            self.lines[0].xy_mm
            if len(self.lines) == 1
            else np.vstack([line.xy_mm for line in self.lines])
        )

    @property
    def ending(self) -> str:
        """How the line ended; of several the ending that tells most: "lost", "joined", "ended", "closed"."""
        return min((line.ending for line in self.lines), key=ENDINGS.index)

    @property
    def fault(self) -> LineFault | None:
        """The fault of the line that was lost; of several the first one's, with the numbers of all that are
        incomplete.
        """
        lost = [line for line in self.lines if line.fault is not None]
        lines = len({line.number for line in self.lines})  # a cutter may run one in pieces
        return (
            _incomplete(lost, lines) if lost and lines > 1 else lost[0].fault if lost else None
        )

    @property
    def start_mm(self) -> tuple[float, float]:
        """Where the first line was begun, mm."""
        return self.lines[0].start_mm

    @property
    def reference_mm(self) -> tuple[float, float] | None:
        """The reference point from which a line begins, mm; None if none does."""
        return next(
            (line.reference_mm for line in self.lines if line.reference_mm is not None), None
        )

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
        return float(
            sum(np.hypot(*np.subtract(b.begin_mm, a.end_mm)) for a, b in pairwise(self.lines))
        )

    @property
    def duration_s(self) -> float:
        """Length of the motion, Z moves and rapid moves included, s."""
        return sum(len(block) for block in self._blocks()) / self.rate_hz

    @cached_property
    def actions(self) -> list[list[Action]]:
        """What the operator does along each line."""
        return self.operator.actions(self.lines)

    def __iter__(self) -> Iterator[Motion]:
        """Blocks of Motion: down, along the line, up, and over to the next."""
        first = 0
        for block in self._blocks():
            yield Motion(block, self.rate_hz, first / self.rate_hz)
            first += len(block)

    def _blocks(self) -> Iterator[Array]:
        """Positions of those blocks, (n, 3) mm."""
        for line, after, actions in zip_longest(self.lines, self.lines[1:], self.actions):
            if len(line.xy_mm) > 1:  # not one that was never begun
                yield from self._cut(line, actions)
            if after is not None:
                yield self._rapid(line.end_mm, after.begin_mm)

    def _cut(self, line: Line, actions: list[Action]) -> Iterator[Array]:
        """From where a line's program begins to where it ends, at each depth, in blocks (n, 3) mm."""
        if line.begin_mm != line.start_mm:
            yield self._rapid(line.begin_mm, line.start_mm)
        depths_mm, at = (
            self.operator.depths_mm(actions),
            np.array([*line.start_mm, self.work.clearance_mm]),
        )
        for block in self._first_pass(line, actions):
            yield block
            at = block[-1]
        if len(depths_mm) == 1 and at[2] < 0:
            for block in self._where_it_entered(line, actions):
                yield block
                at = block[-1]
        for depth_mm in depths_mm[1:] if at[2] < 0 else ():
            for block in self._again(line, float(at[2]), depth_mm):
                yield block
                at = block[-1]
        if at[2] != self.work.clearance_mm:
            yield _standing(at[:2], self._z(float(at[2]), self.work.clearance_mm))
        yield from self._home(line, at[:2])

    def _first_pass(self, line: Line, actions: list[Action]) -> Iterator[Array]:
        """Along a line, with what is done on the way, (n, 3) mm."""
        z_mm, entry, come_mm = self.work.clearance_mm, None, 0.0
        halts = [*(action.halt.at for action in actions), len(line.xy_mm) - 1]
        pieces = stops.pieces(line.xy_mm, halts, BRAKE_MM_S2, self.rate_hz)[: len(halts)]
        for piece, action in zip_longest(pieces, actions):
            for first in range(0, len(piece), BLOCK_SAMPLES):
                block = piece[first : first + BLOCK_SAMPLES]
                along_mm, come_mm = (
                    (np.full(len(block), z_mm), 0.0)
                    if entry is None
                    else _entered(block, entry, come_mm)
                )
                z_mm = float(along_mm[-1])
                yield _at(block, along_mm)
            if action is not None:
                yield _standing(
                    piece[-1],
                    z_moves(z_mm, action.moves, self.work.acceleration_mm_s2, self.rate_hz),
                )
                z_mm, entry, come_mm = action.moves[-1].to_mm, action.entry, 0.0

    def _where_it_entered(self, line: Line, actions: list[Action]) -> Iterator[Array]:
        """Once more at depth along that piece of a closed line along which the tool went down, (n, 3) mm."""
        down = next((action for action in actions if action.entry is not None), None)
        if down is None or down.entry is None or not (line.ending == "closed" or line.is_lead):
            return
        first = line.loop_from if line.is_lead and line.loop_from is not None else 0
        lengths = lengths_mm(line.xy_mm)
        last = int(
            np.searchsorted(
                lengths,
                np.interp(down.halt.at, range(len(lengths)), lengths) + down.entry.length_mm,
            )
        )
        if last <= first:
            return
        yield _at(self._feed(line.xy_mm[-1], line.xy_mm[first]), -down.entry.depth_mm)
        yield _at(
            self._from_rest(line, first, min(last, len(line.xy_mm) - 1)), -down.entry.depth_mm
        )

    def _again(self, line: Line, z_mm: float, depth_mm: float) -> Iterator[Array]:
        """Along a line, or the loop that it leads to, once more at another depth, (n, 3) mm: straight on
        where it closes, else up and over.
        """
        xy_mm = self._from_rest(
            line, (line.loop_from or 0) if line.is_lead else 0, len(line.xy_mm) - 1
        )
        if line.ending == "closed" or line.is_lead:
            yield _at(self._feed(xy_mm[-1], xy_mm[0]), z_mm)
        else:
            yield _standing(xy_mm[-1], self._z(z_mm, self.work.clearance_mm))
            z_mm = self.work.clearance_mm
            yield self._rapid(xy_mm[-1], xy_mm[0])
        yield _standing(xy_mm[0], self._z(z_mm, -depth_mm))
        for first in range(0, len(xy_mm), BLOCK_SAMPLES):
            yield _at(xy_mm[first : first + BLOCK_SAMPLES], -depth_mm)

    def _from_rest(self, line: Line, first: int, last: int) -> Array:
        """Along a line without its guide lines, from rest to rest, (n, 2) mm: where it left for one it came
        back some um aside.
        """
        stretches = [
            stops.pieces(way, [0, len(way) - 1], BRAKE_MM_S2, self.rate_hz)[1]
            for way in line.without_guides(first, last)
        ]
        between = [self._feed(a[-1], b[0]) for a, b in pairwise(stretches)]
        return np.vstack(
            [
                part
                for pair in zip_longest(stretches, between)
                for part in pair
                if part is not None
            ]
        )

    def _feed(self, start_mm: Array, end_mm: Array) -> Array:
        """Straight from a place to another in the work, (n, 2) mm."""
        return ramp.positions_mm(start_mm, end_mm, self.work.feed_mm_s, rate_hz=self.rate_hz)

    def _home(self, line: Line, at_mm: Array) -> Iterator[Array]:
        """Back along a lead or guide line to where it began, and to the reference point, at clearance, (n, 3)
        mm.
        """
        if not line.goes_back:
            if np.any(at_mm != line.xy_mm[-1]):
                yield self._rapid(at_mm, line.xy_mm[-1])
            return
        last = len(line.xy_mm) - 1 if line.loop_from is None else line.loop_from
        back = np.vstack(line.without_guides(0, last))[::-1]
        yield self._rapid(at_mm, back[0])  # a loop does not end just where it began
        yield _at(
            stops.run(back, self.work.rapid_mm_s, BRAKE_MM_S2, self.rate_hz),
            self.work.clearance_mm,
        )
        if line.begin_mm != line.start_mm:
            yield self._rapid(line.start_mm, line.begin_mm)

    def _rapid(
        self, start_mm: Array | tuple[float, float], end_mm: Array | tuple[float, float]
    ) -> Array:
        """Straight from a place to another at clearance, (n, 3) mm."""
        way = ramp.positions_mm(start_mm, end_mm, self.work.rapid_mm_s, rate_hz=self.rate_hz)
        return _at(way, self.work.clearance_mm)

    def _z(self, from_mm: float, to_mm: float) -> Array:
        """Z of a move that the Z unit makes, (n,) mm at the motion rate."""
        return z_moves(
            from_mm,
            [Move(to_mm, self.work.feed_mm_s)],
            self.work.acceleration_mm_s2,
            self.rate_hz,
        )


def _incomplete(lost: list[Line], lines: int) -> LineFault:
    """The fault of the first of several lines that were lost, with the numbers of all."""
    numbers = ", ".join(str(line.number) for line in lost)
    first = lost[0].fault
    assert first is not None
    which = (
        f"line {numbers} of {lines} is" if len(lost) == 1 else f"lines {numbers} of {lines} are"
    )
    return LineFault(
        f"{which} incomplete, the others are cut; line {lost[0].number}: {first}",
        x_mm=first.x_mm,
        y_mm=first.y_mm,
        heading_rad=first.heading_rad,
    )


def _at(xy_mm: Array, z_mm: float | Array) -> Array:
    """X and Y move while Z stands, or moves with them, (n, 3) mm."""
    return np.column_stack([xy_mm, np.broadcast_to(z_mm, len(xy_mm))])


def _entered(xy_mm: Array, entry: Entry, come_mm: float) -> tuple[Array, float]:
    """Z along a piece (n, 2) mm of the way on which the tool goes down, (n,) mm, and how far it has come
    then: smooth at both ends, 3s² - 2s³.
    """
    lengths = come_mm + lengths_mm(xy_mm)
    share = np.minimum(lengths / entry.length_mm, 1.0)
    return -entry.depth_mm * share**2 * (3 - 2 * share), float(lengths[-1])


def _standing(xy_mm: Array, z_mm: Array) -> Array:
    """X and Y stand while Z moves, (n, 3) mm."""
    return np.column_stack([np.tile(xy_mm, (len(z_mm), 1)), z_mm])
