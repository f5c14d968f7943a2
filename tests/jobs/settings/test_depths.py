"""Settings of cutting in Z: equal passes by a step, and what goes before the card."""

from __future__ import annotations

import math
from types import SimpleNamespace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from morfax.jobs.settings.depths import DepthSettings, equal_passes_mm, of_tabs
from morfax.jobs.settings.settings import ToolSettings, TraceSettings
from morfax.jobs.wrong_use import WrongUse
from morfax.tracer.operator.card import Card
from morfax.tracer.operator.work import Tabs
from morfax.tracer.program.passes import tabs

COUNT_MM = 0.01


@given(depth=st.integers(1, 20_000), step=st.integers(1, 5_000))
def test_equal_passes_are_whole_counts_as_few_as_can_be_and_none_above_the_step(
    depth: int, step: int
) -> None:
    passes = [*equal_passes_mm(depth * COUNT_MM, step * COUNT_MM), depth * COUNT_MM]
    counts = [round(pass_mm / COUNT_MM) for pass_mm in passes]
    assert passes == pytest.approx([count * COUNT_MM for count in counts], abs=1e-9)
    cuts = [after - before for before, after in zip([0, *counts], counts, strict=False)]
    assert max(cuts) <= step and max(cuts) - min(cuts) <= 1
    assert len(passes) == math.ceil(depth / step)


def test_five_mm_by_steps_of_one_and_a_half_are_four_passes() -> None:
    assert equal_passes_mm(5.0, 1.5) == (1.25, 2.5, 3.75)
    assert equal_passes_mm(5.0, 5.0) == equal_passes_mm(5.0, 9.0) == ()


def settings(**depths: float) -> TraceSettings:
    return TraceSettings(depths=DepthSettings(**depths))  # type: ignore[arg-type]


def test_options_go_before_the_card() -> None:
    card = Card.parse(
        'entry = "5mm"\ntabs = { count = 4, width = "5mm" }\npeck = "3mm"\n'
        '[[stop]]\ndrill = { depth = "8mm" }\n'
    )
    assert card.peck_mm == 3.0 and card.stops[0].drill is not None
    assert card.stops[0].drill.peck_counts == 300
    asked = DepthSettings(ramp_rad=0.1, tab_height_mm=2.0, peck_mm=2.0).on(card)
    assert asked.entry_mm is None and asked.ramp_rad == 0.1
    assert asked.tabs == Tabs(4, 5.0, 2.0) and asked.stops[0].drill is not None
    assert asked.peck_mm == 2.0 and asked.stops[0].drill.peck_counts == 200
    assert DepthSettings(tabs=0).on(card).tabs is None


def test_a_step_and_passes_go_together_only_where_they_are_the_same() -> None:
    card = Card.parse('passes = ["1.5mm", "3mm"]')
    same = settings(step_down_mm=1.5)
    assert same.operator(same.depths.on(card), None).work.depths_mm == (1.5, 3.0)
    other = settings(step_down_mm=1.0)
    with pytest.raises(
        WrongUse, match=r"the card has passes of 1\.5, 3 mm, and --step-down 1mm"
    ):
        other.operator(other.depths.on(card), None)


def test_a_tab_is_longer_by_the_cutter_that_the_settings_have() -> None:
    asked = TraceSettings(tool=ToolSettings(cutter_mm=6.0), depths=DepthSettings(tabs=2))
    assert asked.operator(asked.card(), None).work.cutter_mm == 6.0


def test_a_remark_on_missing_tabs_tells_the_radius_that_tabs_need(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    line = SimpleNamespace(number=2, comes_round=True)
    work = SimpleNamespace(tabs=Tabs(3, 5.0, 2.0), cutter_mm=3.0)
    trace = SimpleNamespace(work=work, lines=[line], tabs=[()])
    monkeypatch.setattr(tabs, "is_milled_away", lambda line, cutter_mm: False)
    for felt_mm, radius in ((tabs.FELT_MM, "3 mm"), (1.0, "6 mm")):
        monkeypatch.setattr(tabs, "FELT_MM", felt_mm)
        told = next(of_tabs(trace))  # type: ignore[arg-type]
        assert "line 2 has none" in told and f"by a radius of {radius} or more" in told
