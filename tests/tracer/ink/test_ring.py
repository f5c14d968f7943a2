"""A ring in all the ink: the head goes round as round a contour, at its speed, and by its own cell."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.motion.usual import MOTION_RATE_HZ
from morfax.tracer.following.follower import Follower
from morfax.tracer.head.leaders import share_of_cell
from morfax.tracer.head.settings import Settings
from morfax.tracer.ink import ring
from morfax.tracer.program import trace_ink as all_ink
from morfax.tracer.program.trace_ink import trace_ink
from tests.tracer.inked import UM, arc, inked, polyline

MIDDLE_MM, RADIUS_MM = (8.0, 8.0), 3.0


def off_mm(places: np.ndarray) -> np.ndarray:
    """How far places are outside the circle, mm."""
    return np.hypot(*(places - MIDDLE_MM).T) - RADIUS_MM


def test_the_head_goes_round_a_ring_at_its_own_speed() -> None:
    """By its slow cell it took three times as long, and led by 88 % of the way."""
    (line,) = trace_ink(inked(arc(MIDDLE_MM, RADIUS_MM), seed=1)).lines
    round_s = line.length_mm / Settings().speed_mm_s
    assert line.ending == "closed"
    assert len(line.xy_mm) < 1.1 * round_s * MOTION_RATE_HZ  # it sets out from rest
    assert share_of_cell(line.led.lengths_mm(line.xy_mm)) > 0.9


@pytest.mark.parametrize(("width_mm", "within_um"), [(0.5, 1.4), (0.8, 2.0)])
def test_the_sweep_stands_square_to_the_ring(width_mm: float, within_um: float) -> None:
    """Aslant to the line the cell saw a middle that was 1.7 and 5.0 um within the circle."""
    (line,) = trace_ink(inked(arc(MIDDLE_MM, RADIUS_MM), width_mm=width_mm)).lines
    assert abs(float(np.mean(off_mm(line.xy_mm)))) < within_um * UM


def test_a_head_that_does_not_come_round_follows_the_ring_as_a_chain(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    whole = Follower.follow
    monkeypatch.setattr(Follower, "follow", lambda self, _, told: whole(self, 5.0, told))
    (line,) = trace_ink(inked(arc(MIDDLE_MM, RADIUS_MM))).lines
    assert line.ending == "closed"
    assert float(np.abs(off_mm(line.xy_mm)).max()) < 10 * UM


def test_a_head_off_what_was_felt_is_not_believed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(ring, "nearest_mm", lambda places, _: np.ones(len(places)))
    taken = list[object]()
    monkeypatch.setattr(
        all_ink, "stroke_round", lambda *given: taken.append(ring.stroke_round(*given))
    )
    trace_ink(inked(arc(MIDDLE_MM, RADIUS_MM)))
    assert taken == [None]


def test_a_line_with_ends_and_lines_that_meet_are_no_rings(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    taken = list[object]()
    monkeypatch.setattr(
        all_ink, "stroke_round", lambda *given: taken.append(ring.stroke_round(*given))
    )
    crossed = polyline((2, 8), (14, 8))
    apart = polyline((20, 4), (20, 12))
    trace_ink(inked(arc(MIDDLE_MM, RADIUS_MM), crossed, apart))
    assert taken and all(stroke is None for stroke in taken)
