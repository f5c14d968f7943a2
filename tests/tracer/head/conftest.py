"""A line, and the precise head tuned to it, for tests of the head's parts."""

from __future__ import annotations

import pytest

from morfax.motion.motion import MOTION_RATE_HZ
from morfax.tracer.head.settings import Settings
from morfax.tracer.head.stance import Stance
from morfax.tracer.head.state import Tuning
from morfax.tracer.head.tuning import tune
from morfax.tracer.sensing.photocell import behind_aperture
from morfax.tracer.sensing.view import View
from tests.tracer.head.heads import PLACE
from tests.tracer.inked import inked, polyline


@pytest.fixture(scope="module")
def seen() -> View:
    """A straight line along y = 8 mm."""
    cells = behind_aperture(inked(polyline((4, 8), (24, 8))), 0.15)
    return View(cells, 0.5)


@pytest.fixture(scope="module")
def tuning(seen: View) -> Tuning:
    """The precise head's, on that line."""
    return tune(Stance(PLACE, 0.0, seen), Settings(), MOTION_RATE_HZ)
