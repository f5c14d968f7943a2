"""Two lines: traced lines that may be two lines side by side, which the scan hardly parts.

    hollow    the ink is paler in its middle than at its sides           (`hollow_lines`)
    narrow    the path runs over a strip of paper of a pixel or two      (`narrow_gaps`)
    broad     the ink is as wide as two lines of the sheet's pen         (`broad_lines`)

Signals in: the drawing, and the lines as the head followed them. Signals out: figures, remarks, and the
places that a picture marks.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from morfax.jobs.remarks.broad_lines import BroadLines
from morfax.jobs.remarks.hollow_lines import HollowLines
from morfax.jobs.remarks.narrow_gaps import NarrowGaps

if TYPE_CHECKING:
    from morfax.tracer.drawing.drawing import Drawing
    from morfax.tracer.program.program import Trace


@dataclass(frozen=True, slots=True)
class TwoLines:
    """The lines that may be two, by what shows it."""

    hollow: HollowLines = field(default_factory=HollowLines)
    narrow: NarrowGaps = field(default_factory=NarrowGaps)
    broad: BroadLines = field(default_factory=BroadLines)

    @classmethod
    def along(cls, drawing: Drawing, trace: Trace) -> TwoLines:
        """Those among the lines that the head followed; none is told twice."""
        hollow = HollowLines.along(drawing, trace)
        narrow = NarrowGaps.along(drawing, trace)
        told = frozenset(number for number, _ in (*hollow.of_lines, *narrow.of_lines))
        return cls(hollow, narrow, BroadLines.along(drawing, trace, told))

    def figures(self) -> dict[str, Any]:
        """The figures of all."""
        return self.hollow.figures() | self.narrow.figures() | self.broad.figures()

    def remarks(self) -> Iterator[str]:
        """What is to be said of all."""
        yield from self.hollow.remarks()
        yield from self.narrow.remarks()
        yield from self.broad.remarks()

    @property
    def marked_mm(self) -> dict[str, tuple[float, float]]:
        """The places that a picture marks, by name."""
        return self.hollow.marked_mm | self.narrow.marked_mm | self.broad.marked_mm
