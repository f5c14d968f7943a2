"""TODO."""

from __future__ import annotations

from typing import NamedTuple

from morfax.motion.arrays import Array
from morfax.tracer.sensing.leg import Leg


class Planned(NamedTuple):
    """Stretches from where the head is, the leg that they lead to, and what of the line was felt clean on the
    way.
    """

    stretches: list[Array]
    leg: Leg
    seen: Array | None = None
