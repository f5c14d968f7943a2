"""Erasures: a frame of the check signal of which a dropout took some symbols, read all the same.

Signals in: the symbols of a frame that its check sum does not fit, how strong each is, and what the frame must
say (its track and number). Signals out: what it says, or nothing.

    strength  ____    ____        symbols below half of the usual strength may be either:
                  \\__/            each way of reading up to eight of them is held against the check sum

A dropout of 10 ms takes three to five symbols of 120. A wrong way passes the check sum once in 4e9, and must
also say the right track and number: 256 ways are one wrong frame in 2e13.

Source: R. E. Blahut, Theory and Practice of Error Control Codes, 1983 (erasures: symbols known to be bad);
D. Chase, A class of algorithms for decoding block codes with channel measurement information, IEEE Trans.
Information Theory 18, 1972 (trying the weakest). Questions: none.
"""

from __future__ import annotations

import numpy as np

from morfax.motion.arrays import Array
from morfax.recorder.tape.check_frame import NUMBERS, SYNC_SYMBOLS, Bits, CheckFrame, from_bits

WEAK = 0.5  # of the usual strength; 26 dB of noise leave 0.9
MOST_WEAK = 8  # symbols: two dropouts of 5 ms, or one of 25 ms


def recovered(bits: Bits, strengths: Array, track: int, number: int) -> CheckFrame | None:
    """What a damaged frame of this track and number says; None where too much of it is lost."""
    weak = np.flatnonzero(strengths < WEAK * np.median(strengths))
    weak = weak[weak >= SYNC_SYMBOLS]
    if not 0 < len(weak) <= MOST_WEAK:
        return None
    ways = np.repeat(bits[None], 1 << len(weak), axis=0)
    chosen = (np.arange(len(ways))[:, None] >> np.arange(len(weak))) & 1
    ways[:, weak] = 2 * chosen.astype(np.int8) - 1
    fit = [
        said
        for said in from_bits(ways)
        if said is not None and said.track == track and said.number == number % NUMBERS
    ]
    return fit[0] if len(fit) == 1 else None
