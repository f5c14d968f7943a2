"""The zero of a program: any place, of the part that is cut, or on the sheet."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from morfax.jobs.compare import CompareJob
from morfax.jobs.machine.recording import RecordingUnit
from morfax.jobs.play import PlayJob
from morfax.jobs.record import RecordJob
from morfax.jobs.settings.line_settings import LineSettings
from morfax.jobs.settings.settings import (
    ProgramSettings,
    ToolSettings,
    TraceSettings,
)
from morfax.jobs.trace import TraceJob, TraceOutputs
from morfax.motion.pathfile import read_path
from tests.jobs.worked import BRACKET, PROGRAM

pytestmark = pytest.mark.usefixtures("silent")


def test_the_zero_may_be_any_place(here: Path) -> None:
    for zero, start_mm in (("sheet", (8.5, 23.0)), ((8.0, 20.0), (0.5, 3.0))):
        settings = TraceSettings(program=ProgramSettings(zero=zero))  # type: ignore[arg-type]
        TraceJob(PROGRAM, TraceOutputs(here / "a.csv"), settings).run()
        assert read_path(here / "a.csv").xy_mm[0] == pytest.approx(start_mm, abs=0.05)


PART_MM = np.array([70.0, 50.0])  # its size


@pytest.mark.parametrize(
    ("zero", "turn_deg", "low_mm"),
    [
        ("lower-left", 0, (-2.0, -2.0)),
        ("centre", 0, (-37.0, -27.0)),
        ("lower-left", 90, (-2.0, -2.0)),
    ],
)
def test_the_zero_may_be_of_the_part_that_is_cut(
    zero: Any, turn_deg: int, low_mm: tuple[float, float], here: Path
) -> None:
    """The part is the lines: the path of a cutter of 4 mm begins 2 mm before it, a lead further still.

    The place of the zero on the sheet, as it is told, puts the program back on the drawing.
    """
    settings = TraceSettings(
        LineSettings(lines="all"),
        tool=ToolSettings(cutter_mm=4.0),
        program=ProgramSettings(zero=zero),
    )
    unit = RecordingUnit(turn_rad=np.radians(turn_deg))
    told = TraceJob(BRACKET, TraceOutputs(here / "a.csv"), settings, unit).run().figures
    cut = np.vstack(read_path(here / "a.csv").runs())
    size_mm = PART_MM[::-1] if turn_deg else PART_MM
    # the head follows the lines within some um, the offset's corners are smoothed by 5
    assert cut.min(axis=0) == pytest.approx(low_mm, abs=0.02)
    assert np.ptp(cut, axis=0) == pytest.approx(size_mm + 4.0, abs=0.03)
    if not turn_deg:
        place = told["zero_place_mm"]
        compared = CompareJob(BRACKET, here / "a.csv", cutter_mm=4.0, zero=place).run()
        assert compared.figures["path_to_ink"]["rms_mm"] < 0.01


@pytest.mark.parametrize(
    "placed", [{"turn_rad": np.pi / 2}, {"mirror": "x", "scale": 0.5}, {"turn_rad": 0.3}]
)
def test_a_zero_on_the_sheet_goes_with_the_drawing(placed: dict[str, Any], here: Path) -> None:
    """The middle of the bracket's hole is where the machine has its zero, however the program is placed.

    (Fails where the place counts after mirror, scale and turn: then it is told and meant on the sheet, and
    the program lies elsewhere.)
    """
    contours = LineSettings(lines="contours")
    TraceJob(BRACKET, TraceOutputs(here / "a.csv"), TraceSettings(contours)).run()
    hole = read_path(here / "a.csv").runs()[0]
    middle_mm = 0.5 * (hole.min(axis=0) + hole.max(axis=0))
    zero = (float(middle_mm[0]), float(middle_mm[1]))
    settings = TraceSettings(contours, program=ProgramSettings(zero=zero))
    unit = RecordingUnit(**placed)
    told = TraceJob(BRACKET, TraceOutputs(here / "b.csv"), settings, unit).run().figures
    RecordJob(here / "a.csv", here / "c.ngc", unit=unit, zero=zero).run()
    PlayJob(here / "c.ngc", (here / "c.csv",)).run()
    assert told["zero_place_mm"] == pytest.approx(zero)
    for name in ("b.csv", "c.csv"):
        placed_hole = read_path(here / name).runs()[0]
        middle = 0.5 * (placed_hole.min(axis=0) + placed_hole.max(axis=0))
        assert middle == pytest.approx((0, 0), abs=0.02)
