"""Gouges: a cutter's middle that comes nearer to a line than its radius."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.motion.faults import MotionFault
from morfax.motion.motion import Motion
from morfax.motion.polyline import Nearest
from morfax.tracer.cutter.gouges import refuse_gouges

LINE = np.array([[0.0, 0.0], [40.0, 0.0]])


def beside(away_mm: float, z_mm: float) -> list[Motion]:
    """A run along the line, at a distance from it."""
    x_mm = np.linspace(0, 40, 400)
    return [Motion(np.column_stack([x_mm, 0 * x_mm + away_mm, 0 * x_mm + z_mm]), 6000.0, 0.0)]


@pytest.mark.parametrize("too_near_mm", [0.01, 0.1, 0.4])
def test_a_cutter_nearer_than_its_radius_is_refused(too_near_mm: float) -> None:
    near = Nearest([LINE], 3.0)
    refuse_gouges(iter(beside(3.0, -1.0)), near, 6.0)
    refuse_gouges(iter(beside(3.0 - too_near_mm, 2.0)), near, 6.0)  # above the work
    refuse_gouges(iter(beside(3.0 - too_near_mm, 0.01)), near, 6.0)  # and hardly above it
    with pytest.raises(MotionFault, match="would cut into the part at"):
        refuse_gouges(iter(beside(3.0 - too_near_mm, -1.0)), near, 6.0)
