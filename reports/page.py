"""Where a picture's axes stand on its page, in inches, without a trial drawing to lay it out.

Signals in: height to width of what is shown, how many enlargements there are, and whether there is a scale of
colours. Out: the size of the page, and boxes on it.

    wide enough for a column                     wide and low
    +-----------+  +---+                         +------------------+
    |   main    |  | 1 |                         |       main       |
    |           |  | 2 |                         +------------------+
    +-----------+  | 3 |                          ====== colours
      == colours   +---+                         | 1 |  | 2 |  | 3 |

matplotlib's own layouts draw all words two or three times to learn their sizes: 0.5 s of a picture. Here the
room for words is fixed: numbers of up to six digits, and a title of one line.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from morfax.reports.canvas import FLATTEST, TALLEST

INSETS = 3  # at most
WIDE = 0.6  # height to width, below which the enlargements stand below
WIDTH_IN, BESIDE_IN = 7.4, 3.0  # of the main axes, and of a column of enlargements
LEFT_IN, RIGHT_IN = 0.75, 0.25  # room for numbers and names beside axes
TITLE_IN, NAMES_IN = 0.45, 0.6  # above and below the main axes
BAR_IN, BAR_HIGH_IN = 0.8, 0.16  # room for the scale of colours, and the scale itself
ROW_IN = 3.0  # of enlargements below
# what an enlargement has beside and below or above it, for numbers and its title
AROUND_IN = (0.45, 0.55)


class Box(NamedTuple):
    """A rectangle on the page, from its lower left corner, inches."""

    left_in: float
    bottom_in: float
    width_in: float
    height_in: float


@dataclass(frozen=True, slots=True)
class Page:
    """A page, inches: the boxes of the main axes, of the enlargements, and of the scale of colours."""

    width_in: float
    height_in: float
    main: Box
    insets: list[Box]
    bar: Box | None


def lay_out(height_to_width: float, insets: int, *, has_bar: bool) -> Page:
    """Choose the size of a page, and the places of its axes."""
    shape = max(height_to_width, FLATTEST)
    high = WIDTH_IN * min(shape, TALLEST)
    wide = high / shape
    is_low = insets > 0 and shape < WIDE
    below = (BAR_IN if has_bar else 0.0) + (ROW_IN if is_low else 0.0)
    column = BESIDE_IN if insets and not is_low else 0.0
    width = LEFT_IN + wide + RIGHT_IN + column
    height = TITLE_IN + high + NAMES_IN + below
    main = Box(LEFT_IN, NAMES_IN + below, wide, high)
    bar_wide, bar_low = 0.7 * wide, below - BAR_IN + 0.5
    bar = Box(LEFT_IN + 0.15 * wide, bar_low, bar_wide, BAR_HIGH_IN) if has_bar else None
    beside: list[Box] = []
    cell_wide = width / INSETS if is_low else column
    cell_high = ROW_IN if is_low else height / INSETS
    side = min(cell_wide - AROUND_IN[0] - 0.1, cell_high - AROUND_IN[1])
    for number in range(insets):
        left = number * cell_wide if is_low else width - column
        bottom = 0.0 if is_low else height - (number + 1) * cell_high
        left += AROUND_IN[0] + (cell_wide - AROUND_IN[0] - side) / 2 - 0.05
        beside.append(Box(left, bottom + AROUND_IN[1] / 2, side, side))
    return Page(width, height, main, beside, bar)
