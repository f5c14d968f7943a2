"""A sound file that is being written: how large it may become."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import soundfile

from morfax.motion.faults import TapeFault
from morfax.recorder.sound.spool import LARGEST_AIFF_BYTES, Spool

FRAMES = np.zeros((1000, 2), np.float32)


def test_an_aiff_ends_at_2_gib(tmp_path: Path) -> None:
    with Spool(tmp_path / "a.aiff", 48_000, 2, ("AIFF", "PCM_16"), "") as spool:
        frame_bytes = 4  # two tracks of 16 bit
        # sizes are signed words of 32 bit, and the header takes its part
        assert 2**31 - 2**17 < LARGEST_AIFF_BYTES < 2**31
        spool.frames = LARGEST_AIFF_BYTES // frame_bytes - len(FRAMES)
        spool.put(FRAMES)
        with pytest.raises(TapeFault, match="an AIFF ends at 2 GiB"):
            spool.put(FRAMES)
        spool.frames = len(FRAMES)  # so that the file is whole


def test_a_wav_may_be_longer(tmp_path: Path) -> None:
    with Spool(tmp_path / "a.rf64", 48_000, 2, ("RF64", "PCM_16"), "") as spool:
        spool.frames = LARGEST_AIFF_BYTES
        spool.put(FRAMES)
        spool.frames = len(FRAMES)


@pytest.mark.parametrize("written", [999, 1001])
def test_a_file_that_holds_another_number_of_frames_than_were_put_is_not_whole(
    tmp_path: Path, written: int
) -> None:
    with (
        pytest.raises(soundfile.SoundFileError),
        Spool(tmp_path / "a.flac", 48_000, 2, ("FLAC", "PCM_16"), "") as spool,
    ):
        spool.put(FRAMES)
        spool.frames = written


def test_a_spool_is_called_as_the_file_that_it_will_be(tmp_path: Path) -> None:
    kind = ("AIFF", "PCM_16")
    with Spool(tmp_path / "part", 48_000, 2, kind, "", name=tmp_path / "a.aiff") as spool:
        spool.frames = LARGEST_AIFF_BYTES
        with pytest.raises(TapeFault, match=r"cannot write .*a\.aiff: an AIFF ends"):
            spool.put(FRAMES)
        spool.frames = 0
