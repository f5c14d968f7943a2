"""A drawing traced, for every job that traces one: the head follows the lines, the cutter runs beside them.

Signals: a Drawing and the settings in; out the program with what the cutter cannot reach (see `traced`). What
the operator should know about the run goes to the listener as warnings (see `remarks`).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from morfax.jobs.listener import never_back
from morfax.jobs.remarks.many_pieces import of_many_pieces
from morfax.jobs.remarks.on_contours import of_around, of_contouring, of_open, of_order
from morfax.jobs.remarks.on_edges import of_picture_edge
from morfax.jobs.remarks.on_reference import of_reference, of_zero
from morfax.jobs.remarks.remarks import of_cutter, remarks
from morfax.jobs.remarks.stub_lines import StubLines
from morfax.jobs.remarks.two_lines import TwoLines
from morfax.jobs.remarks.who_led import WhoLed
from morfax.jobs.settings import correction_settings
from morfax.jobs.settings.depths import of_tabs
from morfax.jobs.settings.on_pages import fault_of_page, of_page
from morfax.jobs.settings.zero import ZeroOnSheet
from morfax.jobs.tracing.skips import gap_across_skips, of_pieces
from morfax.jobs.tracing.traced import Traced
from morfax.jobs.wrong_use import WrongUse
from morfax.motion.faults import CardFault, LineFault

if TYPE_CHECKING:
    from pathlib import Path as FilePath

    from morfax.jobs.listener import Listener
    from morfax.jobs.machine.recording import RecordingUnit
    from morfax.jobs.settings.settings import TraceSettings
    from morfax.tracer.cutter.cutter import Left
    from morfax.tracer.drawing.drawing import Drawing
    from morfax.tracer.head.settings import Settings
    from morfax.tracer.operator.card import Card
    from morfax.tracer.operator.operator import Operator, Panel
    from morfax.tracer.program.program import Trace


@dataclass(frozen=True, slots=True)
class Tracing:
    """A head that is set, with an operator beside it: all that was read before anything moves."""

    settings: TraceSettings
    of_head: Settings
    operator: Operator

    @classmethod
    def prepared(cls, settings: TraceSettings, panel: Panel | None = None) -> Tracing:
        """Read the card and the settings; raises WrongUse, CardFault and FileFault for a mistake in them."""
        settings = settings.with_usual_lines()
        settings.line.check()
        settings.contour.check(settings.line.direction)
        card = settings.card()
        _refuse_marks(settings, card)
        if panel is None and waits(card):
            raise CardFault(
                'restart = "manual" waits for the operator\'s button, and there is no terminal and no '
                'panel; run it at one, or set "automatic"',
                field="restart",
                holds="manual",
            )
        return cls(settings, settings.of_head(card), settings.operator(card, panel))

    def trace(self, drawing: Drawing, listener: Listener) -> Traced:
        """Follow the drawing's line, or all that are asked for, to the end or until it is lost.

        Raises LineFault if there is no line to start on.
        """
        return self._across_skips(drawing, listener)._on(drawing)._traced(drawing, listener)

    def _traced(self, drawing: Drawing, listener: Listener) -> Traced:
        """Follow the drawing, and put the tool along or beside its lines."""
        from morfax.motion.motion import thin

        # 1. the head follows
        for text in of_many_pieces(drawing) if self.settings.line.lines != "all" else ():
            listener.warning(text)
        listener.compiling("the head", ("motion", "tracer", "recorder"))
        try:
            followed = self._followed(drawing, listener)
        except LineFault as fault:
            raise fault_of_page(fault, drawing) from None
        for line in followed.lines:
            if line.fault is not None:
                fault_of_page(line.fault, drawing)
        led = WhoLed.along(followed)
        two = TwoLines.along(drawing, followed)
        stubs = StubLines.along(followed)
        said = self._remarks(drawing, followed, led)
        for text in (*said, *two.remarks(), *stubs.remarks()):
            listener.warning(of_page(text, drawing))
        # 2. the zero of the program
        zero = ZeroOnSheet.of(self.settings, drawing, followed)
        for text in of_zero(zero.place_mm, followed, self.settings):
            listener.warning(text)
        # 3. the cutter beside the lines, or the tool along them
        beside, left = self._cut(drawing, followed, listener)
        cutter = self.settings.tool.cutter()
        contouring = self.settings.contour.contouring()
        if cutter is not None and left is not None:
            for text in of_cutter(beside, left, cutter):
                listener.warning(text)
        for text in (*of_contouring(beside, contouring), *of_tabs(beside)):
            listener.warning(text)
        several = self.settings.line.are_several
        on_edges = bool(drawing.edges_mm) or (drawing.both and followed.ink is None)
        path = thin(beside)
        return Traced(beside, path, several, zero, cutter, left, led, two, stubs, on_edges)

    def _remarks(self, drawing: Drawing, followed: Trace, led: WhoLed | None) -> Iterator[str]:
        """What is to be said of the way that the head has gone."""
        if drawing.corrected is not None:
            is_all = self.settings.line.lines == "all"
            lines = None if is_all else followed.lines
            yield from correction_settings.not_served(drawing.corrected, lines)
        times = max((drawing.times_at(line.xy_mm[0]) for line in followed.lines), default=1.0)
        times = max(times, followed.enlarged)
        yield from followed.notes
        yield from remarks(followed, self.settings, self.of_head.gap_mm, times)
        yield from of_reference(followed, drawing, self.settings)
        yield from of_picture_edge(followed, drawing)
        if self.settings.line.lines in ("contours", "outer"):
            yield from of_pieces(drawing, followed, self.of_head)
            tool, contour = self.settings.tool, self.settings.contour.contouring()
            if tool.cutter() is None and not contour.asks:  # which say it in their own words
                yield from of_open(followed)
        yield from of_order(followed, self.settings.line.order)
        if led is not None:
            yield from led.remarks()

    def _across_skips(self, drawing: Drawing, listener: Listener) -> Tracing:
        """The same across the gaps that the pen has left in its line, if nobody has set the widest gap."""
        gap_mm = gap_across_skips(drawing, self.settings.line, self.of_head)
        if gap_mm is None:
            return self
        listener.note(
            f"the pen has skipped: gaps of up to {gap_mm:.1f} mm are crossed; --gap "
            f"{self.of_head.gap_mm:g}mm ends lines at wider ones"
        )
        return replace(self, of_head=replace(self.of_head, gap_mm=gap_mm))

    def _on(self, drawing: Drawing) -> Tracing:
        """The same with the start, the direction and the reference point of the drawing's corrections, where
        nobody has asked for others.
        """
        laid, line = drawing.corrected, self.settings.line
        if laid is None or line.lines == "all":
            return self
        if line.reference_mm is None:
            line = replace(line, reference_mm=laid.reference_mm)
        if line.start_mm is None and not line.are_several and not line.arrows_mm:
            line = replace(
                line, start_mm=laid.start_mm, direction=line.direction or laid.direction
            )
        operator = replace(
            self.operator, reference_mm=line.reference_mm, direction=line.direction
        )
        return replace(self, settings=replace(self.settings, line=line), operator=operator)

    def on_machine(self, unit: RecordingUnit, program: FilePath | None) -> Tracing:
        """The same with the direction of closed lines that a machine asks for, if nobody asks for another.

        Of a program that is mirrored the lines run the other way round on the drawing. A ramp has the angle
        that is asked for after X and Y are scaled, which Z is not.
        """
        contour = self.settings.contour.on_machine(
            unit.milling(program), self.settings.line.direction, bool(unit.mirror)
        )
        settings, work = replace(self.settings, contour=contour), self.operator.work
        if work.ramp_rad is not None:
            work = replace(work, ramp_rad=math.atan(unit.scale * math.tan(work.ramp_rad)))
        return replace(self, settings=settings, operator=replace(self.operator, work=work))

    def _cut(
        self, drawing: Drawing, followed: Trace, listener: Listener
    ) -> tuple[Trace, Left | None]:
        """The program as the tool runs it, and what a cutter leaves."""
        cutter = self.settings.tool.cutter()
        contouring = self.settings.contour.contouring()
        if cutter is None and not contouring.asks:
            return followed, None
        in_lost = dict[int, int]()
        if followed.fault is not None or self.settings.line.lines not in ("contours", "all"):
            from morfax.tracer.program.lines.around import around

            found = around(drawing, followed.lines)
            in_lost = {each.line: each.outer for each in found if each.is_lost}
            for text in of_around(found, cutter, contouring):
                listener.warning(text)
        if cutter is not None:
            from morfax.tracer.cutter.cutter import with_cutter

            speed_mm_s = self.of_head.speed_mm_s
            return with_cutter(followed, cutter, speed_mm_s, contouring, in_lost)
        from morfax.tracer.cutter.along_lines import contoured

        return contoured(followed, contouring, self.of_head.speed_mm_s), None

    def _followed(self, drawing: Drawing, listener: Listener) -> Trace:
        """The line that the head followed, or the lines."""
        from morfax.tracer.program.trace import trace

        line = self.settings.line
        with listener.progress("following the line", 1.0) as advance:
            tell = never_back(advance)
            if line.arrows_mm or line.more_starts_mm:
                starts_mm = line.starts_mm
                if starts_mm:
                    from morfax.tracer.program.trace_lines import trace_places

                    return trace_places(drawing, starts_mm, self.of_head, self.operator, tell)
            if line.lines is None:
                return trace(drawing, line.start_mm, self.of_head, self.operator, tell)
            from morfax.tracer.program.trace_lines import trace_lines

            if line.lines != "all":
                return trace_lines(drawing, line.lines, self.of_head, self.operator, tell)
            if drawing.edges_mm:  # of filled shapes: every edge is a contour
                return trace_lines(drawing, "contours", self.of_head, self.operator, tell)
            from morfax.tracer.program.trace_ink import trace_ink

            # crosses and ticks are lines then: no turns and no stops
            return trace_ink(
                replace(drawing, corrected=None),
                self.of_head,
                self.operator,
                tell,
            )


def _refuse_marks(settings: TraceSettings, card: Card) -> None:
    """Raise WrongUse if all the ink is to be followed, and crosses, ticks or dots of it are to be marks."""
    if settings.line.lines != "all":
        return
    asked = {
        "the card's stops": card.stops,
        "the card's turns": card.turns,
        "--reference-point": settings.line.reference_mm,
        "--direction": settings.line.direction,
    }
    for what, given in asked.items():
        if given:
            raise WrongUse(
                f"--lines all follows crosses, ticks and dots as lines, and does not take {what}; give"
                " --lines contours"
            )


def waits(card: Card) -> bool:
    """Whether a card has stops that wait for the operator's button."""
    return "manual" in (card.restart, *(stop.restart for stop in card.stops))
