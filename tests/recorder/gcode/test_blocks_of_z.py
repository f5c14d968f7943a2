"""Blocks beside their way: chords, moves of Z, dwells, flat arcs and slopes, and what cannot be recorded."""

from __future__ import annotations

import math
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from morfax.motion.contour import distance
from morfax.motion.faults import MotionFault
from morfax.motion.motion import MOTION_RATE_HZ, Motion, thin
from morfax.motion.motion import Path as MotionPath
from morfax.motion.pathfile import read_path
from morfax.player.gcode.machine_reader import read_program
from morfax.player.gcode.moves import LINE
from morfax.recorder.gcode.arcs import fit
from morfax.recorder.gcode.blocks import record_blocks
from morfax.recorder.gcode.machine import TOLERANCE_MM
from morfax.recorder.gcode.pieces import (
    off_circle_mm,
    off_line_mm,
)
from morfax.recorder.gcode.stretches import DWELL_S
from morfax.recorder.media import record
from morfax.tracer.operator.zunit import QuillMove, z_moves
from tests.recorder.gcode.runs import FEWEST, SAMPLES, arc, run_of

WRITTEN_MM = 1e-4  # the last digit of the default machine


def path_of(xy: np.ndarray, z_mm: float = 0.0, speed_mm_s: float = 10.0) -> MotionPath:
    """The tool goes down, round, and up."""
    around = np.vstack([xy[:1], xy, xy[-1:]])
    z = np.full(len(around), z_mm)
    z[0] = z[-1] = 2.0
    points = np.column_stack([around, z])
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    return MotionPath(np.r_[0.0, np.cumsum(steps / speed_mm_s)], points)


def moves_of(file: Path) -> list[str]:
    """The lines of a program between what LinuxCNC's machine begins and ends it with."""
    lines = file.read_text().split("\n")
    first, last = lines.index("G4 P2") + 1, lines.index("M5")
    return [line for line in lines[first:last] if "crc32" not in line]


def test_what_fits_no_chain_is_given_as_chords() -> None:
    zigzag = np.column_stack([np.linspace(0, 2, 400), 0.05 * (np.arange(400) // 7 % 2)])
    for chain in fit(zigzag, 0.004):
        assert chain.deviation_mm <= 0.004


@given(st.floats(0.5, 500), st.floats(0, 6), st.floats(0.2, 3.0))
def test_the_fits_of_line_and_circle_leave_nothing_of_a_line_and_a_circle(
    radius: float, first: float, turn: float
) -> None:
    assert off_circle_mm(arc(radius, first, first + turn)) < 1e-6
    assert off_line_mm(np.linspace([0, 0], [radius, first], 9)) < 1e-9


def test_the_tool_goes_up_and_down_by_z_and_feeds_are_those_of_the_motion(
    tmp_path: Path,
) -> None:
    path = path_of(
        np.vstack([np.linspace([1, 2], [21, 2], 50), arc(5, -math.pi / 2, 0, (21, 7))]),
        z_mm=-1.5,
    )
    report = record_blocks(path, tmp_path / "part.ngc")
    moves = moves_of(report.file)
    assert moves == ["G0 Z2", "G0 X1 Y2", "G1 Z-1.5 F600", *moves[3:5], "G0 Z2"]
    line, turn = read_program(report.file).moves[4:6]  # after the time for the spindle
    assert line.end_mm == pytest.approx(
        (21, 2, -1.5), abs=0.1
    ) and line.feed_mm_s == pytest.approx(10)
    assert turn.centre_mm == pytest.approx((21, 7), abs=0.1) and turn.end_mm == pytest.approx(
        (26, 7, -1.5), abs=2 * WRITTEN_MM
    )
    assert (report.lines, report.arcs, report.bytes) == (3, 1, report.file.stat().st_size)
    # the machine's time: 2 s for the spindle, and its own ramps in the place of the motion's
    assert report.duration_s == pytest.approx(path.t_s[-1] + 2.0, rel=0.02)


def z_program(*moves: tuple[float, float, float]) -> MotionPath:
    """The tool at one place, Z from 2 mm on: each move to a depth, mm, at a feed, mm/s, from rest to rest
    with a motor's acceleration, and a dwell after it, s.
    """
    t_s, z_mm = [0.0], [2.0]
    for to_mm, feed_mm_s, dwell_s in moves:
        motion = z_moves(z_mm[-1], [QuillMove(to_mm, feed_mm_s, dwell_s)])
        t_s += (t_s[-1] + np.arange(1, len(motion) + 1) / MOTION_RATE_HZ).tolist()
        z_mm += motion.tolist()
    points = np.column_stack([np.full(len(z_mm), 10.0), np.full(len(z_mm), 20.0), z_mm])
    return thin([Motion(points)])


@pytest.mark.parametrize("radius_mm", [5e3, 2e4, 1e5])
def test_a_flat_arc_stays_within_the_tolerance(radius_mm: float, tmp_path: Path) -> None:
    # 120 mm of an arc are 360, 90 and 18 um off their chord
    turn = 120 / radius_mm
    path = path_of(arc(radius_mm, 0, turn) - np.array([radius_mm, 0]), z_mm=-1)
    report = record_blocks(path, tmp_path / "part.ngc")
    assert report.deviation_mm <= TOLERANCE_MM
    program = read_program(report.file)
    assert not any(
        move.turned_rad for move in program.moves
    )  # no centre beyond a machine's travel
    there_and_back = distance(run_of(program), path.runs())
    assert (
        there_and_back.hausdorff_mm <= TOLERANCE_MM + 0.001
    )  # 1 um: sagitta of what is drawn out here


def test_every_move_of_z_keeps_its_depth_its_feed_and_its_dwell(tmp_path: Path) -> None:
    # a hole of 8 mm in pecks of 4, a dwell at its bottom, and a plunge slower than the way down to the work
    path = z_program(
        (0.5, 10, 0),
        (-4, 5, 0),
        (1, 20, 0),
        (-3.5, 20, 0),
        (-8, 5, 1.5),
        (2, 50, 0),
        (-1, 2, 0),
        (2, 9, 0),
    )
    report = record_blocks(path, tmp_path / "drill.ngc")
    assert moves_of(report.file)[2:] == [
        "G0 Z0.5",
        "G1 Z-4 F300",
        "G0 Z1",
        "G1 Z-3.5 F1200",
        "G1 Z-8 F300",
        "G4 P1.5",
        "G0 Z2",
        "G1 Z-1 F120",
        "G0 Z2",
    ]
    assert report.dwells == 1
    # rapids, ramps and 2 s for the spindle aside it takes as long as the motion
    assert report.duration_s == pytest.approx(path.t_s[-1] + 2.0, rel=0.1)


def test_a_stand_as_short_as_a_swivel_is_no_dwell(tmp_path: Path) -> None:
    t_s = np.array([0, 1, 1.16, 2.16, 2.16 + DWELL_S, 4])
    x_mm = np.array([0, 10, 10, 20, 20, 30])
    path = MotionPath(t_s, np.column_stack([x_mm, [0, 0, 0, 5, 5, 5], np.zeros(6)]))
    moves = moves_of(record_blocks(path, tmp_path / "part.ngc").file)
    assert [move for move in moves if move.startswith("G4")] == [f"G4 P{DWELL_S:g}"]


@pytest.mark.parametrize(
    ("z_mm", "first"),
    [
        (2.0, ["G0 Z2", "G0 X1 Y2"]),
        (0.0, ["G0 X1 Y2", "G1 Z0 F600"]),
        (-3.0, ["G0 X1 Y2", "G1 Z-3 F600"]),
    ],
)
def test_no_way_to_the_start_is_diagonal(z_mm: float, first: list[str], tmp_path: Path) -> None:
    points = np.array([[1, 2, z_mm], [11, 2, z_mm]])
    report = record_blocks(MotionPath(np.arange(2.0), points), tmp_path / "part.ngc")
    assert moves_of(report.file)[:2] == first


def test_a_slope_is_run_with_lines(tmp_path: Path) -> None:
    points = np.array([[0, 0, 0], [10, 0, -1], [20, 5, -1.5], [20, 5, 2]], np.float64)
    report = record_blocks(MotionPath(np.arange(4.0), points), tmp_path / "part.ngc")
    assert [move.end_mm for move in read_program(report.file).moves[3:]] == [
        tuple(row) for row in points[1:].tolist()
    ]


def test_the_suffix_makes_the_medium(tmp_path: Path) -> None:
    report = record(path_of(arc(5, 0, 3)), tmp_path / "part.ngc", tolerance_mm=0.02)
    assert read_program(tmp_path / "part.ngc").moves and report.bytes > 50


def test_what_cannot_be_recorded_leaves_no_file(tmp_path: Path) -> None:
    file = tmp_path / "part.ngc"
    with pytest.raises(MotionFault, match="stands still"):
        record_blocks(Motion(np.ones((50, 3))), file)
    with pytest.raises(MotionFault, match="not a finite number"):
        record_blocks(MotionPath(np.arange(2.0), np.array([[0, 0, 0], [np.nan, 0, 0]])), file)
    with pytest.raises(MotionFault, match="empty"):
        record_blocks([], file)
    with pytest.raises(ValueError, match="cannot be written"):
        record_blocks(path_of(arc(5, 0, 3)), file, tolerance_mm=0.0)
    assert not list(tmp_path.iterdir())


@pytest.mark.skipif(
    shutil.which("rs274") is None, reason="rs274 of linuxcnc-uspace is not installed"
)
@pytest.mark.parametrize("name", list(FEWEST))
def test_linuxcnc_takes_every_program(name: str, tmp_path: Path) -> None:
    file = tmp_path / "part.ngc"
    record_blocks(read_path(SAMPLES / f"{name}.csv"), file)
    (tmp_path / "tool.tbl").touch()  # else it looks for the example's of a whole installation
    told = subprocess.run(
        ["rs274", "-t", "tool.tbl", "-g", file.name],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert told.returncode == 0, told.stderr
    assert "PROGRAM_END" in told.stdout
    moves = [move for move in read_program(file).moves if move.kind not in ("G0", "G4")]
    assert told.stdout.count("STRAIGHT_FEED") + told.stdout.count("ARC_FEED") == len(moves)


@pytest.mark.parametrize("tolerance_mm", [0.005, 0.02])
def test_a_bend_that_slopes_stays_within_the_tolerance(
    tolerance_mm: float, tmp_path: Path
) -> None:
    """A helix of 10 mm that falls 3 mm in a half turn: its places against the lines in the file, in space."""
    turn = np.linspace(0, np.pi, 2001)
    points = np.column_stack([10 * np.cos(turn), 10 * np.sin(turn), -3 * turn / np.pi])
    path = MotionPath(turn, points)
    report = record_blocks(path, tmp_path / "part.ngc", tolerance_mm=tolerance_mm)
    ends = np.array(
        [move.end_mm for move in read_program(report.file).moves if move.kind == LINE]
    )
    begins, along = ends[:-1], np.diff(ends, axis=0)
    squared = np.maximum((along**2).sum(axis=1), 1e-12)
    off_mm = 0.0
    for place in points[::10]:
        share = np.clip(((place - begins) * along).sum(axis=1) / squared, 0, 1)
        nearest = begins + share[:, None] * along
        off_mm = max(off_mm, float(np.linalg.norm(place - nearest, axis=1).min()))
    assert (
        0.3 * tolerance_mm < off_mm <= tolerance_mm + 0.0005
    )  # a digit of the file, in three axes
