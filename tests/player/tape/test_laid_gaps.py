"""Gaps that are laid or bridged: how free the axis was, and what the frames on both sides tell."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.player.tape.bridges import Bound, GapEdge, bridge, filled, turned
from morfax.player.tape.erasures import Erasures
from morfax.player.tape.gap import Gap, freedom
from morfax.player.tape.symbols import GATES, PARTS, Gates
from morfax.recorder.tape.check_frame import Bits, CheckFrame, to_bits

STILL = GapEdge(0.0, 0.0, 0.0, 0.0)


def test_the_freedom_of_a_gap_is_the_swing_of_its_acceleration() -> None:
    rows, most = 60, 1e-4  # cycles/row²
    laid = np.zeros(rows - 1)
    free = freedom(STILL, STILL, laid, Bound(most, 1.0))
    assert free == pytest.approx(most * rows**2 / 16, rel=1e-3)
    slow = freedom(STILL, STILL, laid, Bound(most, most * rows / 16))
    assert slow < free
    assert freedom(STILL, STILL, laid, Bound(0.0, 0.0)) < 1e-9


@pytest.mark.parametrize("turn", [-2.0, 0.0, 40.0, 127.0, 129.0])
def test_what_is_laid_ends_where_the_axis_is(turn: float) -> None:
    """The acceleration changes beside the gap or within it: the way is laid to the place behind it.

    A way laid from the edge of the gap on ended 0.07 cycle off, without a fault.
    """
    rows, most = 127, 2.8e-4  # 21 ms and 0.5 m/s²
    left = rows - turn
    before = GapEdge(0.0, 0.0, 0.0, 0.0)
    after = GapEdge(most * left**2 / 2, most * left, most / 2, 0.0)
    found = turned(before, after, rows, most)
    assert found is not None
    assert found.turn == pytest.approx(turn, abs=1e-6)
    gap = Gap(0, 100, 100 + rows - 1, before, after, found, Bound(most, 1.0))
    true = most * np.maximum(np.arange(1, rows) - turn, 0.0) ** 2 / 2
    assert np.abs(gap.laid() - true).max() < 0.003  # cycle: what three rows of acceleration are


@pytest.mark.parametrize("seed", range(20))
def test_no_motion_within_the_bound_leaves_the_freedom(seed: int) -> None:
    random, rows = np.random.default_rng(seed), int(20 + 7 * seed)
    most = 1e-4
    acceleration = random.choice([-most, 0.0, most], rows)
    acceleration = np.repeat(acceleration[:: 1 + seed], 1 + seed)[:rows]
    speed = np.concatenate([[0.0], np.cumsum(acceleration)]) + float(random.normal(0, 0.01))
    place = np.concatenate([[0.0], np.cumsum((speed[1:] + speed[:-1]) / 2)])
    before = GapEdge(place[0], speed[0], 0.0, 0.0)
    after = GapEdge(place[-1], speed[-1], 0.0, 0.0)
    laid = filled(before, after, place[-1] - place[0], rows)
    off = np.abs(laid - place[1:-1]).max()
    assert off <= freedom(before, after, laid, Bound(most, np.inf)) + 1e-9


def gates(bits: Bits, strengths: np.ndarray) -> Gates:
    """Symbols of one track as they are read, each as strong at all its gates."""
    shares = np.repeat(strengths[:, None], GATES, axis=1)
    none = np.zeros(len(bits))
    return Gates(
        bits, strengths, strengths, shares, none, np.zeros((len(bits), PARTS)), none, none
    )


@pytest.mark.parametrize(("lost", "read"), [(3, True), (8, True), (9, False), (40, False)])
def test_a_frame_is_read_without_some_of_its_symbols(lost: int, read: bool) -> None:
    frame = CheckFrame(1, 7, 12.5, 200.0, 1000.0)
    random = np.random.default_rng(lost)
    bits, strengths = to_bits(frame)[None].copy(), np.ones((1, 120))
    said = frame._replace(track=0)  # the only track here
    bits[0] = to_bits(said)
    strengths[0, 50 : 50 + lost] = 0.1
    bits[0, 50 : 50 + lost] = random.choice([-1, 1], lost)
    found = Erasures(1).read(gates(bits, strengths), 7)[0]
    assert (found is not None) == read
    if found is not None:
        assert (found.track, found.number, found.cycles) == (0, 7, 12.5)
        # the number is not the one that is due: nothing is made of its weak symbols
        assert Erasures(1).read(gates(-bits[:, ::-1].copy(), strengths), 8)[0] is None


def test_sides_that_agree_are_bridged_with_the_told_acceleration() -> None:
    rows = 66  # 11 ms
    assert bridge(STILL, STILL, rows, 10_000 / 6000**2).certain
    assert not bridge(STILL, STILL, rows, 100_000 / 6000**2).certain


@pytest.mark.parametrize("at", [0, 5, 36, 60, 72])
def test_a_gap_in_which_the_acceleration_changes_once_is_bridged(at: int) -> None:
    """From 0.5 m/s² to an even speed, in 12 ms: the way is laid as it went, half a row beside its turn."""
    hard, rows = 10_000 / 6000**2, 72
    speed = np.cumsum(np.where(np.arange(rows) < at, hard, 0.0))
    way = np.r_[0.0, np.cumsum(speed) - hard * np.minimum(np.arange(1, rows + 1), at) / 2]
    before = GapEdge(0.0, 0.0, hard / 2, 0.0)
    after = GapEdge(float(way[-1]), float(speed[-1]), 0.0, 0.0)
    found = turned(before, after, rows, hard)
    assert found is not None
    assert found.certain
    assert found.travel == pytest.approx(way[-1], abs=0.005)  # cycles: half a row at either end
    gap = Gap(0, 100, 171, before, after, found, Bound(hard, 1.0))
    assert np.abs(gap.laid() - way[1:-1]).max() < 0.005


def test_a_gap_that_no_single_change_of_acceleration_explains_is_not() -> None:
    hard, rows = 10_000 / 6000**2, 72
    faster = GapEdge(0.0, 2 * hard * rows, 0.0, 0.0)  # than the first acceleration can make it
    assert turned(GapEdge(0.0, 0.0, hard / 2, 0.0), faster, rows, hard) is None
    assert turned(STILL, STILL, rows, hard) is None
    elsewhere = GapEdge(
        0.3, hard * rows / 2, 0.0, 0.0
    )  # the speed is reached, another place is not
    assert turned(GapEdge(0.0, 0.0, hard / 2, 0.0), elsewhere, rows, hard) is None
