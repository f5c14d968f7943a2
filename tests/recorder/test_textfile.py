"""The check sum of program files: one changed character is a fault, or changes nothing."""

from __future__ import annotations

import string
from pathlib import Path as FilePath

import numpy as np
import pytest

from morfax.motion.arrays import Array
from morfax.motion.faults import ProgramFault
from morfax.player.controls import play
from morfax.recorder.cubics.cubics import record_cubics
from morfax.recorder.cubics.file import read_program as read_cubic
from morfax.recorder.steps.file import read_program as read_steps
from morfax.recorder.steps.steps import record_steps
from tests.recorder.steps.paths import circle

RECORDERS = {".steps": record_steps, ".cubic": record_cubics}


@pytest.fixture(params=RECORDERS)
def program(request: pytest.FixtureRequest, tmp_path: FilePath) -> FilePath:
    """A circle of 0.5 mm: it ends where it starts, so that no size of the steps changes its end."""
    file = tmp_path / f"a{request.param}"
    RECORDERS[request.param](circle(0.5, 5), file)
    return file


def motion_of(file: FilePath) -> list[Array]:
    """All numbers from which the motion of a program follows, as they are read."""
    if file.suffix == ".steps":
        steps = read_steps(file)
        fmt = steps.format
        figures = [fmt.step_mm, fmt.oscillator_hz, fmt.vectors, fmt.channels]
        places = [*fmt.rates, *fmt.start_mm, *fmt.end_mm]
        return [np.array([*figures, *places]), steps.rows]
    cubic = read_cubic(file)
    fmt = cubic.format
    figures = [fmt.interval_s, fmt.points, fmt.linear, fmt.counts_per_mm, fmt.modulus_per_s]
    return [np.array(figures), cubic.words, np.array(cubic.checks[0])]


def test_every_changed_character_of_the_header_is_a_fault_or_the_same_motion(
    program: FilePath,
) -> None:
    text = program.read_text()
    header, right, faults = text.index("\n\n"), motion_of(program), 0
    for at in range(header):
        for other in {*string.digits, *".-e #x\n", chr(ord(text[at]) ^ 1)} - {text[at]}:
            program.write_text(text[:at] + other + text[at + 1 :], newline="")
            try:
                found = motion_of(program)
            except ProgramFault as fault:
                assert "\n" not in str(fault)
                faults += 1
                continue
            assert all(np.array_equal(a, b) for a, b in zip(found, right, strict=True)), (
                at,
                other,
            )
    assert faults > 10 * header


def test_a_changed_character_of_the_rows_is_a_fault_or_the_same_motion(
    program: FilePath,
) -> None:
    text, right = program.read_text(), motion_of(program)
    random = np.random.default_rng(443122)
    for at in random.integers(text.index("\n\n") + 2, len(text), 100).tolist():
        for other in {"o", ".", "0", "7", "-"} - {text[at]}:
            program.write_text(text[:at] + other + text[at + 1 :])
            try:
                found = motion_of(program)
            except ProgramFault:
                continue
            assert all(np.array_equal(a, b) for a, b in zip(found, right, strict=True)), (
                at,
                other,
            )


def test_a_wrong_sum_says_what_to_do(program: FilePath) -> None:
    text = program.read_text()
    program.write_text(text[: text.rindex(" ")] + " 00000000\n")
    with pytest.raises(
        ProgramFault, match=r"the check sum is 00000000, .*end it with 'end' alone"
    ):
        play(program)


def test_a_file_without_a_sum_plays_with_a_note(program: FilePath) -> None:
    whole = play(program)
    assert list(whole) and whole.notes == ()
    text = program.read_text()
    program.write_text(text[: text.rindex(" crc32")] + "\n")
    playback = play(program)
    assert list(playback) and playback.end_mm == pytest.approx(whole.end_mm, abs=0)
    (note,) = playback.notes
    assert "has no check sum" in note and "\n" not in note


def test_remarks_and_blank_lines_are_not_summed(program: FilePath) -> None:
    text = program.read_text()
    program.write_text("# by hand\n" + text.replace("\n\n", "\n\n# the rows\n\n"))
    assert play(program).notes == ()
