"""The felt pen: half the width, softness and darkness of the pen that drew a line, and the noise about it.

Pixels beside clean, straight places of a line show how its ink fades. The pen is that whose ink is most like
them; what is left is noise. It is a pen of one line, where the noise of a drawing (see `drawing.noise`) is
that of most of its ink, and its softness that of what is felt.

Signals: pixels beside a line, their distance from it and darkness, in; the pen out.

Source: our own.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from morfax.motion.arrays import Array
from morfax.tracer.tangles import pen
from morfax.tracer.tangles.least_squares import fitted
from morfax.tracer.tangles.seen_ink import STEPS, SeenInk

FAR = 1.25  # widths from a line, the ink is another line's; chosen
PAPER_FROM = 1.0  # widths from a line there is paper
DEVIATIONS = 1.4826  # of a normal distribution, to the median of what it strays


class FeltPen(NamedTuple):
    """Half the width of a line and its softness, mm; the darkness of paper and of ink; and the standard
    deviation of what they leave from pixel to pixel, in shares of the ink's darkness.
    """

    half_mm: float
    softness_mm: float
    paper: float
    ink: float
    noise: float

    @classmethod
    def of(cls, away_mm: Array, seen: SeenInk) -> FeltPen:
        """The pen that explains the ink at places that are so far (n,) from a clean line."""
        dark, drawn = seen.darkness, np.empty(len(away_mm))
        paper = float(np.median(dark[away_mm > PAPER_FROM * seen.width_mm]))

        def wrong(figures: Array) -> Array:
            half_mm, softness_mm, ink = figures.tolist()
            pen.ink(away_mm, half_mm, abs(softness_mm), drawn)
            return paper + (ink - paper) * drawn - dark

        figures = fitted(wrong, np.array([seen.half_mm, seen.softness_mm, 1.0]), STEPS)
        half_mm, softness_mm, ink = figures.tolist()
        left = wrong(figures) / (ink - paper)
        noise = DEVIATIONS * float(np.median(np.abs(left - np.median(left))))
        return cls(half_mm, abs(softness_mm), paper, ink, noise)

    def sees(self, seen: SeenInk) -> SeenInk:
        """The same ink as this pen's: 0 for its paper, 1 for its ink."""
        return seen._replace(
            darkness=(seen.darkness - self.paper) / (self.ink - self.paper),
            half_mm=self.half_mm,
            softness_mm=self.softness_mm,
            noise=len(seen.darkness) * self.noise**2,
        )
