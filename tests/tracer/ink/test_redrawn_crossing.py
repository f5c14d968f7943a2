"""Redrawn crossings: a stroke turns within another's ink, and the ink tells how both go on."""

from __future__ import annotations

import math
from itertools import chain

import numpy as np
import pytest

from morfax.motion.plane import direction, left_of
from morfax.motion.polyline import evenly, nearest_mm
from morfax.tracer.ink import crossing
from morfax.tracer.ink.crossing import Crossing
from morfax.tracer.ink.crossing_ink import WaysOn
from morfax.tracer.program.trace_ink import trace_ink
from tests.tracer.inked import Points, inked

WIDTH_MM = 0.4
FAR_MM = 7.5  # from where a stroke turns to its ends
APART_MM = 20.0
# between a true stroke and the one that was run: a corner within another's ink is known to two thirds of a
# pixel; partners that are exchanged, or a corner that is cut, are 130 um off and more
NEAR_MM = 0.08

# degrees: a stroke turns by so much where another crosses it, at such an angle to both its legs or more
TURNS, LEAST_ACROSS = (30.0, 150.0), 20.0
ASIDE_WIDTHS = 0.8  # of where the one turns: the other passes there
MANY, IN_A_ROW = 12, 4


def _pair(number: int, random: np.random.Generator) -> tuple[Points, Points]:
    """A stroke that turns, and one that crosses it there."""
    vertex = np.array(
        [12.0 + APART_MM * (number % IN_A_ROW), 12.0 + APART_MM * (number // IN_A_ROW)]
    )
    come = random.uniform(0.0, math.tau)
    turn = math.radians(random.uniform(*TURNS)) * random.choice([-1, 1])
    across = come
    while min(abs(math.sin(across - a)) for a in (come, come + turn)) < math.sin(
        math.radians(LEAST_ACROSS)
    ):
        across = random.uniform(0.0, math.pi)
    into, out, way = (direction(a) for a in (come, come + turn, across))
    middle = vertex + random.uniform(-ASIDE_WIDTHS, ASIDE_WIDTHS) * WIDTH_MM * left_of(way)
    bent = np.array([vertex - FAR_MM * into, vertex, vertex + FAR_MM * out])
    return bent, np.array([middle - 1.15 * FAR_MM * way, middle + 1.15 * FAR_MM * way])


@pytest.mark.parametrize("seed", [1, 4, 6])
def test_a_stroke_that_turns_within_another_is_told_from_it_by_the_ink(seed: int) -> None:
    """Of four legs, three meet: the turn was cut by up to 280 um, or taken for the other stroke's."""
    random = np.random.default_rng(seed)
    pairs = [_pair(n, random) for n in range(MANY)]
    found = trace_ink(inked(*chain(*pairs), width_mm=WIDTH_MM, seed=seed)).lines
    for stroke in chain(*pairs):
        true = evenly(stroke, 0.05)
        off_mm = min(float(nearest_mm(true, line.places_mm).max()) for line in found)
        assert off_mm < NEAR_MM


def test_a_crossing_that_is_redrawn_is_held_against_its_ink_once(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Its ways explain the ink: other pairs of its legs were tried once more."""
    again = list[WaysOn]()

    def heard(_: Crossing, told: WaysOn) -> WaysOn:
        again.append(told)
        return told

    monkeypatch.setattr(crossing, "told_by_ink", heard)
    random = np.random.default_rng(1)
    pairs = [_pair(n, random) for n in range(MANY)]
    trace_ink(inked(*chain(*pairs), width_mm=WIDTH_MM, seed=1))
    assert not any(told.corners for told in again)
