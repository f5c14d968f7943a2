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

from morfax.reports.canvas import FLATTEST, ROOM_IN, TALLEST, WIDTH_IN

INSETS = 3  # at most
WIDE = 0.6  # height to width, below which the enlargements stand below
INSET_IN = 3.0  # a column or a row of enlargements
LETTERS_PER_IN = 11.0  # of a title of 10 points: capitals and underscores too
EDGE_IN = 0.5  # room for a title, and round what has no numbers


class Box(NamedTuple):
    """A rectangle on the page, from its lower left corner, inches."""

    left_in: float
    bottom_in: float
    width_in: float
    height_in: float

    @property
    def title_letters(self) -> int:
        """How many letters of a title there is room for."""
        return round(self.width_in * LETTERS_PER_IN)


@dataclass(frozen=True, slots=True)
class PageLayout:
    """A page, inches: the boxes of the main axes, of the enlargements, and of the scale of colours."""

    width_in: float
    height_in: float
    main: Box
    insets: list[Box]
    bar: Box | None


def shortened(title: str, letters: int) -> str:
    """A title in so many letters: of a long one a part of the drawing's name, with which it begins, is left
    out, and not what the colours mean.
    """
    if len(title) <= letters:
        return title
    first = letters // 4
    return f"{title[:first]}…{title[first + 1 - letters :]}"


def lay_out(height_to_width: float, insets: int, *, has_bar: bool) -> PageLayout:
    """Choose the size of a page, and the places of its axes."""
    shape = max(height_to_width, FLATTEST)
    high = WIDTH_IN * min(shape, TALLEST)
    wide = high / shape
    is_low = insets > 0 and shape < WIDE
    below = (ROOM_IN if has_bar else 0.0) + (INSET_IN if is_low else 0.0)
    column = INSET_IN if insets and not is_low else 0.0
    width = ROOM_IN + wide + EDGE_IN + column
    height = EDGE_IN + high + ROOM_IN + below
    main = Box(ROOM_IN, ROOM_IN + below, wide, high)
    bar_low = below - ROOM_IN + EDGE_IN
    bar = Box(ROOM_IN, bar_low, wide, EDGE_IN / 4) if has_bar else None
    beside: list[Box] = []
    cell_wide = width / INSETS if is_low else column
    cell_high = INSET_IN if is_low else height / INSETS
    side = min(cell_wide, cell_high) - ROOM_IN
    for number in range(insets):
        left = number * cell_wide if is_low else width - column
        bottom = 0.0 if is_low else height - (number + 1) * cell_high
        beside.append(
            Box(left + (cell_wide - side) / 2, bottom + (cell_high - side) / 2, side, side)
        )
    return PageLayout(width, height, main, beside, bar)
