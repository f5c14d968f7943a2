"""Coarse scans: details between large pixels are kept, and the advice for too few pixels works."""

from __future__ import annotations

import re
from pathlib import Path

import cv2
import numpy as np
import pytest

from morfax.jobs.remarks.scale_doubts import scale_doubts
from morfax.motion.contour import distance
from morfax.motion.units import MM_PER_INCH
from morfax.tracer.drawing import coarse
from morfax.tracer.drawing.blocks import darkest
from morfax.tracer.drawing.coarse import BETWEEN, finer, is_hard
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.scale import Scale
from morfax.tracer.drawing.scan import Scan, Stated
from morfax.tracer.limits import PAPER
from morfax.tracer.program.trace import trace
from morfax.tracer.program.trace_lines import trace_lines
from tests.tracer.inked import UM, Points, arc, inked, polyline

WIDTH_MM = 0.5
PIXEL_MM = 0.25
STEP = polyline(  # a contour with a slot of 3 mm, which a leg of twelve pixels of 0.25 mm would cut off
    (6, 6), (40, 6), (40, 26), (25, 26), (25, 23), (22, 23), (22, 26), (6, 26), (6, 6)
)


def scanned(line: Points, dpi: float, seed: int = 1) -> Drawing:
    """The drawing of a line in ink of 0.5 mm, as it is opened from a scan at a resolution."""
    ink = inked(line, width_mm=WIDTH_MM, dpi=dpi, seed=seed).darkness
    grey = np.clip(np.round(235 - 195 * ink), 0, 255).astype(np.uint8)
    return Drawing.of(Scan(Path("made.png"), grey, Stated((dpi, dpi))), Scale())


@pytest.mark.parametrize(("dpi", "rms_um"), [(125, 8), (100, 10), (76, 15)])
def test_lines_of_two_and_a_half_to_one_and_a_half_pixels(dpi: float, rms_um: float) -> None:
    """A fifteenth of a pixel RMS."""
    line = arc((22.0, 22.0), 16.0)
    run = trace(scanned(line, dpi)).lines[0]
    assert run.ending == "closed"
    assert distance(run.xy_mm[::4], line).path_to_reference.rms_mm < rms_um * UM


def test_a_slot_of_a_few_pixels_is_not_cut_off() -> None:
    drawing = scanned(STEP, 100)
    run = trace(drawing).lines[0]
    assert drawing.finer == 2
    assert run.ending == "closed"
    assert distance(run.xy_mm[::4], STEP).reference_to_path.max_mm < 0.15


def pixel_lines(*corners: Points) -> Drawing:
    """The drawing of closed lines through corners, each a pixel wide, as a paint program draws it."""
    high = np.ceil(np.vstack(corners).max(axis=0) / PIXEL_MM + 20).astype(int)
    grey = np.full((high[1], high[0]), 255, np.uint8)
    for line in corners:
        at = np.column_stack(
            [line[:, 0] / PIXEL_MM - 0.5, high[1] - line[:, 1] / PIXEL_MM - 0.5]
        )
        cv2.polylines(grey, [np.round(at).astype(np.int32)], True, 0, 1, cv2.LINE_8)
    dpi = 25.4 / PIXEL_MM
    return Drawing.of(Scan(Path("made.png"), grey, Stated((dpi, dpi))), Scale())


@pytest.mark.parametrize("beside", [False, True])
def test_sloping_lines_of_a_hard_pixel_do_not_fall_to_pieces(beside: bool) -> None:
    """Their pixels touch by corners only; an upright line beside them is the one that is longest then."""
    tilted = polyline((8, 25), (75, 10), (92, 82), (22, 90)) + 0.5 * PIXEL_MM  # on pixels
    upright = polyline((4, 4), (4, 96))
    drawing = pixel_lines(tilted, *([upright] if beside else []))
    assert drawing.seen_px < 1.5
    run = trace(drawing).lines[0]
    assert run.ending == "closed"
    around = np.vstack([tilted, tilted[:1]])
    off = distance(run.xy_mm[::4], around)
    assert off.path_to_reference.rms_mm < 0.25 * PIXEL_MM
    assert off.reference_to_path.max_mm < PIXEL_MM


@pytest.mark.parametrize("corner", [(95, 82), (93, 83), (90, 80)])
def test_hard_lines_of_any_slope_are_found(corner: tuple[float, float]) -> None:
    """Rows that meet a sloping line look hard and columns do not: of the first just under half of all did."""
    tilted = polyline((8, 25), (75, 10), corner, (22, 90)) + 0.5 * PIXEL_MM
    drawing = pixel_lines(tilted)
    assert drawing.seen_px < 1.5
    run = trace(drawing).lines[0]
    assert run.ending == "closed"
    off = distance(run.xy_mm[::4], np.vstack([tilted, tilted[:1]]))
    assert off.path_to_reference.rms_mm < 0.25 * PIXEL_MM


def test_a_sheet_of_paper_alone_is_not_hard() -> None:
    """As one on which all that is dark are filled shapes; warnings are errors here."""
    assert not is_hard(np.zeros((20, 20), np.float32))


@pytest.mark.parametrize("pale", [30, 34])
def test_a_sheet_is_hard_by_all_pixels_that_are_not_paper(pale: int) -> None:
    """Only blocks that have some are looked through; 3 % of 1 100 are 33, some at the sheet's edge."""
    sheet = np.random.default_rng(3).normal(0.0, 0.02, (61, 83)).astype(np.float32)
    places = np.random.default_rng(4).permutation(sheet.size)[:1100]
    sheet.flat[places] = 0.98
    sheet.flat[places[:pale]] = 0.5
    not_paper = sheet[sheet > PAPER]
    assert is_hard(sheet) == (np.mean(not_paper < 1 - PAPER) < BETWEEN) == (pale == 30)
    assert coarse._counts.py_func(sheet, darkest(sheet) > PAPER) == (1100, pale)


def test_only_hard_lines_are_made_as_dark_as_before() -> None:
    hard = np.zeros((40, 40), np.float32)
    hard[np.arange(5, 35), np.arange(5, 35)] = 1.0
    soft = cv2.GaussianBlur(hard, (0, 0), 0.7)
    # the palest place along the line: half of the ink's darkness parts it
    along = finer(hard, 2, 1.0)[20:60, 20:60].max(axis=0)
    assert along.min() > 0.6
    assert np.array_equal(finer(soft, 2, 1.0), finer(soft, 2))


def test_a_fine_scan_stays_as_it_is() -> None:
    drawing = scanned(arc((22.0, 22.0), 16.0), 300)
    assert drawing.finer == 1
    assert drawing.pitch_mm == pytest.approx(25.4 / 300)


@pytest.mark.parametrize("dpi", [76, 60, 51])
def test_lines_of_one_and_a_half_pixels_and_less_are_told_of_and_the_advice_ends_it(
    dpi: float,
) -> None:
    """Below 1.25 pixels details are cut off now and then, and no measure parts these from 1.5."""
    (note,) = scanned(STEP, dpi).notes
    found = re.search(r"details below ([\d.]+) mm .* scan at (\d+) dpi", note)
    assert found is not None
    assert float(found[1]) == pytest.approx(6 * 25.4 / dpi, rel=0.05)
    assert not scanned(STEP, float(found[2])).notes


@pytest.mark.parametrize("dpi", [300, 150, 108])
def test_lines_of_two_pixels_and_more_are_not_told_of(dpi: float) -> None:
    for seed in (1, 2, 3):
        assert not scanned(arc((22.0, 22.0), 16.0), dpi, seed).notes
        assert not scanned(STEP, dpi, seed).notes


@pytest.mark.parametrize("dpi", [100, 76, 60])
def test_the_resolution_that_is_advised_is_enough(dpi: float) -> None:
    line = arc((22.0, 22.0), 16.0)

    def advised(at_dpi: float) -> list[float]:
        drawing = scanned(line, at_dpi)
        said = (*drawing.notes, *scale_doubts(drawing, trace(drawing).lines[0].width_mm))
        return [float(dpi) for text in said for dpi in re.findall(r"scan at (\d+) dpi", text)]

    (enough,) = advised(dpi)  # one advice, and not two
    assert not advised(enough)


@pytest.mark.parametrize("wide_px", [2.86, 2.899])
def test_lines_of_too_few_pixels_never_read_as_wide_enough(wide_px: float) -> None:
    drawing = scanned(STEP, 150)
    (told,) = [t for t in scale_doubts(drawing, wide_px * drawing.pitch_mm) if "pixels" in t]
    assert "the lines are 2.8 pixels wide, and the head wants 2.9:" in told


@pytest.mark.parametrize(
    ("dpi", "width_mm", "apart"),
    [(120.0, 0.3, 2.5), (120.0, 0.3, 3.0), (100.0, 0.5, 2.0), (120.0, 0.5, 2.0)],
)
def test_two_coarse_lines_close_beside_each_other_are_two(
    dpi: float, width_mm: float, apart: float
) -> None:
    """Two lines in one profile looked like one broad line, which is not coarse: their ink ran together."""
    radii_mm = 20.0, 20.0 - apart * width_mm
    rings = [arc((24.0, 24.0), radius_mm) for radius_mm in radii_mm]
    ink = inked(*rings, width_mm=width_mm, dpi=dpi, seed=1).darkness
    grey = np.clip(np.round(235 - 195 * ink), 0, 255).astype(np.uint8)
    drawing = Drawing.of(Scan(Path("made.png"), grey, Stated((dpi, dpi))), Scale())
    assert drawing.finer == 2
    lines = trace_lines(drawing).lines
    assert [line.ending for line in lines] == ["closed", "closed"]
    for line, radius_mm in zip(lines, sorted(radii_mm), strict=True):
        off_mm = np.hypot(*(line.xy_mm - 24.0).T) - radius_mm
        assert np.abs(off_mm).max() < 0.2 * MM_PER_INCH / dpi  # a fifth of a pixel
