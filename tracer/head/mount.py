"""The mount: how far ahead of the axis the cell swings, and about which place.

Signals: the head's state, legs and what was felt of them (sheet mm) in; the mount's lead and the middle of
its sweep, mm, out.

The mount slides on its guide. Out to its full lead it goes as fast as the axis does (see `swinging`), so that
the drum has no gap; it is drawn in at once, for the drum holds those places already.

Source: our own; mount 42 of patent ES 361967, figure 1, stands at one lead.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from morfax.motion.arrays import Array
from morfax.tracer.head.state import field_of, set_fields
from morfax.tracer.sensing.leg import Leg

# of the lead: what was felt of a leg this far ahead tells where the cell will see it
FELT_ENOUGH = 0.5


def begin_sweep(state: Any) -> None:
    """Begin a sweep anew: the detector is empty."""
    set_fields(state, sweep_periods=0, first_sum=0.0, mean_sum=0.0)


def set_to(state: Any, lead_mm: float) -> None:
    """Set the mount to a lead, with its sweep about the curve that the line has been on."""
    was_mm, middle_mm = field_of(state, "lead_mm"), field_of(state, "middle_mm")
    set_fields(state, middle_mm=middle_mm * (lead_mm / was_mm) ** 2, lead_mm=lead_mm)
    begin_sweep(state)


def middle_on(leg: Leg, felt: Array, lead_mm: float) -> float:
    """Where the swinging cell will see a leg, mm aside: by what was felt ahead, else by its bend."""
    c, n = math.cos(leg.heading_rad), math.sin(leg.heading_rad)
    along = aside = 0.0
    if len(felt):
        along, aside = (felt[-1] - leg.end_mm) @ np.array([[c, -n], [n, c]])
    if along > FELT_ENOUGH * lead_mm:
        return float(aside * (lead_mm / along) ** 2)
    return 0.5 * leg.bend_per_mm * lead_mm * lead_mm
