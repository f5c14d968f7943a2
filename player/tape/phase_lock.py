"""Phase lock: the loop of an axis drive, from the phase on the tape to the turning of the lead screw, and how
it is set. It is stepped by drives.py.

Signals: settings in; out the networks of amplifier and integrator, for a motion rate.

    track ─► trigger 152 ─► comparator 153 ─► amplifier 161 ─► integrator 159 ─► motor 163 ─► screw ─┬─►
                             ▲  decoder 158      lead             PI          velocity servo         │
    cell 141 ─► trigger 157 ─┘                                                                       │
       ▲  edges (see sector_wheel)                                                                   │
       └── wheel 115 ◄── motor 116 ◄── reference track              lamp and cell on the arm 118 ◄───┘

The error is the time between the edges of two pulse trains (see comparator); the decoder counts whole cycles,
so it is known over several of them and not over half of one. Beyond its range fault circuit 162 stops the
drive. With e the error in mm, lag T of the motor under its tacho, and s
the complex frequency:

    lead    w = e · (1 + T s) / (1 + s/b)            answers the motor's lag
    PI      u = K (w + a ∫ w dt)                     mm/s, demand to the motor
    motor   x = u / (s (1 + T s))

    loop    s² (1 + s/b) + K (s + a) = 0          type 2: no standing error at rest or at constant speed,
                                                     and at constant acceleration  e = acceleration / (K a)

K, a and b are placed so that the loop has the pair of poles (natural frequency, damping) and a third real one
further out. The placing is done for the stepped loop itself, exactly: with g the motor's gain per period, l =
1 - g, and z the shift by one period,

    (z - 1)² (z - pole) + k (z + 1)(z - zero) = (z - p1)(z - p2)(z - p3),       k = gain · g · dt / 2.

Source: patent ES 361967, figure 5. Questions: the patent gives neither the networks nor a figure. Chosen: no
path from the tape's speed round the comparator (feed-forward is not in the patent); natural frequency 250 Hz,
damping 1, third pole at 500 Hz: a stop with 0.5 m/s² to 0.5 um, a phase margin of 49 degrees. Twice as fast
would follow noise of 26 dB up to the motor's limit. Without the lead in amplifier 161 a loop beyond about 70
Hz round a motor of 1 ms cannot be damped. While the motor's current is at its limit the integrator goes back
to what that gives, else it would run on and the screw far past; in half a millisecond and not at once, else
noise that meets the limit on one side only would push the screw off the tape. The decoder's range is 4 cycles
(0.2 mm): a start or stop from 40 mm/s at once is still followed, more is a fault (off a tape 34 mm/s at once
can be counted, see `rehearsal`). That range is one limit for all speeds; below it `following_limit` allows
what a sound drive needs at the tape's speed.
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass, replace

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.drive import Drive

BACK_S = 0.5e-3  # a third of the way in a period of 6 kHz
STEPS_PER_PERIOD = 20.0  # of the natural frequency, at a low motion rate
FEWEST_STEPS = 10.0  # per natural period

# A DC motor of 3 000/min on a screw of 5 mm.
ELECTRIC = Drive(top_speed_mm_s=250.0)
# A motor of 20 cm³/rev on the same screw: 9 MPa over it are 29 N m, on 4 g m² of screw and table 7 200
# rad/s². A servo valve of 40 l/min turns it 2 000/min, and is itself a lag of some ms (W. J. Thayer, Transfer
# Functions for Moog Servovalves, 1958).
HYDRAULIC = Drive(lag_s=0.003, acceleration_mm_s2=5700.0, top_speed_mm_s=167.0)


@dataclass(frozen=True, slots=True)
class PhaseLock:
    """Settings of an axis drive; `third_pole` is the real pole over the natural frequency."""

    natural_hz: float = 250.0
    damping: float = 1.0
    third_pole: float = 2.0
    range_cycles: float = 4.0
    drive: Drive = ELECTRIC

    def suited_to(self, rate_hz: float) -> PhaseLock:
        """The settings for a motion rate: at a low one the loop is slower, 20 steps to a natural period."""
        return replace(self, natural_hz=min(self.natural_hz, rate_hz / STEPS_PER_PERIOD))

    def poles(self, dt_s: float) -> Array:
        """The three poles of the stepped loop."""
        natural = 2 * math.pi * self.natural_hz * dt_s
        pair = natural * (-self.damping + 1j * cmath.sqrt(1 - self.damping**2))
        other = natural * (-self.damping - 1j * cmath.sqrt(1 - self.damping**2))
        return np.exp([pair, other, -natural * self.third_pole])


# The spring of 40 cm³ of oil (1.4 GPa) under that motor swings at 95 Hz. It is not simulated; the loop stays
# below it.
MOTORS = {"electric": PhaseLock(), "hydraulic": PhaseLock(natural_hz=60.0, drive=HYDRAULIC)}


@dataclass(frozen=True, slots=True)
class Network:
    """Amplifier 161 and integrator 159, stepped: gain in mm/s per mm, lead (zero, pole), zero of the PI."""

    gain: float
    zero: float
    lead_zero: float
    lead_pole: float


def place(settings: PhaseLock, dt_s: float) -> Network:
    """Solve the loop equation for these poles; raises ValueError if the motion rate is too low."""
    if not 0 < settings.natural_hz * dt_s * FEWEST_STEPS <= 1:
        raise ValueError(
            f"a loop of {settings.natural_hz:g} Hz cannot be stepped at {1 / dt_s:g} Hz; "
            f"give more than 0 and at most {1 / dt_s / FEWEST_STEPS:g} Hz"
        )
    one, a2, a1, a0 = np.poly(settings.poles(dt_s)).real
    g = settings.drive.gain(dt_s)
    lead_pole = -1 - (-one + a2 - a1 + a0) / 4
    k = a2 + 2 + lead_pole
    zero = 1 - (one + a2 + a1 + a0) / (2 * k)
    return Network(2 * k / (g * dt_s), zero, 1 - g, lead_pole)
