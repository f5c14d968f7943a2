"""Least squares: the figures of a shape move to where what is wrong at places of the ink is least.

The sum of squares is made least by MINPACK's `lmder` (Levenberg and Marquardt), as scipy's `least_squares`
calls it. MINPACK is loaded by itself: scipy's other optimisers, which come with it, take 22 to 48 MB and a
quarter of a second.

Signals: the figures (k,) to begin with, and what is wrong (n,) at the places by the figures, in; the figures
at the least out.

Source: J. J. Moré, The Levenberg-Marquardt algorithm, 1978. Questions: `settling` has one in its kernel, for
the vertices of tangles, which are moved some hundred times.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.extension import extension

# of the sum: over some thousand places, figures are then within a thirtieth of how far the noise moves them
ENOUGH = 1e-6
TOLERANCE = 1e-8  # of the figures and of the slope, as scipy has it
FIRST_STEP = 100.0  # times the figures' length, at the most: MINPACK's own
NUDGE = 1e-4  # of a figure, by which it is moved to see what that changes

Of = Callable[[Array], Array]


def fitted(wrong: Of, figures: Array, most: int, changes: Of | None = None) -> Array:
    """Figures (k,) moved to where what is wrong is least, which is asked for so many times at the most.

    `changes` gives what each figure changes, (n, k) per unit of it; without it each is moved in turn.
    """
    changes = changes or (lambda now: _changes(wrong, now))
    limits = ENOUGH, TOLERANCE, TOLERANCE, most, FIRST_STEP, None
    found = _lmder()(wrong, changes, figures.copy(), (), True, False, *limits)
    return np.asarray(found[0])


def _changes(wrong: Of, figures: Array) -> Array:
    """By how much each figure changes what is wrong at the places, (n, k) per unit of it."""
    now, by = wrong(figures), NUDGE * figures
    by[figures + by == figures] = np.sqrt(np.finfo(float).eps)
    change = np.empty((len(figures), len(now)))
    for k in range(len(figures)):
        moved = figures.copy()
        moved[k] += by[k]
        change[k] = (wrong(moved) - now) / (moved[k] - figures[k])
    return change.T


@cache
def _lmder() -> Any:
    """MINPACK's `lmder`."""
    try:
        return extension("scipy", "optimize._minpack")._lmder
    except (ImportError, AttributeError):  # a scipy that keeps it elsewhere
        from scipy.optimize import _minpack

        return _minpack._lmder
