"""What a job says of its ink: a pen that skips, pale lines."""

from __future__ import annotations

from morfax.jobs.line_settings import LineSettings
from morfax.jobs.listener import Silent
from morfax.jobs.settings import TraceSettings
from morfax.jobs.tracing import Tracing
from morfax.tracer.drawing.drawing import Drawing
from tests.tracer.drawing.test_skips import ring
from tests.tracer.ink.test_pale import with_pale_bar
from tests.tracer.inked import inked


class Heard(Silent):
    """A listener that keeps what it hears."""

    def __init__(self) -> None:
        self.said = list[str]()

    def note(self, text: str) -> None:
        self.said.append(text)

    def warning(self, text: str) -> None:
        self.said.append(text)


def said_of(drawing: Drawing, line: LineSettings) -> tuple[list[str], list[str]]:
    """What is said of a drawing, and how its lines end."""
    heard = Heard()
    traced = Tracing.prepared(TraceSettings(line)).trace(drawing, heard)
    return heard.said, [line.ending for line in traced.trace.lines]


def test_skips_are_crossed_and_told_unless_a_gap_is_set() -> None:
    drawing = inked(*ring(0.7, 0.7, 0.7, 0.7), seed=1)
    said, endings = said_of(drawing, LineSettings())
    assert endings == ["closed"] and any("the pen has skipped" in text for text in said)
    said, endings = said_of(drawing, LineSettings(gap_mm=0.5))
    assert endings == ["ended"] and not any("skipped" in text for text in said)


def test_pale_lines_are_told_where_all_ink_is_asked_for() -> None:
    said, _ = said_of(with_pale_bar(0.3), LineSettings(lines="all"))
    assert any("mm of line (17 %) are left out" in text for text in said)
    said, _ = said_of(with_pale_bar(0.0), LineSettings(lines="all"))
    assert not any("left out" in text for text in said)
