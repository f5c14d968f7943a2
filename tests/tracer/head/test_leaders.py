"""Who led the head: runs of leaders, and what a trace says of the cell's share of its way."""

from __future__ import annotations

import tracemalloc

import numpy as np
import pytest

from morfax.jobs.remarks.who_led import WhoLed
from morfax.tracer.head.leaders import CELL, MEMORY, STATIONS, Led
from morfax.tracer.program.trace import trace
from morfax.tracer.program.trace_ink import trace_ink
from tests.tracer.inked import UM, arc, inked, polyline

STEPS = np.column_stack([np.arange(6.0), np.zeros(6)])  # positions 1 mm apart
LED = Led((0, 2, 5), (STATIONS, CELL, MEMORY))


def test_each_leader_has_the_way_to_its_positions() -> None:
    assert LED.of(6).tolist() == [STATIONS] * 2 + [CELL] * 3 + [MEMORY]
    assert LED.lengths_mm(STEPS).tolist() == [3.0, 1.0, 1.0, 0.0]
    assert LED.lengths_mm(STEPS[:4]).tolist() == [2.0, 1.0, 0.0, 0.0]  # cut off where it joined
    runs = [(leader, places[[0, -1], 0].tolist()) for leader, places in LED.runs(STEPS)]
    assert runs == [(STATIONS, [0, 1]), (CELL, [1, 4]), (MEMORY, [4, 5])]
    assert Led.along(LED.of(6)) == LED
    assert Led.along(LED.of(0)) == Led()


def test_leaders_are_compared_as_bytes() -> None:
    """Their differences took eight times the room of a coast's leaders, and a quarter of a second."""
    leaders = np.repeat(np.array([CELL, MEMORY], np.int8), 100_000)
    tracemalloc.start()
    led = Led.along(leaders)
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert led == Led((0, 100_000), (CELL, MEMORY))
    assert most < 2 * leaders.nbytes


def test_the_way_back_has_the_same_leaders() -> None:
    assert LED.turned_round(6).of(6).tolist() == LED.of(6)[::-1].tolist()


def test_the_cell_leads_round_a_circle_and_stations_only_onto_it() -> None:
    """The stations lead until the cell's places are half of the window: a lead less the point's distance."""
    line = trace(inked(arc((14, 14), 10), seed=1)).lines[0]
    cell, stations, memory, redrawn = line.led.lengths_mm(line.xy_mm)
    assert stations == pytest.approx(0.75, abs=0.1) and redrawn == 0
    assert memory < 0.9  # from where home is seen, a lead ahead, onto it
    assert cell + stations + memory == pytest.approx(line.length_mm, abs=50 * UM)


def test_a_corner_is_memory_s() -> None:
    """Within a lead of the vertex nothing is the cell's; in the middle of a side all is."""
    square = polyline((4, 4), (24, 4), (24, 24), (4, 24), (4, 4))
    line = trace(inked(square, seed=1)).lines[0]
    leaders = line.led.of(len(line.xy_mm))
    near = np.hypot(*(line.xy_mm[:, None] - square).T).min(axis=0)
    assert set(leaders[near < 0.5]) == {MEMORY}
    assert set(leaders[(near > 4) & (np.hypot(*(line.xy_mm - line.xy_mm[0]).T) > 2)]) == {CELL}


def test_all_the_ink_says_who_led_as_well() -> None:
    """A cross: each stroke is the cell's but for its ends and the crossing."""
    found = trace_ink(inked(polyline((4, 14), (24, 14)), polyline((14, 4), (14, 24)), seed=1))
    led = WhoLed.along(found)
    assert led is not None and 0.7 < led.cell_share < 0.95
    assert sum(led.lengths_mm) == pytest.approx(found.length_mm, abs=0.5)


@pytest.mark.parametrize(("cell_mm", "said"), [(59.0, 1), (61.0, 0)])
def test_a_small_share_of_the_cell_is_told(cell_mm: float, said: int) -> None:
    """Corners and crossings, which memory runs, are no sign that the path is wrong."""
    led = WhoLed((cell_mm, 40.0, 500.0, 0.0))
    assert len(list(led.remarks())) == said
    assert led.figures()["cell_on_lines_share"] == pytest.approx(cell_mm / (cell_mm + 40))


@pytest.mark.parametrize(("width_mm", "advice"), [(1.9, "scan at a higher"), (2.4, "--edge")])
def test_where_lines_are_broader_than_pens_draw_the_advice_is_for_filled_shapes(
    width_mm: float, advice: str
) -> None:
    (said,) = WhoLed((1.0, 40.0, 500.0, 0.0), width_mm=width_mm).remarks()
    assert advice in said
