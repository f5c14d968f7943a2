"""The speed gauge: how fast each axis of a motion is at most, and whether its track stays in its band.

Signals in: positions of the axes (n, axes) mm at the motion rate, block by block. Signals out: the largest
speed of each axis, mm/s; a fault where one leaves the deviation.

    speed = (place - place before) · motion rate          a track deviates by speed · cycles per mm

Source: our own.
"""

from __future__ import annotations

import numpy as np

from morfax.motion.arrays import ROUNDED, Array
from morfax.motion.compiled import njit
from morfax.motion.faults import MotionFault
from morfax.recorder.tape.format import TapeFormat
from morfax.recorder.tape.waiting_rows import ROWS_AT_ONCE


class SpeedGauge:
    """The largest speeds of one tape so far, `largest_mm_s`."""

    def __init__(self, fmt: TapeFormat) -> None:
        self._format = fmt
        self.largest_mm_s = np.zeros(len(fmt.axes))

    def feed(self, positions: Array, before: Array, done: int) -> None:
        """Take positions that come after a place and after so many others; raises MotionFault."""
        fmt = self._format
        most = fmt.largest_speed_mm_s * (1 + ROUNDED)
        rows = np.ascontiguousarray(positions)
        at, axis, speed = _speeds(rows, before, fmt.motion_rate_hz, most, self.largest_mm_s)
        if at >= 0:
            raise _too_fast(fmt, axis, (done + at) / fmt.motion_rate_hz, speed)


@njit(cache=True, nogil=True, _nrt=False)
def widest_moves(along, apart, widest):  # type: ignore[no-untyped-def]
    """Make the widest moves so far those from places to the ones so many behind them, too.

    `along`: places row after row; as many at once as `widest` is long, so that they fill the vectors.
    """
    before, after = along[: max(len(along) - apart, 0)], along[apart:]
    for begin in range(0, len(before), len(widest)):
        come = before[begin : begin + len(widest)]
        gone = after[begin : begin + len(widest)]
        for k in range(len(come)):
            widest[k] = max(widest[k], abs(gone[k] - come[k]))


@njit(cache=True, nogil=True)
def _speeds(positions, last_mm, rate_hz, most_mm_s, largest_mm_s):  # type: ignore[no-untyped-def]
    """Make the largest speeds so far those of positions, too, which come after the last ones.

    Returns row, axis and speed of the first that is above the limit; -1 without any.
    """
    # 1. the largest of all
    places, axes = positions.ravel(), positions.shape[1]
    fastest = np.zeros(ROWS_AT_ONCE * axes)
    widest_moves(places, axes, fastest)
    for axis in range(min(axes, len(places))):
        fastest[axis] = max(fastest[axis], abs(places[axis] - last_mm[axis]))
    fastest *= rate_hz
    if fastest.max() <= most_mm_s:
        for k in range(len(fastest)):
            largest_mm_s[k % axes] = max(largest_mm_s[k % axes], fastest[k])
        return -1, -1, 0.0
    # 2. row by row, if one of them is too fast
    before = last_mm
    for k in range(len(positions)):
        for axis in range(positions.shape[1]):
            speed = (positions[k, axis] - before[axis]) * rate_hz
            if abs(speed) > most_mm_s:
                return k, axis, speed
            largest_mm_s[axis] = max(largest_mm_s[axis], abs(speed))
        before = positions[k]
    return -1, -1, 0.0


def _too_fast(fmt: TapeFormat, axis: int, time_s: float, speed_mm_s: float) -> MotionFault:
    """The fault of a speed at which the track would leave its band."""
    message = (
        f"axis {fmt.axes[axis]} moves at {abs(speed_mm_s):.4g} mm/s at {time_s:.4f} s; this tape "
        "takes at most "
        f"{fmt.largest_speed_mm_s:.4g} mm/s ({fmt.largest_deviation_hz:.4g} Hz of deviation): move "
        "slower there"
    )
    return MotionFault(message, axis=fmt.axes[axis], time_s=time_s, speed_mm_s=speed_mm_s)
