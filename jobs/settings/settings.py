"""Settings: what somebody sets for a drawing, its lines, the head, the tool and the program.

All are plain values. None means "not set": the operator's card then decides, after it the file of settings,
and at last the head's and the tool's own values.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path as FilePath
from typing import TYPE_CHECKING

from morfax.jobs.settings.contour_settings import ContourSettings
from morfax.jobs.settings.depths import DepthSettings, passes_mm
from morfax.jobs.settings.line_settings import LineSettings
from morfax.jobs.wrong_use import settings_checked

if TYPE_CHECKING:
    from morfax.jobs.settings.zero import Zero
    from morfax.recorder.gcode.machine import UsualLines
    from morfax.tracer.cutter.cutter import Cutter, CutterSide
    from morfax.tracer.head.settings import Settings
    from morfax.tracer.operator.card import Card, Override
    from morfax.tracer.operator.operator import Marks, Operator, Panel
    from morfax.tracer.operator.work import Work


@dataclass(frozen=True, slots=True)
class HeadSettings:
    """Which head follows, and what is changed about it: its speed, a file of settings, settings by name."""

    kind: str = "precise"
    speed_mm_s: float | None = None
    settings_file: FilePath | None = None
    changes: tuple[str, ...] = ()  # NAME=VALUE


@dataclass(frozen=True, slots=True)
class ToolSettings:
    """How deep the tool goes, where it stands above the work, and the cutter that runs beside the lines."""

    depth_mm: float | None = None
    clearance_mm: float | None = None
    cutter_mm: float | None = None  # diameter; None: the tool runs on the line
    side: CutterSide = "outside"

    def described(self, scale: float) -> str:
        """The tool that a program of this scale needs, in the words of its head."""
        if self.cutter_mm is None:
            return "on the line"
        return f"{scale * self.cutter_mm:g} mm wide, {self.side}"

    def cutter(self) -> Cutter | None:
        """The cutter, if there is one."""
        if self.cutter_mm is None:
            return None
        from morfax.tracer.cutter.cutter import Cutter

        return Cutter(self.cutter_mm, self.side)


@dataclass(frozen=True, slots=True)
class ProgramSettings:
    """What is done at the stops, and where the zero of the program is."""

    card_file: FilePath | None = None
    stop_override: Override | None = None  # None: the card's
    zero: Zero = "sheet"
    marks: Marks = "auto"  # a card or an override is for marks


@dataclass(frozen=True, slots=True)
class TraceSettings:
    """All that is set for tracing a drawing."""

    line: LineSettings = field(default_factory=LineSettings)
    head: HeadSettings = field(default_factory=HeadSettings)
    tool: ToolSettings = field(default_factory=ToolSettings)
    program: ProgramSettings = field(default_factory=ProgramSettings)
    depths: DepthSettings = field(default_factory=DepthSettings)
    contour: ContourSettings = field(default_factory=ContourSettings)

    def with_usual_lines(self, of_machine: UsualLines | None = None) -> TraceSettings:
        """The same, with the lines that a cutter or the machine is for, where nobody asks for some of them.

        Beside lines a cutter runs round all contours: a part is cut with its holes. A card is for one drawn
        program, and so are marks and directions, which are no lines of a machine that draws all the ink.
        """
        line, program = self.line, self.program
        usual = of_machine if self.tool.cutter_mm is None else "contours"
        if usual is None or line.is_asked_for or program.card_file is not None:
            return self
        of_a_program = line.reference_mm, line.direction, program.stop_override
        is_program = program.marks == "on" or any(given is not None for given in of_a_program)
        if usual == "all" and (is_program or line.order):
            return self
        return replace(self, line=replace(line, lines=usual))

    def card(self) -> Card:
        """The operator's card, an empty one if no file is given; raises CardFault for a mistake on it."""
        from morfax.tracer.operator.card import Card

        file = self.program.card_file
        card = Card() if file is None else Card.open(file)
        override = self.program.stop_override
        return self.depths.on(card if override is None else replace(card, override=override))

    def of_head(self, card: Card | None = None) -> Settings:
        """Settings of the head; raises WrongUse for one that the head does not have or cannot take."""
        from morfax.tracer.head.settings import choose

        card = self.card() if card is None else card
        changes: dict[str, object] = dict(self._filed())
        by_options: dict[str, object] = {
            "speed_mm_s": _first_set(self.head.speed_mm_s, card.trace_mm_s),
            "gap_mm": self.line.gap_mm,
            "recatch_mm": self.line.recatch_mm,
            "line_width_mm": self.line.line_width_mm,
        }
        changes.update({name: v for name, v in by_options.items() if v is not None})
        for change in self.head.changes:
            name, _, value = change.partition("=")
            changes[name.strip()] = value.strip()
        with settings_checked():
            return choose(self.head.kind, changes)

    def operator(self, card: Card, panel: Panel | None) -> Operator:
        """What is done at the stops, by the card and whoever is at the panel."""
        from morfax.tracer.following.direction import Arrow
        from morfax.tracer.operator.operator import Operator

        line = self.line
        program = self.program
        for_marks = program.card_file is not None or program.stop_override is not None
        marks = "on" if program.marks == "auto" and for_marks else program.marks
        work = self._work(card)
        arrows = tuple(Arrow(*each) for each in line.arrows_mm)
        where = line.reference_mm, line.direction
        letters_from_mm = line.letters_from_mm(self.tool.cutter_mm or 0.0)
        return Operator(work, card, panel, *where, marks, arrows, line.order, letters_from_mm)

    def _filed(self) -> dict[str, float]:
        """Settings of the head in the file, by name."""
        if self.head.settings_file is None:
            return {}
        from morfax.tracer.operator.settings_file import read_changes

        return read_changes(self.head.settings_file)

    def _work(self, card: Card) -> Work:
        """Depths, feeds and clearance of the tool; of the card's passes those above the depth."""
        from morfax.tracer.operator.work import Work

        usual = Work()
        of_card_mm = card.depths_mm[-1] if card.depths_mm else None
        depth_mm = _first_set(self.tool.depth_mm, of_card_mm, usual.depth_mm)
        clearance_mm = _first_set(self.tool.clearance_mm, card.start_mm, usual.clearance_mm)
        assert depth_mm is not None and clearance_mm is not None
        return replace(
            usual,
            depth_mm=depth_mm,
            clearance_mm=clearance_mm,
            feed_mm_s=card.feed_mm_s or usual.feed_mm_s,
            rapid_mm_s=card.rapid_mm_s or usual.rapid_mm_s,
            passes_mm=passes_mm(card, depth_mm),
            tabs=card.tabs,
            ramp_rad=card.ramp_rad,
            peck_mm=card.peck_mm,
            cutter_mm=self.tool.cutter_mm or 0.0,
        )


def _first_set(*values: float | None) -> float | None:
    """The first value that is set."""
    return next((value for value in values if value is not None), None)
