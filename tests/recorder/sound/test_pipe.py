"""Tapes through a pipe: WAV and raw, of every kind of sample, as the file would be."""

from __future__ import annotations

import io
import struct
from pathlib import Path

import numpy as np
import pytest
import soundfile

from morfax.motion.faults import TapeFault
from morfax.motion.motion import Motion, join
from morfax.player.tape.playback import play, play_pipe
from morfax.recorder.sound.pipe import PipeSink, PipeSource, Samples
from morfax.recorder.tape.tape import Tape, record
from tests.player.worn import program

BY_HAND = {"reference_hz": 6000.0, "cycles_per_mm": 20.0}


@pytest.fixture(scope="module")
def tape(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A circle."""
    file = tmp_path_factory.mktemp("pipe") / "a.wav"
    record(Motion(program(2.0)), file)
    return file


@pytest.mark.parametrize("sample", ["16", "24", "32", "float"])
def test_a_wav_in_a_pipe_is_the_wav(tmp_path: Path, sample: str) -> None:
    record(Motion(program(1.0)), tmp_path / "a.wav", sample=sample)
    with Tape.of(PipeSource(io.BytesIO((tmp_path / "a.wav").read_bytes()))) as pipe:
        frames = np.vstack(list(pipe.blocks(10_000)))
    assert np.array_equal(frames, soundfile.read(tmp_path / "a.wav", dtype="float32")[0])


def test_a_wav_of_no_stated_length_plays_as_the_file(tape: Path) -> None:
    data = bytearray(tape.read_bytes())
    at = data.find(b"data")
    data[4:8] = data[at + 4 : at + 8] = struct.pack("<I", 0xFFFFFFFF)
    assert np.array_equal(
        join(play_pipe(io.BytesIO(bytes(data)))).positions_mm, join(play(tape)).positions_mm
    )


def test_raw_samples_play_with_what_is_given_by_hand(tape: Path) -> None:
    frames = soundfile.read(tape, dtype="int16")[0]
    went = join(play_pipe(io.BytesIO(frames.tobytes() + b"\0\0\0"), **BY_HAND)).positions_mm
    whole = join(play(tape)).positions_mm
    assert len(went) == len(whole)
    # mm: the zero is taken from less of the standstill
    assert np.abs(went - whole).max() < 1e-6


@pytest.mark.parametrize(
    ("data", "said"),
    [
        (b"", "nothing came"),
        (b"RIFF\0\0\0\0WAVE", "within its header"),
        (b"RIFF\0\0\0\0WAVEdata\0\0\0\0", "no format before"),
        (b"RIFF\0\0\0\0WAVEjunk\xff\xff\xff\x7f", "header chunk"),
        (b"RIFF\0\0\0\0WAVEfmt \x04\0\0\0abcd", "broken format"),
        (
            b"RIFF\0\0\0\0WAVEfmt \x10\0\0\0" + struct.pack("<HHIIHH", 1, 1, 48000, 0, 0, 16),
            "3 or more",
        ),
        (b"0123456789abcdef" * 9, "does not say its format"),
    ],
)
def test_what_is_no_tape(data: bytes, said: str) -> None:
    with pytest.raises(TapeFault, match=said):
        Tape.of(PipeSource(io.BytesIO(data)))


def test_samples_of_a_frame() -> None:
    assert Samples(3, bits=24).frames(b"\xff\xff\x7f\0\0\0\0\0\x80").tolist() == [
        [pytest.approx(1, abs=1e-6), 0, -1]
    ]


@pytest.mark.parametrize("text", ["ab", "abc"])
def test_the_text_in_front_of_a_pipe_is_read_by_libsndfile(tmp_path: Path, text: str) -> None:
    stream = io.BytesIO()
    sink = PipeSink(stream, 48_000, 2, text)
    frames = np.linspace(-1.1, 1.1, 200, dtype=np.float32).reshape(100, 2)
    sink.put(frames)
    head = stream.getvalue()
    at = head.index(b"ICMT")
    size = int.from_bytes(head[at + 4 : at + 8], "little")
    # a word ends in a zero, and chunks in even places; no zero more than that takes
    assert head[at + 8 : at + 8 + size] == text.encode() + b"\0" * (size - len(text))
    assert size == len(text) + (2 if len(text) % 2 == 0 else 1)
    assert head.index(b"data") == at + 8 + size
    (tmp_path / "a.wav").write_bytes(head)
    with soundfile.SoundFile(tmp_path / "a.wav") as sound:
        assert sound.comment == text
        assert (sound.subtype, sound.channels, sound.samplerate) == ("PCM_16", 2, 48_000)
        # half a step of 16 bit, and one by which full scale is 32767 or 32768; beyond it is clipped
        assert sound.read() == pytest.approx(np.clip(frames, -1, 1), abs=1.5 * 2.0**-15)


def _wav(format_chunk: bytes, frames: bytes, *between: tuple[bytes, bytes]) -> io.BytesIO:
    """A WAV of a format chunk, other chunks and samples."""
    chunks = ((b"fmt ", format_chunk), *between, (b"data", frames))
    body = b"".join(name + struct.pack("<I", len(each)) + each for name, each in chunks)
    return io.BytesIO(b"RIFF" + struct.pack("<I", 4 + len(body)) + b"WAVE" + body)


@pytest.mark.parametrize(("kind", "bits"), [(1, 24), (1, 32), (3, 32)])
def test_the_extensible_format_names_its_kind_in_its_second_part(kind: int, bits: int) -> None:
    """Recording programs write it for three tracks and more, and for 24 bit; a GUID begins with the kind."""
    frame = 3 * bits // 8
    plain = struct.pack("<HHIIHH", kind, 3, 48_000, 48_000 * frame, frame, bits)
    guid = struct.pack("<H", kind) + b"\0\0\0\0\x10\0\x80\0\0\xaa\0\x38\x9b\x71"
    extended = struct.pack("<H", 0xFFFE) + plain[2:] + struct.pack("<HHI", 22, bits, 0) + guid
    samples = np.linspace(-0.5, 0.5, 30)
    data = (
        samples.astype("<f4").tobytes()
        if kind == 3
        else b"".join(
            int(value * 2 ** (bits - 1)).to_bytes(bits // 8, "little", signed=True)
            for value in samples
        )
    )
    sources = [PipeSource(_wav(chunk, data)) for chunk in (plain, extended)]
    assert {source.sample for source in sources} == {"FLOAT" if kind == 3 else f"PCM_{bits}"}
    frames = [np.vstack(list(source.stored_blocks())) for source in sources]
    assert np.array_equal(*frames)
    # within a step of the samples
    assert frames[0].ravel() == pytest.approx(samples, abs=2.0 ** (1 - min(bits, 24)))


def test_a_header_chunk_may_be_a_mebibyte_and_no_more() -> None:
    plain = struct.pack("<HHIIHH", 1, 3, 48_000, 48_000 * 6, 6, 16)
    largest = b"\0" * 2**20
    source = PipeSource(_wav(plain, b"\1\0" * 30, (b"junk", largest)))
    assert len(np.vstack(list(source.stored_blocks(frames=4)))) == source.frames == 10
    with pytest.raises(TapeFault, match=f"chunk of {2**20 + 2} bytes; at most {2**20}"):
        PipeSource(_wav(plain, b"\1\0" * 30, (b"junk", largest + b"\0\0")))


@pytest.mark.parametrize("begin", [b"RIFF\0\0\0\0AVI ", b"\1\0\2\0\3\0\4\0WAVE"])
def test_what_is_no_wav_by_both_its_words_is_raw_samples(begin: bytes) -> None:
    data = begin + b"\5\0" * 6
    (frames,) = PipeSource(io.BytesIO(data)).stored_blocks()
    assert np.array_equal(frames, Samples().frames(data[: len(data) // 8 * 8]))


@pytest.mark.parametrize("first", [0, 3, 7])
def test_a_pipe_is_read_from_the_frame_that_is_asked_for(first: int) -> None:
    data = np.arange(40, dtype="<i2").tobytes()
    source = PipeSource(io.BytesIO(data))
    blocks = list(source.stored_blocks(4, first))
    assert np.array_equal(np.vstack(blocks), Samples().frames(data)[first:])
    assert source.frames == 10 - first
