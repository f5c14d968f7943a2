"""Lines beside each other: two lines of a pen in one ink, of which one begins or ends on the other's way.

Signals: the stations along a stretch (places mm, widths mm) and the pen's width in; out its lines, each with
its clean runs, and how far beyond these it ends.

              ______________          the ink is broader from one step to the other, and at each step one
    ═════════/══════════════\\═══     rim goes straight on: that of the line which comes in there, or goes on

A line that swells, an arrowhead and a line of a broader pen have both their rims step aside, or none at once.
The pen's round shows where a line ends, for a pen of a radius r and lines d apart: half of its step is
√(r² - (r - d/2)²) beyond the end, or √(r² - (d - r - g)²) where paper parts the round from the other line
up to there; less than g of paper is not seen.

Source: our own.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.median import median
from morfax.motion.plane import direction, left_of
from morfax.tracer.ink.both_lines import within_rims
from morfax.tracer.ink.felt import Ends, feel_along, judged
from morfax.tracer.ink.run import Run
from morfax.tracer.ink.swelling import TWO
from morfax.tracer.limits import WIDER
from morfax.tracer.sensing.leg import FEWEST_STATIONS

NOTHING = np.empty((0, 2))  # was felt between
# All limits below were chosen by trial on pairs of lines and on line art.
BROAD = 1.08  # times the pen's width: ink that may be two lines'
LONG = 6.0  # widths of a pen: shorter broad ink is where others cross, or a blot
# widths before a step: there a line shows where it leads, along so much at least
OWN, LEAST = (0.75, 2.75), 0.6
NARROWEST = 10.0  # percentile of a stretch's widths: parts of its ink are so narrow
NARROW = 0.8  # times the pen's width: a line by itself is broader
STEEP = 1.0  # widths: within them a line begins, its pen's radius and what the cells average
RISEN = 0.25, 0.75  # of a step's height: from here to there it is as steep
# pixels of paper between two lines that are not seen; and of how far a round is felt to reach: cells average
PAPER_PX, ROUND = 0.7, 0.75
ASIDE = 0.6, 1.4  # of half the step: so far the middle of the ink moves aside


class Shared(NamedTuple):
    """The part of a stretch that two lines share, as it was felt again: from and up to which station, with
    its share; and on which side, 1 or -1, the line lies that comes in there, and the one that goes on.
    """

    first: float
    last: float
    felt: Run
    comes: int
    goes_on: int

    def cuts(self, off: int) -> tuple[int, int]:
        """The stations between which its lines are not by themselves, some off its steps."""
        return round(self.first) - off, round(self.last) + off


@dataclass(slots=True)
class StretchLine:
    """A line of a stretch: its runs, what was felt between them, and how far it ends beyond these, mm; None
    at an end of the stretch.
    """

    runs: list[Run] = field(default_factory=list)
    parted: list[Array] = field(default_factory=list)
    ends_mm: tuple[float | None, float | None] = (None, None)

    def goes_on(self, runs: list[Run], parted: list[Array]) -> None:
        """Add runs, and what was felt between them."""
        self.parted += [NOTHING, *parted] if self.runs else parted
        self.runs += runs


def lines_beside(run: Run, pen_mm: float, ends: Ends) -> list[StretchLine]:
    """The lines along a stretch in part of which two of a width run beside each other; none if it is other.

    Where the sheet does not tell the pen's width, NaN, the stretch's own narrow ink does.
    """
    if math.isnan(pen_mm):
        pen_mm = float(np.nanpercentile(run.widths_mm, NARROWEST))
    parts = list(_shared(run, pen_mm))
    shared = [part for part in parts if part is not None]
    if not shared or len(shared) < len(parts):
        return []
    off = round(OWN[0] * pen_mm / run.view.step_mm)
    cuts = [0, *(at for part in shared for at in part.cuts(off)), len(run)]
    found, view = [StretchLine()], replace(run.view, width_mm=pen_mm)
    for k, (first, last) in enumerate(zip(cuts[::2], cuts[1::2], strict=True)):
        # a line by itself, and then two of them
        own = replace(run.part(first, last), view=view)
        runs, parted = judged(own, pen_mm).runs(
            (ends[0] and k == 0, ends[1] and k == len(shared))
        )
        if not runs:
            return []
        found[-1].goes_on(runs, parted)
        if k < len(shared):
            _add_two(found, shared[k], run, pen_mm)
    return found


def _add_two(found: list[StretchLine], part: Shared, run: Run, pen_mm: float) -> None:
    """Add the lines along a part that two share; the last of those found comes in, and the last goes on."""
    felt = replace(part.felt, view=replace(run.view, width_mm=pen_mm))
    left, right = within_rims(felt, felt.widths_mm, pen_mm)
    strand = {1: left, -1: right}
    before_mm, behind_mm = _ends_mm(run, part, left, pen_mm)
    found[-1].goes_on([strand[part.comes]], [])
    if part.comes == part.goes_on:
        found.insert(0, StretchLine([strand[-part.comes]], [], (before_mm, behind_mm)))
    else:
        found[-1].ends_mm = found[-1].ends_mm[0], behind_mm
        found.append(StretchLine([strand[part.goes_on]], [], (before_mm, None)))


def _shared(stations: Run, pen_mm: float) -> Iterator[Shared | None]:
    """The parts of a stretch that two lines share; None for broad ink that is not known to be that."""
    run = _filled(stations, LONG * pen_mm)
    if run is None:
        return
    few = max(1, round(pen_mm / run.view.step_mm))
    padded = np.pad(run.widths_mm, few // 2, mode="edge")
    averaged = np.convolve(padded, np.ones(few) / few, "same")[few // 2 :][: len(run)]
    broad = np.flatnonzero(averaged > WIDER * pen_mm)
    for some in np.split(broad, np.flatnonzero(np.diff(broad) > few) + 1):
        if len(some) * run.view.step_mm > LONG * pen_mm:
            yield _part(run, (int(some[0]), int(some[-1]) + 1), pen_mm)


def _filled(run: Run, least_mm: float) -> Run | None:
    """A run with widths between those that are known; None if less of it is known."""
    known = np.isfinite(run.widths_mm)
    if known.sum() * run.view.step_mm < least_mm:
        return None
    at = np.arange(len(run))
    return replace(run, widths_mm=np.interp(at, at[known], run.widths_mm[known]))


def _part(run: Run, part: tuple[int, int], pen_mm: float) -> Shared | None:
    """A broad part of a stretch as two lines; None if it is not that."""
    widths, step_mm = run.widths_mm, run.view.step_mm
    inside = widths[part[0] : part[1]]
    if median(inside) < WIDER * pen_mm or inside.max() > TWO * pen_mm:
        return None
    # 1. where the ink becomes broader, and narrower, within a width
    first = _step(widths[: part[1]], part[0], pen_mm, step_mm)
    back = widths[::-1][: len(run) - part[0]]
    last = _step(back, len(run) - part[1], pen_mm, step_mm)
    if first is None or last is None:
        return None
    # 2. to which side its middle moves there
    off = round(OWN[0] * pen_mm / step_mm)
    guide = run.places_mm[round(first) + off : len(run) - round(last) - off]
    felt = _filled(feel_along(run.view, guide), OWN[1] * pen_mm) if len(guide) > 1 else None
    if felt is None:
        return None
    side = _side(run, round(first), felt, pen_mm)
    far_side = _side(run.turned_round(), round(last), felt.turned_round(), pen_mm)
    if not (side and far_side):
        return None
    return Shared(first, len(run) - 1 - last, felt, -side, far_side)


def _step(widths: Array, at: int, pen_mm: float, step_mm: float) -> float | None:
    """The station, with its share, about a place at which half of a step in the width has come; None if it is
    not steep, or no line by itself comes before it.
    """
    off, far = _own(at, pen_mm, step_mm)
    before, behind = widths[at - far : at - off], widths[at + off : at + far]
    if len(before) < max(LEAST * pen_mm / step_mm, FEWEST_STATIONS) or len(behind) < len(
        before
    ):
        return None
    low_mm, high_mm = median(before), median(behind)
    if not NARROW * pen_mm < low_mm < BROAD * pen_mm < high_mm:
        return None
    rise = (widths[at - far : at + far] - low_mm) / (high_mm - low_mm)
    begins, half, risen = (int(np.argmax(rise > share)) for share in (RISEN[0], 0.5, RISEN[1]))
    if (risen - begins) * step_mm > STEEP * pen_mm:
        return None
    above, below = rise[half], rise[half - 1] if half else 0.0
    return at - far + half - float((above - 0.5) / (above - below))


def _own(at: int, pen_mm: float, step_mm: float) -> tuple[int, int]:
    """How many stations before one a line shows where it leads: the nearest and the farthest."""
    off, far = (round(share * pen_mm / step_mm) for share in OWN)
    return off, min(far, at)


def _side(run: Run, at: int, felt: Run, pen_mm: float) -> int:
    """To which side the middle of the ink moves at a step, 1 to the left; 0 if it does not by half of it, or
    too little of a line comes before it.
    """
    off, far = _own(at, pen_mm, run.view.step_mm)
    if far - off < FEWEST_STATIONS or len(felt) < FEWEST_STATIONS:
        return 0
    before = run.part(at - far, at - off)
    behind = replace(
        felt.part(0, round(LONG * pen_mm / run.view.step_mm)), legs_mm=LONG * pen_mm
    )
    come, gone = before.leg_in(), behind.leg_out().turned_round()
    way = float((gone.end_mm - come.end_mm) @ direction(come.heading_rad))
    moved = gone.at(0.5 * way) - come.at(0.5 * way)
    aside_mm = float(moved @ left_of(direction(come.heading_rad)))
    half_mm = 0.5 * (median(behind.widths_mm) - median(before.widths_mm))
    is_half = ASIDE[0] * half_mm < abs(aside_mm) < ASIDE[1] * half_mm
    return (1 if aside_mm > 0 else -1) if is_half else 0


def _ends_mm(run: Run, part: Shared, strand: Run, pen_mm: float) -> tuple[float, float]:
    """How far beyond a strand of a part of a stretch a line of it ends at either end, mm."""
    found = list[float]()
    near, radius_mm = round(OWN[1] * pen_mm / run.view.step_mm), 0.5 * pen_mm
    for at, leg, widths in (
        (part.first, strand.leg_out().turned_round(), part.felt.widths_mm[:near]),
        (part.last, strand.leg_in(), part.felt.widths_mm[-near:]),
    ):
        apart_mm = median(widths) - pen_mm
        paper_mm = apart_mm - radius_mm - PAPER_PX * run.view.pitch_mm
        off_mm = max(radius_mm - 0.5 * apart_mm, paper_mm)
        round_mm = ROUND * math.sqrt(max(radius_mm**2 - off_mm**2, 0.0))
        place = run.places_mm[math.floor(at) : math.floor(at) + 2]
        step = place[0] + (at % 1) * (place[-1] - place[0])
        out_mm = float((step - leg.end_mm) @ direction(leg.heading_rad))
        found.append(max(out_mm - round_mm, 0.0))
    return found[0], found[1]
