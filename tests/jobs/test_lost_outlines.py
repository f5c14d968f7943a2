"""`--edge --lines all`: outlines on which the head is lost are left out and told, the others kept."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import pytest
from PIL import Image

from morfax.jobs.settings.drawing_file import DrawingFile
from morfax.jobs.settings.line_settings import LineSettings
from morfax.jobs.settings.settings import TraceSettings
from morfax.jobs.trace import TraceJob, TraceOutputs, TraceResult
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.following.line import Line
from morfax.tracer.program.lines.lost_outlines import without_lost
from tests.jobs.test_told_ink import Heard
from tests.tracer.inked import arc

DPI, FINE, SOFTNESS_PX = 150.0, 4, 0.7
WALLS = [((8, 40), (62, 43)), ((8, 8), (11, 43)), ((59, 8), (62, 43))]
TEXT = [("BATH 12", (16, 32)), ("w. 25 380", (16, 22)), ("abcdeg", (16, 12))]
LETTER_HEIGHT = 22  # of the font, in its own units
SHEET_MM = 70, 50


def plan(file: Path, letter_mm: float = 1.5, pen_mm: float = 0.2) -> Path:
    """A plan with filled walls and lettering."""
    px_mm = DPI / 25.4
    columns, rows = (int(side * px_mm) for side in SHEET_MM)
    big = np.zeros((rows * FINE, columns * FINE), np.uint8)

    def at(place_mm: tuple[float, float]) -> tuple[int, int]:
        x, y = place_mm
        return int(x * px_mm * FINE), int((SHEET_MM[1] - y) * px_mm * FINE)

    for corner, other in WALLS:
        cv2.rectangle(big, at(corner), at(other), 255, -1)
    size = letter_mm * px_mm * FINE / LETTER_HEIGHT
    for text, place in TEXT:
        pen_px = int(pen_mm * px_mm * FINE)
        cv2.putText(
            big, text, at(place), cv2.FONT_HERSHEY_DUPLEX, size, 255, pen_px, cv2.LINE_AA
        )
    ink = cv2.resize(big, (columns, rows), interpolation=cv2.INTER_AREA) / 255.0
    levels = 235 - 200 * cv2.GaussianBlur(ink, (0, 0), SOFTNESS_PX)
    levels += np.random.default_rng(1).normal(0, 5, levels.shape)
    picture = np.clip(np.round(levels), 0, 255).astype(np.uint8)
    Image.fromarray(picture).save(file, dpi=(DPI, DPI))
    return file


def traced(file: Path) -> tuple[TraceResult, list[str]]:
    """The result of `--edge --lines all`, and what is said of it."""
    heard = Heard()
    job = TraceJob(
        DrawingFile(file, edge=True),
        TraceOutputs(file.with_suffix(".csv")),
        TraceSettings(LineSettings(lines="all")),
    )
    return job.run(heard), [text for text in heard.said if "left out" in text]


def test_outlines_on_which_the_head_is_lost_are_told_with_their_places(tmp_path: Path) -> None:
    result, (told,) = traced(plan(tmp_path / "plan.png"))
    fault, endings = result.fault, [line.ending for line in result.traced.trace.lines]
    assert fault is None
    assert set(endings) == {"closed"}
    rows = result.figures["lost_outlines"]
    lost_mm = [row["lost_outline_mm"] for row in rows]
    assert told.startswith(f"{len(rows)} outlines are left out, {sum(lost_mm):.0f} mm in all")
    assert lost_mm == sorted(lost_mm, reverse=True)
    x, y = rows[0]["lost_outline_place_mm"]
    assert f"the longest, {lost_mm[0]:.1f} mm, at {x:.1f},{y:.1f} mm" in told
    marked_mm = result.traced.marked_mm
    assert marked_mm["lost outline 1"] == (x, y)


def outline(radius_mm: float, ending: str) -> Line:
    """A line round about a circle, or as far as the head came on it."""
    places = arc((30, 30), radius_mm)
    come = places if ending == "closed" else places[: len(places) // 3]
    return Line(come, ending, 0.5, 0.0 if ending != "closed" else 2 * np.pi * radius_mm)


@pytest.mark.parametrize(("lost_mm", "is_kept"), [(3.0, True), (9.0, False)])
def test_where_the_lost_edges_are_the_larger_part_the_sheet_is_lost(
    lost_mm: float, is_kept: bool
) -> None:
    radii_mm = 6.0, lost_mm
    edges = Drawing(
        np.zeros((10, 10), np.float32), 0.1, edges_mm=tuple(arc((30, 30), r) for r in radii_mm)
    )
    lines = [outline(6.0, "closed"), outline(lost_mm, "lost")]
    whole, lost = without_lost(edges, lines)
    assert [line.ending for line in whole] == (["closed"] if is_kept else ["closed", "lost"])
    assert len(lost) == is_kept
    if is_kept:
        assert lost[0].length_mm == pytest.approx(2 * np.pi * lost_mm, rel=0.01)
        assert lost[0].place_mm == pytest.approx(tuple(lines[1].xy_mm[-1]))
