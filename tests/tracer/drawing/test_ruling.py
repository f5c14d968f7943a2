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
from morfax.tracer.drawing.drawing import Darkness, Drawing, Reading
from morfax.tracer.drawing.ruling import PaperKind, families
from morfax.tracer.drawing.scale import Scale
from morfax.tracer.drawing.scan import Scan, Stated
from morfax.tracer.program.trace import trace
from tests.tracer.inked import DPI, UM, Points, arc, inked, polyline

PITCH_MM = MM_PER_INCH / DPI
PRINTED_MM, SIDE_MM = 0.2, 66.0
LINE = arc((32.0, 31.0), 20.0)
SLANTED = polyline((12, 14), (50, 9.3), (56, 44), (20, 52), (12, 14))


def on_paper(
    line: Points, apart_mm: tuple[float, ...], printed: float, tilt_deg: float = 0.0
) -> Darkness:
    """Levels 0..255 of a drawn line on paper with lines so far apart, as dark as a share of the drawn ink."""
    rows = round(SIDE_MM / PITCH_MM)
    down, right = (np.indices((rows, rows)) + 0.5) * PITCH_MM
    ink = np.zeros((rows, rows))
    drawn = inked(line, width_mm=0.45).darkness
    ink[rows - len(drawn) :, : drawn.shape[1]] = drawn[:, :rows]
    c, s = math.cos(math.radians(tilt_deg)), math.sin(math.radians(tilt_deg))
    grid = np.zeros_like(ink)
    for k, mm in enumerate(apart_mm):
        at = (c * down - s * right, c * right + s * down)[k] + 1.3
        off = np.abs(at - np.round(at / mm) * mm)
        grid = np.maximum(grid, np.clip((0.5 * PRINTED_MM - off) / PITCH_MM + 0.5, 0, 1))
    ink = np.maximum(ink, printed * grid)
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
    found = families(np.asarray((235 - levels) / 130, np.float32), PITCH_MM)
    assert [f.period_px * PITCH_MM for f in found] == pytest.approx([5.0, 5.0], abs=0.01)
    tilts = [math.degrees(math.asin(f.across[i])) for f, i in zip(found, (1, 0), strict=True)]
    assert np.abs(tilts) == pytest.approx([1.1, 1.1], abs=0.05)


def test_plain_paper_stays_as_it_is_and_a_drawn_grid_is_kept() -> None:
    """A grid with paper about it is drawn, not printed."""
    lines = [polyline((4 + 5 * k, 4), (4 + 5 * k, 44)) for k in range(9)]
    lines += [line[:, ::-1] for line in lines]
    drawn = inked(*lines, seed=1)
    assert families(drawn.darkness, PITCH_MM) == []
    plain = opened(on_paper(LINE, (), 0.0))
    assert plain.notes == ()
    kept = opened(on_paper(LINE, (5.0, 5.0), 0.9), "plain")
    assert np.mean(kept.darkness > 0.5) > 0.05


def test_printed_lines_that_are_not_there_are_refused() -> None:
    with pytest.raises(DrawingFault, match="no printed lines are found"):
        opened(on_paper(LINE, (), 0.0), "squared")


@pytest.mark.parametrize("seed", range(12))
def test_the_darkest_pixels_never_rule_out_ink_all_over(seed: int) -> None:
    """Spots of ink at random, as many as are nearly, or just, all over the sheet when it is reduced."""
    rng = np.random.default_rng(seed)
    rows, columns = (int(side) for side in rng.integers(1500, 2600, 2))
    darkness = np.zeros((rows, columns), np.float32)
    by = int(rng.integers(2, 5))
    for _ in range(int(rng.integers(150, 500))):
        row, column = int(rng.integers(rows)), int(rng.integers(columns))
        darkness[row : row + 40, column : column + 40] = rng.uniform(0.1, 0.4)
    size = columns // by, rows // by
    small = np.asarray(cv2.resize(darkness, size, interpolation=cv2.INTER_AREA), np.float32)
    all_over = ruling._is_all_over(small)
    assert ruling._may_be_all_over(darkness, by) or not all_over


def test_a_line_on_plain_paper_is_not_reduced(monkeypatch: pytest.MonkeyPatch) -> None:
    darkness = np.zeros((3200, 3200), np.float32)
    cv2.circle(darkness, (1200, 1200), 400, 1.0, 12)
    monkeypatch.setattr(ruling.cv2, "resize", None)  # whoever reduced it would fail
    assert ruling.families(darkness, 0.04) == []


@pytest.mark.parametrize("bare_mm", [0.0, 1.0, 4.0])
@pytest.mark.parametrize("is_upright", [True, False])
def test_lines_that_do_not_come_to_both_ends_of_the_sheet_are_not_looked_for(
    monkeypatch: pytest.MonkeyPatch, bare_mm: float, is_upright: bool
) -> None:
    """Six lines of 0.25 mm, as few as there may be, 10 mm apart on 62 mm of paper; its ends are 3 % of 62 mm.

    With paper of 1 mm at one end there is still ink for more than half of these lines there.
    """
    asked = list[bool]()
    monkeypatch.setattr(ruling, "_is_all_over", lambda _: True)
    monkeypatch.setattr(ruling, "_family", lambda _, __, way: asked.append(way))
    to_px = DPI / MM_PER_INCH
    paper = np.zeros((round(62 * to_px),) * 2, np.float32)
    for k in range(6):
        middle = round((6 + 10 * k) * to_px)
        paper[round(bare_mm * to_px) :, middle : middle + 3] = 1.0
    families(paper if is_upright else np.ascontiguousarray(paper.T), 1 / to_px)
    assert (is_upright in asked) is (bare_mm < 2.0)
