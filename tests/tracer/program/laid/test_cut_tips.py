"""A tip of about a width that a way cuts is laid where its ink shows it; a tick on a right way is not."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.motion.polyline import nearest_mm, with_places
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.head.leaders import REDRAWN
from morfax.tracer.program.against_ink.in_one_box import with_boxes
from morfax.tracer.program.against_ink.own_ink import OwnInk
from morfax.tracer.program.against_ink.unexplained import Unexplained
from morfax.tracer.program.laid.cut_tips import with_tips
from morfax.tracer.program.setup import Setup
from morfax.tracer.tangles import folding_rule
from tests.tracer.inked import Points, inked, polyline
from tests.tracer.program.against_ink.test_own_ink import closed

OFF_MM = 0.05  # two thirds of a pixel; the tip is 0.5 mm off a way that cuts it
PLATE = (4.0, 4.0), (44.0, 4.0), (44.0, 24.0)


def plate(*upper_side: tuple[float, float]) -> Points:
    """A plate with some places on its upper side."""
    return polyline(*PLATE, *upper_side, (4, 24), (4, 4))


DRAWN = plate((24, 24), (20.0, 24.5), (20.4, 23.7))
RAN = plate((24, 24), (20.4, 23.7))


def laid(drawing: Drawing, way: Points) -> OwnInk:
    """A way with the tips laid at which a box shows that it is beside its ink."""
    own = OwnInk(drawing, [closed(way)])
    return with_tips(Setup(drawing.sheet), own, with_boxes(own, ()))


@pytest.mark.parametrize("seed", [None, 1, 2])
def test_a_tip_that_was_cut_is_laid(seed: int | None) -> None:
    (line,) = laid(inked(DRAWN, seed=seed), RAN).lines
    truth = with_places(DRAWN, 0.01)
    assert nearest_mm(truth, line.places_mm).max() < OFF_MM
    assert nearest_mm(line.places_mm, truth).max() < OFF_MM
    assert REDRAWN in line.led.leaders, "the head runs there from memory"


def test_of_two_strands_the_one_that_was_cut_is_laid() -> None:
    """A tip within the ink of another side, which is told at that side."""
    begin, far = (
        ((4.0, 6.0), (34.2, 6.0)),
        ((20.0, 27.0), (34.6, 27.0), (34.6, 3.0), (4.0, 3.0)),
    )
    drawn = polyline(*begin, (34.2, 16.8), (33.55, 16.0), *far, begin[0])
    ran = polyline(*begin, (34.2, 15.9), (33.55, 16.0), *far, begin[0])
    drawing, told = inked(drawn, seed=1), Unexplained((34.6, 16.4), 0.5, "beside")
    (line,) = with_tips(Setup(drawing.sheet), OwnInk(drawing, [closed(ran)]), [told]).lines
    truth = with_places(drawn, 0.01)
    assert nearest_mm(truth, line.places_mm).max() < OFF_MM


def test_a_way_on_its_ink_is_as_it_was() -> None:
    drawing = inked(DRAWN, polyline((30, 24), (30, 25)), seed=1)
    own = OwnInk(drawing, [closed(DRAWN)])
    assert with_tips(Setup(drawing.sheet), own, with_boxes(own, ())) is own


def test_rules_by_a_tip_turn_there() -> None:
    way, tip_mm = np.array([[0.0, 0.0], [1.0, 0.1], [2.0, 0.0]]), np.array([1.2, 0.6])
    rules = list(folding_rule.by_tip(way, tip_mm, 0.25))
    assert {len(rule.corners_mm) for rule in rules} == {1, 2}
    assert (
        sum((rule.corners_mm == tip_mm).all(axis=1).any() for rule in rules) == len(rules) - 1
    )
    assert not any(rule.rounded.any() for rule in rules)
