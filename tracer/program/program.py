"""The program: the lines that the head followed, cut one after the other, with the Z moves of the operator.

Signals: lines and what the operator does along them in; out a Trace, which is a stream of Motion (X, Y, Z in
sheet mm at the motion rate).

    Z  clearance ──╮                           ╭── clearance
       0           │ X, Y stand     X, Y stand │
       -depth      ╰────── the line ───────────╯

Each line is cut at its depths (see `passes`); from one line to the next the tool goes straight at clearance.

Source: patent ES 361967, section on use.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property
from itertools import pairwise, zip_longest
from typing import TYPE_CHECKING

import numpy as np

from morfax.motion.by_number import listed
from morfax.motion.faults import LineFault
from morfax.motion.median import weighted_median
from morfax.motion.motion import MOTION_RATE_HZ, Motion
from morfax.tracer.operator.operator import Operator
from morfax.tracer.program.lines.selection import NO_OTHERS, Others
from morfax.tracer.program.passes.passes import Passes
from morfax.tracer.program.passes.tabs import Tab, tabs_of

if TYPE_CHECKING:
    from morfax.motion.arrays import Array
    from morfax.tracer.following.line import Line
    from morfax.tracer.ink.ledger import Balance
    from morfax.tracer.operator.work import Action, Work
    from morfax.tracer.program.against_ink.unexplained import Unexplained
    from morfax.tracer.program.lines.lost_outlines import LostOutline
    from morfax.tracer.program.lines.small_rings import SmallPatch

ENDINGS = ("lost", "joined", "ended", "closed")  # the one to be told first comes first


@dataclass(frozen=True)
class Trace:
    """What the head did: a stream of Motion over its lines, in the order in which they are cut.

    `left_out` patches of ink were too short to be lines; `left_out_mm` of ink is joined to lines, but none.
    `others`: further lines of a sheet whose longest line was asked for. `ink`: how much of the ink of a sheet
    the strokes run along, where all of it was asked for. `unread`: ticks and dots that were taken for ink.
    `unexplained`: places at which closed lines are not what is drawn. `enlarged`: how many times at most
    the outlines of solid areas among lines were; `notes` on these are for the operator. `letters`: numbers of
    contours that are likely lettering; `letters_out`: of those that were left out as too low.
    `lost_outlines`: edges that were left out, as the head was lost on them. `small_rings`: closed lines that
    are too short to be contours; `unclear`: patches of ink on which the head can nowhere be put down.
    """

    lines: tuple[Line, ...]
    operator: Operator = field(default_factory=Operator)
    rate_hz: float = MOTION_RATE_HZ
    left_out: int = 0
    left_out_mm: float = 0.0
    others: Others = NO_OTHERS
    ink: Balance | None = None
    unread: int = 0
    unexplained: tuple[Unexplained, ...] = ()
    enlarged: float = 1.0
    notes: tuple[str, ...] = ()
    letters: tuple[int, ...] = ()
    letters_out: tuple[int, ...] = ()
    lost_outlines: tuple[LostOutline, ...] = ()
    small_rings: tuple[SmallPatch, ...] = ()
    unclear: tuple[SmallPatch, ...] = ()

    @property
    def work(self) -> Work:
        """How deep the tool goes, and how fast."""
        return self.operator.work

    @property
    def xy_mm(self) -> Array:
        """Positions along the lines, one behind the other, (n, 2) mm."""
        parts = [line.xy_mm for line in self.lines]
        return parts[0] if len(parts) == 1 else np.vstack(parts)

    @property
    def ending(self) -> str:
        """How the line ended; of several lines "lost", or how many ended how, such as "9 closed, 2 ended"."""
        ways = Counter(line.ending for line in self.lines)
        if len(ways) == 1 or "lost" in ways:
            return min(ways, key=ENDINGS.index)
        return ", ".join(f"{ways[way]} {way}" for way in reversed(ENDINGS) if ways[way])

    @property
    def fault(self) -> LineFault | None:
        """The fault of the line that was lost; of several lost lines the first fault, with all numbers."""
        lost = [line for line in self.lines if line.fault is not None]
        numbers = {line.number for line in self.lines}  # a cutter may run one line in pieces
        if not lost:
            return None
        return _incomplete(lost, len(numbers)) if len(numbers) > 1 else lost[0].fault

    @property
    def start_mm(self) -> tuple[float, float]:
        """Where the first line was begun, mm."""
        return self.lines[0].start_mm

    @property
    def reference_mm(self) -> tuple[float, float] | None:
        """The reference point from which a line begins, mm; None if none does."""
        named = (line.reference_mm for line in self.lines if line.reference_mm is not None)
        return next(named, None)

    @property
    def line_width_mm(self) -> float:
        """Width of the line, mm; of several lines half of the way is along narrower ones."""
        widths_mm = [line.width_mm for line in self.lines]
        half_way_mm = weighted_median(widths_mm, [line.length_mm for line in self.lines])
        assert half_way_mm is not None  # a trace has lines
        return half_way_mm

    @property
    def roughness_mm(self) -> float | None:
        """Roughness of the roughest edge, mm; None without edges, or where it could not be measured."""
        rough_mm = [line.roughness_mm for line in self.lines if line.roughness_mm is not None]
        return max(rough_mm, default=None)

    @property
    def length_mm(self) -> float:
        """How far the head travelled along the lines, mm."""
        return sum(line.length_mm for line in self.lines)

    @property
    def idle_mm(self) -> float:
        """How far the tool goes from line to line, mm."""
        return sum((math.dist(b.begin_mm, a.end_mm) for a, b in pairwise(self.lines)), 0.0)

    @property
    def duration_s(self) -> float:
        """Length of the motion, Z moves and rapid moves included, s."""
        return sum(len(block) for block in self._blocks()) / self.rate_hz

    @cached_property
    def actions(self) -> list[list[Action]]:
        """What the operator does along each line."""
        return self.operator.actions(self.lines)

    @cached_property
    def tabs(self) -> list[tuple[Tab, ...]]:
        """The holding tabs of each line; raises MotionFault if there is no room for them."""
        return tabs_of(self.lines, self.operator, self.actions)

    def __iter__(self) -> Iterator[Motion]:
        """Blocks of Motion: down, along the line, up, and over to the next."""
        first = 0
        for block in self._blocks():
            yield Motion(block, self.rate_hz, first / self.rate_hz)
            first += len(block)

    def _blocks(self) -> Iterator[Array]:
        """Positions of those blocks, (n, 3) mm."""
        passes = Passes(self.operator, self.rate_hz)
        for line, after, actions, tabs in zip_longest(
            self.lines, self.lines[1:], self.actions, self.tabs
        ):
            if len(line.xy_mm) > 1:  # not one that was never begun
                yield from passes.along(line, actions, tabs)
            if after is not None:
                yield passes.rapid(line.end_mm, after.begin_mm)


def _incomplete(lost: list[Line], lines: int) -> LineFault:
    """The fault of the first of several lines that were lost, with the numbers of all."""
    named = sorted(line.number for line in lost)
    first = lost[0].fault
    assert first is not None
    are = f"{listed('line', named)} of {lines} {'is' if len(lost) == 1 else 'are'}"
    rest = "no line is whole" if len(lost) == lines else "the others are cut"
    return LineFault(
        f"{are} incomplete, {rest}; line {lost[0].number}: {first}",
        x_mm=first.x_mm,
        y_mm=first.y_mm,
        heading_rad=first.heading_rad,
    )
