"""The grey values of a line, for tests of images."""

from __future__ import annotations

import numpy as np
import pytest

from tests.tracer.drawing.images import LINE, Grey
from tests.tracer.inked import inked


@pytest.fixture(scope="module")
def grey() -> Grey:
    """Grey values of a line of 0.5 mm on white paper."""
    return np.round(255 - 215 * inked(LINE).darkness).astype(np.uint8)
