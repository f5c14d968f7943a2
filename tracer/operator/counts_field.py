"""A length on the card, in counts of the Z unit.

Signals in: a field of the card that holds a length. Signals out: counts of 0.01 mm, or a CardFault that names
the lengths that five decades can be set to.

Source: patent ES 361967, the five decade switches of the Z unit.
"""

from __future__ import annotations

from morfax.motion.toml_fields import Field
from morfax.motion.units import parse_length_mm
from morfax.motion.usual import COUNT_MM
from morfax.tracer.operator.zunit import COUNTS_PER_MM, LARGEST_COUNT, counts_of


def counts_in(field: Field, least: int = 1) -> int:
    """Counts of a length that can be set on five decades; raises CardFault for any other value."""
    allowed = (
        f"it may hold {least * COUNT_MM:.2f} to {LARGEST_COUNT * COUNT_MM:.2f} mm "
        f'in steps of {COUNT_MM:g} mm, such as "2.5mm"'
    )
    try:
        length_mm = parse_length_mm(field.quantity(allowed))
        settable = abs(length_mm) * COUNTS_PER_MM <= LARGEST_COUNT + 1
        counts = counts_of(length_mm) if settable else -1
    except ValueError:
        field.refuse(allowed)
    if not least <= counts <= LARGEST_COUNT:
        field.refuse(allowed)
    return counts
