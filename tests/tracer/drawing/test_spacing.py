"""How far apart edges are: the nearest two of many, at any distance up to the one that is asked for.

Broken on purpose, with a part of the distance left out, or all but the first, the test fails.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from morfax.motion.arrays import Array
from morfax.tracer.drawing.sharpening import Edge
from morfax.tracer.drawing.spacing import nearest_px


def square(left: float, top: float) -> Edge:
    """The edge of a square of 20 pixels, its corners put back."""
    corners = np.array([[0, 0], [20, 0], [20, 20], [0, 20], [0, 0.0]])
    outline: Array = corners + np.array([top, left])
    return Edge(outline, np.arange(4))


@pytest.mark.parametrize("apart_px", [1.0, 3.0, 6.0, 11.0, 13.0])
def test_the_nearest_edges_are_found_within_what_is_asked(apart_px: float) -> None:
    """Of three squares, two so far apart and the third further away; none within twelve pixels is near."""
    squares = [square(0, 0), square(20 + apart_px, 0), square(0, 20 + 1.5 * apart_px)]
    found = nearest_px(squares, 12.0)
    assert found == (pytest.approx(apart_px) if apart_px < 12 else math.inf)
