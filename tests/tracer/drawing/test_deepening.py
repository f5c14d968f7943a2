"""Pale lines where all the ink is asked for: followed at their middles on quiet paper, left on grained."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray

from morfax.motion.polyline import nearest_mm
from morfax.tracer.drawing.deepening import ABOVE_NOISE, LEAST, _lines
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.reading import Reading
from morfax.tracer.drawing.scale import Scale
from morfax.tracer.drawing.scan import Scan, Stated
from morfax.tracer.drawing.shapes_among_lines import drawing_of_all_ink
from morfax.tracer.drawing.spots import noise_of_spots, times_as_noisy
from morfax.tracer.program.trace_ink import trace_ink
from tests.tracer.inked import DPI, WIDTH_MM, arc, inked, polyline, together

SQUARE = polyline((6, 6), (46, 6), (46, 36), (6, 36), (6, 6))
WAVE = np.column_stack(
    [np.linspace(6, 46, 800), 21 + 5 * np.sin(np.linspace(0, 4 * np.pi, 800))]
)
RING = arc((16, 12), 3.5)
LETTER = polyline((26, 20), (26, 21.5), (27, 20), (27, 21.5))  # a printed N, 1.7 mm high
NOISE = 0.02  # of a quiet scan
UM = 1e-3


def read(
    pale: float, *, grain: float = 0.0, all_ink: bool = True, letter: bool = False
) -> Drawing:
    """A scan of a square with a ring in it, and a paler wave from side to side, or a letter in its place."""
    dark, wave = inked(SQUARE, RING).darkness, inked(WAVE, SQUARE).darkness
    if letter:
        wave = together((LETTER, 0.2), (SQUARE, WIDTH_MM)).darkness
    alone = np.maximum(wave - inked(SQUARE).darkness, 0)
    rng = np.random.default_rng(1)
    coarse = cv2.GaussianBlur(rng.normal(0, 1, dark.shape), (0, 0), 1.5)
    noise = rng.normal(0, NOISE, dark.shape) + grain * coarse / coarse.std()
    grey = 240 - 200 * (np.maximum(dark, pale * alone) + noise)
    pixels = np.asarray(np.clip(np.round(grey), 0, 255), np.uint8)
    scan = Scan(Path("made.png"), pixels, Stated((DPI, DPI)))
    return (
        drawing_of_all_ink(scan, Scale(), None, "auto")
        if all_ink
        else Drawing.of(scan, Scale())
    )


def _middle(drawing: Drawing) -> tuple[slice, slice]:
    """The part of a sheet where only the wave is."""
    rows, columns = (np.array(drawing.darkness.shape) / 40).astype(int)
    return slice(15 * rows, 30 * rows), slice(22 * columns, 34 * columns)


def off_mm(drawing: Drawing, line: NDArray[np.float64]) -> NDArray[np.float64]:
    """How far places of a line are from the nearest path."""
    ways = [each.xy_mm for each in trace_ink(drawing).lines]
    return np.min([nearest_mm(line, way) for way in ways], axis=0)


@pytest.mark.parametrize("pale", [0.2, 0.3, 0.45])
def test_a_pale_line_on_quiet_paper_is_followed_at_its_middle_and_told(pale: float) -> None:
    drawing = read(pale)
    off = off_mm(drawing, WAVE)
    # the noise of a line of a fifth of ink's darkness is five times as high
    assert np.sqrt(np.mean(off[30:-30] ** 2)) < 8 * UM
    assert off.max() < 0.25  # it begins at the middle of the square's line
    ink = trace_ink(drawing).ink
    assert ink is not None and ink.followed_share > 0.995
    assert any("less than half as dark" in note for note in drawing.notes)


def test_dark_lines_stay_where_they_are_beside_a_pale_one() -> None:
    off = off_mm(read(0.3), RING)
    assert np.sqrt(np.mean(off**2)) < 4 * UM


def test_what_is_paler_than_what_shines_through_stays_as_it_is() -> None:
    drawing = read(0.1)
    assert off_mm(drawing, WAVE).max() > 1 and not drawing.notes


@pytest.mark.parametrize(("pale", "is_followed"), [(0.45, True), (0.2, False)])
def test_a_short_pale_line_counts_where_it_stands_out_twice_as_far(
    pale: float, is_followed: bool
) -> None:
    """Grey letters of a map are lower than 2 mm; as pale as what shines through they are specks."""
    off = off_mm(read(pale, letter=True), LETTER)
    assert (np.percentile(off, 90) < 0.1) == is_followed


def test_on_grained_paper_nothing_is_made_darker() -> None:
    """As on a photograph: grain would be lines."""
    drawing = read(0.3, grain=0.07)
    assert not any("less than half as dark" in note for note in drawing.notes)


def test_pale_lines_are_no_noise_though_they_take_up_a_sixth_of_the_paper() -> None:
    """A page of notes: nearly all paper that is near ink has writing and rules on it."""
    paper = np.random.default_rng(1).normal(0, 0.06, (400, 400)).astype(np.float32)
    lined = paper.copy()
    for first in range(3):
        lined[first::20] += 0.4
    # a whole standard deviation higher, where lines are, it is 2.8 times as high
    assert noise_of_spots(lined) < 2.2 * noise_of_spots(paper)


def test_noise_of_a_photographs_dark_corner_is_no_pale_line() -> None:
    """A camera makes its corners brighter, and their noise with them: it ran 80 strokes there."""
    pixels = np.full((1200, 1200), 170.0)
    cv2.rectangle(pixels, (500, 500), (900, 900), 60.0, 9)
    cv2.line(pixels, (520, 700), (880, 700), 130.0, 7)  # a pale one
    rng = np.random.default_rng(2)
    noise = cv2.GaussianBlur(rng.normal(0, 1, pixels.shape), (0, 0), 1.6)
    down, across = np.mgrid[:1200, :1200] / 1200
    noise *= (1 + 3 * np.exp(-8 * (down**2 + across**2))) * 2.5 / noise.std()
    scan = Scan(
        Path("made.png"), np.asarray(np.round(pixels + noise), np.uint8), Stated((DPI, DPI))
    )
    drawing = drawing_of_all_ink(scan, Scale(), None, "auto")
    assert any("31 mm of line are less than half as dark" in note for note in drawing.notes)
    trace = trace_ink(drawing)
    assert len(trace.lines) == 2
    assert trace.ink is not None and not trace.ink.pale and trace.ink.followed_share > 0.99


def test_a_part_in_pale_lines_is_not_taken_for_noisy_paper() -> None:
    paper = np.random.default_rng(1).normal(0, 0.02, (960, 960)).astype(np.float32)
    hatched = paper.copy()
    for first in range(3):
        hatched[480 + first :: 12, :480] += 0.25  # a quarter of it, a half with rims
    assert times_as_noisy(hatched).max() < 1.6
    paper[:480, :480] *= 3
    assert times_as_noisy(paper)[:4, :4].min() > 2.4


@pytest.mark.parametrize("pale", [0.3, 0.45])
def test_on_a_board_a_line_that_stands_out_from_its_grain_is_followed(pale: float) -> None:
    """A pen that grows paler towards a corner. (Nothing was made darker on such a sheet.)"""
    noise = noise_of_spots(np.asarray(read(pale, grain=0.025, all_ink=False).darkness))
    assert LEAST < ABOVE_NOISE * noise < 0.25
    off = off_mm(read(pale, grain=0.025), WAVE)
    assert np.sqrt(np.mean(off[30:-30] ** 2)) < 15 * UM and off.max() < 0.25


def test_a_line_that_noise_makes_ink_here_and_there_is_one_line() -> None:
    """Patches of ink in it were told from it with their rims, and broke it into pieces."""
    off = off_mm(read(0.45, grain=0.018), WAVE)
    assert np.sqrt(np.mean(off[30:-30] ** 2)) < 10 * UM and off.max() < 0.25


def test_where_all_the_ink_is_not_asked_for_pale_lines_stay_pale() -> None:
    drawing = read(0.3, all_ink=False)
    assert not any("less than half as dark" in note for note in drawing.notes)
    assert np.percentile(np.asarray(drawing.darkness)[_middle(drawing)], 99) < 0.5


def test_the_shade_of_a_filled_shape_is_no_pale_line() -> None:
    """Its rim on the picture is the only line that there is."""
    grey = np.full((500, 700), 240, np.uint8)
    cv2.circle(grey, (350, 250), 150, 40, -1, cv2.LINE_AA)
    scan = Scan(Path("made.png"), grey, Stated((100.0, 100.0)))
    drawing = Drawing.of(scan, Scale(), None, Reading(pale_is_ink=True))
    plain = Drawing.of(scan, Scale())
    assert plain.shapes is not None and plain.shapes.any()
    assert np.array_equal(np.asarray(drawing.darkness), np.asarray(plain.darkness))


@pytest.mark.parametrize(("dark", "is_line"), [(0.0, False), (0.3, True)])
def test_paper_between_inks_is_no_pale_line(dark: float, is_line: bool) -> None:
    """Behind the spot a row of it between a beam and a staff is as dark as one; its darkness, 0, was divided
    by.
    """
    strip = np.zeros((60, 60), np.uint8)
    strip[30, 10:45] = 1
    levels = np.full((1, 1), LEAST, np.float32)
    found = _lines(strip, np.full(strip.shape, dark, np.float32), 2.0, levels, 0.17)
    assert (found is not None) == is_line
