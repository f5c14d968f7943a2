"""Legs of corners of an edge: the straight line and the parabola through their places.

Broken on purpose, with the skew or the spread left out of the parabola, the test here fails.
"""

from __future__ import annotations

import numpy as np
import pytest
from numpy.polynomial import polynomial

from morfax.tracer.drawing.edge_leg import fitted


@pytest.mark.parametrize("count", [4, 60])
def test_a_leg_is_fitted_by_least_squares(count: int) -> None:
    """As a general fit has it, far from the origin and unevenly spaced as well."""
    random = np.random.default_rng(count)
    u = 30 + np.sort(random.uniform(0, 20, count)) ** 2
    v = 0.02 * u**2 + random.normal(size=count)
    straight, bent = fitted(u, v)
    assert straight == pytest.approx(polynomial.polyfit(u, v, 1), rel=1e-9)
    assert bent == pytest.approx(polynomial.polyfit(u, v, 2), rel=1e-6)
