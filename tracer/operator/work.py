"""The work: how deep the tool goes, and what it does at each halt of a line.

Signals: mm, mm/s and s. A halt is a place of a line where X and Y stand; an action is what Z does there.

Source: patent ES 361967, section on use. Questions: it gives no figures; the values here are our own.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, NamedTuple

from morfax.tracer.operator.zunit import ACCELERATION_MM_S2, Move


@dataclass(frozen=True, slots=True)
class Work:
    """How deep the tool goes, where it stands above the work between lines, and how fast Z moves."""

    depth_mm: float = 5.0
    clearance_mm: float = 2.0
    feed_mm_s: float = 5.0
    acceleration_mm_s2: float = ACCELERATION_MM_S2
    # from line to line; half of what a tape of 6 kHz and 20 cycles per mm carries
    rapid_mm_s: float = 50.0
    passes_mm: tuple[float, ...] = ()  # depths of the passes before the last

    @property
    def depths_mm(self) -> tuple[float, ...]:
        """Depths at which each line is run, one after the other, mm."""
        return (*self.passes_mm, self.depth_mm)


@dataclass(frozen=True, slots=True)
class Halt:
    """Where the axis stands: the position of the line, the reason, and the number of a stop."""

    at: float
    kind: Literal["begin", "tick", "dot", "hole", "leave", "back", "loop"]
    place_mm: tuple[float, float]
    number: int | None = None


class Entry(NamedTuple):
    """Z goes down while X and Y move: from the surface to a depth over a length of the line, both mm."""

    depth_mm: float
    length_mm: float


@dataclass(frozen=True, slots=True)
class Action:
    """What Z does at a halt: moves one after the other, each with its dwell, and an entry on the way after.

    Where the tool goes down into the line, `depths_mm` are the depths at which that line is run.
    """

    halt: Halt
    moves: tuple[Move, ...]
    entry: Entry | None = None
    depths_mm: tuple[float, ...] = ()
