"""The aperture on a large sheet: what cells see there is what they see of the whole sheet behind the spot."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter, map_coordinates

from morfax.motion.arrays import Array
from morfax.tracer.drawing.tiles import PAPER, TILE_PX, Tiles
from morfax.tracer.sensing import aperture

ROWS, COLUMNS = 150, 110  # neither is a whole number of tiles
UNIT = 1 / 200
FLOAT32 = 1e-6  # of darkness: made tiles are kept with 24 bits


def sheet() -> tuple[Tiles, Array]:
    """Random ink on four tiles of a large sheet, and the same as a whole."""
    chance = np.random.default_rng(5)
    number = np.full((-(-ROWS // TILE_PX), -(-COLUMNS // TILE_PX)), PAPER, np.int32)
    inked = [(0, 0), (1, 1), (4, 3), (2, 1)]
    kept = chance.integers(0, 200, (len(inked), TILE_PX, TILE_PX)).astype(np.uint8)
    for k, place in enumerate(inked):
        number[place] = k
    tiles = Tiles((ROWS, COLUMNS), number, kept, UNIT)
    return tiles, np.asarray(tiles, float)


@pytest.fixture(params=[False, True], ids=["kernel", "plain"])
def organ(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> Any:
    """The kernels, and the same in plain Python."""
    if request.param:
        for name, kernel in list(vars(aperture).items()):
            if hasattr(kernel, "py_func"):
                monkeypatch.setattr(aperture, name, kernel.py_func)
    return aperture


@pytest.mark.parametrize("spread_px", [0.0, 0.7, 2.0])
def test_a_cell_sees_what_it_sees_of_the_whole_sheet(organ: Any, spread_px: float) -> None:
    tiles, whole = sheet()
    blurred = gaussian_filter(whole, spread_px, mode="nearest", truncate=4.0)
    made = organ.MadeTiles.of(tiles, spread_px)
    chance = np.random.default_rng(1)
    x, y = chance.uniform(0.5, COLUMNS - 0.5, 300), chance.uniform(0.5, ROWS - 0.5, 300)
    told = map_coordinates(blurred, [ROWS - y - 0.5, x - 0.5], order=1)
    seen = [organ.darkness_at(made, *place) for place in zip(x, y, strict=True)]
    assert seen == pytest.approx(
        told, abs=2 * FLOAT32 + (5e-5 if spread_px else 0)
    )  # beyond 4 spreads


def test_outside_the_middles_of_the_outermost_pixels_is_paper(organ: Any) -> None:
    tiles = Tiles(
        (64, 32), np.zeros((2, 1), np.int32), np.full((1, 32, 32), 200, np.uint8), UNIT
    )
    made = organ.MadeTiles.of(tiles, 0.0)
    inside, outside = (0.51, 31.49), (0.49, 31.51, -5.0)
    for x in inside:
        assert organ.darkness_at(made, x, 20.0) == pytest.approx(1.0)
        assert organ.darkness_at(made, 16.0, 2 * x) == pytest.approx(1.0)
    for x in outside:
        assert organ.darkness_at(made, x, 20.0) == 0.0
        assert organ.darkness_at(made, 16.0, x if x < 1 else x + 32) == 0.0


def test_a_tile_that_gave_way_is_made_again(organ: Any) -> None:
    """With room for two tiles only, wherever the head goes and comes back to."""
    tiles, whole = sheet()
    full = organ.MadeTiles.of(tiles, 0.0)
    small = full._replace(made=full.made[:2].copy(), owner=full.owner[:2].copy())
    for row, column in [(3, 3), (20, 20), (40, 40), (3, 3), (90, 60), (20, 20), (40, 40)]:
        place = column + 0.5, ROWS - row - 0.5
        assert organ.darkness_at(small, *place) == pytest.approx(
            whole[row, column], abs=FLOAT32
        )
        # each made tile knows its place, and no other place counts as made
        kept = [tuple(owner) for owner in small.owner if owner[0] >= 0]
        assert sorted(kept) == sorted(zip(*np.nonzero(small.place >= 0), strict=True))


def test_a_window_is_what_is_on_the_sheet(organ: Any) -> None:
    tiles, whole = sheet()
    made = organ.MadeTiles.of(tiles, 0.0)
    assert organ.window(made, 5, 70, 20, 41) == pytest.approx(whole[5:70, 20:41], abs=FLOAT32)
    assert organ.window(made, 140, 999, 90, 999) == pytest.approx(whole[140:, 90:], abs=FLOAT32)
    assert organ.window(made, 200, 210, 0, 7).shape == (0, 7)
    assert organ.window(made, 0, 7, 200, 210).shape == (7, 0)


def test_a_spot_behind_a_spot_is_as_wide_as_both() -> None:
    tiles, whole = sheet()
    both = aperture.MadeTiles.of(tiles, 1.2).wider(1.6)
    assert both.spread_px == pytest.approx(2.0)
    seen = aperture.window(both, 0, ROWS, 0, COLUMNS)
    assert seen == pytest.approx(
        gaussian_filter(whole, 2.0, mode="nearest", truncate=4.0), abs=2 * FLOAT32
    )
    # the sheet far from all ink was never made
    assert (both.place == aperture.PAPER).any()
