"""What every recorder tells of the program file that it wrote."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Generic, Protocol, TypeVar


class Clocked(Protocol):
    """A format whose intervals all take the same time."""

    @property
    def interval_s(self) -> float: ...


Format = TypeVar("Format", bound=Clocked)


@dataclass(frozen=True, slots=True)
class Written:
    """A program file that was written."""

    file: Path

    @property
    def bytes(self) -> int:
        """Size of the file."""
        return self.file.stat().st_size


@dataclass(frozen=True, slots=True)
class WrittenIntervals(Written, Generic[Format]):
    """A program of equal intervals: format, number of intervals, and largest distance from the motion."""

    format: Format
    intervals: int
    deviation_mm: float

    @property
    def duration_s(self) -> float:
        """Running time of the program, s."""
        return self.intervals * self.format.interval_s
