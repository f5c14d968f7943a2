"""The quiet frame: a frame of the check signal that is read whole on all tracks, in one kernel.

Signals in: points of the subcarrier, where the frame begins, and what is held of the frames before. Signals
out: what each track tells, its times, and the rows of the tape; or that something of it is weak or wrong, and
then the gates alone: what is to be made of them is in erasures.py and check_reader.py.

Nearly all frames of a tape are quiet, and calling five kernels for each takes longer than their work.

Source: our own. Questions: none.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.compiled import keeps_kinds, lasting, njit
from morfax.player.tape.calm_frames import CalmFrames
from morfax.player.tape.delays import DEAD_ZONE_S
from morfax.player.tape.erasures import Erasures, weigh
from morfax.player.tape.frame_order import LARGEST_LATE_S, LARGEST_SWING_S
from morfax.player.tape.frame_report import FrameReport, frame_report
from morfax.player.tape.subcarrier import Subcarrier, interpolate
from morfax.player.tape.symbols import (
    FIGURES,
    PARTS,
    WORD,
    Gates,
    count_on,
    gates_of,
    read_gates,
)
from morfax.player.tape.told_bounds import told_span
from morfax.recorder.tape.check_frame import (
    SYMBOLS,
    TABLES,
    is_of,
    said_by,
    said_of_axis,
    tell,
    values_of_codes,
)
from morfax.recorder.tape.check_signal import CYCLES_PER_FRAME, CYCLES_PER_SYMBOL
from morfax.recorder.tape.format import TapeFormat

# the start of a frame, its middle, and the middle of each part, in cycles of the reference
MOMENTS = (
    np.r_[0, SYMBOLS / 2, (np.arange(PARTS) + 0.5) * SYMBOLS / PARTS - 0.5] * CYCLES_PER_SYMBOL
)
_FIXED = lasting((WORD, *TABLES, MOMENTS, values_of_codes()))


class _Fields(NamedTuple):
    gates: Gates
    usual: Array  # strength and size of a symbol, as `weigh` has them
    size: Array
    held: tuple[Array, Array]  # turns of each track, as `count_on` has them
    told: NDArray[np.int64]
    is_read: NDArray[np.bool_]
    counts: NDArray[np.int64]
    weights: Array
    rows: Array
    figures: Array


@keeps_kinds
class _Room(_Fields):
    """The arrays in which the frames of one tape are read, the same for all."""


class QuietFrames:
    """Reads the quiet frames of one tape; `gates` are those of the frame that was read last.

    `held`: turns of each track, as `count_on` has them.
    """

    def __init__(
        self,
        fmt: TapeFormat,
        reference_hz: float,
        first_row: int,
        erasures: Erasures,
        held: tuple[Array, Array],
    ) -> None:
        tracks = fmt.tracks
        self.gates: Gates = gates_of(tracks)
        frame_s = CYCLES_PER_FRAME / fmt.reference_hz
        self._scale = (
            1 / reference_hz,
            (float(first_row), float(fmt.samples_per_motion)),
            (fmt.motion_rate_hz, frame_s * fmt.motion_rate_hz),
        )
        self._room = _Room(
            self.gates,
            erasures.usual,
            erasures.size,
            held,
            np.empty(tracks, np.int64),
            np.empty(tracks, bool),
            np.empty((tracks, 3), np.int64),
            np.empty((2, tracks, 2)),
            np.empty(len(MOMENTS)),
            np.empty((tracks, FIGURES)),
        )

    def read(
        self, points: Subcarrier, begins: float, number: int, most: int
    ) -> tuple[CalmFrames, bool]:
        """Read frames from that of a number on, which begins at a count of the reference, as long as they are
        calm, and so many at the most; and whether the next one is at least quiet.
        """
        clock = (points.first, points.hop, points.cycles_per_frame)
        tracks = len(self._room.told)
        calm = CalmFrames(
            number,
            np.empty((most, len(MOMENTS))),
            np.empty((most, tracks), np.int64),
            np.empty((most, tracks, FIGURES)),
            np.empty((most, tracks - 1, 4)),
            np.empty((most, tracks - 1, 4)),
        )
        seen = (points.points, points.theta, begins, number)
        count, is_quiet = _read_calm(seen, clock, self._scale, _FIXED, self._room, calm[1:])
        return calm if count == most else calm.upto(count), is_quiet

    def report(self, number: int) -> FrameReport:
        """The report of the frame that was read last, of this number: it is quiet, and not calm."""
        room = self._room
        said = tuple([said_by(told) for told in room.told.tolist()])
        return frame_report(number, room.rows.tolist(), said, room.figures.tolist())


@njit(cache=True, nogil=True)
def _read_calm(seen, clock, scale, fixed, room, calm):  # type: ignore[no-untyped-def]
    """Fill in calm frames, one behind the other; how many, and whether the next one is quiet."""
    points, theta, begins, number = seen
    moments, told, figures, said, spans = calm
    for at in range(len(told)):
        of_frame = (points, theta, begins + at * CYCLES_PER_FRAME, number + at)
        is_quiet, is_calm = _read_quiet(of_frame, clock, scale, fixed, room)
        if not is_calm:
            return at, is_quiet
        moments[at], told[at], figures[at] = room.rows, room.told, room.figures
        rows = room.rows[0], room.rows[2], room.rows[-1]
        for axis in range(said.shape[1]):
            of_axis = said_of_axis(told[at, axis + 1], fixed[-1])
            if not np.isfinite(of_axis[2] + of_axis[3]):
                return at, True  # it asks for more than can be told
            said[at, axis] = of_axis
            spans[at, axis] = told_span(rows, of_axis[2:], scale[2])
    return len(told), True


@njit(cache=True, nogil=True)
def _read_quiet(seen, clock, scale, fixed, room):  # type: ignore[no-untyped-def]
    """Fill the gates of a frame and, if it is quiet, all else; whether it is, and whether it is calm."""
    points, theta, begins, number = seen
    word, white, byte_crcs, moments, _ = fixed
    gates, is_read, counts, weights = room.gates, room.is_read, room.counts, room.weights
    # 1. the symbols, what they tell, and how strong they are
    read_gates(points, theta, begins, word, gates)
    tell(gates.bits, white, byte_crcs, room.told, is_read)
    if not is_read.all():
        return False, False
    strong = (gates.strengths, gates.sizes, gates.shares)
    weigh(strong, (room.usual, room.size), weights[1], weights[0], counts)
    if counts.any() or not np.isfinite(gates.turns).all():
        return False, False
    # 2. the phases
    count_on(gates, is_read, room.held, scale[0], room.figures)
    room.usual[:], room.size[:] = weights[1, :, 0], weights[1, :, 1]
    # 3. where it lies
    interpolate(begins + moments, theta, clock, room.rows)
    first_row, frames_per_row = scale[1]
    for k in range(len(room.rows)):
        room.rows[k] = first_row + room.rows[k] / frames_per_row
    return True, _is_calm(room.told, number, room.figures)


@njit(cache=True, nogil=True)
def _is_calm(told, number, figures):  # type: ignore[no-untyped-def]
    """Whether nothing is to be said of a quiet frame: see `FrameReport`."""
    for track in range(len(told)):
        in_time = abs(figures[track, 0]) <= LARGEST_LATE_S
        if not (is_of(told[track], track, number) and in_time):
            return False
        if not figures[track, -1] <= LARGEST_SWING_S:
            return False
        for part in range(PARTS):
            if not abs(figures[track, 1 + part]) <= DEAD_ZONE_S:
                return False
    return True
