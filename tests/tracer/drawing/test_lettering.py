"""Lettering: words, numbers of two figures beside them, and holes that are neither."""

from __future__ import annotations

import numpy as np

from morfax.tracer.drawing.lettering import lettering
from morfax.tracer.drawing.strokes import Sheet
from tests.tracer.inked import Points, arc, inked, polyline

HIGH = 4.0  # mm
FRAME = polyline((4, 4), (44, 4), (44, 30), (4, 30), (4, 4))


def word(x: float, y: float) -> list[Points]:
    """LVI, 4 mm high."""
    return [
        polyline((x, y + HIGH), (x, y), (x + 2, y)),
        polyline((x + 4, y + HIGH), (x + 5, y), (x + 6, y + HIGH)),
        polyline((x + 8, y), (x + 8, y + HIGH)),
    ]


def number(x: float, y: float, high: float) -> list[Points]:
    """70, its 0 half as wide as high."""
    zero = arc((0, 0), high / 2) * (0.55, 1.0) + (x + 5, y + high / 2)
    return [polyline((x, y + high), (x + 2.2, y + high), (x + 1, y)), zero]


def lettered(*lines: Points) -> list[float]:
    """Where the letters of a drawing begin, mm from the left."""
    sheet = Sheet.of(inked(FRAME, *lines, width_mm=0.35, seed=1))
    left_mm = [
        float(sheet.patches.boxes[patch, 2]) * sheet.drawing.pitch_mm
        for patch in lettering(sheet)
    ]
    return np.sort(left_mm).round(1).tolist()


def test_a_number_of_two_figures_is_lettering_where_a_word_is_as_high() -> None:
    found = lettered(*word(8, 8), *number(30, 20, HIGH))
    assert np.allclose(found, [7.8, 11.8, 15.8, 29.8, 33.7], atol=0.2)


def test_two_figures_alone_or_of_another_height_are_lines() -> None:
    assert lettered(*number(30, 20, HIGH)) == []
    assert len(lettered(*word(8, 8), *number(28, 18, 6.0))) == 3


def test_two_round_holes_as_high_as_letters_are_no_lettering() -> None:
    holes = [arc((x, 22), HIGH / 2) for x in (30, 36)]
    assert len(lettered(*word(8, 8), *holes)) == 3
