"""A window on a sheet: what the cells see there is what they see of the whole sheet, to the rounding."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.sensing import photocell
from tests.tracer.inked import Points

PITCH_MM = 25.4 / 300
ROUNDING = 2.4e-7  # of darkness 1: two units in the last place of float32; sums are taken in other parts


@pytest.mark.parametrize("window", [(301, 207, 503, 411), (0, 0, 90, 60), (560, 610, 600, 700)])
@pytest.mark.parametrize("aperture_mm", [0.05, 0.1, 0.1733, 0.24])
def test_cells_see_the_same_in_a_window(
    aperture_mm: float, window: tuple[int, int, int, int]
) -> None:
    sheet = Drawing(np.random.default_rng(3).random((600, 700), np.float32), PITCH_MM)
    top, left, bottom, right = window
    whole = photocell.behind_aperture(sheet, aperture_mm)
    part = photocell.behind_aperture(sheet, aperture_mm, window=window)
    assert part.shape == whole.shape == (600, 700)
    seen = part.window(0, 600, 0, 700).copy()
    off = np.abs(seen[top:bottom, left:right] - whole.darkness[top:bottom, left:right])
    assert off.max() <= ROUNDING
    if aperture_mm > 0.1:  # a smaller one changes nothing, and the sheet itself is handed out
        assert part.darkness.size < sheet.darkness.size / 3
        seen[top:bottom, left:right] = 0
        assert not seen.any()


@pytest.mark.parametrize("window", [(301, 207, 503, 411), (0, 0, 90, 60), (560, 610, 640, 740)])
def test_a_part_is_looked_at_as_if_paper_were_all_about_it(
    window: tuple[int, int, int, int],
) -> None:
    """Also between its rim and the paper, at the sheet's own rim, and behind a further spot."""
    rng = np.random.default_rng(4)
    sheet = Drawing(rng.random((600, 700), np.float32), PITCH_MM)
    part = photocell.behind_aperture(sheet, 0.2, window=window)
    shown = part._replace(darkness=part.window(0, 600, 0, 700).copy(), beyond=(0, 0, 0, 0))
    top, left, bottom, right = window
    columns = rng.uniform(left - 3, right + 3, 4000)
    rows = rng.uniform(top - 3, bottom + 3, 4000)
    places = np.column_stack([columns, 600 - rows]) * PITCH_MM
    for one, other in ((part, shown), _wider(part, shown, places)):
        assert one.shape == other.shape
        seen = photocell.darkness_along(one, places)
        assert np.array_equal(seen, photocell.darkness_along(other, places)) and seen.any()
        some = photocell.darkness_at.py_func(one, *places[7])
        assert some == photocell.darkness_at.py_func(other, *places[7])
    for cut in ((top - 2, bottom - 5, left + 3, right + 4), (0, top + 1, 0, left + 1)):
        cut = tuple(max(side, 0) for side in cut)
        assert np.array_equal(part.window(*cut), shown.window(*cut))


def _wider(
    part: photocell.Cells, shown: photocell.Cells, places: Points
) -> tuple[photocell.Cells, photocell.Cells]:
    """Both behind a further spot, about a quarter of the places."""
    some = places[np.all(places < np.median(places, axis=0), axis=1)]
    one, other = (cells.wider(1.5, some, 0.3) for cells in (part, shown))
    return one, other
