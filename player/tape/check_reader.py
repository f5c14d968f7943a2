"""The check reader: what every track says of itself, frame by frame, and how late it is.

Signals in: the tape's frames in blocks. Signals out: which track says to be which, and a report per frame of
the check signal: what each track says, the row of the tape at which the frame begins, and the delay of each
track against the reference, a quarter of a frame at a time.

    search     the sync word is looked for at every quarter of a symbol; a place counts if the check sum
               behind it is right
    follow     the next frames must lie where the reference's cycles say, 2880 cycles one after the other
    late       early against late symbols, a quarter of a symbol to either side: true to 50 us
    delay      phase of the subcarrier against that of track 1, over 30 symbols, in s:
               true to 0.1 us at 40 dB, 0.5 us at 26 dB

The phase says the delay within half a cycle of the subcarrier (a track may be inverted), and `late` says
which half cycle it is.

Source: our own. Questions: none.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.faults import TapeFault
from morfax.player.tape.calm_frames import Heard, unfolded
from morfax.player.tape.erasures import Erasures
from morfax.player.tape.frame_report import FrameReport, frame_report
from morfax.player.tape.quiet_frame import MOMENTS, QuietFrames
from morfax.player.tape.slips import slip
from morfax.player.tape.standstill import REFERENCE_BAND, strongest_hz
from morfax.player.tape.subcarrier import Subcarrier
from morfax.player.tape.symbols import (
    FIGURES,
    QUARTER,
    count_on,
    likeness,
    read_symbols,
)
from morfax.recorder.tape.check_frame import (
    SYMBOLS,
    CheckFrame,
    from_bits,
)
from morfax.recorder.tape.check_signal import (
    CYCLES_PER_FRAME,
    CYCLES_PER_SUBCARRIER,
    CYCLES_PER_SYMBOL,
)
from morfax.recorder.tape.format import TapeFormat
from morfax.recorder.tape.tape import Stored, full_scale

LEAST_FRAMES = 2.2  # of the check signal, among which two are whole
# frames of the tape: four times what 192 kHz and a reference of 5 kHz need
MOST_AHEAD = 1 << 20
# of the power of 24 symbols: noise as strong as the symbols has a share of 1/24
SYNC_LIKENESS = 0.5
CENTRING = 6  # times: 7 us are left after three, 4 us after six
# behind a frame before it is read, in cycles: the windows of its last symbol
REACH_CYCLES = 2 * CYCLES_PER_SYMBOL


@dataclass(frozen=True, slots=True)
class Found:
    """A frame found by its sync word: where it begins (cycles of the reference), its phase, what it says."""

    theta: float
    turns: float
    said: CheckFrame


def read_ahead(blocks: Iterator[Stored], fmt: TapeFormat) -> list[Stored]:
    """The first blocks of a tape, until two frames of the check signal must be among them."""
    needed = LEAST_FRAMES * _frame_length(fmt)
    many = fmt.can_be_checked and needed <= MOST_AHEAD
    ahead: list[Stored] = []
    for block in blocks:
        ahead.append(block)
        if not many or sum(map(len, ahead)) >= needed:
            break
    return ahead


def _frame_length(fmt: TapeFormat) -> float:
    """Length of a frame of the check signal in frames of the tape."""
    return CYCLES_PER_FRAME / fmt.reference_hz * fmt.sample_rate_hz


def read_check(ahead: list[Stored], fmt: TapeFormat, first_row: int = 0) -> CheckReader | None:
    """The reader of a tape's check signal, from its first blocks; None for a bare tape.

    Raises TapeFault for a tape that runs backwards.
    """
    if not fmt.can_be_checked or sum(map(len, ahead)) < _frame_length(fmt):
        return None
    first = np.concatenate(ahead)
    if not np.isfinite(first).all():
        return None
    found_hz = strongest_hz(full_scale(first[:, 0]), fmt.sample_rate_hz)
    if not abs(found_hz / fmt.reference_hz - 1) <= REFERENCE_BAND:
        return None  # the bearings will say so
    reader = CheckReader(fmt, first, found_hz, first_row)
    return reader if reader.is_checked else None


class CheckReader:
    """Reads the check signal of one tape; `found` is what the first block holds, track by track."""

    def __init__(
        self, fmt: TapeFormat, first: Stored, reference_hz: float, first_row: int = 0
    ) -> None:
        self._reference_hz, self._format, self._first_row = reference_hz, fmt, first_row
        self._points = Subcarrier(fmt.sample_rate_hz, self._reference_hz, fmt.tracks)
        self._points.feed(first)
        self._kind = first.dtype
        self.found = [self._search(track) for track in range(fmt.tracks)]
        self._reach = REACH_CYCLES
        self._turns = np.zeros(fmt.tracks)
        self._zero_turns = np.zeros(fmt.tracks)
        self._number, self._theta = 0, 0.0  # the next frame, and where it begins
        self._erasures = Erasures(fmt.tracks)
        turns = (self._turns, self._zero_turns)
        self._quiet = QuietFrames(fmt, reference_hz, first_row, self._erasures, turns)
        self._clock_lost = False  # whether the reference said nothing in the last frame
        self._sound_from = -1.0  # the last point before which the reference is counted right
        if self.is_checked:
            self._begin()
        elif any(self._search(track, backwards=True) for track in range(fmt.tracks)):
            raise TapeFault(
                "the tape runs backwards: its check signal is read from the end; turn it round",
                time_s=0.0,
            )

    @property
    def is_checked(self) -> bool:
        """Whether any track has a check signal."""
        return any(self.found)

    @property
    def is_timed(self) -> bool:
        """Whether the reference itself says when its frames begin."""
        return bool(self.found[0])

    @property
    def tracks(self) -> list[int | None]:
        """Which track each of them says to be, from 0; None where it says nothing."""
        return [found[0].said.track if found else None for found in self.found]

    def feed(self, frames: Stored) -> None:
        """Take the next frames of the tape."""
        self._points.feed(frames)

    def listen(self, frames: Stored) -> list[Heard]:
        """The frames of the check signal that are whole with the next frames of the tape."""
        self.feed(frames)
        return self.heard()

    def finish(self) -> None:
        """Take the end of the tape: a frame that ends with it is whole."""
        hop = self._points.hop
        self._points.feed(np.zeros((3 * hop, self._format.tracks), self._kind))
        self._reach = -CYCLES_PER_SYMBOL / 2

    def reports(self) -> list[FrameReport]:
        """The frames that are whole by now, one by one."""
        return unfolded(self.heard())

    def heard(self) -> list[Heard]:
        """The frames that are whole by now; those that are calm all at once."""
        told: list[Heard] = []
        while most := self._whole():
            if self._put_right():
                most = 1
            calm, is_quiet = self._quiet.read(self._points, self._theta, self._number, most)
            if calm.frames or is_quiet:
                self._clock_lost = False
            if calm.frames:
                told.append(calm)
                self._pass(calm.frames)
            if calm.frames < most:
                told.append(self._quiet.report(self._number) if is_quiet else self._report())
                self._pass(1)
        if told:
            self._points.forget(self._theta - REACH_CYCLES)
        return told

    def _whole(self) -> int:
        """How many frames are whole by now."""
        theta = self._points.theta
        left = theta[-1] - self._reach - self._theta if len(theta) else 0.0
        return max(int(left // CYCLES_PER_FRAME), 0)

    def _pass(self, frames: int) -> None:
        """Go on by so many frames."""
        self._number, self._theta = (
            self._number + frames,
            self._theta + frames * CYCLES_PER_FRAME,
        )

    def _search(self, track: int, *, backwards: bool = False) -> list[Found]:
        """All frames of a track among the points, or among the points from the last to the first."""
        theta = self._points.theta
        if len(theta) < 2 or not np.isfinite(theta).all():
            return []
        grid = np.arange(theta[0], theta[-1], QUARTER)
        seen = np.interp(grid, theta, self._points.points[:, track])
        if backwards:
            seen = seen[::-1]
        alike, like = likeness(seen)
        found: list[Found] = []
        for start in np.argsort(-like).tolist():
            if like[start] < SYNC_LIKENESS:
                break
            if any(abs(grid[start] - other.theta) < CYCLES_PER_SYMBOL for other in found):
                continue
            turn = np.angle(alike[start])
            bits = np.sign((seen[start : start + 4 * SYMBOLS : 4] * np.exp(-1j * turn)).real)
            said = from_bits(bits[None].astype(np.int8))[0]
            if said is None:
                continue
            begins = (
                float(grid[start]) if backwards else self._centred(track, float(grid[start]))
            )
            # a frame whose first symbol is cut off runs away from where it was found
            if abs(begins - grid[start]) < CYCLES_PER_SYMBOL / 2:
                found.append(Found(begins, float(turn / (2 * np.pi)), said))
        return sorted(found, key=lambda one: one.theta)

    def _centred(self, track: int, begins: float) -> float:
        """Where a frame begins, to a hundredth of a symbol: the gates are moved until none is late."""
        for _ in range(CENTRING):
            begins += float(read_symbols(self._points, begins).late[track])
        return begins

    def _begin(self) -> None:
        """Set where the next frame begins, and the phase of each track, by what was found."""
        clock = next((found for found in self.found if found), [])
        first = clock[0]
        self._number = first.said.number
        begins = []  # of the first track's frame, by each track and its delay
        for track, found in enumerate(self.found):
            if not found:
                continue
            self._turns[track] = found[0].turns
            # how late, by the symbols, and by the phase within half a cycle
            late = np.array([one.theta - first.theta for one in found])
            late -= CYCLES_PER_FRAME * np.round(late / CYCLES_PER_FRAME)
            by_phase = first.turns - found[0].turns
            halves = round(2 * (late[0] / CYCLES_PER_SUBCARRIER - by_phase))
            self._zero_turns[track] = first.turns + halves / 2
            late_by_phase = CYCLES_PER_SUBCARRIER * (by_phase + halves / 2)
            begins += (first.theta + late - late_by_phase).tolist()
        self._theta = float(np.median(begins))

    def _report(self) -> FrameReport:
        """The report of the frame whose gates were read last."""
        gates = self._quiet.gates
        said = self._erasures.read(gates, self._number)
        is_read = np.array([frame is not None for frame in said])
        figures = np.empty((len(said), FIGURES))
        held = (self._turns, self._zero_turns)
        count_on(gates, is_read, held, 1 / self._reference_hz, figures)
        if self._clock_lost and len(self._erasures.weak[0]):
            # the clock was put right within this frame only: all seemed late by as much
            figures[:, 1:-2] = np.nan
        self._clock_lost = said[0] is None
        rows = self._rows(self._theta + MOMENTS)
        read = tuple(one if sure else None for one, sure in zip(said, is_read, strict=True))
        weak = [self._rows(self._theta + CYCLES_PER_SYMBOL * at) for at in self._erasures.weak]
        hurt = tuple(self._erasures.damaged), weak
        return frame_report(self._number, rows, read, figures.tolist(), hurt=hurt)

    def _put_right(self) -> bool:
        """Put right what was miscounted of the reference while it failed, at the first frame behind that.

        Whether it failed: then the next frame is to be read by itself.
        """
        ended = self._points.lost[1]
        if ended <= self._sound_from:
            return False
        if self._points.theta_at(ended) >= self._theta:
            return True
        slipped = slip(self._points, self._theta, self._number)
        if slipped is not None:  # else the next frame may be read
            self._sound_from = ended
        if slipped:
            self._points.slip(slipped)
        return True

    def _rows(self, theta: Array) -> list[float]:
        """The rows of the tape at some counts of the reference."""
        return self._rows_of(self._points.frames_at(theta).tolist()) if len(theta) else []

    def _rows_of(self, frames: list[float]) -> list[float]:
        """The rows of the tape at some of its frames."""
        return [self._first_row + frame / self._format.samples_per_motion for frame in frames]
