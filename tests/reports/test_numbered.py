"""The numbered sheet: its numbers can be read where lines lie close together, and the legend hides none."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import cv2
import numpy as np
import pytest
from PIL import Image

from morfax.jobs.lines import LinesJob
from morfax.jobs.settings.drawing_file import DrawingFile
from morfax.reports import labels, numbered, vector
from morfax.reports.plate import Caption, Mark

DPI = 100
STROKES = 8
PT_PER_MM = 8 * 72 / 254  # the picture is 8 inches wide, the sheet ten


def test_numbers_of_lines_close_together_do_not_hide_each_other(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The numbers of a word's letters lay on one another, and only the last could be read."""
    grey = np.full((600, 1000), 240, np.uint8)
    for k in range(STROKES):
        cv2.line(grey, (500 + 8 * k, 300), (500 + 8 * k, 330 + 3 * k), 30, 3)
    Image.fromarray(grey).save(tmp_path / "a.png", dpi=(DPI, DPI))
    seen: list[Mark] = []
    monkeypatch.setattr(vector, "put", lambda _, mark: seen.append(mark))
    numbered.draw_numbered(
        LinesJob(DrawingFile(tmp_path / "a.png"), picture=tmp_path / "b.png").run()
    )
    words = [mark for mark in seen if isinstance(mark, Caption)]
    assert sorted(int(word.text) for word in words) == list(range(1, STROKES + 1))
    boxes = sorted(
        (x * PT_PER_MM + dx, y * PT_PER_MM + dy, len(word.text) * labels.LETTER * word.size_pt)
        for word in words
        for (x, y), (dx, dy) in [(word.place_mm, word.offset_pt)]
    )
    for (left, low, wide), (other, other_low, _) in pairwise(boxes):
        assert other >= left + wide or abs(other_low - low) >= words[0].size_pt
