"""Parts that are written for several machines."""

from __future__ import annotations

import math

import numpy as np

from morfax.motion.motion import Path as MotionPath

CORNERS_MM = [(10, 10), (40, 10), (40, 30), (10, 30), (10, 10)]


def part() -> MotionPath:
    """A square with one round corner and a hole drilled in two pecks, cut 3 mm deep at 10 mm/s, "
    "plunged at 4."""
    turn = np.linspace(math.pi, math.pi / 2, 40)
    rounded = np.column_stack([15 + 5 * np.cos(turn), 25 + 5 * np.sin(turn)])
    around = np.vstack(
        [CORNERS_MM[0], CORNERS_MM[1], CORNERS_MM[2], rounded[::-1], CORNERS_MM[0]]
    )
    cut = [(x, y, -3.0) for x, y in around]
    hole = [(25.0, 20.0, z) for z in (2.0, -2.0, 2.0, -4.0, 2.0)]
    points = np.array([(10, 10, 2.0), *cut, (10, 10, 2.0), *hole])
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    across = np.abs(np.diff(points[:, :2], axis=0)).max(axis=1) > 0
    return MotionPath(np.r_[0.0, np.cumsum(steps / np.where(across, 10.0, 4.0))], points)
