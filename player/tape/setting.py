"""What is set at the machine before a tape is played: its motors, the zero of each axis, the speed of the
tape, and what is wrong with its pick-ups.

Signals: none; machine.py plays by it.

    zero        a phase added before an axis' comparator: its screw stands this far off the tape's place
    override    the tape runs this many times as fast, with sector wheels and screws, along the same path;
                the drives stay what they are, so what is too fast for them is a fault

Source: patent ES 361967, figure 5 (phase changer 155 "for the adjustment of the zero", motor 163 electric or
hydraulic). Questions: how far a phase changer turns is not said; here a metre at most, at 10 mm/s, before the
tape starts. A speed of the tape other than its own is not in the patent, but follows from it: the reference
on the tape turns the wheels.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from morfax.motion.axis import TRAVEL_MM
from morfax.player.tape.phase_lock import MOTORS, PhaseLock
from morfax.player.tape.sector_wheel import SectorWheel

OVERRIDES = 0.1, 2.0  # what a transport of variable speed does
LARGEST_ZERO_MM = TRAVEL_MM / 2  # half of the machine's travel to either side


@dataclass(frozen=True, slots=True)
class Setting:
    """Drives, zeros in mm in the order of the axes (missing ones are 0), the override, the sector wheels."""

    lock: PhaseLock = MOTORS["electric"]
    zero_mm: tuple[float, ...] = ()
    override: float = 1.0
    wheel: SectorWheel = field(default_factory=SectorWheel)

    def __post_init__(self) -> None:
        slowest, fastest = OVERRIDES
        if not slowest <= self.override <= fastest:
            raise ValueError(
                f"the override is {self.override:.0%}; give {slowest:.0%} to {fastest:.0%}"
            )
        far = [shift for shift in self.zero_mm if not abs(shift) <= LARGEST_ZERO_MM]
        if far:
            raise ValueError(
                f"a zero of {far[0]:g} mm is too far; the phase changer turns ±{LARGEST_ZERO_MM:g} mm"
            )

    def zeros_mm(self, axes: Sequence[str]) -> NDArray[np.float64]:
        """The zero of every axis, mm; raises ValueError for more zeros than axes."""
        if len(self.zero_mm) > len(axes):
            raise ValueError(
                f"a zero of {len(self.zero_mm)} places does not fit; the tape has {len(axes)} axes"
            )
        return np.array([*self.zero_mm, *[0.0] * (len(axes) - len(self.zero_mm))])


def check_resumption(
    resume_at_s: float, start_mm: Sequence[float] | None, duration_s: float
) -> None:
    """Raise ValueError for a tape time at which a tape cannot be resumed."""
    if not 0 <= resume_at_s < duration_s:
        raise ValueError(
            f"the tape cannot be resumed at {resume_at_s:g} s; it lasts from 0 to {duration_s:.3f} s"
        )
    if resume_at_s and start_mm is None:
        raise ValueError(
            f"where the machine stands at {resume_at_s:g} s must be said; give the place (--from X,Y,Z)"
        )
