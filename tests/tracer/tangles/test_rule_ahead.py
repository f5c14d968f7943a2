"""Teeth whose sides are no longer than a line or two are wide are followed all along, over all their corners:
no side of them is a leg, and where they stand close their inks run together.
"""

from __future__ import annotations

import copy
import pickle
from collections.abc import Iterable

import numpy as np
import pytest

from morfax.motion.arrays import Array
from morfax.motion.contour import distance
from morfax.motion.polyline import with_places
from morfax.tracer.program.trace import trace
from morfax.tracer.sensing.leg import Leg
from morfax.tracer.tangles import folding_rule, rule_ahead
from morfax.tracer.tangles.folding_rule import Rule
from morfax.tracer.tangles.memory import Tangles
from morfax.tracer.tangles.seen_ink import SeenInk
from tests.tracer.inked import UM, inked, polyline
from tests.tracer.tangles.pen_ink import ink_along

# two thirds of a pixel of 85 um: the head that runs by legs alone leaves millimetres of such teeth out
CORNER_MM = 60 * UM


def saw(pitch_mm: float, high_mm: float, lean_mm: float, turned_deg: float) -> Array:
    """A bar with nine teeth along one side, upright in front and sloping behind; closed."""
    feet = [(k * pitch_mm, 0.0) for k in range(10)]
    tips = [(x + lean_mm, high_mm) for x, _ in feet]
    teeth = [place for pair in zip(feet, tips, strict=True) for place in pair]
    bar = [(-4.0, 0.0), *teeth, (10 * pitch_mm, 0.0), (10 * pitch_mm + 4, 0.0)]
    bar += [(10 * pitch_mm + 4, -5.0), (-4.0, -5.0), (-4.0, 0.0)]
    angle = np.radians(turned_deg)
    turning = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    places = np.array(bar) @ turning
    return polyline(*(places - places.min(axis=0) + 6))


@pytest.mark.parametrize(
    ("pitch_mm", "high_mm", "turned_deg"),
    [
        (1.5, 1.4, 20.0),
        (1.5, 1.4, 52.0),
        (1.8, 1.4, 20.0),
        # the last side was cut aslant
        (1.3, 1.2, 350.0),
        # on a side the head feels no leg, and knows that the rule led it there
        (1.3, 1.2, 20.0),
        (1.3, 1.2, 80.0),
        # the slits between the teeth are narrower than a pixel: no ink is as broad as the line for long
        (1.13, 1.15, 200.0),
    ],
)
def test_teeth_with_sides_of_few_widths_are_followed_all_along(
    pitch_mm: float, high_mm: float, turned_deg: float
) -> None:
    line = saw(pitch_mm, high_mm, 0.1 * pitch_mm, turned_deg)
    run = trace(inked(line, seed=1)).lines[0]
    assert run.ending == "closed"
    assert distance(line, run.xy_mm).path_to_reference.max_mm < CORNER_MM


def test_rules_of_few_corners_are_fitted_only_where_one_of_most_explains_the_ink(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """What that leaves fewer corners leave as well: of a line with a further one in its ink, much."""
    asked, explained = list[int](), folding_rule.explained

    def counted(ink: SeenInk, rules: Iterable[Rule], of_bay: bool) -> Rule | None:
        some = list(rules)
        asked.append(len(some[0].corners_mm))
        return explained(ink, some, of_bay)

    monkeypatch.setattr(folding_rule, "explained", counted)
    way = with_places(np.array([(1.0, 3.0), (3.0, 3.0), (3.0, 5.0), (6.0, 5.0)]), 0.1)
    tooth = ink_along(way, 0.085, 90)
    found = rule_ahead._explained(tooth, way, 0.1)
    assert found is not None and len(found.corners_mm) == 2 and asked == [4, 1, 2]
    asked.clear()
    more = ink_along(np.vstack([way, (4.5, 6.5), (4.5, 3.5)]), 0.085, 90)
    assert rule_ahead._explained(more, way, 0.1) is None and asked == [4]


def test_the_side_that_a_rule_led_onto_decides_the_way_on() -> None:
    """Heads that remember other sides are not the same: one of them may come onto a side as its rule lay."""
    memory = Tangles()
    before = pickle.dumps(memory.state)
    memory._side = Leg(np.array([5.0, 5.0]), 0.0, 0.0, 0.5, np.empty((0, 3)))
    assert pickle.dumps(memory.state) != before
    assert pickle.dumps(copy.deepcopy(memory).state) == pickle.dumps(memory.state)
