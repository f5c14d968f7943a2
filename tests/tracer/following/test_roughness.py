"""Roughness of edges: measured beyond the noise of the pixels, told of, and the advice works when followed.

Broken on purpose, with nothing subtracted for noise: the noisy disc is 6 um rough.
"""

from __future__ import annotations

import re
from pathlib import Path

import cv2
import numpy as np
import pytest
from PIL import Image

from morfax.jobs.machine.recording import RecordingUnit
from morfax.jobs.remarks.on_ink import of_ink
from morfax.jobs.settings.drawing_file import DrawingFile
from morfax.jobs.trace import TraceJob, TraceOutputs
from morfax.motion.contour import distance
from morfax.motion.pathfile import read_path
from morfax.motion.polyline import evenly
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.program.program import Trace
from morfax.tracer.program.trace import trace
from morfax.tracer.program.trace_lines import trace_lines
from tests.tracer.drawing.filled import CIRCLE, filled
from tests.tracer.drawing.test_shapes import STEPPED, star
from tests.tracer.inked import DPI, UM, Points, arc

SHAPES = {"disc": CIRCLE, "plate": STEPPED, "star": star()}
APART_MM = 0.02


def roughened(outline: Points, rough_um: float, wave_mm: float = 0.1, seed: int = 1) -> Points:
    """An outline that strays to both sides by so much (standard deviation), correlated over so far."""
    places = evenly(outline, APART_MM)
    per_mm = 2 * np.pi * np.fft.fftfreq(len(places), APART_MM)
    heard = np.fft.fft(np.random.default_rng(seed).normal(size=len(places)))
    strays = np.fft.ifft(heard * np.exp(-0.25 * (per_mm * wave_mm) ** 2)).real
    strays *= rough_um * UM / strays.std()
    way = np.roll(places, -1, axis=0) - np.roll(places, 1, axis=0)
    left = np.column_stack([-way[:, 1], way[:, 0]]) / np.hypot(*way.T)[:, None]
    rough = places + strays[:, None] * left
    return np.vstack([rough, rough[:1]])


def traced(file: Path) -> Trace:
    """The edge that is traced on a scan."""
    return trace(Drawing.open(file, edge=True))


def told(run: Trace) -> list[str]:
    """What is said of rough edges."""
    return [text for text in of_ink(run, several=False) if "rough" in text]


def noisier(file: Path, levels: float) -> Path:
    """A scan with more noise."""
    grey = np.asarray(Image.open(file), float)
    grey += np.random.default_rng(5).normal(0, levels, grey.shape)
    Image.fromarray(np.clip(grey, 0, 255).astype(np.uint8)).save(file, dpi=(DPI, DPI))
    return file


@pytest.mark.parametrize("levels", [0, 16])
@pytest.mark.parametrize("name", SHAPES)
def test_clean_edges_are_smooth_whatever_the_noise(
    tmp_path: Path, name: str, levels: float
) -> None:
    run = traced(noisier(filled(tmp_path / "shape.png", SHAPES[name]), levels))
    assert run.roughness_mm is not None and run.roughness_mm < 3 * UM
    assert not told(run)


@pytest.mark.parametrize("name", SHAPES)
def test_a_rough_edge_is_measured_and_told_of(tmp_path: Path, name: str) -> None:
    """The lens averages waves of 0.2 mm, and what is longer than 3 mm is the shape's."""
    run = traced(filled(tmp_path / "rough.png", roughened(SHAPES[name], 80)))
    (note,) = told(run)
    said = re.search(r"strays by (\d\.\d+) mm", note)
    assert said is not None and run.roughness_mm is not None
    assert float(said[1]) == pytest.approx(run.roughness_mm, abs=0.001)
    off_mm = distance(run.xy_mm[::4], SHAPES[name]).path_to_reference.rms_mm
    assert 0.5 * off_mm < run.roughness_mm < 80 * UM


def test_half_as_rough_is_half_as_much(tmp_path: Path) -> None:
    rough_mm = [
        traced(filled(tmp_path / "rough.png", roughened(CIRCLE, um))).roughness_mm
        for um in (20, 40, 80)
    ]
    assert rough_mm[1] == pytest.approx(0.5 * rough_mm[2], rel=0.1)
    assert rough_mm[0] == pytest.approx(0.5 * rough_mm[1], rel=0.1)


def test_blurred_paper_is_no_roughness(tmp_path: Path) -> None:
    """Grain of the paper that is correlated over two pixels, as a JPEG's is."""
    file = filled(tmp_path / "disc.png", CIRCLE)
    grey = np.asarray(Image.open(file), np.float32)
    grain = np.random.default_rng(3).normal(0, 30, grey.shape).astype(np.float32)
    grey += cv2.GaussianBlur(grain, (0, 0), 1.5)
    Image.fromarray(np.clip(grey, 0, 255).astype(np.uint8)).save(file, dpi=(DPI, DPI))
    assert not told(traced(file))


def test_the_advice_on_a_rough_edge_works(tmp_path: Path) -> None:
    """The same pen, twice as large, and --scale as told: the path is half as far off."""
    small, large = arc((9, 8.5), 7), arc((18, 17), 14)
    run = traced(filled(tmp_path / "rough.png", roughened(small, 80)))
    (note,) = told(run)
    said = re.search(r"draw it twice as large with the same pen, and with --scale (\S+)", note)
    assert said is not None
    larger = filled(tmp_path / "larger.png", roughened(large, 80, seed=2))
    outputs = TraceOutputs(path=tmp_path / "larger.csv", program=tmp_path / "larger.wav")
    unit = RecordingUnit(scale=float(said[1]), about_mm=(0.0, 0.0))
    result = TraceJob(DrawingFile(larger, edge=True), outputs, unit=unit).run()
    assert result.figures["edge_roughness_mm"] > run.roughness_mm * 0.7  # on the sheet
    before_mm = distance(run.xy_mm[::4], small).path_to_reference.rms_mm
    after = read_path(tmp_path / "larger.csv").runs()
    after_mm = distance(np.vstack(after), small).path_to_reference.rms_mm
    assert after_mm < 0.6 * before_mm


def test_too_little_of_an_edge_tells_nothing(tmp_path: Path) -> None:
    """A hole of 1.4 mm bends too much everywhere; a line has no edge of its own."""
    hole = arc((16, 16), 0.7)
    drawing = Drawing.open(filled(tmp_path / "hole.png", CIRCLE, holes=(hole,)), edge=True)
    run = trace(drawing)
    assert run.roughness_mm is not None
    both = sorted(trace_lines(drawing).lines, key=lambda line: line.length_mm)
    assert both[0].roughness_mm is None and both[1].roughness_mm is not None
