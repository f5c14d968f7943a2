"""The page of a picture: where its axes stand, in inches, without a trial drawing to lay it out.

Signals in: height to width of what is shown, how many enlargements there are, and whether there is a scale of
colours. Out: the axes on a figure of that size.

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
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

INSETS = 3  # at most
WIDE = 0.6  # height to width, below which the enlargements stand below
FLATTEST, TALLEST = 0.2, 1.4  # height to width of the main axes
WIDTH_IN, BESIDE_IN = 7.4, 3.0  # of the main axes, and of a column of enlargements
LEFT_IN, RIGHT_IN = 0.75, 0.25  # room for numbers and names beside axes
TITLE_IN, NAMES_IN = 0.45, 0.6  # above and below the main axes
BAR_IN, BAR_HIGH_IN = 0.8, 0.16  # room for the scale of colours, and the scale itself
ROW_IN = 3.0  # of enlargements below
AROUND_IN = (
    0.45,
    0.55,
)  # what an enlargement has beside and below or above it, for numbers and its title


@dataclass(frozen=True, slots=True)
class Page:
    """The axes of one picture: the main ones, the enlargements, and those of the scale of colours."""

    main: Axes
    insets: list[Axes]
    bar: Axes | None
    wide_in: float  # of the main axes


def lay_out(figure: Figure, height_to_width: float, insets: int, *, has_bar: bool) -> Page:
    """Set the size of a figure, and put its axes on it."""
    shape = max(height_to_width, FLATTEST)
    high = WIDTH_IN * min(shape, TALLEST)
    wide = high / shape
    is_low = insets > 0 and shape < WIDE
    below = (BAR_IN if has_bar else 0.0) + (ROW_IN if is_low else 0.0)
    column = BESIDE_IN if insets and not is_low else 0.0
    width, height = LEFT_IN + wide + RIGHT_IN + column, TITLE_IN + high + NAMES_IN + below
    figure.set_size_inches(width, height)

    def axes(left: float, bottom: float, across: float, up: float) -> Axes:
        return figure.add_axes((left / width, bottom / height, across / width, up / height))

    main = axes(LEFT_IN, NAMES_IN + below, wide, high)
    bar_wide, bar_low = 0.7 * wide, below - BAR_IN + 0.5
    bar = axes(LEFT_IN + 0.15 * wide, bar_low, bar_wide, BAR_HIGH_IN) if has_bar else None
    beside: list[Axes] = []
    cell_wide = width / INSETS if is_low else column
    cell_high = ROW_IN if is_low else height / INSETS
    side = min(cell_wide - AROUND_IN[0] - 0.1, cell_high - AROUND_IN[1])
    for number in range(insets):
        left = number * cell_wide if is_low else width - column
        bottom = 0.0 if is_low else height - (number + 1) * cell_high
        left += AROUND_IN[0] + (cell_wide - AROUND_IN[0] - side) / 2 - 0.05
        beside.append(axes(left, bottom + AROUND_IN[1] / 2, side, side))
    return Page(main, beside, bar, wide)
