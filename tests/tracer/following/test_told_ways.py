"""Ways out that the operator has told: they come before what the head sees, and count as junctions."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from morfax.tracer.corrections.on_sheet import TurnAt
from morfax.tracer.following import ways_out
from morfax.tracer.following.ways_out import Turns, WaysOut
from morfax.tracer.head.settings import Settings
from morfax.tracer.junctions.planner import Planner
from morfax.tracer.sensing.leg import leg_of
from tests.tracer.inked import inked, polyline
from tests.tracer.junctions.test_choice import X_MM, come_along

ALONG = polyline((4, 10), (24, 10))
ACROSS = polyline((X_MM, 4), (X_MM, 16))
PLACE = (X_MM, 10.0)


@pytest.mark.parametrize(("lines", "counted"), [((ALONG, ACROSS), 1), ((ALONG,), 0)])
def test_a_junction_that_is_gone_through_as_told_counts_where_there_is_a_choice(
    lines: tuple[Any, ...], counted: int
) -> None:
    """Corrections for later junctions are numbered by it; where only one way leads on there is none."""
    view, _, trail = come_along(inked(*lines))
    incoming = leg_of(view.feel(np.array([X_MM - 4.0, 10.0]), 0.0, 3.0), True, view.leg_mm)
    ways = WaysOut(Turns(at=(TurnAt(1, "straight", PLACE),)), from_reference=False)
    planner = Planner(view, (incoming.end_mm, 0.0), trail, Settings())
    assert ways.as_told(planner, incoming, _at(trail)) is not None
    assert ways.served == {1}
    assert len(ways.junctions.places_mm) == counted


@pytest.mark.parametrize(("told", "fork"), [(7, 7), (None, 30)])
def test_what_the_operator_says_of_a_place_comes_before_the_fork_that_is_seen(
    monkeypatch: pytest.MonkeyPatch, told: int | None, fork: int
) -> None:
    monkeypatch.setattr(WaysOut, "told_station", lambda *given: told)
    monkeypatch.setattr(ways_out, "fork_in", lambda *given: 30)
    carriage: Any = SimpleNamespace(ink_beside=False)
    ways = WaysOut(Turns(), from_reference=False)
    view: Any = None
    assert ways.fork(view, np.zeros((40, 3)), 2, carriage) == fork


def _at(trail: Any) -> Any:
    """A carriage as far as it matters: it has travelled 10 mm along its trail."""
    return SimpleNamespace(trail=trail, travel_mm=10.0, count=300)
