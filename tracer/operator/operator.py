"""The operator at the panel: what the Z unit does at the start of a line, at its stops and guide lines, and
at its end.

Signals: a line as it was followed, with its marks, in; actions out: at which position of the line X and Y
stand, and which moves Z makes there.

    plain line     down at its start                                                      X,Y  ──●──
    lead line      raised; down at the last tick before the loop, or where the loop begins     ▼ stand ▲
    guide line     raised; a hole is drilled at its end, or at a dot there                Z    ╲______╱
    stop           what the card says; without an entry there Z stands for half a second

A lead line begins at a reference point, or bears a tick, and runs into a loop. A line that begins at a
reference point and ends is a guide line. Any other line is cut from its start. Stops are numbered along the
way, over all the lines; the head passes those that the operator overrides.

Ticks and dots are marks where a program is drawn: a line begins at a reference point, the card says what to
do at stops, there are dots and nothing else, or the operator says so. On any other sheet they are ink.

Source: patent ES 361967, section on use, and figure 3; override button of figure 1. Questions: the patent's
operator knows what a line is for; here its marks show it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Literal, Protocol

from morfax.motion.faults import CardFault
from morfax.tracer.following.direction import Arrow, Direction
from morfax.tracer.following.line import Line
from morfax.tracer.limits import ABOUT_WIDTHS
from morfax.tracer.operator.card import Card, Drill, Stop
from morfax.tracer.operator.work import Action, Descent, Halt, Work
from morfax.tracer.operator.zunit import COUNTS_PER_MM, QuillMove
from morfax.tracer.sensing.side import Side

Marks = Literal["auto", "on", "off"]

STAND_S = 0.5  # at a stop without an entry on the card: our own figure
# a dot as near to the end of a guide line is the hole drilled there; by trial


class Panel(Protocol):
    """An operator who is present during the run."""

    def ask(self, halt: Halt, z_mm: float, usual: Sequence[QuillMove]) -> Stop | None:
        """What to do at a stop; None: the usual moves."""

    def wait(self, halt: Halt) -> float:
        """Wait until the button is pressed; returns the time that it took, s."""


@dataclass(frozen=True, slots=True)
class Operator:
    """What is to be done at the stops: the card says it, or somebody at the panel."""

    work: Work = field(default_factory=Work)
    card: Card = field(default_factory=Card)
    panel: Panel | None = None
    reference_mm: tuple[float, float] | None = None  # None: the reference point is looked for
    direction: Direction | None = None  # in which the head takes the line
    marks: Marks = "auto"  # whether ticks and dots are marks; auto: where a program is drawn
    arrows: tuple[Arrow, ...] = ()  # where lines begin, and which way
    order: tuple[int, ...] = ()  # numbers of the lines that are cut first, in this order
    # lettering that is lower is left out where contours, or all the ink, are asked for; 0: none is
    letters_from_mm: float = 0.0

    @property
    def sides(self) -> tuple[Side | None, ...]:
        """Where the head turns off at the junctions."""
        return tuple(None if side == "straight" else side for side in self.card.turns)

    def reads_marks(self, lines: Sequence[Line]) -> bool:
        """Whether ticks and dots on some lines of a drawing are marks, and not ink."""
        if self.marks != "auto":
            return self.marks == "on"
        has_reference = any(line.reference_mm is not None for line in lines)
        are_dots = all(line.is_dot for line in lines)
        return has_reference or are_dots or self.means_program

    @property
    def means_program(self) -> bool:
        """Whether the operator says that a program is drawn, whatever the drawing shows."""
        named = self.reference_mm is not None or self.card.is_about_stops
        return self.marks == "on" or (self.marks == "auto" and named)

    def actions(self, lines: Sequence[Line]) -> list[list[Action]]:
        """The actions along each of several lines, in the order in which the lines are cut.

        Raises CardFault for moves that the Z unit cannot make.
        """
        made, first = list[list[Action]](), 1
        for line in lines:
            halts = self._halts(line, first)
            first += _count_stops(halts)
            made.append(self._along(self._not_overridden(halts), line))
        return made

    def not_there(self, lines: Sequence[Line]) -> tuple[list[int], int]:
        """Numbers of stops that the card names and the lines do not have, and how many stops they have."""
        override = () if isinstance(self.card.override, str) else self.card.override
        of_entries = [stop.number for stop in self.card.stops if stop.number is not None]
        stops = sum(_count_stops(self._halts(line, 1)) for line in lines)
        return sorted(n for n in {*override, *of_entries} if n > stops), stops

    def stops(self, line: Line, first: int) -> list[Halt]:
        """The stops of a line in order, with their own numbers, or numbered from `first`."""
        # 1. ticks and dots
        stops = list[Halt]()
        for mark in line.marks:
            stops.append(Halt(mark.at, mark.kind, mark.place_mm))
        # 2. a hole at the end of each guide line; a dot near that end is the hole
        tips: list[float] = [guide.tip for guide in line.guides]
        if line.is_guide:
            tips.append(len(line.xy_mm) - 1)
        near_mm = ABOUT_WIDTHS * line.width_mm
        for tip in tips:
            place = line.place(tip)
            dots = [
                s for s in stops if s.kind == "dot" and math.dist(s.place_mm, place) < near_mm
            ]
            stops = [s for s in stops if s not in dots]
            stops.append(replace(dots[0], kind="hole") if dots else Halt(tip, "hole", place))
        # 3. numbers along the way
        stops.sort(key=lambda halt: halt.at)
        numbers = range(first, first + len(stops)) if line.numbers is None else line.numbers
        return [replace(stop, number=n) for stop, n in zip(stops, numbers, strict=True)]

    def depths_mm(self, actions: Sequence[Action]) -> tuple[float, ...]:
        """Depths at which a line is run: those of the stop where the tool goes down, or those of the work."""
        own = (action.depths_mm for action in actions if action.depths_mm)
        return next(own, self.work.depths_mm)

    def down_at(self, line: Line, first: int) -> float | None:
        """The position of the tick where the tool goes down into a line; None if it does so at no tick.

        The stops of the line are numbered from `first`.
        """
        down = self._down(self._not_overridden(self._halts(line, first)), line)
        return down.at if down is not None and down.kind == "tick" else None

    def _halts(self, line: Line, first: int) -> list[Halt]:
        """Every place of a line where something may be done, in order, its stops numbered from `first`."""
        halts = self.stops(line, first)
        for guide in line.guides:
            halts.append(Halt(guide.leave, "leave", line.place(guide.leave)))
            halts.append(Halt(guide.back, "back", line.place(guide.back)))
        if line.loop_from is not None and line.is_lead:
            halts.append(Halt(line.loop_from, "loop", line.place(line.loop_from)))
        elif not line.is_guide:
            halts.append(Halt(0, "begin", line.start_mm))
        return sorted(halts, key=lambda halt: halt.at)

    def _not_overridden(self, halts: Sequence[Halt]) -> list[Halt]:
        """The halts at which the head stands: all but the ticks and dots that the operator overrides."""
        override = self.card.override
        if override == "none":
            return list(halts)
        return [
            halt
            for halt in halts
            if halt.kind not in ("tick", "dot")
            or (override != "all" and halt.number not in override)
        ]

    def _depths(self, halt: Halt) -> tuple[float, ...]:
        """Depths at which a line is run if the tool goes down at this halt."""
        own = () if halt.number is None else self.card.stop(halt.number).passes_mm
        return own or self.work.depths_mm

    def _down(self, halts: Sequence[Halt], line: Line) -> Halt | None:
        """Where the tool goes down into the line."""
        ticks = [halt for halt in halts if halt.kind == "tick"]
        if line.is_lead:
            before = [halt for halt in ticks if halt.at < (line.loop_from or 0)]
            return before[-1] if before else next(halt for halt in halts if halt.kind == "loop")
        if line.is_guide:
            return ticks[0] if ticks else None
        return next(halt for halt in halts if halt.kind == "begin")

    def _along(self, halts: list[Halt], line: Line) -> list[Action]:
        """What is done at each halt; the tool is at clearance before the first."""
        down = self._down(halts, line)
        actions = list[Action]()
        z_mm = left_mm = self.work.clearance_mm
        for halt in halts:
            if halt.kind == "leave":
                left_mm, moves = z_mm, self._to(max(z_mm, self.work.clearance_mm))
            elif halt.kind == "back":
                moves = self._to(left_mm)
            else:
                moves = self._at_stop(halt, z_mm, is_down=halt is down)
            if not moves:
                continue
            made = Action(halt, moves)
            if halt is down:
                made = self._entered(Action(halt, moves, None, self._depths(halt)))
            actions.append(made)
            z_mm = made.z_mm
        if z_mm >= 0 and not line.is_guide:
            self._refuse_passes_above(actions)
        return actions

    def _refuse_passes_above(self, actions: Sequence[Action]) -> None:
        """Raise CardFault if a line that ends with the tool up has further passes, which have no stops."""
        depths_mm = self.depths_mm(actions)
        if len(depths_mm) < 2 or not any(action.depths_mm for action in actions):
            return
        last = next(action for action in reversed(actions) if action.moves[-1].to_mm >= 0)
        x, y = last.halt.place_mm
        further = ", ".join(f"{depth:g}" for depth in depths_mm[1:])
        raise CardFault(
            f"at stop {last.halt.number}, {x:.2f},{y:.2f} mm, the tool goes up for the rest of the line, and"
            f" further passes, at {further} mm, have no stops: give one depth instead of passes, or lower the"
            " tool again before the line ends"
        )

    def _entered(self, action: Action) -> Action:
        """Where the tool goes down, with a ramp or an entry: to the surface while X and Y stand."""
        to_mm = action.moves[-1].to_mm
        if to_mm >= 0 or len(action.moves) > 1:
            return action
        entry = self.work.ramp(0.0, -to_mm)
        if entry is None and self.card.entry_mm is not None:
            entry = Descent(-to_mm, self.card.entry_mm)
        if entry is None:
            return action
        to_surface = replace(action.moves[0], to_mm=0.0)
        return replace(action, moves=(to_surface,), entry=entry)

    def _to(self, z_mm: float) -> tuple[QuillMove, ...]:
        """One move of Z at the work's feed."""
        return (QuillMove(z_mm, self.work.feed_mm_s),)

    def _at_stop(self, halt: Halt, z_mm: float, *, is_down: bool) -> tuple[QuillMove, ...]:
        """What is done at a stop, or where the line begins: what the card says, or what is usual."""
        if halt.number is None:
            return self._to(-self.work.depths_mm[0]) if is_down else ()
        stop = self.card.stop(halt.number)
        moves = self._moves(halt, stop, z_mm, is_down=is_down)
        answer = self.panel.ask(halt, z_mm, moves) if self.panel is not None else None
        if answer is not None:
            stop, moves = answer, self._moves(halt, answer, z_mm, is_down=is_down)
        return tuple(self._restarted(halt, stop, moves))

    def _moves(self, halt: Halt, stop: Stop, z_mm: float, *, is_down: bool) -> list[QuillMove]:
        """The moves that an entry of the card gives, or the usual ones."""
        feed_mm_s = self.work.feed_mm_s
        moves = self._from_card(halt, stop, z_mm)
        if moves:
            return moves
        if is_down:
            return [QuillMove(-self._depths(halt)[0], feed_mm_s, stop.dwell_s)]
        if halt.kind in ("dot", "hole") and z_mm > 0:
            if self.work.peck_mm is not None:
                return self._pecks(halt, stop, z_mm, self.work.peck_mm)
            return [
                QuillMove(-self.work.depth_mm, feed_mm_s, stop.dwell_s),
                QuillMove(z_mm, feed_mm_s),
            ]
        return [QuillMove(z_mm, feed_mm_s, stop.dwell_s or STAND_S)]

    def _pecks(self, halt: Halt, stop: Stop, z_mm: float, peck_mm: float) -> list[QuillMove]:
        """The moves that drill a hole peck by peck."""
        depth, peck = (round(mm * COUNTS_PER_MM) for mm in (self.work.depth_mm, peck_mm))
        drill = Drill(depth, peck, feed_mm_s=self.work.feed_mm_s, dwell_s=stop.dwell_s)
        return self._from_card(halt, Stop(stop.number, drill=drill), z_mm)

    def _from_card(self, halt: Halt, stop: Stop, z_mm: float) -> list[QuillMove]:
        """The moves that an entry of the card gives; none for a dwell alone."""
        if not stop.moves and stop.drill is None:
            return []
        x, y = halt.place_mm
        where = f"at stop {halt.number}, {x:.2f},{y:.2f} mm"
        return stop.motor_moves(z_mm, self.work.rapid_mm_s, where)

    def _restarted(self, halt: Halt, stop: Stop, moves: list[QuillMove]) -> list[QuillMove]:
        """The moves, the last with the time that the operator takes to press the button."""
        if (stop.restart or self.card.restart) == "automatic":
            return moves
        if self.panel is None:
            raise CardFault(
                f'stop {halt.number} waits for the operator\'s button (restart = "manual"), and nobody is at'
                ' the panel; run it at a terminal, or set restart = "automatic"'
            )
        last = moves[-1]
        return [*moves[:-1], replace(last, dwell_s=last.dwell_s + self.panel.wait(halt))]


def _count_stops(halts: Sequence[Halt]) -> int:
    """How many of some halts are stops."""
    return sum(halt.number is not None for halt in halts)
