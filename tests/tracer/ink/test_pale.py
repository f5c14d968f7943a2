"""Pale lines: in the balance and told, on clean paper and on noisy."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
import pytest

from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.ink import pale
from morfax.tracer.ink.pale import pale_lines
from morfax.tracer.program.trace_ink import trace_ink
from tests.tracer.inked import WIDTH_MM, arc, inked, polyline

SQUARE = polyline((6, 6), (36, 6), (36, 36), (6, 36), (6, 6))
BAR = polyline((6, 20), (36, 20))
RIM_MM = 2.0  # of the bar lies within the rims of the square's ink


def with_pale_bar(darkness: float, noise: float = 0.04) -> Drawing:
    """A square with a bar that is paler; noise is a standard deviation."""
    square, bar = inked(SQUARE, arc((20, 10), 3)), inked(BAR, SQUARE)
    both = np.maximum(square.darkness, darkness * bar.darkness)
    rough = np.random.default_rng(1).normal(0, noise, both.shape)
    return replace(square, darkness=np.asarray(both + rough, np.float32))


@pytest.mark.parametrize("darkness", [0.25, 0.4])
def test_a_pale_line_is_found_with_its_place_and_length(darkness: float) -> None:
    (line,) = pale_lines(with_pale_bar(darkness))
    assert line.length_mm == pytest.approx(30 - 2 * 0.25, abs=RIM_MM)
    # the place is on the bar, within its width
    assert abs(line.y_mm - 20) < 0.5 and 6 < line.x_mm < 36


def test_a_pale_line_is_the_same_on_a_sheet_that_lay_across() -> None:
    drawing = with_pale_bar(0.25, 0.1)
    across = replace(drawing, darkness=np.ascontiguousarray(drawing.darkness.T[::-1, ::-1]))
    (line,), (other,) = pale_lines(drawing), pale_lines(across)
    # noise moves each end by up to a width of the line
    assert other.length_mm == pytest.approx(line.length_mm, abs=2 * WIDTH_MM)


def test_strips_of_a_sheet_show_the_same_pale_lines_as_all_of_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Rows that stand at a strip's edge are looked at with those of the next."""
    drawing = with_pale_bar(0.3)
    whole = pale_lines(drawing)
    monkeypatch.setattr(pale, "FEW_PX", 40 * drawing.darkness.shape[1])
    assert pale_lines(drawing) == whole and len(whole) == 1


@pytest.mark.parametrize("noise", [0.0, 0.04, 0.1])
def test_paper_and_the_rims_of_ink_are_no_pale_lines(noise: float) -> None:
    assert pale_lines(with_pale_bar(0.0, noise)) == []


def test_the_share_that_was_followed_counts_pale_lines() -> None:
    ink = trace_ink(with_pale_bar(0.3)).ink
    assert ink is not None
    drawn_mm = 120 + 2 * np.pi * 3
    assert ink.followed_share == pytest.approx(drawn_mm / (drawn_mm + 30), abs=0.02)


def test_a_smudge_on_grained_paper_is_no_pale_line_and_a_line_beside_it_is_one() -> None:
    """As on a photograph of a board: grain of some pixels in a smudge that is a little darker than paper."""
    bare = with_pale_bar(0.4, 0.02)
    rows, columns = bare.darkness.shape
    white = np.random.default_rng(3).normal(0, 1, (rows, columns))
    grain = cv2.GaussianBlur(white, (0, 0), 1.5)
    down, across = np.mgrid[:rows, :columns] * bare.pitch_mm
    is_smudged = (np.abs(across - 21) < 11) & (np.abs(bare.height_mm - down - 29) < 5)
    smudged = bare.darkness + 0.05 * grain / grain.std() + 0.14 * is_smudged
    found = pale_lines(replace(bare, darkness=np.asarray(smudged, np.float32)))
    on_bar_mm = sum(line.length_mm for line in found if abs(line.y_mm - 20) < 0.5)
    assert on_bar_mm == pytest.approx(30 - 2 * 0.25, abs=RIM_MM)
    # of 160 mm of web that the smudge thins to
    assert sum(line.length_mm for line in found) - on_bar_mm < 25


@pytest.mark.parametrize(("along_px", "across_px"), [(20, 2), (40, 8)])
def test_strands_that_a_slit_makes_of_the_papers_grain_are_no_pale_lines(
    along_px: float, across_px: float
) -> None:
    """As on a photograph of pencil on rough paper: 1970 mm of strands beside a line of 520 mm.

    Broad strands are noise too: against the paper about them alone 70 mm of them were pale lines.
    """
    bare = with_pale_bar(0.6, 0.02)
    white = np.random.default_rng(3).normal(0, 1, bare.darkness.shape)
    strands = cv2.GaussianBlur(white, (0, 0), sigmaX=along_px, sigmaY=across_px)
    seen = np.asarray(bare.darkness + 0.14 * strands / strands.std(), np.float32)
    rough = replace(bare, darkness=np.maximum(seen, 0))
    assert sum(line.length_mm for line in pale_lines(rough)) > 25
    found = pale_lines(replace(rough, grainy=True))
    assert sum(line.length_mm for line in found if abs(line.y_mm - 20) > 0.5) < 10


def test_a_line_of_one_hard_pixel_is_ink() -> None:
    """It was followed, and told as left out: a third of a plan of 1-bit pixels."""
    sheet = with_pale_bar(0.0, 0.0)
    rows = round(16 / sheet.pitch_mm)
    darkness = np.asarray(sheet.darkness, np.float32).copy()
    darkness[rows, round(10 / sheet.pitch_mm) : round(32 / sheet.pitch_mm)] = 1.0
    assert pale_lines(replace(sheet, darkness=darkness)) == []
    darkness[rows] *= 0.45
    assert len(pale_lines(replace(sheet, darkness=darkness))) == 1
