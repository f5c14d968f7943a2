"""The work: how deep the tool goes, and what it does at each halt of a line.

Signals: mm, mm/s and s. A halt is a place of a line where X and Y stand; an action is what Z does there.

Source: patent ES 361967, section on use. Questions: it gives no figures; the values here are our own.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np

from morfax.motion.arrays import Array
from morfax.tracer.operator.zunit import ACCELERATION_MM_S2, QuillMove


@dataclass(frozen=True, slots=True)
class Tabs:
    """Holding tabs: how many on a closed line, how wide their top is, and how high they stand, mm.

    What is cut out hangs on them until it is broken off. 3 mm by 1 mm are our own figures.
    """

    count: int
    width_mm: float = 3.0
    height_mm: float = 1.0


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
    tabs: Tabs | None = None
    # the tool goes in along the line at this angle; None: straight down
    ramp_rad: float | None = None
    peck_mm: float | None = None  # how deep a drill goes at a time; None: at once
    cutter_mm: float = 0.0  # the cutter's diameter, which a tab is longer by at its foot

    @property
    def depths_mm(self) -> tuple[float, ...]:
        """Depths at which each line is run, one after the other, mm."""
        return (*self.passes_mm, self.depth_mm)

    def ramp(self, from_mm: float, depth_mm: float) -> Descent | None:
        """The ramp from one depth to another, mm; None without ramps."""
        if self.ramp_rad is None or depth_mm <= from_mm:
            return None
        length_mm = (depth_mm - from_mm) / math.tan(self.ramp_rad)
        return Descent(depth_mm, length_mm, from_mm, is_straight=True)


@dataclass(frozen=True, slots=True)
class Halt:
    """Where the axis stands: the position of the line, the reason, and the number of a stop."""

    at: float
    kind: Literal["begin", "tick", "dot", "hole", "leave", "back", "loop"]
    place_mm: tuple[float, float]
    number: int | None = None


class Descent(NamedTuple):
    """Z goes down while X and Y move: from one depth to another over a length of the line, all mm.

    Straight down a slope, from rest to rest; or smoothly at both ends, 3s² - 2s³, while X and Y run on.
    """

    depth_mm: float
    length_mm: float
    from_mm: float = 0.0
    is_straight: bool = False

    def z_mm(self, come_mm: Array) -> Array:
        """Where Z is when the tool has come so far, (n,) mm."""
        share = np.minimum(come_mm / self.length_mm, 1.0)
        down = share if self.is_straight else share**2 * (3 - 2 * share)
        return -self.from_mm - (self.depth_mm - self.from_mm) * down


@dataclass(frozen=True, slots=True)
class Action:
    """What Z does at a halt: moves one after the other, each with its dwell, and an entry on the way after.

    Where the tool goes down into the line, `depths_mm` are the depths at which that line is run.
    """

    halt: Halt
    moves: tuple[QuillMove, ...]
    entry: Descent | None = None
    depths_mm: tuple[float, ...] = ()

    @property
    def z_mm(self) -> float:
        """Where the tool is after it, an entry included."""
        return self.moves[-1].to_mm if self.entry is None else -self.entry.depth_mm
