"""Remarks on the reference point of a traced drawing: one that leads nowhere, a ring that may be a hole, and
a hole that may be the reference point.

Signals in: the traced lines, the drawing, and what was asked of the head. Signals out: texts, each with what
to do.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from morfax.motion.by_number import numbered
from morfax.tracer.limits import AHEAD_RAD

if TYPE_CHECKING:
    from morfax.jobs.settings.settings import TraceSettings
    from morfax.tracer.drawing.drawing import Drawing
    from morfax.tracer.following.line import Line
    from morfax.tracer.program.program import Trace

Place = tuple[float, float]
LEAD_PLACES = 40  # of a line from an end, 2 mm at 10 mm/s: they show its heading there
INK = 0.5  # darker is ink: a cross has ink in its middle, and a ring has paper


def of_reference(trace: Trace, drawing: Drawing, settings: TraceSettings) -> Iterator[str]:
    """Remarks on a reference point that was given, or that was found without a card."""
    given = settings.line.reference_mm
    if given is not None:
        if not any(line.reference_mm == given for line in trace.lines):
            yield _leads_nowhere(given, settings)
    elif settings.program.card_file is None and settings.program.marks == "auto":
        yield from _of_rings(trace, drawing)
        if trace.ink is None and trace.reference_mm is None:
            yield from _of_holes(trace)


def of_zero(zero_mm: Place, trace: Trace, settings: TraceSettings) -> Iterator[str]:
    """The zero at a cross or ring that nobody has named, and from which no line begins: perhaps a hole."""
    is_sought = settings.program.zero == "reference" and settings.line.reference_mm is None
    if is_sought and trace.reference_mm is None:
        x, y = zero_mm
        yield (
            f"the program's zero is the only small cross or ring on the drawing, at {x:.1f},{y:.1f} mm, "
            "though no line begins there: if it is a hole or a symbol, give --reference-point X,Y"
        )


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


def _of_holes(trace: Trace) -> Iterator[str]:
    """Rings that are cut as holes though a line leads away from them: the first, and how many more."""
    found = [
        (hole, line, place_mm)
        for hole, place_mm in _rings_like_a_reference(trace)
        for line in trace.lines
        if line.ending == "ended" and _leads_away(line, place_mm)
    ]
    if not found:
        return
    hole, line, (x, y) = found[0]
    more = f", as at {len(found) - 1} more" if len(found) > 1 else ""
    yield (
        f"the ring at {x:.1f},{y:.1f} mm is cut as a hole, line {hole.number}{more}: line {line.number} "
        "leads away from it, but to no contour; if the ring is the reference point of a drawn program, give "
        "--marks on"
    )


def _rings_like_a_reference(trace: Trace) -> Iterator[tuple[Line, Place]]:
    """The lines that are rings of a reference point's size, and their middles, mm."""
    from morfax.motion.circle import circle_through
    from morfax.tracer.marks.reference import LARGEST_MM, LEAST_MM
    from morfax.tracer.marks.sizes import RING_ROUND

    for line in trace.lines:
        is_small = LEAST_MM < line.length_mm / math.pi < LARGEST_MM
        if line.ending != "closed" or line.is_lead or not is_small:
            continue
        centre, radius_mm, misfit_mm = circle_through(line.places_mm)
        if misfit_mm < RING_ROUND * radius_mm:
            yield line, (float(centre[0]), float(centre[1]))


def _leads_away(line: Line, place_mm: Place) -> bool:
    """Whether an open line begins near a place, at one of its ends, and leads away from it."""
    from morfax.tracer.following.open_ends import LEAD_MM
    from morfax.tracer.sensing.leg import turn

    for way in (line.places_mm, line.places_mm[::-1]):
        inward = way[: LEAD_PLACES + 1]
        x, y = way[0] - np.asarray(place_mm)
        u, v = inward[-1] - inward[0]
        away = abs(turn(math.atan2(y, x), math.atan2(v, u))) < AHEAD_RAD
        if math.hypot(x, y) < LEAD_MM and away:
            return True
    return False
