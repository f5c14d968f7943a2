"""A circle on a tape, and its rate."""

import numpy as np

from morfax.motion.motion import Motion

RATE_HZ = 6000


def circle(turns: float = 0.2, z_mm: float = -2.0, blocks: int = 1) -> list[Motion]:
    """Part of a circle of 10 mm radius at 10 mm/s that starts and ends gently."""
    samples = round(2 * np.pi * turns * RATE_HZ)
    share = np.linspace(0, 1, samples)
    angle = 2 * np.pi * turns * (10 * share**3 - 15 * share**4 + 6 * share**5)
    positions = np.column_stack(
        [40 + 10 * np.cos(angle), 20 + 10 * np.sin(angle), np.full(samples, z_mm)]
    )
    return [Motion(part, RATE_HZ) for part in np.array_split(positions, blocks)]
