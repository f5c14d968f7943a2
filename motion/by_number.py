"""Things by their numbers, as messages name them.

Signals in: what they are, and their numbers; out: the beginning of a sentence.
"""

from __future__ import annotations

from collections.abc import Sequence

MOST_NAMED = 6  # numbers that a sentence names; of more it says how many there are


def numbered(what: str, numbers: Sequence[int]) -> str:
    """Things by their numbers, with their verb."""
    return f"{listed(what, numbers)} {'is' if len(numbers) == 1 else 'are'}"


def listed(what: str, numbers: Sequence[int]) -> str:
    """Things by their numbers."""
    return f"{what}{'' if len(numbers) == 1 else 's'} {few(numbers)}"


def few(numbers: Sequence[int]) -> str:
    """A few numbers; of many the first, and how many more there are."""
    named = ", ".join(map(str, numbers[:MOST_NAMED]))
    more = len(numbers) - MOST_NAMED
    return f"{named} and {more} more" if more > 0 else named


def and_so(others: int, one: str, several: str) -> str:
    """That something holds of so many others too, by the verb for one or several; nothing without others."""
    return f", and so {one if others == 1 else several} {others} more" if others else ""
