"""Kinds of images, blank and damaged ones, and sheets in strips, as the command line takes them."""

from __future__ import annotations

import struct
import zlib
from pathlib import Path

import cv2
import numpy as np
import pytest
from PIL import Image

from morfax.tracer.drawing import components as patches
from morfax.tracer.drawing import memory as room
from morfax.tracer.drawing.components import Patches, runs_of
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.strokes import Sheet
from tests.console.conftest import SAMPLES, Morfax

UM = 1e-3
CAM = SAMPLES / "cam.png"
DPI = (300.0, 300.0)


@pytest.mark.parametrize("kind", ["1", "I;16", "LA", "RGBA", "CMYK", "P"])
def test_every_kind_of_image_can_be_traced(
    morfax: Morfax, here: Path, small: np.ndarray, kind: str
) -> None:
    grey = Image.fromarray(small)
    image = (
        Image.fromarray(small.astype(np.uint16) * 257) if kind == "I;16" else grey.convert(kind)
    )
    image.save("part.tif", dpi=DPI)
    answer = morfax("trace", "part.tif", "-o", "part.csv", "--json")
    assert answer.exit_code == 0 and answer.figures["ending"] == "closed"


def test_an_image_without_a_resolution_asks_for_one(
    morfax: Morfax, here: Path, small: np.ndarray
) -> None:
    Image.fromarray(small).save("photo.png")
    answer = morfax("trace", "photo.png")
    assert answer.exit_code == 3 and "--dpi" in answer.fault and "--width" in answer.fault
    by_dpi = morfax("trace", "photo.png", "--dpi", 300, "-o", "a.csv", "--json").figures
    by_width = morfax(
        "trace", "photo.png", "--width", f"{320 * 25.4 / 300}mm", "-o", "b.csv", "--json"
    ).figures
    assert by_dpi["length_mm"] == pytest.approx(by_width["length_mm"], abs=1 * UM)
    assert morfax("trace", "photo.png", "--dpi", 300, "--width", "20mm").exit_code == 2


@pytest.mark.parametrize("blank", [255, 0, 128])
def test_a_blank_sheet_holds_no_line(morfax: Morfax, here: Path, blank: int) -> None:
    Image.fromarray(np.full((400, 400), blank, np.uint8)).save("blank.png", dpi=DPI)
    answer = morfax("trace", "blank.png")
    assert answer.exit_code == 3 and "no line" in answer.fault


def test_what_is_no_image_is_told(morfax: Morfax, here: Path) -> None:
    (here / "words.png").write_text("these are words")
    (here / "cut.png").write_bytes(CAM.read_bytes()[:5000])
    for file in ("words.png", "cut.png"):
        answer = morfax("trace", file)
        assert answer.exit_code == 3 and file in answer.fault


def test_a_sheet_larger_than_the_memory_says_what_it_needs(
    morfax: Morfax, here: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Asked before it is unpacked: of this one there is nothing but the head of the file."""
    monkeypatch.setattr(room, "free_bytes", lambda: 4_000_000_000)
    Image.fromarray(np.zeros((10, 10), np.uint8)).save("huge.png", dpi=DPI)
    whole = bytearray((here / "huge.png").read_bytes())
    whole[16:24] = struct.pack(">II", 30_000, 30_000)
    whole[28] = 1  # interlaced: it is held as a whole
    whole[29:33] = struct.pack(">I", zlib.crc32(whole[12:29]))
    (here / "huge.png").write_bytes(whole)
    answer = morfax("trace", "huge.png")
    assert answer.exit_code == 3
    for said in ("30000 x 30000 pixels", "8.4 GB", "4.0 GB", "lower resolution"):
        assert said in answer.fault


def test_a_sheet_in_strips_is_the_same_sheet(monkeypatch: pytest.MonkeyPatch) -> None:
    whole = Drawing.open(CAM)
    lines = Sheet.of(whole)
    monkeypatch.setattr(patches, "STRIP_PX", 64 * 1024)
    in_strips = Drawing.open(CAM)
    assert np.allclose(in_strips.darkness, whole.darkness, atol=1e-5)
    again = Sheet.of(in_strips)
    assert again.longest().length_mm == pytest.approx(lines.longest().length_mm, abs=1 * UM)
    assert again.longest().middles_mm == pytest.approx(lines.longest().middles_mm)


def test_patches_are_those_of_opencv() -> None:
    """On paper strewn with ink at random, where many touch at a corner only, and in strips."""
    ink = (np.random.default_rng(3).random((300, 200)) < 0.35).astype(np.uint8)
    found = Patches.of(runs_of(ink[top : top + 70], top) for top in range(0, 300, 70))
    count, labels, stats, _ = cv2.connectedComponentsWithStats(ink)
    assert found.count == count - 1
    assert sorted(found.areas) == sorted(stats[1:, cv2.CC_STAT_AREA])
    largest = np.arange(found.count) == np.argmax(found.areas)
    own = labels == 1 + np.argmax(stats[1:, cv2.CC_STAT_AREA])
    assert (found.painted(largest, 20, 250, 30, 190) == own[20:250, 30:190]).all()
