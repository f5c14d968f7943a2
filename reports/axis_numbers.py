"""The numbers along an axis: round, evenly apart, no more than there is room for.

Signals in: the first and the last value of an axis, and how many steps there may be. Out: values, and each as
it is written. The steps are 1, 2, 2.5 or 5 times a power of ten, as matplotlib has them.
"""

from __future__ import annotations

import math

from morfax.motion.arrays import ROUNDED

STEPS = (1.0, 2.0, 2.5, 5.0, 10.0)
MOST = 9  # steps of an axis, however long
MINUS = "\N{MINUS SIGN}"


def steps_in(long_pt: float, size_pt: float, *, upright: bool) -> int:
    """For how many steps an axis has room; a number takes three times its size along the axis, or twice."""
    return min(max(int(long_pt / (size_pt * (2 if upright else 3))), 1), MOST)


def numbers(first: float, last: float, most_steps: int) -> list[tuple[float, str]]:
    """Values from the first to the last, and how each is written."""
    least = (last - first) / most_steps
    power = math.floor(math.log10(least))
    times = next(step for step in STEPS if step * 10.0**power >= least * (1 - ROUNDED))
    step = times * 10.0**power
    decimals = max(0, -power + (times == 2.5) - (times == 10.0))
    begin = math.ceil(first / step - ROUNDED)
    end = math.floor(last / step + ROUNDED)
    values = [number * step for number in range(begin, end + 1)]
    return [(value, _written(value, decimals)) for value in values]


def _written(value: float, decimals: int) -> str:
    """A number with so many decimals, and a true minus sign."""
    text = f"{abs(value):.{decimals}f}"
    return f"{MINUS}{text}" if value < 0 and float(text) > 0 else text
