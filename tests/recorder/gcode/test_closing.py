"""Where a cut line comes back onto itself, without its leads."""

from __future__ import annotations

import pytest

from morfax.recorder.gcode.closing import loop
from morfax.recorder.gcode.program_text import Block

SQUARE = [(0.0, 0.0), (20.0, 0.0), (20.0, 20.0), (0.0, 20.0), (0.0, 0.0)]


def line(*places_mm: tuple[float, float]) -> list[Block]:
    """Blocks along places at one depth."""
    return [Block("G1", (x, y, -1.0)) for x, y in places_mm]


@pytest.mark.parametrize(
    ("places_mm", "wanted"),
    [
        (SQUARE, (0, 4)),
        ([(-3.0, 0.0), *SQUARE, (-3.0, -1.0)], (1, 5)),  # a lead-in and a lead-out
        # a lead that meets itself on its way does not hide the longer round
        ([(-3.0, 0.0), (-1.0, 0.0), *SQUARE, (-1.0, 0.0)], (1, 7)),
        (SQUARE[:-1], None),
        ([*SQUARE[:-1], (0.0, 0.06)], None),  # open by more than the noise of a line
        ([*SQUARE[:-1], (0.0, 0.04)], (0, 4)),
        ([(x / 200, y / 200) for x, y in SQUARE], None),  # 0.4 mm round: too small to tell
    ],
)
def test_a_line_goes_round_between_the_furthest_places_that_meet(places_mm, wanted):
    assert loop(line(*places_mm)) == wanted
