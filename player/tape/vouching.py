"""Vouching: rows of the tape are held until the check signal has vouched for them, and delays are taken out.

Signals in: rows of phases that the dropouts have left certain, and the reports of the check reader. Signals
out: rows that are vouched for, about a second later, and the first that is not, with its fault.

    order       frames of each track are its own and follow one another      frame_order.py
    delay       of a track against the reference                             delays.py: taken out of the phase
    count       cycles of the axis at the start of each frame, in its middle counts.py: off is a fault
    tail        what moves behind the last delay                             tail.py: taken out at rest
    last        the last two frames say that the tape ends                   the end is missing: a fault

A frame of a track may be missing, in a dropout, if one of the next vouches for what was between. A dropout
whose way the sides and the told acceleration do not tell is a fault at its start, once the next count says
where the axes are behind it; or, in mending, its way is laid to that place (lost_ways.py).

Source: our own. Questions: none.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from morfax.motion.arrays import Array
from morfax.motion.faults import Fault
from morfax.player.tape import check_faults as faults
from morfax.player.tape.calm_frames import Heard
from morfax.player.tape.check_reader import CheckReader
from morfax.player.tape.counts import Counts, Off
from morfax.player.tape.delays import corrected
from morfax.player.tape.frame_order import FrameOrder
from morfax.player.tape.frame_report import FrameReport
from morfax.player.tape.gap import Gap
from morfax.player.tape.held_rows import HeldRows
from morfax.player.tape.lost_ways import Laid, LostWays, laid
from morfax.player.tape.phases import Phases, Uncertain
from morfax.player.tape.tail import tail_of
from morfax.player.tape.told_axes import ToldAxes
from morfax.player.tape.told_bounds import ToldBounds
from morfax.player.tape.warrant import Certain, Given, PlaceMm, StandsMm
from morfax.recorder.tape.check_frame import SYMBOLS
from morfax.recorder.tape.check_signal import CYCLES_PER_FRAME
from morfax.recorder.tape.format import TapeFormat
from morfax.recorder.tape.told_figures import StatedFigures, agreed

LARGEST_OFF_S = 6e-6  # of a delay off the line through seven: 0.036 cycle; 26 dB leave 2


class Vouching:
    """Holds the rows of one tape until they are vouched for.

    With `mends` the way of dropouts that it would stop at is laid; `mended` are these.
    """

    is_checked = True

    def __init__(self, fmt: TapeFormat, check: CheckReader, *, mends: bool = False) -> None:
        self._format, self._check, self._mends = fmt, check, mends
        self._rate_hz, frame_s = fmt.motion_rate_hz, CYCLES_PER_FRAME / fmt.reference_hz
        self._counts = Counts(len(fmt.axes), fmt.reference_hz, is_timed=check.is_timed)
        self._place_mm: PlaceMm = lambda axis, cycles: math.nan
        self._told = ToldAxes(fmt)
        self._ways = LostWays(len(fmt.axes), frame_s / SYMBOLS * self._rate_hz)
        # rows of weak symbols that no gap explains yet
        self._weak: list[list[float]] = [[] for _ in fmt.axes]
        self._rests: dict[int, int] = {}  # by axis: the row from which it stands to the end
        self._lost: dict[int, Gap] = {}  # by axis: a gap at which the machine stops
        self.mended: list[Laid] = []
        self._rows = HeldRows()
        self._given = 0  # rows that were given out and are still held, to lend their speed
        self._counted = [0.0] * len(fmt.axes)  # the last row at which the count was right
        self._order = FrameOrder(fmt)
        self.listen = check.listen
        self._heard = check.heard()  # of the first blocks
        self._fault: Fault | None = None
        self.notes: tuple[str, ...] = ()

    def hear(self, heard: list[Heard]) -> None:
        """Take these frames; they are looked at when somebody asks what they tell."""
        self._heard += heard

    def begin(self, rows: Phases) -> Phases:
        """The first rows, put right as far as the first frames tell; raises TapeFault for a wrong track."""
        self._demand_tracks_and_figures()
        self._take_reports()
        return corrected(rows, self._told.delays)

    def bear(self, zero_cycles: Array | None, place_mm: PlaceMm) -> None:
        """Take the zeros of the axes; None: where their counts begin is told by the first frames."""
        self._place_mm = place_mm
        if zero_cycles is not None:
            self._counts.zero_cycles = zero_cycles.tolist()

    def bounds(self) -> Sequence[ToldBounds]:
        """What the track of each axis tells of the program, as far as its frames were read."""
        self._take_reports()
        return self._told.bounds

    def end(self, time_s: float) -> None:
        """The tape ends, and has said so."""

    def _demand_tracks_and_figures(self) -> None:
        """Raise TapeFault unless each track is what it should be, and the text states what they say."""
        fmt = self._format
        faults.demand_tracks(self._check.tracks, fmt.axes)
        used = StatedFigures(fmt.cycles_per_mm, fmt.axes, fmt.start_mm)
        self.notes = agreed(self._check.found[0][0].said, fmt.stated, used)

    def _take_reports(self) -> None:
        """Take what was heard by now."""
        while self._heard and self._fault is None:
            heard = self._heard.pop(0)
            if isinstance(heard, FrameReport):
                self._take(heard)
            elif self._told.moves or not (self._check.is_timed and self._order.takes(heard)):
                self._heard[:0] = heard.reports()
            else:
                self._counts.take(heard)
                self._told.take(heard)

    def feed(self, certain: Certain, stands_mm: StandsMm, *, last: bool = False) -> Given:
        """Take the next rows and the fault behind them; the rows that are vouched for, and the fault."""
        self._hold(certain)
        if last:
            self._check.finish()
            self._heard += self._check.heard()
        self._take_reports()
        self._check_counts(stands_mm)
        if last:
            self._check_end(certain)
        held, ended = self._rows, last and certain.fault is None and self._fault is None
        upto = len(held) if ended else min(int(self._vouched) - held.first_row, len(held))
        upto = max(upto, self._given)
        out = self._cut(held, upto)
        fault = self._fault or (certain.fault and certain.fault.fault)
        if fault is not None:
            return out, Uncertain(len(out), fault)
        keep = max(upto - self._told.delays[0].span, 0)
        held.drop(keep)
        self._given = upto - keep
        return out, None

    def _hold(self, certain: Certain) -> None:
        """Hold the next rows, further on by what mending has put back."""
        self._ways.take(certain.gaps)
        rows, cycles = certain.rows, certain.rows.cycles
        if self._ways.shift_cycles.any():
            cycles = cycles + self._ways.shift_cycles
        # the levels of the tracks have said what they say
        self._rows.add(Phases(rows.first_row, cycles, rows.surprise, rows.levels[:0]))

    def _check_end(self, certain: Certain) -> None:
        """Note the fault of a tape that ends where it does not say so, or in a dropout."""
        if self._fault is not None or certain.fault is not None:
            return
        lost = min(self._lost.values(), key=lambda gap: gap.first, default=None)
        left = lost or self._ways.unsettled()
        if left is not None:
            self._fault = self._lost_way(left, None)
        elif not self._order.ended:
            self._fault = faults.no_end(self._vouched / self._rate_hz)
        for axis, delay in enumerate(self._told.delays):
            if self._fault is None and delay.moves:
                self._fault = self._tail_swings(axis)

    def _tail_swings(self, axis: int) -> Fault | None:
        """The fault of an axis whose delay at the end is in doubt, or that moves there more than it told."""
        held, delay = self._rows, self._told.delays[axis]
        way = delay.corrected(held.axis(axis, 0, len(held)), held.first_row)
        found = tail_of(way, held.first_row, delay, self._told.bounds[axis], self._format)
        if found.rest_row is not None:
            self._rests[axis] = found.rest_row
        if not found.off_s:
            return None
        time_s = (held.first_row + len(held)) / self._rate_hz
        return faults.swings(axis + 1, self._format.axes, found.off_s, time_s)

    def _cut(self, held: HeldRows, upto: int) -> Phases:
        """The rows up to one that are not yet given out, put right; those around them lend their speed."""
        if upto <= self._given:
            return held.cut(upto, upto)
        beyond = corrected(held.cut(0, upto + self._told.delays[0].span), self._told.delays)
        for axis, row in self._rests.items():
            at = row - beyond.first_row
            beyond.cycles[at:, axis] = beyond.cycles[at, axis]
        return beyond.cut(self._given, upto)

    @property
    def _vouched(self) -> float:
        """The row up to which delays and counts are known."""
        return min(self._told.settled_row, *self._counted)

    def _take(self, report: FrameReport) -> None:
        """Take the report of one frame."""
        self._fault = self._order.fault(report)
        if self._fault is not None:
            return
        self._counts.begin(report.row, report.middle_row)
        for axis in range(len(self._told.delays)):
            if weak := report.weak_rows[0] + report.weak_rows[axis + 1]:
                self._weak[axis] += sorted(weak)
            self._note(axis, report)

    def _note(self, axis: int, report: FrameReport) -> None:
        """Note the count, the bounds and the delays of one axis."""
        delays_s, said = report.delay_s[axis + 1], report.said[axis + 1]
        if said is None or not math.isfinite(sum(delays_s)):
            return  # the reference says nothing
        self._counts.tell(axis, said, report.error_s[axis + 1])
        off_s = self._told.add(axis, report)
        if off_s > LARGEST_OFF_S and self._fault is None:
            time_s = report.row / self._rate_hz
            self._fault = faults.swings(axis + 1, self._format.axes, off_s, time_s)

    def _check_counts(self, stands_mm: StandsMm) -> None:
        """Compare the axes' counts with what their tracks say, as far as rows are held."""
        known = self._fault  # of a frame further on: what is before it is still compared
        while self._fault is known:
            is_plain = not (
                self._told.moves or self._lost or any(self._weak) or self._ways.are_open
            )
            passed = self._counts.pass_right(self._rows) if is_plain else None
            if passed is not None:
                self._counted = [passed] * len(self._told.delays)
            due = self._counts.due(self._rows.first_row, len(self._rows))
            if due is None:
                return
            row = due.row
            open_ = self._ways.uncovered(due.told, row)
            places = self._told.places(self._rows, row)
            off = {axis: self._counts.off(axis, places[axis], due) for axis in open_}
            if due.is_middle:
                self._check_middle(row, off, stands_mm)
                continue
            for axis in open_:
                self._settle(axis, row, off[axis], stands_mm)
            if self._lost and len(open_) == len(self._told.delays) and not self._fault:
                first = min(self._lost.values(), key=lambda gap: gap.first)
                self._fault = self._lost_way(first, (row, off))

    def _check_middle(self, row: float, off: dict[int, Off], stands_mm: StandsMm) -> None:
        """Note the fault of an axis that is off in the middle of a frame.

        A right one vouches for nothing, as whole cycles do not show; behind a dropout the next count tells.
        """
        for axis, found in off.items():
            if not (found.is_right or self._ways.any_open(axis) or self._weak[axis]):
                self._fault = self._fault or self._miscounted(axis, row, found, stands_mm)

    def _miscounted(self, axis: int, row: float, off: Off, stands_mm: StandsMm) -> Fault:
        """The fault of an axis that lies off its count."""
        name = self._format.axes[axis]
        return faults.miscounted(name, off, row / self._rate_hz, stands_mm()[axis])

    def _settle(self, axis: int, row: float, off: Off, stands_mm: StandsMm) -> None:
        """Let a count vouch for the way until there; or note which gap lost it, or lay that gap anew."""
        if off.is_right and not self._weak[axis] and not self._ways.any_open(axis):
            self._counted[axis] = row
            return
        before = [weak for weak in self._weak[axis] if weak < row]
        self._weak[axis] = self._weak[axis][len(before) :]
        replaced = self._ways.bare(axis, before)
        if replaced is not None:
            time_s = replaced / self._rate_hz
            self._fault = self._fault or faults.replaced(axis + 1, self._format.axes, time_s)
            return
        gap, whole = self._ways.lost(axis, row, off.cycles), round(off.cycles)
        if gap is not None and not self._mends:
            self._lost.setdefault(axis, gap)
            if not whole:  # then it vouches for the way until the gap
                self._counted[axis] = max(self._counted[axis], gap.sound_until)
            return
        if gap is not None:
            self._lay(axis, gap, -whole)
        elif not off.is_right:
            self._fault = self._fault or self._miscounted(axis, row, off, stands_mm)
            return
        self._ways.settle(axis, row, 0.0 if gap is None else float(-whole))
        self._counted[axis] = row

    def _lay(self, axis: int, gap: Gap, more: int) -> None:
        """Lay the way over a gap anew, so that so many cycles more lie behind it."""
        self._rows.become(laid(self._rows.cut(0, len(self._rows)), gap, more))
        near = self._told.bounds[axis].around(gap.first, gap.last)
        self.mended.append(Laid(gap.ending(more), more, near or gap.bound))

    def _lost_way(self, gap: Gap, behind: tuple[float, dict[int, Off]] | None) -> Fault:
        """The fault of a gap; `behind`: a row at which all axes are known again, and how far off each is."""
        known = None
        if behind is not None:
            row = math.ceil(behind[0])
            places = self._told.places(self._rows, row)
            off = [(axis, round(off.cycles)) for axis, off in sorted(behind[1].items())]
            places_mm = tuple(self._place_mm(axis, places[axis] - whole) for axis, whole in off)
            known = faults.Behind(row / self._rate_hz, places_mm, behind[1][gap.axis].cycles)
        name, place_mm = self._format.axes[gap.axis], self._place_mm(gap.axis, gap.before.place)
        return faults.lost_way(gap, name, self._rate_hz, place_mm, known)
