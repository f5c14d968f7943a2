"""Two lines nearer to each other than a pen's width all along: two strokes, or told."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import shapely

from morfax.jobs.remarks.on_ink import of_ink
from morfax.jobs.tracing.trace_figures import ink as figures_of
from morfax.motion.polyline import length_mm, nearest_mm
from morfax.tracer.head.settings import Settings
from morfax.tracer.ink.bare import Thinned
from morfax.tracer.ink.both_lines import strands
from morfax.tracer.ink.ledger import balance
from morfax.tracer.ink.left_out import ink_left
from morfax.tracer.ink.run import LEAST_PLACES
from morfax.tracer.ink.stretches import FeltSheet
from morfax.tracer.program.trace_ink import trace_ink
from tests.tracer.ink.near_lines import CLEAR, LONG_MM, near_lines
from tests.tracer.inked import WIDTH_MM, arc, inked, polyline


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
