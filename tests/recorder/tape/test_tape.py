"""A tape written and read gives the motion back; what cannot be a tape is refused and leaves no file."""

import os
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
import soundfile
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from morfax.motion.faults import FileFault, MotionFault, TapeFault
from morfax.motion.motion import Motion
from morfax.motion.motion import Path as ThinnedPath
from morfax.recorder.sound import riff
from morfax.recorder.tape.tape import Tape, TapeFormat, record

RATE_HZ = 6000
# a step of 16 bit at half level is 1/16384 of the carrier; half of it turns a track by 5e-6 cycle, two tracks
# by 1e-5, and the test's own transform, which also takes the noise from all other frequencies, by as much
# again
QUANTISED_CYCLES = 2e-5


def circle(turns: float = 0.2, z_mm: float = -2.0, blocks: int = 1) -> list[Motion]:
    """Part of a circle of 10 mm radius at 10 mm/s that starts and ends gently."""
    samples = round(2 * np.pi * turns * RATE_HZ)
    share = np.linspace(0, 1, samples)
    angle = 2 * np.pi * turns * (10 * share**3 - 15 * share**4 + 6 * share**5)
    positions = np.column_stack(
        [40 + 10 * np.cos(angle), 20 + 10 * np.sin(angle), np.full(samples, z_mm)]
    )
    return [Motion(part, RATE_HZ) for part in np.array_split(positions, blocks)]


def read_frames(file: Path) -> np.ndarray:
    with Tape.open(file) as tape:
        return np.vstack(list(tape.blocks()))


def displacement_cycles(frames: np.ndarray, samples_per_motion: int = 8) -> np.ndarray:
    """Phase of each track against the reference at the motion rate, cycles: another way than the player's."""
    from scipy.signal import hilbert

    analytic = hilbert(frames.astype(float), axis=0)
    turned = np.unwrap(np.angle(analytic[:, 1:] * analytic[:, :1].conj()), axis=0) / (2 * np.pi)
    return turned[::samples_per_motion]


@pytest.mark.parametrize("name", ["a.wav", "a.WAV", "a.rf64", "a.flac"])
def test_the_motion_comes_back_between_two_standstills(tmp_path: Path, name: str) -> None:
    motion = circle()[0].positions_mm
    recording = record([Motion(motion)], tmp_path / name, TapeFormat())
    cycles = displacement_cycles(read_frames(tmp_path / name))
    assert len(cycles) == len(motion) + 2 * RATE_HZ
    wanted = np.vstack(
        [np.tile(motion[0], (RATE_HZ, 1)), motion, np.tile(motion[-1], (RATE_HZ, 1))]
    )
    error = (cycles - 20 * (wanted - motion[0]))[
        1000:-1000
    ]  # the transform rings at the tape's two ends
    assert np.abs(error).max() < QUANTISED_CYCLES
    assert recording.frames == 8 * len(cycles)
    assert recording.duration_s == pytest.approx(len(motion) / RATE_HZ + 2.0)


@settings(max_examples=15, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    st.floats(500, 15_000),
    st.floats(1, 15),
    st.sampled_from([44_100, 48_000, 96_000]),
    st.integers(4, 12),
    st.floats(0.1, 1.0),
    st.integers(0, 1000),
)
def test_any_format_carries_the_motion(
    tmp_path: Path,
    reference_hz: float,
    cycles: float,
    rate_hz: int,
    per_motion: int,
    level: float,
    seed: int,
) -> None:
    fmt = TapeFormat(
        1,
        rate_hz,
        reference_hz,
        cycles,
        ("x", "y"),
        dwell_s=0.1,
        level=level,
        samples_per_motion=per_motion,
    )
    random, samples = np.random.default_rng(seed), round(0.5 * fmt.motion_rate_hz)
    bend = np.sin(np.pi * np.arange(samples) / samples) ** 2
    positions = (
        random.uniform(-100, 100, 2)
        + bend[:, None] * random.uniform(-0.05, 0.05, 2) * fmt.largest_speed_mm_s
    )
    record([Motion(positions, fmt.motion_rate_hz)], tmp_path / "a.wav", fmt, sample="float")
    turned = displacement_cycles(read_frames(tmp_path / "a.wav"), per_motion)
    dwell = round(0.1 * fmt.motion_rate_hz)
    error = turned[dwell:-dwell] - cycles * (positions - positions[0])
    # the transform's ringing on a tape of under a second, not the tape
    assert np.abs(error).max() < 2e-3


def test_blocks_do_not_show(tmp_path: Path) -> None:
    record(circle(blocks=1), tmp_path / "one.wav")
    record(circle(blocks=7), tmp_path / "many.wav")
    assert (tmp_path / "one.wav").read_bytes() == (tmp_path / "many.wav").read_bytes()


def test_a_path_is_recorded_as_it_is(tmp_path: Path) -> None:
    path = ThinnedPath(np.array([0.0, 0.5]), np.array([[0.0, 0.0, 2.0], [5.0, 0.0, 2.0]]))
    done: list[tuple[float, float | None]] = []
    recording = record(
        path,
        tmp_path / "a.wav",
        progress=lambda done_s, total_s: done.append((done_s, total_s)),
    )
    assert recording.format.end_mm == (5.0, 0.0, 2.0)
    assert recording.largest_speed_mm_s == pytest.approx((10.0, 0.0, 0.0), abs=1e-9)
    assert done[-1] == (pytest.approx(0.5, abs=1e-3), 0.5)


@pytest.mark.parametrize("name", ["a.wav", "a.rf64", "a.flac"])
def test_the_text_chunk_says_the_format_with_start_and_end(tmp_path: Path, name: str) -> None:
    motion = circle()[0].positions_mm
    recording = record(circle(), tmp_path / name, TapeFormat(level=0.25))
    with Tape.open(tmp_path / name) as tape:
        assert tape.format == recording.format
        assert tape.format.level == 0.25
        assert tape.format.start_mm == pytest.approx(motion[0], abs=1e-6)
        assert tape.format.end_mm == pytest.approx(motion[-1], abs=1e-6)
        assert tape.frames == recording.frames
        assert tape.text.startswith('{"version": 1')


@pytest.mark.parametrize(
    ("name", "sample", "kinds"),
    [
        ("a.wav", "16", ("WAV", "PCM_16")),
        ("a.wav", "24", ("WAV", "PCM_24")),
        ("a.wav", "32", ("WAV", "PCM_32")),
        ("a.wav", "float", ("WAV", "FLOAT")),
        ("a.rf64", "16", ("RF64", "PCM_16")),
        ("a.flac", "24", ("FLAC", "PCM_24")),
    ],
)
def test_kinds_of_file_and_sample(
    tmp_path: Path, name: str, sample: str, kinds: tuple[str, str]
) -> None:
    record(circle(), tmp_path / name, TapeFormat(), sample=sample)
    with Tape.open(tmp_path / name) as tape:
        assert (tape.container, tape.sample) == kinds
        peak = max(float(np.abs(block).max()) for block in tape.blocks())
    assert peak == pytest.approx(0.5, abs=1 / 32768)


def test_a_wav_too_large_for_its_header_is_an_rf64(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # stands for 4 GiB, where soundfile's own WAV loses the rest without an error
    monkeypatch.setattr(riff, "LARGEST_RIFF_BYTES", 500_000)
    record(circle(), tmp_path / "a.wav")
    assert soundfile.info(tmp_path / "a.wav").format == "RF64"
    frames = read_frames(tmp_path / "a.wav")
    monkeypatch.undo()
    record(circle(), tmp_path / "a.wav")
    assert soundfile.info(tmp_path / "a.wav").format == "WAV"
    assert np.array_equal(read_frames(tmp_path / "a.wav"), frames)


@pytest.mark.parametrize(
    ("motion", "fault"),
    [
        ([], "motion is empty"),
        ([Motion(np.zeros((0, 3)))], "motion is empty"),
        (
            [Motion(np.zeros((9, 3)), 5000.0)],
            r"runs at 5000 Hz; a tape of 48000 Hz takes 6000 Hz",
        ),
        ([Motion(np.zeros((9, 2)))], "has 2 axes; this tape takes 3: x, y, z"),
        ([Motion(np.full((9, 3), np.nan))], r"axis x is at nan mm at 0.0000 s"),
    ],
)
def test_what_no_tape_can_take_leaves_nothing(
    tmp_path: Path, motion: list[Motion], fault: str
) -> None:
    with pytest.raises(MotionFault, match=fault):
        record(motion, tmp_path / "a.wav")
    assert list(tmp_path.iterdir()) == []


def test_too_fast_is_refused_with_axis_time_and_speed(tmp_path: Path) -> None:
    positions = np.zeros((12_000, 3))
    positions[9000:, 1] = -(100.5 / RATE_HZ) * np.arange(
        3000
    )  # from 1.5 s on, over a block's end
    with pytest.raises(
        MotionFault,
        match=r"axis y moves at 100.5 mm/s at 1.5002 s; .* at most 100 mm/s \(2000 Hz",
    ) as caught:
        record([Motion(part) for part in np.array_split(positions, 5)], tmp_path / "a.wav")
    assert caught.value.axis == "y"
    assert caught.value.time_s == pytest.approx(1.5, abs=1e-3)
    assert caught.value.speed_mm_s == pytest.approx(-100.5)
    assert list(tmp_path.iterdir()) == []


def test_the_largest_speed_itself_is_taken(tmp_path: Path) -> None:
    positions = np.outer(np.arange(3000) * (100.0 / RATE_HZ), [1, -1, 0])
    recording = record([Motion(positions)], tmp_path / "a.wav")
    assert recording.largest_speed_mm_s == pytest.approx((100.0, 100.0, 0.0))


@pytest.mark.parametrize("error", [KeyboardInterrupt, RuntimeError])
def test_a_broken_run_leaves_the_tape_before_it(
    tmp_path: Path, error: type[BaseException]
) -> None:
    def breaking() -> Iterator[Motion]:
        yield from circle(blocks=4)[:2]
        raise error

    (tmp_path / "a.wav").write_bytes(b"before")
    with pytest.raises(error):
        record(breaking(), tmp_path / "a.wav")
    assert [file.name for file in tmp_path.iterdir()] == ["a.wav"]
    assert (tmp_path / "a.wav").read_bytes() == b"before"


@pytest.mark.skipif(os.name != "posix", reason="needs a limit on the size of files")
@pytest.mark.parametrize("name", ["a.wav", "a.rf64", "a.flac"])
def test_a_full_disk_is_a_fault_and_leaves_nothing(tmp_path: Path, name: str) -> None:
    import resource

    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    # the disk takes 20 kB, as a full one would
    resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, before[1]))
    try:
        with pytest.raises(FileFault, match="no half file is left"):
            record(circle(), tmp_path / name)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    assert list(tmp_path.iterdir()) == []


def test_names_and_samples_that_cannot_be(tmp_path: Path) -> None:
    with pytest.raises(FileFault, match=r"ends in .wav, .rf64, .flac"):
        record(circle(), tmp_path / "a.mp3")
    with pytest.raises(TapeFault, match="FLAC has no samples of float"):
        record(circle(), tmp_path / "a.flac", sample="float")
    with pytest.raises(ValueError, match="must be one of 16, 24, 32, float"):
        record(circle(), tmp_path / "a.wav", sample="8")
    with pytest.raises(FileFault, match="does not exist"):
        record(circle(), tmp_path / "none" / "a.wav")


def test_what_is_given_by_hand_goes_before_the_text(tmp_path: Path) -> None:
    record(circle(), tmp_path / "a.wav")
    with Tape.open(tmp_path / "a.wav", reference_hz=3000, start_mm=(0, 0)) as tape:
        assert tape.format.reference_hz == 3000
        assert tape.format.cycles_per_mm == 20
        assert tape.format.start_mm == (0.0, 0.0, -2.0)
        end = circle()[0].positions_mm[-1] - [50, 20, 0]  # moved with the start
        assert tape.format.end_mm == pytest.approx(end, abs=1e-6)
    with Tape.open(tmp_path / "a.wav", cycles_per_mm=10) as tape:
        assert tape.format.end_mm is None  # twice the travel ends elsewhere
    with pytest.raises(ValueError, match="4 places; the tape has 3 axes"):
        Tape.open(tmp_path / "a.wav", start_mm=(0, 0, 0, 0))
    with pytest.raises(TapeFault, match="cannot be played so: reference_hz is 20000"):
        Tape.open(tmp_path / "a.wav", reference_hz=20_000)


def test_a_tape_without_text_needs_two_figures(tmp_path: Path) -> None:
    soundfile.write(tmp_path / "a.wav", np.zeros((100, 5)), 44_100)
    with pytest.raises(TapeFault, match="give --reference-frequency 6kHz --cycles-per-mm 20"):
        Tape.open(tmp_path / "a.wav")
    with pytest.raises(TapeFault, match="give --cycles-per-mm 20"):
        Tape.open(tmp_path / "a.wav", reference_hz=6000)
    with Tape.open(
        tmp_path / "a.wav", reference_hz=6000, cycles_per_mm=20, start_mm=(1, 2)
    ) as tape:
        assert tape.format.axes == ("x", "y", "z", "a")
        assert tape.format.start_mm == (1.0, 2.0, 0.0, 0.0)
        assert tape.format.sample_rate_hz == 44_100
        assert tape.format.motion_rate_hz == 6300
        assert tape.text == ""


def test_a_remark_of_a_sound_program_is_no_format(tmp_path: Path) -> None:
    with soundfile.SoundFile(tmp_path / "a.wav", "w", 48_000, 4) as out:
        out.comment = "mastered"
        out.write(np.zeros((100, 4)))
    with pytest.raises(TapeFault, match="does not say its format"):
        Tape.open(tmp_path / "a.wav")


def test_a_resampled_tape_goes_by_its_own_rate(tmp_path: Path) -> None:
    with soundfile.SoundFile(tmp_path / "a.wav", "w", 44_100, 4) as out:
        out.comment = TapeFormat().to_json()
        out.write(np.zeros((100, 4)))
    with Tape.open(tmp_path / "a.wav") as tape:
        assert tape.format.sample_rate_hz == 44_100


@pytest.mark.parametrize(
    ("tracks", "text", "fault"),
    [
        (1, "", "has one track; a tape has at least 3"),
        (2, "", "has 2 tracks; a tape has at least 3"),
        (5, TapeFormat().to_json(), "has 5 tracks, but its text chunk speaks of 4"),
        (4, '{"version": 9}', "version 9; this program reads 3"),
        (4, "{broken", "no JSON object"),
    ],
)
def test_sounds_that_are_no_tape(tmp_path: Path, tracks: int, text: str, fault: str) -> None:
    with soundfile.SoundFile(tmp_path / "a.wav", "w", 48_000, tracks) as out:
        if text:
            out.comment = text
        out.write(np.zeros((100, tracks)))
    with pytest.raises(TapeFault, match=fault):
        Tape.open(tmp_path / "a.wav")


def test_files_that_are_no_sound(tmp_path: Path) -> None:
    for name, content, fault in (
        ("a.wav", b"", "is empty"),
        ("a.wav", b"RIFF", "is no tape"),
        ("a.wav", b"t_s,x_mm,y_mm\n0,0,0\n", "is no tape"),
        ("a.raw", b"0123456789", "is no tape"),
    ):
        (tmp_path / name).write_bytes(content)
        with pytest.raises(TapeFault, match=fault):
            Tape.open(tmp_path / name)
    soundfile.write(tmp_path / "a.wav", np.zeros((0, 4)), 48_000)
    with pytest.raises(TapeFault, match="holds no frames"):
        Tape.open(tmp_path / "a.wav")
    with pytest.raises(FileFault, match="No such file"):
        Tape.open(tmp_path / "none.wav")
    with pytest.raises(FileFault, match="directory"):
        Tape.open(tmp_path)


@pytest.mark.parametrize("name", ["a.wav", "a.rf64", "a.flac"])
@pytest.mark.parametrize("share", [0.02, 0.5, 0.999])
def test_a_tape_cut_short_is_told(tmp_path: Path, name: str, share: float) -> None:
    record(circle(), tmp_path / name)
    whole = (tmp_path / name).read_bytes()
    (tmp_path / name).write_bytes(whole[: int(share * len(whole))])
    with pytest.raises(TapeFault, match="is cut short"):
        Tape.open(tmp_path / name)


def test_a_tape_that_is_cut_while_it_is_read(tmp_path: Path) -> None:
    record(circle(), tmp_path / "a.wav")
    with Tape.open(tmp_path / "a.wav") as tape:
        os.truncate(tmp_path / "a.wav", 100_000)
        with pytest.raises(TapeFault, match=r"is cut short: 0\.2"):
            list(tape.blocks(4096))


def test_blocks_are_of_the_size_asked_for(tmp_path: Path) -> None:
    recording = record(circle(), tmp_path / "a.wav")
    with Tape.open(tmp_path / "a.wav") as tape:
        sizes = [len(block) for block in tape.blocks(1000)]
        assert sizes[:-1] == [1000] * (len(sizes) - 1)
        # and again from the start
        assert sum(sizes) == recording.frames == sum(len(block) for block in tape.blocks())
        assert all(block.dtype == np.float32 for block in tape.blocks())
        with pytest.raises(ValueError, match="at least 1"):
            next(tape.blocks(0))
