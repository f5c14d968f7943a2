"""Step programs as files: rows, formats, rings of vectors, legs and lengths."""

from __future__ import annotations

from pathlib import Path as FilePath
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from morfax.motion import speed_limits
from morfax.motion.faults import FileFault, ProgramFault
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
from morfax.recorder.steps.steps import encode
from tests.recorder.steps.paths import SQUARE, STEP_MM, circle, polyline


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
