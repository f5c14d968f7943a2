"""On coloured paper ink is as dark as on white paper, whatever is whiter than the paper."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from morfax.tracer.drawing.coloured_paper import levels_on_white
from morfax.tracer.drawing.drawing import Drawing

BROWN, INK, WHITE = (207, 165, 95), (80, 62, 35), (255, 255, 255)
# as scanned; an old print that has faded
BLUEPRINT, FADED = (10, 85, 183), (110, 150, 200)
DPI = 100


def sheet(
    paper: tuple[int, int, int], label: bool = True, ink: tuple[int, int, int] = INK
) -> Image.Image:
    """A sheet with four thin lines of ink, and a white label with letters of the paper's colour."""
    colours = np.full((400, 600, 3), paper, np.uint8)
    for row in (60, 140, 220, 300):
        colours[row : row + 3, 40:560] = ink
    if label:
        colours[340:390, 40:200] = WHITE
        colours[350:380, 60:180:8] = paper
    return Image.fromarray(colours)


def test_lines_on_brown_paper_are_ink_beside_a_white_label(tmp_path: Path) -> None:
    sheet(BROWN).save(tmp_path / "map.png", dpi=(DPI, DPI))
    drawing = Drawing.open(tmp_path / "map.png")
    assert drawing.darkness[61, 300] > 0.9
    assert drawing.darkness[100, 300] < 0.1


@pytest.mark.parametrize("paper", [(255, 255, 255), (240, 225, 200), (40, 70, 110)])
def test_white_yellowed_and_dark_paper_stays_as_it_is(paper: tuple[int, int, int]) -> None:
    assert levels_on_white(sheet(paper)) is None


def test_each_channel_of_brown_paper_is_as_light_as_its_lightest() -> None:
    found = levels_on_white(sheet(BROWN))
    assert found is not None
    levels = np.reshape(found, (3, 256))
    assert [channel[level] for channel, level in zip(levels, BROWN, strict=True)] == 3 * [207]
    assert (np.diff(levels) >= 0).all() and (levels[:, 255] == 255).all()


@pytest.mark.parametrize("paper", [BLUEPRINT, FADED])
def test_white_lines_on_a_blueprint_are_the_lines(
    paper: tuple[int, int, int], tmp_path: Path
) -> None:
    """The blue channel of a blueprint is light; the lines of a real one were lost, and it was refused."""
    picture = sheet(paper, label=False, ink=WHITE)
    assert levels_on_white(picture) is None
    picture.save(tmp_path / "blueprint.png", dpi=(DPI, DPI))
    drawing = Drawing.open(tmp_path / "blueprint.png")
    assert drawing.darkness[61, 300] > 0.9
    assert drawing.darkness[100, 300] < 0.1
