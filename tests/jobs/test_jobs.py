"""Every job without the console: its result, what it tells its listener, that it prints nothing and can be
sent to another process.
"""

from __future__ import annotations

import pickle
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from morfax.jobs.age import AgeJob
from morfax.jobs.check import CheckJob
from morfax.jobs.compare import CompareJob
from morfax.jobs.inspect import InspectJob
from morfax.jobs.machine.playing import ByHand
from morfax.jobs.machine.recording import RecordingUnit
from morfax.jobs.mend import MendJob
from morfax.jobs.play import ControlSettings, PlayJob
from morfax.jobs.record import RecordJob
from morfax.jobs.run import RunJob
from morfax.jobs.settings.contour_settings import ContourSettings
from morfax.jobs.settings.drawing_file import MEASURED, READ, DrawingFile
from morfax.jobs.settings.line_settings import LineSettings
from morfax.jobs.settings.settings import (
    HeadSettings,
    ProgramSettings,
    ToolSettings,
    TraceSettings,
)
from morfax.jobs.sheet import SheetJob
from morfax.jobs.systems import SystemsJob
from morfax.jobs.trace import TraceJob, TraceOutputs
from morfax.jobs.wrong_use import WrongUse
from morfax.motion.faults import (
    CardFault,
    LineFault,
)
from morfax.motion.pathfile import read_path
from morfax.motion.polyline import area_mm2
from morfax.player.gcode.check.motion_rules import Stock
from tests.console.conftest import SAMPLES
from tests.jobs.worked import BRACKET, CURVE, PROGRAM, UM, Recording, worked

pytestmark = pytest.mark.usefixtures("silent")


class Answering:
    """A panel whose operator presses the button at once."""

    waited = 0

    def ask(self, halt: Any, z_mm: float, usual: Any) -> None:
        return None

    def wait(self, halt: Any) -> float:
        self.waited += 1
        return 0.25


def test_trace(here: Path) -> None:
    outputs = TraceOutputs(here / "curve.wav", here / "curve.csv", here / "curve.png")
    result, listener = worked(TraceJob(CURVE, outputs))
    assert result.fault is None and result.figures["ending"] == "ended"
    assert {file.name for file in here.iterdir()} == {"curve.wav", "curve.csv"}
    assert result.picture == here / "curve.png"  # which a face draws
    assert ("compiling", "the head") in listener.said
    assert listener.done["following the line"][-1] > 0.9
    # a page of many drawn lines takes long to read, and a large sheet to measure
    assert list(listener.done)[:2] == [READ, MEASURED]


def test_run_puts_all_in_a_folder(here: Path) -> None:
    result, listener = worked(RunJob(CURVE, here / "out"))
    names = {"curve.wav", "curve.traced.csv", "curve.played.csv"}
    assert {file.name for file in (here / "out").iterdir()} == names
    assert result.faults == () and result.figures["played_to_ink"]["max_mm"] < 20 * UM
    assert set(listener.done) >= {"following the line", "playing curve.wav"}


def test_record_and_play(here: Path, path_file: Path) -> None:
    result, listener = worked(RecordJob(path_file, here / "circle.wav"))
    assert result.program == here / "circle.wav" and result.program.exists()
    assert listener.done["recording circle.wav"][-1] == pytest.approx(1, abs=0.01)
    outputs, charts = (here / "circle.csv", here / "circle.svg"), (here / "servos.png",)
    result, _ = worked(PlayJob(here / "circle.wav", outputs, charts))
    assert result.paths == outputs and result.charts == charts and result.fault is None
    assert {file.name for file in here.iterdir()} == {"circle.wav", "circle.csv"}
    assert result.path is not None and result.chart is not None  # for a face to draw
    played, drawn = read_path(here / "circle.csv"), read_path(path_file)
    assert np.abs(played.xy_mm[-1] - drawn.xy_mm[-1]).max() < 1 * UM


def test_a_program_without_a_check_sum_plays_with_a_note(here: Path, path_file: Path) -> None:
    program = here / "circle.cubic"
    worked(RecordJob(path_file, program))
    _, listener = worked(PlayJob(program))
    assert not [text for kind, text in listener.said if kind == "note" and "check sum" in text]
    text = program.read_text(encoding="ascii")
    program.write_text(text[: text.rindex(" crc32")] + "\n", encoding="ascii")
    result, listener = worked(PlayJob(program))
    assert result.fault is None
    assert [text for kind, text in listener.said if kind == "note" and "check sum" in text]


def test_a_playing_may_be_set(tape_file: Path) -> None:
    plain, _ = worked(PlayJob(tape_file))
    faster, _ = worked(PlayJob(tape_file, control=ControlSettings(feed_override=1.5)))
    shares = plain.figures["duration_s"] / faster.figures["duration_s"]
    assert shares == pytest.approx(1.5, rel=1e-3)


def test_a_motor_is_its_lock_and_a_chart_has_speeds(here: Path, path_file: Path) -> None:
    """A hydraulic motor's drive swings at 60 Hz; of a program in blocks a chart shows the speeds held."""
    settings = ControlSettings(motor="hydraulic").for_file(Path("a.wav"), ByHand())
    assert settings["settings"].natural_hz == 60
    RecordJob(path_file, here / "circle.ngc").run()
    drawn = PlayJob(here / "circle.ngc", charts=(here / "servos.png",)).run()
    listed = PlayJob(here / "circle.ngc", charts=(here / "servos.csv",)).run()
    assert drawn.speeds is not None and listed.speeds is None


def test_a_printed_sheet_has_a_margin_about_its_frame(here: Path) -> None:
    figures = SheetJob(here / "sheet.pdf").run().figures
    wide_mm, high_mm = figures["frame_width_mm"], figures["frame_height_mm"]
    # printers leave 3 to 6 mm white; most of the sheet is for the drawing
    assert 0.8 * 210 < wide_mm < 210 - 2 * 3
    assert 0.8 * 297 < high_mm < 297 - 2 * 3


def test_a_drawing_from_cad_is_played_by_way_of_a_tape(here: Path, path_file: Path) -> None:
    """The machine draws the circle, and the tape is gone afterwards."""
    PlayJob(
        RecordJob(path_file, here / "circle.wav").run().program, (here / "circle.dxf",)
    ).run()
    result, _ = worked(PlayJob(here / "circle.dxf", (here / "again.csv",)))
    drawn, again = read_path(path_file).runs()[0], read_path(here / "again.csv").runs()[0]
    assert result.fault is None
    assert area_mm2(again) == pytest.approx(area_mm2(drawn), rel=1e-3)
    assert {file.suffix for file in here.iterdir()} == {".wav", ".dxf", ".csv"}


def test_compare(path_file: Path, tape_file: Path) -> None:
    result, _ = worked(CompareJob(DrawingFile(tape_file), path_file, tolerance_mm=3 * UM))
    assert result.within is True and result.figures["within_tolerance"] is True
    result, _ = worked(CompareJob(CURVE, SAMPLES / "curve.csv", tolerance_mm=1e-6))
    assert result.within is False and result.drawing is not None


def test_systems(here: Path) -> None:
    result, listener = worked(SystemsJob(CURVE, ("wav",), tolerance_mm=0.05))
    assert result.within is True and [one.suffix for one in result.results] == ["wav"]
    assert list(result.rows) == ["traced", "Morfax 1969 (.wav)"]
    assert any(text.startswith("Morfax 1969") for kind, text in listener.said if kind == "note")
    assert list(here.iterdir()) == []


def test_inspect(here: Path, path_file: Path, tape_file: Path) -> None:
    result, _ = worked(InspectJob(tape_file))
    assert result.fault is None and result.figures["track_2_x"]["highest_travel_mm"] > 0
    RecordJob(path_file, here / "circle.steps").run()
    result, _ = worked(InspectJob(here / "circle.steps"))
    assert result.figures["program"].endswith("circle.steps")


def test_check(here: Path, path_file: Path) -> None:
    RecordJob(path_file, here / "circle.nc", unit=RecordingUnit(machine="grbl-pen")).run()
    result, _ = worked(CheckJob(here / "circle.nc"))
    assert result.may_start and result.machine.name == "grbl-pen"
    assert result.figures["cuts"] == 1 and result.figures["findings"] == []
    beside, _ = worked(CheckJob(here / "circle.nc", stock=Stock(1, 1)))
    assert not beside.may_start and beside.figures["findings"][0]["kind"] == "stock"


def test_straight_plunges_are_no_cut_length(here: Path) -> None:
    """A square of 10 mm in two passes, at depths of 1 and 2 mm: 80 mm, whatever Z goes."""
    rounds = "".join(f"G1 Z-{z} F60\nG1 X10\nG1 Y10\nG1 X0\nG1 Y0\n" for z in (1, 2))
    (here / "square.nc").write_text(
        f"G21 G90 G17\nG0 X0 Y0 Z2\nM3 S1000\n{rounds}G0 Z2\nM5\nM2\n"
    )
    result, _ = worked(CheckJob(here / "square.nc", machine="grbl-router"))
    assert result.figures["cut_length_mm"] == pytest.approx(80.0)


def test_age_and_mend(here: Path, tape_file: Path) -> None:
    aged, listener = worked(AgeJob(tape_file, here / "worn.wav", parts=(("noise_db", 40.0),)))
    assert aged.tape.exists() and listener.done[f"wearing {tape_file.name}"][-1] == 1
    # its noise is that of seed 0, whenever it is made again
    again = AgeJob(tape_file, here / "again.wav", parts=(("noise_db", 40.0),), seed=0).run()
    assert again.tape.read_bytes() == aged.tape.read_bytes()
    mended, _ = worked(MendJob(here / "worn.wav", here / "mended.wav"))
    assert mended.tape.exists() and mended.mends == ()


def test_all_settings_travel() -> None:
    line = LineSettings(None, (1, 3), 0.5, 0.7, 5.0, "cw", (8.5, 23.0))
    head = HeadSettings("historic", 5.0, Path("head.toml"), ("lead_mm=1.5",))
    tool, program = (
        ToolSettings(3.0, 1.0, 6.0, "inside"),
        ProgramSettings(None, (2,), (1.0, 2.0)),
    )
    unit = RecordingUnit("coil", "x", 2.0, 0.5, (1.0, 1.0))
    job = TraceJob(CURVE, TraceOutputs(), TraceSettings(line, head, tool, program), unit)
    assert pickle.loads(pickle.dumps(job)) == job
    play = PlayJob(
        Path("a.wav"),
        control=ControlSettings(1.0, 500.0, None, 0.5, "hydraulic", (0.0, 1.0)),
        by_hand=ByHand(6000.0, 20.0, (1.0, 2.0), (2, 1, 3, 4), True),
    )
    assert pickle.loads(pickle.dumps(play)) == play


def test_options_go_before_the_card_and_the_card_before_the_file(here: Path) -> None:
    (here / "card.toml").write_text('depth = "3mm"\n[speeds]\ntrace = "7mm/s"\n')
    (here / "head.toml").write_text("speed_mm_s = 4\ngap_mm = 0.9\n")
    program = ProgramSettings(card_file=here / "card.toml")
    head = HeadSettings(settings_file=here / "head.toml")
    by_card = TraceSettings(head=head, program=program)
    assert by_card.of_head().speed_mm_s == 7 and by_card.of_head().gap_mm == 0.9
    assert by_card.operator(by_card.card(), None).work.depth_mm == 3
    head = HeadSettings(speed_mm_s=9.0, settings_file=here / "head.toml")
    by_options = TraceSettings(
        LineSettings(gap_mm=0.2), head, ToolSettings(depth_mm=1.0), program
    )
    assert by_options.of_head().speed_mm_s == 9 and by_options.of_head().gap_mm == 0.2
    assert by_options.operator(by_options.card(), None).work.depth_mm == 1
    head = HeadSettings(speed_mm_s=9.0, changes=("speed_mm_s=2",))
    assert TraceSettings(head=head).of_head().speed_mm_s == 2


def test_the_panel_is_asked(here: Path) -> None:
    (here / "card.toml").write_text('restart = "manual"\n')
    program = ProgramSettings(card_file=here / "card.toml")
    job = TraceJob(PROGRAM, TraceOutputs(here / "a.csv"), TraceSettings(program=program))
    with pytest.raises(CardFault, match="waits for the operator"):
        job.run()
    panel = Answering()
    worked(job, panel)
    assert panel.waited == 2


def test_a_machine_s_direction_counts_where_nobody_asks_for_another(here: Path) -> None:
    """qtplasmac turns the outline clockwise; `--direction` and `--conventional` come before it."""
    ways = {}
    for name, line, milling in (
        ("as the machine", LineSettings(), None),
        ("as asked", LineSettings(), "conventional"),
        ("as the head", LineSettings(direction="ccw"), None),
    ):
        settings = TraceSettings(line, contour=ContourSettings(milling))  # type: ignore[arg-type]
        outputs = TraceOutputs(here / "a.ngc", here / "a.csv")
        TraceJob(BRACKET, outputs, settings, RecordingUnit(machine="qtplasmac")).run()
        hole, outline = read_path(here / "a.csv").runs()  # a torch cuts the part with its hole
        assert np.ptp(hole) < np.ptp(outline)
        ways[name] = area_mm2(outline) > 0
    assert ways == {"as the machine": False, "as asked": True, "as the head": True}


def test_what_is_wrong_is_raised(here: Path, path_file: Path) -> None:
    nowhere = TraceSettings(LineSettings(start_mm=(1.0, 1.0)))
    with pytest.raises(LineFault):
        TraceJob(CURVE, TraceOutputs(here / "a.csv"), nowhere).run()
    both = TraceSettings(LineSettings(start_mm=(1.0, 1.0), lines="contours"))
    with pytest.raises(WrongUse, match="--lines several"):
        TraceJob(CURVE, TraceOutputs(here / "a.csv"), both).run()
    with pytest.raises(WrongUse, match="--pickup is for tapes"):
        RecordJob(path_file, here / "a.steps", unit=RecordingUnit("coil")).run()
    with pytest.raises(WrongUse, match="--pickup is for tapes"):
        RunJob(CURVE, here, unit=RecordingUnit("coil", machine="grbl-pen")).run()
    with pytest.raises(WrongUse, match="no setting 'colour'"):
        TraceSettings(head=HeadSettings(changes=("colour=3",))).of_head()
    assert list(here.iterdir()) == []


def test_an_interruption_passes_through_and_leaves_nothing(here: Path, path_file: Path) -> None:
    class Impatient(Recording):
        @contextmanager
        def progress(self, what: str, total: float) -> Iterator[Callable[[float], None]]:
            def stop(done: float) -> None:
                raise KeyboardInterrupt

            yield stop

    with pytest.raises(KeyboardInterrupt):
        RecordJob(path_file, here / "a.wav").run(Impatient())
    assert list(here.iterdir()) == []
