"""Notches and tongues hardly wider than two lines are laid where the head's own way fails."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
import shapely

from morfax.motion.motion import MOTION_RATE_HZ
from morfax.motion.polyline import with_places
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.head.leaders import REDRAWN
from morfax.tracer.program.against_ink.off_ink import ink_about
from morfax.tracer.program.laid import narrow_bays
from morfax.tracer.program.laid.laid_way import LaidWay
from morfax.tracer.program.laid.line_parts import REACH
from morfax.tracer.program.laid.way_ink import BayInk
from morfax.tracer.program.program import Trace
from morfax.tracer.program.setup import Setup
from morfax.tracer.program.trace import trace
from morfax.tracer.program.trace_ink import trace_ink
from morfax.tracer.program.trace_lines import trace_lines
from morfax.tracer.tangles import folding_rule
from morfax.tracer.tangles.seen_ink import SeenInk
from tests.tracer.inked import Points, inked, polyline
from tests.tracer.program.laid.ways import off_mm, run_along

WIDTH_MM, DEEP_MM = 0.5, 3.0
UM = 1e-3


def plate(*inner: tuple[float, float]) -> Points:
    """A plate of 30 x 16 mm with some places in its upper side."""
    return polyline((4, 4), (34, 4), (34, 20), *inner, (4, 20), (4, 4))


def with_bay(wide_mm: float, deep_mm: float, aside_mm: float = 0.0) -> Points:
    """A plate with a square notch in its upper side, or a tongue if it is not deep, maybe aslant."""
    left, right, end = 18.0, 18.0 + wide_mm, 20 - deep_mm
    return plate((right, 20), (right + aside_mm, end), (left + aside_mm, end), (left, 20))


BAYS = [
    pytest.param(
        with_bay(widths * WIDTH_MM, deep_mm, aside_mm), id=f"{widths}-{deep_mm}-{aside_mm}"
    )
    for widths in (1.1, 1.5, 2.0)
    for deep_mm in (DEEP_MM, -DEEP_MM)
    for aside_mm in (0.0, 0.8)
]


@pytest.mark.parametrize("truth", BAYS)
def test_a_bay_is_followed_as_it_is_drawn(truth: Points) -> None:
    """Within 60 um, 0.7 of a pixel of 300 dpi; half a line is cut off or run past otherwise."""
    (line,) = contours(truth).lines
    assert line.ending == "closed" and off_mm(line, truth) < 60 * UM


@pytest.mark.parametrize("traced", [trace_ink, trace], ids=["all", "one"])
@pytest.mark.parametrize(
    ("widths", "deep_mm"), [(1.1, DEEP_MM), (1.5, DEEP_MM), (1.5, -DEEP_MM)]
)
def test_a_bay_of_an_open_line_is_followed_as_well(
    traced: Callable[[Drawing], Trace], widths: float, deep_mm: float
) -> None:
    """Its end was cut off by 0.3 mm, or the line went past it, and nothing was said."""
    left, right, end = 18.0, 18 + widths * WIDTH_MM, 20 - deep_mm
    truth = polyline(
        (6, 20), (left, 20), (left + 0.8, end), (right + 0.8, end), (right, 20), (30, 20)
    )
    trace = traced(inked(truth, width_mm=WIDTH_MM, dpi=300, seed=1))
    (line,) = trace.lines
    way = shapely.LineString(line.places_mm)
    assert way.hausdorff_distance(shapely.LineString(truth)) < 60 * UM
    assert line.ending == "ended" and not trace.unexplained


def contours(*lines: Points) -> Trace:
    """The contours of a sheet."""
    return trace_lines(inked(*lines, width_mm=WIDTH_MM, dpi=300, seed=1))


def test_the_head_passes_on_to_a_bay_and_from_it_without_a_jump() -> None:
    """Its steps are never longer than 10 mm/s makes them, and a twentieth, which bends add."""
    (line,) = contours(with_bay(1.1 * WIDTH_MM, DEEP_MM)).lines
    assert REDRAWN in line.led.leaders
    speed_mm_s = np.hypot(*np.diff(line.xy_mm, axis=0).T) * MOTION_RATE_HZ
    assert speed_mm_s.max() < 10.5
    assert len(line.led.of(len(line.xy_mm))) == len(line.xy_mm)


def test_a_tick_of_one_line_and_a_bar_to_another_are_no_bays() -> None:
    tick, bar = polyline((12, 20), (12, 22)), polyline((24, 4), (24, 20))
    trace = contours(plate(), tick, bar)
    line = max(trace.lines, key=lambda each: each.length_mm)
    assert line.length_mm == pytest.approx(92, abs=0.5)


def test_the_same_rules_are_fitted_to_the_same_ink_once(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    fitted, explained = list[SeenInk](), folding_rule.explained

    def counted(
        ink: SeenInk, rules: list[folding_rule.Rule], of_bay: bool
    ) -> folding_rule.Rule | None:
        fitted.append(ink)
        assert len(folding_rule.not_far(ink, rules)) == len(rules)  # no others are fitted
        return explained(ink, rules, of_bay)

    monkeypatch.setattr(folding_rule, "explained", counted)
    setup = Setup(inked(with_bay(1.1 * WIDTH_MM, DEEP_MM), width_mm=WIDTH_MM, seed=1).sheet)
    line = run_along(polyline((4, 4), (34, 4), (34, 20), (4, 20), (4, 4)))  # past the bay
    (mended,), _ = narrow_bays.explained(setup, [line])
    first = len(fitted)
    assert first and mended is not line
    (again,), _ = narrow_bays.explained(setup, [line])
    assert len(fitted) == first and np.array_equal(again.xy_mm, mended.xy_mm)
    # of other ink the rules are others
    other = Setup(inked(with_bay(1.1 * WIDTH_MM, 2.5), width_mm=WIDTH_MM, seed=1).sheet)
    narrow_bays.explained(replace(other, rules=setup.rules), [line])
    assert len(fitted) > first


@pytest.mark.parametrize(
    ("gains", "best"),
    [
        ((0.2, 0.5), 0.5),
        ((0.5, 0.2), 0.5),
        ((None, 0.1), 0.1),
        ((0.1, None), 0.1),
        ((None,), None),
    ],
)
def test_of_the_ways_within_the_rims_the_one_counts_that_explains_the_ink_best(
    monkeypatch: pytest.MonkeyPatch, gains: tuple[float | None, ...], best: float | None
) -> None:
    """A way that does not explain it better than the head's, or badly, has no gain, and is no bay."""
    truth = with_bay(1.1 * WIDTH_MM, DEEP_MM)
    drawing = inked(truth, width_mm=WIDTH_MM, seed=1)
    line = run_along(polyline((4, 4), (34, 4), (34, 20), (4, 20), (4, 4)))
    own = with_places(polyline((20, 20), (17, 20)), 0.05)
    ink = ink_about(drawing, own, WIDTH_MM, REACH)
    told = iter(gains)
    rims = [LaidWay((own,), 0.5 * WIDTH_MM) for _ in gains]
    monkeypatch.setattr(narrow_bays, "rim_bays", lambda *_: rims)
    monkeypatch.setattr(narrow_bays, "is_a_pen", lambda *_: False)
    monkeypatch.setattr(narrow_bays._Bays, "_gain", lambda *_: next(told))
    bays = narrow_bays._Bays(Setup(drawing.sheet), line, [line], ())
    suspect = narrow_bays.Suspect(0, len(own) - 1, np.empty((0, 2)), True)
    bay = bays._rim_bay(BayInk(0, len(own) - 1, own, ink), suspect)
    assert (None if bay is None else bay.gain) == best
