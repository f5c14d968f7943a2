"""Reading ahead: the same blocks as without a thread, the same faults, and nothing left running."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import soundfile

from morfax.motion.drive import SOUND
from morfax.motion.faults import Fault
from morfax.motion.motion import MOTION_RATE_HZ, Motion
from morfax.player.tape.ahead import BLOCKS_AHEAD, NAME, ReadAhead
from morfax.player.tape.check_reader import CheckReader
from morfax.player.tape.discriminator import Discriminator
from morfax.player.tape.playback import TapePlayback, play
from morfax.recorder.tape.tape import TapeFormat, record

LONG_S = 5.0  # for a thread to come to rest


def is_anything_left() -> bool:
    """Whether a reading thread runs still, when those that end have ended."""
    until_s = time.monotonic() + LONG_S
    while any(thread.name == NAME for thread in threading.enumerate()):
        if time.monotonic() > until_s:
            return True
        time.sleep(0.01)
    return False


def test_the_blocks_come_in_order_and_the_fault_behind_the_last() -> None:
    def make() -> Iterator[int]:
        yield from range(20)
        raise Fault("the tape is torn")

    found: list[int] = []
    with pytest.raises(Fault, match="torn"):
        found.extend(ReadAhead[int]().blocks(make))
    assert found == [*range(20)]
    assert list(ReadAhead[int]().blocks(lambda: iter(range(7)))) == [*range(7)]


def test_so_many_blocks_are_made_ahead_and_no_more() -> None:
    made: list[int] = []

    def make() -> Iterator[int]:
        for number in range(9):
            made.append(number)
            yield number

    for number in ReadAhead[int]().blocks(make):
        time.sleep(0.02)  # what takes long to use
        assert len(made) <= number + 1 + BLOCKS_AHEAD
    assert len(made) == 9


def test_who_makes_a_block_is_told_of_the_use_of_all_before_it() -> None:
    ahead, used, told = ReadAhead[int](), [], []

    def make() -> Iterator[int]:
        for number in range(9):
            if number % 3 == 0:
                ahead.wait_for_use()
                told.append(len(used))
            yield number

    for number in ahead.blocks(make):
        time.sleep(0.005)
        used.append(number)
    assert told == [0, 3, 6]


@pytest.mark.parametrize("is_waiting", [False, True])
def test_nothing_is_left_running_when_nobody_asks_any_more(is_waiting: bool) -> None:
    ahead, closed = ReadAhead[int](), []

    def make() -> Iterator[int]:
        try:
            for number in range(9):
                if is_waiting and number:
                    ahead.wait_for_use()
                yield number
        finally:
            closed.append(True)

    blocks = ahead.blocks(make)
    assert next(iter(blocks)) == 0
    blocks.close()  # type: ignore[attr-defined]
    assert closed == [True]
    assert not is_anything_left()


def test_blocks_that_are_freed_in_the_thread_that_makes_them_do_not_wait_for_themselves() -> (
    None
):
    ahead, taken, blocks = ReadAhead[int](), threading.Event(), list[Iterator[int]]()

    def make() -> Iterator[int]:
        yield 0
        taken.wait(LONG_S)
        blocks.pop().close()  # type: ignore[attr-defined]
        yield 1

    blocks.append(ahead.blocks(make))
    assert next(blocks[0]) == 0
    begun_s = time.monotonic()
    taken.set()
    assert not is_anything_left()
    assert time.monotonic() - begun_s < LONG_S


def tape(folder: Path) -> Path:
    """A tape of 12 s whose Y goes ever faster; X drops out for 4 ms every half second from 3 s on."""
    file = folder / "tape.wav"
    t_s = np.arange(round(12 * MOTION_RATE_HZ)) / MOTION_RATE_HZ
    x_mm, y_mm = 4 * np.sin(t_s) ** 2, 20 * np.clip(t_s / 10, 0, 1) ** 3
    record(
        [Motion(np.column_stack([x_mm, y_mm, 0 * t_s]), MOTION_RATE_HZ)],
        file,
        TapeFormat(checked=True),
    )
    frames, rate_hz = soundfile.read(file, dtype="int16")
    for at_s in np.arange(3.0, 11.0, 0.5):
        frames[round(at_s * rate_hz) :, 1][: round(0.004 * rate_hz)] = 0
    raw = bytearray(file.read_bytes())
    begins = raw.find(b"data") + 8
    raw[begins : begins + frames.nbytes] = frames.tobytes()
    file.write_bytes(raw)
    return file


def played(playback: TapePlayback) -> tuple[np.ndarray, str, dict[tuple[float, str], float]]:
    """Where the machine went, what ended it, and the dropouts that were told of."""
    blocks, fault = [np.zeros((0, 3))], ""
    try:
        for motion in playback:
            blocks.append(motion.positions_mm)
    except Fault as error:
        fault = f"{error} {sorted(vars(error).items())}"
    return np.vstack(blocks), fault, playback.bridged


@pytest.mark.parametrize("is_weak", [False, True])
def test_a_tape_read_ahead_plays_as_one_that_is_not(tmp_path: Path, is_weak: bool) -> None:
    file, told = tape(tmp_path), []
    for ahead in (False, True):
        playback = play(file)
        assert playback.reads_ahead
        playback.reads_ahead = ahead
        # a drive that has lost some of its gain fails where Y is fast, behind some dropouts
        weak = replace(SOUND, gain_share=0.3) if is_weak else SOUND
        playback.conditions = [SOUND, weak, SOUND]
        told.append(played(playback))
    assert (told[0][0] == told[1][0]).all()
    assert told[0][1:] == told[1][1:]
    assert bool(told[0][1]) == is_weak
    assert len(told[0][2]) > 3
    assert not is_anything_left()


@pytest.mark.parametrize("ahead", [False, True])
def test_the_check_signal_of_a_tape_read_ahead_has_a_thread_of_its_own(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, ahead: bool
) -> None:
    threads: dict[str, set[int]] = {}
    heard, fed = CheckReader.heard, Discriminator.feed

    def noted(name: str) -> None:
        threads.setdefault(name, set()).add(threading.get_ident())

    monkeypatch.setattr(CheckReader, "heard", lambda *a: (noted("heard"), heard(*a))[1])
    monkeypatch.setattr(Discriminator, "feed", lambda *a: (noted("fed"), fed(*a))[1])
    playback = play(tape(tmp_path))
    playback.reads_ahead = ahead
    blocks = iter(playback)
    next(blocks), next(blocks)
    blocks.close()  # type: ignore[attr-defined]
    own = threads["heard"] - threads["fed"]
    assert len(own) == ahead
    assert not is_anything_left()
