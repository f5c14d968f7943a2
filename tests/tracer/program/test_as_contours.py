"""A patch whose strokes fail its narrow bays is the closed contour that explains its ink."""

from __future__ import annotations

import pytest

from morfax.tracer.program.program import Trace
from morfax.tracer.program.trace_ink import trace_ink
from tests.tracer.inked import Points, arc, inked, polyline
from tests.tracer.program.laid.test_bridges import points_of, shapes
from tests.tracer.program.laid.test_narrow_bays import (
    DEEP_MM,
    WIDTH_MM,
    plate,
    with_bay,
)
from tests.tracer.program.laid.ways import off_mm

UM = 1e-3

BAYS = [
    pytest.param(with_bay(widths * WIDTH_MM, deep_mm, 0.4), id=f"{widths}-{deep_mm}")
    for widths in (1.1, 1.5, 2.0)
    for deep_mm in (DEEP_MM, -DEEP_MM)
]


def all_ink(*lines: Points) -> Trace:
    """All the ink of a sheet."""
    return trace_ink(inked(*lines, width_mm=WIDTH_MM, dpi=300, seed=1))


@pytest.mark.parametrize("truth", BAYS)
def test_a_plate_with_a_narrow_bay_is_one_closed_line(truth: Points) -> None:
    """Within 60 um, 0.7 of a pixel of 300 dpi; strokes run 0.3 mm beside the sides of the bay."""
    trace = all_ink(truth)
    (line,) = trace.lines
    assert line.ending == "closed" and off_mm(line, truth) < 60 * UM
    assert not trace.unexplained


@pytest.mark.parametrize("widths", [0.5, 0.9])
@pytest.mark.parametrize("name", ["bent stalk", "keyhole"])
def test_a_bar_that_is_bent_or_leads_to_a_small_hole_is_of_one_closed_line(
    name: str, widths: float
) -> None:
    """Within 0.1 mm, a pixel and a bit of 300 dpi."""
    truth = points_of(shapes(widths * WIDTH_MM)[name])
    (line,) = all_ink(truth).lines
    assert line.ending == "closed" and off_mm(line, truth) < 100 * UM


def test_a_tick_and_a_bar_from_side_to_side_stay_strokes() -> None:
    tick, bar = polyline((12, 20), (12, 22)), polyline((24, 4), (24, 20))
    trace = all_ink(plate(), tick, bar)
    lengths_mm = sorted(line.length_mm for line in trace.lines)
    assert lengths_mm == pytest.approx([2.0, 16.0, 92.0], abs=0.6)


def test_strokes_that_end_on_bare_paper_are_not_followed_as_a_contour(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A closed line would leave the chord's ends out: that is known before the head runs."""
    followed = list[object]()
    room = "morfax.tracer.program.as_contours"
    monkeypatch.setattr(f"{room}._broken_at", lambda *_: [])
    monkeypatch.setattr(f"{room}._contour", lambda *args: followed.append(args))
    assert len(all_ink(plate(), polyline((2, 12), (38, 12))).lines) == 2
    assert not followed
    all_ink(plate(), polyline((4, 12), (34, 12)))  # both ends are on the plate
    assert len(followed) == 1


def test_a_bent_slot_whose_sides_run_together_is_told() -> None:
    """The compass lays straight slots only, and a stroke in the middle is half a line beside each side."""
    sides = arc((14, 12), 2.0, 60, 120), arc((14, 12), 2.0 + WIDTH_MM, 60, 120)
    trace = all_ink(plate(), *sides)
    (place,) = trace.unexplained
    assert place.kind == "broad"
    assert place.place_mm == pytest.approx((14, 14.2), abs=0.5)
