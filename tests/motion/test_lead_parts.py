"""Lead parts: what lies before and after the contour of a closed run is raised; of other runs nothing."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.motion.lead_parts import MEET_MM, without_leads
from morfax.motion.motion import Path
from morfax.motion.polyline import length_mm

SQUARE = [(0, 0), (10, 0), (10, 20), (-10, 20), (-10, 0), (0, 0)]
ANGLES = np.linspace(-np.pi / 2, 0, 80)
LEAD_IN = [
    (float(3 * np.sin(a)), float(3 * np.cos(a) - 3)) for a in ANGLES
]  # touches the square in (0, 0), along X


def path(places: list[tuple[float, float]]) -> Path:
    """The tool down along places, one after the other, a second for each."""
    rows = [(x, y, -1.0) for x, y in places]
    whole = [(*places[0], 2.0), *rows, (*places[-1], 2.0)]
    return Path(np.arange(float(len(whole))), np.array(whole))


@pytest.mark.parametrize(
    ("places", "contour_mm"),
    [
        ([*LEAD_IN, *SQUARE[1:]], 80.0),
        ([*LEAD_IN, *SQUARE[1:], (1, -1)], 80.0),
        ([(-2, -2), *SQUARE, (1, -1)], 80.0),
        ([(-2, -2), *SQUARE, *SQUARE[1:], (1, -1)], 160.0),  # two passes
        (SQUARE, 80.0),
        (SQUARE[:-1], 70.0),  # open
        ([(0, 0), (30, 0)], 30.0),
    ],
    ids=["lead-in", "both", "straight", "two passes", "none", "open", "line"],
)
def test_a_run_without_its_leads_is_its_contour(
    places: list[tuple[float, float]], contour_mm: float
) -> None:
    """Where an arc leaves its line is known by 4 um across it: of an arc of 3 mm 0.16 mm along it."""
    (run,) = without_leads(path(places)).runs()
    assert length_mm(run) == pytest.approx(contour_mm, abs=0.16 + 2 * MEET_MM)


def test_nothing_is_left_out_of_the_path_but_its_depth() -> None:
    led = path([*LEAD_IN, *SQUARE[1:], (1, -1)])
    raised = without_leads(led)
    assert length_mm(raised.xy_mm) == pytest.approx(length_mm(led.xy_mm), abs=1e-9)
    assert np.all(np.diff(raised.t_s) >= 0)
