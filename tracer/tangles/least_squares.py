"""Least squares: the figures of a shape move to where what is wrong at places of the ink is least.

    (JᵀJ + p D²) s = Jᵀ w       w what is wrong at the places, J what each figure changes of it, D how much
                                each changes in all; p is such that the step s is as long as is trusted

Signals: what is drawn by figures (see `figured`), the ink, and the figures (k,) to begin with in; the figures
at the least out.

Source: J. J. Moré, The Levenberg-Marquardt algorithm, 1978, as MINPACK's `lmder` has it, in a kernel; steps
are trusted, and the fit ends, as there. Questions: MINPACK solves for the step by J itself; ink is drawn by
few figures that hardly stand for one another, and by the square of J they come out the same to a nanometre.
`settling` has a plainer one, for the vertices of tangles, which are moved some hundred times.
"""

from __future__ import annotations

import math

import numpy as np

from morfax.motion.arrays import ROUNDED_SQUARE, Array
from morfax.motion.compiled import njit
from morfax.tracer.tangles import figured
from morfax.tracer.tangles.figured import Figured
from morfax.tracer.tangles.pen import Ink

# of the sum: over some thousand places, figures are then within a thirtieth of how far the noise moves them
ENOUGH = 1e-6
TOLERANCE = 1e-8  # of the figures and of the slope, as scipy has it
# MINPACK's own: a first step is no longer than so many times the figures; one that gains less than a share of
# what it should is taken back; and all else that is a tenth there: to which a step is as long as is trusted,
# how much shorter the next may be, how much more may be wrong; and tries to find how a step is damped
FIRST_STEP, GOOD, TENTH, TRIES = 100.0, 1e-4, 0.1, 10


def fitted(drawn: Figured, ink: Ink, figures: Array, most: int) -> Array:
    """Figures (k,) moved to where what is wrong is least, for which so often at the most ink is drawn."""
    return np.asarray(settled(drawn, ink, np.ascontiguousarray(figures), most))


@njit(cache=True)
def settled(drawn, ink, figures, most):  # type: ignore[no-untyped-def]
    """The same in a kernel."""
    places, count = len(ink.darkness), len(figures)
    figures, now, after = figures.copy(), np.empty(places), np.empty(places)
    change, scale = np.empty((places, count)), np.zeros(count)
    near, then = np.empty((places, 3)), np.empty((places, 3))
    figured.wrong(drawn, ink, figures, near, now)
    left, reach, damping, asked = _length(now), 0.0, 0.0, 1
    while True:
        # 1. what each figure changes, and whether any makes less wrong
        figured.changes(drawn, ink, figures, near, change)
        square, right = _normal(change, now)
        each, is_first = np.sqrt(np.diag(square)), asked == 1
        if not np.any(np.abs(right) > TOLERANCE * left * each):
            return figures
        if is_first:
            scale[:] = np.where(each > 0, each, 1.0)
            reach = FIRST_STEP * _length(scale * figures) or FIRST_STEP
        scale[:] = np.maximum(scale, each)
        # 2. a step that makes less wrong, shorter until it does
        gained = 0.0
        while gained < GOOD:
            step, damping = _step(square, right, scale, (reach, damping))
            long = _length(scale * step)
            reach = min(reach, long) if is_first else reach
            figured.wrong(drawn, ink, figures - step, then, after)
            asked, still = asked + 1, _length(after)
            gain = 1 - (still / left) ** 2 if TENTH * still < left else -1.0
            by_slope, damped = _along(square, step) / left**2, damping * (long / left) ** 2
            expected = by_slope + 2 * damped
            gained = gain / expected if expected > 0 else 0.0
            reach, damping = _trusted((gain, gained, by_slope + damped), (reach, long, damping))
            if gained >= GOOD:
                figures -= step
                now, after, left = after, now, still
                near, then = then, near
            is_enough = abs(gain) <= ENOUGH and expected <= ENOUGH and gained <= 2
            if is_enough or reach <= TOLERANCE * _length(scale * figures) or asked >= most:
                return figures


@njit(cache=True)
def _trusted(gains, step):  # type: ignore[no-untyped-def]
    """How far the next step may reach, and how it is damped: by what the last one gained, of all and of what
    was expected, and the slope there; how far it might reach, how long it was, how it was damped.
    """
    (gain, gained, slope), (reach, long, damping) = gains, step
    if gained <= 0.25:
        shorter = 0.5 if gain >= 0 else 0.5 * slope / (slope - 0.5 * gain)
        shorter = TENTH if gain == -1.0 else max(shorter, TENTH)
        return shorter * min(reach, long / TENTH), damping / shorter
    if damping == 0 or gained >= 0.75:
        return 2 * long, 0.5 * damping
    return reach, damping


@njit(cache=True)
def _step(square, right, scale, last):  # type: ignore[no-untyped-def]
    """The step that reaches as far as is trusted, and how it is damped; the same of the last one is given."""
    reach, damping = last
    # 1. undamped, if that is no longer
    root, is_whole = _root(square, scale, 0.0)
    step = _solved(root, right)
    long = _length(scale * step)
    over = long - reach
    if over <= TENTH * reach:
        return step, 0.0
    # 2. between what is too little and what is too much
    least = over / reach / _bends(root, scale, step) if is_whole else 0.0
    slope = _length(right / scale)
    most = slope / reach
    damping = min(max(damping, least), most) or slope / long
    for k in range(TRIES):
        damping = damping or 1e-3 * most
        root, _ = _root(square, scale, damping)
        step = _solved(root, right)
        before, over = over, _length(scale * step) - reach
        if abs(over) <= TENTH * reach or k == TRIES - 1 or (least == 0 and over <= before < 0):
            break
        more = over / reach / _bends(root, scale, step)
        if over > 0:
            least = max(least, damping)
        else:
            most = min(most, damping)
        damping = max(least, damping + more)
    return step, damping


@njit(cache=True)
def _bends(root, scale, step):  # type: ignore[no-untyped-def]
    """How fast a step becomes shorter as it is damped more, of its length."""
    long = _length(scale * step)
    return _length(_forwards(root, scale * (scale * step / long))) ** 2


@njit(cache=True)
def _normal(change, now):  # type: ignore[no-untyped-def]
    """The normal equations: their square (k, k) and right side (k,). A figure changes few places."""
    count = change.shape[1]
    square, right, some = np.zeros((count, count)), np.zeros(count), np.empty(count, np.int64)
    for k in range(len(now)):
        n = 0
        for i in range(count):
            if change[k, i] != 0.0:
                some[n] = i
                n += 1
        for a in range(n):
            i = some[a]
            right[i] += change[k, i] * now[k]
            for b in range(a + 1):
                square[i, some[b]] += change[k, i] * change[k, some[b]]
    for i in range(count):
        for j in range(i):
            square[j, i] = square[i, j]
    return square, right


@njit(cache=True)
def _root(square, scale, damping):  # type: ignore[no-untyped-def]
    """The root (k, k), lower left, of a damped square, and whether it is whole: the row of a figure that
    others stand for is empty.
    """
    root, is_whole = np.zeros(square.shape), True
    for i in range(len(square)):
        for j in range(i + 1):
            rest = square[i, j] + (damping * scale[i] ** 2 if i == j else 0.0)
            all_of_it = rest
            for k in range(j):
                rest -= root[i, k] * root[j, k]
            if i > j:
                root[i, j] = rest / root[j, j] if root[j, j] > 0 else 0.0
            elif rest > ROUNDED_SQUARE * all_of_it:
                root[i, i] = math.sqrt(rest)
            else:
                root[i, :i], is_whole = 0.0, False
    return root, is_whole


@njit(cache=True)
def _forwards(root, right):  # type: ignore[no-untyped-def]
    """The solution of a root's own equations; a figure whose row is empty is not moved."""
    out = np.zeros(len(right))
    for i in range(len(out)):
        if root[i, i] > 0:
            rest = right[i]
            for k in range(i):
                rest -= root[i, k] * out[k]
            out[i] = rest / root[i, i]
    return out


@njit(cache=True)
def _solved(root, right):  # type: ignore[no-untyped-def]
    """The solution of the equations of which the root is given."""
    out = _forwards(root, right)
    for i in range(len(out) - 1, -1, -1):
        if root[i, i] > 0:
            for k in range(i + 1, len(out)):
                out[i] -= root[k, i] * out[k]
            out[i] /= root[i, i]
    return out


@njit(cache=True)
def _length(values):  # type: ignore[no-untyped-def]
    """The length of a vector."""
    total = 0.0
    for value in values:
        total += value * value
    return math.sqrt(total)


@njit(cache=True)
def _along(square, step):  # type: ignore[no-untyped-def]
    """The square of what a step changes by the slopes."""
    total = 0.0
    for i in range(len(step)):
        for j in range(len(step)):
            total += step[i] * square[i, j] * step[j]
    return total
