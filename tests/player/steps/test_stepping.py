"""The step control: decoder, ring memory, pulses, and motors that lose steps when asked for more than they
can do.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from morfax.motion.motion import join
from morfax.player.steps import motor as motor_module
from morfax.player.steps import stepping
from morfax.player.steps.motor import Motor, MotorCondition, Motors
from morfax.player.steps.ring_memory import (
    DOWN_X,
    DOWN_Y,
    MEMORY_ENTRIES,
    UP_X,
    UP_Y,
    ring_memory,
)
from morfax.player.steps.stepping import (
    decode,
    play_steps,
    pulse_ticks,
    pulses_of,
    tick_table,
)
from morfax.recorder.steps.file import TICKS, StepFormat, StepProgram, write_program
from morfax.recorder.steps.rings import RINGS

INTERVAL_S = 1 / 160
FORMATS = st.builds(
    StepFormat, vectors=st.sampled_from([1, 2]), channels=st.sampled_from([5, 8])
)


@pytest.mark.parametrize("pulses", range(1, TICKS + 1))
def test_pulses_are_spread_evenly_over_the_interval(pulses: int) -> None:
    ticks = np.array(pulse_ticks(pulses))
    gaps = np.diff(np.r_[ticks, ticks[0] + TICKS])
    assert len(ticks) == pulses and ticks[0] >= 0 and ticks[-1] < TICKS
    assert np.ptp(gaps) <= 1  # oscillator ticks
    assert tick_table()[pulses, TICKS] == pulses


def test_no_more_pulses_than_ticks() -> None:
    with pytest.raises(ValueError, match="0 to 64"):
        pulse_ticks(65)


def test_the_ring_memory_has_512_entries_and_answers_for_vectors_only() -> None:
    memory = ring_memory()
    assert len(memory) == MEMORY_ENTRIES == 512
    vectors = {(x + 8, y + 8) for ring in RINGS.values() for x, y in ring}
    answers = {(at >> 5, at >> 1 & 15) for at in np.flatnonzero(memory).tolist()}
    assert answers == vectors and len(vectors) == 148


def test_the_ring_memory_s_next_and_previous_are_those_of_the_patent() -> None:
    """Page 22: counts 13, 5 go to 12, 4 by "next", and to 14, 6 by "previous"."""
    memory = ring_memory()
    address = 13 << 5 | 5 << 1
    assert memory[address | 1] == DOWN_X | DOWN_Y
    assert memory[address] == UP_X | UP_Y


@given(st.binary(max_size=300), FORMATS)
def test_no_tape_of_any_content_asks_for_more_than_the_motor_can_do(
    content: bytes, fmt: StepFormat
) -> None:
    rows = np.frombuffer(content, np.uint8) & (2**fmt.channels - 1)
    counts, _ = decode(StepProgram(fmt, rows))
    assert ((counts >= 1) & (counts <= 15)).all()
    pulses = pulses_of(counts, fmt.rates)
    assert (
        np.abs(np.diff(pulses, axis=0, prepend=np.zeros((1, 3), np.int64))).max(initial=0) <= 1
    )
    motors = Motors(3, fmt.interval_s)
    told, made = motors.run(pulses, tick_table(), 8)
    assert not motors.lost.any() and (told == made).all()


@given(st.binary(max_size=200), FORMATS)
def test_a_file_of_any_rows_plays_without_loss_or_is_refused(
    tmp_path_factory: pytest.TempPathFactory, content: bytes, fmt: StepFormat
) -> None:
    rows = np.frombuffer(content, np.uint8) & (2**fmt.channels - 1)
    file = tmp_path_factory.mktemp("any") / "any.steps"
    write_program(StepProgram(fmt, rows), file)
    try:
        playback = play_steps(file)
    except stepping.ProgramFault as refused:
        assert "ends at speed" in str(refused) or "it states" in str(refused)
        return
    join(playback)
    assert not playback.following_error_mm.any()


def test_a_jump_of_two_loses_steps() -> None:
    motors = Motors(1, INTERVAL_S)
    told, steps = motors.run(np.array([[0], [3], [3], [3], [3], [0]]), tick_table(), 1)
    assert np.diff(steps[:, 0], prepend=0).tolist() == [0, 1, 2, 3, 3, 2]
    assert motors.lost[0] == 12 - 11 and (told - steps).max() == 3


def test_a_stronger_motor_takes_the_same_jump() -> None:
    motors = Motors(1, INTERVAL_S, Motor(3 * 25600))
    motors.run(np.array([[0], [3], [3], [0]]), tick_table(), 1)
    assert not motors.lost.any()
    assert Motor().most(1 / 120) == 1 and Motor().most(1 / 80) == 4


def test_rates_need_not_be_linear(tmp_path: Path) -> None:
    fmt = StepFormat(rates=(1, 3, 5, 7, 8, 9, 10), end_mm=(0.25, 0, 0))
    rows = [0b10001] * 4 + [0b10010] * 4
    write_program(StepProgram(fmt, np.array(rows, np.uint8)), tmp_path / "a.steps")
    with pytest.raises(stepping.ProgramFault, match="ask for changes of 51200"):
        play_steps(tmp_path / "a.steps")
    playback = play_steps(tmp_path / "a.steps", motor=Motor(51200))
    assert playback.pulses[:, 0].tolist() == [1, 3, 5, 7, 5, 3, 1, 0]
    assert fmt.acceleration_steps_s2 == pytest.approx(51200)


@pytest.mark.parametrize("oscillator_hz", [10240, 7680, 5000])
def test_the_oscillator_sets_the_interval(tmp_path: Path, oscillator_hz: float) -> None:
    fmt = StepFormat(oscillator_hz=oscillator_hz, end_mm=(0.04, 0, 0))
    write_program(
        StepProgram(fmt, np.array([0b10001, 0b10001, 0b10010, 0b10010], np.uint8)),
        tmp_path / "a.steps",
    )
    playback = play_steps(tmp_path / "a.steps")
    assert playback.duration_s == pytest.approx(4 * 64 / oscillator_hz)
    motion = join(playback)
    assert motion.times_s[-1] == pytest.approx(playback.duration_s)
    assert motion.positions_mm[-1] == pytest.approx([0.04, 0, 0])
    assert playback.end_error_mm == pytest.approx([0, 0, 0])


def test_the_blocks_of_a_long_program_join_without_a_gap(tmp_path: Path) -> None:
    rows = np.full(9000, 0b10000, np.uint8)
    rows[0], rows[-1] = 0b10001, 0b10010
    fmt = StepFormat(end_mm=(89.99, 0, 0))
    write_program(StepProgram(fmt, rows), tmp_path / "a.steps")
    playback = play_steps(tmp_path / "a.steps")
    blocks = list(playback)
    ends_s = [block.start_s + block.duration_s for block in blocks[:-1]]
    assert ends_s == pytest.approx([block.start_s for block in blocks[1:]])
    assert np.abs(np.diff(join(blocks).positions_mm[:, 0])).max() < 1.01 * fmt.step_mm


def test_motors_of_another_number_are_refused() -> None:
    with pytest.raises(ValueError, match=r"must be \(k, 3\)"):
        Motors(3, INTERVAL_S).run(np.zeros((2, 2), np.int64), tick_table(), 8)


def test_the_kernels_do_as_plain_python_what_they_do_compiled(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    rows = np.random.default_rng(1).integers(0, 256, 500).astype(np.uint8)
    compiled = decode(StepProgram(StepFormat(), rows))
    monkeypatch.setattr(stepping, "_counted", stepping._counted.py_func)
    monkeypatch.setattr(stepping, "_decode", stepping._decode.py_func)
    plain = decode(StepProgram(StepFormat(), rows.astype(np.int64)))
    assert (compiled[0] == plain[0]).all() and (compiled[1] == plain[1]).all()
    pulses = pulses_of(plain[0], (1, 3, 5, 7, 8, 9, 10))
    runs = []
    for run in (motor_module._run, motor_module._run.py_func):
        monkeypatch.setattr(motor_module, "_run", run)
        motors = Motors(3, INTERVAL_S)
        motors.conditions = [
            motor_module.SOUND,
            motor_module.MotorCondition(0.8, 0.1, 3.0),
            motor_module.SOUND,
        ]
        runs.append((*motors.run(pulses, tick_table(), 8), motors.lost))
    assert all((one == other).all() for one, other in zip(*runs, strict=True))


def test_friction_slows_a_start_and_helps_a_stop() -> None:
    """Half the torque: up by 5 of 10 steps from interval to interval, and down by 15."""
    motors = Motors(1, INTERVAL_S, Motor(acceleration_steps_s2=10 / INTERVAL_S**2))
    motors.conditions = [MotorCondition(friction_share=0.5)]
    motors.run(np.full((10, 1), 20), tick_table(), 1)
    started = int(motors.lost[0])
    assert started == 15 + 10 + 5  # at 5, 10, 15 and then 20 steps to an interval
    motors.run(np.zeros((10, 1), np.int64), tick_table(), 1)
    assert motors.lost[0] - started == -5  # at 5, and it stands
