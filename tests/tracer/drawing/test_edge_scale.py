"""The scale at which the head follows an edge: a short one enlarged, one of large pixels on a smaller one."""

from __future__ import annotations

import math

import numpy as np
import pytest

from morfax.tracer.drawing.drawing import LEAST_RADIUS_MM, MOST_ENLARGED, Drawing
from tests.tracer.inked import arc

PITCH_MM = 0.05


def with_edges(*radii_mm: float) -> Drawing:
    """A sheet with round edges in a row, 20 mm from one to the next."""
    edges = tuple(arc((10.0 + 20 * k, 10.0), radius) for k, radius in enumerate(radii_mm))
    return Drawing(np.zeros((400, 1600), np.float32), PITCH_MM, edges_mm=edges)


@pytest.mark.parametrize("times", [1.5, 2.5, 3.5])
def test_an_edge_that_bends_too_tightly_is_enlarged_until_it_does_not(times: float) -> None:
    """By a whole number: its own radius is that of a circle as long."""
    sheet = with_edges(LEAST_RADIUS_MM / times, 8.0)
    assert sheet.times_at(np.array([10.0, 10.0])) == min(math.ceil(times), MOST_ENLARGED)
    # each edge by itself
    assert sheet.times_at(np.array([38.0, 10.0])) <= 1.0


def test_no_edge_is_enlarged_by_more_than_the_most() -> None:
    assert with_edges(LEAST_RADIUS_MM / 1000).times_at(np.array([10.0, 10.0])) == MOST_ENLARGED


def test_a_drawing_of_lines_is_followed_as_it_is() -> None:
    assert with_edges().times_at(np.array([10.0, 10.0])) == 1.0
