"""The interpolator as figure 2 draws it: four recirculating stores, whose digits come round one by one.

Signals: a word is a train of binary digits, the lowest first, negative numbers as the two's complement. In
each round a store's digits pass its maintenance gate 52 and come back; while a transfer gate 51 is open the
digits of the store to the right are added on the way, by an adder 50 of one digit with its carry:

    IV ─51─► +III ─51─► +II ─51─► +I ─530─► out         each store: ┌► 52 ─► adder 50 ─► delay ┐
                                                                   └─────────────────────────┘

All three adders work in the same round, on what the stores held before it: that is table I.
`player.interpolator` makes the same sums with whole words, a million times as fast; this is what they are
held to.

Source: patent US 3062995, figure 2, columns 7 and 8. Questions: the patent gives no width. A sum that needs
more digits than the store has loses them, as it would there.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(slots=True)
class Store:
    """A recirculating store: its digits, the lowest first."""

    digits: list[int]

    @classmethod
    def of(cls, word: int, width: int) -> Store:
        """Clear the store and write a word of this many digits."""
        if not -(1 << width - 1) <= word < 1 << width - 1:
            raise ValueError(
                f"{word} does not fit in {width} digits; it must be below 2^{width - 1} either way"
            )
        return cls([word >> place & 1 for place in range(width)])

    @property
    def word(self) -> int:
        """The word in the store."""
        held = sum(digit << place for place, digit in enumerate(self.digits))
        return held - (self.digits[-1] << len(self.digits))


class Stores:
    """The four stores of an interpolator and their gates: the twin of `Interpolator` for claims 1 and 10."""

    def __init__(self, words: tuple[int, int, int, int], width: int) -> None:
        self.stores = [Store.of(word, width) for word in words]

    @property
    def words(self) -> tuple[int, ...]:
        """The words in the four stores."""
        return tuple(store.word for store in self.stores)

    def round(self, gate_1: bool = True, gate_2: bool = True, gate_3: bool = True) -> None:
        """Let all digits come round once; gate 1 adds II to I, gate 2 III to II, gate 3 IV to III."""
        carries = [0, 0, 0]
        gates = (gate_1, gate_2, gate_3)
        for place in range(len(self.stores[0].digits)):
            outgoing = [store.digits[place] for store in self.stores]
            for i, open_ in enumerate(gates):
                total = outgoing[i] + (outgoing[i + 1] if open_ else 0) + carries[i]
                self.stores[i].digits[place], carries[i] = total & 1, total >> 1
