"""Places on traced lines of which a report warns: a figure for each, one remark, and marks in a picture.

Signals in: what was found, with the lines' numbers. Signals out: figures, and the places that a picture
marks.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, ClassVar, Protocol

from morfax.jobs.figures import FEW_PLACES


class Located(Protocol):
    """What was found on a line, and where that is, sheet mm."""

    @property
    def place_mm(self) -> tuple[float, float]:
        """Where it is."""


@dataclass(frozen=True, slots=True)
class OnLines:
    """What was found on lines, by the lines' numbers, the worst first."""

    called: ClassVar[str]  # in the figures
    marked: ClassVar[str]  # in a picture
    # the figures of each place, and what they are of it
    rows: ClassVar[tuple[tuple[str, str], ...]]

    of_lines: tuple[tuple[int, Located], ...] = ()

    def remarks(self) -> Iterator[str]:
        """What is to be said of the worst; nothing where nothing was found."""
        if self.of_lines:
            number, worst = self.of_lines[0]
            x, y = worst.place_mm
            yield self._of(
                f"line {number}", worst, f"{x:.1f},{y:.1f} mm", len(self.of_lines) - 1
            )

    def _of(self, line: str, worst: Any, at: str, others: int) -> str:
        """The remark of the worst, on a line and at a place, and of how many others."""
        raise NotImplementedError

    def figures(self) -> dict[str, Any]:
        """The figures of each place."""
        rows = [
            {"of_line": number} | {name: getattr(found, what) for name, what in self.rows}
            for number, found in self.of_lines
        ]
        return {self.called: rows or None}

    @property
    def marked_mm(self) -> dict[str, tuple[float, float]]:
        """The places that a picture marks, by name."""
        worst = self.of_lines[:FEW_PLACES]
        return {f"{self.marked} {k}": found.place_mm for k, (_, found) in enumerate(worst, 1)}
