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
from tests.recorder.tape.circles import RATE_HZ, circle

# a step of 16 bit at half level is 1/16384 of the carrier; half of it turns a track by 5e-6 cycle, two tracks
# by 1e-5, and the test's own transform, which also takes the noise from all other frequencies, by as much
# again
QUANTISED_CYCLES = 2e-5


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
