"""Remarks on the reference point of a traced drawing: one that leads nowhere, and a ring that may be a hole.

Signals in: the traced lines, the drawing, and what was asked of the head. Signals out: texts, each with what
to do.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from morfax.jobs.numbered import numbered

if TYPE_CHECKING:
    from morfax.jobs.settings import TraceSettings
    from morfax.tracer.drawing.drawing import Drawing
    from morfax.tracer.program.program import Trace

INK = 0.5  # darker is ink: a cross has ink in its middle, and a ring has paper


def of_reference(trace: Trace, drawing: Drawing, settings: TraceSettings) -> Iterator[str]:
    """Remarks on a reference point that was given, or that was found without a card."""
    given = settings.line.reference_mm
    if given is not None:
        if not any(line.reference_mm == given for line in trace.lines):
            yield _leads_nowhere(given, settings)
    elif settings.program.card_file is None and settings.program.marks == "auto":
        yield from _of_rings(trace, drawing)


def _leads_nowhere(given: tuple[float, float], settings: TraceSettings) -> str:
    """A reference point that was given and from which no line begins."""
    from morfax.tracer.following.open_ends import LEAD_MM

    use = (
        "it is the machine's zero only"
        if settings.program.zero == "reference"
        else "the program does not begin there"
    )
    x, y = given
    return f"no line begins within {LEAD_MM:g} mm of the reference point {x:g},{y:g} mm: {use}"


def _of_rings(trace: Trace, drawing: Drawing) -> Iterator[str]:
    """Rings that were taken for reference points: they may be holes of the part."""
    from morfax.tracer.drawing.deviation import darkness_across

    places_mm = dict.fromkeys(
        line.reference_mm for line in trace.lines if line.reference_mm is not None
    )
    for place_mm in places_mm:
        here = np.array([place_mm])
        if darkness_across(drawing, here, np.zeros(1), np.zeros(1)).item() > INK:
            continue
        x, y = place_mm
        from_it = [
            line for line in trace.lines if line.reference_mm == place_mm and line.is_guide
        ]
        numbers = [line.number for line in from_it]
        too = f"; {numbered('line', numbers)} run from it with the tool up" if numbers else ""
        yield (
            f"the ring at {x:.1f},{y:.1f} mm is taken for the reference point of a drawn program, and is not "
            f"cut{too}: if it is a hole of the part, give --marks off"
        )
