"""The step recorder: a motion in, a punched tape out that stays within a step of it."""

from __future__ import annotations

from pathlib import Path as FilePath

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from morfax.motion.contour import distance, distances_mm
from morfax.motion.faults import MotionFault
from morfax.motion.motion import Path, thin
from morfax.motion.segments import Limits, segments
from morfax.player.steps.stepping import play_steps
from morfax.recorder.steps.file import (
    StepFormat,
    StepProgram,
    read_program,
)
from morfax.recorder.steps.steps import encode, record_steps
from tests.recorder.steps.paths import SQUARE, STEP_MM, circle, polyline

# steps: within an interval the axes step one after the other, half a step each way
STAIR = 1.25
STAR = polyline((0, 0, 0), (10, 2, 0), (1, 4, 0), (9, -5, 0), (4, 7, 0), (0, 0, 0))
TOOL = polyline((3, 3, 2), (3, 3, -1), (9, 7, -1), (9, 7, 2))


@pytest.mark.parametrize(
    "path",
    [circle(10, 10), circle(0.5, 10), SQUARE, STAR],
    ids=["10 mm", "0.5 mm", "square", "star"],
)
def test_the_machine_stays_within_a_step_of_the_motion(tmp_path: FilePath, path: Path) -> None:
    report = record_steps(path, tmp_path / "a.steps")
    assert report.deviation_mm <= STEP_MM
    found = distance(thin(play_steps(tmp_path / "a.steps")), path)
    assert found.hausdorff_mm <= STAIR * STEP_MM


def test_the_tool_goes_down_and_up_over_its_places(tmp_path: FilePath) -> None:
    record_steps(TOOL, tmp_path / "a.steps")
    playback = play_steps(tmp_path / "a.steps")
    played = thin(playback)
    assert played.positions_mm[0] == pytest.approx([3, 3, 2]) and played.positions_mm[
        -1
    ] == pytest.approx([9, 7, 2])
    assert played.positions_mm[:, 2].min() == pytest.approx(-1, abs=STEP_MM)
    assert [change.down for change in playback.tool_changes] == [True, False]
    down_s = playback.tool_changes[0].time_s
    assert np.interp(down_s, played.t_s, played.positions_mm[:, 2]) == pytest.approx(
        0.05, abs=0.15
    )  # one interval


def test_a_tolerance_is_the_size_of_the_steps(tmp_path: FilePath) -> None:
    report = record_steps(circle(5, 4), tmp_path / "a.steps", tolerance_mm=0.005)
    assert report.format.step_mm == 0.005 and report.deviation_mm <= 0.005
    with pytest.raises(MotionFault, match=r"allowed 0\.001 mm: give a larger tolerance"):
        record_steps(circle(5, 4), tmp_path / "b.steps", tolerance_mm=0.001, fmt=StepFormat())
    assert not (tmp_path / "b.steps").exists()


def test_the_speed_is_held_in_rings_and_taken_back_before_corners(tmp_path: FilePath) -> None:
    report = record_steps(circle(20, 9.6), tmp_path / "c.steps")  # six steps in an interval
    assert report.vector_intervals > 0.9 * report.intervals
    record_steps(SQUARE, tmp_path / "s.steps")
    playback = play_steps(tmp_path / "s.steps")
    at = playback.start_mm + np.cumsum(playback.pulses, axis=0) * STEP_MM
    corner = np.hypot(at[:, 0] - 10, at[:, 1]) < STEP_MM
    assert (
        np.abs(playback.pulses[corner]).max() <= 2
        and not playback.pulses[corner].any(axis=1).all()
    )


def test_two_vectors_in_a_row_take_fewer_rows_for_the_same_path(tmp_path: FilePath) -> None:
    one = record_steps(circle(10, 9), tmp_path / "one.steps", fmt=StepFormat(vectors=1))
    two = record_steps(circle(10, 9), tmp_path / "two.steps", fmt=StepFormat(vectors=2))
    assert one.rows == one.intervals and two.rows < 0.6 * one.rows
    assert (
        play_steps(tmp_path / "one.steps").counts == play_steps(tmp_path / "two.steps").counts
    ).all()


@given(st.lists(st.tuples(*[st.integers(-1, 1)] * 3), max_size=40), st.sampled_from([1, 2]))
def test_what_is_encoded_is_decoded(changes: list[tuple[int, int, int]], vectors: int) -> None:
    from morfax.player.steps.stepping import decode, pulses_of

    lengths = np.clip(np.cumsum(np.array(changes, np.int64).reshape(-1, 3), axis=0), -7, 7)
    lengths = (
        lengths[np.r_[True, np.abs(np.diff(lengths, axis=0)).max(axis=1) <= 1]]
        if len(lengths)
        else lengths
    )
    fmt = StepFormat(vectors=vectors)
    counts, _ = decode(StepProgram(fmt, encode(lengths, np.zeros(len(lengths), bool), fmt)))
    assert (pulses_of(counts, fmt.rates) == lengths).all()


def test_what_cannot_be_punched_is_refused() -> None:
    with pytest.raises(ValueError, match="more than one step"):
        encode(np.array([[2, 0, 0]]), np.zeros(1, bool), StepFormat())
    with pytest.raises(ValueError, match="five channels"):
        encode(np.array([[0, 0, 1]]), np.zeros(1, bool), StepFormat(channels=5))


def test_a_motion_that_is_none_is_refused(tmp_path: FilePath) -> None:
    with pytest.raises(MotionFault, match="empty"):
        record_steps([], tmp_path / "a.steps")
    with pytest.raises(MotionFault, match=r"0\.500 s"):
        record_steps(
            Path(np.array([0, 0.5]), np.array([[0, 0, 0], [np.nan, 0, 0]])),
            tmp_path / "a.steps",
        )
    with pytest.raises(ValueError, match="above zero"):
        record_steps(SQUARE, tmp_path / "a.steps", tolerance_mm=0)
    assert not list(tmp_path.iterdir())


def test_a_motion_that_stands_is_a_tape_without_rows(tmp_path: FilePath) -> None:
    report = record_steps(
        Path(np.array([0.0, 1]), np.array([[1.0, 2, 3]] * 2)), tmp_path / "a.steps"
    )
    assert report.rows == 0 and thin(play_steps(tmp_path / "a.steps")).positions_mm[
        -1
    ].tolist() == [1, 2, 3]


def test_a_rest_is_kept(tmp_path: FilePath) -> None:
    moved = polyline((0, 0, 0), (2, 0, 0), (4, 0, 0))
    rested = Path(np.array([0, 0.2, 1.2, 1.4]), moved.positions_mm[[0, 1, 1, 2]])
    gained_s = [
        record_steps(path, tmp_path / "a.steps").duration_s for path in (rested, SQUARE, moved)
    ]
    assert gained_s[0] - gained_s[2] > 1.0


def test_the_report_counts_rows_vectors_and_steps(tmp_path: FilePath) -> None:
    """A straight line of 2 mm along X, and back: 400 steps, of which no change but at 2 … 7 is a vector."""
    report = record_steps(polyline((0, 0, 0), (2, 0, 0), (0, 0, 0)), tmp_path / "a.steps")
    program = read_program(tmp_path / "a.steps")
    assert report.steps == 400 and report.rows == len(program.rows)
    axis_rows = int(np.count_nonzero(program.rows & 0b0001_0000))
    assert report.vector_intervals == report.intervals - axis_rows
    assert report.figures == {
        "rows": report.rows,
        "punched_bits": 8 * report.rows,
        "vector_share": report.vector_intervals / report.intervals,
        "deviation_mm": report.deviation_mm,
    }
    counts = record_steps(SQUARE, tmp_path / "b.steps", orders="counts")
    assert counts.rows == counts.intervals and counts.vector_intervals == 0
    assert counts.figures["punched_bits"] == 13 * counts.rows


@pytest.mark.parametrize("path", [circle(10, 9), circle(2, 5), SQUARE, STAR])
def test_a_program_takes_as_long_as_its_speeds_and_stops(
    tmp_path: FilePath, path: Path
) -> None:
    """By the motors' limits for each leg; whole intervals and steps make it up to a twentieth longer."""
    report = record_steps(path, tmp_path / "a.steps")
    fmt = report.format
    limits = Limits(
        0.98 * 7 * fmt.step_mm * fmt.rate_hz,
        fmt.step_mm * fmt.rate_hz**2,
        spacing_mm=fmt.step_mm / 4,
        window_mm=5 * fmt.step_mm,
    )
    own_s = sum(float(leg.times_s[-1]) for leg in segments(path, limits))
    assert 0.95 * own_s < report.duration_s < 1.05 * own_s + 0.1 * report.format.interval_s


@pytest.mark.parametrize("path", [circle(10, 9), STAR])
def test_the_steps_lie_about_the_motion_and_not_beside_it(
    tmp_path: FilePath, path: Path
) -> None:
    """Places on a grid of steps are 0.3 to 0.5 steps off a line, root mean square, at the best."""
    report = record_steps(path, tmp_path / "a.steps")
    playback = play_steps(tmp_path / "a.steps")
    ends = playback.start_mm + np.cumsum(playback.pulses, axis=0) * STEP_MM
    off_mm = distances_mm(ends[:, :2], path)
    assert np.sqrt(np.mean(off_mm**2)) < 0.4 * STEP_MM
    assert (
        off_mm.max() <= report.deviation_mm + 0.25 * STEP_MM
    )  # it is told by places a quarter apart
