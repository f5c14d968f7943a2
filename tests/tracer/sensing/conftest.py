"""A line of known width, for the tests of the photocells."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.tracer.drawing.drawing import Drawing
from tests.tracer.sensing.kernels import FINE_MM, WIDE_MM


@pytest.fixture(scope="module")
def strip() -> Drawing:
    """A line of 0.7 mm along X through the middle of a strip of 6 mm, in pixels of 5 um."""
    y = (np.arange(1200) + 0.5) * FINE_MM - 3.0
    return Drawing(
        np.repeat((np.abs(y) < WIDE_MM / 2)[:, None], 240, axis=1).astype(np.float32), FINE_MM
    )
