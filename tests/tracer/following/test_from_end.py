"""Open lines: from end to end, or the other way round where that closes; and where the head ends its run."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from morfax.tracer.following import run_ends
from morfax.tracer.following.attempts import OVERRUN_MM, Attempts
from morfax.tracer.following.followed import Followed
from morfax.tracer.head.settings import Settings
from morfax.tracer.head.stance import Stance
from morfax.tracer.sensing.leg import Leg
from tests.tracer.following.test_attempts import DRAWING, STANCE, run


@pytest.mark.parametrize(
    ("beyond_mm", "is_open"),
    [(-1.0, False), (0.5 * OVERRUN_MM, True), (1.5 * OVERRUN_MM, False)],
)
def test_a_line_that_closes_but_for_the_pen_s_overrun_is_run_from_end_to_end(
    beyond_mm: float, is_open: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Where the pen set out and where it went on to are both drawn; a longer stub is another line's."""
    there, back = run("ended", 42.9), run("ended", 43)
    other = run("closed", back.travel_mm - beyond_mm)

    def known(self: Attempts, stance: Stance, turns: tuple[int, ...] = ()) -> Followed:
        if stance.place_mm[0] != STANCE.place_mm[0]:
            return back
        return there if math.cos(stance.heading_rad) > 0 else other

    monkeypatch.setattr(Attempts, "run", known)
    found = Attempts(DRAWING, Settings(), 100.0).all_of_it(STANCE)
    assert found is (back if is_open else other)


@pytest.mark.parametrize(
    ("end_mm", "choices", "runs_to_mm"),
    [
        (0.7, 0, 0.7),
        (None, 1, 0.0),  # all that leads on has been followed: it ends where its leg was clean
        (None, 0, None),  # lost
    ],
)
def test_the_head_runs_to_the_end_of_the_ink_or_to_where_it_knew_its_line(
    end_mm: float | None,
    choices: int,
    runs_to_mm: float | None,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(run_ends, "end_of", lambda *_: end_mm)
    leg = Leg(np.zeros(2), 0.0, 0.0, 0.5, np.empty((0, 3)))
    head = SimpleNamespace(
        view=None,
        settings=Settings(),
        _home=SimpleNamespace(is_across=lambda *_: False),
        _round_faint_corner=lambda *_: None,
        _lost=lambda _: None,
        _end=lambda _, at_mm, joined: (at_mm, joined),
    )
    ran = cast(Any, run_ends.RunEnds._at_end(cast(Any, head), leg, choices))
    assert ran == (None if runs_to_mm is None else (runs_to_mm, choices > 0))
