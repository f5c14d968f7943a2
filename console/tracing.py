"""A drawing traced for a verb: the head as it is set, the tape and the path that come of it, and the figures.

When the head loses the line, what it traced until then is kept, with `.incomplete` in the names, and the fault is given
beside.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

import click

from console import medium
from console.desk import Desk
from console.remarks import of_cutter, remarks
from motion.faults import CardFault, Fault, LineFault

if TYPE_CHECKING:
    from console.attended import Attended
    from console.unit import Unit
    from motion.motion import Path
    from tracer.card import Card, Override
    from tracer.cutter import Cutter, Left
    from tracer.drawing import Drawing
    from tracer.operator import Direction, Operator
    from tracer.program import Trace
    from tracer.settings import Settings

# settings of the head that have an option of their own
SET_BY_OPTIONS = ("speed_mm_s", "gap_mm", "recatch_mm", "line_width_mm")


@dataclass(frozen=True, slots=True)
class Marks:
    """What the operator says of the marks on the drawing."""

    reference_mm: tuple[float, float] | None = None  # None: looked for
    origin: str = "sheet"
    direction: Direction | None = None
    override: Override | None = None  # None: the card's
    ask: bool = False


@dataclass(frozen=True, slots=True)
class Head:
    """What the operator sets for the head and the tool."""

    start_mm: tuple[float, float] | None
    speed_mm_s: float
    depth_mm: float
    clearance_mm: float
    line_width_mm: float | None
    gap_mm: float
    lines: str | tuple[int, ...] | None = None  # the one line at the start, or the longest
    card: Card | None = None
    kind: str = "precise"
    recatch_mm: float | None = None
    filed: Mapping[str, float] = field(default_factory=dict)  # settings from a file
    changes: tuple[str, ...] = ()  # NAME=VALUE
    marks: Marks = field(default_factory=Marks)
    cutter: Cutter | None = None  # None: the draughtsman has allowed for it

    def trace(self, drawing: Drawing, desk: Desk, picture: FilePath | None = None) -> Traced:
        """Follow the drawing's line, or all that are asked for, to the end or until it is lost.

        Raises LineFault if there is none to start on; the sheet is then drawn, if a name for a picture is given.
        """
        from motion.motion import thin
        from tracer.sequence import trace
        from tracer.tour import trace_lines

        desk.warn_of_compiling("the head", "motion", "tracer", "recorder")
        settings = self.settings()
        operator = self._operator()
        try:
            with desk.bar("following the line", total=1.0) as advance:
                if self.lines is None:
                    traced = trace(
                        drawing, self.start_mm, settings, operator, lambda come, length: advance(come / length)
                    )
                else:
                    traced = trace_lines(
                        drawing, self.lines, settings, operator, lambda come, all_: advance(come / all_)
                    )
        except LineFault as fault:
            if picture is not None:
                self._show_sheet(drawing, fault, medium.incomplete(picture), desk)
            raise
        for text in remarks(traced, self, settings.gap_mm, drawing.enlarged):
            desk.note(text)
        origin_mm = (0.0, 0.0) if self.marks.origin == "sheet" else self._reference_mm(drawing, traced)
        beside, left = self._beside(traced, settings, desk)
        return Traced(beside, thin(beside), self.lines is not None, origin_mm, self.cutter, left)

    def _beside(self, traced: Trace, settings: Settings, desk: Desk) -> tuple[Trace, Left | None]:
        """The program of the cutter beside the lines, and what it cannot reach; without a cutter the lines themselves."""
        if self.cutter is None:
            return traced, None
        from tracer.cutter import with_cutter

        beside, left = with_cutter(traced, self.cutter, settings.speed_mm_s)
        for text in of_cutter(beside, left, self.cutter):
            desk.note(text)
        return beside, left

    def _reference_mm(self, drawing: Drawing, trace: Trace) -> tuple[float, float]:
        """The reference point: the one given, that from which the program begins, or the only one on the sheet; raises LineFault without one."""
        from tracer.stance import reference_on

        return self.marks.reference_mm or trace.reference_mm or reference_on(drawing)

    def settings(self) -> Settings:
        """Settings of the head; raises UsageError for one that there is not, or that is out of bounds."""
        from tracer.settings import choose

        options = {name: getattr(self, name) for name in SET_BY_OPTIONS}
        changes: dict[str, object] = {**self.filed, **{name: v for name, v in options.items() if v is not None}}
        for change in self.changes:
            name, _, value = change.partition("=")
            changes[name.strip()] = value.strip()
        try:
            return choose(self.kind, changes)
        except ValueError as error:
            raise click.UsageError(str(error)) from None

    def by_file(self, filed: Mapping[str, float], given: Callable[[str], bool]) -> Head:
        """The same with the settings of a file, but for the options that were given on the command line."""
        own: dict[str, Any] = {name: v for name, v in filed.items() if name in SET_BY_OPTIONS and not given(name)}
        return replace(self, filed=filed, **own)

    def by_card(self, card: Card, given: Callable[[str], bool]) -> Head:
        """The same with what the card says, but for the options that were given on the command line."""
        depth_mm = card.depths_mm[-1] if card.depths_mm else None
        says = {"speed_mm_s": card.trace_mm_s, "depth_mm": depth_mm, "clearance_mm": card.start_mm}
        set_by_card: dict[str, Any] = {name: v for name, v in says.items() if v is not None and not given(name)}
        return replace(self, card=card, **set_by_card)

    def _operator(self) -> Operator:
        """What is done at the stops: depths, feeds and clearance of the tool (of the card's passes those less deep than the depth), and the card."""
        from tracer.card import Card
        from tracer.operator import Operator, Work

        work = Work(depth_mm=self.depth_mm, clearance_mm=self.clearance_mm)
        card = self.card or Card()
        work = replace(
            work,
            feed_mm_s=card.feed_mm_s or work.feed_mm_s,
            rapid_mm_s=card.rapid_mm_s or work.rapid_mm_s,
            passes_mm=tuple(depth_mm for depth_mm in card.depths_mm if depth_mm < self.depth_mm),
        )
        marks = self.marks
        if marks.override is not None:
            card = replace(card, override=marks.override)
        return Operator(work, card, self._panel(card), marks.reference_mm, marks.direction)

    def _panel(self, card: Card) -> Attended | None:
        """The operator at the terminal, if he is needed; raises UsageError or CardFault if there is none."""
        from console.attended import Attended, at_terminal, waits

        if not self.marks.ask and not waits(card):
            return None
        if at_terminal():
            return Attended(asking=self.marks.ask)
        if self.marks.ask:
            raise click.UsageError("--ask needs a terminal to ask at; write a card instead, see docs/card.md")
        raise CardFault(
            'restart = "manual" waits for the operator\'s button, and there is no terminal; run it at one, or set "automatic"',
            field="restart",
            holds="manual",
        )

    def _show_sheet(self, drawing: Drawing, fault: LineFault, file: FilePath, desk: Desk) -> None:
        """Draw the sheet with the place that was asked for and the nearest line's."""
        from console.overlay import draw_sheet

        places = {"--start": self.start_mm, "nearest line": fault.nearest_mm}
        draw_sheet(drawing, {name: place for name, place in places.items() if place is not None}, file)
        desk.note(f"the sheet is drawn in {file}; read a place for --start off its axes")


@dataclass(frozen=True, slots=True)
class Traced:
    """The program that the head made, its motion thinned to a path, and what the cutter cannot reach."""

    trace: Trace
    path: Path
    several: bool = False  # lines were asked for, not one line
    origin_mm: tuple[float, float] = (0.0, 0.0)  # the machine's zero on the sheet
    cutter: Cutter | None = None
    left: Left | None = None  # by the cutter

    @property
    def places_mm(self) -> list[tuple[str, tuple[float, float]]]:
        """Where each of several lines, or piece of one, begins, and its number."""
        return [(str(line.number), line.start_mm) for line in self.trace.lines] if self.several else []

    @property
    def fault(self) -> Fault | None:
        """The fault of a line that was lost."""
        return self.trace.fault

    def name(self, file: FilePath) -> FilePath:
        """The name for a result: marked if the line was lost."""
        return medium.incomplete(file) if self.fault else file

    def record(self, file: FilePath, unit: Unit, desk: Desk) -> FilePath:
        """Record the motion on a tape, or in the medium that the name says; the program's name."""
        unit.record(self.trace, self.name(file), desk)
        return self.name(file)

    def write(self, file: FilePath, unit: Unit) -> FilePath:
        """Write the path file, placed as the tape is; its name."""
        from motion.pathfile import write_path

        write_path(unit.placement.path(self.path), self.name(file))
        return self.name(file)

    def figures(self) -> dict[str, Any]:
        """What the head found, as figures."""
        return {
            "ending": self.trace.ending,
            "incomplete": True if self.fault else None,
            "length_mm": self.trace.length_mm,
            "duration_s": float(self.path.t_s[-1] - self.path.t_s[0]),
            "line_width_mm": self.trace.line_width_mm,
            "start_place_mm": self.trace.start_mm,
            "reference_place_mm": self.trace.reference_mm,
            "origin_place_mm": self.origin_mm if any(self.origin_mm) else None,
            **(self._of_lines() if self.several else {}),
            "stops": self._stops() or None,
            "junctions": self._junctions() or None,
            **self._of_cutter(),
        }

    def _of_cutter(self) -> dict[str, Any]:
        """The cutter, and what it cannot reach."""
        if self.cutter is None or self.left is None:
            return {}
        lines = [
            {
                "line_left_out": out.line,
                "length_mm": out.length_mm,
                "middle_place_mm": out.room.place_mm if out.room else None,
                "room_mm": out.room.wide_mm if out.room else None,
                "cutter_up_to_mm": out.room.passes_mm if out.room else None,
                "stops_left_out": list(out.stops) or None,
            }
            for out in self.left.lines
        ]
        rows = [
            {"unreached": k, "of_line": u.line, "place_mm": u.place_mm, "left_mm": u.left_mm, "stretch_mm": u.length_mm}
            for k, u in enumerate(self.left.stretches, 1)
        ]
        told = {"cutter_diameter_mm": self.cutter.diameter_mm, "side": self.cutter.side}
        return {**told, "lines_left_out": lines or None, "unreached": rows or None}

    @property
    def marked_mm(self) -> dict[str, tuple[float, float]]:
        """Places to be marked in a picture: the stops, and what the cutter cannot reach, by name."""
        if self.left is None:
            return self.stops_mm
        out = {f"line {out.line} left out": out.room.place_mm for out in self.left.lines if out.room is not None}
        return {**self.stops_mm, **out, **{f"left {k}": u.place_mm for k, u in enumerate(self.left.stretches, 1)}}

    def _stops(self) -> list[dict[str, Any]]:
        """The stops, by number: what kind of mark, where, and where Z goes."""
        return [
            {
                "stop": action.halt.number,
                "mark": action.halt.kind,
                "stop_place_mm": action.halt.place_mm,
                "z_mm": [move.to_mm for move in action.moves],
            }
            for actions in self.trace.actions
            for action in actions
            if action.halt.number is not None
        ]

    def _junctions(self) -> list[dict[str, Any]]:
        """The junctions that the head came to on each line, in order, as the card's `turns` count them."""
        return [
            {"junction": k, **({"of_line": line.number} if self.several else {}), "junction_place_mm": place_mm}
            for line in self.trace.lines
            for k, place_mm in enumerate(line.junctions_mm, 1)
        ]

    @property
    def stops_mm(self) -> dict[str, tuple[float, float]]:
        """Where the stops are, by number."""
        return {f"stop {row['stop']}": row["stop_place_mm"] for row in self._stops()}

    def _of_lines(self) -> dict[str, Any]:
        """What the head found of each line, in the order in which they are cut."""
        lines = [
            {
                "line": line.number,
                "ending": line.ending,
                "length_mm": line.length_mm,
                "line_width_mm": line.width_mm,
                "start_place_mm": line.start_mm,
            }
            for line in self.trace.lines
        ]
        return {
            "idle_mm": self.trace.idle_mm,
            "patches_left_out": self.trace.left_out,
            "ink_left_out_mm": self.trace.left_out_mm,
            "lines": lines,
        }
