"""The kinds of pick-up: the wave that each makes of the turning of a screw, and the travel of one cycle.

Signals: none of their own; carrier.py makes the samples by what stands here. With phi the phase of the track,
f its frequency now and r = exp(-2 pi · gap / pitch of the teeth), each is a sum of odd harmonics:

    resolver    sin phi                                                        sine
    photocell   sum of sin(n phi) / n                    = pi/4 · sign(sin phi)    square: light or dark
    scale       sum of (-1)^k sin(n phi) / n²            = pi/4 · (phi to the nearest node)   triangle, n=2k+1
    hall        sum of r^(n-1) sin(n phi) / n            = arctan(2 r sin phi / (1 - r²)) / 2 r
    coil        f / reference · sum of (-1)^k r^(n-1) sin(n phi)    = f / reference · slope of Hall's flux

so that the fundamental of all has the level of the tape at standstill, and the phase of all is that of the
sine. Teeth as wide as their gaps make no even harmonics. A field falls off from the teeth by r^n for each
harmonic, so at a gap of a quarter of the pitch little more than the fundamental is left (r = 0.21), of which
a coil gives the rate of change: the faster the teeth pass, the stronger. A grating as wide as the gaps of a
scale uncovers them in proportion: a triangle.

Source: patent ES 361967, lines 471 to 507 (sector wheel and photocell, magnetic wheel and coil, a toothed
member along the slide, Hall effect, resolvers). Field of a toothed rack: Laplace's equation over a periodic
boundary. Questions: the patent gives no figures. Chosen: on a screw of 5 mm pitch 100 sectors, teeth or pole
pairs; a scale of 0.1 mm. The reference track is that of the source 142 itself and a sine whatever the
pick-ups are.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from morfax.motion.axis import LeadScrew

GAP_SHARE = 0.25  # air gap over the pitch of the teeth
# r: how much weaker the field of each further harmonic is
DECAY = math.exp(-2 * math.pi * GAP_SHARE)
SCALE_PITCH_MM = 0.1  # of a scale along the slide; chosen here

SCREW = LeadScrew()


@dataclass(frozen=True, slots=True)
class Sensor:
    """A kind of pick-up; `harmonic(n, k)`: amplitude of harmonic n = 2 k + 1 against the fundamental.

    `largest`: the most that a sample can be where the fundamental is 1. `by_speed`: whether the amplitude
    grows with the frequency of the track. `flat`: whether the top is flat, so that clipping cannot be told
    from it.
    """

    what: str
    travel: str
    cycles_per_mm: float
    harmonic: Callable[[int, int], float]
    largest: float = 1.0
    by_speed: bool = False
    flat: bool = False

    @property
    def is_sine(self) -> bool:
        """Whether the wave is a plain sine of constant amplitude."""
        return not self.by_speed and self.harmonic(3, 1) == 0

    def amplitudes(self, count: int) -> NDArray[np.float64]:
        """Amplitudes of the first odd harmonics, 1, 3, 5 …, against the fundamental."""
        return np.array([self.harmonic(2 * k + 1, k) for k in range(max(count, 1))])

    def fundamental_share(self, reference_hz: float, sample_rate_hz: float) -> float:
        """Share of the fundamental in the power at standstill, on a tape of this sample rate."""
        amplitudes = self.amplitudes(int((sample_rate_hz / 2 / reference_hz + 1) / 2))
        return float(1 / np.square(amplitudes).sum())


_WHEEL = "screw of 5 mm over 100"
PICK_UPS: dict[str, Sensor] = {
    "resolver": Sensor(
        "resolver", f"{_WHEEL} pole pairs", SCREW.cycles_per_mm, lambda n, k: float(n == 1)
    ),
    "photocell": Sensor(
        "sector wheel and photocell",
        f"{_WHEEL} sectors",
        SCREW.cycles_per_mm,
        lambda n, k: 1 / n,
        flat=True,
    ),
    "coil": Sensor(
        "toothed magnetic wheel and coil",
        f"{_WHEEL} teeth",
        SCREW.cycles_per_mm,
        lambda n, k: (-1) ** k * DECAY ** (n - 1),
        largest=4 / 3 / (1 - DECAY**2),  # at the largest deviation, a third of the reference
        by_speed=True,
    ),
    "hall": Sensor(
        "toothed magnetic wheel and Hall cell",
        f"{_WHEEL} teeth",
        SCREW.cycles_per_mm,
        lambda n, k: DECAY ** (n - 1) / n,
    ),
    "scale": Sensor(
        "toothed scale along the slide",
        "pitch of 0.1 mm",
        1 / SCALE_PITCH_MM,
        lambda n, k: (-1) ** k / n**2,
        math.pi**2 / 8,
    ),
}
DEFAULT_PICK_UP = "resolver"
