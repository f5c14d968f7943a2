"""The step recorder: a motion in, a punched tape out that stays within a step of it."""

from __future__ import annotations

from pathlib import Path as FilePath
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from morfax.motion import speed_limits
from morfax.motion.contour import distance, distances_mm
from morfax.motion.faults import FileFault, MotionFault, ProgramFault
from morfax.motion.motion import Path, thin
from morfax.motion.segments import Limits, segments
from morfax.player.steps.stepping import play_steps
from morfax.recorder.steps import lengths as lengths_module
from morfax.recorder.steps.file import (
    StepFormat,
    StepProgram,
    holes,
    read_program,
    write_program,
)
from morfax.recorder.steps.rings import RINGS, command, commands
from morfax.recorder.steps.steps import encode, record_steps

STEP_MM = 0.01
# steps: within an interval the axes step one after the other, half a step each way
STAIR = 1.25


def circle(radius_mm: float, speed_mm_s: float, turns: float = 1.0) -> Path:
    """Round a circle at a speed, from the start at once."""
    angle = np.linspace(0, 2 * np.pi * turns, 2001)
    xy = radius_mm * np.column_stack([np.sin(angle), 1 - np.cos(angle)])
    return Path(angle * radius_mm / speed_mm_s, np.column_stack([xy, 0 * angle]))


def polyline(*points: tuple[float, float, float], speed_mm_s: float = 10.0) -> Path:
    """Straight from point to point at a speed, corners and all."""
    places = np.array(points, float)
    lengths = np.sqrt((np.diff(places, axis=0) ** 2).sum(axis=1))
    return Path(np.r_[0, np.cumsum(lengths)] / speed_mm_s, places)


SQUARE = polyline((0, 0, 0), (10, 0, 0), (10, 10, 0), (0, 10, 0), (0, 0, 0))
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


@pytest.mark.parametrize(
    ("lengths", "rows"),
    [
        # standstill, then one step more on each axis: X up, Y down, Z up
        ([(1, -1, 1)], [0b0011_1001]),
        # from (1, 0, 0) X down; then nothing changes
        ([(1, 0, 0), (0, 0, 0), (0, 0, 0)], [0b0001_0001, 0b0001_0010, 0b0001_0000]),
    ],
)
def test_an_axis_row_is_punched_as_figure_6_has_it(
    lengths: list[tuple[int, int, int]], rows: list[int]
) -> None:
    fmt = StepFormat()
    found = encode(np.array(lengths), np.zeros(len(lengths), bool), fmt)
    assert [bin(row) for row in found] == [bin(row) for row in rows]
    down = encode(np.array(lengths), np.ones(len(lengths), bool), fmt)
    assert [int(row) for row in down] == [0b1000_0000 | row for row in rows]
    if not np.any(lengths, axis=0)[2]:  # five channels have neither Z nor a tool
        five = encode(np.array(lengths), np.ones(len(lengths), bool), StepFormat(channels=5))
        assert five.tolist() == rows


def test_vectors_are_punched_in_pairs_of_one_tool_and_no_second_change_of_z() -> None:
    """Ring of two: (2, 0), (2, -1), (1, -2) … are each the next one; figure 11."""
    ramp = [(1, 0, 0), (2, 0, 0)]
    ring = [(2, -1, 0), (1, -2, 0), (0, -2, 0)]
    lengths, fmt = np.array(ramp + ring), StepFormat()
    up = np.zeros(5, bool)
    axis = [0b0001_0001, 0b0001_0001]
    single = encode(lengths, up, StepFormat(vectors=1)).tolist()
    assert single == [*axis, 0b10, 0b10, 0b10]
    # two commands in a row, and what is left over as an axis row: X down
    assert encode(lengths, up, fmt).tolist() == [*axis, 0b1010, 0b0001_0010]
    # the tool changes between the two: both stand alone
    down = np.array([False, False, False, True, True])
    assert len(encode(lengths, down, fmt)) == 4 and encode(lengths, down, fmt)[2] & 0b0001_0000
    # Z changes with the first of a pair, and its bits stand beside the commands; not with the second
    first, second = lengths.copy(), lengths.copy()
    first[2:, 2], second[3:, 2] = 1, 1
    assert encode(first, up, fmt).tolist() == [*axis, 0b0010_1010, 0b0001_0010]
    assert len(encode(second, up, fmt)) == 4


@pytest.mark.parametrize(
    ("speed", "vectors"), [(2, 12), (3, 16), (4, 20), (5, 28), (6, 32), (7, 40)]
)
def test_a_ring_is_a_circle_of_nearly_one_speed(speed: int, vectors: int) -> None:
    """As many vectors as the table has; each as long as the speed within half a step, one step from the
    next; laid end to end they close.
    """
    ring = np.array(RINGS[speed])
    assert len(ring) == len(set(RINGS[speed])) == vectors
    assert np.abs(np.hypot(*ring.T) - speed).max() <= 0.5
    assert np.abs(ring - np.roll(ring, 1, axis=0)).max() == 1
    assert ring.sum(axis=0).tolist() == [0, 0]
    turned = np.diff(np.unwrap(np.arctan2(ring[:, 1], ring[:, 0])))
    assert turned.max() < 0  # towards -Y, clockwise


@pytest.mark.parametrize(
    ("name", "good", "bad"),
    [
        ("step_mm", (1e-6, 1.0), (0.0, 1.001)),
        ("oscillator_hz", (1.0, 1e9), (0.9, 1.1e9)),
        ("rates", ((1,) * 7, (64,) * 7), ((0, 1, 1, 1, 1, 1, 1), (65,) * 7, (1,) * 8)),
        ("start_mm", ((-9e5, 9e5, 0.0),), ((-1e6, 0.0, 0.0), (0.0, 0.0))),
        ("end_mm", ((-9e5, 9e5, 0.0),), ((0.0, 1e6, 0.0), (0.0,) * 4)),
    ],
)
def test_a_format_is_refused_beyond_its_bounds_and_taken_at_them(
    name: str, good: tuple[Any, ...], bad: tuple[Any, ...]
) -> None:
    for value in good:
        assert getattr(StepFormat(**{name: value}), name) == value
    for value in bad:
        with pytest.raises(ValueError, match=name):
            StepFormat(**{name: value})


def test_what_a_format_asks_of_the_motors() -> None:
    """64 pulses at 10 240 Hz are 6.25 ms; one step per interval more in each is 160² steps/s²."""
    fmt = StepFormat()
    assert (fmt.interval_s, fmt.rate_hz, fmt.acceleration_steps_s2) == (
        0.00625,
        160.0,
        25_600.0,
    )
    assert StepFormat(rates=(3, 4, 5, 6, 7, 8, 10)).acceleration_steps_s2 == 3 * 25_600
    assert (fmt.tool_bit, StepFormat(channels=5).tool_bit) == (128, 0)
    counts = StepFormat(vectors=0, channels=13)
    assert counts.tool_bit == 4096 and counts.holds_counts and not fmt.holds_counts
    with pytest.raises(ValueError, match="13 for counts"):
        StepFormat(vectors=0, channels=8)


# the file


def test_a_program_comes_back_from_its_file(tmp_path: FilePath) -> None:
    fmt = StepFormat(0.0254, 7680, (1, 3, 5, 7, 8, 9, 10), 1, 5, (1.5, -2, 0), (1.5, -2, 0))
    written = StepProgram(fmt, np.array([0b10001, 0b10001, 0, 0b11111], np.uint8))
    write_program(written, tmp_path / "a.steps")
    read = read_program(tmp_path / "a.steps")
    assert read.format == fmt and (read.rows == written.rows).all()
    assert read.lines.tolist() == [11, 11, 12, 13]
    assert "o...o  x2\n.....\nooooo\nend crc32 " in (tmp_path / "a.steps").read_text()
    assert holes(0b10110, 5) == "o.oo."


GOOD = (
    "morfax steps 1\nstep_mm 0.01\noscillator_hz 10240\nrates 1 2 3 4 5 6 7\nvectors 2\nchannels 8\n"
    "start_mm 0 0 0\nend_mm 0.01 0 0\nrows 2\n\n...o...o\n...o..o.\nend\n"
)
BAD = [
    ("", "must begin with", 1),
    (GOOD.replace("steps 1", "steps 2"), "version 2; this program reads 1", 1),
    (GOOD.replace("step_mm", "stop_mm"), "instead of step_mm", 2),
    (GOOD.replace("10240", "fast"), "is no number", 3),
    (GOOD.replace("6 7", "6"), "7 whole numbers", None),
    (GOOD.replace("vectors 2", "vectors 3"), "1 \\(figure 6\\) or 2", None),
    (GOOD.replace("channels 8", "channels 7"), "5 or 8", None),
    (GOOD.replace("step_mm 0.01", "step_mm nan"), "step_mm", None),
    (GOOD.replace("start_mm 0 0 0", "start_mm 0 0"), "three numbers", None),
    (GOOD.replace("...o..o.", "...o..x."), "it must be 8 of o and", 12),
    (GOOD.replace("...o..o.", "...o..o"), "it must be 8 of o and", 12),
    (GOOD.replace("...o..o.", "...o..o. x0"), "holds 1 of the 2 rows", None),
    (GOOD.replace("...o..o.", "...o..o. x5"), "more than the 2 rows", 12),
    (GOOD.replace("end\n", ""), "cut short: 2 of 2 rows and no end", None),
    (GOOD[:130], "line|cut short", None),
    (GOOD.replace("end_mm 0.01", "end_mm 0.5"), "but it states 0.500 mm", None),
    (GOOD.replace("...o..o.", "........"), "ends at speed", None),
    (GOOD.replace("start_mm 0", "start_mm 2000"), "line 11: X goes to 2000.01 mm", 11),
    (GOOD.replace("10240", "20480"), "the motor gives 25600", None),
    ("\xff", "no ASCII text", None),
]


@pytest.mark.parametrize(("text", "told", "line"), BAD, ids=range(len(BAD)))
def test_a_garbled_file_is_one_line_with_its_place(
    tmp_path: FilePath, text: str, told: str, line: int | None
) -> None:
    (tmp_path / "a.steps").write_text(text, encoding="latin-1")
    with pytest.raises(ProgramFault, match=told) as met:
        play_steps(tmp_path / "a.steps")
    assert "\n" not in str(met.value)
    assert met.value.line == line or told.startswith("line")


def test_the_good_file_is_good(tmp_path: FilePath) -> None:
    (tmp_path / "a.steps").write_text("# a remark\n" + GOOD)
    with pytest.raises(FileFault):
        read_program(tmp_path / "b.steps")
    (tmp_path / "a.steps").write_text(GOOD.replace("...o...o", "# a remark\n\n...o...o"))
    assert play_steps(tmp_path / "a.steps").pulses.tolist() == [[1, 0, 0], [0, 0, 0]]


# rings, legs and lengths


def test_every_vector_command_stands_in_the_table() -> None:
    table = commands()
    assert np.count_nonzero(table >= 0) == 3 * sum(map(len, RINGS.values()))
    assert (
        command((6, 0), (6, -1)) == 0b10
        and command((6, -1), (6, 0)) == 0b01
        and command((6, 0), (6, 0)) == 0
    )
    assert command((6, 0), (6, -2)) is None and command((0, 0), (1, 0)) is None
    assert table[6 + 7, 7, 1, 0] == 0b10


def test_legs_part_at_corners_and_rests_and_run_from_stop_to_stop() -> None:
    found = segments(SQUARE, Limits(10, 256))
    assert [round(leg.length_mm, 3) for leg in found] == [10] * 4
    for leg in found:
        assert leg.speed_mm_s[0] == leg.speed_mm_s[
            -1
        ] == 0 and leg.speed_mm_s.max() == pytest.approx(10)
        pull = np.diff(leg.speed_mm_s**2) / 2 / leg.spacing_mm
        assert np.abs(pull).max() <= 0.7 * 256 * 1.001  # mm/s²
    assert found[0].times_s[-1] == pytest.approx(10 / 10 + 10 / (0.7 * 256), rel=1e-3)


def test_a_bend_is_taken_no_faster_than_the_motor_can_pull() -> None:
    leg = max(segments(circle(0.5, 100), Limits(100, 256)), key=lambda leg: leg.length_mm)
    assert leg.speed_mm_s.max() == pytest.approx(
        np.sqrt(0.7 * 256 * 0.5 * np.sqrt(2)), rel=0.05
    )  # at 45 degrees


def test_the_kernels_do_as_plain_python_what_they_do_compiled() -> None:
    leg = segments(polyline((0, 0, 0), (0.3, 0.1, 0)), Limits(10, 256))[0]
    squared = np.array([0, 5, 5, 5, 5, 5, 5, 5, 0.0])
    speed_limits._passes.py_func(squared, np.ones(8), True)
    assert squared.tolist() == [0, 1, 2, 3, 4, 3, 2, 1, 0]
    places, speeds = leg.places_mm / STEP_MM, leg.speed_mm_s / STEP_MM / 160
    compiled = lengths_module.cut(
        places, speeds, leg.spacing_mm / STEP_MM, np.zeros(3, np.int64)
    )
    plain = pytest.MonkeyPatch()
    for name in ("_search", "_continued", "_speed_price", "_keep", "_arrived", "_nearest"):
        plain.setattr(lengths_module, name, getattr(lengths_module, name).py_func)
    again = lengths_module.cut(places, speeds, leg.spacing_mm / STEP_MM, np.zeros(3, np.int64))
    plain.undo()
    assert (compiled[0] == again[0]).all() and compiled[0].sum(axis=0).tolist() == [30, 10, 0]


@given(st.binary(max_size=200), st.integers(0, len(GOOD)), st.integers(0, 60))
def test_whatever_stands_in_a_file_is_played_or_refused_in_one_line(
    tmp_path_factory: pytest.TempPathFactory, junk: bytes, at: int, over: int
) -> None:
    file = tmp_path_factory.mktemp("junk") / "a.steps"
    good = GOOD.encode()
    for content in (junk, good[:at] + junk + good[at + over :]):
        file.write_bytes(content)
        try:
            playback = play_steps(file)
            assert list(playback) and not playback.following_error_mm.any()
        except ProgramFault as fault:
            assert "\n" not in str(fault)
