"""The operator at the panel: what the Z unit does at the start of a line, at its stops, where it is left and
come back to, and at its end.

Signals: a line as it was followed, with its marks, in; actions out: at which position of the line X and Y
stand, and what moves Z makes there.

    plain line     down at its start                                                      X,Y  ──●──
    lead line      raised; down at the last tick before the loop, or where that begins         ▼ stand ▲
    guide line     raised; at its end, or at a dot, a hole is drilled                     Z    ╲______╱
    stop           what the card says; without one Z stands for half a second

A lead line begins at a reference point, or bears a tick, and runs into a loop; a line that begins at a
reference point and ends is a guide line. Any other is cut from its start. Stops are numbered along the way,
over all the lines; those that the operator overrides are passed by.

Source: patent ES 361967, section on use, and figure 3; override button of figure 1. Questions: the patent's
operator knows what a line is for; here its marks say it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Literal, NamedTuple, Protocol

from morfax.motion.faults import CardFault
from morfax.tracer.following.direction import Direction
from morfax.tracer.following.line import Line
from morfax.tracer.operator import zunit
from morfax.tracer.operator.card import Card, Stop
from morfax.tracer.operator.zunit import Move
from morfax.tracer.sensing.side import Side

STAND_S = 0.5
NEAR_WIDTHS = 3.0  # a dot at the end of a guide line is the hole drilled there, and no other


@dataclass(frozen=True, slots=True)
class Work:
    """How deep the tool goes, where it stands above the work between lines, and how fast it goes down and up."""

    depth_mm: float = 5.0
    clearance_mm: float = 2.0
    feed_mm_s: float = 5.0
    acceleration_mm_s2: float = zunit.ACCELERATION_MM_S2
    # from line to line, half of what a tape of 6 kHz and 20 cycles per mm carries
    rapid_mm_s: float = 50.0
    passes_mm: tuple[
        float, ...
    ] = ()  # depths at which each line is run before it is run at its depth

    @property
    def depths_mm(self) -> tuple[float, ...]:
        """Depths at which each line is run, one after the other, mm."""
        return (*self.passes_mm, self.depth_mm)


@dataclass(frozen=True, slots=True)
class Halt:
    """Where the axis stands: which position of the line, why, and the number of the stop if it is one."""

    at: float
    kind: Literal["begin", "tick", "dot", "hole", "leave", "back", "loop"]
    place_mm: tuple[float, float]
    number: int | None = None


class Entry(NamedTuple):
    """Z superimposed on X and Y: from the surface down to a depth over a length of the line, both mm."""

    depth_mm: float
    length_mm: float


@dataclass(frozen=True, slots=True)
class Action:
    """What is done where the axis stands: moves of Z one after the other, each with its dwell; and how deep Z
    goes on the way after it, over how many mm.

    Where the tool goes down into the line: the depths at which that is run.
    """

    halt: Halt
    moves: tuple[Move, ...]
    entry: Entry | None = None
    depths_mm: tuple[float, ...] = ()


class Panel(Protocol):
    """An operator who is there during the run."""

    def ask(self, halt: Halt, z_mm: float, usual: Sequence[Move]) -> Stop | None:
        """What to do at a stop; None: the moves that are made there without an answer."""

    def wait(self, halt: Halt) -> float:
        """Wait until the button is pressed; the time that it took, s."""


@dataclass(frozen=True, slots=True)
class Operator:
    """What is to be done at the stops: the card, or somebody at the panel."""

    work: Work = field(default_factory=Work)
    card: Card = field(default_factory=Card)
    panel: Panel | None = None
    # where the reference point is, if it is not to be looked for
    reference_mm: tuple[float, float] | None = None
    direction: Direction | None = None  # in which the head takes the line

    @property
    def sides(self) -> tuple[Side | None, ...]:
        """Where the head turns off at the junctions."""
        return tuple(None if side == "straight" else side for side in self.card.turns)

    def actions(self, lines: Sequence[Line]) -> list[list[Action]]:
        """The actions along each of several lines, in the order in which they are cut; raises CardFault for
        moves that the Z unit cannot make.
        """
        made, first = [], 1
        for line in lines:
            halts = self._halts(line, first)
            first += sum(1 for halt in halts if halt.number is not None)
            made.append(
                self._along([halt for halt in halts if not self._overridden(halt)], line)
            )
        return made

    def not_there(self, lines: Sequence[Line]) -> tuple[list[int], int]:
        """Numbers of stops that the card names and that the lines do not have, and how many stops they have."""
        override = () if isinstance(self.card.override, str) else self.card.override
        named = {
            *override,
            *(stop.number for stop in self.card.stops if stop.number is not None),
        }
        stops = sum(
            1 for line in lines for halt in self._halts(line, 1) if halt.number is not None
        )
        return sorted(number for number in named if number > stops), stops

    def stops(self, line: Line, first: int) -> list[Halt]:
        """The stops of a line in order, with the numbers that it has for them, or numbered from `first`."""
        stops = [
            Halt(mark.at, "tick" if mark.kind == "tick" else "dot", mark.place_mm)
            for mark in line.marks
        ]
        tips = [guide.tip for guide in line.guides] + (
            [len(line.xy_mm) - 1] if line.is_guide else []
        )
        for tip in tips:
            place, near = line.place(tip), NEAR_WIDTHS * line.width_mm
            dots = [
                stop
                for stop in stops
                if stop.kind == "dot" and _apart(stop.place_mm, place) < near
            ]
            stops = [stop for stop in stops if stop not in dots]
            stops.append(replace(dots[0], kind="hole") if dots else Halt(tip, "hole", place))
        stops.sort(key=lambda halt: halt.at)
        numbers = range(first, first + len(stops)) if line.numbers is None else line.numbers
        return [
            replace(stop, number=number) for stop, number in zip(stops, numbers, strict=True)
        ]

    def _halts(self, line: Line, first: int) -> list[Halt]:
        """Every place of a line where something may be done, in order, its stops numbered from `first`."""
        halts = self.stops(line, first)
        for guide in line.guides:
            halts += [
                Halt(guide.leave, "leave", line.place(guide.leave)),
                Halt(guide.back, "back", line.place(guide.back)),
            ]
        if line.loop_from is not None and line.is_lead:
            halts.append(Halt(line.loop_from, "loop", line.place(line.loop_from)))
        elif not line.is_guide:
            halts.append(Halt(0, "begin", line.start_mm))
        return sorted(halts, key=lambda halt: halt.at)

    def _overridden(self, halt: Halt) -> bool:
        """Whether the operator lets a stop mark pass by; a hole at the end of a guide line is none."""
        override = self.card.override
        return halt.kind in ("tick", "dot") and (
            override == "all" or (override != "none" and halt.number in override)
        )

    def depths_mm(self, actions: Sequence[Action]) -> tuple[float, ...]:
        """Depths at which a line is run: the passes of the stop where the tool goes down, or those of the
        work.
        """
        return next(
            (action.depths_mm for action in actions if action.depths_mm), self.work.depths_mm
        )

    def down_at(self, line: Line, first: int) -> float | None:
        """Which position of a line, its stops numbered from `first`, has the tick at which the tool goes
        down; None if that is at no tick.
        """
        down = self._down(
            [halt for halt in self._halts(line, first) if not self._overridden(halt)], line
        )
        return down.at if down is not None and down.kind == "tick" else None

    def _depths(self, halt: Halt) -> tuple[float, ...]:
        own = () if halt.number is None else self.card.stop(halt.number).passes_mm
        return own or self.work.depths_mm

    def _down(self, halts: Sequence[Halt], line: Line) -> Halt | None:
        """Where the tool goes down into the line."""
        if line.is_lead:
            before = [
                halt
                for halt in halts
                if halt.kind == "tick" and halt.at < (line.loop_from or 0)
            ]
            return before[-1] if before else next(halt for halt in halts if halt.kind == "loop")
        if line.is_guide:
            return next((halt for halt in halts if halt.kind == "tick"), None)
        return next(halt for halt in halts if halt.kind == "begin")

    def _along(self, halts: list[Halt], line: Line) -> list[Action]:
        """What is done at each halt, the tool at clearance before the first."""
        down, actions, z_mm, left_mm = (
            self._down(halts, line),
            list[Action](),
            self.work.clearance_mm,
            self.work.clearance_mm,
        )
        for halt in halts:
            if halt.kind == "leave":
                left_mm, moves = z_mm, self._to(max(z_mm, self.work.clearance_mm))
            elif halt.kind == "back":
                moves = self._to(left_mm)
            else:
                moves = self._at_stop(halt, z_mm, is_down=halt is down)
            if moves:
                made = (
                    self._entered(Action(halt, moves, None, self._depths(halt)))
                    if halt is down
                    else Action(halt, moves)
                )
                actions.append(made)
                z_mm = -made.entry.depth_mm if made.entry else moves[-1].to_mm
        if z_mm >= 0 and not line.is_guide:
            self._refuse_passes_above(actions)
        return actions

    def _refuse_passes_above(self, actions: Sequence[Action]) -> None:
        """Raise CardFault if a line that ends with the tool up was to be run at further depths: only the
        first pass has stops.
        """
        depths_mm = self.depths_mm(actions)
        if any(action.depths_mm for action in actions) and len(depths_mm) > 1:
            last = next(action for action in reversed(actions) if action.moves[-1].to_mm >= 0)
            (x, y), which = (
                last.halt.place_mm,
                ", ".join(f"{depth:g}" for depth in depths_mm[1:]),
            )
            raise CardFault(
                f"at stop {last.halt.number}, {x:.2f},{y:.2f} mm, the tool goes up for the rest of the line, and further passes, at {which} mm, have no stops:"
                " give one depth instead of passes, or lower the tool again before the line ends"
            )

    def _entered(self, action: Action) -> Action:
        """The action where the tool goes down, with the card's entry: to the surface standing, and the rest
        on the way.
        """
        to_mm, length_mm = action.moves[-1].to_mm, self.card.entry_mm
        if length_mm is None or to_mm >= 0 or len(action.moves) > 1:
            return action
        return replace(
            action, moves=(replace(action.moves[0], to_mm=0.0),), entry=Entry(-to_mm, length_mm)
        )

    def _to(self, z_mm: float) -> tuple[Move, ...]:
        return (Move(z_mm, self.work.feed_mm_s),)

    def _at_stop(self, halt: Halt, z_mm: float, *, is_down: bool) -> tuple[Move, ...]:
        """What is done at a stop, or where the line begins: the card's entry, or what is usual without one."""
        if halt.number is None:
            return self._to(-self.work.depths_mm[0]) if is_down else ()
        stop = self.card.stop(halt.number)
        moves = self._moves(halt, stop, z_mm, is_down=is_down)
        answer = self.panel.ask(halt, z_mm, moves) if self.panel is not None else None
        if answer is not None:
            stop, moves = answer, self._moves(halt, answer, z_mm, is_down=is_down)
        return tuple(self._restarted(halt, stop, moves))

    def _moves(self, halt: Halt, stop: Stop, z_mm: float, *, is_down: bool) -> list[Move]:
        """The moves that an entry asks for, or those that are usual there."""
        moves = self._asked(halt, stop, z_mm)
        if moves:
            return moves
        if is_down:
            return [Move(-self._depths(halt)[0], self.work.feed_mm_s, stop.dwell_s)]
        if halt.kind in ("dot", "hole") and z_mm > 0:
            return [
                Move(-self.work.depth_mm, self.work.feed_mm_s, stop.dwell_s),
                Move(z_mm, self.work.feed_mm_s),
            ]
        return [Move(z_mm, self.work.feed_mm_s, stop.dwell_s or STAND_S)]

    def _asked(self, halt: Halt, stop: Stop, z_mm: float) -> list[Move]:
        """The moves that a card's entry asks for."""
        if not stop.moves and stop.drill is None:
            return []  # a dwell alone belongs to what is usual there
        x, y = halt.place_mm
        return stop.motor_moves(
            z_mm, self.work.rapid_mm_s, f"at stop {halt.number}, {x:.2f},{y:.2f} mm"
        )

    def _restarted(self, halt: Halt, stop: Stop, moves: list[Move]) -> list[Move]:
        """The moves, the last with the time that the operator takes to press the button."""
        if (stop.restart or self.card.restart) == "automatic":
            return moves
        if self.panel is None:
            raise CardFault(
                f'stop {halt.number} waits for the operator\'s button (restart = "manual"), and nobody is at the panel;'
                ' run it at a terminal, or set restart = "automatic"'
            )
        last = moves[-1]
        return [*moves[:-1], replace(last, dwell_s=last.dwell_s + self.panel.wait(halt))]


def _apart(a: tuple[float, float], b: tuple[float, float]) -> float:
    return float(((a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2) ** 0.5)
