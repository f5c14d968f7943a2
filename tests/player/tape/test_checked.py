"""Checked tapes: what a bare tape would play wrongly is right, or a fault that says what is wrong."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from io import BytesIO
from pathlib import Path
from unittest import mock

import numpy as np
import pytest
import soundfile
from scipy.signal import lfilter

from morfax.motion.faults import Fault, LockFault, TapeFault
from morfax.motion.motion import Motion, join
from morfax.player.tape.mend import mend
from morfax.player.tape.playback import TapePlayback, play, play_pipe
from morfax.recorder.tape import check_signal
from morfax.recorder.tape.tape import Tape, TapeFormat, record
from morfax.recorder.wear.settings import Wear
from morfax.recorder.wear.transport import age
from tests.player.attacks.bench import to_bits_of_version_1
from tests.player.worn import program

RATE_HZ = 48000
UM = 1e-3  # mm
RIGHT_UM = 1.0  # of the path, with any delay up to 200 us
AT = 76923  # the frame at which samples are lost: at 1.6 s, where X and Y run at 60 mm/s
REFERENCE, X, Y, Z = range(4)
ALL = (REFERENCE, X, Y, Z)
Frames = np.ndarray
Change = Callable[[Frames], Frames]


class Bench:
    """A circle at 60 mm/s on a tape with a check signal, and what of it is played after a change."""

    def __init__(self, folder: Path) -> None:
        positions = program(10.0, 60.0)
        positions[:, 2] = 2 - 1.5 * positions[:, 1] / 10.0
        self.tape, self.changed = folder / "fast.wav", folder / "changed.wav"
        record(Motion(positions), self.tape)
        self.clean = join(play(self.tape)).positions_mm
        with soundfile.SoundFile(self.tape) as sound:
            self.frames, self.text = sound.read(dtype="float32"), sound.comment

    def written(self, change: Change) -> Path:
        """The tape with its frames changed, its text as it was."""
        with soundfile.SoundFile(self.changed, "w", RATE_HZ, 4, "PCM_16") as out:
            out.comment = self.text
            out.write(np.clip(change(self.frames.copy()), -1, 1))
        return self.changed

    def played(self, change: Change) -> tuple[np.ndarray, Fault | None]:
        """What was played, and the fault that ended it."""
        return run(play(self.written(change)))

    def error_um(self, went: np.ndarray) -> float:
        """The largest error at the same moments, um."""
        return float(np.abs(went - self.clean[: len(went)]).max(initial=0.0) / UM)


def run(playback: TapePlayback) -> tuple[np.ndarray, Fault | None]:
    """Play to the end or to a fault."""
    blocks = []
    try:
        for block in playback:
            blocks.append(block)
    except Fault as fault:
        return join(blocks).positions_mm if blocks else np.zeros((0, 3)), fault
    return join(blocks).positions_mm, None


@pytest.fixture(scope="module")
def bench(tmp_path_factory: pytest.TempPathFactory) -> Bench:
    return Bench(tmp_path_factory.mktemp("checked"))


def delayed(track: int, delay_s: Callable[[np.ndarray], np.ndarray]) -> Change:
    """Play one track later by a delay that may change, to 1e-4 of full scale (24 samples of a sinc)."""

    def change(frames: Frames) -> Frames:
        numbers = np.arange(len(frames))
        places = numbers - delay_s(numbers / RATE_HZ) * RATE_HZ
        whole = np.floor(places).astype(int)
        late = np.zeros(len(frames))
        for k in range(-23, 25):
            apart = places - whole - k
            window = np.cos(np.pi * np.clip(apart / 24, -1, 1) / 2) ** 2
            at = np.clip(whole + k, 0, len(frames) - 1)
            late += frames[at, track] * np.sinc(apart) * window
        frames[:, track] = late
        return frames

    return change


def lost(tracks: tuple[int, ...], count: int) -> Change:
    """Leave out some samples of some tracks."""

    def change(frames: Frames) -> Frames:
        if tracks == ALL:
            return np.delete(frames, slice(AT, AT + count), axis=0)
        for track in tracks:
            rest = np.delete(frames[:, track], slice(AT, AT + count))
            # what comes last is standstill, a whole number of cycles of 8 samples
            more = frames[len(frames) - 8000 : len(frames) - 8000 + count, track]
            frames[:, track] = np.concatenate([rest, more])
        return frames

    return change


def repeated(tracks: tuple[int, ...], count: int) -> Change:
    """Play some samples of some tracks twice."""

    def change(frames: Frames) -> Frames:
        for track in tracks:
            twice = np.insert(frames[:, track], AT, frames[AT - count : AT, track])
            frames[:, track] = twice[: len(frames)]
        return frames

    return change


def test_the_check_signal_does_not_move_the_screws(bench: Bench, tmp_path: Path) -> None:
    positions = program(10.0, 60.0)
    positions[:, 2] = 2 - 1.5 * positions[:, 1] / 10.0
    record(Motion(positions), tmp_path / "bare.wav", TapeFormat())
    bare = play(tmp_path / "bare.wav")
    apart = (join(bare).positions_mm - bench.clean) * 20
    # 2e-5 cycle is asked; the filter has it 96 dB below the carrier
    assert np.sqrt((apart**2).mean(axis=0)).max() < 1e-5
    assert len(bare.notes) == 1
    checked = play(bench.tape)
    join(checked)
    assert checked.notes == ()


@pytest.mark.parametrize("delay_us", [-200, -20, 3, 30, 100, 200])
def test_a_late_track_is_put_right(bench: Bench, delay_us: float) -> None:
    went, fault = bench.played(delayed(X, lambda t: np.full_like(t, delay_us * 1e-6)))
    assert fault is None
    assert bench.error_um(went) < RIGHT_UM


@pytest.mark.parametrize("delay_us", [-195, 195])
def test_a_late_reference_takes_the_clock_along(bench: Bench, delay_us: float) -> None:
    """Its frames begin as late: at 60 mm/s a count told at another moment is 0.23 cycle off."""
    went, fault = bench.played(delayed(REFERENCE, lambda t: np.full_like(t, delay_us * 1e-6)))
    assert fault is None
    rows = np.arange(len(went))
    late_rows = delay_us * 1e-6 * 6000
    at = np.column_stack([np.interp(rows + late_rows, rows, column) for column in went.T])
    assert bench.error_um(at) < RIGHT_UM


@pytest.mark.parametrize("track", [REFERENCE, Y])
@pytest.mark.parametrize("drift_us", [-45, 45])
def test_a_delay_that_drifts_is_put_right(bench: Bench, track: int, drift_us: float) -> None:
    went, fault = bench.played(delayed(track, lambda t: drift_us * 1e-6 * t))
    assert fault is None
    # a reference that drifts takes the machine's clock along: 3 us at 60 mm/s are 0.2 um
    went = went if track else along(went, bench.clean, drift_us * 1e-6)
    assert bench.error_um(went) < RIGHT_UM


def along(went: np.ndarray, wanted: np.ndarray, drift: float) -> np.ndarray:
    """What was played by a clock that drifts, at the moments of the right one."""
    rows = np.arange(len(went))
    return np.column_stack([np.interp(rows * (1 + drift), rows, column) for column in went.T])


@pytest.mark.parametrize("delay_us", [230, 400, 500, 740, -260])
def test_a_track_later_than_200_us_is_a_fault(bench: Bench, delay_us: float) -> None:
    went, fault = bench.played(delayed(X, lambda t: np.full_like(t, delay_us * 1e-6)))
    assert isinstance(fault, TapeFault)
    assert "us off the reference" in str(fault)
    assert bench.error_um(went) < RIGHT_UM


@pytest.mark.parametrize("count", [1, 2, 3, 8, 480, 960])
@pytest.mark.parametrize("change", [lost, repeated])
@pytest.mark.parametrize("tracks", [(REFERENCE,), (X,), (Z,)])
def test_samples_lost_or_repeated_on_one_track_are_a_fault(
    bench: Bench, tracks: tuple[int, ...], change: Callable[..., Change], count: int
) -> None:
    went, fault = bench.played(change(tracks, count))
    assert fault is not None
    # nothing behind the place is given out, and what was a second before it is
    assert AT / RATE_HZ - 1 < len(went) / 6000 < AT / RATE_HZ
    assert bench.error_um(went) < RIGHT_UM


@pytest.mark.parametrize("count", [8, 48, 192, 480, 960, 23040])
@pytest.mark.parametrize("change", [lost, repeated])
def test_buffers_lost_or_repeated_on_all_tracks_are_a_fault(
    bench: Bench, change: Callable[..., Change], count: int
) -> None:
    went, fault = bench.played(change(ALL, count))
    assert fault is not None
    assert len(went) / 6000 < AT / RATE_HZ
    assert bench.error_um(went) < RIGHT_UM


# four are half a cycle of the reference, which may be counted either way; one of them is a fault
@pytest.mark.parametrize("count", [1, 2, 3, 4])
def test_a_few_samples_lost_on_all_tracks_only_move_the_time(bench: Bench, count: int) -> None:
    went, fault = bench.played(lost(ALL, count))
    if fault is not None:
        assert count == 4
        return
    on = bench.clean[: len(went)]
    # the machine jumps 60 mm/s · 21 us · count along the path, and not off it
    off = np.hypot(went[:, 0], went[:, 1] - 10) - np.hypot(on[:, 0], on[:, 1] - 10)
    assert np.abs(off).max() < RIGHT_UM * UM
    assert np.abs(went[-1] - on[-1]).max() < RIGHT_UM * UM


@pytest.mark.parametrize(
    ("tracks", "told"),
    [
        ([0, 0, 2, 3], "track 2 says that it is the reference, and should be the X"),
        ([0, 1, 1, 3], "track 3 says that it is the X, and should be the Y"),
    ],
)
def test_a_copied_track_is_a_fault_before_anything_moves(
    bench: Bench, tracks: list[int], told: str
) -> None:
    went, fault = bench.played(lambda frames: frames[:, tracks])
    assert not len(went)
    assert told in str(fault)


def test_tracks_in_another_order_are_put_in_order_or_told(bench: Bench) -> None:
    went, fault = bench.played(lambda frames: frames[:, [0, 2, 1, 3]])
    assert fault is None
    assert bench.error_um(went) < 1e-6
    pipe = BytesIO(bench.changed.read_bytes())
    with pytest.raises(TapeFault, match=r"track 2 says that it is the Y.*--tracks"):
        join(play_pipe(pipe))


def test_a_tape_that_runs_backwards_is_a_fault_at_once(bench: Bench) -> None:
    with pytest.raises(TapeFault, match="the tape runs backwards: its check signal"):
        play(bench.written(lambda frames: frames[::-1]))


@pytest.mark.parametrize("tracks", [(X,), (REFERENCE,), ALL])
def test_polarity_does_not_matter(bench: Bench, tracks: tuple[int, ...]) -> None:
    signs = np.array([-1.0 if track in tracks else 1.0 for track in ALL], np.float32)
    went, fault = bench.played(lambda frames: frames * signs)
    assert fault is None
    assert bench.error_um(went) < 0.01  # um: the rounding of 16 bit


def test_a_start_that_is_cut_is_right_and_an_end_that_is_cut_is_a_fault(bench: Bench) -> None:
    went, fault = bench.played(lambda frames: frames[RATE_HZ // 2 :])
    assert fault is None
    assert np.abs(went - bench.clean[3000:]).max() < RIGHT_UM * UM
    went, fault = bench.played(lambda frames: frames[: -int(1.5 * RATE_HZ)])
    assert "the tape's end is missing" in str(fault)
    assert bench.error_um(went) < RIGHT_UM


def test_a_count_that_slips_in_a_dropout_is_a_fault(bench: Bench) -> None:
    """A splice of a whole cycle of the carrier of X, at a place where its level hides it."""

    def slipped(frames: Frames) -> Frames:
        carrier = np.exp(2j * np.pi * np.linspace(0, 1, 960))  # a cycle more in 20 ms
        from scipy.signal import butter, hilbert, sosfiltfilt

        # the check signal beneath stays as it is, or it could not be read
        low = sosfiltfilt(butter(6, 2500, fs=RATE_HZ, output="sos"), frames[:, X])
        analytic = hilbert(frames[:, X] - low)
        frames[AT : AT + 960, X] = low[AT : AT + 960] + (analytic[AT : AT + 960] * carrier).real
        return frames

    went, fault = bench.played(slipped)
    assert isinstance(fault, LockFault)
    assert fault.axis == "x"
    assert abs(fault.error_cycles) == pytest.approx(1, abs=0.1)
    assert bench.error_um(went) < RIGHT_UM


@pytest.mark.parametrize("noise_db", [40, 26])
def test_noise_moves_the_screws_no_more_than_without(bench: Bench, noise_db: float) -> None:
    random = np.random.default_rng(3)
    sigma = 0.5 / np.sqrt(2) * 10 ** (-noise_db / 20)
    went, fault = bench.played(
        lambda frames: frames + random.normal(0, sigma, frames.shape).astype(np.float32)
    )
    assert fault is None
    rms = np.sqrt((((went - bench.clean) * 20) ** 2).mean(axis=0))
    assert rms.max() < {40: 1e-3, 26: 5e-3}[noise_db]  # cycles, as asked


@pytest.mark.parametrize("kind", ["speed", "flutter", "level", "hum", "rate", "cassette"])
def test_what_a_recorder_does_leaves_it_readable(
    bench: Bench, tmp_path: Path, kind: str
) -> None:
    wear = {
        "speed": Wear(speed=0.05),
        "flutter": Wear(wow=2e-3, flutter=2e-3, scrape=1e-3),
        "level": Wear(level_db=-20, uneven_db=0.7),
        "hum": Wear(hum_db=20, dc=0.02, third=0.03),
        "rate": Wear(stamped_hz=44100),
        "cassette": Wear(noise_db=46, crosstalk_db=40, bandwidth_hz=12_500, skew_s=1.2e-5),
    }[kind]
    age(bench.tape, tmp_path / "worn.wav", wear, seed=1)
    playback = play(tmp_path / "worn.wav")
    went, fault = run(playback)
    assert fault is None
    assert playback.reader.is_checked
    assert np.abs(went[-1] - bench.clean[-1]).max() < RIGHT_UM * UM


@pytest.mark.parametrize("pickup", ["photocell", "coil", "hall", "scale"])
def test_every_pick_up_carries_it(bench: Bench, tmp_path: Path, pickup: str) -> None:
    from morfax.recorder.tape.pickups import PICK_UPS

    own = PICK_UPS[pickup].cycles_per_mm
    positions = program(5.0, 20.0)
    record(
        Motion(positions),
        tmp_path / "a.wav",
        TapeFormat(pickup=pickup, cycles_per_mm=own, checked=True),
    )
    playback = play(tmp_path / "a.wav")
    went, fault = run(playback)
    assert fault is None
    assert playback.reader.is_checked
    assert (
        np.abs(went[6000:-6000] - positions[: len(went) - 12000]).max() < 0.01
    )  # mm: following


def test_further_axes_and_other_rates_carry_it(tmp_path: Path) -> None:
    for axes, rate_hz in ((("x", "y"), 44100), (("x", "y", "z", "u", "v"), 96000)):
        fmt = TapeFormat(
            axes=axes, sample_rate_hz=rate_hz, samples_per_motion=rate_hz // 6000, checked=True
        )
        smooth = (1 - np.cos(np.linspace(0, np.pi, 9000))) / 2
        way = 5.0 * (1 + np.arange(len(axes)))
        stream = Motion(np.outer(smooth, way), fmt.motion_rate_hz, 0.0, axes)
        record(stream, tmp_path / "a.wav", fmt)
        playback = play(tmp_path / "a.wav")
        ended = join(playback).positions_mm[-1]
        assert playback.reader.is_checked
        assert ended[: len(axes) if len(axes) > 2 else 2] == pytest.approx(way, abs=1e-3)


def test_a_mended_tape_is_checked_again(bench: Bench, tmp_path: Path) -> None:
    def holed(frames: Frames) -> Frames:
        frames[AT : AT + 9600, X] *= 0.01  # 0.2 s, which no bound makes known
        return frames

    mended = mend(bench.written(holed), tmp_path / "mended.wav")
    assert [one.axis for one in mended.mends] == ["x"]
    playback = play(tmp_path / "mended.wav")
    ended = join(playback).positions_mm[-1]
    assert playback.reader.is_checked
    assert np.abs(ended - bench.clean[-1]).max() < RIGHT_UM * UM


def test_it_goes_on_from_a_place(bench: Bench) -> None:
    row = 7980  # 30 ms after the start, at 15 mm/s
    resumed = join(play(bench.tape, resume_at_s=row / 6000, start_mm=tuple(bench.clean[row])))
    assert np.abs(resumed.positions_mm[600:] - bench.clean[row + 600 :]).max() < 2 * UM


def test_a_reference_too_low_has_no_check_signal(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"at least 5000 Hz for a check signal.*--plain"):
        TapeFormat(reference_hz=3000.0, checked=True)
    record(Motion(program(3.0)), tmp_path / "a.wav", TapeFormat(reference_hz=3000.0))
    playback = play(tmp_path / "a.wav")
    join(playback)
    assert len(playback.notes) == 1


@pytest.mark.parametrize("track", [REFERENCE, X])
def test_a_delay_that_begins_to_drift_under_way_is_put_right(bench: Bench, track: int) -> None:
    """50 us/s from 2.2 s on; a mean over seven delays alone rounded the bend off: 2.2 um."""

    bend = delayed(track, lambda t: 50e-6 * np.clip(t - 2.2, 0, None))
    went, fault = bench.played(bend)
    assert fault is None
    if track == REFERENCE:  # it takes the machine's clock along
        rows = np.arange(len(went))
        by = rows + 50e-6 * np.clip(rows - 2.2 * 6000, 0, None)
        went = np.column_stack([np.interp(by, rows, column) for column in went.T])
    assert bench.error_um(went) < RIGHT_UM


@pytest.mark.parametrize("corner", [-0.8, -0.6])
def test_a_carrier_that_a_filter_turns_on_is_a_fault(bench: Bench, corner: float) -> None:
    """An all-pass on X turns its carrier by up to 9 um, at any level; its check signal is late by less."""

    def turned(frames: Frames) -> Frames:
        frames[:, X] = lfilter([corner, 1], [1, corner], frames[:, X])
        return frames

    went, fault = bench.played(turned)
    assert isinstance(fault, LockFault)
    assert fault.axis == "x" and fault.error_cycles is not None
    assert 0.048 < abs(fault.error_cycles) < 0.25
    assert "as a filter or an echo does" in str(fault)
    assert bench.error_um(went) < 2.5  # 0.05 cycle


def test_an_echo_that_shows_between_the_starts_of_frames_is_a_fault(bench: Bench) -> None:
    """Once round takes two frames: at each start Y is nearly right, and 0.17 cycle off between two."""

    def echoed(frames: Frames) -> Frames:
        late, tracks = 14, [2, 3]  # Y and Z
        frames[late:, tracks] += 0.37 * frames[:-late, tracks].copy()
        return frames * 0.6

    went, fault = bench.played(echoed)
    assert isinstance(fault, LockFault)
    assert fault.axis == "y"
    assert bench.error_um(went) < 2.5  # 0.05 cycle


def test_counts_that_begin_again_lead_no_axis_astray(tmp_path: Path) -> None:
    """X goes 0.45 m at up to 84 mm/s; its count begins again at 0.41 m."""
    time_s = np.arange(round(9.2 * 6000)) / 6000
    way = np.clip((time_s - 0.4) / 8, 0, 1)
    positions = np.zeros((len(time_s), 3))
    positions[:, 0] = 450 * way**2 * (3 - 2 * way)
    record(Motion(positions), tmp_path / "long.wav")
    went, fault = run(play(tmp_path / "long.wav"))
    assert fault is None
    assert went[-1] == pytest.approx([450, 0, 0], abs=0.1 * UM)


def test_a_tape_of_version_1_plays(tmp_path: Path, bench: Bench) -> None:
    """Its counts are sixteenths of a cycle."""
    with mock.patch.object(check_signal, "to_bits", to_bits_of_version_1):
        earlier = Bench(tmp_path)
    assert not np.array_equal(earlier.frames, bench.frames)
    assert np.abs(earlier.clean - bench.clean).max() < 0.01 * UM
    playback = play(earlier.tape)
    join(playback)
    assert playback.notes == ()  # a tape whose frames are not read is a bare one, and told so


def test_the_text_says_nothing_of_it(bench: Bench) -> None:
    with Tape.open(bench.tape) as opened:
        assert "check" not in opened.text
        assert opened.format.version == 1
        assert replace(opened.format, checked=True) == opened.format


@pytest.mark.parametrize("frames", [1, 2, 3, 50])
@pytest.mark.parametrize("value", [0.0, np.nan, np.inf])
def test_a_tape_of_a_moment_is_a_fault(
    bench: Bench, tmp_path: Path, frames: int, value: float
) -> None:
    with soundfile.SoundFile(tmp_path / "a.wav", "w", RATE_HZ, 4, "FLOAT") as out:
        out.comment = bench.text
        out.write(np.where(np.arange(frames)[:, None] == 0, value, bench.frames[:frames]))
    with pytest.raises(TapeFault):
        join(play(tmp_path / "a.wav"))


@pytest.mark.parametrize("track", [REFERENCE, X])
@pytest.mark.parametrize("at", [100, AT])
def test_a_sample_that_is_no_number_is_ridden_over_or_a_fault(
    bench: Bench, tmp_path: Path, track: int, at: int
) -> None:
    frames = bench.frames.copy()
    frames[at, track] = np.nan
    with soundfile.SoundFile(tmp_path / "a.wav", "w", RATE_HZ, 4, "FLOAT") as out:
        out.comment = bench.text
        out.write(frames)
    went, _ = run(play(tmp_path / "a.wav"))
    assert bench.error_um(went) < RIGHT_UM


@pytest.mark.parametrize("length_s", [0.05, 0.3, 0.6])
def test_a_carrier_without_its_check_signal_is_a_fault(bench: Bench, length_s: float) -> None:
    """However long: a dropout takes the carrier too, another signal does not."""

    def replaced(frames: Frames) -> Frames:
        from scipy.signal import butter, sosfiltfilt

        low = sosfiltfilt(butter(6, 2500, fs=RATE_HZ, output="sos"), frames[:, X])
        end = AT + round(length_s * RATE_HZ)
        frames[AT:end, X] -= low[AT:end]
        return frames

    _, fault = bench.played(replaced)
    assert isinstance(fault, TapeFault)
    assert "check signal" in str(fault)
    assert fault.time_s == pytest.approx(AT / RATE_HZ, abs=0.01)
