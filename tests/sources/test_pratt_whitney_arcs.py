"""Patent from US application 631 214 (Pratt & Whitney, 1967): one test for each claim on arcs.

`docs/background/claims-pratt-whitney.md` has the table from claim to test. Pulses are of 0.0005 in.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
import pytest

from morfax.player.gcode.residues import (
    CLOCKWISE,
    COUNTER_CLOCKWISE,
    ResidueInterpolator,
)
from tests.sources.pulse_registers import (
    ALWAYS,
    Block,
    quarters,
    ways,
)


def crossings(block: Block) -> Iterator[tuple[slice, float, float, np.ndarray]]:
    """Parts of an arc: rows, crossed recirculations too many, E/2h by geometry, and the place there."""
    radius = math.dist(block.place[0, :2], block.centre)
    for first in range(0, len(block.pulses) - 400, 400):
        rows = slice(first, first + 400)
        opened = block.was_open[rows]
        crossed = int((opened & (block.ratio[:-1][rows] < 0)).sum())
        straight = int(opened.sum()) - crossed
        here = block.place[:-1][rows][opened][:, :2].mean(axis=0)
        chord = math.dist(here, block.end[:2])
        if chord > radius / 4 and opened.sum() > 60:
            twice_h = math.sqrt(4 * radius**2 - chord**2)
            yield rows, crossed - straight * chord / twice_h, chord / twice_h, here


def test_claim_23_the_tangent_is_the_chord_and_twice_the_perpendicular() -> None:
    """What enters the residues is, in the mean, E + A with A = E · E/2h at a right angle to E."""
    seen = 0
    for block in quarters():
        for rows, _, ratio, here in crossings(block):
            opened = block.was_open[rows]
            came = block.entered[rows][opened, :2].mean(axis=0) * (1 + ratio)
            chord = block.end[:2] - here
            across = block.sense * ratio * np.array([chord[1], -chord[0]])
            # 5 %: an error more or less crossed in 60
            assert math.dist(came, chord + across) < 0.05 * math.hypot(*came)
            radial = came @ (here - block.centre)
            assert abs(radial) < 0.05 * math.hypot(*came) * math.dist(here, block.centre)
            seen += 1
    assert seen > 10


@pytest.mark.parametrize("sense", [COUNTER_CLOCKWISE, CLOCKWISE])
def test_claim_24_errors_are_added_or_taken_by_the_sense_of_rotation(sense: int) -> None:
    start, end = (1_500, 0, 0), (0, 1_500 * sense, 0)
    pulses = ResidueInterpolator(start).arc(end, (0, 0), sense, ALWAYS)
    way = ways(pulses, start)
    turning = np.unwrap(np.arctan2(way[:, 1], way[:, 0]))
    assert turning[-1] == pytest.approx(sense * math.pi / 2)
    assert (np.diff(turning[::100]) * sense > 0).all()


def perpendicular(block: Block) -> np.ndarray:
    """2h of the axis with the smaller error, by equations X and XI, along an arc."""
    place, error = block.place[:-1, :2], block.error[:, :2]
    both = 2 * (block.centre - place) - error
    larger_x = np.abs(error[:, 0]) > np.abs(error[:, 1])
    return np.abs(np.where(larger_x, both[:, 1], both[:, 0]))


def test_claim_25_larger_error_and_smaller_perpendicular_choose_how_the_errors_go_in() -> None:
    """They are crossed E/2h times as often as not, with E and h from the circle's geometry."""
    for block in quarters():
        parts = [(too_many, ratio) for _, too_many, ratio, _ in crossings(block)]
        assert max(abs(too_many) for too_many, _ in parts) <= 2  # one at either end of a part
        # as the chord gets shorter fewer are crossed; at the start of a quarter as many as not
        assert parts[0][1] == pytest.approx(1, rel=0.1) and parts[-1][1] < 0.3


def test_claim_26_one_more_loop_takes_the_larger_and_adds_the_smaller() -> None:
    """Loop Q as it was compiled: - E_m where it is not negative, + 2h where it is, else as it was."""
    for block in quarters():
        largest = np.abs(block.error[:, :2]).max(axis=1)
        change = np.where(block.ratio[:-1] >= 0, -largest, perpendicular(block))
        assert (np.diff(block.ratio) == np.where(block.was_open, change, 0)).all()
        assert block.ratio.min() < 0 < block.ratio.max()


def test_claim_27_where_the_loop_is_positive_errors_go_to_their_own_circuits() -> None:
    for block in quarters():
        straight = block.was_open & (block.ratio[:-1] >= 0)
        assert (block.entered[straight, :2] == block.error[straight, :2]).all()
        assert straight.sum() > 500


def test_claim_28_where_it_is_negative_they_are_crossed_and_one_is_subtracted() -> None:
    for block in quarters():
        crossed = block.was_open & (block.ratio[:-1] < 0)
        to_x, to_y = block.entered[crossed, :2].T
        error_x, error_y = block.error[crossed, :2].T
        assert (to_x == block.sense * error_y).all() and (to_y == -block.sense * error_x).all()
        assert crossed.sum() > 200
