"""The time of a program on its own machine: the same whether its control or the check has read it."""

from __future__ import annotations

from pathlib import Path

import pytest

from morfax.jobs.machine.running import on_machine, on_machine_as_read
from morfax.jobs.play import PlayJob
from morfax.player.controls import play
from morfax.player.gcode.check import checked

WAY = "G0 X0 Y0\n{on}\nG1 X10 F1200\nG2 X20 Y0 I5 J0\n{off}\nG4 P0.5\nG0 X40 Y5\n{on}\nG1 X45\n{off}\n"
PROGRAMS = {
    "linuxcnc": "G21 G90\nG0 Z5\n"
    + WAY.format(on="M3 S9000\nG1 Z-1 F300", off="G0 Z5\nM5")
    + "M2\n",
    "grbl-laser": "G21 G90\n" + WAY.format(on="M4 S500", off="M5") + "M2\n",
    "grbl-pen": "G21 G90\n" + WAY.format(on="M3 S90\nG4 P0.2", off="M5") + "M2\n",
    "marlin-fan": "G21 G90\n" + WAY.format(on="M106 S200", off="M107"),
    "qtplasmac": "G21 G90\nF#<_hal[plasmac.cut-feed-rate]>\n"
    + WAY.format(on="M3 $0 S1\nM67 E3 Q60", off="M67 E3 Q0\nM5 $0")
    + "M2\n",
}


@pytest.mark.parametrize("name", PROGRAMS)
@pytest.mark.parametrize("is_given", [True, False])
def test_the_time_by_what_the_control_has_read(
    name: str, is_given: bool, tmp_path: Path
) -> None:
    file, given = tmp_path / "part.ngc", name if is_given else None
    file.write_text(PROGRAMS[name])
    read = play(file, **({"machine": name} if is_given else {})).as_read  # type: ignore[attr-defined]
    figures = on_machine_as_read(read, given)
    assert figures["machine"] == name
    assert figures == {**on_machine(file, given), "machine": name}


def test_a_feed_above_those_of_the_control_counts_as_it_was_asked_for(tmp_path: Path) -> None:
    file = tmp_path / "fast.nc"
    file.write_text("M5\nG0 X5 Y5\nM3 S300\nG1 X90 F90000\nM5\nG0 X0\nM2\n")
    read = play(file, machine="grbl-laser").as_read  # type: ignore[attr-defined]
    assert on_machine_as_read(read, "grbl-laser") == on_machine(file, "grbl-laser")


def test_play_reads_a_program_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = tmp_path / "part.ngc"
    file.write_text(PROGRAMS["linuxcnc"])
    seconds = on_machine(file)["machine_duration_s"]

    def read_again(*_: object) -> None:
        raise AssertionError("the program is read for a second time")

    monkeypatch.setattr(checked, "check_lines", read_again)
    assert PlayJob(file).run().figures["machine_duration_s"] == seconds
