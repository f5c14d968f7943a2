"""Two lines nearer to each other than a pen's width all along: two strokes, or told."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
import pytest
import shapely

from morfax.jobs.remarks.on_ink import of_ink
from morfax.jobs.tracing.trace_figures import ink as figures_of
from morfax.motion.polyline import length_mm, nearest_mm
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.two_levels import with_rims
from morfax.tracer.head.settings import Settings
from morfax.tracer.ink.bare import Thinned
from morfax.tracer.ink.both_lines import strands
from morfax.tracer.ink.ledger import balance
from morfax.tracer.ink.left_out import ink_left
from morfax.tracer.ink.run import LEAST_PLACES
from morfax.tracer.ink.stretches import FeltSheet
from morfax.tracer.program.trace_ink import trace_ink
from tests.tracer.inked import WIDTH_MM, Points, arc, inked, loops, polyline, together

LONG_MM = 40.0
CLEAR = polyline((5, 40), (55, 40))  # a line by itself


def near_lines(crossed: bool) -> tuple[Points, Points]:
    """Two lines apart by three widths at their ends, by 0.8 widths and less for 25 mm in between.

    They change sides in the middle, or they touch there.
    """
    along = np.linspace(-1, 1, 400)
    apart_mm = WIDTH_MM * (2.4 * along**5 + 0.8 * along)
    if not crossed:
        apart_mm = WIDTH_MM * (2.2 * along**6 + 0.8 * along**2)
    x = 30 + 0.5 * LONG_MM * along
    return (
        np.column_stack([x, 20 + 0.5 * apart_mm]),
        np.column_stack([x, 20 - 0.5 * apart_mm]),
    )


@pytest.mark.parametrize("crossed", [True, False])
def test_two_lines_nearer_than_a_width_are_two_strokes(crossed: bool) -> None:
    one, other = near_lines(crossed)
    found = trace_ink(inked(one, other, CLEAR, seed=1))
    assert found.ink is not None and found.ink.followed_share > 0.999
    # each of the lines is one stroke from end to end, and on its own side all along
    assert len(found.lines) == 3
    for line in (one, other):
        away_mm = min(
            float(shapely.hausdorff_distance(*map(shapely.LineString, (line, stroke.xy_mm))))
            for stroke in found.lines
        )
        assert away_mm < 0.25 * WIDTH_MM  # the other line is up to three widths away


@pytest.mark.parametrize("apart", [1.15, 1.3])
def test_where_all_lines_run_in_pairs_their_pale_middle_shows_that_they_are_two(
    apart: float,
) -> None:
    """Two rings, one moved aside: no line shows the pen, and the ink swells as a nib's would."""
    rings = [arc((30 + dx, 30.0), 22) for dx in (0.0, apart * WIDTH_MM)]
    found = trace_ink(inked(*rings, seed=1))
    truth = np.vstack(rings)
    assert found.ink is not None and found.ink.followed_share > 0.99
    near_mm = nearest_mm(truth, np.vstack([line.xy_mm for line in found.lines]))
    assert np.mean(near_mm < 0.15 * WIDTH_MM) > 0.97
    ways = [length_mm(line.xy_mm) for line in found.lines]
    assert sum(ways) == pytest.approx(2 * 2 * np.pi * 22, rel=0.02)


@pytest.mark.parametrize("long_mm", [4.6, 4.9, 5.2, 7.0])
def test_a_pen_that_turns_back_beside_its_own_line_draws_one_stroke(long_mm: float) -> None:
    """A loop as in handwriting, narrower than two widths all along, which crosses itself at its foot.

    The short one shows its width along less than eight widths, and all of that is broad.
    """
    t = np.linspace(-1.6, 1.6, 600)
    t_loop = np.clip(t, -1, 1)
    aside = 1.4 * WIDTH_MM * t_loop * (1 - t_loop**2) - 2.8 * WIDTH_MM * (t - t_loop)
    way = np.column_stack([30 + aside, 14 + long_mm * (1 - t_loop**2 - 2 * np.abs(t - t_loop))])
    found = trace_ink(inked(way, CLEAR, seed=1))
    assert len(found.lines) == 2, [line.length_mm for line in found.lines]
    run_mm = sum(line.length_mm for line in found.lines)
    assert run_mm == pytest.approx(length_mm(way) + length_mm(CLEAR), rel=0.01)


def test_two_lines_that_others_cut_into_short_pieces_are_two_strokes() -> None:
    """They lie about 0.3 mm apart; pieces of 2.5 mm of their ink are too short to be told by themselves."""
    along = np.linspace(-1, 1, 400)
    apart_mm = 0.3 + 0.05 * along + 12 * np.maximum(np.abs(along) - 0.6, 0) ** 2
    pair = [np.column_stack([30 + 25 * along, 20 + side * apart_mm / 2]) for side in (1, -1)]
    across = [polyline((x, 10), (x, 30)) for x in (27.5, 30, 32.5)]
    found = trace_ink(inked(*pair, *across, CLEAR, seed=1))
    run_mm = sum(line.length_mm for line in found.lines)
    assert run_mm == pytest.approx(sum(map(length_mm, (*pair, *across, CLEAR))), rel=0.01)
    # one stroke between both would be 0.15 mm from either
    places = np.vstack([line.places_mm for line in found.lines])
    for line in pair:
        assert nearest_mm(line[np.abs(along) < 0.1], places).max() < 0.1 * WIDTH_MM


@pytest.mark.parametrize("turned_deg", [4.0, 6.0, 8.0])
def test_two_lines_that_cross_at_a_small_angle_keep_to_themselves_among_others(
    turned_deg: float,
) -> None:
    """Others cut their ink into pieces, no two of which are as broad: no piece is a line of a broader pen."""
    rise = 20 * np.tan(np.radians(turned_deg / 2))
    pair = [polyline((10, 20 - side * rise), (50, 20 + side * rise)) for side in (1, -1)]
    across = [polyline((x - 3, 8), (x + 3, 32)) for x in (26, 28, 32, 34)]
    found = trace_ink(inked(*pair, *across, seed=1))
    assert len(found.lines) == 6
    for line in pair:
        away_mm = min(
            float(shapely.hausdorff_distance(*map(shapely.LineString, (line, stroke.xy_mm))))
            for stroke in found.lines
        )
        assert (
            away_mm < 0.25 * WIDTH_MM
        )  # a stroke that changes over would end 1.4 mm away or more


@pytest.mark.parametrize("apart_mm", [0.5, 0.55])
def test_two_lines_whose_rims_touch_for_a_while_are_two_strokes(apart_mm: float) -> None:
    """The lens closes the slit between them: their ink is a little over two widths wide there, and even."""
    along = np.linspace(-1, 1, 400)
    aside_mm = 0.5 * apart_mm + 3 * np.maximum(np.abs(along) - 0.3, 0) ** 2
    pair = [np.column_stack([30 + 12 * along, 20 + side * aside_mm]) for side in (1, -1)]
    found = trace_ink(inked(*pair, CLEAR, seed=1))
    assert len(found.lines) == 3
    run_mm = sum(line.length_mm for line in found.lines)
    assert run_mm == pytest.approx(sum(map(length_mm, (*pair, CLEAR))), rel=0.01)


def test_the_ledger_counts_the_line_that_no_second_stroke_follows() -> None:
    drawing = inked(*near_lines(crossed=True), CLEAR, seed=1)
    left = ink_left(drawing.sheet)
    felt = FeltSheet.of(left.drawing, Settings(), left.ink)
    ways = [polyline((10, 20), (50, 20)), CLEAR]  # once through the middle of both
    thinned = Thinned.of(drawing.sheet, felt.graph, left)
    counted = balance(drawing.sheet, felt, thinned, left, ways)
    assert counted.followed_share < 0.9
    ((x, y, long_mm),) = counted.single
    assert abs(x - 30) < 12 and abs(y - 20) < 1 and 10 < long_mm < LONG_MM


def test_it_is_told_with_its_place_and_in_the_figures() -> None:
    found = trace_ink(inked(CLEAR, seed=1))
    assert found.ink is not None
    told = replace(found, ink=found.ink._replace(single=((30.0, 20.0, 12.0),)))
    (said,) = [text for text in of_ink(told, several=True) if "nearer" in text]
    assert "12 mm of ink (19 %)" in said and "30.0,20.0" in said
    assert figures_of(told)["doubled_ink_run_once_mm"] == 12.0
    assert told.ink is not None and told.ink.followed_share < 0.82


def test_a_line_of_a_broader_pen_is_one_line() -> None:
    drawn = together((CLEAR, WIDTH_MM), (polyline((5, 20), (55, 20)), 1.6 * WIDTH_MM), seed=1)
    found = trace_ink(drawn)
    assert len(found.lines) == 2 and found.ink is not None and not found.ink.single


def test_a_line_of_a_broader_pen_is_one_line_however_often_others_cross_it() -> None:
    broad = polyline((5, 20), (55, 20)), 1.6 * WIDTH_MM
    others = [(polyline((x, 10), (x + 3, 30)), WIDTH_MM) for x in range(8, 50, 4)]
    found = trace_ink(together(broad, *others, seed=1))
    assert len(found.lines) == 1 + len(others)


@pytest.mark.parametrize("swell", ["by its heading", "as a sine"])
def test_a_nib_that_swells_and_shrinks_is_one_line(swell: str) -> None:
    way = loops(5)
    turned = np.linspace(0, 9 * np.pi, len(way))[::5] + 0.6
    share = np.abs(np.sin(turned)) if swell == "by its heading" else 0.5 - 0.5 * np.cos(turned)
    pieces = ((way[5 * k : 5 * k + 6], 0.25 + 0.35 * wide) for k, wide in enumerate(share))
    found = trace_ink(together(*pieces, seed=1))
    # taken for two lines of the thinnest pen, it was run twice, along both its rims
    assert sum(line.length_mm for line in found.lines) < 1.03 * length_mm(way)
    places = np.vstack([line.places_mm for line in found.lines])
    assert float(np.mean(nearest_mm(places, way) < 0.2 * WIDTH_MM)) > 0.97


def test_rough_lines_do_not_tell() -> None:
    """The width of a rough line says nothing of a second one."""
    rng, x = np.random.default_rng(1), np.linspace(5, 55, 400)
    rough = np.column_stack([np.r_[x, x[::-1]], np.r_[20 + rng.uniform(-0.1, 0.1, 800)]])
    drawing = inked(rough, CLEAR, seed=1)
    left = ink_left(drawing.sheet)
    assert not FeltSheet.of(left.drawing, Settings(), left.ink).doubled.stations


def test_lines_that_share_their_ink_do_not_turn_off_into_what_crosses_it() -> None:
    pair = [polyline((5, 20 + side * 0.2), (55, 20 + side * 0.2)) for side in (1, -1)]
    slope = float(np.tan(np.radians(20.0)))
    across = polyline((10, 20 - 20 * slope), (50, 20 + 20 * slope))
    drawing = inked(*pair, across, CLEAR, seed=1)
    left = ink_left(drawing.sheet)
    felt = FeltSheet.of(left.drawing, Settings(), left.ink).felt
    both = [
        strand
        for run in felt
        if abs(run.places_mm[:, 1] - 20).max() < 1.0 and run.length_mm > 10
        for strand in strands(run, WIDTH_MM)
    ]
    assert len(both) == 4  # two to either side of the crossing
    for strand in both:
        turned = np.degrees(np.abs(np.sin(strand.headings_rad)))
        assert (
            turned.max() < 10.0
        )  # ink that becomes wider by 0.15 of its way is not yet a flare: 8.5


def test_a_small_ring_of_a_broader_pen_is_one_line() -> None:
    """It has no end at which anything could go on: on such a sheet all was given up."""
    ring = arc((30, 20), 2.0), 1.6 * WIDTH_MM
    thin = [(arc((30, 20), radius_mm), WIDTH_MM) for radius_mm in (9.0, 14.0)]
    found = trace_ink(together(ring, *thin))
    assert len(found.lines) == 3 and found.ink is not None
    assert found.ink.followed_share > 0.999 and not found.ink.single


def test_of_ink_that_is_felt_over_less_than_half_a_width_nothing_flares_out() -> None:
    drawing = inked(CLEAR, seed=1)
    left = ink_left(drawing.sheet)
    run = FeltSheet.of(left.drawing, Settings(), left.ink).felt[0]
    widths_mm = np.full(len(run), np.nan)
    widths_mm[10 : 10 + LEAST_PLACES] = 1.3 * WIDTH_MM
    scarcely = replace(run, widths_mm=widths_mm)
    assert LEAST_PLACES * run.view.step_mm < 0.5 * 4 * WIDTH_MM
    one, other = strands(scarcely, 4 * WIDTH_MM)
    assert len(one) == len(other) == LEAST_PLACES


def two_pens(thin_mm: float, thick_mm: float, seed: int | None) -> Drawing:
    """Rings by a thin pen round arcs by a thicker one, which two straight lines of that pen cross."""
    thin = [arc((30, 30), 20.0), arc((30, 30), 24.0), polyline((5, 56), (55, 58))]
    thick = [arc((30, 30), radius_mm, 0.0, 300.0) for radius_mm in (5.0, 8.0, 11.0, 14.0, 17.0)]
    thick += [polyline((12, 16), (20, 44)), polyline((40, 14), (33, 44))]
    drawn = [(line, thin_mm) for line in thin] + [(line, thick_mm) for line in thick]
    return together(*drawn, seed=seed)


def doubled_mm(drawing: Drawing, *, tell_letters: bool = True) -> float:
    """The length of the ink of a drawing that is taken for that of two lines."""
    left = ink_left(drawing.sheet)
    letters = drawing.sheet.patches.painted(
        left.lettering, 0, len(left.ink), 0, left.ink.shape[1]
    )
    told = letters if tell_letters else None
    sheet = FeltSheet.of(left.drawing, Settings(), left.ink, told)
    return sum(sheet.doubled.length_mm(sheet.felt, n) for n in sheet.doubled.stations)


def test_lines_of_few_pixels_do_not_tell() -> None:
    assert doubled_mm(two_pens(0.2, 0.28, None)) == 0.0


def test_lines_with_grain_do_not_tell() -> None:
    """A pencil line on a photograph was told as two along 343 of its 520 mm."""
    clean = two_pens(0.5, 0.65, None)
    assert doubled_mm(clean) > 0
    assert doubled_mm(replace(clean, grainy=True)) == 0


def test_hard_pixels_tell_a_width_to_one_of_them() -> None:
    """A line of five and six pixels was ink of two lines, of which one was told as left out, or both were."""
    seen = inked(*near_lines(True), CLEAR)
    assert doubled_mm(seen) > 10.0
    assert doubled_mm(replace(seen, is_hard=True)) == 0.0


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_a_broader_pens_line_along_the_steps_of_pixels_is_one_line(seed: int) -> None:
    """It is a pixel broader for as long as its rims come by no step: 29 mm were told as two lines."""
    rows = [polyline((4, y), (46, y + rise)) for y, rise in ((10, 0.4), (28, -0.5), (38, 0.9))]
    columns = [polyline((x, 4), (x + 2, 46)) for x in (12, 24, 37)]
    thin = [(line, 0.25) for line in (*columns, rows[1], polyline((4, 18), (46, 19.4)))]
    drawing = together(*thin, (rows[0], 0.45), (rows[2], 0.45), seed=None)
    noise = np.random.default_rng(seed).normal(0.0, 0.1, drawing.darkness.shape)
    hard = (drawing.darkness + cv2.GaussianBlur(noise, (0, 0), 0.8) > 0.5).astype(np.float32)
    laid = replace(drawing, darkness=with_rims(hard), has_rims=True)
    assert doubled_mm(laid) == 0.0
    assert doubled_mm(replace(laid, has_rims=False)) > 5.0


@pytest.mark.parametrize("seed", [None, 1, 2])
def test_a_broader_pen_that_comes_by_two_lines_in_one_ink_draws_one_line(
    seed: int | None,
) -> None:
    """Where an arc comes up to a straight line both are one ink; the other arcs of that pen are not."""
    drawing = two_pens(0.25, 0.35, seed)
    assert doubled_mm(drawing) < 5.0  # of 230 mm that the broader pen has drawn
    found = trace_ink(drawing)
    assert found.ink is not None and found.ink.followed_share > 0.99


def test_printed_letters_do_not_tell() -> None:
    """Of a broader pen, nowhere as narrow as the lines: they need not even be told as letters."""
    lines = polyline((5, 30), (95, 33)), arc((50, 20), 8.0), arc((30, 18), 9.0)
    drawing = together(*((line, 0.4) for line in lines), seed=1)
    words = np.zeros(drawing.darkness.shape, np.uint8)
    at = 60, len(words) - 60
    cv2.putText(
        words, "SECTION OF RODS", at, cv2.FONT_HERSHEY_TRIPLEX, 1.6, 255, 1, cv2.LINE_AA
    )
    printed = cv2.GaussianBlur(words.astype(np.float32) / 255, (0, 0), 0.6)
    with_words = Drawing(np.maximum(drawing.darkness, printed), drawing.pitch_mm)
    assert doubled_mm(with_words, tell_letters=False) == 0.0
    assert doubled_mm(with_words) == 0.0
