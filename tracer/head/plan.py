"""A plan: the course that `junctions` or `tangles` hand to the head, and the leg to follow from there."""

from __future__ import annotations

from typing import NamedTuple

from morfax.motion.arrays import Array
from morfax.tracer.head.leaders import MEMORY
from morfax.tracer.sensing.leg import Leg


class Plan(NamedTuple):
    """Stretches (n, 2) mm from where the head is, the leg they lead to, and the stations (n, 3) felt.

    `leader` tells by what the stretches were laid (see `leaders`).
    """

    stretches: list[Array]
    leg: Leg
    seen: Array | None = None
    leader: int = MEMORY
