"""Direction: which way the operator has the head take a line, and where it turns off."""

from __future__ import annotations

from typing import Literal, NamedTuple

from morfax.tracer.sensing.side import Side

Direction = Literal["cw", "ccw", "left", "right"]


class Route(NamedTuple):
    """How the operator has the head go: which way it takes the line, and to which side at each junction.

    A direction of None is either; a side of None is straight on, as at every junction after the last that is
    named.
    """

    direction: Direction | None = None
    sides: tuple[Side | None, ...] = ()
