"""The delay of one track: how certain it is behind the last that was told."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.motion.median import OUTLIERS
from morfax.player.tape.bridges import Bound
from morfax.player.tape.delays import WINDOW, Delay
from morfax.player.tape.tail import apart, tail_of
from morfax.player.tape.told_bounds import ToldBounds
from morfax.recorder.tape.format import TapeFormat

ROWS = 720.0  # from one told delay to the next: a quarter of a frame at 6 kHz
ERROR_S = 1e-6


def told(random: np.random.Generator, drift_s: float) -> Delay:
    """A delay that drifts, told eight times with a standard error of 1 us."""
    delay = Delay(6000.0, 6000.0)
    for first in (0, 4):
        numbers = np.arange(first, first + 4)
        delays_s = drift_s * numbers + random.normal(0, ERROR_S, 4)
        delay.add((ROWS * numbers).tolist(), delays_s.tolist(), [ERROR_S])
    return delay


@pytest.mark.parametrize("beyond", [0.5, 2.5, 4.5])
def test_the_doubt_is_what_the_line_may_be_off(beyond: float) -> None:
    """Of 600 lines 1 in 370 is further off than three standard errors; half of them is not enough."""
    random, drift_s = np.random.default_rng(3), 6e-6
    row = ROWS * (WINDOW + beyond)
    off_s, doubt_s = [], 0.0
    for _ in range(600):
        delay = told(random, drift_s)
        moved = delay.corrected(np.zeros(round(row) + 50), 0)[round(row)]
        off_s.append(abs(moved / 6000.0 - drift_s * row / ROWS))
        doubt_s = delay.doubt_s(row)
    # beyond the last the line goes on from what is used there, half a us of dead zone beside it
    assert np.mean(np.array(off_s) > doubt_s + 0.5e-6) < 0.01
    assert np.mean(np.array(off_s) > doubt_s / OUTLIERS / 2) > 0.3


def test_what_was_told_too_seldom_is_not_judged() -> None:
    assert Delay(6000.0, 6000.0).doubt_s(1e4) == 0.0


def test_averages_of_a_way_lie_apart_as_far_as_it_goes_less_one_of_them() -> None:
    assert apart(0.001 * np.arange(100), 10) == pytest.approx(0.090)
    assert apart(np.resize([0.0, 0.1], 100), 10) == pytest.approx(0.0, abs=1e-12)  # noise goes
    assert apart(np.array([3.0]), 10) == 0.0


class Says(ToldBounds):
    """An axis that told one speed of all its rows, cycles/row."""

    def __init__(self, speed: float) -> None:
        super().__init__(6000.0, 0.48)
        self.speed = speed

    def between(self, first: int, last: int) -> Bound | None:
        """The same everywhere."""
        return Bound(0.0, self.speed)


def test_an_axis_that_told_rest_is_held_and_one_that_moves_is_judged() -> None:
    """Behind the last settled delay it swings on by 0.1 cycle; by half a cycle is a fault at rest, too."""
    fmt, delay = TapeFormat(), told(np.random.default_rng(1), 0.0)
    settled = int(delay.settled_row)
    way = np.concatenate([np.zeros(101), np.linspace(0, 0.1, 6000)])
    assert tail_of(way, settled - 100, delay, Says(0.0), fmt) == (settled, 0.0)
    assert tail_of(5 * way, settled - 100, delay, Says(0.0), fmt).off_s > 0
    moves = tail_of(way, settled - 100, delay, Says(1e-6), fmt)
    assert moves.rest_row is None and moves.off_s * fmt.reference_hz > 0.02
