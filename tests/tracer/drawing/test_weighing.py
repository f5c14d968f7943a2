"""Weighing: lines nearly of one length keep their order at any size, angle and resolution.

Broken on purpose, with `ROUND` 0, or lengths by area, tests here fail.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from morfax.motion.polyline import length_mm
from morfax.tracer.drawing.strokes import Sheet
from morfax.tracer.program.lines import selection
from tests.tracer.inked import WIDTH_MM, Points, arc, inked

MIDDLE_MM = np.array([30.0, 30.0])


def star(length: float, corners: int = 5) -> Points:
    """A star of a length about zero, mm."""
    turns = np.arange(2 * corners + 1) * math.pi / corners
    radius = np.where(np.arange(len(turns)) % 2, 0.65, 1.0)
    places = np.column_stack([radius * np.cos(turns), radius * np.sin(turns)])
    return np.asarray(places * length / length_mm(places), float)


def open_arc(length: float) -> Points:
    """Half a circle and more of a length about zero, mm."""
    places = arc((0.0, 0.0), 1.0, 0.0, 250.0)
    return np.asarray(places * length / length_mm(places), float)


LINES = [
    np.array([-14.0, -12.0]) + star(23.2),
    np.array([13.0, 10.0]) + open_arc(22.2),
    np.array([-12.0, 13.0]) + arc((0.0, 0.0), 21.2 / math.tau),
    np.array([14.0, -13.0]) + open_arc(20.3),
]


def order(times: float, angle_deg: float, dpi: float) -> list[int]:
    """The lines by their numbers on a scan of a size, angle and resolution."""
    turn = math.radians(angle_deg)
    turned = np.array([[math.cos(turn), math.sin(turn)], [-math.sin(turn), math.cos(turn)]])
    lines = [times * (line @ turned + MIDDLE_MM) for line in LINES]
    sheet = Sheet.of(
        inked(*lines, width_mm=times * WIDTH_MM, dpi=dpi, seed=round(dpi + angle_deg))
    )
    places = [sheet.stroke(int(patch)).middles_mm for patch in selection.lines_of(sheet)]
    return [
        int(np.argmin([np.hypot(*(line - middles[0]).T).min() for line in lines]))
        for middles in places
    ]


@pytest.mark.parametrize("dpi", [200.0, 300.0, 600.0])
@pytest.mark.parametrize(
    ("times", "angle_deg"), [(1.0, 0.0), (0.75, 20.0), (1.4, 45.0), (1.0, 77.0)]
)
def test_lines_that_differ_by_4_percent_have_the_same_numbers(
    times: float, angle_deg: float, dpi: float
) -> None:
    assert order(times, angle_deg, dpi) == [0, 1, 2, 3]


def test_weights_are_the_lengths_of_round_lines_within_1_percent() -> None:
    sheet = Sheet.of(inked(*(line + MIDDLE_MM for line in LINES), dpi=200.0, seed=1))
    by_number = [
        sheet.weights[int(patch)]
        for patch in selection.lines_of(sheet)
        if patch in sheet.weights
    ]
    assert [weight.is_open for weight in by_number] == [False, True, False, True]
    caps_mm2 = [math.pi / 4 * WIDTH_MM**2 * weight.is_open for weight in by_number]
    lengths = np.array(
        [
            (weight.weight_mm2 - caps) / WIDTH_MM
            for weight, caps in zip(by_number, caps_mm2, strict=True)
        ]
    )
    # of the star, pens overlap in ten corners
    assert lengths[1:] / lengths[2] * 21.2 == pytest.approx([22.2, 21.2, 20.3], rel=0.01)


@pytest.mark.parametrize(("second_mm", "count"), [(20.6, 2), (18.0, 0)])
def test_two_lines_are_weighed_where_they_are_nearly_of_one_length(
    second_mm: float, count: int
) -> None:
    rounds = [
        middle + arc((0.0, 0.0), long_mm / math.tau)
        for middle, long_mm in (((12.0, 12.0), 21.2), ((24.0, 12.0), second_mm))
    ]
    sheet = Sheet.of(inked(*rounds, seed=1))
    selection.lines_of(sheet)
    assert len(sheet.weights) == count
