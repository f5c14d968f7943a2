"""One ink of several: a blue line on a printed grid is followed as it is without the grid."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from morfax.motion.contour import distance
from morfax.motion.faults import DrawingFault
from morfax.motion.motion import thin
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.inks import parsed
from morfax.tracer.program.trace import trace
from tests.tracer.inked import UM, Points, arc, inked, polyline

BLUE, ORANGE, GREY, PAPER = (
    (0x20, 0x30, 0xC0),
    (0xF0, 0xA0, 0x50),
    (0xB0, 0xB0, 0xB0),
    (0xF6, 0xF4, 0xEC),
)
CIRCLE = arc((16, 16), 10)
NOISE = 6.0  # levels in each channel, 4 % of the line's contrast


def drawn(
    file: Path,
    grid: tuple[int, int, int] | None,
    line: tuple[int, int, int] = BLUE,
    seed: int = 1,
) -> Path:
    """A coloured circle on a sheet of 30 x 30 mm, on squared paper of 5 mm printed in another colour; a scan
    with noise.
    """
    squares = [polyline((k, 0), (k, 30)) for k in range(3, 30, 5)] + [
        polyline((0, k), (30, k)) for k in range(3, 30, 5)
    ]
    share = inked(CIRCLE, *squares).darkness.shape
    picture = np.ones((*share, 3)) * PAPER
    for colour, ink in (
        (grid, _alike(inked(*squares, width_mm=0.25), share)),
        (line, _alike(inked(CIRCLE), share)),
    ):
        if colour is not None:
            picture += ink[..., None] * (np.array(colour) - picture)
    picture += np.random.default_rng(seed).normal(0, NOISE, picture.shape)
    Image.fromarray(np.clip(np.round(picture), 0, 255).astype(np.uint8)).save(
        file, dpi=(300, 300), quality=90
    )
    return file


def _alike(drawing: Drawing, shape: tuple[int, ...]) -> NDArray[np.float32]:
    """The darkness on a sheet of another size, the lower-left corner the same."""
    own = drawing.darkness[-shape[0] :, : shape[1]]
    return np.asarray(
        cv2.copyMakeBorder(
            own,
            shape[0] - own.shape[0],
            0,
            0,
            shape[1] - own.shape[1],
            cv2.BORDER_CONSTANT,
            value=0.0,
        )
    )


def rms_mm(file: Path, ink: str | None) -> float:
    """How far the path is from the true circle, mm RMS."""
    return distance(
        thin(trace(Drawing.open(file, ink=ink), (26, 16))), CIRCLE
    ).path_to_reference.rms_mm


@pytest.mark.parametrize("darkest", [0.85, 0.5])
def test_an_ink_is_told_on_a_photograph_lit_from_one_side_with_a_shadow_across(
    tmp_path: Path, darkest: float
) -> None:
    file = drawn(tmp_path / "scan.png", ORANGE)
    picture = np.asarray(Image.open(file), float)
    y, x = np.mgrid[0 : picture.shape[0], 0 : picture.shape[1]]
    light = 1 - (1 - darkest) * x / x.max() - 0.1 / (1 + np.exp(-(y - 0.6 * x - 100) / 15))
    lit = picture * light[..., None] * [1, 0.97, 0.9]
    photo = tmp_path / "photo.jpg"
    Image.fromarray(np.clip(np.round(lit), 0, 255).astype(np.uint8)).save(
        photo, dpi=(300, 300), quality=90
    )
    assert rms_mm(photo, "blue") < 4 * UM  # 2.5 and 2.7; the same as a scan 1.0


RED, BLACK = (0xD0, 0x20, 0x30), (30, 30, 30)
CHORDS = [polyline((2, 10), (28, 19)), polyline((5, 28), (22, 3))]


def among(file: Path, second: tuple[int, int, int], lines: list[Points], *, over: bool) -> Path:
    """The blue circle on an orange grid, and lines of a second other ink printed over it, or under it."""
    grid = [polyline((k, 0), (k, 30)) for k in range(3, 30, 5)] + [
        polyline((0, k), (30, k)) for k in range(3, 30, 5)
    ]
    share = inked(CIRCLE, *grid).darkness.shape
    own, other = (BLUE, [CIRCLE], 0.5), (second, lines, 0.35)
    picture = np.ones((*share, 3)) * PAPER
    for colour, strokes, width_mm in (
        (ORANGE, grid, 0.25),
        *((own, other) if over else (other, own)),
    ):
        ink = _alike(inked(*strokes, width_mm=width_mm), share)
        picture += ink[..., None] * (np.array(colour) - picture)
    picture += np.random.default_rng(1).normal(0, NOISE, picture.shape)
    Image.fromarray(np.clip(np.round(picture), 0, 255).astype(np.uint8)).save(
        file, dpi=(300, 300), quality=90
    )
    return file


@pytest.mark.parametrize("suffix", [".png", ".jpg"])
@pytest.mark.parametrize(
    ("second", "lines", "over"),
    [(RED, [arc((20, 20), 8)], False), (BLACK, CHORDS, True), (BLACK, CHORDS, False)],
)
def test_two_other_inks_are_passed_over(
    tmp_path: Path, second: tuple[int, int, int], lines: list[Points], over: bool, suffix: str
) -> None:
    run = trace(
        Drawing.open(
            among(tmp_path / f"sheet{suffix}", second, lines, over=over), ink="#0000c0"
        ),
        (26, 16),
    )
    found = distance(thin(run), CIRCLE)
    assert run.ending == "closed"
    # measured 4.0 and, as JPEG, which keeps colours more coarsely than lightness, 10.4 um RMS and 51 um at
    # most: half as much again
    assert found.path_to_reference.rms_mm < (15 if suffix == ".jpg" else 6) * UM, found
    assert found.hausdorff_mm < (80 if suffix == ".jpg" else 30) * UM, found


@pytest.mark.parametrize("grid", [ORANGE, GREY], ids=["orange", "grey"])
@pytest.mark.parametrize("suffix", [".png", ".jpg"])
def test_a_blue_line_on_a_grid_is_followed_as_without_the_grid(
    tmp_path: Path, grid: tuple[int, int, int], suffix: str
) -> None:
    plain = rms_mm(drawn(tmp_path / f"plain{suffix}", None), "blue")
    on_grid = rms_mm(drawn(tmp_path / f"grid{suffix}", grid), "#0000c0")
    assert plain < 4 * UM and on_grid < 6 * UM, (plain, on_grid)


def test_edges_stay_linear(tmp_path: Path) -> None:
    darkness = Drawing.open(drawn(tmp_path / "grid.png", None), ink="blue").darkness
    true = inked(CIRCLE).darkness
    part = _alike(Drawing(true, 1.0), darkness.shape)
    edge = (part > 0.2) & (part < 0.8)
    assert np.polyfit(part[edge], darkness[edge], 1) == pytest.approx(
        [1, 0], abs=0.05
    )  # a share of the contrast


def test_a_colour_that_is_nowhere_is_refused_with_those_that_are(tmp_path: Path) -> None:
    with pytest.raises(
        DrawingFault,
        match=r"no ink of the colour #00ff00 on paper of #f\w+; the colours found are #\w{6}, #\w{6}; give",
    ):
        Drawing.open(drawn(tmp_path / "grid.png", ORANGE), ink="lime")


@pytest.mark.parametrize("asked", ["green", "navy", "#0000c0"])
@pytest.mark.parametrize("ink", [(0, 0, 0), (0x50, 0x50, 0x54), (0x90, 0x8C, 0x8C)])
def test_black_and_pencil_are_no_ink_of_a_dark_colour(
    tmp_path: Path, asked: str, ink: tuple[int, int, int]
) -> None:
    """Dark green is 16 degrees from black in the direction from the paper."""
    with pytest.raises(DrawingFault, match="there is no ink of the colour"):
        Drawing.open(drawn(tmp_path / "grid.png", ORANGE, ink), ink=asked)
    assert rms_mm(drawn(tmp_path / "dark.png", ORANGE, (0x10, 0x40, 0x18)), "green") < 0.005


@pytest.mark.parametrize("text", ["blue", "#00f", "#0000ff", " BLUE "])
def test_a_colour_is_a_name_or_a_number(text: str) -> None:
    assert parsed(text) == (0, 0, 255)


def test_what_is_no_colour_is_said(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="'blau' is no colour; give a name such as blue"):
        parsed("blau")
