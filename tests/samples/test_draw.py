"""The sample drawings: the script draws what is committed, and the ink lies where the truth says.

To make the drawings anew after a change of the script: `python samples/draw.py`.
"""

from __future__ import annotations

import runpy
from pathlib import Path

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

SAMPLES = Path(__file__).parents[2] / "samples"
SCRIPT = runpy.run_path(str(SAMPLES / "draw.py"))
NAMES = tuple(SCRIPT["DRAWINGS"])
PIXELS_PER_MM = 300 / 25.4
UM = 1e-3


def darkness(file: Path) -> NDArray[np.float64]:
    """255 - grey, rows from the top."""
    with Image.open(file) as image:
        return 255.0 - np.asarray(image, float)


def ink_offset_mm(
    dark: NDArray[np.float64], truth_mm: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Centre of mass of the ink across the truth, at the truth's points without both ends, mm."""
    along = truth_mm[2:] - truth_mm[:-2]
    across = np.column_stack([-along[:, 1], along[:, 0]]) / np.hypot(*along.T)[:, None]
    reach_mm = np.linspace(-0.8, 0.8, 161)
    at = truth_mm[1:-1, None] + reach_mm[None, :, None] * across[:, None]
    column = (at[..., 0] * PIXELS_PER_MM - 0.5).astype(np.float32)
    row = (len(dark) - at[..., 1] * PIXELS_PER_MM - 0.5).astype(np.float32)
    seen = cv2.remap(dark.astype(np.float32), column, row, cv2.INTER_LINEAR)
    seen = seen - np.median(seen[:, [0, -1]])
    return np.asarray((seen * reach_mm).sum(axis=1) / seen.sum(axis=1))


@pytest.mark.parametrize("name", NAMES)
def test_the_script_draws_what_is_committed(name: str, tmp_path: Path) -> None:
    SCRIPT["draw"](name, tmp_path)
    assert (tmp_path / f"{name}.csv").read_text() == (SAMPLES / f"{name}.csv").read_text()
    drawn, committed = darkness(tmp_path / f"{name}.png"), darkness(SAMPLES / f"{name}.png")
    assert drawn.shape == committed.shape
    # another version or processor may round a grey value the other way, here and there, by one step
    assert np.abs(drawn - committed).max() <= SCRIPT["GREY_STEP"]
    assert np.mean(drawn != committed) < 1e-3


@pytest.mark.parametrize("name", NAMES)
def test_the_file_carries_its_resolution_and_is_small(name: str) -> None:
    with Image.open(SAMPLES / f"{name}.png") as image:
        assert image.mode == "L"
        assert image.info["dpi"] == pytest.approx(
            (300, 300), abs=0.01
        )  # PNG keeps whole pixels per metre
    assert (SAMPLES / f"{name}.png").stat().st_size < 250_000


@pytest.mark.parametrize("name", ["cam", "curve"])
def test_the_ink_lies_on_the_truth(name: str) -> None:
    truth_mm = np.loadtxt(SAMPLES / f"{name}.csv", delimiter=",", skiprows=1)[:, 1:]
    offset_mm = ink_offset_mm(darkness(SAMPLES / f"{name}.png"), truth_mm)
    assert abs(offset_mm.mean()) < 1 * UM  # the noise is 6 um at each of some thousand points
    aside_mm = ink_offset_mm(
        darkness(SAMPLES / f"{name}.png"), truth_mm + np.array([0.005, 0.005])
    )
    assert np.abs(aside_mm - offset_mm).mean() > 2 * UM  # the measure sees a shift of 7 um
