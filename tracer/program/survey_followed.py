"""The survey of lines that have been followed: every number, as the run along it came out.

Signals: a survey and a set-up in; the survey out, with an entry for each line that is joined to another.

Source: our own.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from morfax.motion import nesting
from morfax.tracer.following.line import Line
from morfax.tracer.program.lines import selection
from morfax.tracer.program.setup import Setup
from morfax.tracer.program.survey import Entry, Kind, Survey
from morfax.tracer.program.trace_lines import found_lines

KINDS: dict[str, Kind] = {
    "closed": "closed",
    "ended": "open",
    "joined": "joined",
    "lost": "lost",
}  # of endings


def followed(seen: Survey, setup: Setup) -> Survey:
    """The survey with all lines followed; raises LineFault for what none can be followed on."""
    found = found_lines(setup, "contours")
    lines = {line.number: line for line in found.lines}
    contours, _ = selection.plan(seen.sheet, "contours")
    strokes = {contour.number: contour for contour in contours}
    entries = dict[int, Entry]()
    # 1. what was seen
    for entry in seen.entries:
        if entry.kind == "dot":
            entries[entry.number] = entry
        elif entry.number in lines:
            entries[entry.number] = _came_out(entry, lines[entry.number])
        else:
            along = [
                n for n, line in lines.items() if strokes[entry.number].lies_on(line.places_mm)
            ]
            entries[entry.number] = replace(entry, piece_of=along[0] if along else None)
    # 2. lines that are joined to another
    for number, patch in found.patch_of.items():
        own = replace(entries[patch], number=number, joined_to=patch)
        entries[number] = _came_out(own, lines[number])
    # 3. what lies inside which
    inside = _insides(found.lines)
    nested = [
        replace(entry, inside=inside.get(entry.number, entry.inside))
        for _, entry in sorted(entries.items())
    ]
    return replace(
        seen,
        entries=tuple(nested),
        lines=tuple(found.lines),
        not_followed_mm=found.left_out_mm(),
    )


def _came_out(entry: Entry, line: Line) -> Entry:
    """An entry as its line was followed."""
    return replace(
        entry,
        kind=KINDS[line.ending],
        place_mm=line.start_mm,
        length_mm=line.length_mm,
        width_mm=line.width_mm,
        can_begin=len(line.xy_mm) > 1,
        reference_mm=line.reference_mm,
    )


def _insides(lines: list[Line]) -> dict[int, int | None]:
    """The number of the smallest closed line round each line."""
    loops_mm = [line.loop_mm for line in lines]
    inside = nesting.nested(loops_mm, [not line.is_open for line in lines])
    sizes_mm2 = np.array([float(np.prod(np.ptp(loop_mm, axis=0))) for loop_mm in loops_mm])
    around = dict[int, int | None]()
    for line, outer in zip(lines, inside, strict=True):
        nearest = np.argmin(np.where(outer, sizes_mm2, np.inf)) if outer.any() else None
        around[line.number] = None if nearest is None else lines[nearest].number
    return around
