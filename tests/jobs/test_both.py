"""`--lines all --edge` in the whole way, in a comparison and in the table of lines."""

from __future__ import annotations

from pathlib import Path

import pytest
from PIL import Image

from morfax.jobs.compare import CompareJob
from morfax.jobs.lines import LinesJob
from morfax.jobs.run import RunJob, RunResult
from morfax.jobs.settings.drawing_file import DrawingFile
from morfax.jobs.settings.line_settings import LineSettings
from morfax.jobs.settings.settings import TraceSettings
from tests.tracer.inked import UM
from tests.tracer.program.test_ink_and_edges import (
    DISC,
    DPI,
    FRAME,
    TO_DISC,
    TO_WALL,
    WALL,
    levels,
)

ALL = LineSettings(lines="all")


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> RunResult:
    folder = tmp_path_factory.mktemp("both")
    file = folder / "plan.png"
    grey = levels(FRAME, TO_WALL, TO_DISC, shapes=(WALL, DISC))
    Image.fromarray(grey).save(file, dpi=(DPI, DPI))
    return RunJob(
        DrawingFile(file, edge=True), folder / "out", settings=TraceSettings(ALL)
    ).run()


def test_the_whole_way_measures_outlines_and_lines_alike(run: RunResult) -> None:
    assert run.traced.trace.ink is not None
    assert [area.what for area in run.traced.trace.ink.areas] == ["outlined area"] * 2
    assert sum(line.on_edge for line in run.traced.trace.lines) == 2
    played = run.figures["played_to_ink"]
    # the corners of a wall and a line's mouth have no middle of 0.5 mm; nearly all the rest is measured
    assert played["measured_share"] > 0.95 and played["rms_mm"] < 10 * UM
    assert run.figures["missed_ink_share"] < 0.01


def test_its_path_is_compared_with_lines_and_outlines(run: RunResult) -> None:
    drawing = DrawingFile(Path(run.figures["drawing"]), edge=True)
    path = Path(run.figures["traced_path"])
    both = CompareJob(drawing.for_lines(ALL), path).run()
    assert both.found.measured_share > 0.95 and both.figures["missed_ink_share"] < 0.01
    # of the same path against the lines' own edges a large part is beside them
    edges = CompareJob(drawing, path).run()
    assert edges.figures["missed_ink_share"] > 0.2


def test_the_table_has_lines_without_solid_areas_and_these(run: RunResult) -> None:
    drawing = DrawingFile(Path(run.figures["drawing"]), edge=True)
    found = LinesJob(drawing, ALL).run()
    assert found.figures["line_width_mm"] == pytest.approx(0.5, abs=0.05)
    assert not any(row["remark"] for row in found.figures["lines"])
    sizes = sorted(area["solid_mm2"] for area in found.figures["solid_areas"])
    assert sizes == pytest.approx([12.6, 102.0], rel=0.15)
