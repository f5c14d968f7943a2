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

from morfax.motion.arrays import Array, median
from morfax.motion.compiled import njit
from morfax.player.tape.symbols import Gates
from morfax.recorder.tape.check_frame import NUMBERS, SYNC_SYMBOLS, Bits, CheckFrame, from_bits

WEAK = 0.5  # of the usual strength; 15 dB of noise leave 0.75 (four standard deviations)
MOST_WEAK = 8  # symbols: two dropouts of 5 ms, or one of 25 ms
_NONE: Array = np.zeros(0)


class Erasures:
    """Reads the frames of the tracks of one tape; holds how strong the symbols of each usually are."""

    def __init__(self, tracks: int) -> None:
        self.usual = np.full(tracks, np.nan)
        self.size = np.full(tracks, np.nan)  # of a symbol, at the median
        self.damaged: list[int] = []
        self.weak: list[Array] = []

    def read(self, gates: Gates, number: int) -> list[CheckFrame | None]:
        """What the tracks say in the frame of this number; None where it is lost.

        `damaged` are then the tracks that say nothing though few of their symbols are weak, and `weak` the
        places of each track at which it is weak, in symbols from the first.
        """
        said = from_bits(gates.bits)
        self.damaged, self.weak = [], []
        counts = np.empty((len(said), 3), np.int64)
        least, usual = np.empty((2, len(said), 2))
        held = (self.usual, self.size)
        weigh((gates.strengths, gates.sizes, gates.shares), held, usual, least, counts)
        most_small = counts[0, 1] > MOST_WEAK
        for track, (weak, small, faint) in enumerate(counts.tolist()):
            if most_small or small > MOST_WEAK:
                places = np.flatnonzero(gates.sizes[track] < least[track, 1])
                self.weak.append(places.astype(np.float64))
            else:
                self.weak.append(
                    _places(gates.shares[track], least[track, 0]) if faint else _NONE
                )
            if weak > MOST_WEAK:
                said[track] = None
                continue
            if said[track] is None:
                at = np.flatnonzero(gates.strengths[track] < least[track, 0])
                at = at[at >= SYNC_SYMBOLS]
                said[track] = _recovered(gates.bits[track], at, track, number)
            if said[track] is None:
                self.damaged.append(track)
            else:
                self.usual[track], self.size[track] = usual[track]
        return said


@njit(cache=True, nogil=True)
def weigh(seen, held, usual, least, counts):  # type: ignore[no-untyped-def]
    """Weigh the strengths, sizes and shares of each track's symbols.

    `held`: usual strength and size so far, nan where none is; `usual` (tracks, 2): those of this frame, at
    the median; `least` (tracks, 2): below them a symbol is weak or small; `counts` (tracks, 3): weak ones,
    small ones, faint gates.
    """
    strengths, sizes, shares = seen
    for track in range(len(strengths)):
        usual[track] = median(strengths[track]), median(sizes[track])
        known = held[0][track] if np.isfinite(held[0][track]) else usual[track, 0]
        least[track] = WEAK * known, WEAK * held[1][track]
        counts[track] = 0
        for symbol in range(strengths.shape[1]):
            counts[track, 0] += strengths[track, symbol] < least[track, 0]
            counts[track, 1] += sizes[track, symbol] < least[track, 1]
            for gate in range(shares.shape[1]):
                counts[track, 2] += shares[track, gate, symbol] < least[track, 0]


def _places(shares: Array, least: float) -> Array:
    """The places of faint gates (gates, symbols), in symbols."""
    gate, symbol = np.nonzero(shares < least)
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
