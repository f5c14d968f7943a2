"""Erasures: a frame of the check signal of which a dropout took some symbols, read all the same.

Signals in: the symbols of a frame, how strong each is, and what the frame must say (its track and number).
Signals out: what it says, or nothing.

    strength  ____    ____        symbols below half of the usual strength may be either:
                  \\__/            each way of reading up to eight of them is held against the check sum

A dropout of 10 ms takes three to five symbols of 120. A wrong way passes the check sum once in 4e9, and must
also say the right track and number: 256 ways are one wrong frame in 2e13. Of a frame with more weak symbols
nothing is taken, even where what is left of them can be read: its time would be that of its strong symbols.

A dropout that takes the sync word, or the reference by which all are timed, leaves no phase to hold the
symbols against: all of that frame seem weak. Which of them the dropout took is then told by their sizes.

Source: R. E. Blahut, Theory and Practice of Error Control Codes, 1983 (erasures: symbols known to be bad);
D. Chase, A class of algorithms for decoding block codes with channel measurement information, IEEE Trans.
Information Theory 18, 1972 (trying the weakest). Questions: none.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.player.tape.symbols import Gates
from morfax.recorder.tape.check_frame import NUMBERS, SYNC_SYMBOLS, Bits, CheckFrame, from_bits

WEAK = 0.5  # of the usual strength; 15 dB of noise leave 0.75 (four standard deviations)
MOST_WEAK = 8  # symbols: two dropouts of 5 ms, or one of 25 ms


class Erasures:
    """Reads the frames of the tracks of one tape; holds how strong the symbols of each usually are."""

    def __init__(self, tracks: int) -> None:
        self._usual = np.full(tracks, np.nan)
        self._size = np.full(tracks, np.nan)  # of a symbol, at the median
        self.damaged: list[int] = []
        self.weak: list[Array] = []

    def read(self, gates: Gates, number: int) -> list[CheckFrame | None]:
        """What the tracks say in the frame of this number; None where it is lost.

        `damaged` are then the tracks that say nothing though few of their symbols are weak, and `weak` the
        places of each track at which it is weak, in symbols from the first.
        """
        bits, strengths, sizes, shares = gates.bits, gates.strengths, gates.sizes, gates.shares
        said = from_bits(bits)
        self.damaged, self.weak = [], []
        # of all tracks at once: one by one they were a tenth of the time of playing
        usuals, usual_sizes = np.median(strengths, axis=1), np.median(sizes, axis=1)
        small = [
            np.flatnonzero(sizes[track] < WEAK * self._size[track])
            for track in range(len(said))
        ]
        for track, frame in enumerate(said):
            usual = float(usuals[track])
            known = self._usual[track] if np.isfinite(self._usual[track]) else usual
            weak = np.flatnonzero(strengths[track] < WEAK * known)
            lost = max(len(small[0]), len(small[track])) > MOST_WEAK
            self.weak.append(
                small[track].astype(np.float64)
                if lost
                else _places(shares[track] < WEAK * known)
            )
            if len(weak) > MOST_WEAK:
                frame = None
            elif frame is None:
                frame = _recovered(bits[track], weak[weak >= SYNC_SYMBOLS], track, number)
            if frame is not None:
                self._usual[track] = usual
                self._size[track] = usual_sizes[track]
            elif len(weak) <= MOST_WEAK:
                self.damaged.append(track)
            said[track] = frame
        return said


def _places(weak: NDArray[np.bool_]) -> Array:
    """The places of weak gates (gates, symbols), in symbols."""
    gate, symbol = np.nonzero(weak)
    return np.sort(symbol + (gate - 1) / 4)


def _recovered(
    bits: Bits, weak: NDArray[np.int64], track: int, number: int
) -> CheckFrame | None:
    """What a frame of this track and number says, whichever way its weak symbols are read."""
    ways = np.repeat(bits[None], 1 << len(weak), axis=0)
    chosen = (np.arange(len(ways))[:, None] >> np.arange(len(weak))) & 1
    ways[:, weak] = 2 * chosen.astype(np.int8) - 1
    fit = [
        said
        for said in from_bits(ways)
        if said is not None and said.track == track and said.number == number % NUMBERS
    ]
    return fit[0] if len(fit) == 1 else None
