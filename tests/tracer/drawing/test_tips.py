"""Sharp tips of filled shapes: as drawn down to 15 degrees, and told of with their place below that."""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np
import pytest

from morfax.jobs.remarks.on_ink import of_ink
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.program.program import Trace
from morfax.tracer.program.trace import trace
from tests.tracer.drawing.filled import filled
from tests.tracer.drawing.test_shapes import STEPPED, nearest_um
from tests.tracer.inked import UM, Points

TIP = np.array([32.03, 19.07])
LONG_MM = 22.0


def needle(angle_deg: float, turned_deg: float = 7.0) -> Points:
    """A wedge whose tip is at `TIP`, on a blunt back."""
    half = LONG_MM * math.tan(math.radians(angle_deg) / 2)
    own = np.array(
        [
            [0, 0],
            [-LONG_MM, half],
            [-LONG_MM - 4, half],
            [-LONG_MM - 4, -half],
            [-LONG_MM, -half],
        ]
    )
    c, s = math.cos(math.radians(turned_deg)), math.sin(math.radians(turned_deg))
    turned = TIP + own @ np.array([[c, s], [-s, c]])
    return np.vstack([turned, turned[:1]])


def short_mm(run: Trace) -> float:
    """How far short of the tip a path ends."""
    return float(nearest_um(run.lines[0].xy_mm, TIP[None])[0]) * UM


@pytest.mark.parametrize("angle_deg", [22, 27])
def test_a_tip_that_the_lens_draws_in_by_a_quarter_of_a_mm_is_as_sharp_as_drawn(
    tmp_path: Path, angle_deg: float
) -> None:
    shape = needle(angle_deg, turned_deg=-3)
    run = trace(Drawing.open(filled(tmp_path / "needle.png", shape, seed=2), edge=True))
    assert run.lines[0].ending == "closed" and not run.unexplained
    assert short_mm(run) < 0.03


@pytest.mark.parametrize(("angle_deg", "turned_deg"), [(22, 11), (22, 18), (27, 11), (18, -3)])
def test_one_that_the_picture_shows_and_the_path_cuts_is_told_of_with_its_place(
    tmp_path: Path, angle_deg: float, turned_deg: float
) -> None:
    seed = round((turned_deg + 17) / 7)
    shape = needle(angle_deg, turned_deg)
    run = trace(Drawing.open(filled(tmp_path / "needle.png", shape, seed=seed), edge=True))
    if short_mm(run) < 0.1:
        assert not run.unexplained
        return
    (tip,) = run.unexplained
    assert tip.kind == "tip" and math.dist(tip.place_mm, TIP) < 0.1
    assert tip.length_mm == pytest.approx(short_mm(run), abs=0.1)
    (said,) = [text for text in of_ink(run, several=False) if "short" in text]
    assert "1 tip" in said


@pytest.mark.parametrize("angle_deg", [8, 10, 13])
def test_one_too_sharp_for_the_picture_is_told_of_too(tmp_path: Path, angle_deg: float) -> None:
    drawing = Drawing.open(filled(tmp_path / "needle.png", needle(angle_deg)), edge=True)
    ends_mm = short_mm(trace(drawing))
    (note,) = drawing.notes
    said = re.search(r"ends ([\d.]+) mm short at ([\d.]+),([\d.]+) mm", note)
    assert said is not None
    told_mm, x, y = map(float, said.groups())
    assert ends_mm > 0.4 and told_mm == pytest.approx(ends_mm, rel=0.25)
    assert math.dist((x, y), TIP) < 1.2 * ends_mm + 0.1


def test_a_shape_without_tips_is_told_nothing(tmp_path: Path) -> None:
    assert not Drawing.open(filled(tmp_path / "plate.png", STEPPED), edge=True).notes
