"""The felt pen: half the width, softness and darkness of the pen that drew a line, and the noise about it.

Pixels beside clean, straight places of a line show how its ink fades. The pen is that whose ink is most like
them; what is left is noise. It is a pen of one line, where the noise of a drawing (see `drawing.noise`) is
that of most of its ink, and its softness that of what is felt.

Signals: pixels beside a line, their distance from it and darkness, in; the pen out.

Source: our own.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.median import ROBUST, median
from morfax.tracer.effort import ROUNDS
from morfax.tracer.tangles import pen
from morfax.tracer.tangles.seen_ink import SeenInk

FAR = 1.25  # widths from a line, the ink is another line's; chosen
PAPER_FROM = 1.0  # widths from a line there is paper
LEAST = 0.1  # of the softness that was felt: the fit's, at the least


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
        dark = seen.darkness
        paper = median(dark[away_mm > PAPER_FROM * seen.width_mm])
        figures = np.array([seen.half_mm, seen.softness_mm, 1.0 - paper])
        for _ in range(ROUNDS):
            wrong, changes = _wrong(away_mm, dark - paper, figures)
            figures -= np.linalg.lstsq(changes, wrong, None)[0]
            figures[1] = max(figures[1], LEAST * seen.softness_mm)
        half_mm, softness_mm, ink = figures.tolist()
        left = _wrong(away_mm, dark - paper, figures)[0] / ink
        noise = ROBUST * median(np.abs(left - median(left)))
        return cls(half_mm, softness_mm, paper, paper + ink, noise)

    def sees(self, seen: SeenInk) -> SeenInk:
        """The same ink as this pen's: 0 for its paper, 1 for its ink."""
        return seen._replace(
            darkness=(seen.darkness - self.paper) / (self.ink - self.paper),
            half_mm=self.half_mm,
            softness_mm=self.softness_mm,
            noise=len(seen.darkness) * self.noise**2,
        )


def _wrong(away_mm: Array, dark: Array, figures: Array) -> tuple[Array, Array]:
    """What a pen of some figures draws too dark at places so far (n,) from its way, and by how much each of
    the figures changes that, (n, 3).
    """
    half_mm, softness_mm, ink = figures.tolist()
    drawn = np.empty(len(away_mm))
    pen.ink(away_mm, half_mm, softness_mm, drawn)
    u = (away_mm - half_mm) / softness_mm
    fades = ink * np.exp(-0.5 * u * u) / (math.sqrt(math.tau) * softness_mm)
    return ink * drawn - dark, np.column_stack([fades, fades * u, drawn])
