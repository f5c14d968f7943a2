"""The end count: how many whole cycles each dropout of a bare tape lost, told by where the tape ends.

Signals in: what the sides of the doubtful dropouts say, and the cycles that are missing at the end, axis by
axis. Signals out: whole cycles for each dropout, or the fault that they cannot be known (mend.py has the
equation).

Source: our own. Questions: two dropouts of one axis may have lost what the other put back; then nothing is
known.
"""

from __future__ import annotations

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.faults import LockFault, TapeFault
from morfax.player.tape.bridges import COUNT_MARGIN, Bridge
from morfax.recorder.tape.format import SURE_CYCLES, TapeFormat

MANY = 2  # sets of numbers that fulfil the end: more need not be counted

Place = tuple[int, int]  # of a dropout: first row, axis


def lost_cycles(
    doubtful: dict[Place, Bridge], missing: Array, fmt: TapeFormat
) -> dict[Place, int]:
    """Whole cycles to put back at each doubtful dropout; raises TapeFault or LockFault if unknown."""
    told: dict[Place, int] = {}
    for axis, cycles in enumerate(missing.tolist()):
        gaps = [gap for gap in sorted(doubtful) if gap[1] == axis]
        if abs(cycles - round(cycles)) > SURE_CYCLES:
            raise not_whole(axis, cycles, fmt)
        sets = _sets([_candidates(doubtful[gap]) for gap in gaps], round(cycles))
        if len(sets) != 1:
            raise _unknown(
                axis,
                round(cycles),
                [gap[0] / fmt.motion_rate_hz for gap in gaps],
                len(sets),
                fmt,
            )
        told |= dict(zip(gaps, sets[0], strict=True))
    return told


def _candidates(found: Bridge) -> range:
    """Whole cycles by which the travel over a dropout may be wrong."""
    most = found.reach + COUNT_MARGIN + found.misfit
    return range(int(np.ceil(-most - found.off)), int(np.floor(most - found.off)) + 1)


def _sets(candidates: list[range], total: int) -> list[tuple[int, ...]]:
    """Sets of one number from each range with this sum; at most two, as two are ambiguous already."""
    if not candidates:
        return [()] if total == 0 else []
    found: list[tuple[int, ...]] = []
    rest_low, rest_high = (
        sum(r[0] for r in candidates[1:] if r),
        sum(r[-1] for r in candidates[1:] if r),
    )
    for number in candidates[0]:
        if rest_low <= total - number <= rest_high:
            found += [(number, *rest) for rest in _sets(candidates[1:], total - number)]
        if len(found) >= MANY:
            return found[:MANY]
    return found


def _unknown(
    axis: int, cycles: int, times_s: list[float], sets: int, fmt: TapeFormat
) -> TapeFault:
    """The fault of cycles that no dropout, or one of several, has lost."""
    name, places = (
        fmt.axes[axis].upper(),
        ", ".join(f"{time_s:.3f} s" for time_s in times_s[:6]),
    )
    if sets and not cycles:
        why = (
            f"where it should, but what one of the {len(times_s)} dropouts at {places} lost another may "
            "have put back"
        )
    elif sets:
        why = (
            f"{cycles:+d} cycles off, and the {len(times_s)} dropouts at {places} could have lost them "
            "in more than one way"
        )
    elif times_s:
        why = f"{cycles:+d} cycles off, and the dropouts at {places} are too short for it"
    else:
        why = f"{cycles:+d} cycles off, and there is no dropout that could have lost them; look for a splice"
    return TapeFault(f"{name} ends {why}: it cannot be known; get another copy")


def not_whole(axis: int, cycles: float, fmt: TapeFormat) -> LockFault:
    """The fault of an end that is off by more than whole cycles."""
    return LockFault(
        f"{fmt.axes[axis].upper()} ends {cycles:+.2f} cycles off, which is no whole number within "
        f"{SURE_CYCLES:g}: more than "
        f"cycles was lost, or it is cut short; get another copy",
        axis=fmt.axes[axis],
        time_s=0.0,
        error_cycles=cycles,
        position_mm=float(fmt.end_mm[axis] if fmt.end_mm else 0.0),
    )
