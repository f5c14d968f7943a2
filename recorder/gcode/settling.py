"""Settling: the joints and half angles of an arc spline (see `spline`), by steps that lessen its residuals.

Signals: joints (segments + 1, 2) mm and half the angle that each segment turns, rad, in; the settled ones
out, in their place. `seen`: places (n, 2) mm, how far along the path each lies (0 to 1), its weight, 1/mm.

Source: steps by K. Levenberg, 1944, and D. Marquardt, 1963.
"""

from __future__ import annotations

import math

import numpy as np

from morfax.motion.arrays import ROUNDED
from morfax.motion.compiled import njit
from morfax.recorder.gcode.normal_equations import BREAK_RAD, normal, offs, solved

ROUNDS = 20  # what has not settled by then is taken as it is
TRIES = 5  # of a step, each with ten times the damping


@njit(cache=True)
def settle(joints, halves, seen, columns, closed):  # type: ignore[no-untyped-def]
    """Take steps until they no longer help. `columns`: the unknown of each segment's five numbers, or -1."""
    damping = 1e-3
    for _ in range(ROUNDS):
        cost, band, pull, seam = linearised(joints, halves, seen, columns, closed)
        if not len(pull):
            return
        before_joints, before_halves = joints.copy(), halves.copy()
        scale = band[:, 0].mean() + (seam**2).mean()
        now = math.inf
        for _ in range(TRIES):
            damped = band.copy()
            damped[:, 0] += damping * 1e-4 * scale
            joints[:], halves[:] = before_joints, before_halves
            step(joints, halves, -solved(damped, seam, pull), columns)
            left = residuals(joints, halves, seen, closed)
            now = left @ left
            if now < cost:
                break
            damping *= 10
        if not now < cost:
            joints[:], halves[:] = before_joints, before_halves
            return
        damping = max(damping / 5, ROUNDED)
        if cost - now < 1e-3 * cost:
            return


@njit(cache=True)
def step(joints, halves, change, columns):  # type: ignore[no-untyped-def]
    """Change joints and half angles by a change of the unknowns."""
    for segment in range(len(columns)):
        for axis in range(2):
            if columns[segment, axis] >= 0:
                joints[segment, axis] += change[columns[segment, axis]]
        if columns[segment, 4] >= 0:
            halves[segment] += change[columns[segment, 4]]


@njit(cache=True)
def linearised(joints, halves, seen, columns, closed):  # type: ignore[no-untyped-def]
    """The sum of the squared residuals, and the normal equations of their slopes: the band of the matrix
    (unknowns, BAND), the right side, and the slopes of the seam's break, which are not in the band.
    """
    places, shares, weights = seen
    table = table_of(joints, halves)
    of_places = (places, owners(table, shares), weights)
    return normal(table, of_places, _breaks(table, closed) / BREAK_RAD, columns, closed)


@njit(cache=True)
def residuals(joints, halves, seen, closed):  # type: ignore[no-untyped-def]
    """Distances by their weights, and breaks of the tangent by theirs."""
    places, shares, weights = seen
    table = table_of(joints, halves)
    off = offs(table, places, owners(table, shares))
    return np.concatenate((weights * off, _breaks(table, closed) / BREAK_RAD))


@njit(cache=True)
def table_of(joints, halves):  # type: ignore[no-untyped-def]
    """The ends of each segment and half the angle that it turns."""
    table = np.empty((len(halves), 5))
    table[:, :2] = joints[:-1]
    table[:, 2:4] = joints[1:]
    table[:, 4] = halves
    return table


@njit(cache=True)
def _breaks(table, closed):  # type: ignore[no-untyped-def]
    """The jump of the direction at each joint, and at the seam of a closed line, rad."""
    count = len(table) if closed else len(table) - 1
    jumps = np.empty(count)
    for one in range(count):
        after = (one + 1) % len(table)
        jump = _direction(table, after) - table[after, 4]
        jump -= _direction(table, one) + table[one, 4]
        jumps[one] = (jump + math.pi) % (2 * math.pi) - math.pi
    return jumps


@njit(cache=True)
def _direction(table, one):  # type: ignore[no-untyped-def]
    """The direction of a segment's chord, rad."""
    return math.atan2(table[one, 3] - table[one, 1], table[one, 2] - table[one, 0])


@njit(cache=True)
def owners(table, shares):  # type: ignore[no-untyped-def]
    """The segment of each place, by how far along the path it lies; the places follow one another."""
    until = np.empty(len(table))
    way = 0.0
    for one in range(len(table)):
        half = table[one, 4]
        chord = math.hypot(table[one, 2] - table[one, 0], table[one, 3] - table[one, 1])
        way += chord if half == 0.0 else chord * half / math.sin(half)
        until[one] = way
    return np.searchsorted(until[:-1], shares * way)
