"""The chunks of a WAV: found, told whole from cut short, and changed in place."""

from pathlib import Path

import numpy as np
import pytest
import soundfile

from morfax.recorder.sound import riff

FRAMES = (np.arange(4000).reshape(1000, 4) / 8000).astype(np.float32)


def written(file: Path, container: str, text: str = "", subtype: str = "PCM_16") -> Path:
    with soundfile.SoundFile(file, "w", 48_000, 4, subtype, format=container) as out:
        if text:
            out.comment = text
        out.write(FRAMES)
    return file


@pytest.mark.parametrize("container", ["WAV", "WAVEX", "RF64"])
def test_sizes_of_a_whole_file(tmp_path: Path, container: str) -> None:
    sizes = riff.read_sizes(written(tmp_path / "a", container, "remark"))
    assert sizes is not None
    assert sizes.stated == sizes.held == FRAMES.size * 2
    assert not sizes.cut_short


@pytest.mark.parametrize("container", ["WAV", "RF64"])
def test_a_file_that_ends_early_is_cut_short(tmp_path: Path, container: str) -> None:
    file = written(tmp_path / "a", container)
    file.write_bytes(file.read_bytes()[:-1])
    sizes = riff.read_sizes(file)
    assert sizes is not None
    assert sizes.cut_short


def test_a_wav_from_a_pipe_does_not_say_its_length(tmp_path: Path) -> None:
    file = written(tmp_path / "a", "WAV")
    whole = file.read_bytes()
    file.write_bytes(
        whole.replace(b"data" + (8000).to_bytes(4, "little"), b"data\xff\xff\xff\xff")
    )
    sizes = riff.read_sizes(file)
    assert sizes is not None
    assert sizes.stated is None
    assert not sizes.cut_short


def test_other_files_have_no_sizes(tmp_path: Path) -> None:
    assert riff.read_sizes(written(tmp_path / "a", "FLAC")) is None
    for start in (b"", b"RIFF", b"RIFF\0\0\0\0WAVE", b"RIFF\0\0\0\0WAVEfmt \xff\xff\xff\x7f"):
        (tmp_path / "b").write_bytes(start)
        assert riff.read_sizes(tmp_path / "b") is None


@pytest.mark.parametrize("subtype", ["PCM_16", "PCM_24", "PCM_32", "FLOAT"])
def test_an_rf64_becomes_a_plain_wav_of_the_same_frames(tmp_path: Path, subtype: str) -> None:
    file = written(tmp_path / "a", "RF64", "remark", subtype)
    before, _ = soundfile.read(file, dtype="float32")
    assert riff.make_plain(file)
    with soundfile.SoundFile(file) as plain:
        assert (plain.format, plain.subtype, plain.comment) == ("WAV", subtype, "remark")
        assert np.array_equal(plain.read(dtype="float32"), before)


def test_a_plain_wav_is_what_python_s_own_module_reads(tmp_path: Path) -> None:
    import wave

    file = written(tmp_path / "a", "RF64")
    riff.make_plain(file)
    with wave.open(str(file)) as plain:
        assert (plain.getnchannels(), plain.getframerate(), plain.getnframes()) == (
            4,
            48_000,
            1000,
        )


def test_what_is_too_large_or_no_rf64_stays(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert not riff.make_plain(written(tmp_path / "a", "WAV"))
    monkeypatch.setattr(riff, "LARGEST_RIFF_BYTES", 8000)
    assert not riff.make_plain(written(tmp_path / "a", "RF64"))
    assert soundfile.info(tmp_path / "a").format == "RF64"


@pytest.mark.parametrize("container", ["WAV", "RF64", "FLAC"])
def test_a_text_is_replaced_in_its_place(tmp_path: Path, container: str) -> None:
    file = written(tmp_path / "a", container, "before      ")
    riff.replace_text(file, "before      ", "afterwards")
    with soundfile.SoundFile(file) as changed:
        assert changed.comment.rstrip() == "afterwards"
        assert changed.frames == 1000


def test_a_text_without_a_place_is_misuse(tmp_path: Path) -> None:
    file = written(tmp_path / "a", "WAV", "before")
    for old, new in (("other", "any"), ("before", "much longer")):
        with pytest.raises(ValueError, match="no place in the header"):
            riff.replace_text(file, old, new)


@pytest.mark.parametrize("container", ["AIFF", "W64"])
def test_the_whole_file_s_length_is_stated_at_its_head(tmp_path: Path, container: str) -> None:
    file = written(tmp_path / "a", container)
    sizes = riff.read_sizes(file)
    assert sizes is not None
    assert sizes.stated == sizes.held == file.stat().st_size
    file.write_bytes(file.read_bytes()[:-1])
    sizes = riff.read_sizes(file)
    assert sizes is not None
    assert sizes.cut_short
    file.write_bytes(file.read_bytes()[:20])
    assert riff.read_sizes(file) is None


@pytest.mark.parametrize("size", [4, 5])
def test_a_chunk_of_odd_size_ends_at_an_even_place(tmp_path: Path, size: int) -> None:
    file = written(tmp_path / "a", "WAV")
    whole = file.read_bytes()
    at = whole.index(b"data")
    chunk = b"junk" + size.to_bytes(4, "little") + b"x" * (size + size % 2)
    file.write_bytes(whole[:at] + chunk + whole[at:])
    sizes = riff.read_sizes(file)
    assert sizes is not None
    assert (sizes.data_at, sizes.stated) == (at + len(chunk) + 8, FRAMES.size * 2)
