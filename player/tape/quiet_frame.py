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
from morfax.player.tape.delays import DEAD_ZONE_S
from morfax.player.tape.erasures import Erasures, weigh
from morfax.player.tape.frame_order import LARGEST_LATE_S, LARGEST_SWING_S
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
from morfax.recorder.tape.check_frame import (
    SYMBOLS,
    TABLES,
    CheckFrame,
    is_of,
    said_by,
    tell,
)
from morfax.recorder.tape.check_signal import CYCLES_PER_SYMBOL

# the start of a frame, its middle, and the middle of each part, in cycles of the reference
MOMENTS = (
    np.r_[0, SYMBOLS / 2, (np.arange(PARTS) + 0.5) * SYMBOLS / PARTS - 0.5] * CYCLES_PER_SYMBOL
)
_FIXED = lasting((WORD, *TABLES, MOMENTS))


class QuietFrame(NamedTuple):
    """A frame that is quiet: what each track says, and its rows and times as `count_on` fills them.

    `is_calm` as that of its report.
    """

    said: tuple[CheckFrame | None, ...]
    frames: list[float]
    figures: list[list[float]]
    is_calm: bool


class _Fields(NamedTuple):
    gates: Gates
    usual: Array  # strength and size of a symbol, as `weigh` has them
    size: Array
    held: tuple[Array, Array]  # turns of each track, as `count_on` has them
    told: NDArray[np.int64]
    is_read: NDArray[np.bool_]
    counts: NDArray[np.int64]
    weights: Array
    frames: Array
    figures: Array


@keeps_kinds
class _Room(_Fields):
    """The arrays in which the frames of one tape are read, the same for all."""


class QuietFrames:
    """Reads the quiet frames of one tape; `gates` are those of the frame that was read last.

    `held`: turns of each track, as `count_on` has them.
    """

    def __init__(
        self, tracks: int, reference_hz: float, erasures: Erasures, held: tuple[Array, Array]
    ) -> None:
        self.gates: Gates = gates_of(tracks)
        self._cycle_s = 1 / reference_hz
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

    def read(self, points: Subcarrier, begins: float, number: int) -> QuietFrame | None:
        """Read the frame of a number that begins at a count of the reference; None where it is not quiet."""
        clock, room = (points.first, points.hop, points.cycles_per_frame), self._room
        seen = (points.points, points.theta, begins, number)
        is_quiet, is_calm = _read_quiet(seen, clock, self._cycle_s, _FIXED, room)
        if not is_quiet:
            return None
        said = tuple([said_by(told) for told in room.told.view(np.uint64).tolist()])
        return QuietFrame(said, room.frames.tolist(), room.figures.tolist(), is_calm)


@njit(cache=True, nogil=True)
def _read_quiet(seen, clock, cycle_s, fixed, room):  # type: ignore[no-untyped-def]
    """Fill the gates of a frame and, if it is quiet, all else; whether it is, and whether it is calm."""
    points, theta, begins, number = seen
    word, white, byte_crcs, moments = fixed
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
    count_on(gates, is_read, room.held, cycle_s, room.figures)
    room.usual[:], room.size[:] = weights[1, :, 0], weights[1, :, 1]
    # 3. where it lies
    interpolate(begins + moments, theta, clock, room.frames)
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
