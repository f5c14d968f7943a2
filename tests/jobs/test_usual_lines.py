"""Which lines of a drawing are traced where nobody asks: what the cutter, or the machine, is for."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from morfax.jobs.machine.recording import RecordingUnit
from morfax.jobs.run import RunJob
from morfax.jobs.settings.drawing_file import DrawingFile
from morfax.jobs.settings.line_settings import LineSettings
from morfax.jobs.settings.settings import ProgramSettings, ToolSettings, TraceSettings
from morfax.jobs.trace import TraceJob, TraceOutputs
from morfax.recorder.gcode.machine import as_toml

SHEET = Path(__file__).parents[2] / "samples" / "bracket.png"
PEN, LASER, TORCH, ROUTER = "grbl-pen", "grbl-laser", "qtplasmac", "grbl-router"


def lines_of(folder: Path, machine: str | None, **settings: Any) -> Any:
    """Which lines `trace` takes for a machine; `run` takes the same."""
    of_trace, unit = TraceSettings(**settings), RecordingUnit(machine=machine)
    suffix = ".ngc" if machine == TORCH else ".nc"
    outputs = TraceOutputs(folder / f"part{suffix}")
    _, tracing = TraceJob(DrawingFile(SHEET), outputs, of_trace, unit).prepared()
    _, running = RunJob(DrawingFile(SHEET), folder / "run", of_trace, unit).prepared()
    assert running.settings.line.lines == tracing.settings.line.lines
    return tracing.settings.line.lines


@pytest.mark.parametrize(
    ("machine", "settings", "expected"),
    [
        (PEN, {}, "all"),
        (LASER, {}, "all"),
        (TORCH, {}, "contours"),
        (ROUTER, {}, None),
        (None, {}, None),
        # a cutter has the first word
        (ROUTER, {"tool": ToolSettings(cutter_mm=3.0)}, "contours"),
        (TORCH, {"tool": ToolSettings(cutter_mm=1.5)}, "contours"),
        (LASER, {"tool": ToolSettings(cutter_mm=0.2)}, "contours"),
        # what somebody asks for is done
        (PEN, {"line": LineSettings(lines="contours")}, "contours"),
        (PEN, {"line": LineSettings(lines=(1, 2))}, (1, 2)),
        (PEN, {"line": LineSettings(start_mm=(10.0, 10.0))}, None),
        # a drawn program with its marks is one line
        (PEN, {"line": LineSettings(direction="cw")}, None),
        (PEN, {"line": LineSettings(reference_mm=(8.5, 23.0))}, None),
        (PEN, {"program": ProgramSettings(marks="on")}, None),
    ],
)
def test_a_pen_draws_all_the_ink_a_torch_cuts_contours_and_who_asks_is_served(
    tmp_path: Path, machine: str | None, settings: dict[str, Any], expected: Any
) -> None:
    assert lines_of(tmp_path, machine, **settings) == expected


def test_a_machine_of_one_s_own_says_the_same(tmp_path: Path) -> None:
    mine = tmp_path / "mine.toml"
    mine.write_text(as_toml(PEN).replace('lines = "all"', 'lines = "contours"'))
    assert lines_of(tmp_path, str(mine)) == "contours"
