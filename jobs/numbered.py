"""Things by their numbers, as remarks name them.

Signals in: what they are, and their numbers; out: the beginning of a sentence.
"""


def numbered(what: str, numbers: list[int]) -> str:
    """Things by their numbers, with their verb."""
    if len(numbers) == 1:
        return f"{what} {numbers[0]} is"
    return f"{what}s {', '.join(map(str, numbers))} are"
