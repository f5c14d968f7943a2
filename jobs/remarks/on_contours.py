"""Remarks on contoured lines: leads that are shorter than asked for, and lines that keep their direction.

Signals in: the traced lines, and what was asked for. Signals out: texts, each with what to do.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from morfax.motion.by_number import numbered

if TYPE_CHECKING:
    from morfax.tracer.cutter.contouring import Contouring, Lead
    from morfax.tracer.cutter.cutter import Cutter
    from morfax.tracer.following.line import Line
    from morfax.tracer.program.lines.around import Around
    from morfax.tracer.program.program import Trace

CLOSE = (
    "if a closed line is meant, close its gap on the drawing, or by `morfax correct --bridge`"
)
FEW = 6  # lines that are listed with their leads; of more the shortest


def of_contouring(trace: Trace, contouring: Contouring) -> Iterator[str]:
    """Remarks on a program whose closed lines were contoured."""
    if trace.fault is not None and contouring.asks:
        yield (
            "a line was lost, so morfax cannot know which lines are holes: some lines may be cut as traced; "
            "mend the drawing where it was lost, and trace it again"
        )
        return
    closed = [line for line in trace.lines if line.ending == "closed"]
    if contouring.lead_in is not None:
        yield from _of_leads("lead-in", contouring.lead_in, closed)
    if contouring.lead_out is not None:
        yield from _of_leads("lead-out", contouring.lead_out, closed)
    asked = contouring.milling is not None and not contouring.by_machine
    numbers = _cut_open(trace)
    if numbers and (asked or contouring.moves_start):
        yield (
            f"{numbered('line', numbers)} open and cut as traced: direction, start and leads are for closed"
            f" lines; {CLOSE}"
        )


def of_open(trace: Trace) -> Iterator[str]:
    """Open lines among closed ones, which run along with them as if they were contours of a part."""
    numbers = [number for number in _cut_open(trace) if number not in trace.letters]
    if numbers and any(line.ending == "closed" for line in trace.lines):
        run = "runs" if len(numbers) == 1 else "run"
        yield (
            f"{numbered('line', numbers)} open, and {run} from end to end with the closed ones; to leave out "
            "what is no outline, such as large letters, give the numbers of the others after --lines; "
            f"{CLOSE}"
        )


def of_order(trace: Trace, order: Sequence[int]) -> Iterator[str]:
    """Lines that the operator has put behind one in which they lie."""
    if not order:
        return
    from morfax.motion.nesting import nested

    lines = [line for line in trace.lines if len(line.xy_mm) > 1]
    inside = nested([line.loop_mm for line in lines], [not line.is_open for line in lines])
    for outer in range(len(lines)):
        late = [lines[i].number for i in range(outer + 1, len(lines)) if inside[i, outer]]
        if late:
            numbers = ", ".join(map(str, late))
            yield (
                f"--order cuts line {lines[outer].number} before line {numbers} inside it: the part may be"
                " loose by then; give the inner ones first"
            )


def of_around(
    found: Sequence[Around], cutter: Cutter | None, contouring: Contouring
) -> Iterator[str]:
    """Lines that look like the outline of a part only because the line round them was not asked for."""
    inner = [each for each in found if not each.is_lost]
    on_side = contouring.has_leads or contouring.milling is not None
    if not inner or (cutter.side != "outside" if cutter is not None else not on_side):
        return
    lines = ", ".join(str(each.line) for each in inner)
    outer = ", ".join(str(number) for number in sorted({each.outer for each in inner}))
    do = "" if cutter is None else "give --side inside for a hole, or "
    are = f"line {lines} lies" if len(inner) == 1 else f"lines {lines} lie"
    yield (
        f"{are} inside line {outer}, which is not cut: without line {outer} morfax cuts the outline of a part"
        f" there, not a hole; {do}cut line {outer}, too"
    )


def _of_leads(name: str, asked: Lead, closed: list[Line]) -> Iterator[str]:
    """The lines whose leads are shorter than asked for, with what each has."""
    got = [(_size_mm(name, line), line.number) for line in closed if not line.is_lead]
    short = sorted(pair for pair in got if pair[0] < asked.size_mm)
    if not short:
        return
    listed = [
        f"{size_mm:g} mm at line {number}" if size_mm else f"none at line {number}"
        for size_mm, number in short[:FEW]
    ]
    more = (
        f" and {len(short) - FEW} more lines, which the figures list"
        if len(short) > FEW
        else ""
    )
    fits_mm = math.floor(10 * short[0][0]) / 10  # in whole tenths
    kind = ",line" if asked.kind == "line" else ""
    fits = f"; --{name} {fits_mm:g}mm{kind} fits everywhere" if fits_mm else ""
    yield (
        f"there is no room for a {name} of {asked.size_mm:g} mm everywhere: {', '.join(listed)}{more}{fits}"
    )


def _size_mm(name: str, line: Line) -> float:
    """The size of a line's lead, mm; 0 without."""
    if line.leads is None:
        return 0.0
    return round(line.leads.in_mm if name == "lead-in" else line.leads.out_mm, 2)


def _cut_open(trace: Trace) -> list[int]:
    """The numbers of the lines that are cut and do not come round."""
    return sorted({line.number for line in trace.lines if _is_cut_open(line)})


def _is_cut_open(line: Line) -> bool:
    """Whether a line is cut that does not come round."""
    return (
        len(line.xy_mm) > 1
        and not line.is_guide
        and not line.is_lead
        and line.ending != "closed"
    )
