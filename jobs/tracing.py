"""A drawing traced, for every job that traces one: the head follows the lines, the cutter runs beside them.

Signals: a Drawing and the settings in; out the program with what the cutter cannot reach (see `traced`). What
the operator should know about the run goes to the listener as warnings (see `remarks`).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from morfax.jobs.depths import of_tabs
from morfax.jobs.remarks import of_cutter, remarks
from morfax.jobs.traced import Traced
from morfax.jobs.wrong_use import WrongUse
from morfax.motion.faults import CardFault

if TYPE_CHECKING:
    from morfax.jobs.listener import Listener
    from morfax.jobs.settings import TraceSettings
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
        if settings.line.lines is not None and settings.line.start_mm is not None:
            raise WrongUse("--start picks one line, --lines several; give one of them")
        if settings.line.more_starts_mm and settings.line.start_mm is None:
            raise WrongUse("more_starts_mm are further places; give the first one as start_mm")
        card = settings.card()
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
        from morfax.motion.motion import thin

        # 1. the head follows
        listener.compiling("the head", ("motion", "tracer", "recorder"))
        followed = self._followed(drawing, listener)
        for text in remarks(followed, self.settings, self.of_head.gap_mm, drawing.enlarged):
            listener.warning(text)
        # 2. the machine's zero
        origin_mm = self._origin_mm(drawing, followed)
        # 3. the cutter beside the lines
        cutter, left, beside = self.settings.tool.cutter(), None, followed
        if cutter is not None:
            from morfax.tracer.cutter.cutter import with_cutter

            beside, left = with_cutter(followed, cutter, self.of_head.speed_mm_s)
            for text in of_cutter(beside, left, cutter):
                listener.warning(text)
        for text in of_tabs(beside):
            listener.warning(text)
        several = self.settings.line.are_several
        return Traced(beside, thin(beside), several, origin_mm, cutter, left)

    def _followed(self, drawing: Drawing, listener: Listener) -> Trace:
        """The line that the head followed, or the lines."""
        from morfax.tracer.program.trace import trace
        from morfax.tracer.program.trace_lines import trace_lines, trace_places

        line = self.settings.line
        with listener.progress("following the line", 1.0) as advance:

            def tell(come_mm: float, all_mm: float) -> None:
                advance(come_mm / all_mm)

            if line.more_starts_mm and line.start_mm is not None:
                starts_mm = (line.start_mm, *line.more_starts_mm)
                return trace_places(drawing, starts_mm, self.of_head, self.operator, tell)
            if line.lines is None:
                return trace(drawing, line.start_mm, self.of_head, self.operator, tell)
            return trace_lines(drawing, line.lines, self.of_head, self.operator, tell)

    def _origin_mm(self, drawing: Drawing, followed: Trace) -> tuple[float, float]:
        """The machine's zero on the sheet; raises LineFault without the reference point that is asked for.

        The reference point is the one given, or that from which the program begins, or the only one drawn.
        """
        from morfax.tracer.following.start import reference_on

        origin = self.settings.program.origin
        if origin == "sheet":
            return (0.0, 0.0)
        if not isinstance(origin, str):
            return origin
        given_mm = self.settings.line.reference_mm
        return given_mm or followed.reference_mm or reference_on(drawing)


def waits(card: Card) -> bool:
    """Whether a card has stops that wait for the operator's button."""
    return "manual" in (card.restart, *(stop.restart for stop in card.stops))
