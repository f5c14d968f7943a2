"""What is usual of machines and tapes, where nobody has set it: plain numbers, for those who load little.

Source: our own choice; a plotter's unit is that of HP-GL.
"""

from __future__ import annotations

TRACKS = 4  # of a tape: reference, X, Y, Z
WAIT_S = 60.0  # for the carriers of a tape to come
SAMPLE_RATE_HZ = 48_000
SAMPLES_PER_MOTION = 8
MOTION_RATE_HZ = SAMPLE_RATE_HZ / SAMPLES_PER_MOTION
REFERENCE_HZ = MOTION_RATE_HZ  # the carrier of a reference has a period to a motion sample
FEED_MM_S = 10.0  # the head's own speed, and of a path without times
RAPID_MM_S = 20.0
ACCELERATION_MM_S2 = 500.0  # of X and Y
INCREMENT_MM = 0.001  # in which places are counted
PLOTTER_MM = 0.025
COUNT_MM = 0.01  # the step of the Z unit's decades
SLOWEST_MM_S, FASTEST_MM_S = 0.01, 1000.0  # of a feed
THINNED = 30  # one position in 30 shows where a line runs: every 50 um at the head's speed
AT_ONCE = 65536  # samples that are worked on together: 11 s of motion
