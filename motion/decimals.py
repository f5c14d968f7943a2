"""Decimals: rows of numbers as text, with so many decimals in each column.

Signals in: numbers (rows, columns), decimals of each column. Signals out: a line for each row, the numbers
between commas; to the letter what `"%.5f"` makes of rounded numbers, without minus zero.

    number · 10^decimals ─► rounded to a whole number ─► its digits, with a point among them

Python's own formatting takes twenty times as long, and keeps all other threads waiting.

Source: our own. Questions: beyond 1e15 units of the last decimal a double has no such decimals; these, and
what is no number, are left to Python.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.compiled import njit

# of the last decimal: half a unit is still more than the number's own rounding
LARGEST_UNITS = 1e15
MOST_CHARACTERS = 19  # of a number: sign, 16 digits, point, and what comes after it
COMMA, NEW_LINE, MINUS, POINT, ZERO = b",\n-.0"


def lines_of(numbers: Array, decimals: Sequence[int]) -> str:
    """The lines of rows of numbers, each column with so many decimals."""
    units = np.rint(numbers * 10.0 ** np.array(decimals))
    if not (np.abs(units) < LARGEST_UNITS).all():
        line = ",".join(f"%.{many}f" for many in decimals) + "\n"
        rounded = np.column_stack(
            [np.round(column, many) for column, many in zip(numbers.T, decimals, strict=True)]
        )
        return line * len(rounded) % tuple((rounded + 0.0).ravel())
    text = np.empty(units.size * MOST_CHARACTERS, np.uint8)
    count = _write(units.astype(np.int64), np.array(decimals, np.int64), text)
    return text[:count].tobytes().decode("ascii")


@njit(cache=True, nogil=True)
def _write(units, decimals, text):  # type: ignore[no-untyped-def]
    """Write rows of whole numbers, the last so many digits of which are decimals; how many characters."""
    at, columns = 0, units.shape[1]
    for row in range(len(units)):
        for column in range(columns):
            left, places = units[row, column], decimals[column]
            if left < 0:
                text[at], left = MINUS, -left
                at += 1
            # 1. room for the digits: one before the point at least
            digits, beyond = 1, left // 10
            while beyond > 0 or digits <= places:
                digits, beyond = digits + 1, beyond // 10
            # 2. from the last to the first
            end = at + digits + (places > 0)
            place = end
            for digit in range(digits):
                if digit == places and places > 0:
                    place -= 1
                    text[place] = POINT
                place -= 1
                text[place] = ZERO + left % 10
                left //= 10
            text[end] = COMMA if column < columns - 1 else NEW_LINE
            at = end + 1
    return at
