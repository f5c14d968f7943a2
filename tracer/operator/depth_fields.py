"""The fields of the card that say how deep: heights, passes, ramps, tabs.

Signals in: fields of the card. Signals out: mm, rad and Tabs, or a CardFault with what a field may hold.

Source: patent ES 361967, the five decade switches of the Z unit; ramps and tabs are our own, as in CAM.
"""

from __future__ import annotations

import math

from morfax.motion.toml_fields import Field, read
from morfax.motion.units import parse_angle_rad
from morfax.tracer.operator.counts_field import counts_in
from morfax.tracer.operator.work import Tabs
from morfax.tracer.operator.zunit import COUNTS_PER_MM

# the first count above IN_WORK_BELOW_MM, where the tool is out of the work
LEAST_START_COUNTS = 6
TABS_KEYS = ("count", "width", "height")
# flatter is lost in the noise of Z, steeper is a plunge
LEAST_RAMP_DEG, MOST_RAMP_DEG = 1.5, 45.0


def start_mm(field: Field) -> float:
    """Where the tool stands above the work, mm: out of the work."""
    return counts_in(field, LEAST_START_COUNTS) / COUNTS_PER_MM


def length_mm(field: Field) -> float:
    """A length that can be set on five decades, mm."""
    return counts_in(field) / COUNTS_PER_MM


def passes_mm(field: Field) -> tuple[float, ...]:
    """Depths in mm, each deeper than the one before."""
    allowed = 'depths, each deeper than the one before, such as ["2mm", "4mm"]'
    depths: list[int] = []
    for element in field.elements(allowed):
        counts = counts_in(element)
        if depths and counts <= depths[-1]:
            before_mm = depths[-1] / COUNTS_PER_MM
            element.refuse(f"it may hold more than the pass before, {before_mm:g} mm")
        depths.append(counts)
    return tuple(counts / COUNTS_PER_MM for counts in depths)


def ramp_rad(field: Field) -> float:
    """The angle at which the tool goes in along a line, rad."""
    allowed = f'it may hold {LEAST_RAMP_DEG:g} to {MOST_RAMP_DEG:g} degrees, such as "3deg"'
    try:
        angle_rad = parse_angle_rad(field.quantity(allowed))
    except ValueError:
        field.refuse(allowed)
    if not LEAST_RAMP_DEG <= round(math.degrees(angle_rad), 9) <= MOST_RAMP_DEG:
        field.refuse(allowed)
    return angle_rad


def tabs(field: Field) -> Tabs:
    """Holding tabs."""
    fields = field.table(*TABS_KEYS)
    if "count" not in fields:
        field.refuse("it must hold a count, such as { count = 4 }")
    usual = Tabs(fields["count"].number())
    return Tabs(
        usual.count,
        read(fields, "width", length_mm, usual.width_mm),
        read(fields, "height", length_mm, usual.height_mm),
    )
