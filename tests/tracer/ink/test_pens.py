"""The width of a sheet's pen, which tells ink that two lines share, and sheets of pens of several widths."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest

from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.head.settings import Settings
from morfax.tracer.ink.left_out import ink_left
from morfax.tracer.ink.solving import solved
from morfax.tracer.ink.stretches import FeltSheet
from morfax.tracer.ink.swelling import Swelling, pen_of_hollow
from tests.tracer.inked import WIDTH_MM, inked, polyline, together

CLEAR = polyline((5, 40), (55, 40))  # a line by itself


def felt_of(drawing: Drawing) -> FeltSheet:
    """All the ink of a drawing as it is felt."""
    left = ink_left(drawing.sheet)
    return FeltSheet.of(left.drawing, Settings(), left.ink)


def test_broad_lines_among_those_of_pens_of_several_widths_are_one_line_each() -> None:
    """One of them swells by a tenth, once to either side; thin lines cross all, so that all is one patch."""
    even = [(polyline((5, y), (55, y)), 1.6 * WIDTH_MM) for y in (12, 16)]
    swells = [
        (polyline((a, 20), (b, 20)), (1.7 + 0.1 * math.sin((a - 5) / 8)) * WIDTH_MM)
        for a, b in itertools.pairwise(np.linspace(5, 55, 201).tolist())
    ]
    thin = [(polyline((x, 8), (x, 24)), WIDTH_MM) for x in (8, 52)]
    felt = felt_of(together(*even, *swells, *thin, (CLEAR, WIDTH_MM), seed=1))
    assert not felt.doubled.stations


def test_lines_of_a_second_pen_that_swell_a_little_are_one_line_each() -> None:
    """As the outlines of a colouring page, which all swell a little; thin lines end on them, and some that
    narrow in their middle look like lines that cross.
    """
    along = list(itertools.pairwise(np.linspace(5, 55, 201).tolist()))
    broad = [
        (polyline((a, y), (b, y)), (1.4 + 0.04 * math.sin(a)) * WIDTH_MM)
        for y in (10, 26)
        for a, b in along
    ]
    tapered = [
        (polyline((x, 18 + 8 * a), (x, 18 + 8 * b)), (1 + 0.5 * abs(a)) * WIDTH_MM)
        for x in (21, 39)
        for a, b in itertools.pairwise(np.linspace(-1, 1, 81).tolist())
    ]
    thin = [(polyline((x, 10), (x + 1, 26)), WIDTH_MM) for x in (9, 15, 27, 33, 45, 51)]
    felt = felt_of(together(*broad, *tapered, *thin, (CLEAR, WIDTH_MM), seed=1))
    solved(felt)
    level = {n for n, run in enumerate(felt.felt) if np.ptp(run.places_mm[:, 1]) < WIDTH_MM}
    assert felt.doubled.second_mm == pytest.approx(1.4 * WIDTH_MM, rel=0.1)
    assert not level & {*felt.doubled.stations, *felt.together}


def test_a_band_that_is_paler_in_its_middle_tells_no_pen() -> None:
    """As the shadow round a sheet in a picture: too broad to be two lines whose ink runs together."""
    rims = [polyline((5, y), (55, y)) for y in (20 + 1.6 * WIDTH_MM, 20 - 1.6 * WIDTH_MM)]
    drawing = inked(*rims, CLEAR, seed=1)
    pitch_mm, darkness = drawing.pitch_mm, drawing.darkness.copy()
    top, bottom = (len(darkness) - round(y / pitch_mm) for y in (20.8, 19.2))
    darkness[top:bottom, round(5 / pitch_mm) : round(55 / pitch_mm)] = 0.7
    felt = felt_of(Drawing(darkness, pitch_mm))
    found = [Swelling.of(run, ends) for run, ends in zip(felt.felt, felt.ends, strict=True)]
    assert math.isnan(pen_of_hollow([each for each in found if each is not None]))
