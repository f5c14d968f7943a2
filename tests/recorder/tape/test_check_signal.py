"""The check signal on the tape: where its power lies, that it adds nothing else, and what it says."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import soundfile

from morfax.motion.motion import Motion
from morfax.player.tape.check_reader import read_ahead, read_check
from morfax.recorder.tape import check_frame, check_signal
from morfax.recorder.tape.carrier import Carrier
from morfax.recorder.tape.check_frame import SENT_BY, SYMBOLS
from morfax.recorder.tape.check_signal import CheckWriter
from morfax.recorder.tape.format import CHECK_SHARE
from morfax.recorder.tape.tape import Tape, TapeFormat, record
from tests.player.worn import program

RATE_HZ = 48000
FRAME_ROWS = 2880  # at 6 kHz


@pytest.fixture(scope="module")
def positions() -> np.ndarray:
    return program(10.0, 60.0)


@pytest.fixture(scope="module")
def tape(tmp_path_factory: pytest.TempPathFactory, positions: np.ndarray) -> Path:
    """A circle at 60 mm/s, bare and with the check signal beside it."""
    folder = tmp_path_factory.mktemp("check")
    record(Motion(positions), folder / "bare.wav", TapeFormat(), sample="float")
    record(Motion(positions), folder / "a.wav", TapeFormat(checked=True), sample="float")
    return folder / "a.wav"


def only_check(tape: Path) -> np.ndarray:
    """What the check signal adds to the bare tape."""
    return np.asarray(
        soundfile.read(tape)[0] - soundfile.read(tape.with_name("bare.wav"))[0], float
    )


def test_its_power_lies_about_a_sixth_of_the_reference(tape: Path) -> None:
    signal = only_check(tape)[:, 1]
    assert np.abs(signal).max() == pytest.approx(0.5 * CHECK_SHARE, rel=0.01)
    power = np.abs(np.fft.rfft(signal * np.hanning(len(signal)))) ** 2
    hz = np.fft.rfftfreq(len(signal), 1 / RATE_HZ)
    total = power.sum()
    assert power[(hz > 750) & (hz < 1250)].sum() / total > 0.999
    # beyond 1.5 kHz, where the player's filter begins to let it pass: 40 dB down and more
    assert power[hz > 1500].sum() / total < 1e-4
    assert power[hz > 3000].sum() / total < 1e-6


def test_tracks_change_over_at_the_same_moments(tape: Path) -> None:
    """At the middle of each symbol the subcarrier has its full amplitude on all tracks."""
    signal = only_check(tape)
    # a quarter of a cycle of the subcarrier behind the middle of a symbol
    at = np.arange(1, 400) * 192 + 12
    full = 0.5 * CHECK_SHARE * np.cos(np.pi * 12 / 192 / 2) ** 2
    assert (np.abs(signal[at]) > 0.9 * full).all()


def test_each_track_says_what_its_axis_does(tape: Path, positions: np.ndarray) -> None:
    with Tape.open(tape) as opened:
        blocks = opened.stored_blocks()
        check = read_check(read_ahead(blocks, opened.format), opened.format)
        assert check is not None
        for block in blocks:
            check.feed(block)
        check.finish()
        reports = check.reports()
    assert check.tracks == [0, 1, 2, 3]
    assert [report.number for report in reports] == list(range(len(reports)))
    still = np.concatenate([np.tile(positions[:1], (6000, 1)), positions])
    still = np.concatenate([still, np.tile(positions[-1:], (6000, 1))])
    cycles = (still - still[0]) * 20
    speed = np.abs(np.diff(cycles, axis=0)) * 6000
    for report in reports:
        first = report.number * FRAME_ROWS
        assert report.row == pytest.approx(first, abs=0.1)  # rows: 17 us
        span = slice(first, first + 2 * FRAME_ROWS)
        for axis, said in enumerate(report.said[1:]):
            assert said is not None
            assert said.cycles == pytest.approx(cycles[first, axis], abs=1 / 16)
            fastest = speed[span, axis].max()
            assert fastest <= said.speed * (1 + 1e-6)
            assert said.speed <= max(1.2 * fastest, 0.6)
        assert np.abs(report.delay_s).max() < 0.5e-6
    ends = [report.said[1].last for report in reports if report.said[1]]
    assert ends[-2:] == [True, True]
    assert not any(ends[:-2])


def test_frames_do_not_depend_on_the_blocks_of_the_motion(
    tmp_path: Path, positions: np.ndarray, tape: Path
) -> None:
    parts = [Motion(part) for part in np.array_split(positions, 37)]
    record(parts, tmp_path / "b.wav", TapeFormat(checked=True), sample="float")
    whole, split = soundfile.read(tape)[0], soundfile.read(tmp_path / "b.wav")[0]
    assert np.abs(whole - split).max() < 1e-6


def test_a_level_without_room_for_it_is_refused() -> None:
    TapeFormat(level=0.83, checked=True)
    with pytest.raises(ValueError, match=r"level is 0\.9; it must be at most 0\.833"):
        TapeFormat(level=0.9, checked=True)


def test_a_tape_shorter_than_a_frame_is_whole(tmp_path: Path) -> None:
    motion = Motion(np.zeros((100, 3)))
    report = record(motion, tmp_path / "a.wav", TapeFormat(dwell_s=0.0, checked=True))
    assert report.frames == 800


def signal_alone(fmt: TapeFormat, sizes: list[int]) -> np.ndarray:
    """The check signal beneath carriers that are silent, of rows that come in blocks of these sizes."""
    carrier = Carrier(replace(fmt.carrier, level=0.0), np.zeros(3))
    writer = CheckWriter(fmt, carrier)
    out = []
    for rows in sizes:
        carrier.feed(np.zeros((rows, 3)))
        out += list(writer.frames())
    return np.concatenate([*out, *writer.rest()])


def test_the_signal_does_not_depend_on_the_blocks_of_rows() -> None:
    fmt = TapeFormat(checked=True)
    out = signal_alone(fmt, [5000, 3000, 0, 7000])
    assert np.array_equal(out, signal_alone(fmt, [15_000]))
    assert len(out) == 15_000 * fmt.samples_per_motion
    assert np.abs(out).max() > 0.9 * CHECK_SHARE * fmt.level


def test_the_subcarrier_of_one_frame_serves_all_where_frames_begin_alike(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    made = []
    fill = check_signal._fill

    def counted(*args: object) -> None:
        made.append(args)
        fill(*args)

    monkeypatch.setattr(check_signal, "_fill", counted)
    signal_alone(TapeFormat(checked=True), [30_000])  # ten check frames
    assert len(made) == 1


@pytest.mark.parametrize("reference_hz", [6000.0, 6001.37])
def test_the_subcarrier_is_in_phase_with_the_reference(reference_hz: float) -> None:
    fmt = TapeFormat(checked=True, reference_hz=reference_hz)
    out = signal_alone(fmt, [20_000])
    theta = np.arange(len(out)) * (reference_hz / RATE_HZ)
    wave = CHECK_SHARE * fmt.level * np.sin(2 * np.pi * theta / 6)
    # at its start a symbol is +1 or -1 whole; in its first twentieth it has gone over by 0.6 % of the two
    whole = theta % 24 < 24 / 20
    off = np.abs(np.abs(out[whole, 1]) - np.abs(wave[whole]))
    assert off.max() <= 2 * 0.0062 * CHECK_SHARE * fmt.level


def test_the_plain_kernel_of_the_subcarrier_is_the_compiled_one() -> None:
    tables = [
        (np.empty((8, 400)), np.empty((8, 400)), np.empty((8, 400), np.int64)) for _ in range(2)
    ]
    for fill, table in zip(
        (check_signal._fill, check_signal._fill.py_func), tables, strict=True
    ):
        fill((-0.01, 3), (0.125, 0.1), *table)
    # the compiler may fuse multiply and add
    for one, other in zip(*tables, strict=True):
        assert np.abs(one - other).max() <= 1e-14


def test_the_plain_kernel_tells_what_the_compiled_one_tells(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    fmt = TapeFormat(checked=True)
    rows = np.cumsum(np.random.default_rng(5).normal(0, 0.01, (9000, 3)), axis=0)
    teller = check_signal._teller(fmt, float(FRAME_ROWS), 12)
    symbols = np.empty((2, SYMBOLS + 1, 4))
    check_signal._tell(rows, 0, 1, True, teller, SENT_BY, symbols[0])
    for name in ("_count", "_gauged", "_widest_changes", "widest_moves", "word_of", "send"):
        monkeypatch.setattr(check_signal, name, getattr(check_signal, name).py_func)
    monkeypatch.setattr(check_frame, "to_code", check_frame.to_code.py_func)
    check_signal._tell.py_func(rows, 0, 1, True, teller, SENT_BY, symbols[1])
    assert np.array_equal(symbols[0], symbols[1])
    said = check_frame.from_bits(symbols[0, :SYMBOLS].T.astype(np.int8))
    assert [frame.track for frame in said if frame is not None] == [0, 1, 2, 3]
    for axis, frame in enumerate(said[1:]):
        assert frame is not None and frame.number == 1 and frame.last
        assert frame.cycles == pytest.approx(rows[FRAME_ROWS, axis], abs=0.5 / 64)


@pytest.mark.parametrize("rows", [0, 1, 12, 13, 14, 500])
@pytest.mark.parametrize("plain", [False, True])
def test_the_gauge_finds_the_largest_of_plain_differences(
    monkeypatch: pytest.MonkeyPatch, rows: int, plain: bool
) -> None:
    places = np.cumsum(np.random.default_rng(rows).normal(0, 0.01, (rows, 3)), axis=0)
    told = np.full((2, 3), 20.0)  # of the rows before
    gauged = check_signal._gauged
    if plain:
        gauged = gauged.py_func
        for name in ("_widest_changes", "widest_moves"):
            monkeypatch.setattr(check_signal, name, getattr(check_signal, name).py_func)
    gauged(places, (6000.0, 12), told[0], told[1])
    speeds = np.diff(places, axis=0) * 6000.0
    changes = np.abs(speeds[12:] - speeds[:-12]) * (6000.0 / 12)
    assert told[0] == pytest.approx(np.abs(speeds).max(axis=0, initial=20.0), rel=1e-12)
    assert told[1] == pytest.approx(changes.max(axis=0, initial=20.0), rel=1e-12)
