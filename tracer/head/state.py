"""What the head's kernels work on: the state of the head, its tuning, and why a kernel returns.

The state is one record that numba and numpy take alike. Its fields hold float64, the counts int64.

Source: our own layout; the parts are those of patent ES 361967, figure 1.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from morfax.motion.arrays import Array

DRUM = 256  # places that the drum remembers: 10 mm of line at 250 sweeps/s and 10 mm/s

FLOATS = (
    *("x_mm", "y_mm", "vx_mm_s", "vy_mm_s"),  # the two screws, and their speeds
    *("heading_rad", "turn_rad_s", "speed_mm_s"),  # of the steering, and the speed along it
    *("first_sum", "mean_sum"),  # the sweep so far: sum of darkness·sin(phase), sum of darkness
    *(
        "lead_mm",
        "middle_mm",
    ),  # of the mount: ahead of the axis, and to the left of the heading
    *("swept_x_mm", "swept_y_mm"),  # where the axis stood in the middle of the sweep
    "swept_ink",  # darkness of the last sweep, as a share of what it was when the head was tuned
    "ink",  # the line's darkness, as a share of what it was when the head was tuned
    *(
        "guard_left",
        "guard_ahead",
        "guard_right",
    ),  # what the guard cells see, as a share of the ink
    "slow_periods",  # for which the relay still holds
    "travel_mm",
    *("point_x_mm", "point_y_mm"),  # the point that the axis steers for
    "bend_per_mm",  # of the line at that point
    "trusted_mm",  # up to this travel the line was felt clean: the guard cells do not stop the head
    "usual_bend_per_mm",  # without its noise, by which the window is narrowed then
    "aside_mm",  # how far to the left the cell of a head without a drum sees the line
)
STATE = np.dtype(
    [(name, np.float64) for name in FLOATS]
    + [
        ("sweep_periods", np.int64),
        ("places", np.int64),
        ("noise_number", np.int64),
    ]  # into the sweep; put on the drum so far; the last random number
    + [("drum_mm", np.float64, (DRUM, 2))],  # the places of the line seen last, round and round
)

MORE, JUNCTION, TIGHT, HOME, CHANGED = 0, 1, 2, 3, 4  # why the kernel returned


class Home(NamedTuple):
    """Where a closed line began, and the travel from which on the head may close there."""

    x_mm: float
    y_mm: float
    heading_rad: float
    from_travel_mm: float


class Tuning(NamedTuple):
    """Settings of the head as its kernels take them."""

    period_s: float  # of the motion rate
    speed_mm_s: float
    slowed: float  # share of the speed while the relay holds
    slow_periods: float  # how long the relay holds
    acceleration_mm_s2: float
    sweep_periods: int
    pin: Array  # 48, where it stands in each period of a sweep: across and along the line, (n, 2)
    lead_mm: float  # to which the mount slides out
    point_mm: float  # from the axis to the point that it steers for
    half_window_mm: float  # of the parabola about that point
    narrow_mm: (
        float  # half of the narrowest window, for tight bends of a line that was felt clean
    )
    narrowest_per_mm: float  # no window is narrow enough for a line that bends more
    tightest_per_mm: float  # a line that bends more is a junction's, unless it was felt clean
    amplitude_mm: float
    along_mm: float  # lengthwise half-axis of the sweep's ellipse
    guard_mm: float  # from the middle of the line to the guard cells beside it
    guard_lead_mm: float
    look_ahead_mm: float
    slope_per_mm: float  # of the sweep's fundamental at the middle of the line
    mean: (
        float  # darkness over a centred sweep; on an edge, the size of the sweep's fundamental
    )
    balance_per_mm: (
        float  # of the sweep's mean as the edge of a shape moves to the left; 0 on a line
    )
    drive_gain: float  # share of the speed error that a drive makes good in one period
    drive_change_mm_s: float  # largest change of a drive's speed in one period
    steering_gain: (
        float  # share of the turn rate's error that the servo makes good in one period
    )
    square: bool  # the sweep stands square to bends
    square_on_clean: bool  # it does where the line was felt clean
    direct_rad_s_mm: float  # turn rate per mm that the cell sees the line aside; 0: by the drum
    cell_gain: float  # of the swinging cell's current
    detector_gain: float  # of the synchronous detector
    cell_noise: float  # of the cell's current, standard deviation


class Moment(NamedTuple):
    """What a carriage was at a moment: the head's state and tuning, and how much it had recorded."""

    state: Any
    tuning: Tuning
    positions: int
    leads: int
    cell_from_mm: float


def at_rest(place_mm: Array, lead_mm: float) -> Any:
    """The state of a head that stands at a place (x, y) with its mount at a lead: a record, which the kernels
    change.
    """
    state = np.zeros(1, STATE).view(np.recarray)[0]
    state.x_mm, state.y_mm = place_mm
    state.lead_mm = lead_mm
    state.ink = state.swept_ink = 1.0
    return state


def field_of(state: Any, name: str) -> float:
    """A field of the state, as it is read thousands of times: a record asks its attributes first."""
    return float(_item(state, name))


def set_fields(state: Any, **values: float) -> None:
    """Set some fields of the state."""
    for name, value in values.items():
        _set_item(state, name, value)


_item, _set_item = np.void.__getitem__, np.void.__setitem__


def put_on_drum(state: Any, places_mm: Array) -> None:
    """Fill the drum with places of the line (n, 2) mm, in their order; with the last of them, if it remembers
    fewer.
    """
    kept = places_mm[-DRUM:]
    state.drum_mm[: len(kept)] = kept
    state.places = len(kept)


def two_of(state: Any) -> Any:
    """Two states like this one, side by side, (2,): records that a kernel may use up."""
    states = np.zeros(2, state.dtype)  # a plain array of records: its kernels are kept on disk
    states[:] = state
    return states
