"""How fine filled shapes may be: slots, teeth, slits and bridges, what is told of finer ones, and lines that
are no shapes.
"""

from __future__ import annotations

import re
from pathlib import Path

import cv2
import numpy as np
import pytest
import shapely
from PIL import Image

from morfax.motion.contour import distance
from morfax.motion.faults import DrawingFault
from morfax.motion.motion import thin
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.shapes import outlined
from morfax.tracer.drawing.strokes import Sheet
from morfax.tracer.program.trace import trace
from morfax.tracer.program.trace_lines import trace_lines
from tests.tracer.drawing.filled import CIRCLE, filled
from tests.tracer.inked import DPI, UM, Points, arc, polyline


def test_a_slight_round_is_no_corner(tmp_path: Path) -> None:
    """Corners of an octagon with a round of 0.6 mm: 0.6 · (1/cos(22.5°) - 1) = 49 um inside where the legs
    meet.
    """
    vertices = np.array([17, 17]) + 11 * np.array(
        [[np.cos(a), np.sin(a)] for a in np.radians(10 + 45 * np.arange(8))]
    )
    outline = np.array(
        shapely.Polygon(vertices).buffer(-0.6).buffer(0.6, quad_segs=64).exterior.coords
    )
    run = trace(Drawing.open(filled(tmp_path / "octagon.png", outline), edge=True))
    found = distance(thin(run), outline)
    assert run.ending == "closed" and found.hausdorff_mm < 25 * UM, found


def test_edges_may_be_0_3_mm_apart(tmp_path: Path) -> None:
    """Two bars, the slot between them 0.3 mm: to either side of it the corners are those of a line that is
    0.1 mm wide.
    """
    bars = [polyline((8, y), (28, y), (28, y + 8), (8, y + 8), (8, y)) for y in (8.0, 16.3)]
    run = trace_lines(Drawing.open(filled(tmp_path / "bars.png", *bars), edge=True))
    assert [line.ending for line in run.lines] == ["closed", "closed"]
    assert distance(thin(run), bars).hausdorff_mm < 60 * UM


@pytest.mark.parametrize("apart_mm", [0.4, 0.7])
def test_a_slot_in_an_edge_is_followed_to_its_end(tmp_path: Path, apart_mm: float) -> None:
    """Its end has two corners nearer to one another than the lens lets legs be felt: they stay as round as
    the lens made them, 0.77 s = 66 um.
    """
    low, high = 17 - apart_mm / 2, 17 + apart_mm / 2
    outline = polyline(
        (8, 8), (28, 8), (28, low), (14, low), (14, high), (28, high), (28, 26), (8, 26), (8, 8)
    )
    run = trace(Drawing.open(filled(tmp_path / "slot.png", outline), edge=True))
    found = distance(thin(run), outline)
    assert run.ending == "closed" and found.path_to_reference.rms_mm < 6 * UM, found
    assert found.hausdorff_mm < 100 * UM, found  # it was 9.8 mm: the head went past the slot


def teeth(top_mm: float, number: int = 9) -> Points:
    """A rack: teeth of 1.8 mm whose flanks are 15 degrees from upright, on a bar."""
    pitch_mm, aside_mm = 2.0, 1.8 * np.tan(np.radians(15))
    row: list[tuple[float, float]] = []
    for k in range(number):
        left = 9 + k * pitch_mm
        row += [
            (left, 16),
            (left + aside_mm, 17.8),
            (left + aside_mm + top_mm, 17.8),
            (left + 2 * aside_mm + top_mm, 16),
        ]
    turn, middle = np.radians(8), np.array([18, 14])
    bar = polyline((8, 10), *row, (28, 16), (28, 10), (8, 10)) - middle
    return np.asarray(
        middle + bar @ [[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]]
    )


@pytest.mark.parametrize("top_mm", [0.4, 0.7])
def test_narrow_teeth_are_all_followed(tmp_path: Path, top_mm: float) -> None:
    """Tops too short for the lens to show their corners stay round: 100 um. With the line at 0.4 mm the head
    cut across, 0.9 mm off, and said nothing.
    """
    rack = teeth(top_mm)
    run = trace(Drawing.open(filled(tmp_path / "rack.png", rack), edge=True))
    found = distance(thin(run), rack)
    assert run.ending == "closed" and found.path_to_reference.rms_mm < 10 * UM, found
    assert found.hausdorff_mm < 120 * UM, found


@pytest.mark.parametrize("radius_mm", [0.4, 0.6])
def test_small_holes_are_round(tmp_path: Path, radius_mm: float) -> None:
    hole = arc((15, 16), radius_mm)
    run = trace_lines(
        Drawing.open(filled(tmp_path / "hole.png", CIRCLE, holes=(hole,)), edge=True)
    )
    assert [line.ending for line in run.lines] == ["closed", "closed"]
    found = distance(thin(run), [CIRCLE, hole])
    assert found.hausdorff_mm < 45 * UM, (
        found
    )  # the hole is five to seven softnesses of the lens in radius


def bars(apart_mm: float, times: float = 1.0) -> list[Points]:
    """Two bars of 12 x 4 mm, a slit between them, drawn so many times as large."""
    low, high = 4.0, 4.0 + apart_mm
    return [
        (
            8
            + times
            * (polyline((0, y), (12, y), (12, y + 4), (0, y + 4), (0, y)) - [0, low - 4])
        )
        for y in (low - 4, high)
    ]


def test_edges_that_the_lens_cannot_part_are_closed_across_and_told_of(tmp_path: Path) -> None:
    """One slit of 0.15 mm: the outline goes round both bars as one. It was refused."""
    drawing = Drawing.open(filled(tmp_path / "bars.png", *bars(0.15)), edge=True)
    run = trace_lines(drawing)
    around = polyline((8, 8), (20, 8), (20, 16.15), (8, 16.15), (8, 8))
    assert [line.ending for line in run.lines] == ["closed"]
    found = distance(thin(run), around)
    assert found.hausdorff_mm < 400 * UM, (
        found
    )  # a notch at either mouth: the corners there are round
    xy_mm = run.lines[0].xy_mm
    beside = np.abs(xy_mm[:, 1] - 12) > 1
    assert distance(xy_mm[beside][::4], around).path_to_reference.rms_mm < 6 * UM
    (note,) = drawing.notes
    told = re.search(r"a slit of (0\.\d+) mm over (\d+\.\d) mm at 14\.\d,12\.[01] mm", note)
    assert told is not None, note
    assert abs(float(told[1]) - 0.15) < 0.04 and abs(float(told[2]) - 12) < 1


def test_the_advice_on_a_slit_works(tmp_path: Path) -> None:
    """Drawn so many times as large, with --scale as told, the slit is followed on both sides."""
    (note,) = Drawing.open(filled(tmp_path / "bars.png", *bars(0.15)), edge=True).notes
    told = re.search(r"print the shape (\S+) times as large and give --scale (\S+)$", note)
    assert told is not None, note
    times, scale = float(told[1]), float(told[2])
    larger = bars(0.15, times)
    drawing = Drawing.open(filled(tmp_path / "larger.png", *larger), edge=True)
    run = trace_lines(drawing)
    assert not drawing.notes and [line.ending for line in run.lines] == ["closed", "closed"]
    assert distance(thin(run), larger).hausdorff_mm < 60 * UM
    assert abs(scale * times - 1) < 0.001


@pytest.mark.parametrize("seed", [1, 2])
def test_the_advice_on_texture_works(seed: int) -> None:
    """A disc of 40 mm whose grey goes up and down over 0.1 mm, up to the paper's: a print of the gaps would
    have to be 20 times as large and more. Blurred as told, one outline is left, and it is the disc's.
    """
    pitch_mm, pixels = 25.4 / 150, 354
    grain = np.random.default_rng(seed).normal(size=(pixels, pixels)).astype(np.float32)
    grain = np.asarray(cv2.GaussianBlur(grain, (0, 0), 0.7))
    row, column = np.mgrid[:pixels, :pixels] - pixels / 2
    shape = 1 / (1 + np.exp((np.hypot(row, column) - pixels / 3) / 0.8))
    dark = shape * (0.75 + 0.35 * grain / grain.std())
    grey = np.clip(255 * (1 - dark), 0, 255).astype(np.float32)
    (note,) = outlined(grey, pitch_mm).notes
    told = re.search(r"they are texture .* blur the picture by (\d\.\d) mm", note)
    assert told is not None and "times as large" not in note, note
    found = outlined(cv2.GaussianBlur(grey, (0, 0), float(told[1]) / pitch_mm), pitch_mm)
    assert not found.notes and len(found.edges_mm) == 1
    across_mm = np.ptp(found.edges_mm[0], axis=0)
    assert np.abs(across_mm - 2 * pixels / 3 * pitch_mm).max() < 0.3


def test_a_slit_that_is_a_streak_only_is_told_of(tmp_path: Path) -> None:
    drawing = Drawing.open(filled(tmp_path / "bars.png", *bars(0.05)), edge=True)
    assert re.search(r"streak only, over 1\d\.\d mm at 14\.\d,12\.0 mm", drawing.notes[0])
    assert Drawing.open(filled(tmp_path / "disc.png", CIRCLE), edge=True).notes == ()


def test_a_bridge_that_is_too_thin_is_left_out_and_told_of(tmp_path: Path) -> None:
    """A bridge of 0.1 mm over a gap of 2 mm: the plates are outlines of their own."""
    plates = [polyline((x, 8), (x + 8, 8), (x + 8, 14), (x, 14), (x, 8)) for x in (8.0, 18.0)]
    bridge = polyline((15, 11), (19, 11), (19, 11.14), (15, 11.14), (15, 11))
    drawing = Drawing.open(filled(tmp_path / "plates.png", *plates, bridge), edge=True)
    run = trace_lines(drawing)
    assert re.search(
        r"a bridge of 0\.1\d mm over [12]\.\d mm at 17\.\d,11\.\d mm", drawing.notes[0]
    )
    assert [line.ending for line in run.lines] == ["closed", "closed"]
    found = distance(thin(run), plates)
    assert found.path_to_reference.p95_mm < 20 * UM and found.hausdorff_mm < 400 * UM, found


def test_a_slit_of_0_2_mm_is_followed(tmp_path: Path) -> None:
    """It was refused. Each edge is drawn to the other by the lens: 8 um of 200."""
    outlines = bars(0.2)
    run = trace_lines(Drawing.open(filled(tmp_path / "bars.png", *outlines), edge=True))
    assert [line.ending for line in run.lines] == ["closed", "closed"]
    assert distance(thin(run), outlines).hausdorff_mm < 40 * UM


def test_a_cut_shape_does_not_keep_the_others_from_being_followed(tmp_path: Path) -> None:
    cut = polyline((30, 26), (40, 26), (40, 32), (30, 32), (30, 26))
    drawing = Drawing.open(filled(tmp_path / "two.png", CIRCLE, cut), edge=True)
    assert "left out: a filled shape is cut by the border" in drawing.notes[0]
    run = trace_lines(drawing)
    assert distance(thin(run), CIRCLE).path_to_reference.rms_mm < 4 * UM


def test_a_shape_cut_by_the_border_is_refused(tmp_path: Path) -> None:
    file = filled(tmp_path / "cut.png", polyline((20, 8), (40, 8), (40, 20), (20, 20), (20, 8)))
    with pytest.raises(
        DrawingFault,
        match=r"a filled shape is cut by the border of the sheet at 3\d\.\d,(8|20|19)\.\d mm",
    ):
        Drawing.open(file, edge=True)


def test_lines_are_no_shapes(tmp_path: Path) -> None:
    file = filled(tmp_path / "line.png", arc((16, 16), 10), holes=(arc((16, 16), 9.5),))
    with pytest.raises(
        DrawingFault, match=r"0\.\d+ mm broad at most.*leave --edge out to follow lines"
    ):
        Drawing.open(file, edge=True)


def test_a_hole_is_a_line_of_its_own(tmp_path: Path) -> None:
    hole = arc((15, 16), 4)
    run = trace_lines(
        Drawing.open(filled(tmp_path / "ring.png", CIRCLE, holes=(hole,)), edge=True)
    )
    assert [line.ending for line in run.lines] == ["closed", "closed"]
    assert distance(thin(run), [CIRCLE, hole]).hausdorff_mm < 25 * UM


def test_a_blank_sheet_has_no_edge(tmp_path: Path) -> None:
    file = tmp_path / "blank.png"
    Image.fromarray(np.full((300, 300), 240, np.uint8)).save(file, dpi=(300, 300))
    with pytest.raises(DrawingFault, match="no filled shape on the drawing"):
        Drawing.open(file, edge=True)


@pytest.mark.parametrize("light", [False, True])
def test_without_edge_the_rim_of_a_filled_shape_is_known(tmp_path: Path, light: bool) -> None:
    """A disc of 20 mm is broader than a stroke; paper that is half as dark as ink on one side is a shadow."""
    disc = Sheet.of(Drawing.open(filled(tmp_path / "disc.png", CIRCLE, light=light)))
    assert disc.are_solid[np.argmax(disc.lengths_mm)]
    assert disc.is_solid_at(CIRCLE[0])
    ring = filled(
        tmp_path / "ring.png",
        arc((16, 16), 12),
        holes=(arc((16, 16), 10),),
        shade=80,
        light=light,
    )
    assert not Sheet.of(Drawing.open(ring)).are_solid.any()


@pytest.mark.parametrize("light", [False, True])
def test_where_light_falls_off_a_line_is_no_rim_and_a_filled_shape_is(
    tmp_path: Path, light: bool
) -> None:
    """Beneath a lamp the paper is darker at one side by more than the ink of a pencil.

    (Fails with the brightest of all the paper, in `Paper.shapes`, for the brightest close by.)
    """
    columns = round(180 / 25.4 * DPI)
    across, up = np.meshgrid(
        (np.arange(columns) + 0.5) * 25.4 / DPI, np.arange(400) * 25.4 / DPI
    )
    ring_mm = np.abs(np.hypot(across - 140, up - 17) - 12)
    inside_mm = np.hypot(across - 100, up - 17) - 12
    pixel_mm = 25.4 / DPI
    ink = np.clip(0.5 + (0.3 - ring_mm) / pixel_mm, 0, 1)
    filled_in = np.clip(0.5 - inside_mm / pixel_mm, 0, 1)
    grey = (240 - 110 * across / 180) * (1 - 0.45 * np.maximum(ink, filled_in))
    file = tmp_path / "lamp.png"
    Image.fromarray((255 - grey if light else grey).astype(np.uint8)).save(file, dpi=(DPI, DPI))
    sheet = Sheet.of(Drawing.open(file))
    assert not sheet.is_solid_at(np.array([152.0, 34.0 - 17]))
    assert sheet.is_solid_at(np.array([112.0, 34.0 - 17]))


def test_a_line_in_a_shadow_as_dark_as_a_shape_is_no_rim(tmp_path: Path) -> None:
    """Two rings of 0.5 mm lines, 20 mm across, of which one lies where a phone's shadow halves the light."""
    ink = np.zeros((591, 827), np.uint8)  # 70 x 50 mm
    for column in (210, 617):
        cv2.circle(ink, (column, 295), 118, 255, 6, cv2.LINE_AA)
    light = 1 - 0.5 / (1 + np.exp(-(np.arange(827) - 413) / 15))
    grey = (235 - 195 * (ink / 255.0)) * light
    file = tmp_path / "shadow.png"
    Image.fromarray(np.round(grey).astype(np.uint8)).save(file, dpi=(300, 300))
    sheet = Sheet.of(Drawing.open(file))
    assert len(np.flatnonzero(sheet.lengths_mm > 50)) == 2 and not sheet.are_solid.any()
