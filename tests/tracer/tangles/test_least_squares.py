"""Least squares: figures come to where MINPACK brings them, within a nanometre."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.optimize import least_squares

from morfax.motion.arrays import Array
from morfax.tracer.tangles import figured
from morfax.tracer.tangles import least_squares as ours
from morfax.tracer.tangles.figured import Figured
from morfax.tracer.tangles.pen import Ink
from tests.tracer.inked import UM, arc
from tests.tracer.tangles.pen_ink import HALF_MM, ink_along

WAY = np.array([(1.0, 3.0), (2.2, 3.0), (2.3, 4.6), (3.8, 4.5), (3.9, 3.0), (5.0, 3.0)])
SHARP, ROUNDED = np.zeros(4, bool), np.array([False, True, True, False])
CORNERS = (WAY[1:-1] + np.array([0.08, -0.11])).ravel()
BESIDE = WAY + np.array([0.0, 0.05])
LOOP = np.vstack([arc((2.4, 3.0), 0.5, 90, 270), arc((3.6, 3.0), 0.5, -90, 90)])
LOOP = np.vstack([LOOP, LOOP[:1]])
MOVES = np.zeros((6, 8, 2))
MOVES[np.repeat(np.arange(1, 5), 2), np.arange(8), np.tile([0, 1], 4)] = 1.0
# what is drawn, along which way the ink is, and the figures to begin with
CASES = {
    "sharp": (Figured.rule(WAY[[0, -1]], SHARP), WAY, np.r_[CORNERS, 1.1 * HALF_MM]),
    "rounded": (Figured.rule(WAY[[0, -1]], ROUNDED), WAY, np.r_[CORNERS, 0.2, HALF_MM]),
    "slot": (Figured.core(), LOOP, np.array([2.5, 3.1, 3.4, 2.9, 0.6, HALF_MM])),
    "inside out": (Figured.core(), LOOP, np.array([2.5, 3.1, 3.4, 2.9, -0.6, HALF_MM])),
    "points": (Figured.core(), LOOP, np.array([2.0, 2.5, 4.0, 2.6, 3.9, 3.5, 2.1, 3.4, 0.2])),
    "moved": (Figured.moved(BESIDE, MOVES, np.zeros(6, bool)), WAY, np.zeros(8)),
}


def ink_of(way: Array) -> Ink:
    return ink_along(way, 0.1, 60, noise=0.03).for_kernel()


def wrong(drawn: Figured, ink: Ink, figures: Array) -> Array:
    out, near = np.empty(len(ink.darkness)), np.empty((len(ink.darkness), 3))
    figured.wrong(drawn, ink, figures, near, out)
    return out


def slopes(drawn: Figured, ink: Ink, figures: Array) -> Array:
    out, near = np.empty((len(ink.darkness), len(figures))), np.empty((len(ink.darkness), 3))
    figured.wrong(drawn, ink, figures, near, out[:, 0].copy())
    figured.changes(drawn, ink, figures.copy(), near, out)
    return out


@pytest.mark.parametrize("name", CASES)
def test_figures_come_to_where_minpack_brings_them(name: str) -> None:
    drawn, way, start = CASES[name]
    ink = ink_of(way)
    asked = {"method": "lm", "ftol": ours.ENOUGH}
    for most in (3, 5, 400):
        theirs = least_squares(
            lambda it: wrong(drawn, ink, it),
            start,
            lambda it: slopes(drawn, ink, it),
            max_nfev=most,
            **asked,
        )
        found = ours.fitted(drawn, ink, start, most)
        assert np.abs(found - theirs.x).max() < 1e-3 * UM
    assert np.sum(wrong(drawn, ink, found) ** 2) < 0.5 * np.sum(wrong(drawn, ink, start) ** 2)


@pytest.mark.parametrize("name", CASES)
def test_the_kernel_is_what_plain_python_is(name: str) -> None:
    drawn, way, start = CASES[name]
    ink = ink_of(way)
    plain = ours.settled.py_func(drawn, ink, start, 60)
    assert np.allclose(ours.settled(drawn, ink, start, 60), plain, atol=1e-3 * UM)
    near = np.zeros((len(ink.darkness), 3))
    for kernel, slope in ((figured.wrong, False), (figured.changes, True)):
        shape = (len(ink.darkness), len(start)) if slope else len(ink.darkness)
        compiled, again = np.empty(shape), np.empty(shape)
        kernel(drawn, ink, start.copy(), near, compiled)
        kernel.py_func(drawn, ink, start.copy(), near, again)
        assert np.allclose(compiled, again, atol=1e-6)


def test_a_figure_that_changes_nothing_stays_and_the_others_come_to_the_ink() -> None:
    """As where no ink is near to a corner."""
    moves = np.concatenate([MOVES, np.zeros((6, 1, 2))], axis=1)
    drawn = Figured.moved(BESIDE, moves, np.zeros(6, bool))
    found = ours.fitted(drawn, ink_of(WAY), np.zeros(9), 400)
    assert found[-1] == 0.0
    only = ours.fitted(CASES["moved"][0], ink_of(WAY), np.zeros(8), 400)
    assert np.allclose(found[:-1], only, atol=1e-3 * UM)


def test_each_part_of_a_step_is_what_plain_python_has() -> None:
    rng = np.random.default_rng(2)
    change, now, scale = rng.normal(size=(40, 5)), rng.normal(size=40), rng.uniform(1, 3, 5)
    change[:, 3] = 2 * change[:, 1]  # two figures for one
    square, right = ours._normal(change, now)
    assert np.allclose(square, change.T @ change) and np.allclose(right, change.T @ now)
    assert np.allclose(ours._normal.py_func(change, now)[0], square)
    root, is_whole = ours._root.py_func(square, scale, 0.0)
    assert not is_whole and not root[3].any()
    undamped, damping = ours._step.py_func(square, right, scale, (math.inf, 0.0))
    assert damping == 0.0 and undamped[3] == 0.0
    for share, once in ((0.5, 0.0), (0.1, damping)):
        reach = share * float(np.linalg.norm(scale * undamped))
        step, damping = ours._step.py_func(square, right, scale, (reach, once))
        assert abs(np.linalg.norm(scale * step) - reach) <= ours.TENTH * reach
        assert np.allclose((square + damping * np.diag(scale**2)) @ step, right)
        assert damping > once
    trusted = ours._trusted.py_func
    assert trusted((0.5, 0.9, 0.5), (1.0, 0.8, 0.2)) == (1.6, 0.1)
    assert trusted((0.5, 0.5, 0.5), (1.0, 0.8, 0.2)) == (1.0, 0.2)
    assert trusted((0.01, 0.02, 0.5), (1.0, 0.8, 0.2)) == (0.5, 0.4)
    assert trusted((-1.0, -2.0, 0.5), (1.0, 0.8, 0.2)) == pytest.approx((0.1, 2.0))
