"""The cut of one line: the line run at each of its depths, down ramps and over tabs.

Signals: a line, what the operator does along it and its holding tabs in; positions of X, Y, Z out, in blocks
(n, 3) mm at the motion rate.

    closed line   Z  ──╲                  ┆ once more     down along the line, round and round if need be,
                        ╲_________________┆______         and once more where it was not yet deep
    open line     Z  ──╲╱╲╱______________________         to and fro where the tool goes down

On a closed line, too, the tool goes to and fro if the head stops on the ramp. At a tab X and Y stand while Z
goes up, and again while it goes down. On a slope X and Y run no faster than Z with its feed.

Source: patent ES 361967, section on use, for the passes; ramps and tabs are our own, as in CAM.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from functools import cached_property

from morfax.motion import ramp
from morfax.motion.arrays import Array
from morfax.motion.faults import MotionFault
from morfax.motion.long_array import released
from morfax.motion.motion import BLOCK_SAMPLES
from morfax.motion.usual import ACCELERATION_MM_S2
from morfax.tracer.following.line import Line
from morfax.tracer.operator.operator import Operator
from morfax.tracer.operator.work import Action, Descent
from morfax.tracer.operator.zunit import QuillMove
from morfax.tracer.program.passes import braking
from morfax.tracer.program.passes.tabs import Tab
from morfax.tracer.program.passes.tool_height import (
    ToolHeight,
    at_height,
    rapid,
    slowed,
    standing,
)
from morfax.tracer.program.passes.way import Rest, Way, in_order

SHORTEST_MM = 0.1  # in which the tool goes to and fro down a ramp: less is no way


class LineCut:
    """One line as it is cut: how high the tool is, and what is not yet cut at depth."""

    def __init__(
        self,
        line: Line,
        operator: Operator,
        actions: Sequence[Action],
        tabs: Sequence[Tab],
        rate_hz: float,
    ) -> None:
        self.line, self.actions, self.tabs, self.rate_hz = line, actions, tabs, rate_hz
        self.work = operator.work
        self.depths_mm = operator.depths_mm(actions)
        self.tool = ToolHeight(self.work.clearance_mm)
        self.top_mm = -math.inf
        if self.work.tabs is not None:
            self.top_mm = self.work.tabs.height_mm - self.depths_mm[-1]
        # the position up to which the loop is not yet deep: there the tool went down a slope
        self.shallow_to: float | None = None

    @cached_property
    def whole(self) -> Way:
        """The way along the line; asked for where the tool goes down on its way."""
        return Way.whole(self.line)

    @cached_property
    def loop(self) -> Way:
        """The way along the loop; asked for as well where the tool goes down on its way."""
        return Way.loop(self.line)

    def passes(self) -> Iterator[Array]:
        """The line at each of its depths, up to where the tool goes up, (n, 3) mm."""
        # 1. the first pass, with what is done on the way; a lead-out waits for the last pass
        line, end = self.line, len(self.line.xy_mm) - 1
        enters = any(action.entry is not None for action in self.actions)
        first_to = line.last if len(self.depths_mm) > 1 or enters else end
        yield from self._first_pass(first_to)
        # 2. further passes, and once more where the tool went down on the way
        if self.tool.z_mm < 0:
            yield from self._on_down()
            for depth_mm in self.depths_mm[1:]:
                yield from self._again(depth_mm)
            yield from self._where_it_went_down()
        # 3. the lead-out
        if first_to < end:
            out_mm = line.xy_mm[first_to:]
            yield from self._pieces(self._resting(out_mm, [0, len(out_mm) - 1])[1:2])

    def _first_pass(self, last: int) -> Iterator[Array]:
        """Along the line to a position, with what is done on the way, (n, 3) mm."""
        rests = [Rest(action.halt.at, action) for action in self.actions]
        lowest_mm = min((action.z_mm for action in self.actions), default=math.inf)
        rests += self._tab_rests(lowest_mm)
        down = next((action for action in self.actions if action.entry is not None), None)
        if down is not None and down.entry is not None and self._goes_round(down):
            begin_mm = self.whole.mm_at(down.halt.at)
            rests += self._slope_rests(down.entry, self.whole, begin_mm)
            self.shallow_to = self.whole.position(begin_mm + down.entry.length_mm)
        rests = in_order(rests, last)
        pieces = self._resting(self.line.xy_mm, [rest.at for rest in rests])
        yield from self._pieces(pieces[:-1], rests, lambda: self.whole)

    def _on_down(self) -> Iterator[Array]:
        """Further rounds of a closed line until the tool is at the end of its slope, (n, 3) mm."""
        if not self.line.comes_round:
            self.tool.go_down(None)
        while self.tool.entry is not None:
            yield from self._back_to_start()
            yield from self._round(self.line.last)

    def _again(self, depth_mm: float) -> Iterator[Array]:
        """Along the line, or its loop, once more at another depth, (n, 3) mm: straight on, or up and over."""
        begin_mm, end_mm = self.line.xy_mm[self.line.first], self.line.xy_mm[self.line.last]
        was_mm, self.shallow_to = self.tool.z_mm, None
        entry = self.work.ramp(-was_mm, depth_mm)
        if self.line.comes_round:
            yield from self._back_to_start()
            if entry is None:
                yield from self._z_to(begin_mm, -depth_mm)
            self.tool.go_down(entry)
        else:
            yield from self._z_to(end_mm, self.work.clearance_mm)
            yield rapid(self.work, end_mm, begin_mm, self.rate_hz)
            yield from self._z_to(begin_mm, -depth_mm if entry is None else was_mm)
            if entry is not None:
                yield from self._to_and_fro(self.line.first, entry)
        yield from self._round(self.line.last)
        yield from self._on_down()

    def _where_it_went_down(self) -> Iterator[Array]:
        """Once more at depth along the piece of a closed line where the tool went down, (n, 3) mm.

        A line with leads is run once more whole, so that it ends where its lead-out begins.
        """
        line = self.line
        if self.shallow_to is None or not line.comes_round:
            return
        last = line.last
        if line.leads is None:
            last = min(math.ceil(self.shallow_to), last)
            last = min([last, *(int(tab.first) for tab in self.tabs if tab.last >= last)])
        if last > line.first and self.shallow_to > line.first:
            yield from self._back_to_start()
            yield from self._round(last)

    def _round(self, last: int) -> Iterator[Array]:
        """Along the loop to a position, from rest to rest, (n, 3) mm.

        Where the head took a guide line it came back some um aside: straight over.
        """
        line, tool = self.line, self.tool
        slope, come_mm = tool.entry, tool.come_mm
        rests = self._tab_rests(tool.z_mm if slope is None else -slope.depth_mm)
        if slope is not None:
            rests += self._slope_rests(slope, self.loop, -come_mm)
        before: Array | None = None
        for a, b in line.ranges(line.first, last):
            here = in_order([rest for rest in rests if rest.at >= a], b - 1)
            pieces = self._resting(line.xy_mm[a:b], [0, *(rest.at - a for rest in here)])
            if before is not None:
                yield from self._piece(self._straight(before, line.xy_mm[a]), 0.0)
            yield from self._pieces(pieces[1:-1], here, lambda: self.loop, a)
            before = line.xy_mm[b - 1]
        if slope is not None and tool.entry is None:
            self.shallow_to = self.loop.position(slope.length_mm - come_mm)

    def _pieces(
        self,
        pieces: Sequence[Array],
        rests: Sequence[Rest] = (),
        way: Callable[[], Way] | None = None,
        at: float = 0.0,
    ) -> Iterator[Array]:
        """Pieces (n, 2) mm of a way from a position on, with what is done at the end of each,
        (n, 3) mm.
        """
        for k, piece in enumerate(pieces):
            rest, length_mm = rests[k] if k < len(rests) else None, 0.0
            if way is not None and rest is not None:
                if self.tool.entry is not None:  # only a slope asks how long the way is
                    length_mm = way().mm_at(rest.at) - way().mm_at(at)
                at = rest.at
            yield from self._piece(piece, length_mm)
            if rest is not None and rest.tab is not None:
                yield from self._at_tab(piece[-1], rest)
            if rest is not None and rest.action is not None:
                yield from self._act(piece[-1], rest.action)

    def _piece(self, xy_mm: Array, length_mm: float) -> Iterator[Array]:
        """A piece (n, 2) mm that is so long on the line, at the height of the tool, (n, 3) mm."""
        if self.tool.entry is None:
            for first in range(0, len(xy_mm), BLOCK_SAMPLES):
                some = xy_mm[first : first + BLOCK_SAMPLES]
                yield at_height(some, self.tool.along(some, 0.0))
                released(some)
            return
        positions_mm = at_height(xy_mm, self.tool.along(xy_mm, length_mm))
        positions_mm = slowed(positions_mm, self.work.feed_mm_s, self.rate_hz)
        for first in range(0, len(positions_mm), BLOCK_SAMPLES):
            yield positions_mm[first : first + BLOCK_SAMPLES]

    def _act(self, place_mm: Array, action: Action) -> Iterator[Array]:
        """What the operator does at a halt, (n, 3) mm."""
        yield standing(self.work, place_mm, self.tool.z_mm, action.moves, self.rate_hz)
        self.tool.z_mm = action.moves[-1].to_mm
        if action.entry is None or self._goes_round(action):
            self.tool.go_down(action.entry)
        else:
            yield from self._to_and_fro(action.halt.at, action.entry)

    def _goes_round(self, down: Action) -> bool:
        """Whether the tool goes down on its way round: nothing is done there before it is down.

        A smooth entry is run on the way in any case.
        """
        entry = down.entry
        if entry is None or not entry.is_straight:
            return True
        ends_mm = self.whole.mm_at(down.halt.at) + entry.length_mm
        after = [action.halt.at for action in self.actions if action.halt.at > down.halt.at]
        return self.line.comes_round and all(self.whole.mm_at(at) > ends_mm for at in after)

    def _to_and_fro(self, at: float, entry: Descent) -> Iterator[Array]:
        """Down a ramp to and fro between a position and the next at which something is done, (n, 3) mm."""
        line = self.line
        others = [action.halt.at for action in self.actions]
        others += [*(tab.first for tab in self.tabs), *(guide.leave for guide in line.guides)]
        until = min([line.last, *(other for other in others if other > at)])
        begin_mm = self.whole.mm_at(at)
        room_mm = self.whole.mm_at(until) - begin_mm
        if room_mm < SHORTEST_MM:
            x, y = line.place(at)
            raise MotionFault(
                f"the tool has {room_mm:.2f} mm to go down a ramp at {x:.1f},{y:.1f} mm, and needs"
                f" {SHORTEST_MM:g} mm; leave out --ramp, or move what comes next"
            )
        strokes = 2 * math.ceil(entry.length_mm / (2 * room_mm))
        stroke_mm = entry.length_mm / strokes
        end = self.whole.position(begin_mm + stroke_mm)
        forth = self._resting(line.xy_mm, [at, end])[1]
        self.tool.go_down(entry)
        for k in range(strokes):
            yield from self._piece(forth[::-1] if k % 2 else forth, stroke_mm)
        self.tool.go_down(None)

    def _at_tab(self, place_mm: Array, rest: Rest) -> Iterator[Array]:
        """Up on a tab, or down from it, (n, 3) mm."""
        tool = self.tool
        heights_mm = tool.z_mm, self.top_mm
        tool.top_mm = self.top_mm if rest.tab == "first" else None
        from_mm, to_mm = heights_mm if rest.tab == "first" else heights_mm[::-1]
        if tool.z_mm < self.top_mm:
            move = QuillMove(to_mm, self.work.feed_mm_s)
            yield standing(self.work, place_mm, from_mm, [move], self.rate_hz)

    def _tab_rests(self, lowest_mm: float) -> list[Rest]:
        """The ends of the tabs, where the tool goes lower than their top."""
        if lowest_mm >= self.top_mm:
            return []
        first = [Rest(tab.first, tab="first") for tab in self.tabs]
        return [*first, *(Rest(tab.last, tab="last") for tab in self.tabs)]

    def _slope_rests(self, entry: Descent, way: Way, begin_mm: float) -> list[Rest]:
        """Where a straight slope that begins at a length of a way ends, and where it comes to a tab's top."""
        if not entry.is_straight:
            return []
        down = (-self.top_mm - entry.from_mm) / (entry.depth_mm - entry.from_mm)
        ends = [way.rest(begin_mm + entry.length_mm)]
        if 0 < down < 1:
            met = way.rest(begin_mm + down * entry.length_mm)
            ends += [met for tab in self.tabs if met and tab.first < met.at < tab.last]
        return [rest for rest in ends if rest is not None]

    def _back_to_start(self) -> Iterator[Array]:
        """From the end of a closed line to its beginning, which are some um apart, (n, 3) mm."""
        line = self.line
        way = self._straight(line.xy_mm[line.last], line.xy_mm[line.first])
        yield from self._piece(way, 0.0)

    def _z_to(self, place_mm: Array, z_mm: float) -> Iterator[Array]:
        """To a height while X and Y stand, (n, 3) mm."""
        move = QuillMove(z_mm, self.work.feed_mm_s)
        yield standing(self.work, place_mm, self.tool.z_mm, [move], self.rate_hz)
        self.tool.z_mm = z_mm

    def _straight(self, start_mm: Array, end_mm: Array) -> Array:
        """Straight from a place to another in the work, (n, 2) mm."""
        return ramp.positions_mm(start_mm, end_mm, self.work.feed_mm_s, rate_hz=self.rate_hz)

    def _resting(self, xy_mm: Array, at: Sequence[float]) -> list[Array]:
        """Positions (n, 2) mm cut at some of them, at rest there."""
        return braking.pieces(xy_mm, at, ACCELERATION_MM_S2, self.rate_hz)
