"""The block recorder: the fewest lines and arcs within a tolerance, tangent where smooth, corners kept;
RS-274 text.
"""

from __future__ import annotations

import math
import shutil
import subprocess
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from morfax.motion.contour import distance
from morfax.motion.faults import MotionFault
from morfax.motion.motion import MOTION_RATE_HZ, Motion, thin
from morfax.motion.motion import Path as MotionPath
from morfax.motion.pathfile import read_path
from morfax.player.gcode.machine_reader import read_program
from morfax.player.gcode.moves import LINE, Move, Program
from morfax.recorder.gcode.arcs import fit
from morfax.recorder.gcode.blocks import TOLERANCE_MM, record_blocks
from morfax.recorder.gcode.normal_equations import BREAK_RAD
from morfax.recorder.gcode.pieces import (
    corners,
    longest_pieces,
    off_circle_mm,
    off_line_mm,
    resample,
)
from morfax.recorder.gcode.spline import LineOrArc
from morfax.recorder.gcode.stretches import DWELL_S
from morfax.recorder.media import record
from morfax.tracer.operator.zunit import QuillMove, z_moves

SAMPLES = Path(__file__).parents[3] / "samples"
FEWEST = {
    "gear": 16,
    "bracket": 9 + 4,
    "cam": 15,
    "curve": 25,
}  # drawn; cam and curve: circles that need not meet
WRITTEN_MM = 1e-4  # the last digit of the default machine
ASKED = 1.3  # times as many segments at most


def bend(points: list[tuple[float, float]]) -> np.ndarray:
    return np.array(points, np.float64)


def arc(
    radius: float, first: float, last: float, centre: tuple[float, float] = (0, 0)
) -> np.ndarray:
    """Points of an arc, 1 um of sagitta or less apart."""
    t = np.linspace(first, last, 2 + int(abs(last - first) * math.sqrt(radius / 0.008)))
    return np.array(centre) + radius * np.column_stack([np.cos(t), np.sin(t)])


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


def run_of(program: Program) -> list[np.ndarray]:
    """The (n, 2) polylines that a program runs at and below the surface, arcs drawn out."""
    place, runs = np.array(program.start_mm), []
    for move in program.moves:
        points = _drawn(place, move)
        if move.kind != "G4" and place[2] <= 0.05 and move.end_mm[2] <= 0.05:
            runs.append(points)
        place = np.array(move.end_mm)
    return runs


def _drawn(place: np.ndarray, move: Move) -> np.ndarray:
    if not move.turned_rad:
        return np.array([place[:2], move.end_mm[:2]])
    first = math.atan2(place[1] - move.centre_mm[1], place[0] - move.centre_mm[0])
    radius = math.dist(place[:2], move.centre_mm)
    return arc(radius, first, first + move.turned_rad, move.centre_mm)


def segments(points: np.ndarray, tolerance_mm: float = TOLERANCE_MM) -> list[list[LineOrArc]]:
    return [chain.segments for chain in fit(points, tolerance_mm)]


@pytest.mark.parametrize("name", list(FEWEST))
def test_the_samples_need_hardly_more_than_the_fewest_segments(
    name: str, tmp_path: Path
) -> None:
    path = read_path(SAMPLES / f"{name}.csv")
    chains = [chain for run in path.runs() for chain in fit(run, TOLERANCE_MM)]
    assert sum(len(chain.segments) for chain in chains) <= ASKED * FEWEST[name]
    report = record_blocks(path, tmp_path / "part.ngc")
    assert report.deviation_mm <= TOLERANCE_MM
    there_and_back = distance(run_of(read_program(report.file)), path.runs())
    # 1 um: sagitta of what is drawn out here
    assert there_and_back.hausdorff_mm <= report.deviation_mm + 0.001


def test_a_rounded_square_is_four_lines_and_four_arcs() -> None:
    sides = [
        arc(3, a, a + math.pi / 2, c)
        for a, c in zip(
            np.arange(4) * math.pi / 2, [(7, 7), (3, 7), (3, 3), (7, 3)], strict=True
        )
    ]
    points = np.vstack([[[10.0, 5.0]], *sides, [[10.0, 5.0]]])
    (chain,) = segments(points)
    assert len(chain) == 9  # the side on which it starts is in two
    assert sorted(
        round(1 / s.curvature_per_mm, 2) for s in chain if s.curvature_per_mm
    ) == pytest.approx([3.0] * 4, abs=0.02)


def test_a_circle_is_two_arcs() -> None:
    ((one, two),) = segments(arc(20, 0.3, 0.3 + 2 * math.pi))
    assert one.turned_rad + two.turned_rad == pytest.approx(2 * math.pi, abs=1e-3)
    assert 1 / one.curvature_per_mm == pytest.approx(20, abs=0.002)


def test_a_line_is_one_line() -> None:
    ((line,),) = segments(np.column_stack([np.linspace(0, 90, 500), np.linspace(0, -20, 500)]))
    assert (line.curvature_per_mm, line.end_mm) == (0.0, pytest.approx((90, -20)))


@pytest.mark.parametrize("turn_deg", [15, 36, 90, 150, 174])
def test_corners_are_kept(turn_deg: float) -> None:
    turn = math.radians(turn_deg)
    points = np.vstack(
        [
            np.linspace([-30, 0], [0, 0], 300),
            np.linspace([0, 0], [30 * math.cos(turn), 30 * math.sin(turn)], 300)[1:],
        ]
    )
    chains = segments(points)
    assert [len(chain) for chain in chains] == [1, 1]
    assert chains[1][0].begin_mm == pytest.approx((0, 0), abs=1e-9)


def test_a_bend_is_no_corner() -> None:
    assert (
        len(
            corners(
                np.vstack(
                    [
                        np.linspace([-9, -1], [0, -1], 9),
                        arc(1.0, -math.pi / 2, math.pi / 2),
                        np.linspace([0, 1], [-9, 1], 9),
                    ]
                )
            )
        )
        == 0
    )


@given(st.integers(0, 10_000))
@settings(max_examples=25)
def test_a_smooth_line_is_run_tangent_at_every_joint_within_the_tolerance(seed: int) -> None:
    random = np.random.default_rng(seed)
    t = np.linspace(0, 1, 900)
    waves = sum(
        random.uniform(0.1, 4)
        * np.sin(2 * math.pi * random.uniform(0.2, 2) * t + random.uniform(0, 6))
        for _ in range(3)
    )
    points = np.column_stack([50 * t, waves])
    (chain,) = fit(points, TOLERANCE_MM)
    for before, after in pairwise(chain.segments):
        assert before.end_mm == pytest.approx(after.begin_mm, abs=1e-9)
        jump = math.remainder(
            after.heading_rad - before.heading_rad - before.turned_rad, 2 * math.pi
        )
        assert abs(jump) <= 10 * BREAK_RAD
    assert chain.deviation_mm <= TOLERANCE_MM
    drawn = np.vstack([_drawn_segment(segment) for segment in chain.segments])
    # 1 um of sagitta, 1 um between samples
    assert distance(drawn, points).hausdorff_mm <= TOLERANCE_MM + 0.002
    fewest = len(longest_pieces(resample(points), TOLERANCE_MM))
    assert len(chain.segments) <= max(ASKED * fewest, fewest + 2)


def _drawn_segment(segment: LineOrArc) -> np.ndarray:
    return np.array(
        [
            segment.begin_mm,
            *(
                LineOrArc(
                    segment.begin_mm,
                    segment.heading_rad,
                    share * segment.length_mm,
                    segment.curvature_per_mm,
                ).end_mm
                for share in np.linspace(0, 1, 60)[1:]
            ),
        ]
    )


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
