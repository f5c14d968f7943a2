"""A sheet on a table in a photograph that was not made flat: told, with advice that works."""

import re
from pathlib import Path

import cv2
import numpy as np
import pytest
from PIL import Image

from morfax.jobs.listener import Silent
from morfax.jobs.settings.drawing_file import DrawingFile
from morfax.jobs.settings.flattening import FlattenSettings
from morfax.tracer.flatten.wanted import parsed

CORNERS = np.array([[150, 90], [660, 120], [640, 500], [130, 470]])
ROUGHLY_PX = 12  # the lens and the table's grain; measured: at most 6


class Heard(Silent):
    """A listener that keeps the warnings."""

    def __init__(self) -> None:
        self.warnings: list[str] = []

    def warning(self, text: str) -> None:
        """Keep a warning."""
        self.warnings.append(text)


def sheet_on(tone: int, file: Path, frame: int = 0) -> Path:
    """A turned sheet with a filled circle on a table of a tone, with grain; or a frame drawn on paper."""
    noise = np.random.default_rng(tone).normal(0, 6, (600, 800, 1)).astype(np.float32)
    picture = tone + cv2.GaussianBlur(noise, (0, 0), 3)[..., None] * np.array([2.0, 3.0, 4.0])
    if frame:
        cv2.polylines(picture, [CORNERS], True, (40, 40, 40), frame)
    else:
        cv2.fillPoly(picture, [CORNERS], (238, 240, 236))
    cv2.circle(picture, (400, 300), 90, (30, 30, 30), -1)
    soft = np.clip(cv2.GaussianBlur(picture, (0, 0), 1), 0, 255).astype(np.uint8)
    Image.fromarray(soft).save(file, quality=88)
    return file


@pytest.mark.parametrize("tone", [40, 110, 190])
def test_a_sheet_on_a_table_is_told_and_the_advice_reads_the_sheet_alone(
    tmp_path: Path, tone: int
) -> None:
    file, heard = sheet_on(tone, tmp_path / "sheet.jpg"), Heard()
    DrawingFile(file, width_mm=300.0, edge=True).open(heard)
    [told] = [text for text in heard.warnings if "on a darker table" in text]
    found = np.array(re.findall(r"(\d+),(\d+)(?= )", told), float)
    assert np.abs(found - CORNERS).max() < ROUGHLY_PX
    advised = FlattenSettings(parsed("paper=200x150mm"))
    [circle] = DrawingFile(file, edge=True, flatten=advised).open().edges_mm
    assert np.ptp(circle, axis=0) == pytest.approx(2 * 90 * 200 / 511, rel=0.05)


@pytest.mark.parametrize(
    ("name", "frame"), [("framed.jpg", 3), ("framed.jpg", 20), ("sheet.png", 0)]
)
def test_a_frame_on_paper_and_a_png_are_no_photograph_of_a_table(
    tmp_path: Path, name: str, frame: int
) -> None:
    heard = Heard()
    DrawingFile(sheet_on(240 if frame else 110, tmp_path / name, frame), width_mm=300.0).open(
        heard
    )
    assert not [text for text in heard.warnings if "on a darker table" in text]
