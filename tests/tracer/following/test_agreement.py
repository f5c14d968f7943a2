"""A head whose cell is out of order: stations do not take its place, on any line.

The cell points the wrong way (its detector is inverted), hears nothing, is blind, or hears more noise than
line: each run ends within 10 mm with the fault that cell and felt line disagree. Noise of half of the ink's
darkness in every reading is averaged away by the sweep and the drum.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from morfax.motion.compiled import described
from morfax.motion.contour import distance
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.following import follower
from morfax.tracer.following.agreement import AGREES
from morfax.tracer.following.start import put_down
from morfax.tracer.head import carriage, swinging
from morfax.tracer.head.settings import Settings
from morfax.tracer.head.tuning import CALIBRATED_ASIDE, tuned_along
from morfax.tracer.program.trace import trace
from tests.console.conftest import SAMPLES
from tests.tracer.inked import UM, arc, inked, polyline

BROKEN = {
    "inverted": Settings(detector_gain=-1.0),
    "deaf": Settings(detector_gain=0.0),
    "blind": Settings(cell_gain=0.0),
    "noisy": Settings(cell_noise=1.5),
}
STRAIGHT, ROUND = polyline((4, 4), (34, 10)), arc((14, 14), 10)


def drawn(name: str) -> Drawing:
    """A straight line or a circle, inked, or a sample."""
    lines = {"straight": STRAIGHT, "circle": ROUND}
    if name in lines:
        return inked(lines[name], seed=1)
    return Drawing.open(SAMPLES / f"{name}.png")


@pytest.mark.parametrize("broken", BROKEN)
@pytest.mark.parametrize(
    "name", ["straight", "circle", "cam", "bracket", "curve", "gear", "program"]
)
def test_a_cell_that_is_out_of_order_follows_nothing(broken: str, name: str) -> None:
    run = trace(drawn(name), None, BROKEN[broken])
    assert run.ending == "lost" and run.length_mm < 10
    assert "swinging cell and the line felt ahead disagree" in str(run.fault)


@pytest.mark.parametrize("broken", ["inverted", "blind", "noisy"])
def test_it_is_found_on_the_way_as_well(broken: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Without the check of the standing head: where stations overrule the cell three times in a row."""
    monkeypatch.setattr(carriage.Carriage, "hears", lambda self, view: True)
    run = trace(drawn("circle"), None, BROKEN[broken])
    assert run.ending == "lost" and 0 < run.length_mm < 10
    assert "disagree" in str(run.fault)


@pytest.mark.parametrize(("name", "line"), [("straight", STRAIGHT), ("circle", ROUND)])
def test_noise_that_the_sweep_averages_does_no_harm(name: str, line: np.ndarray) -> None:
    """Half of the ink's darkness in each of 24 readings is 30 um a sweep, and a few um over the window."""
    run = trace(drawn(name), None, Settings(cell_noise=0.5))
    assert run.fault is None
    assert distance(run.xy_mm[::4], line).path_to_reference.rms_mm < 12 * UM


def test_the_cell_goes_on_where_it_stands_on_the_line_and_not_beside_it() -> None:
    """12 % of the width off the felt line it is overruled; and as often in a row as that, contradicted."""
    drawing = inked(STRAIGHT, seed=1)
    stance, _ = next(iter(put_down(drawing)))
    head = follower.Follower(stance, Settings(), 6000.0)
    agreement, cell = follower.Agreement(), head.carriage
    seen = stance.view.feel(stance.place_mm, stance.heading_rad, 3.0)
    assert agreement.goes_on_mm(cell, stance.view, seen) == pytest.approx(1.7, abs=0.05)
    cell.state.middle_mm += 0.9 * AGREES * stance.view.width_mm
    assert agreement.goes_on_mm(cell, stance.view, seen) > 0
    cell.state.middle_mm += 0.2 * AGREES * stance.view.width_mm
    for _ in range(3):
        assert not agreement.contradict
        assert agreement.goes_on_mm(cell, stance.view, seen) == 0
    assert agreement.contradict
    # in a row: a cell that has led for more than its own lead since is overruled for the first time
    cell.cell_led_mm += 1.1 * cell.tuning.lead_mm
    assert agreement.goes_on_mm(cell, stance.view, seen) == 0
    assert not agreement.contradict


def test_a_circle_of_small_radius_is_the_cell_s() -> None:
    """A circle of 2.2 mm radius: half the old window was too wide, and stations led it."""
    run = trace(inked(arc((14, 14), 2.2), seed=1))
    line = run.lines[0]
    assert line.cell_share is not None and line.cell_share > 0.7
    off_mm = np.hypot(*(run.xy_mm - 14).T) - 2.2
    assert math.sqrt(float(np.mean(off_mm**2))) < 5 * UM


@pytest.mark.parametrize("radius_mm", [1.4, 1.7])
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_the_head_hears_its_cell_on_a_small_coarse_circle(radius_mm: float, seed: int) -> None:
    """At 150 dpi the cell leads by the circle's radius: it was heard off the line, and the line refused."""
    run = trace(inked(arc((10, 10), radius_mm), dpi=150.0, seed=seed))
    assert run.ending == "closed"


@pytest.mark.parametrize(
    ("radius_mm", "width_mm", "dpi", "seed"),
    [
        (1.72, 0.7, 120.0, 0),
        (0.99, 0.7, 200.0, 0),
        (0.74, 0.5, 300.0, 3),
        (0.82, 0.7, 300.0, 3),
    ],
)
def test_a_hole_tighter_than_the_cell_s_lead_is_no_contradiction(
    radius_mm: float, width_mm: float, dpi: float, seed: int
) -> None:
    """The cell looks ahead along the heading, and stands beside a line that turns away by 34 degrees or more:
    three such stops were taken for a broken cell, and the hole was lost half-way.
    """
    run = trace(inked(arc((8.1, 8.2), radius_mm), width_mm=width_mm, dpi=dpi, seed=seed))
    assert run.ending == "closed"
    off_mm = np.hypot(*(run.xy_mm - (8.1, 8.2)).T) - radius_mm
    assert np.abs(off_mm).max() < 0.5 * 25.4 / dpi


@pytest.mark.parametrize("broken", [None, "inverted", "noisy"])
def test_the_standing_head_hears_in_one_kernel_what_it_heard_sweep_by_sweep(
    broken: str | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each sweep is set off from the same state, whatever the one before made of its own; the head's own
    state stays as it is; and the plain kernel says the same."""
    settings = Settings() if broken is None else BROKEN[broken]
    stance, _ = next(iter(put_down(inked(STRAIGHT, seed=1))))
    head, view = follower.Follower(stance, settings, 6000.0).carriage, stance.view
    own, heard = head.state.copy(), []
    compiled = swinging.goes_back

    def noted(*args: Any) -> float:
        described(
            args
        )  # raises TypeError for what only numba, and no kernel kept on disk, could run
        heard.extend([compiled(*args), compiled.py_func(*args)])
        return float(heard[0])

    monkeypatch.setattr(swinging, "goes_back", noted)
    hears = head.hears(view)
    assert head.state == own
    off_mm, back_mm, stations = CALIBRATED_ASIDE * view.width_mm, 0.0, tuned_along(view)
    tuning = head.tuning._replace(lead_mm=0.0)
    for k in range(stations):
        for side in (-1.0, 1.0):
            state = own.copy()
            state.lead_mm = state.middle_mm = 0.0
            state.x_mm += k * view.step_mm * math.cos(state.heading_rad)
            state.y_mm += k * view.step_mm * math.sin(state.heading_rad)
            back_mm -= side * swinging.heard(view.cells, state, tuning, side * off_mm)
    assert heard == pytest.approx([back_mm, back_mm], rel=1e-12)
    assert hears == (back_mm > carriage.HEARD * 2 * stations * off_mm)
