"""Motion edges: how far any motion that keeps to what the tape tells may lie off what was laid over a gap.

Signals in: rows of phases beside a gap, cycles; the rows laid within it; the bound of the program there
(cycles/row², cycles/row). Signals out: the upper edge of all such motions, and the furthest that any of them
lies off the way laid, cycles.

    p      ___                  upper edge, at each t: the highest place from which one can still arrive
      0 __/   \\__ 1             speed s there, with  L(s) from the left and R(s) from the right:
        \\__ __/                    L(s) = p0 + v0 t + A t²/2 - (v0 + A t - s)² / 4A
           ‾                     R(s) the same, back from p1;  the highest of min(L, R), where L(s) = R(s)

The ends may be taken so close to the gap that the bound itself says how wrong they are. A straight line
through n rows tells the place and the speed in their middle, of any motion of acceleration A at most, within

    place   A n² / 24 + e_p           speed   3 A n / 16 + e_v        e: by noise, three standard deviations

(the speed is furthest off where the acceleration turns over in the middle). No shape of the motion is taken
for granted: neither that its acceleration is even, nor that it changes once.

Source: motion that keeps to an acceleration is quickest with all of it, one way and then the other (A. E.
Bryson and Y.-C. Ho, Applied Optimal Control, 1975, section 3.9); both errors are the integrals of the line's
weights over such a motion.
Questions: none.
"""

from __future__ import annotations

import numpy as np

from morfax.motion.arrays import NOT_ZERO, Array

# 1.5 ms at 6 kHz, odd: the band filter spans eight, so that fewer tell a speed no better
END_ROWS = 9
# of six standard deviations of a row: rows within a filter's span are noisy together
PLACE_NOISE = 1 / 2


def upper_edge(ends: Array, rows: int, acceleration: float, speed: float) -> Array:
    """The upper edge of all motions between two ends (place, speed, place, speed) at the rows between."""
    p0, v0, p1, v1 = ends.tolist()
    # at least what the two ends ask for as they were measured, with their noise
    swerve = p1 - p0 - rows * (v0 + v1) / 2
    asked = abs(v1 - v0) / rows + 4 * abs(swerve) / rows**2
    most = max(acceleration, asked, NOT_ZERO)
    t = np.arange(1, rows)
    left = rows - t
    # 1. the fastest that it may be going, and how high it is then: from the left, and back from the right
    s0, s1 = v0 + most * t, v1 - most * left
    top0 = p0 + v0 * t + most * t**2 / 2
    top1 = p1 - v1 * left + most * left**2 / 2
    # 2. the speed at which both are as high
    apart = np.maximum(s0 - s1, NOT_ZERO)
    s = (s0**2 - s1**2 - 4 * most * (top0 - top1)) / (2 * apart)
    s = np.clip(s, np.minimum(s0, s1), np.maximum(s0, s1))
    from_left = top0 - (s - s0) ** 2 / (4 * most)
    from_right = top1 - (s - s1) ** 2 / (4 * most)
    edge = np.minimum(from_left, from_right)
    # 3. no faster than the program runs
    fastest = np.minimum(p0 + speed * t, p1 + speed * left)
    return np.asarray(np.minimum(edge, fastest))


def furthest(
    sides: tuple[Array, Array], laid: Array, most: tuple[float, float], noise: float
) -> float:
    """The furthest that a motion may lie off the rows laid over a gap, cycles.

    `sides`: END_ROWS rows before and behind it, counted on; `most`: acceleration and speed of the program;
    `noise`: six standard deviations of a row.
    """
    half = END_ROWS // 2
    numbers = np.arange(END_ROWS) - half
    (p0, v0), (p1, v1) = ((rows.mean(), numbers @ rows / (numbers @ numbers)) for rows in sides)
    place = most[0] * END_ROWS**2 / 24 + PLACE_NOISE * noise
    speed = most[0] * END_ROWS * 3 / 16 + noise / END_ROWS
    ends = np.array([p0, v0, p1, v1])
    off = np.array([place, speed, place, -speed])
    rows = len(laid) + 1 + 2 * half
    within = slice(half, half + len(laid))
    above = upper_edge(ends + off, rows, *most)[within] - laid
    below = upper_edge(off - ends, rows, *most)[within] + laid
    return float(max(np.abs(above).max(initial=0.0), np.abs(below).max(initial=0.0)))
