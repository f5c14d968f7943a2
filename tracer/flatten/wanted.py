"""What is wanted of a photograph: what on it says how it is made flat.

auto                            marks if there are any, else a sheet of the one format that fits
marks                           marks of a printed sheet
paper=a4                        the four edges of a sheet of a known format
X,Y X,Y X,Y X,Y=200x100mm       four places and the rectangle that they are, in pixels of the photograph
                                from its upper left corner, clockwise from the rectangle's upper left one
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Literal

import numpy as np

from morfax.motion.arrays import Array
from morfax.tracer.flatten import formats
from morfax.tracer.flatten.formats import Format

Way = Literal["auto", "marks", "paper", "corners"]

ALLOWED = (
    "auto, marks, paper=a4 (letter, a3, 148x105mm …), or four places and their size in the form"
    ' "120,80 3900,95 3850,2900 150,2880=200x100mm"'
)
_PLACE = re.compile(r"(-?[\d.]+),(-?[\d.]+)")


@dataclass(frozen=True, slots=True)
class Wanted:
    """How a photograph is to be made flat; the format, and the four places (px), where they are given."""

    way: Way
    paper: Format | None = None
    corners_px: tuple[tuple[float, float], ...] = ()


def parsed(text: str) -> Wanted:
    """Read what is wanted; raises ValueError for a text that says nothing of the kind."""
    word = text.strip()
    if word.lower() in ("auto", "marks"):
        return Wanted("auto" if word.lower() == "auto" else "marks")
    before, equals, size = word.rpartition("=")
    if before.strip().lower() == "paper":
        return Wanted("paper", formats.parsed(size))
    places = [_PLACE.fullmatch(part) for part in before.split()]
    if not equals or not places or not all(places):
        raise ValueError(f"{text.strip()[:60]!r} is not a way to flatten; give {ALLOWED}")
    try:
        corners = [(float(place[1]), float(place[2])) for place in places if place]
    except ValueError:
        raise ValueError(
            f"{text.strip()[:60]!r} is not a way to flatten; give {ALLOWED}"
        ) from None
    if len(corners) != 4:
        raise ValueError(
            f"four places make a rectangle, {len(corners)} were given; give {ALLOWED}"
        )
    _check_round(np.array(corners))
    return Wanted("corners", formats.parsed(size), tuple(corners))


def _check_round(corners_px: Array) -> None:
    """Raise ValueError unless four places run round a convex figure clockwise, as one sees it."""
    ways = np.roll(corners_px, -1, axis=0) - corners_px
    x, y = ways.T
    turns = x * np.roll(y, -1) - y * np.roll(x, -1)
    if (turns > 0).all():  # Y runs down
        return
    what = (
        "run anticlockwise, which would mirror the drawing"
        if (turns < 0).all()
        else "do not go round a rectangle"
    )
    raise ValueError(
        f"the four places {what}; give them clockwise: upper left, upper right, lower right, lower left"
    )
