"""Drawings on squared and ruled paper: the printed lines are left out, the drawn one is followed.

A printed line of 0.2 mm hides 0.3 mm of each stroke that crosses it; 50 um RMS is a tenth of the drawn line.
"""

from __future__ import annotations

import math
from pathlib import Path

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
TO_PX = 1 / PITCH_MM
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


def lined(bare_mm: float) -> Darkness:
    """Six lines of 0.25 mm, as few as there may be, 10 mm apart on 62 mm of paper, bare at the upper end."""
    paper = np.zeros((round(62 * TO_PX),) * 2, np.float32)
    for k in range(6):
        middle = round((6 + 10 * k) * TO_PX)
        paper[round(bare_mm * TO_PX) :, middle : middle + 3] = 1.0
    return paper


def test_as_few_lines_as_there_may_be_are_found() -> None:
    """The middle of a line of three pixels is half a pixel before its second edge: within a hundredth."""
    (family,) = families(lined(0.0), PITCH_MM)
    assert family.period_px / TO_PX == pytest.approx(10, abs=0.01)
    assert families(lined(4.0), PITCH_MM) == []


@pytest.mark.parametrize("bare_mm", [0.0, 1.0, 4.0])
@pytest.mark.parametrize("is_upright", [True, False])
def test_lines_that_do_not_come_to_both_ends_of_the_sheet_are_not_looked_for(
    monkeypatch: pytest.MonkeyPatch, bare_mm: float, is_upright: bool
) -> None:
    """The ends of 62 mm of paper are 3 % of it.

    With paper of 1 mm at one end there is still ink for more than half of these lines there.
    """
    asked = list[bool]()
    monkeypatch.setattr(ruling, "_family", lambda _, __, way: asked.append(way))
    paper = lined(bare_mm)
    families(paper if is_upright else np.ascontiguousarray(paper.T), PITCH_MM)
    assert (is_upright in asked) is (bare_mm < 2.0)
