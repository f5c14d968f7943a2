"""The order in which lines are cut: as the operator told, or inner before outer, with short idle ways.

Signals: lines that were followed in; the same in their order, open ones run from the nearer end, out.

Source: our own (see `lines.order`); the patent has one contour to a tape.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from morfax.motion import nesting
from morfax.motion.faults import LineFault
from morfax.tracer.following.line import Line
from morfax.tracer.following.start import put_down
from morfax.tracer.program.arrows import turned_round
from morfax.tracer.program.lines import order, selection
from morfax.tracer.program.setup import Setup
from morfax.tracer.program.taken import kept_off, patches_of, taken_by


def in_cutting_order(setup: Setup, lines: list[Line]) -> list[Line]:
    """The lines in the order of cutting; an open one followed anew from its other end if that is nearer."""
    inner = nesting.nested(
        [line.loop_mm for line in lines], [not line.is_open for line in lines]
    )
    begins = np.array([line.begin_mm for line in lines])
    ends = np.array([line.end_mm for line in lines])
    may_turn = np.array(
        [line.is_open and not line.goes_back and not line.as_told for line in lines]
    )
    before = _as_told(inner, [line.number for line in lines], setup.operator.order)
    sequence, turned = order.in_order_and_turned(begins, ends, before, may_turn)
    taken = taken_by(setup, lines)
    ordered = list[Line]()
    for i in sequence:
        ordered.append(_turned(setup, lines[i], taken) if turned[i] else lines[i])
        setup.come(len(ordered), len(lines))
    return ordered


def _turned(setup: Setup, line: Line, taken: set[int]) -> Line:
    """A line followed from its other end, along none of the patches of others; as it was, if that is no open
    end of ink: from there the head would run to the line's beginning, and come back along it as it was.
    """
    here = kept_off(setup, taken - patches_of(setup.sheet, line))
    return turned_round(here, line) if line.is_of_net or _ends_open(here, line) else line


def _ends_open(setup: Setup, line: Line) -> bool:
    """Whether the head that is put down where a line ends stands at an open end of its ink."""
    end_mm = line.place(len(line.xy_mm) - 1)
    try:
        stance, _ = next(put_down(setup.sheet, end_mm, setup.settings))
    except LineFault:
        return False
    return stance.at_end


def _as_told(
    inner: NDArray[np.bool_], numbers: list[int], told: tuple[int, ...]
) -> NDArray[np.bool_]:
    """Which line is cut before which: the told ones first, in their order; the others inner before outer.

    Raises LineFault for a number that no line has.
    """
    if not told:
        return inner
    for number in told:
        if number not in numbers:
            raise selection.no_line(number, sorted(set(numbers)))
    rank = np.array([told.index(n) if n in told else len(told) for n in numbers])
    by_rank = np.asarray(rank[:, None] < rank[None])
    both_free = (rank[:, None] == len(told)) & (rank[None] == len(told))
    return np.where(both_free, inner, by_rank)
