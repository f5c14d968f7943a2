"""A drawing traced for a verb: the head as it is set by options, card and file, and what is said of its run
(see `traced` for what comes of it).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

import click

from morfax.console.terminal.desk import Desk
from morfax.jobs import files as medium
from morfax.jobs.remarks import of_cutter, remarks
from morfax.jobs.traced import Traced
from morfax.motion.faults import CardFault, LineFault

if TYPE_CHECKING:
    from morfax.console.terminal.attended import Attended
    from morfax.tracer.cutter.cutter import Cutter, Left
    from morfax.tracer.drawing.drawing import Drawing
    from morfax.tracer.following.direction import Direction
    from morfax.tracer.head.settings import Settings
    from morfax.tracer.operator.card import Card, Override
    from morfax.tracer.operator.operator import Operator
    from morfax.tracer.program.program import Trace

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

        Raises LineFault if there is none to start on; the sheet is then drawn, if a name for a picture is
        given.
        """
        from morfax.motion.motion import thin
        from morfax.tracer.program.trace import trace
        from morfax.tracer.program.trace_lines import trace_lines

        desk.warn_of_compiling("the head", "motion", "tracer", "recorder")
        settings = self.settings()
        operator = self._operator()
        try:
            with desk.bar("following the line", total=1.0) as advance:
                if self.lines is None:
                    traced = trace(
                        drawing,
                        self.start_mm,
                        settings,
                        operator,
                        lambda come, length: advance(come / length),
                    )
                else:
                    traced = trace_lines(
                        drawing,
                        self.lines,
                        settings,
                        operator,
                        lambda come, all_: advance(come / all_),
                    )
        except LineFault as fault:
            if picture is not None:
                self._show_sheet(drawing, fault, medium.incomplete(picture), desk)
            raise
        for text in remarks(traced, self, settings.gap_mm, drawing.enlarged):
            desk.note(text)
        origin_mm = (
            (0.0, 0.0) if self.marks.origin == "sheet" else self._reference_mm(drawing, traced)
        )
        beside, left = self._beside(traced, settings, desk)
        return Traced(
            beside, thin(beside), self.lines is not None, origin_mm, self.cutter, left
        )

    def _beside(
        self, traced: Trace, settings: Settings, desk: Desk
    ) -> tuple[Trace, Left | None]:
        """The program of the cutter beside the lines, and what it cannot reach; without a cutter the lines
        themselves.
        """
        if self.cutter is None:
            return traced, None
        from morfax.tracer.cutter.cutter import with_cutter

        beside, left = with_cutter(traced, self.cutter, settings.speed_mm_s)
        for text in of_cutter(beside, left, self.cutter):
            desk.note(text)
        return beside, left

    def _reference_mm(self, drawing: Drawing, trace: Trace) -> tuple[float, float]:
        """The reference point: the one given, that from which the program begins, or the only one on the
        sheet; raises LineFault without one.
        """
        from morfax.tracer.following.start import reference_on

        return self.marks.reference_mm or trace.reference_mm or reference_on(drawing)

    def settings(self) -> Settings:
        """Settings of the head; raises UsageError for one that there is not, or that is out of bounds."""
        from morfax.tracer.head.settings import choose

        options = {name: getattr(self, name) for name in SET_BY_OPTIONS}
        changes: dict[str, object] = {
            **self.filed,
            **{name: v for name, v in options.items() if v is not None},
        }
        for change in self.changes:
            name, _, value = change.partition("=")
            changes[name.strip()] = value.strip()
        try:
            return choose(self.kind, changes)
        except ValueError as error:
            raise click.UsageError(str(error)) from None

    def by_file(self, filed: Mapping[str, float], given: Callable[[str], bool]) -> Head:
        """The same with the settings of a file, but for the options that were given on the command line."""
        own: dict[str, Any] = {
            name: v for name, v in filed.items() if name in SET_BY_OPTIONS and not given(name)
        }
        return replace(self, filed=filed, **own)

    def by_card(self, card: Card, given: Callable[[str], bool]) -> Head:
        """The same with what the card says, but for the options that were given on the command line."""
        depth_mm = card.depths_mm[-1] if card.depths_mm else None
        says = {
            "speed_mm_s": card.trace_mm_s,
            "depth_mm": depth_mm,
            "clearance_mm": card.start_mm,
        }
        set_by_card: dict[str, Any] = {
            name: v for name, v in says.items() if v is not None and not given(name)
        }
        return replace(self, card=card, **set_by_card)

    def _operator(self) -> Operator:
        """What is done at the stops: depths, feeds and clearance of the tool (of the card's passes those less
        deep than the depth), and the card.
        """
        from morfax.tracer.operator.card import Card
        from morfax.tracer.operator.operator import Operator
        from morfax.tracer.operator.work import Work

        work = Work(depth_mm=self.depth_mm, clearance_mm=self.clearance_mm)
        card = self.card or Card()
        work = replace(
            work,
            feed_mm_s=card.feed_mm_s or work.feed_mm_s,
            rapid_mm_s=card.rapid_mm_s or work.rapid_mm_s,
            passes_mm=tuple(
                depth_mm for depth_mm in card.depths_mm if depth_mm < self.depth_mm
            ),
        )
        marks = self.marks
        if marks.override is not None:
            card = replace(card, override=marks.override)
        return Operator(work, card, self._panel(card), marks.reference_mm, marks.direction)

    def _panel(self, card: Card) -> Attended | None:
        """The operator at the terminal, if he is needed; raises UsageError or CardFault if there is none."""
        from morfax.console.terminal.attended import Attended, at_terminal, waits

        if not self.marks.ask and not waits(card):
            return None
        if at_terminal():
            return Attended(asking=self.marks.ask)
        if self.marks.ask:
            raise click.UsageError(
                "--ask needs a terminal to ask at; write a card instead, see docs/reference/card.md"
            )
        raise CardFault(
            'restart = "manual" waits for the operator\'s button, and there is no terminal; run it at one, or set "automatic"',
            field="restart",
            holds="manual",
        )

    def _show_sheet(
        self, drawing: Drawing, fault: LineFault, file: FilePath, desk: Desk
    ) -> None:
        """Draw the sheet with the place that was asked for and the nearest line's."""
        from morfax.reports.overlay import draw_sheet

        places = {"--start": self.start_mm, "nearest line": fault.nearest_mm}
        draw_sheet(
            drawing, {name: place for name, place in places.items() if place is not None}, file
        )
        desk.note(f"the sheet is drawn in {file}; read a place for --start off its axes")
