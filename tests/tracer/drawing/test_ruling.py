"""Drawings on squared and ruled paper: the printed lines are left out, the drawn one is followed.

A printed line of 0.2 mm hides 0.3 mm of each stroke that crosses it; 50 um RMS is a tenth of the drawn line.
"""

from __future__ import annotations

import math
from pathlib import Path

import cv2
import numpy as np
import pytest

from morfax.motion.contour import distance
from morfax.motion.faults import DrawingFault
from morfax.motion.units import MM_PER_INCH
from morfax.tracer.drawing import ruling
from morfax.tracer.drawing.drawing import Darkness, Drawing
from morfax.tracer.drawing.printed_lines import families
from morfax.tracer.drawing.reading import Reading
from morfax.tracer.drawing.ruling import PaperKind, left_out
from morfax.tracer.drawing.scale import Scale
from morfax.tracer.drawing.scan import Scan, Stated
from morfax.tracer.program.trace import trace
from tests.tracer.inked import DPI, UM, Points, arc, inked, polyline

PITCH_MM = MM_PER_INCH / DPI
TO_PX = 1 / PITCH_MM
PRINTED_MM, SIDE_MM = 0.2, 66.0
LINE = arc((32.0, 31.0), 20.0)
SLANTED = polyline((12, 14), (50, 9.3), (56, 44), (20, 52), (12, 14))


def on_paper(
    line: Points,
    apart_mm: tuple[float, ...],
    printed: float,
    tilt_deg: float = 0.0,
    margin_mm: float = -SIDE_MM,
    finer: float = 0.0,
) -> Darkness:
    """Levels 0..255 of a drawn line on paper with lines so far apart, as dark as a share of the drawn ink,
    with a margin on all sides, and with lines a fifth as far apart that are as dark as another share of it.
    """
    rows = round(SIDE_MM / PITCH_MM)
    down, right = (np.indices((rows, rows)) + 0.5) * PITCH_MM
    ink = np.zeros((rows, rows))
    drawn = inked(line, width_mm=0.45).darkness
    ink[rows - len(drawn) :, : drawn.shape[1]] = drawn[:, :rows]
    c, s = math.cos(math.radians(tilt_deg)), math.sin(math.radians(tilt_deg))
    turned = c * down - s * right, c * right + s * down
    on_grid = np.all([(at > margin_mm) & (at < SIDE_MM - margin_mm) for at in turned], axis=0)
    for times, dark in ((1, printed), (5, finer)):
        for k, mm in enumerate(apart_mm):
            at, apart = turned[k] + 1.3, mm / times
            off = np.abs(at - np.round(at / apart) * apart)
            grid = np.clip((0.5 * PRINTED_MM - off) / PITCH_MM + 0.5, 0, 1) * on_grid
            ink = np.maximum(ink, dark * grid)
    noise = np.random.default_rng(1).normal(0, 8, ink.shape)
    return np.asarray(235 - 130 * ink + noise, np.float32)


def opened(levels: Darkness, printed: PaperKind = "auto") -> Drawing:
    """The drawing of a picture of grey levels, as it is opened."""
    grey = np.clip(np.round(levels), 0, 255).astype(np.uint8)
    return Drawing.of(
        Scan(Path("made.png"), grey, Stated((DPI, DPI))),
        Scale(),
        reading=Reading(printed=printed),
    )


@pytest.mark.parametrize("line", [LINE, SLANTED], ids=["circle", "slanted"])
@pytest.mark.parametrize(
    ("apart_mm", "printed", "tilt_deg"),
    [((5.0, 5.0), 0.9, 0.7), ((5.0, 5.0), 0.5, -1.3), ((8.0,), 0.9, 0.4)],
    ids=["squared", "pale squares", "ruled"],
)
def test_the_drawn_line_is_followed_and_the_printed_ones_are_not(
    line: Points, apart_mm: tuple[float, ...], printed: float, tilt_deg: float
) -> None:
    drawing = opened(on_paper(line, apart_mm, printed, tilt_deg))
    run = trace(drawing).lines[0]
    apart = distance(run.xy_mm[::4], line)
    assert any("left out" in note for note in drawing.notes)
    assert run.ending == "closed"
    assert apart.path_to_reference.rms_mm < 50 * UM
    assert max(apart.path_to_reference.max_mm, apart.reference_to_path.max_mm) < 0.35


def test_the_period_and_the_tilt_are_measured() -> None:
    levels = on_paper(LINE, (5.0, 5.0), 0.9, 1.1)
    found = [one for (one,) in families(np.asarray((235 - levels) / 130, np.float32), PITCH_MM)]
    assert [f.period_px * PITCH_MM for f in found] == pytest.approx([5.0, 5.0], abs=0.01)
    tilts = [math.degrees(math.asin(f.across[i])) for f, i in zip(found, (1, 0), strict=True)]
    assert np.abs(tilts) == pytest.approx([1.1, 1.1], abs=0.05)


def left_of_printed(drawing: Drawing, line: Points) -> float:
    """The share of the sheet further than 0.6 mm from the drawn line that is dark."""
    far, near = drawing.darkness.copy(), round(0.6 / drawing.pitch_mm)
    for x, y in line:
        row, column = int(len(far) - y / drawing.pitch_mm), int(x / drawing.pitch_mm)
        far[row - near : row + near + 1, column - near : column + near + 1] = 0
    return float(np.mean(far > 0.5))


@pytest.mark.parametrize("tilt_deg", [0.0, -1.3])
def test_squares_with_a_margin_are_left_out_where_they_are_paler_than_the_drawing(
    tilt_deg: float,
) -> None:
    """A pad's squares end 5 mm before the edge of the paper; squares as dark as the drawing may be drawn."""
    pale = on_paper(LINE, (5.0, 5.0), 0.5, tilt_deg, margin_mm=5.0)
    drawing = opened(pale)
    assert left_of_printed(drawing, LINE) < 1e-4
    run = trace(drawing).lines[0]
    assert run.ending == "closed"
    assert distance(run.xy_mm[::4], LINE).path_to_reference.rms_mm < 50 * UM
    dark = on_paper(LINE, (5.0, 5.0), 1.0, tilt_deg, margin_mm=5.0)
    (note,) = opened(dark).notes
    assert "5.00 and 5.00 mm apart; if the paper is squared, give --paper squared" in note
    assert left_of_printed(opened(dark), LINE) > 0.02
    assert left_of_printed(opened(dark, "squared"), LINE) < 1e-4


def test_more_squares_than_anybody_draws_are_left_out() -> None:
    """28 lines each way, as dark as the drawing, with a margin; 12 may be drawn (see above)."""
    drawing = opened(on_paper(LINE, (2.0, 2.0), 1.0, 0.5, margin_mm=5.0))
    assert any("2.00 and 2.00 mm apart; they are left out" in note for note in drawing.notes)
    assert left_of_printed(drawing, LINE) < 2e-3


def test_what_is_drawn_beside_the_squares_stays() -> None:
    """Printed lines end where they end: a line in their margin keeps its ink where they would go on."""
    line = polyline((2.0, 2.5), (64.0, 2.5))
    drawing = opened(on_paper(line, (5.0, 5.0), 0.5, margin_mm=5.0))
    row = int(len(drawing.darkness) - 2.5 / drawing.pitch_mm)
    columns = (np.arange(3.0, 63.0, 0.1) / drawing.pitch_mm).astype(int)
    assert drawing.darkness[row, columns].min() > 0.7


def test_millimetre_paper_is_left_out_with_its_finer_lines() -> None:
    drawing = opened(on_paper(LINE, (5.0, 5.0), 0.45, 0.6, finer=0.3))
    assert any("1.00 and 1.00 mm apart; they are left out" in note for note in drawing.notes)
    assert left_of_printed(drawing, LINE) < 1e-4
    run = trace(drawing).lines[0]
    assert run.ending == "closed"
    assert distance(run.xy_mm[::4], LINE).path_to_reference.rms_mm < 50 * UM


def test_plain_paper_stays_as_it_is_and_a_drawn_grid_is_kept() -> None:
    """A grid with paper about it, as dark as the rest, is drawn and not printed."""
    lines = [polyline((4 + 5 * k, 4), (4 + 5 * k, 44)) for k in range(9)]
    lines += [line[:, ::-1] for line in lines]
    drawn = inked(*lines, arc((24, 24), 7.0), seed=1).darkness
    kept = left_out(drawn, PITCH_MM, "auto")
    assert kept.note is not None
    assert np.array_equal(kept.darkness, drawn)
    plain = opened(on_paper(LINE, (), 0.0))
    assert plain.notes == ()
    kept_squares = opened(on_paper(LINE, (5.0, 5.0), 0.9), "plain")
    assert np.mean(kept_squares.darkness > 0.5) > 0.05


@pytest.mark.parametrize("rows", [1, 3, 6])
def test_a_sheet_of_few_rows_has_no_printed_lines(rows: int) -> None:
    """Of a strip that is lower than what is looked at of other sheets."""
    darkness = np.zeros((rows, 600), np.float32)
    darkness[rows // 2, 50:550] = 1.0
    assert families(darkness, PITCH_MM) == []
    assert families(np.ascontiguousarray(darkness.T), PITCH_MM) == []


def test_of_ruled_paper_with_a_drawn_table_only_what_is_left_out_is_named() -> None:
    """Lines 8 mm apart go from edge to edge; seven upright ones, 9 mm apart, end before the paper does."""
    levels = on_paper(LINE, (8.0,), 0.9)
    low, high = round(5 * TO_PX), round(61 * TO_PX)
    for mm in np.arange(6.0, 61.0, 9.0):
        levels[low:high, round(mm * TO_PX) : round(mm * TO_PX) + 3] = 105
    (note,) = opened(levels).notes
    assert note.startswith("the paper is ruled, with lines 8.00 mm apart; they are left out")


def test_printed_lines_that_are_not_there_are_refused() -> None:
    with pytest.raises(DrawingFault, match="no printed lines are found"):
        opened(on_paper(LINE, (), 0.0), "squared")


def lined(bare_mm: float) -> Darkness:
    """Six lines of 0.25 mm, as few as there may be, 10 mm apart on 62 mm of paper, bare at the upper end."""
    paper = np.zeros((round(62 * TO_PX),) * 2, np.float32)
    for k in range(6):
        middle = round((6 + 10 * k) * TO_PX)
        paper[round(bare_mm * TO_PX) :, middle : middle + 3] = 1.0
    return paper


@pytest.mark.parametrize("is_upright", [True, False])
@pytest.mark.parametrize("bare_mm", [0.0, 4.0, 40.0])
def test_as_few_lines_as_there_may_be_are_found(bare_mm: float, is_upright: bool) -> None:
    """The middle of a line of three pixels is half a pixel before its second edge: within a hundredth. Where
    they end is told to a pixel; lines over less than half of the sheet are none.
    """
    paper = lined(bare_mm)
    found = families(paper if is_upright else np.ascontiguousarray(paper.T), PITCH_MM)
    if bare_mm > 31:
        assert found == []
        return
    ((family,),) = found
    assert family.lines == 6
    assert family.period_px / TO_PX == pytest.approx(10, abs=0.01)
    assert family.is_whole is (bare_mm == 0)
    ends = sorted(abs(at) / TO_PX for at in family.run_px)
    assert ends == pytest.approx([bare_mm, 62.0] if bare_mm else [math.inf] * 2, abs=0.13)


@pytest.mark.parametrize("is_printed", [True, False])
def test_a_large_sheet_is_made_smaller_only_where_printed_lines_may_be(
    is_printed: bool,
) -> None:
    """No row of a sheet without lines in the rows and columns looked at."""
    sheet = np.random.default_rng(6).normal(0.0, 0.02, (3001, 2998)).astype(np.float32)
    if is_printed:
        sheet[:, 20::60] = sheet[:, 21::60] = sheet[:, 22::60] = 0.6
    small, by = ruling._small_enough(sheet)
    assert by == 2
    whole = cv2.resize(sheet, (1499, 1500), interpolation=cv2.INTER_AREA)
    assert np.array_equal(small, whole) if is_printed else small.size == 0
    assert bool(left_out(sheet, PITCH_MM, "auto").note) == is_printed
