"""The passes: how a line is cut at each of its depths, from where its program begins to where it ends.

Signals: a line, what the operator does along it and its holding tabs in; positions of X, Y, Z out, in blocks
(n, 3) mm at the motion rate.

A line of several passes is run at each depth: a closed one straight on from its end, another one from its
start again, with the tool up on the way (see `line_cut`). The marks stop the head on the first pass. The
lead-in of a cut is run on the first pass, its lead-out on the last. From a lead line's loop the tool goes
back along the lead line, and so to the reference point, as it came.

Source: patent ES 361967, section on use; the Z moves are the Z unit's (see `zunit`), and when they are made
is the operator's (see `operator`).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.usual import ACCELERATION_MM_S2
from morfax.tracer.following.line import Line
from morfax.tracer.operator.operator import Operator
from morfax.tracer.operator.work import Action, Work
from morfax.tracer.operator.zunit import QuillMove
from morfax.tracer.program.passes import braking
from morfax.tracer.program.passes.line_cut import LineCut
from morfax.tracer.program.passes.tabs import Tab
from morfax.tracer.program.passes.tool_height import PlaceMm, at_height, rapid, standing


@dataclass(frozen=True, slots=True)
class Passes:
    """How lines are cut: the operator, and the motion rate."""

    operator: Operator
    rate_hz: float

    @property
    def work(self) -> Work:
        """How deep the tool goes, and how fast."""
        return self.operator.work

    def along(
        self, line: Line, actions: Sequence[Action], tabs: Sequence[Tab] = ()
    ) -> Iterator[Array]:
        """From where a line's program begins to where it ends, at each depth, in blocks (n, 3) mm."""
        if line.begin_mm != line.start_mm:
            yield self.rapid(line.begin_mm, line.start_mm)
        at = np.array([*line.start_mm, self.work.clearance_mm])
        for block in LineCut(line, self.operator, actions, tabs, self.rate_hz).passes():
            yield block
            at = block[-1]
        if at[2] != self.work.clearance_mm:
            up = QuillMove(self.work.clearance_mm, self.work.feed_mm_s)
            yield standing(self.work, at[:2], float(at[2]), [up], self.rate_hz)
        yield from self._home(line, at[:2])

    def rapid(self, start_mm: PlaceMm, end_mm: PlaceMm) -> Array:
        """Straight from a place to another at clearance, (n, 3) mm."""
        return rapid(self.work, start_mm, end_mm, self.rate_hz)

    def _home(self, line: Line, at_mm: Array) -> Iterator[Array]:
        """Back along a lead or guide line, and to its reference point, at clearance, (n, 3) mm."""
        if not line.goes_back:
            if np.any(at_mm != line.xy_mm[-1]):
                yield self.rapid(at_mm, line.xy_mm[-1])
            return
        last = len(line.xy_mm) - 1 if line.loop_from is None else line.loop_from
        back = np.vstack(line.without_guides(0, last))[::-1]
        yield self.rapid(at_mm, back[0])  # a loop does not end just where it began
        way = braking.run(back, self.work.rapid_mm_s, ACCELERATION_MM_S2, self.rate_hz)
        yield at_height(way, self.work.clearance_mm)
        if line.begin_mm != line.start_mm:
            yield self.rapid(line.start_mm, line.begin_mm)
