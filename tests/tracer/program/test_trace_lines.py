"""The tour: of what the head made of a line from an open end and round about, which is the line."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.tracer.following.line import Line
from morfax.tracer.head.settings import Settings
from morfax.tracer.operator.operator import Operator
from morfax.tracer.program import trace_lines as tour
from tests.tracer.inked import arc, inked

DRAWING = inked(arc((16, 16), 10))


def line(ending: str, length_mm: float, ink_mm: float = 100.0) -> Line:
    return Line(
        np.column_stack([np.linspace(0, length_mm, 50), np.zeros(50)]),
        ending,
        0.5,
        length_mm,
        ink_mm=ink_mm,
    )


@pytest.mark.parametrize(
    ("from_end", "round_about", "taken"),
    [
        (
            line("joined", 40),
            line("closed", 95),
            "round",
        ),  # an end that is none led round a part of the ink
        (line("joined", 40), line("closed", 30), "end"),  # a stem that leads to a small loop
        (line("joined", 40), line("joined", 95), "end"),
        (
            line("joined", 70),
            line("closed", 95),
            "end",
        ),  # a stem, and the loop that it leads to
        (line("ended", 40), line("closed", 95), "end"),
        (None, line("closed", 95), "round"),
    ],
)
def test_a_line_from_an_end_that_leads_round_little_of_the_ink_gives_way(
    monkeypatch: pytest.MonkeyPatch, from_end: Line | None, round_about: Line, taken: str
) -> None:
    monkeypatch.setattr(tour, "followed_from_an_end", lambda *_: from_end)
    monkeypatch.setattr(tour, "followed", lambda *_, **__: round_about)
    monkeypatch.setattr(tour, "_joined", lambda *_: ([], 0.0))
    found = tour.trace_lines(DRAWING, (1,), Settings(), Operator()).lines
    # type: ignore[union-attr]
    assert [each.length_mm for each in found] == [
        (from_end if taken == "end" else round_about).length_mm
    ]
