"""The frame of the check signal: what each track says of itself, in 120 bits.

Signals in: what is to be said, or 120 bits; out: 120 bits, or what they say; nothing, where the check sum is
wrong.

    24 sync | 64 told | 32 CRC-32 of the 64                    most significant bit first
    told:  3 version | 1 last | 4 track | 16 number | 20 count | 6 middle | 7 speed | 7 acceleration

What the reference's track says in place of the last four: told_figures.py.

`count` is the axis' displacement at the frame's first instant, in sixty-fourths of a cycle (version 1:
sixteenths), with a sign; beyond 0.4 m at 20 cycles per mm it begins again at the other end. `middle` is the
same in the middle of the frame, modulo one cycle. Versions 1 and 2 tell no middle, and have its bits for the
count, as the reference's track has. `speed` and `acceleration` are the largest from the first instant to the
end of the next frame, in eighths of an octave, rounded up: a frame that is lost was told of by the one before
it. `last`: at most one whole frame follows.
Told and CRC are whitened by a pseudo-random sequence, so that a track that stands does not send one tone.

Source: sync word of 24 bits: IRIG 106, appendix for PCM (hex FAF320); CRC-32: IEEE 802.3, as zlib has it;
whitening: the sequence x^7 + x^4 + 1 of IEEE 802.11. Questions: a random frame passes the CRC once in 4e9.
"""

from __future__ import annotations

import math
from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import ROUNDED
from morfax.motion.compiled import lasting, njit

VERSION = 3
SYMBOLS = 120  # of a frame
SYNC_SYMBOLS = 24
_SYNC = 0xFAF320
_TOLD_BYTES, _CRC_BYTES = 8, 4
COUNTS_PER_CYCLE = {1: 16, 2: 64, 3: 64}  # by version
NUMBERS = 1 << 16  # of frames, then they begin again: after nine hours
MOST_TRACKS = 16  # of a tape; chosen here
# the middle's bits are the last of the count's
_COUNT_BITS, _MIDDLE_BITS, _CODE_BITS = 26, 6, 7
# where in a frame's 64 bits its number begins, its track, whether it is the last, and its version
_NUMBER_AT = _COUNT_BITS + 2 * _CODE_BITS
_TRACK_AT = _NUMBER_AT + NUMBERS.bit_length() - 1
LAST_AT = _TRACK_AT + MOST_TRACKS.bit_length() - 1
_VERSION_AT = LAST_AT + 1
_PER_OCTAVE = 8
LEAST_SPEED, LEAST_ACCELERATION = 0.5, 32.0  # cycles/s and cycles/s²: of code 1; 0 is at rest

Bits = NDArray[np.int8]


class CheckFrame(NamedTuple):
    """What one track says: cycles, cycles/s and cycles/s²; speed and acceleration as rounded up.

    `middle_cycles`: in the middle of the frame, modulo one; None: not told, or to be told as at its start.
    """

    track: int
    number: int
    cycles: float
    speed: float = 0.0
    acceleration: float = 0.0
    last: bool = False
    version: int = VERSION
    middle_cycles: float | None = None

    @property
    def counts(self) -> int:
        """The displacement in counts, rounded."""
        return round(self.cycles * COUNTS_PER_CYCLE[self.version])

    @property
    def grain_cycles(self) -> float:
        """Cycles to a count."""
        return 1 / COUNTS_PER_CYCLE[self.version]

    @property
    def turn_cycles(self) -> float:
        """Cycles after which the counts begin again."""
        return turn_cycles(self.version, self.track)


@cache  # of three versions and 16 tracks: asked twice a frame
def turn_cycles(version: int, track: int) -> float:
    """Cycles after which the counts of a track begin again."""
    return (1 << _COUNT_BITS - middle_bits(version, track)) / COUNTS_PER_CYCLE[version]


def middle_bits(version: int, track: int) -> int:
    """The bits of the count that tell where an axis is in the middle of the frame."""
    return _MIDDLE_BITS if version >= 3 and track else 0


def _whitening() -> NDArray[np.uint8]:
    """The pseudo-random bits that told and CRC are added to."""
    state, bits = [1] * 7, []
    for _ in range(SYMBOLS - SYNC_SYMBOLS):
        bit = state[6] ^ state[3]
        state = [bit, *state[:6]]
        bits.append(bit)
    return np.array(bits, np.uint8)


def _crc_of_bytes() -> NDArray[np.uint32]:
    """The CRC-32 of each byte, by which that of more bytes is made."""
    crcs = np.arange(256, dtype=np.uint32)
    for _ in range(8):
        crcs = np.where(crcs & 1, crcs >> 1 ^ 0xEDB88320, crcs >> 1).astype(np.uint32)
    return crcs


SYNC: Bits = np.array(
    [1 if _SYNC >> bit & 1 else -1 for bit in range(SYNC_SYMBOLS - 1, -1, -1)], np.int8
)
# the whitening, and the CRC-32 of each byte, for `tell`; the same with the sync word, for `send`
TABLES = (_whitening(), _crc_of_bytes())
SENT_BY = lasting((SYNC, *TABLES))


def to_bits(frame: CheckFrame) -> Bits:
    """The frame as 120 symbols of +1 and -1; raises ValueError for a track that has no room."""
    if not 0 <= frame.track < MOST_TRACKS:
        raise ValueError(f"track {frame.track} has no room in a check frame")
    middle = frame.cycles if frame.middle_cycles is None else frame.middle_cycles
    counts = frame.counts, round(middle * COUNTS_PER_CYCLE[frame.version])
    state = frame.version, frame.last, middle_bits(frame.version, frame.track)
    word = word_of(frame[:2], state, counts, frame[3:5])
    symbols = np.empty((SYMBOLS + 1, 1))
    send(np.array([word]), SENT_BY, symbols)
    return symbols[:SYMBOLS, 0].astype(np.int8)


@njit(cache=True, nogil=True)
def word_of(who, state, counts, most):  # type: ignore[no-untyped-def]
    """The 64 bits that a track tells.

    `who`: track and number; `state`: version, whether the tape ends, bits of a middle; `counts`: where it is
    at the frame's first instant, and in its middle; `most`: speed and acceleration.
    """
    (track, number), (version, last, of_middle) = who, state
    word = ((version << 1 | int(last)) << 4 | track) << 16 | int(number) % NUMBERS
    word = word << _COUNT_BITS - of_middle | counts[0] & (1 << _COUNT_BITS - of_middle) - 1
    word = word << of_middle | counts[1] & (1 << of_middle) - 1
    word = word << _CODE_BITS | to_code(most[0], LEAST_SPEED)
    return word << _CODE_BITS | to_code(most[1], LEAST_ACCELERATION)


@njit(cache=True, nogil=True)
def send(words, tables, symbols):  # type: ignore[no-untyped-def]
    """Fill in the symbols, +1 and -1, of frames that are sent side by side (symbols, words): sync word, told
    bits and check sum, and the first symbol of the frames that come next.
    """
    sync, white, byte_crcs = tables
    for track in range(len(words)):
        word, crc = words[track], 0xFFFFFFFF
        for byte in range(_TOLD_BYTES):
            value = word >> 8 * (_TOLD_BYTES - 1 - byte) & 0xFF
            crc = int(byte_crcs[(crc ^ value) & 0xFF]) ^ crc >> 8
        crc ^= 0xFFFFFFFF
        for at in range(len(sync)):
            symbols[at, track] = sync[at]
        for at in range(len(white)):
            told = at < 8 * _TOLD_BYTES
            left = 8 * _TOLD_BYTES - 1 - at if told else 8 * (_TOLD_BYTES + _CRC_BYTES) - 1 - at
            bit = (word if told else crc) >> left & 1
            symbols[len(sync) + at, track] = 1.0 if bit != white[at] else -1.0
        symbols[len(sync) + len(white), track] = sync[0]


def from_bits(bits: Bits) -> list[CheckFrame | None]:
    """What rows of 120 symbols of +1 and -1 say; None where the check sum is wrong."""
    told = np.empty(len(bits), np.int64)
    is_right = np.empty(len(bits), bool)
    tell(bits, *TABLES, told, is_right)
    if not is_right.any():  # as nearly all that are tried by chance
        return [None] * len(bits)
    return [
        said_by(one) if right else None
        for one, right in zip(told.view(np.uint64).tolist(), is_right.tolist(), strict=True)
    ]


@njit(cache=True, nogil=True)
def tell(bits, white, byte_crcs, told, is_right):  # type: ignore[no-untyped-def]
    """Fill the 64 bits that each row of symbols tells, and whether its check sum is right."""
    for row in range(len(bits)):
        word, crc, own = 0, 0xFFFFFFFF, 0
        for byte in range(len(white) // 8):
            value = 0
            for at in range(8 * byte, 8 * byte + 8):
                value = 2 * value + int((bits[row, SYNC_SYMBOLS + at] > 0) != (white[at] > 0))
            if byte < _TOLD_BYTES:
                word = word << 8 | value
                crc = int(byte_crcs[(crc ^ value) & 0xFF]) ^ crc >> 8
            else:
                own = own << 8 | value
        told[row] = word
        is_right[row] = own == crc ^ 0xFFFFFFFF


@njit(cache=True, inline="always")
def is_of(told, track, number):  # type: ignore[no-untyped-def]
    """Whether told bits are those of a track's frame of this number, of the version that is written now."""
    is_new = told >> _VERSION_AT & 7 == VERSION
    is_its_own = told >> _TRACK_AT & (MOST_TRACKS - 1) == track
    return is_new and is_its_own and told >> _NUMBER_AT & (NUMBERS - 1) == number % NUMBERS


@njit(cache=True, inline="always")
def said_of_axis(told, values):  # type: ignore[no-untyped-def]
    """What the told bits of an axis say, in the version that is written now: cycles, those of the middle,
    speed and acceleration, whose values of all codes are given.
    """
    codes, word = told & (1 << 2 * _CODE_BITS) - 1, told >> 2 * _CODE_BITS
    middle = word & (1 << _MIDDLE_BITS) - 1
    count = word >> _MIDDLE_BITS & (1 << _COUNT_BITS - _MIDDLE_BITS) - 1
    if count >> _COUNT_BITS - _MIDDLE_BITS - 1:
        count -= 1 << _COUNT_BITS - _MIDDLE_BITS
    speed, acceleration = codes >> _CODE_BITS, codes & (1 << _CODE_BITS) - 1
    per_cycle = 1 << _MIDDLE_BITS  # the middle is told modulo a cycle
    return count / per_cycle, middle / per_cycle, values[0, speed], values[1, acceleration]


def said_by(told: int) -> CheckFrame | None:
    """What the told bits say, behind a right check sum."""
    version = told >> _VERSION_AT
    if version not in COUNTS_PER_CYCLE:
        return None
    track = told >> _TRACK_AT & (MOST_TRACKS - 1)
    bits = middle_bits(version, track)
    codes = told & ((1 << 2 * _CODE_BITS) - 1)
    code_mask = (1 << _CODE_BITS) - 1
    word = told >> 2 * _CODE_BITS & ((1 << _COUNT_BITS) - 1)
    middle, count = word & ((1 << bits) - 1), word >> bits
    if count >> (_COUNT_BITS - bits - 1):
        count -= 1 << _COUNT_BITS - bits
    return CheckFrame(
        track,
        told >> _NUMBER_AT & (NUMBERS - 1),
        count / COUNTS_PER_CYCLE[version],
        to_value(codes >> _CODE_BITS, LEAST_SPEED),
        to_value(codes & code_mask, LEAST_ACCELERATION),
        bool(told >> LAST_AT & 1),
        version,
        middle / COUNTS_PER_CYCLE[version] if bits else None,
    )


@njit(cache=True, nogil=True)
def to_code(value, least):  # type: ignore[no-untyped-def]
    """The code of a speed or acceleration, rounded up; the largest for all that is beyond it."""
    if not value > 0:
        return 0
    steps = math.log2(max(value / least, 1.0)) * _PER_OCTAVE - ROUNDED
    most = (1 << _CODE_BITS) - 1
    return most if steps > most - 2 else 1 + math.ceil(steps)


@cache  # of 128 codes each
def to_value(code: int, least: float) -> float:
    """The speed or acceleration of a code; infinite for the largest."""
    if not code:
        return 0.0
    if code == (1 << _CODE_BITS) - 1:
        return math.inf
    return least * 2.0 ** ((code - 1) / _PER_OCTAVE)


def values_of_codes() -> NDArray[np.float64]:
    """The speeds and accelerations of all codes (2, codes)."""
    codes = range(1 << _CODE_BITS)
    least = LEAST_SPEED, LEAST_ACCELERATION
    return np.array([[to_value(code, of) for code in codes] for of in least])
