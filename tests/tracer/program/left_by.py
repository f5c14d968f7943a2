"""What lines surely leave unexplained, as an operator is told of it."""

from __future__ import annotations

from morfax.tracer.following.line import Line
from morfax.tracer.program.against_ink.own_ink import OwnInk
from morfax.tracer.program.against_ink.unexplained import Unexplained, unexplained
from morfax.tracer.program.setup import Setup


def left_by(setup: Setup, lines: list[Line]) -> tuple[Unexplained, ...]:
    """What some lines surely leave unexplained, the longest first."""
    places = unexplained(setup, OwnInk(setup.sheet.drawing, lines))
    return tuple(place for place in places if place.is_sure)
