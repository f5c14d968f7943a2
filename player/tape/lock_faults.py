"""The faults of the drives: one that lost its lock, and one that ends elsewhere than the tape states.

Signals in: where and when a drive stood, and by how much it was off. Signals out: the fault.

Source: patent ES 361967, figure 5 (fault circuit 162). Questions: none.
"""

from __future__ import annotations

from typing import NamedTuple

from morfax.motion.faults import LockFault
from morfax.player.tape.sector_wheel import THRESHOLD
from morfax.player.tape.setting import Setting
from morfax.recorder.tape.format import SURE_CYCLES, TapeFormat


class Stood(NamedTuple):
    """An axis by its name, the time in s, its error in cycles, and its place in mm."""

    axis: str
    time_s: float
    error_cycles: float
    position_mm: float


def out_of_range(stood: Stood, setting: Setting) -> LockFault:
    """The fault of a drive that could not follow."""
    lock, wheel = setting.lock, setting.wheel
    why = (
        f"the tape asks for more than {lock.drive.acceleration_mm_s2:g} mm/s² or "
        f"{lock.drive.top_speed_mm_s:g} mm/s: play it slower, or record it smoother"
    )
    if not wheel.is_lit:
        why = (
            f"its pick-up gives no signal: the lamp has {wheel.light:.0%} of its light, and"
            f" the trigger needs {THRESHOLD:.0%}"
        )
    return LockFault(
        f"the drive of {stood.axis.upper()} lost its lock at {stood.time_s:.3f} s, position "
        f"{stood.position_mm:.3f} mm: error {stood.error_cycles:+.2f} cycles, allowed "
        f"±{lock.range_cycles:g}; {why}",
        **stood._asdict(),
    )


def ended_elsewhere(stood: Stood, fmt: TapeFormat) -> LockFault:
    """The fault of an axis that stands elsewhere than at the end that the tape states."""
    error_mm, allowed_mm = stood.error_cycles * fmt.mm_per_cycle, SURE_CYCLES * fmt.mm_per_cycle
    return LockFault(
        f"{stood.axis.upper()} ends at {stood.position_mm:.3f} mm, {error_mm:+.3f} mm from the end that the "
        f"tape states; allowed ±{allowed_mm:g} mm; cycles were lost, or it is cut short: get another",
        **stood._asdict(),
    )
