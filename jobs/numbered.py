"""Things by their numbers, as remarks name them.

Signals in: what they are, and their numbers; out: the beginning of a sentence.
"""

MOST_NAMED = 6  # numbers that a sentence names; of more it says how many there are


def numbered(what: str, numbers: list[int]) -> str:
    """Things by their numbers, with their verb."""
    return f"{listed(what, numbers)} {'is' if len(numbers) == 1 else 'are'}"


def and_so(others: int, one: str, several: str) -> str:
    """That something holds of so many others too, by the verb for one or several; nothing without others."""
    return f", and so {one if others == 1 else several} {others} more" if others else ""


def listed(what: str, numbers: list[int]) -> str:
    """Things by their numbers: all of a few; of many how many there are, and the first."""
    if len(numbers) == 1:
        return f"{what} {numbers[0]}"
    named = ", ".join(map(str, numbers[:MOST_NAMED]))
    if len(numbers) <= MOST_NAMED:
        return f"{what}s {named}"
    return f"{len(numbers)} {what}s ({named} and so on)"
