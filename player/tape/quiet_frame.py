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

from morfax.motion.arrays import Array
from morfax.motion.compiled import lasting, njit
from morfax.player.tape.erasures import Erasures, weigh
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
    said_by,
    tell,
)
from morfax.recorder.tape.check_signal import CYCLES_PER_SYMBOL

# the start of a frame, its middle, and the middle of each part, in cycles of the reference
MOMENTS = (
    np.r_[0, SYMBOLS / 2, (np.arange(PARTS) + 0.5) * SYMBOLS / PARTS - 0.5] * CYCLES_PER_SYMBOL
)
_FIXED = lasting((WORD, *TABLES, MOMENTS))


class Read(NamedTuple):
    """A frame that is quiet: what each track says, and its rows and times as `count_on` fills them."""

    said: tuple[CheckFrame | None, ...]
    frames: list[float]
    figures: list[list[float]]


class QuietFrames:
    """Reads the quiet frames of one tape; `gates` are those of the frame that was read last."""

    def __init__(self, tracks: int, reference_hz: float, erasures: Erasures) -> None:
        self.gates: Gates = gates_of(tracks)
        self._cycle_s, self._erasures = 1 / reference_hz, erasures
        self._told, self._is_read = np.empty(tracks, np.int64), np.empty(tracks, bool)
        self._counts = np.empty((tracks, 3), np.int64)
        self._weights = np.empty((2, tracks, 2))
        self._frames, self._figures = np.empty(len(MOMENTS)), np.empty((tracks, FIGURES))

    def read(self, points: Subcarrier, begins: float, held: tuple[Array, Array]) -> Read | None:
        """Read the frame that begins at a count of the reference; None where it is not quiet.

        `held`: turns of each track, as `count_on` has them.
        """
        seen = (points.points, points.theta, begins)
        clock = (points.first, points.hop, points.cycles_per_frame, self._cycle_s)
        usual = (self._erasures.usual, self._erasures.size)
        room = (self._told, self._is_read, self._counts, self._weights)
        out = (self._frames, self._figures)
        if not _read_quiet(seen, clock, _FIXED, self.gates, (usual, held), room, out):
            return None
        said = tuple([said_by(told) for told in self._told.view(np.uint64).tolist()])
        return Read(said, self._frames.tolist(), self._figures.tolist())


@njit(cache=True, nogil=True)
def _read_quiet(seen, clock, fixed, gates, held, room, out):  # type: ignore[no-untyped-def]
    """Fill the gates of a frame and, if it is quiet, all else; whether it is."""
    points, theta, begins = seen
    first, hop, step, cycle_s = clock
    word, white, byte_crcs, moments = fixed
    told, is_read, counts, weights = room
    # 1. the symbols, what they tell, and how strong they are
    read_gates(points, theta, begins, word, gates)
    tell(gates.bits, white, byte_crcs, told, is_read)
    if not is_read.all():
        return False
    weigh((gates.strengths, gates.sizes, gates.shares), held[0], weights[1], weights[0], counts)
    if counts.any() or not np.isfinite(gates.turns).all():
        return False
    # 2. the phases
    count_on(gates, is_read, held[1], cycle_s, out[1])
    held[0][0][:], held[0][1][:] = weights[1, :, 0], weights[1, :, 1]
    # 3. where it lies
    interpolate(begins + moments, theta, (first, hop, step), out[0])
    return True
