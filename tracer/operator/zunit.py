"""Z unit: the operator sets a move on decade switches, the motor runs, and stops where the counters agree
with the switches.

Signals in: presets of the switches (whole counts of 0.01 mm, sense, feed in mm/s, dwell in s) and the start
position in mm above the work. Signal out: Z in mm at the motion rate, up positive, 0 the surface of the work.

    switches 126 ──▶ coincidence 133 ──▶ stop        one move:  feed  ____
                        ▲                                            /    \\
    disc 128 ──▶ counters 127 (up and down)                    _____/      \\_____   dwell
       └──── motor 125 ◀── amplifier 135, tacho 136

One pulse of the disc is one count. The motor runs each move by the ramp counter with the count as its
increment: it speeds up, holds the feed, and comes to rest on the last pulse. What switches it off is the
coincidence of the counted pulses with the switches, so that it never runs past them:

    count at rest = count before ± switches,     Z = 0.01 mm · count          (both exact: counts are whole)

Source: patent ES 361967, figure 3 (switches 126, counters 127, disc 128, counting unit 124, coincidence 133,
motor 125, amplifier 135, tacho 136), claims 3, 13 and 14; the ramp from patent ES 414458, figures 3 and 4
(see `motion.ramp`). Questions: the patent gives no figures. Chosen: five digits of 0.01 mm, the first preset
being the start position above the work, and counters that show the sign and five digits too. The patent's
motor is switched off at coincidence and would run on; the ramp counter brakes before it. A move whose pulses
never come to coincidence is a fault. Without a card the
depth and clearance need not be whole counts: the move is then divided into a whole number of increments, each
as near to a count as possible.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from morfax.motion import ramp
from morfax.motion.arrays import ROUNDED, Array
from morfax.motion.faults import MotionFault
from morfax.motion.motion import MOTION_RATE_HZ
from morfax.motion.usual import COUNT_MM

COUNTS_PER_MM = round(1 / COUNT_MM)
LARGEST_COUNT = 99_999  # five decades
ACCELERATION_MM_S2 = 200.0  # of the Z motor: our own figure


Sense = Literal["up", "down"]


@dataclass(frozen=True, slots=True)
class Preset:
    """One setting of the panel: counts up or down at a feed, then a dwell; 0 counts are a dwell alone."""

    counts: int
    sense: Sense = "down"
    feed_mm_s: float = 5.0
    dwell_s: float = 0.0

    def __post_init__(self) -> None:
        if not 0 <= self.counts <= LARGEST_COUNT:
            raise ValueError(
                f"a move of {self.counts * COUNT_MM:.2f} mm cannot be set on five decades; "
                f"give 0 to {LARGEST_COUNT * COUNT_MM:.2f} mm"
            )
        if self.sense not in ("up", "down"):
            raise ValueError(f"the sense switch has no {self.sense!r}; give up or down")
        if not 0 < self.feed_mm_s < math.inf or not 0 <= self.dwell_s < math.inf:
            raise ValueError(
                f"a feed of {self.feed_mm_s:g} mm/s with a dwell of {self.dwell_s:g} s never ends; "
                "give a feed above zero and a dwell of zero or more, both finite"
            )

    @property
    def digits(self) -> str:
        """What the five switches 126 show."""
        return f"{self.counts:05d}"

    @property
    def signed(self) -> int:
        """Counts of the move, up positive."""
        return self.counts if self.sense == "up" else -self.counts


@dataclass(frozen=True, slots=True)
class Counters:
    """The bidirectional decade counters 127: counts above the work, below zero in it."""

    count: int = 0

    def __post_init__(self) -> None:
        if abs(self.count) > LARGEST_COUNT:
            raise ValueError(
                f"the counters cannot show {self.count * COUNT_MM:.2f} mm; they go from "
                f"{-LARGEST_COUNT * COUNT_MM:.2f} to {LARGEST_COUNT * COUNT_MM:.2f} mm"
            )

    @property
    def digits(self) -> str:
        """What the counters show: sign and five digits."""
        return f"{self.count:+06d}"

    @property
    def z_mm(self) -> float:
        """Where Z is, mm."""
        return self.count / COUNTS_PER_MM

    def after(self, preset: Preset) -> Counters:
        """The counters when a move has come to coincidence; raises ValueError beyond five digits."""
        return Counters(self.count + preset.signed)


@dataclass(frozen=True, slots=True)
class QuillMove:
    """What the motor 125 does: go to a place in mm at a feed, then stand."""

    to_mm: float
    feed_mm_s: float
    dwell_s: float = 0.0


def counts_of(length_mm: float) -> int:
    """Whole counts of a length; raises ValueError for parts of a count."""
    counts = round(length_mm * COUNTS_PER_MM)
    if abs(length_mm * COUNTS_PER_MM - counts) > ROUNDED:
        raise ValueError(
            f"{length_mm:g} mm cannot be counted; give whole steps of {COUNT_MM:g} mm"
        )
    return counts


def moves(start: Counters, presets: Iterable[Preset]) -> list[QuillMove]:
    """What the motor does for presets run one after the other; raises ValueError beyond five digits."""
    made, counters = [], start
    for preset in presets:
        counters = counters.after(preset)
        made.append(QuillMove(counters.z_mm, preset.feed_mm_s, preset.dwell_s))
    return made


def z_moves(
    start_mm: float,
    moves: Sequence[QuillMove],
    acceleration_mm_s2: float = ACCELERATION_MM_S2,
    rate_hz: float = MOTION_RATE_HZ,
) -> Array:
    """Z of moves one after the other from a place, (n,) mm at the motion rate, each to its last pulse; it is
    not to be changed.

    Raises MotionFault where the counters never agree with the switches.
    """
    parts, at_mm = list[Array](), start_mm
    for move in moves:
        parts.append(_one(at_mm, move, acceleration_mm_s2, rate_hz))
        at_mm = float(parts[-1][-1])
    return parts[0] if len(parts) == 1 else np.concatenate([np.empty(0), *parts])


def counted(come_mm: Array, pulse_mm: float = COUNT_MM) -> NDArray[np.int64]:
    """What the counters show at each place of a move, from its start: pulses of disc 128, up and down."""
    return np.trunc(come_mm / pulse_mm + np.copysign(ROUNDED, come_mm)).astype(np.int64)


def coincidence(shown: NDArray[np.int64], counts: int) -> int | None:
    """At which sample of a move the counters agree with the switches (133); None if they never do."""
    there = np.flatnonzero(np.abs(shown) >= counts)
    return int(there[0]) if len(there) else None


@lru_cache(maxsize=16)  # all holes of a plate have the same two moves
def _one(start_mm: float, move: QuillMove, acceleration_mm_s2: float, rate_hz: float) -> Array:
    """Z of one move and of the dwell after it, mm."""
    # 1. what the motor would run
    how = ramp.Ramp(acceleration_mm_s2, COUNT_MM)
    way = ramp.positions_mm([start_mm], [move.to_mm], move.feed_mm_s, how, rate_hz=rate_hz)
    way = way[:, 0]
    # 2. the counters, from the start of the move; the motor is off where they would pass the switches
    length_mm = abs(move.to_mm - start_mm)
    switches = round(length_mm / COUNT_MM)
    if switches:
        shown = counted(way - start_mm, length_mm / switches)
        if coincidence(shown, switches) is None:
            raise MotionFault(
                f"Z does not stop: its counters show {abs(int(shown[-1]))} pulses at the end of a move, "
                f"and the switches {switches}",
                axis="z",
                time_s=len(way) / rate_hz,
            )
        way = way[np.abs(shown) <= switches]
    # 3. the dwell, where it came to rest
    z_mm = np.concatenate([way, np.full(round(move.dwell_s * rate_hz), way[-1])])
    z_mm.flags.writeable = False
    return z_mm
