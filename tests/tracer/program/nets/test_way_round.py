"""A net's outline is run the way round that the operator asks for."""

from __future__ import annotations

import pytest

from morfax.motion.polyline import area_mm2
from morfax.tracer.operator.operator import Operator
from morfax.tracer.program.nets.net_outline import of_net
from morfax.tracer.program.setup import Setup
from tests.tracer.inked import inked
from tests.tracer.program.nets.test_of_nets import BAR, BOX


@pytest.mark.parametrize(("direction", "sign"), [("ccw", 1), ("cw", -1)])
def test_the_outline_of_a_net_runs_the_way_round_that_is_asked_for(
    direction: str, sign: int
) -> None:
    operator = Operator(direction=direction)  # type: ignore[arg-type]
    line = of_net(Setup(inked(BOX, BAR, seed=3).sheet, operator=operator)).line
    assert line is not None and line.ending == "closed"
    assert sign * area_mm2(line.loop_mm) > 500
