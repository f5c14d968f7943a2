"""Lines that the picture's edge cuts, as `morfax trace` tells of them."""

from __future__ import annotations

from pathlib import Path

import pytest
from PIL import Image, ImageDraw

from tests.console.conftest import Morfax


@pytest.mark.parametrize(("left_px", "is_told"), [(-3, True), (4, False)])
def test_a_line_of_which_the_picture_holds_a_part_only_is_told(
    morfax: Morfax, here: Path, left_px: int, is_told: bool
) -> None:
    """A rectangle of a line of 6 pixels, of whose left side the picture holds 3 columns, or all."""
    picture = Image.new("L", (700, 600), 255)
    ImageDraw.Draw(picture).rectangle((left_px, 100, 600, 500), outline=0, width=6)
    picture.save("cut.png", dpi=(300, 300))
    run = morfax("trace", "cut.png", "-o", "cut.csv", "--json")
    assert run.exit_code == 0
    assert run.figures["ending"] == "closed"
    assert ("runs along the picture's edge for 33 mm" in run.err) == is_told, run.err


def test_lines_that_end_at_the_edge_are_not(morfax: Morfax, here: Path) -> None:
    picture = Image.new("L", (700, 600), 255)
    ImageDraw.Draw(picture).line((0, 300, 699, 320), fill=0, width=6)
    picture.save("across.png", dpi=(300, 300))
    run = morfax("trace", "across.png", "--lines", "all", "-o", "across.csv")
    assert run.exit_code == 0 and "picture's edge" not in run.err, run.err
