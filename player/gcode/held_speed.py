"""The speed that the pulse control holds, beside the one that is programmed, along the way.

Signals in: a program in the control. Signals out: way in mm, programmed speed (with the override) and the
speed of the command pulses in mm/s, each over a window of 20 ms of a move; dwells have none.

    held = pulse · sqrt(nx² + ny² + nz²) / window

Source: patent from US application 631 214, pages on the functional gating 88: its weights make the resultant
of three axes good to -10.6 … +1.9 %. Questions: at the end of each move the interpolator comes to rest, so
that the last windows of a move are slower.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from morfax.motion.arrays import Array
from morfax.player.gcode.pulses import PulsePlayback

WINDOW_S = 0.02  # over which a speed is measured: twice the time constant of an approach


@dataclass(frozen=True, slots=True)
class HeldSpeed:
    """Way in mm, and the speeds there in mm/s."""

    way_mm: Array
    programmed_mm_s: Array
    held_mm_s: Array


def held_speed(playback: PulsePlayback, true_norm: bool) -> HeldSpeed:
    """Run the interpolator of a program, with the patent's weights or with a true norm."""
    control = replace(playback.settings, true_norm=true_norm)
    window = round(WINDOW_S * control.recirculations_hz)
    ways, asked, held = [0.0], [0.0], [0.0]
    for speed_mm_s, pulses in PulsePlayback(
        playback.program, control, playback.name
    ).run_moves():
        every = np.vstack([np.zeros((0, 3), np.int8), *pulses])
        for first in range(0, len(every), window):
            part = every[first : first + window]
            way_mm = (
                float(np.linalg.norm(part.sum(axis=0, dtype=np.int64))) * control.servo.pulse_mm
            )
            ways.append(ways[-1] + way_mm)
            asked.append(speed_mm_s * control.override)
            held.append(way_mm * control.recirculations_hz / len(part))
    return HeldSpeed(np.array(ways), np.array(asked), np.array(held))
