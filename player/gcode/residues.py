"""Residue loops: from the position errors to command pulses, along lines and arcs.

Signals in: end point (and centre of an arc) in pulses, feed number. Signals out: per recirculation of 16
clocks a command pulse -1, 0 or +1 for each axis.

    error E = X_c - X_t ─► error gate 94 ─► + ─► + ─► residue register 96 ──┬─► sign not changed: command
                                            ▲    ▲                          │   pulse (detector 101)
                                            │  ∓(L + E_m), against the sign ◄┤ 99
                                            └───────────────────────────────┘

    line    RR ← RR + E (gate open) ∓ (L + E_m),       pulses per second  f_gate · E / (E_m + L)
    arc     tangent V = E + A,  A_x = ± E_y · E/2h,  A_y = ∓ E_x · E/2h    (chord E, perpendicular h from M)

All axes keep the ratio of their errors, and the rate falls to nothing at the end point by itself. The ratio
E/2h is made without division by one more residue loop Q: while it is positive E_m is taken from it and the
errors go to their own axes; while it is negative 2h is added and they are crossed. In pulses E/2h is E_m /
2h_n,

    2h_n = 2 (M_y - T_y) - E_y  where |E_x| > |E_y|,  else  2 (M_x - T_x) - E_x.

Source: patent from US application 631 214 of 1967, figures 5, 6, 8 to 10 and 19, equations IV to XI, table I.
Questions: table I uses L = 4 where the text says 8, and takes over a new sum L + E_m sometimes at once and
sometimes a recirculation late; here always at once. 2h has the error of the other axis, as in equations X and
XI, not the larger one as in the text. Residues are loaded with (L + E_m) / 2, and Q with 0. A guard of ours
freezes an axis without error on a line, and swallows a pulse that leads away from the end point: it comes of
a sum that has shrunk since the residue last crossed zero, so the residue is put back to the edge of its own
side. (With the pulse merely swallowed 10 000 lines deviate by up to 4.5 pulses, so by 1.6.) Arcs must be of
less than half a turn.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from morfax.motion.compiled import njit
from morfax.motion.usual import AT_ONCE
from morfax.player.gcode.feed_control import (
    BLOCKED,
    EIGHTH,
    FEED_EIGHTHS,
    GREATEST,
    MIDDLE,
    OVERRIDE_BITS,
    feed_pulses,
    gate_opens,
    passes,
    resultant_weights,
)

AXES = 3
LINE, CLOCKWISE, COUNTER_CLOCKWISE = 0, -1, 1
# the state's registers
_POSITION, _RESIDUE, _RATIO, _COUNTER, _RECIRCULATION, _FED, _SIZE = 0, 3, 6, 7, 8, 9, 10

Counts = NDArray[np.int64]
Pulses = NDArray[np.int8]


@dataclass(frozen=True, slots=True)
class Feed:
    """What opens the error gates: feed number and override, or a fixed period in recirculations."""

    number: int = 0
    override: int = 1 << OVERRIDE_BITS
    true_norm: bool = False
    gate_period: int = 0


class ResidueInterpolator:
    """The three residue loops with the feed counter; registers are carried from block to block."""

    def __init__(
        self,
        start: tuple[int, int, int] | Counts = (0, 0, 0),
        servo_constant: int = 16,
        *,
        guard: bool = True,
    ):
        if not servo_constant > 0:
            raise ValueError(
                f"L = {servo_constant}: the servos' constant must be 1 or more, else no end point is reached"
            )
        self.servo_constant, self.guard = servo_constant, guard
        self._state = np.zeros(_SIZE, np.int64)
        self._state[_POSITION : _POSITION + AXES] = start

    @property
    def position(self) -> Counts:
        """Interpolated position X_t of each axis, pulses."""
        return self._state[_POSITION : _POSITION + AXES].copy()

    @property
    def residues(self) -> Counts:
        """Residue registers RR of the axes, and Q."""
        return self._state[_RESIDUE : _RATIO + 1].copy()

    @property
    def counter(self) -> float:
        """Counter 81, in units (stage 4 is one)."""
        return float(self._state[_COUNTER]) / (8 * EIGHTH)

    def line(
        self, end: tuple[int, int, int] | Counts, feed: Feed, residue: int | None = None
    ) -> Pulses:
        """Command pulses (recirculations, axes) of a line to an end point."""
        return np.concatenate(list(self.recirculate(end, (0, 0), LINE, feed, residue)))

    def arc(
        self,
        end: tuple[int, int, int] | Counts,
        centre: tuple[int, int] | Counts,
        sense: int,
        feed: Feed,
    ) -> Pulses:
        """Command pulses of an arc in X and Y below half a turn, +1 counter-clockwise, -1 clockwise."""
        if sense not in (CLOCKWISE, COUNTER_CLOCKWISE):
            raise ValueError(
                f"an arc turns counter-clockwise, +1, or clockwise, -1; not {sense}"
            )
        if end[2] != self._state[_POSITION + 2]:
            raise ValueError(
                f"an arc from Z {self._state[2]} to {end[2]} is a helix; its plane is X and Y: keep Z"
            )
        return np.concatenate(list(self.recirculate(end, centre, sense, feed)))

    def recirculate(
        self,
        end: tuple[int, int, int] | Counts,
        centre: tuple[int, int] | Counts,
        sense: int,
        feed: Feed,
        residue: int | None = None,
    ) -> Iterator[Pulses]:
        """Load the residues and give command pulses, in parts, until the error is zero; sense 0 is a line."""
        target = np.array(end, np.int64)
        middle = np.array(centre, np.int64)
        error = target - self.position
        if residue is None:
            residue = (self.servo_constant + int(np.abs(error).max())) // 2
        self._state[_RESIDUE : _RESIDUE + AXES] = residue
        self._state[_RATIO] = 0
        weights = resultant_weights(error, true_norm=feed.true_norm)
        settings = np.array(
            [
                self.servo_constant,
                sense,
                self.guard,
                feed.number,
                feed.override,
                feed.gate_period,
            ]
        )
        rows = AT_ONCE
        while rows == AT_ONCE:
            pulses = np.zeros((AT_ONCE, AXES), np.int8)
            rows = _recirculate(
                target, middle, settings, weights, feed.true_norm, self._state, pulses
            )
            yield pulses[:rows]


@njit(cache=True, nogil=True)
def _recirculate(end, centre, settings, weights, true_norm, state, pulses):  # type: ignore[no-untyped-def]
    """Recirculate until there is no error or `pulses` is full; the number of rows used.

    One loop with all registers: its parts are compiled into it; called, they took half as long again.
    """
    constant, sense, guard, number, override, period = settings
    error = np.empty(3, np.int64)
    added = np.empty(3, np.int64)
    weight = weights.copy()
    for row in range(len(pulses)):
        # 1. the errors, and whether their gate opens
        largest = _largest_error(end, state, error)
        if largest == 0:
            return row
        state[_RECIRCULATION] += 1
        if period > 0:
            is_open = state[_RECIRCULATION] % period == 0
        else:
            _fill_counter(state, number, override)
            is_open = gate_opens(state[_COUNTER], state[_RECIRCULATION])
        # 2. what the gate lets in: the errors, or on an arc the tangent
        added[0], added[1], added[2] = error[0], error[1], error[2]
        if sense != 0:
            _weigh_arc(centre, state, true_norm, weight)
            if is_open:
                _add_tangent(error, centre, sense, state, added)
        # 3. the residues, and a pulse where a sign has not changed
        for axis in range(3):
            if error[axis] == 0 and (axis == 2 if sense != 0 else guard):
                continue
            before = state[_RESIDUE + axis]
            now = before + added[axis] if is_open else before
            now += constant + largest if before < 0 else -(constant + largest)
            state[_RESIDUE + axis] = now
            if (now < 0) != (before < 0):
                continue
            pulse = -1 if now < 0 else 1
            if guard and sense == 0 and pulse * error[axis] < 0:
                state[_RESIDUE + axis] = 0 if pulse < 0 else -1
                continue
            state[axis] += pulse
            state[_COUNTER] -= weight[axis]
            pulses[row, axis] = pulse
    return len(pulses)


@njit(cache=True, inline="always")
def _largest_error(end, state, error):  # type: ignore[no-untyped-def]
    """Write the error of each axis; the largest of their sizes."""
    largest = 0
    for axis in range(3):
        error[axis] = end[axis] - state[axis]
        largest = max(largest, abs(error[axis]))
    return largest


@njit(cache=True, inline="always")
def _fill_counter(state, number, override):  # type: ignore[no-untyped-def]
    """The feed counter takes in the pulses of this recirculation."""
    for _ in range(feed_pulses(state[_RECIRCULATION], number)):
        state[_FED] += 1
        if state[_COUNTER] < BLOCKED:
            passed = passes(state[_FED], override, OVERRIDE_BITS)
            state[_COUNTER] += FEED_EIGHTHS * EIGHTH * passed


@njit(cache=True, inline="always")
def _add_tangent(error, centre, sense, state, added):  # type: ignore[no-untyped-def]
    """Loop Q: the errors to their own axes, or crossed with one of them negative."""
    if state[_RATIO] >= 0:
        state[_RATIO] -= max(abs(error[0]), abs(error[1]))
    else:
        other = 1 if abs(error[0]) > abs(error[1]) else 0
        state[_RATIO] += abs(2 * (centre[other] - state[other]) - error[other])
        added[0], added[1] = sense * error[1], -sense * error[0]


@njit(cache=True, inline="always")
def _weigh_arc(centre, state, true_norm, weight):  # type: ignore[no-untyped-def]
    """Weights of an arc's pulses: where the radius is longer in X, the speed is greater in Y."""
    radius_x, radius_y = abs(centre[0] - state[0]), abs(centre[1] - state[1])
    if true_norm:
        radius = max(np.sqrt(float(radius_x) ** 2 + float(radius_y) ** 2), 1.0)
        weight[0] = round(GREATEST * EIGHTH * radius_y / radius)
        weight[1] = round(GREATEST * EIGHTH * radius_x / radius)
    elif radius_x > radius_y:
        weight[0], weight[1] = MIDDLE * EIGHTH, GREATEST * EIGHTH
    else:
        weight[0], weight[1] = GREATEST * EIGHTH, MIDDLE * EIGHTH
