"""Strokes: lines nearly of one length keep their order at any size, angle and resolution.

Broken on purpose, with `ROUND` 0, or lengths by whole pixels, tests here fail.
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
