"""The head on a chain of lines: who leads where its cell stops."""

from __future__ import annotations

import pytest

from morfax.tracer.head.carriage import CHUNK, Carriage
from morfax.tracer.head.leaders import CELL, MEMORY, STATIONS
from morfax.tracer.head.state import TIGHT, Home
from morfax.tracer.ink.track import InkHead
from morfax.tracer.program.trace_ink import trace_ink
from morfax.tracer.sensing.view import View
from tests.tracer.inked import inked, polyline

# the head sets out from rest: so it comes to within half a lead of its last place
MORE_SAMPLES = 300


def test_a_cell_that_stops_just_before_a_run_s_end_hands_over_to_memory(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """What is left of a run within half a lead of the cell's last place belongs to what follows the run: on a
    coast of 150 mm stations led 17 pieces of 1 mm just before a corner.
    """
    whole = Carriage.follow

    def stops_late(self: Carriage, view: View, home: Home, samples: int) -> int:
        why = whole(self, view, home, samples if samples == CHUNK else samples + MORE_SAMPLES)
        return why if samples == CHUNK else TIGHT

    monkeypatch.setattr(Carriage, "follow", stops_late)
    monkeypatch.setattr(InkHead, "_slowly", lambda *_: False)
    (line,) = trace_ink(inked(polyline((4, 6), (14, 6)), seed=1)).lines
    assert [leader for leader, _ in line.led.runs(line.xy_mm)] == [STATIONS, CELL, MEMORY]
