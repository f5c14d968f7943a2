"""Dots on drawings of known geometry: their middles, and what is none."""

from __future__ import annotations

import math

import numpy as np
import pytest

from morfax.motion.contour import distance
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.strokes import Sheet
from morfax.tracer.following.plain_places import view_of
from morfax.tracer.marks import dots
from morfax.tracer.sensing.leg import leg_of
from morfax.tracer.sensing.view import View
from tests.tracer.inked import UM, arc, dot, inked, polyline
from tests.tracer.marked import trace

WITHIN_MM = 20 * UM  # a quarter of a pixel at 300 dpi
LINE = polyline((4, 12), (24, 12))
AT = (24.0, 12.0)


def seen(drawing: Drawing, width_mm: float = 0.5) -> View:
    return view_of(Sheet.of(drawing), None, width_mm)


def at_end(
    across_mm: float, width_mm: float = 0.5, centre: tuple[float, float] = AT
) -> float | None:
    """How far from a dot's middle it is found at the end of a line, mm; None if it is not."""
    view = seen(
        inked(LINE, width_mm=width_mm, seed=5, specks=[dot(centre, across_mm)]), width_mm
    )
    leg = leg_of(view.feel(np.array([20.0, 12.0]), 0.0, 5.0), True, view.leg_mm)
    found = dots.dot_at_end(view, leg)
    return None if found is None else math.dist(found, centre)


@pytest.mark.parametrize("width_mm", [0.3, 0.5, 0.8])
@pytest.mark.parametrize("widths", [2.0, 3.0, 8.0])
def test_the_middle_of_a_dot_at_which_a_line_ends(widths: float, width_mm: float) -> None:
    off_mm = at_end(widths * width_mm, width_mm)
    assert off_mm is not None and off_mm < WITHIN_MM


def test_a_dot_beside_the_line_s_own_end_is_drilled_in_its_middle_too() -> None:
    off_mm = at_end(2.0, centre=(24.0, 12.2))
    assert off_mm is not None and off_mm < WITHIN_MM


@pytest.mark.parametrize("across_mm", [0.5, 0.7, 7.0])
def test_the_pen_s_own_end_and_a_patch_are_no_dots(across_mm: float) -> None:
    assert at_end(across_mm) is None


def test_a_speck_of_paper_in_a_dot_is_no_line_that_leaves_it() -> None:
    drawing = inked(LINE, seed=5, specks=[dot(AT, 1.8)])
    row, column = (
        int(drawing.darkness.shape[0] - 12.6 / drawing.pitch_mm),
        int(24.4 / drawing.pitch_mm),
    )
    drawing.darkness[row - 1 : row + 1, column - 1 : column + 1] = 0.0
    view = seen(drawing)
    leg = leg_of(view.feel(np.array([20.0, 12.0]), 0.0, 5.0), True, view.leg_mm)
    found = dots.dot_at_end(view, leg)
    assert found is not None and math.dist(found, AT) < WITHIN_MM


@pytest.mark.parametrize("across_mm", [0.5, 0.9, 1.8, 3.0, 5.0])
@pytest.mark.parametrize("beyond_mm", [0.0, 8.0])
def test_no_place_about_which_there_is_a_round_is_passed_over(
    across_mm: float, beyond_mm: float
) -> None:
    line = polyline((4, 12), (24 + beyond_mm, 12))
    view = seen(inked(line, seed=5, specks=[dot((24.0, 12.2), across_mm)]))
    leg = leg_of(view.feel(np.array([20.0, 12.0]), 0.0, 5.0), True, view.leg_mm)
    rounds, inked_mm = list[float](), list[float]()
    for along_mm in (dots.AHEAD * view.width_mm).tolist():
        if not view.dark(leg.at(along_mm)):
            break
        inked_mm.append(along_mm)
        if dots._disc(view, leg.at(along_mm)) is not None:
            rounds.append(along_mm)
    told = [along_mm for along_mm, _ in dots._rounds_ahead(view, leg)]
    assert set(rounds) <= set(told) <= set(inked_mm)
    assert across_mm > 0.5 or len(told) <= 1  # a plain line: nearly nowhere


def test_a_line_goes_on_from_a_dot_only_along_its_heading() -> None:
    turned = inked(polyline((4, 12), AT, (24, 20)), seed=5, specks=[dot(AT, 1.8)])
    through = inked(polyline((4, 12), (34, 12)), seed=5, specks=[dot(AT, 1.8)])
    along = np.array([1.0, 0.0])
    assert dots.disc(seen(turned), np.array(AT), along) is None
    found = dots.disc(seen(through), np.array(AT), along)
    assert found is not None and math.dist(found, AT) < WITHIN_MM


def test_dots_alone_on_the_paper_are_found_and_rings_squares_and_blots_are_not() -> None:
    square = np.array([[30.0, 5], [32, 5], [32, 7], [30, 7]])
    drawing = inked(
        LINE, arc((10, 5), 1.2), seed=5, specks=[dot((16, 6), 1.6), dot((22, 5), 3.0), square]
    )
    found = sorted(tuple(centre) for _, centre in dots.alone(Sheet.of(drawing), seen(drawing)))
    assert len(found) == 2
    assert [
        math.dist(a, b) < WITHIN_MM for a, b in zip(found, [(16, 6), (22, 5)], strict=True)
    ] == [
        True,
        True,
    ]


def test_a_line_goes_on_through_a_dot_where_it_came_in() -> None:
    """The dot is no spike to be gone round: the way through it is as straight as elsewhere."""
    for width_mm in (0.3, 0.8):
        drawing = inked(
            arc((16, 16), 10), width_mm=width_mm, seed=5, specks=[dot((26, 16), 2.4 * width_mm)]
        )
        line = trace(drawing).lines[0]
        away_mm = np.abs(np.hypot(*(line.xy_mm - 16).T) - 10)
        assert [mark.kind for mark in line.marks] == ["dot"] and away_mm.max() < 4 * WITHIN_MM


@pytest.mark.parametrize("seed", [1, 44])
def test_a_dot_soon_after_a_corner_is_no_tangle_with_it(seed: int) -> None:
    """The pen's width does not explain a dot: drawn with strokes the way went 0.8 mm to and fro in the first,
    past its edge in the second.
    """
    rng = np.random.default_rng(seed)
    width_mm, turn = rng.choice([0.5, 0.8]), math.radians(rng.uniform(60, 140))
    gap_mm, radius_mm = rng.uniform(2.9, 5.4) * width_mm, rng.uniform(0.95, 2.0) * width_mm
    way, vertex = np.array([math.cos(turn), math.sin(turn)]), np.array([20.0, 12.0])
    centre = vertex + (radius_mm + gap_mm) * way
    corner = np.array([[4.0, 12.0], vertex, vertex + 16 * way])
    drawing = inked(
        corner,
        width_mm=float(width_mm),
        seed=seed,
        specks=[dot((centre[0], centre[1]), 2 * radius_mm)],
    )
    line = trace(drawing).lines[0]
    assert distance(line.xy_mm[::4], corner).path_to_reference.max_mm < 100 * UM
    assert [mark.kind for mark in line.marks] == ["dot"]
    assert math.dist(line.marks[0].place_mm, centre) < 50 * UM
