"""Pencil with grain, seen through a slit along the line, against drawings made with known grain.

Bounds: the ink's own middle wanders with its grain, 22 um RMS with 45 %. 40 um is
the limit for three drawings.
"""

from __future__ import annotations

import re
from pathlib import Path

import cv2
import numpy as np
import pytest

from morfax.motion.contour import distance
from morfax.motion.units import MM_PER_INCH
from morfax.tracer.drawing import grain
from morfax.tracer.drawing.drawing import Darkness, Drawing
from morfax.tracer.drawing.noise import within
from morfax.tracer.drawing.scale import Scale
from morfax.tracer.drawing.scan import Scan, Stated
from morfax.tracer.program.trace import trace
from morfax.tracer.program.trace_ink import trace_ink
from tests.tracer.inked import DPI, UM, Points, arc, inked, polyline, together

PITCH_MM = MM_PER_INCH / DPI
FAINT, BLACK_LEVELS, NOISE_LEVELS = 1 / 3, 195.0, 8.0  # of 255, as a scanner has them
GRAIN_PX = 1.2


def pencilled(
    line: Points, share: float, seed: int, width_mm: float = 0.45, dpi: float = DPI
) -> Darkness:
    """Levels 0..255 of a line drawn with a pencil of a grain, as a scanner sees it."""
    random = np.random.default_rng(seed)
    ink = inked(line, width_mm=width_mm, dpi=dpi).darkness
    wave = cv2.GaussianBlur(random.normal(size=ink.shape), (0, 0), GRAIN_PX * dpi / DPI)
    ink = ink * np.clip(1 + share * wave / wave.std(), 0, 2) * FAINT
    return np.asarray(235 - BLACK_LEVELS * ink + random.normal(0, NOISE_LEVELS, ink.shape))


def opened(levels: Darkness, dpi: float = DPI) -> Drawing:
    """The drawing of a picture of grey levels, as it is opened."""
    grey = np.clip(np.round(levels), 0, 255).astype(np.uint8)
    return Drawing.of(Scan(Path("made.png"), grey, Stated((dpi, dpi))), Scale())


@pytest.mark.parametrize(("share", "seed"), [(0.35, 1), (0.45, 2), (0.45, 3)])
def test_pencil_with_grain_is_one_closed_path(share: float, seed: int) -> None:
    line = arc((22.0, 22.0), 16.0)
    run = trace(opened(pencilled(line, share, seed))).lines[0]
    apart = distance(run.xy_mm[::4], line)
    assert run.ending == "closed"
    assert apart.path_to_reference.rms_mm < 40 * UM
    assert apart.reference_to_path.max_mm < 0.2


def test_the_corners_of_a_pencilled_square_stay() -> None:
    """A corner is rounded by some 0.1 mm; 0.3 mm is less than the line's width."""
    line = polyline((6, 6), (30, 9), (27, 31), (5, 28), (6, 6))
    run = trace(opened(pencilled(line, 0.4, 4))).lines[0]
    apart = distance(run.xy_mm[::4], line)
    assert run.ending == "closed"
    assert apart.reference_to_path.max_mm < 0.3


def test_a_pencilled_line_ends_where_it_was_drawn_to() -> None:
    """Half of the slit is on paper at the end of a line. A quarter of a width is the grain's."""
    run = trace(opened(pencilled(polyline((6, 10), (40, 10)), 0.35, 5))).lines[0]
    assert run.ending == "ended"
    ends = np.sort(run.xy_mm[[0, -1], 0])
    assert ends == pytest.approx([6, 40], abs=0.4)


def test_the_slit_takes_grain_away_and_leaves_the_paper() -> None:
    levels = pencilled(arc((22.0, 22.0), 16.0), 0.45, 6)
    darkness = np.asarray((235 - levels) / (BLACK_LEVELS * FAINT), np.float32)
    seen_before = within(darkness)
    before, width_px = seen_before.grain, seen_before.width_px
    slit = grain.slit_for(before, width_px, PITCH_MM)
    assert slit is not None
    seen = grain.behind(slit, darkness)
    assert before > 0.2
    assert within(seen).grain < 0.5 * before
    assert np.abs(seen[150:220, 150:220]).max() < 0.3  # paper inside of the circle
    assert darkness[150:220, 150:220].max() > 0.3


@pytest.mark.parametrize(("dpi", "apart"), [(120.0, 2.0), (150.0, 1.75), (200.0, 2.0)])
def test_two_clean_lines_beside_each_other_have_no_grain(dpi: float, apart: float) -> None:
    """A place between them is pale, and one farther on dark, where pixels lie otherwise on them: they would
    be averaged into one line. Both are followed, within a tenth of a pixel (RMS).
    """
    radii_mm = 20.0, 20.0 - apart * 0.5
    rings = [arc((26.0, 26.0), radius_mm) for radius_mm in radii_mm]
    levels = 235 - BLACK_LEVELS * inked(*rings, dpi=dpi, seed=1).darkness
    grey = np.clip(np.round(levels), 0, 255).astype(np.uint8)
    drawing = Drawing.of(Scan(Path("made.png"), grey, Stated((dpi, dpi))), Scale())
    assert not any("grain" in note for note in drawing.notes)
    lines = trace_ink(drawing).lines
    assert sorted(line.ending for line in lines) == ["closed", "closed"]
    for line in lines:
        out_mm = np.hypot(*(line.xy_mm - 26.0).T)
        off_mm = out_mm - min(radii_mm, key=lambda r, out=out_mm: abs(out[0] - r))
        assert np.sqrt(np.mean(off_mm**2)) < 0.1 * MM_PER_INCH / dpi


def test_clean_ink_and_lines_of_several_pens_have_no_grain() -> None:
    """A scanner's noise is no grain, nor is a second pen half as dark: each line is like itself."""
    dark, pale = polyline((5, 5), (45, 8)), polyline((5, 20), (45, 26))
    both = together((dark, 0.5), (pale, 0.5), seed=1).darkness
    both[: len(both) // 2] *= 0.6
    assert within(both).grain < 0.06
    clean = inked(arc((22.0, 22.0), 16.0), seed=2)
    seen = within(clean.darkness)
    assert grain.slit_for(seen.grain, seen.width_px, PITCH_MM) is None


def test_small_bends_pressed_harder_and_softer_are_no_grain() -> None:
    """Behind the slit the nine rings and three zigzags came apart: 23 strokes."""
    dpi = 100.0
    corners = np.arange(5, 40, 2.0)
    zigzags = [
        polyline(*[(x, y + 2.0 * (i % 2)) for i, x in enumerate(corners)]) for y in (5, 11, 17)
    ]
    small = [arc((x, 26.0), 1.5) for x in (8, 14, 20, 26, 32)]
    large = [arc((x, 33.0), 2.4) for x in (8, 16, 24, 32)]
    ink = inked(*zigzags, *small, *large, width_mm=0.85, dpi=dpi).darkness
    down, right = np.mgrid[: ink.shape[0], : ink.shape[1]] * MM_PER_INCH / dpi
    pressed = 0.72 + 0.28 * np.sin(2 * np.pi * (right + 0.6 * down) / 3.5)
    noise = np.random.default_rng(1).normal(0, 2, ink.shape)
    grey = np.clip(np.round(240 - 190 * ink * pressed + noise), 0, 255).astype(np.uint8)
    drawing = Drawing.of(Scan(Path("made.png"), grey, Stated((dpi, dpi))), Scale())
    assert within(drawing.darkness).grain > grain.LEAST_GRAIN
    found = trace_ink(drawing)
    assert len(found.lines) == len([*zigzags, *small, *large])
    assert found.ink is not None and found.ink.followed_share > 0.99


def test_a_marker_that_is_dry_in_a_quarter_of_its_line_is_seen_through_the_slit() -> None:
    """The grain of all its ink is 12 %. Without the slit the head followed a shred of the dry part, 0.42 mm
    beside its middle; a sixth of the width is what the grain takes off one edge.
    """
    line = arc((22.0, 22.0), 16.0)
    wet, dry = (pencilled(line, share, 1, width_mm=0.9) for share in (0.08, 0.6))
    levels = np.where(np.arange(wet.shape[1]) * PITCH_MM > 33, dry, wet)
    darkness = np.asarray((235 - levels) / (BLACK_LEVELS * FAINT), np.float32)
    assert grain.LEAST_OF_SOME < within(darkness).grain < grain.LEAST_GRAIN
    drawing = opened(levels)
    run = trace(drawing).lines[0]
    assert drawing.grainy and not opened(wet).grainy
    assert run.ending == "closed"
    assert distance(run.xy_mm[::4], line).path_to_reference.max_mm < 0.15


def test_a_pencil_too_thin_for_the_slit_is_told_and_the_advice_works() -> None:
    """Its path strays by up to 0.26 mm; 28 um RMS at 150 dpi, 15 at the resolution that is told."""
    line = arc((22.0, 22.0), 16.0)
    (note,) = opened(pencilled(line, 0.35, 1, 0.35, 150), 150).notes
    told = re.search(r"are fewer than 2.9 pixels wide.* scan at (\d+) dpi", note)
    assert told is not None
    finer = int(told[1])
    drawing = opened(pencilled(line, 0.35, 1, 0.35, finer), finer)
    assert drawing.grainy
    apart = distance(trace(drawing).lines[0].xy_mm[::4], line)
    assert apart.path_to_reference.rms_mm < 20 * UM


def test_a_thin_line_without_grain_is_not_told_to_have_it() -> None:
    for dpi, width_mm in ((150, 0.35), (200, 0.3), (200, 0.35)):
        ink = inked(arc((22.0, 22.0), 16.0), width_mm=width_mm, dpi=dpi, seed=1).darkness
        assert not any("grain" in note for note in opened(235 - 195 * ink, dpi).notes)
