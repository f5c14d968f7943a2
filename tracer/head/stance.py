"""The stance: how the head is put down on a line, before it follows."""

from __future__ import annotations

import math
from dataclasses import dataclass

from morfax.motion.arrays import Array
from morfax.tracer.sensing.view import View


@dataclass(frozen=True, slots=True)
class Stance:
    """The head put down: place on the line, heading along it, and how it sees the line."""

    place_mm: Array
    heading_rad: float
    view: View
    at_end: bool = False  # of a line
    reference_mm: tuple[float, float] | None = (
        None  # the reference point that the line starts from
    )


def turned_round(end_mm: Array, heading_rad: float, view: View) -> Stance:
    """The head at the end of a line where it arrived on a heading, to go back along it."""
    return Stance(end_mm, math.remainder(heading_rad + math.pi, math.tau), view, True)
