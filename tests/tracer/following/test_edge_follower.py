"""The edge follower: its own cell leads it, and a cell that is out of order follows no edge."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from morfax.motion.contour import distance
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.following.plain_places import edge_view_of
from morfax.tracer.head import carriage
from morfax.tracer.head.leaders import CELL, STATIONS
from morfax.tracer.head.settings import Settings
from morfax.tracer.program.trace import trace
from morfax.tracer.program.trace_lines import trace_lines
from tests.tracer.drawing.filled import CIRCLE, filled
from tests.tracer.drawing.test_shapes import STEPPED, star
from tests.tracer.following.test_agreement import BROKEN
from tests.tracer.inked import UM, arc

SHAPES = {"disc": CIRCLE, "plate": STEPPED, "star": star()}


@pytest.fixture(scope="module")
def drawings(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Drawing]:
    """The shapes, scanned."""
    folder = tmp_path_factory.mktemp("shapes")
    return {
        name: Drawing.open(filled(folder / f"{name}.png", outline), edge=True)
        for name, outline in SHAPES.items()
    }


@pytest.mark.parametrize("name", SHAPES)
def test_its_own_cell_leads_outside_of_corners(drawings: dict[str, Drawing], name: str) -> None:
    run = trace(drawings[name])
    led_mm = run.lines[0].led.lengths_mm(run.xy_mm)
    assert run.ending == "closed"
    assert led_mm[CELL] > 0.95 * (led_mm[CELL] + led_mm[STATIONS]), led_mm
    assert led_mm[CELL] > 0.7 * led_mm.sum(), led_mm  # a star has a corner every 8 mm


@pytest.mark.parametrize("broken", BROKEN)
@pytest.mark.parametrize("name", SHAPES)
def test_a_cell_that_is_out_of_order_follows_no_edge(
    drawings: dict[str, Drawing], broken: str, name: str
) -> None:
    run = trace(drawings[name], None, BROKEN[broken])
    assert run.ending == "lost" and run.length_mm < 10
    assert "swinging cell and the line felt ahead disagree" in str(run.fault)


@pytest.mark.parametrize("broken", ["inverted", "blind", "noisy"])
def test_it_is_found_on_the_way_as_well(
    drawings: dict[str, Drawing], broken: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Without the check of the standing head."""
    monkeypatch.setattr(carriage.Carriage, "hears", lambda self, view: True)
    run = trace(drawings["disc"], None, BROKEN[broken])
    assert run.ending == "lost" and 0 < run.length_mm < 10
    assert "disagree" in str(run.fault)


def test_the_path_is_not_the_librarys(drawings: dict[str, Drawing]) -> None:
    """What the library says of the edges, moved by 50 um, leaves the path where the cell has it."""
    drawing = drawings["disc"]
    moved = Drawing(
        np.roll(drawing.darkness, 1, axis=1),
        drawing.pitch_mm,
        None,
        drawing.enlarged,
        tuple(edge + np.array([0.05, 0.0]) for edge in drawing.edges_mm),
        drawing.shade,
    )
    assert distance(trace(moved).xy_mm[::4], CIRCLE).path_to_reference.rms_mm < 4 * UM


@pytest.mark.parametrize("radius_mm", [0.5, 1.0])
def test_round_small_holes_the_cell_leads(tmp_path: Path, radius_mm: float) -> None:
    hole = arc((15, 16), radius_mm)
    drawing = Drawing.open(filled(tmp_path / "hole.png", CIRCLE, holes=(hole,)), edge=True)
    line = min(trace_lines(drawing).lines, key=lambda line: line.length_mm)
    led_mm = line.led.lengths_mm(line.xy_mm)
    assert line.ending == "closed" and led_mm[CELL] > 0.75 * led_mm.sum(), led_mm
    assert distance(line.xy_mm[::4], hole).path_to_reference.rms_mm < 12 * UM


def test_noise_of_the_cell_does_little_harm(drawings: dict[str, Drawing]) -> None:
    """A fifth of the contrast in each of 24 readings is 13 um a sweep, and a few um over the window."""
    run = trace(drawings["disc"], None, Settings(cell_noise=0.2))
    assert run.fault is None
    assert distance(run.xy_mm[::4], CIRCLE).path_to_reference.rms_mm < 8 * UM


def test_stations_lie_on_the_edge(drawings: dict[str, Drawing]) -> None:
    """Felt once round from one place, with a scan's noise."""
    view = edge_view_of(drawings["disc"], None)
    seen = view.feel_edge(np.array([26.03, 16.0]), np.pi / 2, 62.5)
    away = np.hypot(*(seen[:, :2] - [16, 16]).T) - 10
    assert len(seen) > 2000 and np.sqrt(np.mean(away**2)) < 12 * UM
    assert np.ptp(np.unwrap(np.arctan2(seen[:, 1] - 16, seen[:, 0] - 16))) > 6.2


def test_all_edges_of_a_sheet_are_seen_through_the_same_cells(
    drawings: dict[str, Drawing],
) -> None:
    """They are made of all of the sheet: of a board with hundreds of pads once, and not for each."""
    one, other = edge_view_of(drawings["disc"], None), edge_view_of(drawings["disc"], None)
    assert one.cells is other.cells
    assert edge_view_of(drawings["disc"], 2 * UM + one.cells.pitch_mm).cells is not one.cells
