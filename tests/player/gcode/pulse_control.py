"""Programs under the pulse control, and how often it recirculates."""

from __future__ import annotations

from morfax.motion.motion import MOTION_RATE_HZ
from morfax.player.gcode.pulses import PulseControl, PulsePlayback
from morfax.player.gcode.rs274 import parse_rs274

RECIRCULATIONS_HZ = 8 * MOTION_RATE_HZ


def playback(*lines: str, control: PulseControl | None = None) -> PulsePlayback:
    return PulsePlayback(parse_rs274([*lines, "M2"]), control or PulseControl())
