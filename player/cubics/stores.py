"""The interpolator as figure 2 draws it: four recirculating stores, whose digits come round one by one.

Signals: a word is a train of binary digits, the lowest first, negative numbers as the two's complement. In
each round a store's digits pass its maintenance gate 52 and come back; while a transfer gate 51 is open the
digits of the store to the right are added on the way, by an adder 50 of one digit with its carry:

    IV ─51─► +III ─51─► +II ─51─► +I ─530─► out         each store: ┌► 52 ─► adder 50 ─► delay ┐
                                                                   └─────────────────────────┘

All three adders work in the same round, on what the stores held before it: that is table I. Each store has
fewer digits than the one before (claim 9); beyond its own highest digit a store gives its sign, which a
flip-flop has kept. `morfax play part.cubic --historic` runs on these stores; the usual control makes the same
sums with whole words (`interpolator`), which is twenty times as fast.

Source: patent US 3062995, figure 2, columns 7 and 8, claims 9 and 10. Questions: the patent gives no lengths.
It also lets the lower digits of III and IV fall off on the way up, which ends up to 20 counts beside the
sample at 16 steps; here the stores are shorter by their highest digits only. A program whose words do not fit
is refused; a sum that needs more digits than its store has would lose them, as it would there.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from morfax.motion.compiled import njit

# digits of the stores I to IV, chosen: places of 2 m, then speeds, accelerations and their change, each with
# the 33 digits behind the point of 2048 steps
LENGTHS = (60, 48, 44, 40)

Words = NDArray[np.int64]


def too_long(words: Words, store: int) -> bool:
    """Whether there is a word that does not fit in the store with this number, 0 … 3."""
    return bool((np.abs(words) >= 1 << LENGTHS[store] - 1).any())


@njit(cache=True, inline="always")
def write(store, length, word):  # type: ignore[no-untyped-def]
    """Clear a store and write a word: its digits, the lowest first."""
    for place in range(length):
        store[place] = word >> place & 1


@njit(cache=True, inline="always")
def content(store, length):  # type: ignore[no-untyped-def]
    """The word in a store."""
    word = -store[length - 1]  # of the two's complement
    for place in range(length - 2, -1, -1):
        word = 2 * word + store[place]
    return word


@njit(cache=True)
def circulate(stores, lengths, gates):  # type: ignore[no-untyped-def]
    """Let all digits come round once; gate 1 adds II to I, gate 2 III to II, gate 3 IV to III."""
    carries = np.zeros(3, np.int64)
    signs = np.array([stores[i, lengths[i] - 1] for i in range(4)])
    for place in range(lengths[0]):
        for i in range(3):  # from left to right: the store to the right still has its old digit
            if place >= lengths[i]:
                continue
            coming = stores[i + 1, place] if place < lengths[i + 1] else signs[i + 1]
            total = stores[i, place] + (coming if gates[i] else 0) + carries[i]
            stores[i, place], carries[i] = total & 1, total >> 1


@njit(cache=True)
def interpolate(words, points, linear, first, out):  # type: ignore[no-untyped-def]
    """Run the stores of all axes through all intervals: register I after each step, as `interpolator`."""
    lengths = np.array(LENGTHS)
    stores = np.zeros((4, lengths[0]), np.int64)
    for axis in range(words.shape[1]):
        write(stores[0], lengths[0], first[axis])
        for k in range(len(words)):
            for i in range(3):
                write(stores[i + 1], lengths[i + 1], words[k, axis, i])
            for step in range(points):
                is_cubic = step % linear == linear - 1
                circulate(stores, lengths, (True, is_cubic, is_cubic))
                out[k * points + step, axis] = content(stores[0], lengths[0])
        first[axis] = content(stores[0], lengths[0])
