"""The passes: one line cut at each of its depths, from where its program begins to where it ends.

Signals: a line and what the operator does along it in; positions of X, Y, Z out, in blocks (n, 3) mm at the
motion rate.

A line of several passes is run at each depth: a closed one straight on from its end, another one from its
start again, with the tool up on the way. The marks stop the head on the first pass. The lead-in of a cut is
run on the first pass, its lead-out on the last. From a lead line's loop the tool goes back along the lead
line, and so to the reference point, as it came.

Source: patent ES 361967, section on use; the Z moves are the Z unit's (see `zunit`), and when they are made
is the operator's (see `operator`).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import zip_longest

import numpy as np

from morfax.motion import ramp
from morfax.motion.arrays import Array
from morfax.motion.motion import BLOCK_SAMPLES
from morfax.motion.polyline import lengths_mm
from morfax.tracer.following.line import Line
from morfax.tracer.operator.operator import Operator
from morfax.tracer.operator.work import Action, Entry, Work
from morfax.tracer.operator.zunit import Move, z_moves
from morfax.tracer.program import braking

BRAKE_MM_S2 = 500.0  # of X and Y, as the head's own

PlaceMm = Array | tuple[float, float]


@dataclass(frozen=True, slots=True)
class Passes:
    """How lines are cut: the operator, and the motion rate."""

    operator: Operator
    rate_hz: float

    @property
    def work(self) -> Work:
        """How deep the tool goes, and how fast."""
        return self.operator.work

    def along(self, line: Line, actions: Sequence[Action]) -> Iterator[Array]:
        """From where a line's program begins to where it ends, at each depth, in blocks (n, 3) mm."""
        if line.begin_mm != line.start_mm:
            yield self.rapid(line.begin_mm, line.start_mm)
        at = np.array([*line.start_mm, self.work.clearance_mm])
        depths_mm = self.operator.depths_mm(actions)
        # 1. the first pass, with what is done on the way; a lead-out waits for the last pass
        end = len(line.xy_mm) - 1
        first_to = line.last if len(depths_mm) > 1 or _enters(actions) else end
        for block in self._first_pass(line, actions, first_to):
            yield block
            at = block[-1]
        # 2. further passes, or once more where the tool went down on the way
        if at[2] < 0:
            for block in self._further(line, actions, depths_mm, float(at[2])):
                yield block
                at = block[-1]
        if first_to < end:
            lead_out = self._from_rest(line, first_to, end)
            yield _at(lead_out, float(at[2]))
            at = np.array([*lead_out[-1], at[2]])
        # 3. up, and back to where the program ends
        if at[2] != self.work.clearance_mm:
            yield _standing(at[:2], self._z(float(at[2]), self.work.clearance_mm))
        yield from self._home(line, at[:2])

    def rapid(self, start_mm: PlaceMm, end_mm: PlaceMm) -> Array:
        """Straight from a place to another at clearance, (n, 3) mm."""
        way = ramp.positions_mm(start_mm, end_mm, self.work.rapid_mm_s, rate_hz=self.rate_hz)
        return _at(way, self.work.clearance_mm)

    def _first_pass(self, line: Line, actions: Sequence[Action], to: int) -> Iterator[Array]:
        """Along a line to a position, with what is done on the way, (n, 3) mm."""
        z_mm, entry, come_mm = self.work.clearance_mm, None, 0.0
        halts = [*(action.halt.at for action in actions), to]
        pieces = braking.pieces(line.xy_mm, halts, BRAKE_MM_S2, self.rate_hz)[: len(halts)]
        for piece, action in zip_longest(pieces, actions):
            for block in _blocks(piece):
                along_mm = np.full(len(block), z_mm)
                if entry is not None:
                    along_mm, come_mm = _entered(block, entry, come_mm)
                z_mm = float(along_mm[-1])
                yield _at(block, along_mm)
            if action is not None:
                acceleration_mm_s2 = self.work.acceleration_mm_s2
                moves_mm = z_moves(z_mm, action.moves, acceleration_mm_s2, self.rate_hz)
                yield _standing(piece[-1], moves_mm)
                z_mm, entry, come_mm = action.moves[-1].to_mm, action.entry, 0.0

    def _further(
        self, line: Line, actions: Sequence[Action], depths_mm: Sequence[float], z_mm: float
    ) -> Iterator[Array]:
        """What is cut after the first pass, (n, 3) mm."""
        if len(depths_mm) == 1:
            yield from self._where_it_entered(line, actions)
        for depth_mm in depths_mm[1:]:
            yield from self._again(line, z_mm, depth_mm)
            z_mm = -depth_mm

    def _where_it_entered(self, line: Line, actions: Sequence[Action]) -> Iterator[Array]:
        """Once more at depth along the piece of a closed line where the tool went down, (n, 3) mm.

        A line with leads is run once more whole, so that it ends where its lead-out begins.
        """
        down = next((action for action in actions if action.entry is not None), None)
        if down is None or down.entry is None or not _comes_round(line):
            return
        first, lengths = line.first, lengths_mm(line.xy_mm)
        down_mm = np.interp(down.halt.at, range(len(lengths)), lengths)
        last = int(np.searchsorted(lengths, down_mm + down.entry.length_mm))
        if last <= first:
            return
        z_mm = -down.entry.depth_mm
        last = line.last if line.leads is not None else min(last, line.last)
        yield _at(self._feed(line.xy_mm[line.last], line.xy_mm[first]), z_mm)
        yield _at(self._from_rest(line, first, last), z_mm)

    def _again(self, line: Line, z_mm: float, depth_mm: float) -> Iterator[Array]:
        """Along a line, or its loop, once more at another depth, (n, 3) mm: straight on, or up and over."""
        xy_mm = self._from_rest(line, line.first, line.last)
        if _comes_round(line):
            yield _at(self._feed(xy_mm[-1], xy_mm[0]), z_mm)
        else:
            yield _standing(xy_mm[-1], self._z(z_mm, self.work.clearance_mm))
            z_mm = self.work.clearance_mm
            yield self.rapid(xy_mm[-1], xy_mm[0])
        yield _standing(xy_mm[0], self._z(z_mm, -depth_mm))
        for block in _blocks(xy_mm):
            yield _at(block, -depth_mm)

    def _from_rest(self, line: Line, first: int, last: int) -> Array:
        """Along a line without its guide lines, from rest to rest, (n, 2) mm.

        Where the head took a guide line it came back some um aside: straight over.
        """
        parts, before = list[Array](), None
        for way in line.without_guides(first, last):
            ends = [0, len(way) - 1]
            stretch = braking.pieces(way, ends, BRAKE_MM_S2, self.rate_hz)[1]
            if before is not None:
                parts.append(self._feed(before[-1], stretch[0]))
            parts.append(stretch)
            before = stretch
        return np.vstack(parts)

    def _feed(self, start_mm: Array, end_mm: Array) -> Array:
        """Straight from a place to another in the work, (n, 2) mm."""
        return ramp.positions_mm(start_mm, end_mm, self.work.feed_mm_s, rate_hz=self.rate_hz)

    def _home(self, line: Line, at_mm: Array) -> Iterator[Array]:
        """Back along a lead or guide line, and to its reference point, at clearance, (n, 3) mm."""
        if not line.goes_back:
            if np.any(at_mm != line.xy_mm[-1]):
                yield self.rapid(at_mm, line.xy_mm[-1])
            return
        last = len(line.xy_mm) - 1 if line.loop_from is None else line.loop_from
        back = np.vstack(line.without_guides(0, last))[::-1]
        yield self.rapid(at_mm, back[0])  # a loop does not end just where it began
        way = braking.run(back, self.work.rapid_mm_s, BRAKE_MM_S2, self.rate_hz)
        yield _at(way, self.work.clearance_mm)
        if line.begin_mm != line.start_mm:
            yield self.rapid(line.start_mm, line.begin_mm)

    def _z(self, from_mm: float, to_mm: float) -> Array:
        """Z of a move that the Z unit makes, (n,) mm at the motion rate."""
        move = Move(to_mm, self.work.feed_mm_s)
        return z_moves(from_mm, [move], self.work.acceleration_mm_s2, self.rate_hz)


def _comes_round(line: Line) -> bool:
    """Whether the end of a line is its beginning, or that of its loop."""
    return line.ending == "closed" or line.is_lead


def _enters(actions: Sequence[Action]) -> bool:
    """Whether the tool goes down into a line while it moves."""
    return any(action.entry is not None for action in actions)


def _blocks(xy_mm: Array) -> Iterator[Array]:
    """Positions in blocks."""
    for first in range(0, len(xy_mm), BLOCK_SAMPLES):
        yield xy_mm[first : first + BLOCK_SAMPLES]


def _at(xy_mm: Array, z_mm: float | Array) -> Array:
    """X and Y move while Z stands, or moves with them, (n, 3) mm."""
    return np.column_stack([xy_mm, np.broadcast_to(z_mm, len(xy_mm))])


def _entered(xy_mm: Array, entry: Entry, come_mm: float) -> tuple[Array, float]:
    """Z along a piece (n, 2) mm of the way on which the tool goes down, (n,) mm, and how far it has come.

    Z is smooth at both ends: 3s² - 2s³.
    """
    lengths = come_mm + lengths_mm(xy_mm)
    share = np.minimum(lengths / entry.length_mm, 1.0)
    return -entry.depth_mm * share**2 * (3 - 2 * share), float(lengths[-1])


def _standing(xy_mm: Array, z_mm: Array) -> Array:
    """X and Y stand while Z moves, (n, 3) mm."""
    return np.column_stack([np.tile(xy_mm, (len(z_mm), 1)), z_mm])
